#!/usr/bin/env python3
"""How the programs start: what --version shows, that settings of the user win, that the environment which the libraries want
is there whatever starts the program, that the process stays the same one, and threads by the load of the machine.

usage: run_start.py [-v] [-k]         -v prints every check, -k keeps the results
"""
import os
import re
import signal
import subprocess
import sys
import time

sys.dont_write_bytecode = True
from support import BIN, DONE, INPUT, LAGAMINE, SIGNAL, UPSETTING, Checks, mesh, result_differences, said, with_h5py, write  # noqa: E402

PROGRAMS = ("lagamine", "remdata", "lagacycle", "lagareport")
ROWS = {"compiler": r"\S.*\d", "MUMPS": r"\d+\.\d+.*|unknown", "METIS": r"\d+\.\d+.*", "HDF5": r"\d+\.\d+.*",
        "BLAS": r"OpenBLAS \d+\.\d+.*, core \w+", "threads": r"\d+", "Gmsh": r"\d+\.\d+.*|none"}
SETTINGS = ("OMP_", "GOMP_", "OPENBLAS_", "LAGAMINE_BLAS_CORE")
LINUX = os.path.exists("/proc/self/exe") and os.path.exists("/proc/stat")
# A loop beside the run ends by itself, should this script be killed.
LOOP = "import time\nend = time.monotonic() + 60\nwhile time.monotonic() < end: pass"


def environment(**more):
    """The environment without settings of threads and BLAS, and with these."""
    return {**{name: value for name, value in os.environ.items() if not name.startswith(SETTINGS)}, **more}


def call(program, *words, **settings):
    """Run a program of ours in a clean environment."""
    return subprocess.run([os.path.join(BIN, program), *words], env=environment(**settings), stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, timeout=120, check=False)


def reported(result):
    """Rows of --version by name."""
    return dict(line.split(": ", 1) for line in result.stdout.splitlines()[1:] if ": " in line)


def version(checks):
    """--version of every program: its name first, then all rows, the same in all."""
    common = None
    for program in PROGRAMS:
        if not os.path.exists(os.path.join(BIN, program)):
            checks.that(program == "lagareport", f"{program} is there")      # left out where Python lacks matplotlib
            continue
        result = call(program, "--version")
        checks.that(result.returncode == DONE and result.stderr == "", f"{program} --version: done", said(result))
        checks.that(re.fullmatch(rf"{program} \d+\.\d+\.\d+", result.stdout.split("\n")[0]), f"{program} --version: name and version first",
                    result.stdout)
        rows = reported(result)
        for name, form in ROWS.items():
            checks.that(re.fullmatch(form, rows.get(name, "")), f"{program} --version: {name}", rows.get(name, "missing"))
        rows = {name: rows.get(name) for name in ROWS}
        common = common or rows
        checks.that(rows == common, f"{program} --version: as the other programs", rows)


def cores(checks):
    """The core of the BLAS: the user's wins; one that is too old and not the user's is replaced where the processor has more."""
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        flags = next((line.split(":")[1].split() for line in file if line.startswith("flags")), [])
    own = reported(call("lagamine", "--version"))["BLAS"]
    checks.that(reported(call("lagamine", "--version"))["BLAS"] == own, "two starts, one core")
    if "avx2" not in flags or "fma" not in flags:
        return
    checks.that(not own.endswith("core Prescott"), "not the oldest kernels on a processor with AVX2", own)
    for program in ("lagamine", "remdata"):
        for core in ("Prescott", "Haswell"):
            blas = reported(call(program, "--version", OPENBLAS_CORETYPE=core))["BLAS"]
            checks.that(blas.endswith(f"core {core}"), f"{program}: OPENBLAS_CORETYPE={core} wins", blas)
        # As on a processor that OpenBLAS does not know: the oldest kernels, and nobody's wish.
        blas = reported(call(program, "--version", OPENBLAS_CORETYPE="Prescott", LAGAMINE_BLAS_CORE="Prescott"))["BLAS"]
        checks.that(re.search(r"core (SkylakeX|Haswell)$", blas), f"{program}: the oldest kernels are replaced", blas)


def begin(words, **settings):
    """Start lagamine in the background."""
    return subprocess.Popen([LAGAMINE, *words], env=environment(**settings), stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE, text=True)


def environ_of(process, wanted, seconds=20):
    """The environment of a process once `wanted` is in it, or when the time is over."""
    limit, found = time.monotonic() + seconds, {}
    while process.poll() is None and time.monotonic() < limit and wanted not in found:
        try:
            with open(f"/proc/{process.pid}/environ", encoding="utf-8") as file:
                found = dict(item.split("=", 1) for item in file.read().split("\0") if "=" in item)
        except OSError:
            pass
        time.sleep(0.01)
    return found


def settings(checks):
    """Waiting threads go to sleep soon, in the process that was started; a user's own settings are left alone."""
    deck = [UPSETTING, "--quiet"] + mesh(24, 36)
    process = begin(deck + ["--threads", "2", "--out", checks.path("waiting")])
    found = environ_of(process, "GOMP_SPINCOUNT")
    checks.that(found.get("OMP_WAIT_POLICY") == "passive" and 0 < int(found.get("GOMP_SPINCOUNT", 0)) <= 20000,
                "threads that wait sleep soon", found.get("GOMP_SPINCOUNT"))
    checks.that(found.get("OPENBLAS_NUM_THREADS") == "1", "OpenBLAS has no threads of its own", found.get("OPENBLAS_NUM_THREADS"))
    with open(f"/proc/{process.pid}/cmdline", encoding="utf-8") as file:
        words = file.read().split("\0")[:-1]
    checks.that(words == [LAGAMINE, *deck, "--threads", "2", "--out", checks.path("waiting")], "the same words as it was called with", words)
    with open(f"/proc/{process.pid}/comm", encoding="utf-8") as file:
        checks.that(file.read().strip() == "lagamine", "the same name")
    while process.poll() is None and not os.path.exists(checks.path("waiting", "history.csv")):
        time.sleep(0.01)
    process.send_signal(signal.SIGTERM)
    stdout, stderr = process.communicate(timeout=120)
    checks.that(process.returncode == SIGNAL + signal.SIGTERM, "a signal to its number stops it, after a checkpoint", stdout + stderr)
    checks.that(os.path.exists(checks.path("waiting", "upsetting.ckp.h5")), "the checkpoint is there")
    for number, own in enumerate(({"OMP_WAIT_POLICY": "active"}, {"GOMP_SPINCOUNT": "7"})):
        process = begin(deck + ["--threads", "2", "--out", checks.path(f"own{number}")], **own)
        time.sleep(0.5)
        found = environ_of(process, "PATH")
        process.kill()
        process.communicate()
        both = {name: found[name] for name in ("OMP_WAIT_POLICY", "GOMP_SPINCOUNT") if name in found}
        checks.that(both == own, f"{own}: left alone", both)


def words(checks):
    """Words of the command line come through another start as they are; so do output and exit code."""
    deck = write(checks.path("a deck's \"name\" \\ $HOME.lag"), "TITLE nothing\nEND\n")
    alone = call("lagamine", deck, "--out", "", "--threads", "1")
    again = call("lagamine", deck, "--out", "", "--threads", "2")
    checks.that((alone.returncode, alone.stdout, alone.stderr) == (again.returncode, again.stdout, again.stderr) and alone.returncode == INPUT,
                "an empty word", said(again))
    alone, again = call("lagamine", deck, "--threads", "1"), call("lagamine", deck, "--threads", "2")
    checks.that((alone.returncode, alone.stdout, alone.stderr) == (again.returncode, again.stdout, again.stderr) and deck in again.stderr
                and again.returncode == INPUT, "blanks and quotes", said(again))


def threads_of(process):
    """Threads of a process, 0 when it is gone."""
    try:
        with open(f"/proc/{process.pid}/status", encoding="utf-8") as file:
            return int(re.search(r"Threads:\s+(\d+)", file.read()).group(1))
    except (OSError, AttributeError):
        return 0


def load(checks):
    """On a machine whose processors all have other work the default is one thread, and a number of the user's is kept."""
    deck = [UPSETTING, "--quiet"] + mesh(24, 36) + ["-p", "travel=1"]
    loops = [subprocess.Popen([sys.executable, "-c", LOOP]) for _ in range(len(os.sched_getaffinity(0)))]
    try:
        time.sleep(0.3)
        for name, own, most in (("load", {}, 1), ("two", {"OMP_NUM_THREADS": "2"}, 2)):
            process, seen = begin(deck + ["--out", checks.path(name)], **own), []
            while process.poll() is None:
                if os.path.exists(checks.path(name, "history.csv")):
                    seen.append(threads_of(process))
                time.sleep(0.02)
            process.communicate()
            seen = sorted(count for count in seen if count > 0)
            checks.that(process.returncode == DONE and seen and seen[len(seen) // 2] == most,
                        f"all processors busy, {own or 'default'}: {most} threads at work", seen)
    finally:
        for loop in loops:
            loop.kill()
            loop.wait()
    wrong = result_differences(checks.path("load"), checks.path("two"))
    checks.that(not wrong, "the same bits by default and with two threads", "; ".join(wrong))


def main():
    with_h5py()
    checks = Checks()
    version(checks)
    words(checks)
    if LINUX:
        cores(checks)
        if len(os.sched_getaffinity(0)) > 1:
            settings(checks)
            load(checks)
    checks.end()


if __name__ == "__main__":
    main()
