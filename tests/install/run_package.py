#!/usr/bin/env python3
"""The package for Debian: made by cpack, unpacked, its programs, pages and decks used from there. Needs dpkg-dev.

usage: run_package.py [--chroot FOLDER]
With --chroot (as root, with debootstrap and a network) FOLDER becomes a clean Debian 12, where apt installs the package with all it asks for.
"""
import os
import shutil
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
SOURCE = os.environ.get("LAGAMINE_SOURCE") or os.path.dirname(os.path.dirname(HERE))
BUILD = os.path.dirname(os.environ.get("LAGAMINE_BIN") or os.path.join(SOURCE, "build", "bin"))
CMAKE = os.environ.get("LAGAMINE_CMAKE") or "cmake"
PROGRAMS = ("lagamine", "lagacycle", "remdata", "lagareport", "lagaimport", "lagastudy")


class Failed(Exception):
    """What did not hold."""


def call(*command, **more):
    """What a command prints; it must succeed."""
    done = subprocess.run(command, text=True, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False, **more)
    if done.returncode != 0:
        raise Failed(f"{' '.join(command)} ended with {done.returncode}: {done.stdout[-1500:]}")
    return done.stdout


def make_package(folder):
    """The .deb of the programs."""
    cpack = shutil.which("cpack", path=os.path.dirname(shutil.which(CMAKE) or "") + os.pathsep + os.environ["PATH"])
    call(cpack, "-B", folder, "-D", "CPACK_COMPONENTS_ALL=programs", "-D", "CPACK_DEBIAN_COMPRESSION_TYPE=gzip", cwd=BUILD)
    found = [name for name in os.listdir(folder) if name.startswith("lagamine_") and name.endswith(".deb")]
    if len(found) != 1:
        raise Failed(f"one package lagamine_VERSION.deb was expected, found {found}")
    return os.path.join(folder, found[0])


def use(root, run, out):
    """The billet, coarse, from the decks of the package; its page; the manual pages."""
    decks = os.path.join("/" if run else root, "usr", "share", "doc", "lagamine", "decks")
    start = [*run] if run else []
    programs = "/usr/bin" if run else os.path.join(root, "usr", "bin")
    for program in PROGRAMS:
        said = call(*start, os.path.join(programs, program), "--version")
        if not said.startswith(program + " "):
            raise Failed(f"{program} --version: {said}")
        page = os.path.join(root, "usr", "share", "man", "man1", program + ".1.gz")
        if not os.path.isfile(page):
            raise Failed(f"no {page}")
    call(*start, os.path.join(programs, "lagamine"), os.path.join(decks, "upsetting", "upsetting.lag"), "--out", out, "--quiet", "-p", "nx=6", "-p", "ny=9")
    if run:
        call(*start, os.path.join(programs, "lagareport"), out, "--quiet")
    with open(os.path.join(root if run else "/", out.lstrip("/"), "history.csv"), encoding="utf-8") as file:
        names, *_, last = [line.rstrip("\n").split(",") for line in file]
    row = {name.split(" ")[0]: float(value) for name, value in zip(names, last)}
    # reference.csv of the deck has 842 kN of a finer mesh
    if row["time"] != 1 or not 0.9 < row["force_y_upper"]/842e3 < 1.1:
        raise Failed(f"the billet ended at time {row['time']} with {row['force_y_upper']}")
    if run:
        for program in PROGRAMS:
            call(*start, "man", "-w", program)


def main():
    if not shutil.which("dpkg-shlibdeps"):
        print("dpkg-dev is not installed: no package can be made here")
        return 0
    folder = tempfile.mkdtemp(prefix="lagamine-package-")
    try:
        package = make_package(folder)
        asked = call("dpkg-deb", "-f", package, "Depends")
        shared = call("ldd", os.path.join(BUILD, "bin", "lagamine"))   # HDF5's archives are linked where they can be
        for name in ("python3-h5py", "python3-matplotlib", "libmumps-seq", "libopenblas0", "libhdf5-fortran" if "libhdf5" in shared else "libsz2"):
            if name not in asked:
                raise Failed(f"the package does not ask for {name}: {asked}")
        if len(sys.argv) > 2 and sys.argv[1] == "--chroot":
            root = os.path.abspath(sys.argv[2])
            if not os.path.isdir(os.path.join(root, "etc", "apt")):
                call("debootstrap", "--variant=minbase", "bookworm", root)
            shutil.copy("/etc/resolv.conf", os.path.join(root, "etc"))
            shutil.copy(package, os.path.join(root, "tmp", "lagamine.deb"))
            call("chroot", root, "sh", "-c", "apt-get update -q && DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends "
                 "man-db /tmp/lagamine.deb")
            use(root, ("chroot", root), "/tmp/billet")
        else:
            root = os.path.join(folder, "root")
            call("dpkg-deb", "-x", package, root)
            use(root, (), os.path.join(folder, "out"))
    except Failed as error:
        print(f"FAILED: {error}")
        return 1
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    print("package made, unpacked and used")
    return 0


if __name__ == "__main__":
    sys.exit(main())
