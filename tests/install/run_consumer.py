#!/usr/bin/env python3
"""The installation, moved to another place: its programs, its layout, and a project that finds the library and adds a law to it.

usage: run_consumer.py [-k]       -k keeps the folder
"""
import csv
import os
import re
import shutil
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
SOURCE = os.environ.get("LAGAMINE_SOURCE") or os.path.dirname(os.path.dirname(HERE))
BUILD = os.path.dirname(os.environ.get("LAGAMINE_BIN") or os.path.join(SOURCE, "build", "bin"))
CMAKE = os.environ.get("LAGAMINE_CMAKE") or "cmake"
BULK = 2000.0           # of fluid.point
# Folders that are not the defaults: nothing may know them but by the standard variables.
FOLDERS = {"bin": "programs", "lib": "libraries", "include": "headers", "share": "data"}
GNU_DIRECTORIES = {"BIN": "bin", "LIB": "lib", "INCLUDE": "include", "DATAROOT": "share"}

passed, failed = 0, 0


def check(good, what, found=""):
    """Count a check; say what failed."""
    global passed, failed
    passed += bool(good)
    failed += not good
    if not good:
        print(f"FAILED: {what}: {found}")
    return good


def call(*command, **more):
    """Run a command to its end."""
    return subprocess.run(command, text=True, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          timeout=600, check=False, **more)


def cache(name, build=BUILD):
    """An entry of a build's CMakeCache.txt; empty where there is none."""
    with open(os.path.join(build, "CMakeCache.txt"), encoding="utf-8") as file:
        found = re.search(rf"^{name}:\w+=(.*)$", file.read(), re.M)
    return found.group(1) if found else ""


def files_of(folder):
    """All files below a folder, relative to it."""
    return sorted(os.path.relpath(os.path.join(place, file), folder) for place, _, files in os.walk(folder) for file in files)


def install(folder):
    """Install, move what was installed; the new place, None where it failed."""
    first, moved = os.path.join(folder, "first"), os.path.join(folder, "moved")
    done = call(CMAKE, "--install", BUILD, "--prefix", first)
    if not check(done.returncode == 0, "cmake --install", done.stdout[-400:]):
        return None
    os.rename(first, moved)
    return moved


def check_programs(prefix):
    """Every program runs where it is now and shows the version of CMakeLists.txt."""
    with open(os.path.join(SOURCE, "CMakeLists.txt"), encoding="utf-8") as file:
        version = re.search(r"project\(lagamine VERSION (\S+)", file.read()).group(1)
    programs = ["lagamine", "remdata", "lagacycle"]
    if os.path.exists(os.path.join(BUILD, "bin", "lagareport")):
        programs += ["lagareport", "lagaimport", "lagastudy"]
    for program in programs:
        said = call(os.path.join(prefix, cache("CMAKE_INSTALL_BINDIR"), program), "--version")
        check(said.returncode == 0 and said.stdout.split("\n")[0].startswith(f"{program} {version}"), f"{program} --version",
              said.stdout)


def check_package(prefix):
    """No file of the package knows where it was built; a module's file for every module of the library."""
    libraries = cache("CMAKE_INSTALL_LIBDIR")
    package = os.path.join(prefix, libraries, "cmake", "lagamine")
    for file in files_of(package):
        with open(os.path.join(package, file), encoding="utf-8") as text:
            text = text.read()
        check(SOURCE not in text and BUILD not in text, f"{file} knows no folder of the build")
    here = {os.path.basename(file) for file in files_of(os.path.join(prefix, cache("CMAKE_INSTALL_INCLUDEDIR"), "lagamine"))}
    sources = [file for file in files_of(os.path.join(SOURCE, "src")) if file.endswith(".f90") and file != "main.f90"]
    for file in sources:
        with open(os.path.join(SOURCE, "src", file), encoding="utf-8") as text:
            if not re.search(r"^module (?!procedure)", text.read(), re.M):
                continue
        module = os.path.basename(file)[:-len(".f90")] + ".mod"
        check(module in here, "installed modules", f"no {module}")
    check("contour_chain.mod" not in here, "modules of the remesher are not installed with the library's")


def check_consumer(prefix, folder):
    """A project with its own list of laws: configured by find_package alone, built, and its law run."""
    build_type = cache("CMAKE_BUILD_TYPE")
    build = os.path.join(folder, "consumer")
    flags = f"CMAKE_Fortran_FLAGS_{build_type.upper()}"
    made = call(CMAKE, "-S", os.path.join(HERE, "consumer"), "-B", build, "-D", f"CMAKE_PREFIX_PATH={prefix}",
                "-D", f"CMAKE_Fortran_COMPILER={cache('CMAKE_Fortran_COMPILER')}", "-D", f"CMAKE_BUILD_TYPE={build_type}",
                "-D", f"{flags}={cache(flags)}")
    if not check(made.returncode == 0, "configure the consumer", made.stdout[-800:]):
        return
    made = call(CMAKE, "--build", build, "--verbose")
    if not check(made.returncode == 0, "build the consumer", made.stdout[-800:]):
        return
    check("-std=f2008" not in made.stdout and "-pedantic" not in made.stdout, "the consumer keeps flags of its own")
    ran = call(os.path.join(build, "points"), "--point", os.path.join(HERE, "consumer", "fluid.point"), "--out", folder)
    if not check(ran.returncode == 0, "run the consumer's law", ran.stdout[-400:]):
        return
    with open(os.path.join(folder, "fluid.point.csv"), encoding="utf-8") as file:
        rows = [{name.split(" ")[0]: float(value) for name, value in row.items()} for row in csv.DictReader(file)]
    check(len(rows) == 5, "rows of the path", len(rows))
    for row in rows:
        wanted = BULK*(row["strain_xx"] + row["strain_yy"] + row["strain_zz"])
        for component in ("xx", "yy", "zz"):
            check(abs(row["stress_" + component] - wanted) <= 1e-12*BULK, f"stress_{component} at time {row['time']}",
                  f"{row['stress_' + component]}, wanted {wanted}")
        check(row["stress_xy"] == 0, "a fluid bears no shear", row["stress_xy"])
    check(rows[-1]["shear_xy"] == 0.05 and abs(rows[-1]["strain_yy"] + 0.02) < 1e-15, "the whole path was run", rows[-1])
    refused = call(os.path.join(build, "points"), "--point", os.path.join(SOURCE, "decks", "point", "tension.point"), "--out", folder)
    check(refused.returncode == 2 and "found 'EPLA'" in refused.stdout, "laws that the consumer left out are unknown to it",
          refused.stdout[-400:])


def check_folders(folder):
    """With other folders by the standard variables everything is there, and lagareport finds its modules."""
    build, prefix = os.path.join(folder, "other"), os.path.join(folder, "other_prefix")
    # The folder of the build is not built again: its programs and the library stand in for those of this one.
    arguments = [f"-DCMAKE_INSTALL_{name}DIR={FOLDERS[default]}" for name, default in GNU_DIRECTORIES.items()]
    made = call(CMAKE, "-S", SOURCE, "-B", build, "-D", "LAGAMINE_TESTS=OFF", "-D", f"CMAKE_INSTALL_PREFIX={prefix}",
                "-D", f"CMAKE_BUILD_TYPE={cache('CMAKE_BUILD_TYPE')}", "-D", f"LAGAMINE_PYTHON={cache('LAGAMINE_PYTHON')}", *arguments)
    if not check(made.returncode == 0, "configure with other folders", made.stdout[-400:]):
        return
    for made_file in files_of(BUILD):
        top = made_file.split(os.sep)[0]
        if top in ("bin", "modules") and os.path.basename(made_file) not in ("lagareport", "lagaimport", "lagastudy", "lagacycle") \
                or made_file.endswith("_core.a") or made_file.startswith(os.path.join("share", "documents")):
            os.makedirs(os.path.dirname(os.path.join(build, made_file)), exist_ok=True)
            shutil.copy2(os.path.join(BUILD, made_file), os.path.join(build, made_file))
    done = call(CMAKE, "--install", build)
    if not check(done.returncode == 0, "install to other folders", done.stdout[-400:]):
        return
    found = {file.split(os.sep)[0] for file in files_of(prefix)}
    check(found == set(FOLDERS.values()), "folders of the installation", sorted(found))
    if os.path.exists(os.path.join(BUILD, "bin", "lagareport")):
        for program in ("lagareport", "lagaimport", "lagastudy"):
            said = call(os.path.join(prefix, FOLDERS["bin"], program), "--version")
            check(said.returncode == 0, f"{program} from other folders", said.stdout)
    check_archives(build)


def check_archives(build):
    """What was found of the archives of one HDF5 is not taken for those of another."""
    found = cache("HDF5_ARCHIVES_LINK", build)
    made = call(CMAKE, build, "-D", f"HDF5_ARCHIVES_LINK:INTERNAL={'' if found else '1'}", "-D", "HDF5_ARCHIVES_TRIED:INTERNAL=elsewhere.a")
    check(made.returncode == 0 and cache("HDF5_ARCHIVES_LINK", build) == found, "archives of another HDF5 are tried anew",
          (found, cache("HDF5_ARCHIVES_LINK", build), made.stdout[-400:]))


def main():
    folder = tempfile.mkdtemp(prefix="lagamine_install_")
    prefix = install(folder)
    if prefix:
        check_programs(prefix)
        check_package(prefix)
        check_consumer(prefix, folder)
        check_folders(folder)
    if "-k" in sys.argv[1:]:
        print(f"kept {folder}")
    else:
        shutil.rmtree(folder, ignore_errors=True)
    print(f"{passed} passed, {failed} failed")
    return 1 if failed or not passed else 0


if __name__ == "__main__":
    sys.exit(main())
