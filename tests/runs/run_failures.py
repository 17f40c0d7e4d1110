#!/usr/bin/env python3
"""How runs fail: exit code, one clear line first, what is left behind, and what goes to which stream.

usage: run_failures.py [-v] [-k]       -v prints every check, -k keeps the results
A disk that is full: a small file system in memory where we may mount one, a limit on the size of files elsewhere.
"""
import os
import resource
import shutil
import signal
import subprocess
import sys

sys.dont_write_bytecode = True
from support import (BIN, DONE, INPUT, LAGAMINE, MACHINE, NO_CONVERGENCE, SOURCE, UPSETTING, Checks, history, mesh, run, said, start,  # noqa: E402
                     summary, with_h5py, write)

LIMIT_LOAD = os.path.join(SOURCE, "decks", "thick_cylinder", "thick_cylinder_plastic.lag")
SMALL = mesh(6, 9) + ["--threads", "1"]
# What a file takes at least on a disk in memory [bytes].
PAGE = 4096
# Words that only a run-time library or a debugger says.
STRANGE = ("Backtrace", "Fortran runtime", "HDF5-DIAG", "SIG", "core dumped", "At line")


def fails(checks, result, code, what, phrases, advice=1):
    """Exit code; one clear line first, on the stream of errors, then lines of advice; nothing from the libraries."""
    lines = result.stderr.splitlines()
    first = lines[0] if lines else ""
    checks.that(result.returncode == code, f"{what}: exit code {code}", said(result))
    checks.that(all(phrase in first for phrase in phrases), f"{what}: the first line says {' and '.join(phrases)}", result.stderr[:400])
    checks.that(len(lines) <= 1 + advice, f"{what}: a line, and {advice} of advice", f"{len(lines)} lines: {result.stderr[:600]}")
    strange = [word for word in STRANGE if word in result.stderr + result.stdout]
    checks.that(not strange, f"{what}: no word from libraries", result.stderr[:300])


def silent(checks, result, what):
    """What went wrong was not reported on standard output."""
    checks.that(result.stdout == "", f"{what}: nothing on standard output", result.stdout[:200])


def command_line(checks):
    """Options and names that are wrong: 2, nothing is made."""
    folder = checks.path("command-line")
    os.makedirs(folder)
    cases = {"an unknown option": (["--thread", "2", UPSETTING], ["--thread", "--threads"]),
             "an unknown short option": (["-x", UPSETTING], ["-x"]),
             "no deck": ([], ["deck"]),
             "two decks": ([UPSETTING, UPSETTING], ["one deck"]),
             "a deck that is not there": (["no_such.lag"], ["no_such.lag"]),
             "a deck that is a folder": ([folder], [folder]),
             "no value": ([UPSETTING, "--out"], ["--out"]),
             "threads that are no number": ([UPSETTING, "--threads", "two"], ["--threads", "two"]),
             "no threads": ([UPSETTING, "--threads", "0"], ["--threads", "0"]),
             "more threads than a number holds": ([UPSETTING, "--threads", "99999999999"], ["--threads"]),
             "-p without a value": ([UPSETTING, "-p", "nx"], ["nx"]),
             "-p of no parameter": ([UPSETTING, "-p", "nz=3"], ["nz"]),
             "an empty name of a deck": ([""], []),
             "an empty folder": ([UPSETTING, "--out", ""] + SMALL, ["--out"]),
             "a checkpoint that is not there": ([UPSETTING, "--resume", "no.ckp.h5"], ["no.ckp.h5"])}
    for what, (arguments, phrases) in cases.items():
        result = run(arguments, cwd=folder)
        fails(checks, result, INPUT, what, phrases)
        silent(checks, result, what)
    laws = run(["--law"], cwd=folder).stdout
    what, result = "a law that is not there", run(["--law", "EPLB"], cwd=folder)
    fails(checks, result, INPUT, what, ["EPLB", "EPLA"], advice=1 + len(laws.splitlines()))
    silent(checks, result, what)
    checks.that("EPLA" in laws and result.stderr.endswith(laws), f"{what}: the list of laws follows", said(result))
    checks.that(os.listdir(folder) == [], "mistakes on the command line: nothing is made", os.listdir(folder))


def no_place(checks):
    """Folders that cannot be made or written: 5."""
    file = write(checks.path("file"), "in the way\n")
    cases = {"a folder below a file": os.path.join(file, "out"), "a file where the folder should be": file,
             "a folder in /proc": "/proc/lagamine/out"}
    if os.getuid() != 0:
        closed = checks.path("closed")
        os.makedirs(closed)
        os.chmod(closed, 0o555)
        cases["a folder without leave to write"] = closed
        cases["a folder below one without leave to write"] = os.path.join(closed, "out")
    for what, out in cases.items():
        result = run([UPSETTING, "--out", out] + SMALL)
        # The line names what is in the way, which may be a folder above.
        fails(checks, result, MACHINE, what, [os.path.dirname(out)])
        silent(checks, result, what)
    for name in ("history.csv", "upsetting.g01.h5", "upsetting.xdmf", "upsetting.log", "upsetting.ckp.h5", "summary.json"):
        out = checks.path("taken-" + name)
        os.makedirs(os.path.join(out, name, "in the way"))
        result = run([UPSETTING, "--out", out, "--quiet", "-p", "travel=0.5"] + SMALL)
        fails(checks, result, MACHINE, f"a folder is called {name}", [name])


def full_disk(checks):
    """The disk fills at several moments: 5, the file is named; what was whole stays whole, and the run can go on with more room."""
    whole = checks.path("whole")
    run([UPSETTING, "--out", whole, "--quiet"] + SMALL)
    files = [os.path.join(folder, name) for folder, _, names in os.walk(whole) for name in names]
    needed = sum(-(-os.path.getsize(file) // PAGE) * PAGE for file in files) // 1024
    disk = checks.path("disk")
    os.makedirs(disk)
    mounted = os.getuid() == 0 and subprocess.run(["mount", "-t", "tmpfs", "-o", "size=4k", "none", disk], stdout=subprocess.DEVNULL,
                                                  stderr=subprocess.DEVNULL, check=False).returncode == 0
    try:
        for share in (0, 0.01, 0.03, 0.08, 0.2, 0.4, 0.6, 0.8, 0.85, 0.865, 0.88, 0.895, 0.91, 0.925, 0.945, 0.98):
            size = int(share * needed)
            what = f"room for {share:.0%} of the results"
            out = os.path.join(disk, "out")
            shutil.rmtree(out, ignore_errors=True)
            if mounted:
                subprocess.run(["mount", "-o", f"remount,size={max(size, 8)}k", disk], check=True)
                result = run([UPSETTING, "--out", out, "--quiet"] + SMALL)
            else:
                # gfortran's own handler of SIGXFSZ is not there without its backtraces: a write beyond the limit then fails.
                result = run([UPSETTING, "--out", out, "--quiet"] + SMALL, preexec_fn=lambda: limit_files(size * 600),
                             restore_signals=False, env=dict(os.environ, GFORTRAN_ERROR_BACKTRACE="0"))
            fails(checks, result, MACHINE, what, [out])
            silent(checks, result, what)
            left = [name for _, _, names in os.walk(out) for name in names if name.endswith(".tmp")]
            checks.that(not left, f"{what}: nothing half written is left", left)
            report_says_why(checks, out, result, what)
            checkpoint = os.path.join(out, "upsetting.ckp.h5")
            if not os.path.exists(checkpoint):
                continue
            if mounted:
                subprocess.run(["mount", "-o", f"remount,size={4 * needed}k", disk], check=True)
            again = run([UPSETTING, "--out", out, "--quiet", "--resume", checkpoint] + SMALL)
            checks.that(again.returncode == DONE, f"{what}: resumed with more room", said(again))
            if again.returncode == DONE:
                checks.that(history(out) == history(whole), f"{what}: resumed, and as in one go")
    finally:
        if mounted:
            subprocess.run(["umount", disk], check=True)


def report_says_why(checks, out, result, what):
    """Of a run that has left no fields, lagareport repeats why, where the listing has it. What can be read is not drawn."""
    sys.path.insert(0, os.path.join(SOURCE, "src", "report"))
    from lagamine_report import ReportError, Run  # pylint: disable=import-outside-toplevel

    try:
        Run(out)
    except ReportError:
        pass
    else:
        return
    page = subprocess.run([os.path.join(BIN, "lagareport"), out, "--out", checks.path("page.html"), "--quiet"], text=True, check=False,
                          stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    listing = os.path.join(out, "upsetting.log")
    if page.returncode != INPUT or not os.path.exists(listing):
        return
    with open(listing, encoding="utf-8") as text:
        known = "stopped: " in text.read()
    checks.that(not known or result.stderr.splitlines()[0] in page.stderr, f"{what}: lagareport says why there are no fields",
                page.stderr)


def limit_files(size):
    """No file of this process beyond `size` bytes; a write beyond it fails instead of ending the program."""
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (max(size, 1), max(size, 1)))


def lost_output(checks):
    """Nobody reads what is said, or it cannot be written."""
    if os.path.exists("/dev/full"):
        with open("/dev/full", "w", encoding="utf-8") as full:
            result = subprocess.run([LAGAMINE, UPSETTING, "--check"], stdout=full,
                                    stderr=subprocess.PIPE, text=True, check=False)
        strange = [word for word in STRANGE if word in result.stderr]
        checks.that(not strange, "standard output is full: no word from libraries", result.stderr[:300])
    out = checks.path("unread")
    process = start([UPSETTING, "--out", out] + SMALL)
    process.stdout.close()
    process.stdout = None
    _, stderr = process.communicate()
    checks.that(process.returncode in (DONE, MACHINE, -signal.SIGPIPE), "nobody reads: ends in order", f"{process.returncode} {stderr[:200]}")
    checks.that(os.path.exists(os.path.join(out, "summary.json")), "nobody reads: the results are there")


def limit_load(checks):
    """Beyond the limit load there is no equilibrium: 3, the last good state is there, and says so."""
    out = checks.path("limit")
    result = run([LIMIT_LOAD, "--out", out, "-p", "p_end=0.3", "--quiet", "--threads", "1"])
    fails(checks, result, NO_CONVERGENCE, "limit load", ["no convergence", "step", "time"])
    silent(checks, result, "limit load, quiet")
    reported = summary(out)
    checks.that(reported["exit_code"] == NO_CONVERGENCE and reported["status"] == "stopped", "limit load: summary has the code", reported["exit_code"])
    checks.that("no convergence" in reported["stop_reason"] and reported["stop_reason"] in result.stderr, "limit load: summary has the reason",
                reported["stop_reason"])
    reached = 0.3 * reported["time"]
    checks.that(abs(reached / 0.192091 - 1) < 0.005, "limit load: Hill's pressure reached and not passed", f"{reached:.6f}")
    rows = history(out)
    checks.that(rows["step"][-1] == reported["steps"] and rows["time"][-1] == reported["time"], "limit load: history ends at the last good step")
    checkpoint = os.path.join(out, "thick_cylinder_plastic.ckp.h5")
    checks.that(os.path.exists(checkpoint), "limit load: the checkpoint is there")
    again = run([LIMIT_LOAD, "--out", out, "-p", "p_end=0.3", "--quiet", "--threads", "1", "--resume", checkpoint])
    checks.that(again.returncode == NO_CONVERGENCE, "limit load: resumed, it ends the same way", said(again))
    checks.that(history(out) == rows, "limit load: resumed, no step was added")
    told = [name for name in sorted(os.listdir(out)) if ".failed." in name]
    checks.that("thick_cylinder_plastic.failed.xdmf" in told and "failed.xdmf" in result.stderr, "limit load: the picture of the failure", told)
    below = run([LIMIT_LOAD, "--out", out, "-p", "p_end=0.1", "--quiet", "--threads", "1"])
    left = [name for folder, _, names in os.walk(out) for name in names if ".failed" in os.path.join(folder, name)]
    checks.that(below.returncode == DONE and not left, "limit load: a run below it in the same folder leaves no picture of a failure", left)
    result = run([LIMIT_LOAD, "--out", checks.path("limit-first"), "-p", "p_end=30000", "--quiet", "--threads", "1"])
    fails(checks, result, NO_CONVERGENCE, "limit load in the first step", ["no convergence", "step 1 "])
    checks.that(os.path.exists(checks.path("limit-first", "summary.json")), "limit load in the first step: summary")
    there = os.path.exists(checks.path("limit-first", "thick_cylinder_plastic.ckp.h5"))
    checks.that(there or "checkpoint" not in result.stderr, "limit load in the first step: no word of a checkpoint that is not there",
                result.stderr)


def heat_alone(checks):
    """What is advised is of the scene: a body that does not move has no limit load."""
    deck = write(checks.path("heat.lag"), "TITLE heat alone, below round-off\nSTATE PLSTN\nKINEM SMALL\nBLOCK w PL8TM 4 h\n   0. 0.   10. 0.   10. 10.   0. 10.\n"
                 "   4 1.   4 1.\nLAW h HEAT\n   TEMP 0.\n   1. 1.\n   TEMP 100.\n   1000. 1.\n   TEMP 101.\n   0.001 1.\nSTART T 0.\nFLUX w 2 Q 1.E5\n"
                 "CONVE w 4 H 1. TS 0.\nNORMS FORCE 1.E-17\nSTRAT 1.E3 1.E3 1.E3   2 1\nSTOP 1.E3\nEND\n")
    result = run([deck, "--out", checks.path("heat"), "--quiet"])
    fails(checks, result, NO_CONVERGENCE, "heat alone", ["no convergence", "step 1 "])
    checks.that("limit load" not in result.stderr and "NORMS near round-off" in result.stderr, "heat alone: advice", result.stderr[:400])
    checks.that("worst at node" in result.stderr and "(heat)" in result.stderr and "force" not in result.stderr, "heat alone: the node of the heat",
                result.stderr[:400])
    jump = write(checks.path("jump.lag"), "TITLE a film that jumps\nSTATE PLSTN\nKINEM SMALL\nBLOCK b PL8LS 4 steel\n   0. 0.   10. 0.   10. 10.   0. 10.\n"
                 "   4 1.   4 1.\nLAW steel ELATH\n   200000. 0.3 1.E-5\nADDEL b PL8TM h BILINEAR\nLAW h HEAT\n   30. 4.\nSTART T 800.\nFIXED b 1 Y\n"
                 "FIXED b 4 X\nCONVE b 2 H 1. TS 20.\n   0. 1.   500. 1.   500.001 1000.   799. 1000.   799.0001 0.01\nSTRAT 10. 10. 10.   5 3\n"
                 "NORMS FORCE 1.E-15 DISPL 1.E-16\nSTOP 100.\nEND\n")
    result = run([jump, "--out", checks.path("jump"), "--quiet"])
    fails(checks, result, NO_CONVERGENCE, "heat beside mechanics", ["no convergence", "(heat)", "temperature:"])
    checks.that("limit load" not in result.stderr and "force" not in result.stderr, "heat beside mechanics: advice of heat", result.stderr[:400])


def streams(checks):
    """What goes where when all is well."""
    quiet = run([UPSETTING, "--out", checks.path("quiet"), "--quiet", "-p", "travel=1"] + SMALL)
    checks.that((quiet.returncode, quiet.stdout, quiet.stderr) == (DONE, "", ""), "--quiet: not a word", said(quiet))
    loud = run([UPSETTING, "--out", checks.path("loud"), "-p", "travel=1"] + SMALL)
    checks.that(loud.returncode == DONE and loud.stderr == "", "nothing on the stream of errors", loud.stderr)
    checks.that("steps" in loud.stdout and "iterations" in loud.stdout, "the table at the end is on standard output", loud.stdout[:200])
    checks.that("\r" not in loud.stdout and "\x1b" not in loud.stdout, "no progress line where there is no terminal")
    elsewhere = checks.path("elsewhere")
    os.makedirs(elsewhere)
    run([UPSETTING, "--quiet", "-p", "travel=1"] + SMALL, cwd=elsewhere)
    checks.that(os.listdir(elsewhere) == ["upsetting"], "without --out: a folder with the deck's name, in the present folder",
                os.listdir(elsewhere))


def main():
    with_h5py()
    checks = Checks()
    for topic in (command_line, no_place, full_disk, lost_output, limit_load, heat_alone, streams):
        topic(checks)
    checks.end()


if __name__ == "__main__":
    main()
