#!/usr/bin/env python3
"""Output of all programs: a standard output that is closed or full is exit code 5 and a line, and no output takes the place of anything
but a regular file.

usage: run_output.py [-v] [-k]       -v prints every check, -k keeps the results
"""
import os
import stat
import subprocess
import sys

sys.dont_write_bytecode = True
from support import BIN, DONE, LAGAMINE, MACHINE, UPSETTING, Checks, mesh, said, write  # noqa: E402

REMDATA, CYCLE, REPORT = (os.path.join(os.path.abspath(BIN), name) for name in ("remdata", "lagacycle", "lagareport"))
SMALL = mesh(4, 4) + ["-p", "travel=1", "--threads", "1"]
STRANGE = ("Backtrace", "Fortran runtime", "HDF5-DIAG", "Traceback", "At line", "Exception", "write error")
LONGEST = 60      # seconds: a pipe that nobody reads must not be waited for
POINT = """TITLE  Point
KINEM  LOG
LAW    steel EPLA
   200000. 0.3
   LINEAR 300. 1000.
PATH   steel
   1. 10   E 0.1  S 0.  E 0.  S 0.
END
"""


def call(command, redirection=""):
    """A program with its standard streams as the shell sets them up."""
    return subprocess.run(["sh", "-c", f'exec "$@" {redirection}', "sh", *command], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, text=True, timeout=LONGEST, check=False)


def standard_output(checks, out, report_there):
    """Closed, full, closed together with the other two, or left by its reader."""
    checkpoint = os.path.join(out, "upsetting.ckp.h5")
    cases = {"lagamine --help": [LAGAMINE, "--help"], "lagamine --version": [LAGAMINE, "--version"],
             "lagamine --law": [LAGAMINE, "--law"], "lagamine --law EPLA": [LAGAMINE, "--law", "EPLA"],
             "lagamine --check": [LAGAMINE, UPSETTING, "--check", *SMALL],
             "lagamine": [LAGAMINE, UPSETTING, "--out", out, *SMALL],
             "remdata --help": [REMDATA, "--help"], "remdata --version": [REMDATA, "--version"],
             "remdata --about": [REMDATA, "--about", checkpoint], "remdata --next": [REMDATA, "--next", os.path.join(out, "upsetting")],
             "remdata": [REMDATA, checkpoint, "--out", checks.path("new.h5")],
             "lagacycle --help": [CYCLE, "--help"], "lagacycle --version": [CYCLE, "--version"]}
    point = write(checks.path("point.lag"), POINT)
    for what, more in {"lagamine --point": [], "lagamine --point --check": ["--check"]}.items():
        cases[what] = [LAGAMINE, "--point", point, "--out", out, *more]
    if report_there:
        cases.update({"lagareport --help": [REPORT, "--help"], "lagareport": [REPORT, out, "--out", checks.path("page.html")]})
    for what, command in cases.items():
        good = call(command)
        checks.that(good.returncode == DONE and good.stdout and not good.stderr, f"{what}: done", said(good))
        for how, redirection in {"closed": ">&-", "full": ">/dev/full"}.items():
            result = call(command, redirection)
            lines = result.stderr.splitlines()
            checks.that(result.returncode == MACHINE, f"{what}, standard output {how}: exit code 5", said(result))
            checks.that(len(lines) == 1 and "standard output" in lines[0] and not any(word in result.stderr for word in STRANGE),
                        f"{what}, standard output {how}: a line", result.stderr[:300])
        result = call(command, "<&- >&- 2>&-")
        checks.that(result.returncode == MACHINE, f"{what}, no stream at all: exit code 5", said(result))
        unread = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        unread.stdout.close()
        unread.stdout = None
        _, stderr = unread.communicate(timeout=LONGEST)
        checks.that(unread.returncode in (DONE, -13, 141) and not stderr, f"{what}, the reader has gone away: no failure",
                    f"{unread.returncode} {stderr[:300]}")
    for name in ("history.csv", "upsetting.log", "upsetting.ckp.h5"):
        with open(os.path.join(out, name), "rb") as file:
            checks.that(b"lagamine:" not in file.read(), f"no line for the terminal is in {name}")


def quiet_without_streams(checks):
    """A run that says nothing needs no stream."""
    result = call([LAGAMINE, UPSETTING, "--out", checks.path("daemon"), "--quiet", *SMALL], "<&- >&- 2>&-")
    checks.that(result.returncode == DONE, "--quiet, no stream at all: done", said(result))


def obstacles(path):
    """What may stand under a name of an output: how to make it, and how it is reported."""
    return {"a pipe": (lambda: os.mkfifo(path), "a pipe"), "a link to a device": (lambda: os.symlink("/dev/null", path), "a symbolic link"),
            "a link to a folder": (lambda: os.symlink("/", path), "a symbolic link"),
            "a link that leads nowhere": (lambda: os.symlink("nowhere", path), "a symbolic link"),
            "a folder": (lambda: os.mkdir(path), "a directory")}


def refused(checks, what, command, path, words):
    """5 and a line that names the file and what it is, which is there as it was."""
    before = os.lstat(path)
    try:
        result = call(command)
    except subprocess.TimeoutExpired:
        checks.that(False, f"{what}: ends", "waits for ever")
        return
    lines = result.stderr.splitlines()
    checks.that(result.returncode == MACHINE, f"{what}: exit code 5", said(result))
    checks.that(1 <= len(lines) <= 2 and path in lines[0] and words in lines[0], f"{what}: a line", result.stderr[:300])
    after = os.lstat(path)
    checks.that((before.st_ino, stat.S_IFMT(before.st_mode)) == (after.st_ino, stat.S_IFMT(after.st_mode)), f"{what}: left as it is")


def put_away(path):
    """Remove an obstacle."""
    os.rmdir(path) if stat.S_ISDIR(os.lstat(path).st_mode) else os.unlink(path)


def only_regular_files(checks, out, report_there):
    """Every file of a run, its temporary name, the files of a remesh and of the report."""
    checkpoint = os.path.join(out, "upsetting.ckp.h5")
    run_names = ("history.csv", "summary.json", "upsetting.log", "upsetting.ckp.h5", "upsetting.xdmf", "upsetting.dies.xdmf", "upsetting.g01.h5",
                 "history.csv.tmp", "upsetting.ckp.h5.tmp")
    folder = checks.path("obstacles")
    os.makedirs(folder)
    cases = {name: (os.path.join(folder, name), [LAGAMINE, UPSETTING, "--out", folder, "--quiet", *SMALL]) for name in run_names}
    for name in ("new.h5", "new.h5.json", "new.h5.tmp"):
        cases["remdata: " + name] = checks.path(name), [REMDATA, checkpoint, "--out", checks.path("new.h5"), "--quiet"]
    if report_there:
        cases["lagareport --out"] = checks.path("page.html"), [REPORT, out, "--out", checks.path("page.html"), "--quiet"]
        cases["lagareport --png"] = checks.path("mesh.png"), [REPORT, out, "--out", checks.path("page.html"), "--quiet", "--png",
                                                              checks.path()]
    for name, (path, command) in cases.items():
        for what, (make, words) in obstacles(path).items():
            if name == "upsetting.g01.h5" and what == "a folder":
                continue    # reported by HDF5's reader, in other words (run_failures)
            if name.startswith("lagareport") and what not in ("a pipe", "a link to a device"):
                continue    # takes its time
            if os.path.lexists(path):
                put_away(path)
            make()
            refused(checks, f"{name} is {what}", command, path, words)
            put_away(path)
    for device in ("/dev/null", "/dev/stdout"):
        refused(checks, f"remdata --out {device}", [REMDATA, checkpoint, "--out", device], device, "output replaces regular files only")
        if report_there:
            refused(checks, f"lagareport --out {device}", [REPORT, out, "--out", device], device, "output replaces regular files only")
    result = call([LAGAMINE, UPSETTING, "--out", "/dev/null", *SMALL])
    checks.that(result.returncode == MACHINE and "/dev/null" in result.stderr, "lagamine --out /dev/null: refused", said(result))
    elsewhere = checks.path("link")
    os.symlink(out, elsewhere)
    result = call([LAGAMINE, UPSETTING, "--out", elsewhere, "--quiet", *SMALL])
    checks.that(result.returncode == DONE, "a folder may be reached by a link", said(result))


def main():
    checks = Checks()
    out = checks.path("out")
    report_there = call([REPORT, "--version"]).returncode == DONE
    result = call([LAGAMINE, UPSETTING, "--out", out, *SMALL])
    checks.that(result.returncode == DONE, "a run", said(result))
    standard_output(checks, out, report_there)
    quiet_without_streams(checks)
    only_regular_files(checks, out, report_there)
    checks.end()


if __name__ == "__main__":
    main()
