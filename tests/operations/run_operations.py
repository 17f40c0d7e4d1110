#!/usr/bin/env python3
"""Operations in a chain (OPERA): what the part takes from one to the next, meshes on the way, resumed runs.

usage: run_operations.py [-v] [-k]

- `split`: a stroke in two operations, the die of the second where that of the first has stopped, is the stroke in one.
- `release`: an operation without dies leaves the part as a die that is lifted does.
- `heat`, `pair`: heat alone; bodies in contact in generalised plane strain, which the next operation finds as they were.
- `at_once`: a multiplier that begins an operation with another value than 0.
- `sudden`: a load that begins an operation at once, far above what the part bears, is named by the run that ends there.
- `held`: a die whose multiplier begins the second operation where the first has left it stands there from the beginning;
  one under a force goes on where it is.
- `strokes`: press, release, press with another die; stopped anywhere and resumed to the same bits; with a new mesh in each
  operation the same part, by one command, also where that is stopped.
- `closing`: an operation without REMSH after one with it: what its table of accuracy says.
- `first_without`: one without before the first with it: its seconds are in the cost of the whole.
- `beginning`: a die that a later operation puts deep into the part is told, after a stop too; one that goes on, or stands at the part's
  height, is not. What the cards of a later operation say of torches and sides is told by --check.
- `path_errors`: what a release adds to the error of the stress by the path.
- `let_go`: slender elastic strips, bent by a third to four fifths of their length, spring back to where they were, also onto a die; with JAUMANN,
  whose stress depends on the way, one bent by a tenth.
- `contour`: a BODY has its sizes from the first operation alone; the others may do without REMSH, the first one not.
"""
import os
import signal
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "runs"))
sys.path.insert(0, os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "cycle"))
from remeshed import cycle, tries, within_limits  # noqa: E402
from support import DONE, NO_CONVERGENCE, SIGNAL, Checks, history, result_differences, run, said, start, stop_after, summary, with_h5py, write  # noqa: E402

HEAD = """TITLE  Block pressed in operations
STATE  PLSTN
KINEM  LOG
BLOCK  block PL8LS 4 metal
   0. 0.   10. 0.   10. 10.   0. 10.
   6 1.   6 1.
LAW    metal EPLA
   70000. 0.33
   LINEAR 200. 200.
LAW    film COUL2D
   PENETR 1.E-3   PHI 0.1   AUGMENT 10
FIXED  block 1 Y
FIXED  block 4 X
NORMS  FORCE 1.E-9 DISPL 1.E-8 PATH 0 RATE 0
PROBE  corner NODE UY 10. 10.
PROBE  width NODE UX 10. 0.
PROBE  plastic MEAN plastic_strain block
CKPT   4
"""
STEP = "STRAT  0.05 1.E-6 0.05   9 3\n"
REMESH = "REMSH\n   SIZE 0.8 2.\n   TIMES "


def flat(y, stroke, time=1.0, more=""):
    """A flat die that goes down from y."""
    return (f"DIE    upper PILOT 0. {y}\n   SEGM   40. {y}   -1. {y}\nCNT2D  block 3 upper -3 film\n"
            f"LIC    press\n   0. 0.   {time} {-stroke}{more}\nMOVE   upper Y press\n")


PUNCH = """DIE    punch PILOT 0. 9.2
   SEGM   4. 20.   4. 9.2
   FILLT  1. 1.E-3
   SEGM   4. 9.2   -1. 9.2
CNT2D  block 3 punch -3 film
LIC    press
   0. 0.   1. -0.6
MOVE   punch Y press
"""
RELEASE = "OPERA  release\nSTOP   0.1\nSTRAT  0.05 1.E-6 0.1   6 3\n"
STROKES = "OPERA  upset\n" + flat(10.0, 1.0) + STEP + RELEASE + "OPERA  indent\n" + PUNCH + STEP


def done(checks, name, text):
    """A deck run to its end: its path and its folder."""
    deck, out = write(checks.path(name + ".lag"), text + "END\n"), checks.path(name)
    result = run([deck, "--out", out, "--threads", "1"])
    checks.that(result.returncode == DONE, f"{name} ends", said(result))
    return deck, out


def near(checks, what, one, two, columns, limit):
    """The last rows agree."""
    for column in columns:
        a, b = one[column][-1], two[column][-1]
        checks.that(abs(a - b) <= limit * abs(b), f"{what}: {column} within {limit:g}", (a, b))


def split(checks):
    """One stroke, whole and in two parts; then released, and with the die lifted."""
    _, whole = done(checks, "whole", HEAD + STEP + flat(10.0, 1.0))
    _, parts = done(checks, "parts", HEAD + STEP + "OPERA one\n" + flat(10.0, 0.5, 0.5) + "OPERA two\n" + flat(9.5, 0.5, 0.5))
    one, two = history(parts), history(whole)
    near(checks, "split", one, two, ("force_y_upper", "corner", "width", "plastic", "plastic_work", "friction_work"), 1e-8)
    checks.that(list(one["operation"]) == sorted(one["operation"]) and set(one["operation"]) == {1, 2}, "split: column of operations")
    checks.that(abs(one["time"][-1] - 1) < 1e-12, "split: the clock of the run goes on", one["time"][-1])
    for name, place in (("summary.one.json", 1), ("summary.json", 2)):
        told = summary(parts, name)
        checks.that(told["operation_number"] == place and told["remeshings"] == 0, f"split: {name}", told["operation_number"])
    _, lifted = done(checks, "lifted", HEAD + STEP + flat(10.0, 1.0, 1.0, "   1.1 -0.5"))
    _, free = done(checks, "free", HEAD + "OPERA  press\n" + flat(10.0, 1.0) + STEP + RELEASE)
    near(checks, "release", history(free), history(lifted), ("corner", "width", "plastic"), 2e-5)
    checks.that(abs(summary(free)["checks"]["energy_imbalance"]) < 0.01, "release: energy", summary(free)["checks"]["energy_imbalance"])


def strokes(checks):
    """Three operations: bits after stops, and with meshes."""
    deck, whole = done(checks, "strokes", HEAD + STROKES)
    rows = history(whole)
    checks.that(rows["operation"][-1] == 3 and rows["force_y_upper"][-1] != rows["force_y_upper"][-1], "no die, no force: nan")
    drift = summary(whole)["checks"]["volume_drift_unloaded"]
    checks.that(abs(drift) < 1e-9, "plastic flow keeps the volume through all operations", drift)
    last = [list(rows["operation"]).index(k) for k in (2, 3)]
    for k, row in enumerate((3, last[0], last[1] + 2)):
        out = checks.path(f"stopped-{k}")
        code, _, stderr = stop_after(start([deck, "--out", out, "--threads", "1"]), out, row, signal.SIGTERM, 0)
        checks.that(code in (SIGNAL + signal.SIGTERM, DONE), f"stopped after {row} rows", f"{code} {stderr}")
        if code != DONE:
            result = run([deck, "--out", out, "--threads", "1", "--resume", os.path.join(out, "strokes.ckp.h5")])
            checks.that(result.returncode == DONE, f"resumed after {row} rows", said(result))
        wrong = result_differences(whole, out)
        checks.that(not wrong, f"after {row} rows as in one go", "; ".join(wrong))
    meshes(checks, rows)


def meshes(checks, plain):
    """A new mesh in each operation, by one command, and stopped on the way."""
    text = HEAD.replace("CKPT   4\n", "") + STROKES.replace(STEP, STEP + REMESH + "0.05 0.5\n") + "END\n"
    text = text.replace(RELEASE, RELEASE + REMESH + "0.05\n")
    deck, out = write(checks.path("meshes.lag"), text), checks.path("meshes")
    result = cycle(deck, out, "--quiet")
    if not checks.that(result.returncode == DONE, "with new meshes", result.stdout + result.stderr):
        return
    made = [(int(t["generation [-]"]), t["accepted"]) for t in tries(out)]
    checks.that(made == [(2, "y"), (3, "y"), (5, "y"), (7, "y"), (8, "y")], "meshes 4 and 6 begin operations, the others are new", made)
    checks.that(summary(out)["remeshings"] == 5, "summary counts new meshes", summary(out)["remeshings"])
    within_limits(checks, out)
    near(checks, "with new meshes", history(out), plain, ("width", "plastic", "corner"), 0.03)
    drift = summary(out)["checks"]["volume_drift_unloaded"]
    checks.that(abs(drift) < 1e-3, "volume through operations and meshes", drift)
    again = checks.path("again")
    for row in (25,):
        code, _, _ = stop_after(start_cycle(deck, again), again, row, signal.SIGTERM, 0)
        checks.that(code in (SIGNAL + signal.SIGTERM, DONE), f"cycle stopped after {row} rows", code)
    result = cycle(deck, again, "--quiet")
    checks.that(result.returncode == DONE, "cycle resumed", result.stdout + result.stderr)
    # tables and reports state seconds
    wrong = [w for w in result_differences(out, again) if ".json" not in w and not w.startswith("cycle.csv")]
    checks.that(not wrong, "stopped cycle as in one go", "; ".join(wrong))


def closing(checks):
    """What an operation without REMSH says of accuracy after one with it: the meshes and seconds of all, and that nobody has followed
    the error of the meshes before."""
    text = HEAD.replace("CKPT   4\n", "") + "OPERA  upset\n" + flat(10.0, 1.0) + STEP + REMESH + "0.5\n" + RELEASE + "END\n"
    deck, out = write(checks.path("closing.lag"), text), checks.path("closing")
    result = cycle(deck, out, "--quiet")
    if not checks.that(result.returncode == DONE, "closing ends", said(result)):
        return
    before, told = summary(out, "summary.upset.json")["accuracy"], summary(out)["accuracy"]
    checks.that(before["space"]["stress_carried_pct"] > 0, "the second mesh has errors of the first", before)
    checks.that(told["space"].get("stress_carried_known") is False and "stress_carried_pct" not in told["space"], "not followed", told)
    checks.that(told.get("cycle", {}).get("meshes") == 2, "meshes of all operations", told)
    if "cycle" in told:
        checks.that(told["cycle"]["processor_s"] > before["cycle"]["processor_s"], "seconds of all operations", told["cycle"])
        checks.that(told["space"]["strain_worst_pct"] >= before["space"]["strain_worst_pct"], "largest errors of all operations", told)


def first_without(checks):
    """An operation without REMSH before the first one with it: the cost of the whole has its seconds."""
    text = HEAD.replace("CKPT   4\n", "") + "OPERA  upset\n" + flat(10.0, 1.0) + STEP.replace("0.05", "0.01")
    text += "OPERA  indent\n" + PUNCH + STEP + REMESH + "0.9\nEND\n"
    deck, out = write(checks.path("later.lag"), text), checks.path("later")
    result = cycle(deck, out, "--quiet")
    if not checks.that(result.returncode == DONE, "later ends", said(result)):
        return
    before, told = summary(out, "summary.upset.json"), summary(out)
    first, whole = before["cpu_s"], told["accuracy"].get("cycle", {}).get("processor_s", 0)
    checks.that("cycle" in before["accuracy"] or os.path.exists(os.path.join(out, "later.cost")), "later: a cost is kept")
    # the last call of the solver alone is that of the second mesh; the remesher and the stroke before it come on top
    checks.that(whole > 0.9*first + told["cpu_s"], "later: seconds of the first operation too", (first, told["cpu_s"], whole))


def start_cycle(deck, out):
    """lagacycle, started."""
    import subprocess
    from remeshed import CYCLE
    return subprocess.Popen([CYCLE, deck, "--out", out, "--threads", "1", "--quiet"], stdin=subprocess.DEVNULL,
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


OTHERS = {"heat": ("""TITLE  Heat alone
STATE  AXISYM
KINEM  SMALL
BLOCK  bar PL8TM 4 heat BILINEAR
   0. 0.   10. 0.   10. 20.   0. 20.
   6 1.   6 1.
LAW    heat HEAT
   20. 3.6
START  T 900.
THETA  TRBDF2 TOL 1.
PROBE  core NODE T 0. 0.
STRAT  0.1 1.E-5 10.   6 3
""", "OPERA  air\nCONVE  bar 2 3 H 0.1 TS 20.\nSTOP   10.\nOPERA  water\nCONVE  bar 2 3 H 4. TS 20.\nSTOP   20.\n"),
          "pair": ("""TITLE  One body pressed on another
STATE  GPLSTN
SECTN  E FREE
SECTN  KX HELD
SECTN  KY HELD
KINEM  LOG
BLOCK  low PL8LS 4 metal
   0. 0.   20. 0.   20. 5.   0. 5.
   8 1.   3 1.
BLOCK  up PL8LS 4 metal
   0. 5.   10. 5.   10. 10.   0. 10.
   5 1.   3 1.
LAW    metal EPLA
   70000. 0.33
   LINEAR 200. 200.
LAW    film COUL2D
   PENETR 1.E-3   PHI 0.1   AUGMENT 10
DIE    anvil SIDES low 3
CNT2D  up 1 anvil film
FIXED  low 1 Y
FIXED  low 4 X
FIXED  up 4 X
STRAT  0.05 1.E-6 0.1   6 3
""", "OPERA  press\nLIC    press\n   0. 0.   1. -0.5\nMOVE   up 3 Y press\nOPERA  hold\nFIXED  up 3 Y\nSTOP   0.5\n")}


def others(checks):
    """Heat alone in two operations; bodies in contact, which goes on in the next operation as it was."""
    _, heat = done(checks, "heat", "".join(OTHERS["heat"]))
    rows = history(heat)
    change = rows["operation"].index(2)
    checks.that(20 < rows["core"][-1] < rows["core"][change - 1] < 900, "heat: water cools on what air has left", rows["core"][-1])
    checks.that(abs(rows["heat_imbalance"][-1]) < 1e-9, "heat: balance", rows["heat_imbalance"][-1])
    _, pair = done(checks, "pair", "".join(OTHERS["pair"]))
    rows = history(pair)
    change = rows["operation"].index(2)
    for column in ("force_y_anvil", "elastic_energy", "section_strain"):
        checks.that(abs(rows[column][-1]/rows[column][change - 1] - 1) < 1e-6, f"pair: {column} is held", rows[column][change - 1:])
    checks.that(rows["iterations"][change] <= 1, "pair: nothing is to be found again", rows["iterations"][change])


def at_once(checks):
    """What an operation moves at once is moved once, in its first step."""
    parts = "OPERA  pull\nLIC    way\n   0. 0.  1. 0.1\nMOVE   block 3 Y way\nOPERA  more\nLIC    way\n   0. 0.1\nMOVE   block 3 Y way\nSTOP   1.\n"
    head = HEAD.replace("LAW    film COUL2D\n   PENETR 1.E-3   PHI 0.1   AUGMENT 10\n", "")
    _, out = done(checks, "at_once", head + STEP + parts)
    rows = history(out)
    change = rows["operation"].index(2)
    for row, way in ((change - 1, 0.1), (change, 0.2), (-1, 0.2)):
        checks.that(abs(rows["corner"][row]/way - 1) < 1e-9, f"at once: {way}", rows["corner"][row])


def held(checks):
    """A die of both operations, driven by a multiplier that begins the second where it ended the first."""
    die = ("DIE    upper PILOT 0. 10.\n   SEGM   40. 10.   -1. 10.\nCNT2D  block 3 upper -3 film\n")
    second = "OPERA  two\nLIC    press\n   0. -1.   0.5 -1.   1. -1.5\nMOVE   upper Y press\n"
    _, out = done(checks, "held", HEAD + STEP + die + "OPERA  one\nLIC    press\n   0. 0.   1. -1.\nMOVE   upper Y press\n" + second)
    rows = history(out)
    change = rows["operation"].index(2)
    for column in ("force_y_upper", "elastic_energy", "plastic_work", "external_work"):
        checks.that(abs(rows[column][change]/rows[column][change - 1] - 1) < 1e-6, f"held: {column}", rows[column][change - 1:change + 1])
    checks.that(abs(rows["displacement_y_upper"][change] + 1) < 1e-12, "held: the die stays where it is", rows["displacement_y_upper"][change])
    _, whole = done(checks, "in_one", HEAD + STEP + die + "LIC    press\n   0. 0.   1. -1.   1.5 -1.   2. -1.5\nMOVE   upper Y press\n")
    near(checks, "held", rows, history(whole), ("force_y_upper", "corner", "width", "plastic_work", "external_work"), 1e-4)
    _, out = done(checks, "rests", HEAD + STEP + die + "OPERA  one\nLIC    push\n   0. 0.   1. 1.\nFORCE  upper Y -3000. push\n"
                  + "OPERA  two\nLIC    push\n   0. 1.   1. 1.\nFORCE  upper Y -3000. push\n")
    rows = history(out)
    change = rows["operation"].index(2)
    for column in ("displacement_y_upper", "force_y_upper", "elastic_energy", "plastic_work", "external_work"):
        checks.that(abs(rows[column][-1]/rows[column][change - 1] - 1) < 1e-9, f"under a force: {column}", (rows[column][change - 1], rows[column][-1]))
    higher = die.replace("10.", "12.")
    _, other = done(checks, "higher", HEAD + STEP + "OPERA  one\n" + die + "LIC    push\n   0. 0.   1. 1.\nFORCE  upper Y -3000. push\n"
                    + "OPERA  two\n" + higher + "LIC    push\n   0. 1.   1. 1.\nFORCE  upper Y -3000. push\n")
    for name, folder, words in (("rests", out, "deep at the start"), ("higher", other, "gap 2.95")):
        with open(os.path.join(folder, name + ".log"), encoding="utf-8") as file:
            told_place = [line.strip() for line in file if line.startswith("contact    block.3/upper: ")][-1]
        checks.that(words in told_place, f"{name}: where its die begins", told_place)


def contour(checks):
    """A body by its contour, pressed and released: the release asks for no meshes and has no REMSH."""
    block = HEAD[HEAD.index("BLOCK"):HEAD.index("LAW    metal")]
    body = "BODY   block PL8LS 4 metal\n   SEGM 0. 0. 10. 0.\n   SEGM 10. 0. 10. 10.\n   SEGM 10. 10. 0. 10.\n   SEGM 0. 10. 0. 0.\n"
    press, size = "OPERA  upset\n" + flat(10.0, 0.5) + STEP, "REMSH\n   SIZE 1. 2.\n"
    head, end = HEAD.replace(block, body), RELEASE + "END\n"
    deck, out = write(checks.path("contour.lag"), head + press + size + end), checks.path("contour")
    result = cycle(deck, out, "--quiet")
    checks.that(result.returncode == DONE, "contour: an operation without REMSH after the first", said(result))
    if result.returncode == DONE:
        rows = history(out)
        checks.that(rows["operation"][-1] == 2 and abs(rows["corner"][-1] + 0.5) < 0.05, "contour: pressed, released", rows["corner"][-1])
    result = run([write(checks.path("unsized.lag"), head + press + end), "--check"])
    lines = result.stderr.splitlines()
    checks.that(result.returncode == 2 and len(lines) == 1 and "BODY: the size of its elements is not given" in lines[0],
                "contour: the first operation needs it", said(result))


def checked(checks):
    """--check shows every operation."""
    deck, folder = write(checks.path("checked.lag"), HEAD + STROKES + "END\n"), checks.path("scenes")
    result = run([deck, "--check", "--out", folder])
    told = [line for line in result.stdout.splitlines() if line.startswith("operation")]
    checks.that(result.returncode == DONE and told == ["operation  1 of 3: upset", "operation  2 of 3: release", "operation  3 of 3: indent"],
                "--check tells the operations", said(result))
    files = sorted(os.listdir(folder))
    checks.that(files == ["checked.indent.scene.json", "checked.release.scene.json", "checked.scene.json"], "--check: a scene each", files)


TORCH = """TITLE  A bar crossed by a torch in its second operation
STATE  PLSTN
KINEM  SMALL
BLOCK  bar PL8TM 4 heat
   0. 0.   40. 0.   40. 20.   0. 20.
   20 1.   10 1.
LAW    heat HEAT
   50. 3.6
START  T 20.
STRAT  0.1 1.E-4 0.3   6 3
OPERA  before
CONVE  bar 3 H 0.02 TS 20.
STOP   30.
OPERA  pass
CONVE  bar 3 H 0.02 TS 20.
GOLDAK bar P 1.E6 ETA 0.8 FRONT 3. REAR 6. WIDTH 8. DEPTH 8. INTO 0. -1. CROSS 8. {cross}
   0. 20. 20.
STOP   10.
"""


def told(out):
    """Warnings of a run."""
    return [item["text"] for item in summary(out)["warnings"]]


def beginning(checks):
    """What can be told as a later operation begins."""
    for name, y, deep in (("deep", 8.8, True), ("goes_on", 9.0, False), ("above", 9.1, False)):
        deck, out = done(checks, name, HEAD + "OPERA  one\n" + flat(10.0, 1.0) + STEP + "OPERA  two\n" + flat(y, 0.3) + STEP)
        warnings = [line for line in told(out) if "as the operation before left it" in line]
        checks.that((len(warnings) == 1 and "deep in die upper" in warnings[0]) if deep else not warnings, f"{name}: begins deep", warnings)
        if not deep:
            continue
        again = checks.path(name + "-again")
        rows = history(out)
        code, _, stderr = stop_after(start([deck, "--out", again, "--threads", "1"]), again, rows["operation"].index(2) + 3, signal.SIGTERM, 0)
        checks.that(code in (SIGNAL + signal.SIGTERM, DONE), f"{name}: stopped", f"{code} {stderr}")
        if code != DONE:
            result = run([deck, "--out", again, "--threads", "1", "--resume", os.path.join(again, name + ".ckp.h5")])
            checks.that(result.returncode == DONE, f"{name}: resumed", said(result))
        wrong = result_differences(out, again)
        checks.that(not wrong and told(again) == told(out), f"{name}: told after a stop as in one go",
                    "; ".join([*wrong, *told(again)]))
    for cross, wanted in ((5.0, []), (9.9, ["crosses at time 9.9"])):
        result = run([write(checks.path("torch.lag"), TORCH.format(cross=cross) + "END\n"), "--check"])
        warnings = [line for line in result.stdout.splitlines() if line.startswith("WARNING")]
        checks.that(len(warnings) == len(wanted) and all(words in line for words, line in zip(wanted, warnings)), f"torch at {cross}", warnings)
    twice = TORCH.format(cross=5.0).replace("OPERA  pass\n", "OPERA  pass\nCONVE  bar 2 3 H 1. TS 20.\n")
    result = run([write(checks.path("twice.lag"), twice + "END\n"), "--check"])
    checks.that("have the sum of both exchanges" in result.stdout, "two exchanges on a side of the second operation", said(result))


def path_errors(checks):
    """A part that springs back elastically errs no more in its stress than before, however long the steps are beside the last ones
    of the operation before, in which the punch went aside and the path bent."""
    text = HEAD.replace("NORMS  FORCE 1.E-9 DISPL 1.E-8 PATH 0 RATE 0\n", "").replace("PHI 0.1", "PHI 0.3") + "OPERA  press\n"
    text += PUNCH.replace("9.2", "10.") + "LIC    aside\n   0. 0.   0.9998 0.   0.9999 0.01   1. 0.02\nMOVE   punch X aside\n"
    _, out = done(checks, "errs", text + "STRAT  0.02 1.E-6 0.02   9 3\n" + RELEASE)
    rows = history(out)
    before = rows["path_error_stress"][list(rows["operation"]).index(2) - 1]
    after = rows["path_error_stress"][-1]
    checks.that(0 < before and after < 10 * before, "errs: a release makes no error of the stress", (before, after))


def let_go(checks):
    """A strip that its support lets go turns by up to 70 degrees, at fixed time; searches along its corrections would stop where they
    stretch it (446 iterations, and no equilibrium)."""
    table = "LAW    tool COUL2D\n   PENETR 0.01   PHI 0.1\nDIE    table\n   SEGM   -10. 0.   150. 0.\nCNT2D  strip 1 table tool\n"
    for kinem, thickness, way, n, die, limit in (("LOG", 0.5, 30, 50, "", 1e-6), ("LOG", 0.5, 60, 50, "", 1e-6), ("LOG", 0.25, 80, 100, "", 1e-6),
                                                 ("LOG", 0.5, 60, 50, table, 1e-6), ("JAUMANN", 0.5, 10, 50, "", 1e-4)):
        name = f"let_go {kinem} {thickness} {way}{' table' if die else ''}"
        text = (f"TITLE  Strip let go\nSTATE  PLSTN\nKINEM  {kinem}\nBLOCK  strip PL8LS 4 steel\n"
                f"   0. 0.   100. 0.   100. {thickness}   0. {thickness}\n   {n} 1.   2 1.\nNORMS  FORCE 1.E-9 DISPL 1.E-8\n"
                "LAW    steel EPLA\n   200000. 0.3\n   LINEAR 1.E5 1000.\nFIXED  strip 4 XY\n"
                "PROBE  tip_x NODE X 100. 0.\nPROBE  tip_y NODE Y 100. 0.\n"
                f"OPERA  bend\nLIC    up\n   0. 0.   1. {way}\nMOVE   strip 2 Y up\nSTRAT  0.02 1.E-6 0.1   6 3\n"
                f"OPERA  release\n{die}STRAT  1. 1.E-3 1.   6 3\nSTOP   1.\n")
        _, out = done(checks, name.replace(" ", "_"), text)
        rows = history(out)
        place = rows["tip_x"][-1], rows["tip_y"][-1]
        checks.that(max(abs(place[0] - 100), abs(place[1])) < limit, f"{name}: the tip is where it was", place)


def sudden(checks):
    """Loads that begin an operation far above what the part bears: the run that ends there names them."""
    for name, load, word in (("release", "FORCE  POINT 10. 10. Y -200000. load", "acts at once, with 200000 as the part is released: let its LIC begin at 0"),
                             ("die", flat(9.5, 0).split("LIC")[0] + "FORCE  upper Y -20000. load",
                              "the FORCE on die upper acts at once, with 20000 in the first step however short: let its LIC begin at 0"),
                             ("side", "PRES2D block 3 2 900. load",
                              "the load on block.3/load acts at once, with 900 in the first step however short: let its LIC begin at 0")):
        deck = write(checks.path(f"sudden-{name}.lag"), HEAD + STEP + "OPERA  press\n" + flat(10, 0.5) + "OPERA  load\nLIC    load\n   0. 1.   1. 1.\n"
                     + load + "\nEND\n")
        result = run([deck, "--out", checks.path(f"sudden-{name}")])
        checks.that(result.returncode == NO_CONVERGENCE and word in result.stderr, f"sudden, {name}: told", said(result))


def main():
    with_h5py()
    checks = Checks()
    split(checks)
    strokes(checks)
    others(checks)
    at_once(checks)
    sudden(checks)
    held(checks)
    checked(checks)
    beginning(checks)
    closing(checks)
    first_without(checks)
    contour(checks)
    path_errors(checks)
    let_go(checks)
    checks.end()


if __name__ == "__main__":
    main()
