#!/usr/bin/env python3
"""Warnings of a chain: at its end all operations are told, each warning once, with the operation that it comes from.

usage: run_warnings.py [-v] [-k]

- A billet pressed with wrong numbers, pressed again by a punch that begins in it, and released: `summary.json`, the closing table, the short
  result of `lagareport`, its page, and the tables of `lagastudy` have the warnings of the first two operations, those of operations have their own.
- The same resumed in another folder from a checkpoint of each operation, and by `lagacycle`, whose last line counts them.
- What is judged again in each operation, a sheet that thins, is told once, with the last numbers.
- A deck without operations has its warnings as ever, checks that do not hold among them.
"""
import csv
import os
import subprocess
import sys

sys.dont_write_bytecode = True
TESTS = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path[:0] = [os.path.join(TESTS, folder) for folder in ("runs", "cycle")]
from remeshed import cycle  # noqa: E402
from support import BIN, DONE, Checks, run, said, summary, with_h5py, write  # noqa: E402

BILLET = """TITLE  Billet pressed twice and released
STATE  AXISYM
KINEM  LOG
BLOCK  billet  PL8LS 4 steel
   0. 0.   10. 0.   10. 15.   0. 15.
   4 1.   6 1.
LAW    steel  EPLA
   200000. 0.3
   LINEAR 700. 300.
FIXED  billet 1 Y
FIXED  billet 4 X
PARAM  step 0.1
STRAT  0.05 1.E-5 $step   5 3
CKPT   1
"""
PRESS = """LAW    rough  COUL2D
   PENETR 1.E-4   PHI 1.5
DIE    upper  PILOT 0. 15.
   SEGM  30. 15.   -1. 15.
CNT2D  billet 3 upper 2 rough
LIC    down
   0. 0.   1. -3.   2. -4.
MOVE   upper Y down
STOP   1.
"""
CHAIN = BILLET + "OPERA  press\n" + PRESS + """OPERA  middle
LAW    rough  COUL2D
   PENETR 1.E-3   PHI 0.3
DIE    punch  PILOT 0. 11.9
   SEGM  5. 11.9   -1. 11.9
CNT2D  billet 3 punch rough
LIC    down
   0. 0.   1. -1.
MOVE   punch Y down
OPERA  release
STOP   0.1
END
"""
# the operation, and what its warning begins with, of the whole run
EXPECTED = [("press", "LIC down goes on after the end of the operation"), ("press", "law rough: its coefficient of friction"),
            ("press", "energy imbalance"), ("press", "sides between points of contact"),
            ("middle", "billet.3/punch: the part, as the operation before left it, begins"), ("middle", "points of contact are deeper")]
SHEET = """TITLE  A sheet pulled twice
STATE  PLSTS 1.
KINEM  LOG
BLOCK  sheet PL8LS 4 steel
   0. 0.   10. 0.   10. 1.   0. 1.
   2 1.   1 1.
LAW    steel EPLA
   200000. 0.3
   LINEAR 200. 2000.
FIXED  sheet 1 Y
FIXED  sheet 4 X
STRAT  0.05 1.E-4 0.1   5 3
NORMS  STRAIN 10.
OPERA  one
LIC    pull
   0. 0.   1. 1500.
MOVE   sheet 2 X pull
OPERA  two
LIC    pull
   0. 0.   1. 500.
MOVE   sheet 2 X pull
END
"""


def told(folder, name="summary.json"):
    """Operation and text of the warnings."""
    return [(warning.get("operation"), warning["text"]) for warning in summary(folder, name)["warnings"]]


def as_expected(checks, what, folder, expected=None):
    """Each of the expected warnings is there, and no other."""
    found = told(folder)
    wanted = EXPECTED if expected is None else expected
    checks.that(len(found) == len(wanted) and all(any(operation == one and text.startswith(words) for one, text in found)
                                                  for operation, words in wanted), what, found)
    checks.that(summary(folder)["warning_count"] == len(found), f"{what}: count")


def tool(program, *words):
    """A program that is installed beside the solver."""
    return subprocess.run([os.path.join(BIN, program), *words], text=True, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          check=False, timeout=120, env=dict(os.environ, PYTHONDONTWRITEBYTECODE="1"))


def chain(checks):
    """Operations and their end; results that are read by people."""
    deck, out = write(checks.path("chain.lag"), CHAIN), checks.path("chain")
    result = run([deck, "--out", out])
    if not checks.that(result.returncode == DONE, "chain ends", said(result)):
        return
    as_expected(checks, "summary of the whole", out)
    for operation in ("press", "middle"):
        own = told(out, f"summary.{operation}.json")
        checks.that(len(own) > 1 and all(one == operation for one, _ in own), f"own warnings of {operation}", own)
    last = result.stdout.rpartition("operation release")[2]
    for operation, words in EXPECTED:
        checks.that(f"WARNING: operation {operation}: {words}" in last, f"last table: {words}", last)
    short = tool("lagareport", out)
    checks.that(short.returncode == DONE and all(f"WARNING: operation {operation}: {words}" in short.stdout for operation, words in EXPECTED),
                "lagareport", short.stdout + short.stderr)
    for die in ("upper", "punch"):
        checks.that(f"force_y_{die}: last" in short.stdout, f"lagareport: force of {die}, which the last operation does not have", short.stdout)
    with open(os.path.join(out, "report.html"), encoding="utf-8") as file:
        page = file.read()
    checks.that("<b>nan</b>" not in page.lower(), "the page has the largest forces of all dies")
    for operation, words in EXPECTED:
        checks.that(f"<p>operation {operation}: {words}" in page, f"page: {words}")
        checks.that(page.count(f"WARNING: operation {operation}: {words}") == 1 and f"WARNING: {words}" not in page,
                    f"from the listing, once: {words}")
    study = tool("lagastudy", deck, "--ladder", "step=0.1,0.05", "--quantity", "force_y_upper@max", "--quantity", "force_y_upper", "--out",
                 checks.path("study"))
    with open(checks.path("study", "study.csv"), encoding="utf-8") as file:
        values = [float(row["value"]) for row in csv.DictReader(file)]
    checks.that(len(values) == 4 and all(value > 0 for value in values), "lagastudy: forces of a die of the first operation", values)
    checks.that(study.returncode == DONE and "WARNING (step=0.1, step=0.05): operation press: law rough" in study.stdout, "lagastudy",
                study.stdout + study.stderr)
    resumed(checks, deck)


def pressed_last(checks):
    """The last operation has contact: a check that does not hold is told once in the short result."""
    deck, out = write(checks.path("two.lag"), CHAIN[:CHAIN.index("OPERA  release")] + "END\n"), checks.path("two")
    result = run([deck, "--out", out])
    if not checks.that(result.returncode == DONE, "two operations end", said(result)):
        return
    short = tool("lagareport", out).stdout
    checks.that(short.count("at points of contact") + short.count("points of contact are deeper") == 1
                and short.count("depth over allowed between") == 1 and "sides between" not in short, "depths once", short)


def resumed(checks, deck):
    """Stopped in each operation, gone on with elsewhere."""
    for operation in (1, 2, 3):
        short = write(checks.path(f"short{operation}.lag"), CHAIN)
        out, elsewhere = checks.path(f"first{operation}"), checks.path(f"elsewhere{operation}")
        process = subprocess.Popen([os.path.join(BIN, "lagamine"), short, "--out", out, "--progress"], stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL)
        wait_for_operation(process, out, operation)
        process.kill()
        process.wait()
        checkpoint = os.path.join(out, f"short{operation}.ckp.h5")
        result = run([short, "--out", elsewhere, "--resume", checkpoint])
        if checks.that(result.returncode == DONE, f"resumed in operation {operation}", said(result)):
            as_expected(checks, f"resumed in operation {operation}", elsewhere)
    out = checks.path("cycle")
    result = cycle(deck, out)
    checks.that(result.returncode == DONE and f"; {len(EXPECTED)} warnings (summary.json)" in result.stdout.splitlines()[-1], "lagacycle counts them",
                result.stdout + result.stderr)
    result = cycle(deck, out)
    checks.that("finished already" in result.stdout and f"; {len(EXPECTED)} warnings (summary.json)" in result.stdout, "and of a finished run",
                result.stdout + result.stderr)


def wait_for_operation(process, folder, operation):
    """Until the history has a row of it."""
    path = os.path.join(folder, "history.csv")
    while process.poll() is None:
        try:
            with open(path, encoding="utf-8") as file:
                lines = file.read().splitlines()
        except OSError:
            continue
        if len(lines) < 2:
            continue
        column = [title.split(" ")[0] for title in lines[0].split(",")].index("operation")
        if any(len(line.split(",")) > column and int(float(line.split(",")[column])) >= operation for line in lines[2:-1]):
            return


def again(checks):
    """What goes on is told once."""
    deck, out = write(checks.path("sheet.lag"), SHEET), checks.path("sheet")
    result = run([deck, "--out", out])
    if not checks.that(result.returncode == DONE, "sheet ends", said(result)):
        return
    thinned = [(operation, text) for operation, text in told(out) if "has thinned to" in text]
    first = [text for _, text in told(out, "summary.one.json") if "has thinned to" in text]
    checks.that(len(thinned) == 1 and thinned[0][0] == "one" and len(first) == 1 and first[0] != thinned[0][1],
                "a sheet thins: once, from the first operation, with the last numbers", (thinned, first))


def plain(checks):
    """A deck without operations."""
    deck, out = write(checks.path("plain.lag"), BILLET + PRESS + "END\n"), checks.path("plain")
    result = run([deck, "--out", out])
    if checks.that(result.returncode == DONE, "plain ends", said(result)):
        as_expected(checks, "plain", out, [(None, "LIC down goes on after the end"), (None, "law rough"), (None, "energy imbalance"),
                                           (None, "sides between points")])
        checks.that("WARNING: law rough" in result.stdout and "WARNING: operation" not in result.stdout, "its table", result.stdout)


def main():
    """All of it."""
    with_h5py()
    checks = Checks()
    chain(checks)
    pressed_last(checks)
    again(checks)
    plain(checks)
    checks.end()


if __name__ == "__main__":
    main()
