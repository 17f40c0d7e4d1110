#!/usr/bin/env python3
"""Temperatures of another run: TEMPE ... FROM drives mechanics, START ... FROM begins a scene of heat.

usage: run_chain.py [-v] [-k]

- `tube`: decks/hot_cylinder in three ways, chained (decks of its folder `chained`, another mesh), staggered and monolithic: thermal
  stress against B.A. Boley, J.H. Weiner, Theory of Thermal Stresses (1960), section 9.11, within 0.5 %.
- `bar`: plastic, by temperature, heated at one end; the motion does nothing to the temperature: a chained run by the steps of the other
  on its mesh is the staggered one, and on other meshes it comes near; with BILINEAR too, in large strain.
- `between`: a bar held at its ends whose temperature grows linearly, saved twice: stress at all steps between; and a scene that begins
  later than the other run, within its only mesh or with that of its second operation.
- `given`: a body with TEMPE keeps that temperature where another one conducts.
- `go_on`: a scene of heat that starts from the end of another is the whole one; between two instants it is their mean; another mesh.
- `remeshed`: a bar on two new meshes: its material has the temperatures that it has in the other run, and the bar gets as long as on one mesh.
- `resume`: the same bits from a checkpoint on; refused where the other run has changed.
- `refused`: files that are missing, cut, altered, of no heat, too short, of another place.
"""
import glob
import os
import re
import shutil
import subprocess
import sys

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [HERE] + [os.path.join(os.path.dirname(HERE), folder) for folder in ("patch", "runs", "cycle")]
from patch_support import LAGAMINE, LONGEST_RUN, SOURCE, Checks, Run, h5py, np  # noqa: E402
from remeshed import cycle, tries  # noqa: E402
from run_heat import NORMS, temperatures  # noqa: E402
from support import DONE, INPUT, history, result_differences, said  # noqa: E402

TUBE = os.path.join(SOURCE, "decks", "hot_cylinder")


def hoop_stress(r):
    """Boley and Weiner: hoop stress of the hot tube, plane strain [Pa]."""
    a, b, k = 0.5, 0.7, 200e9*1e-5*100/(2*(1 - 0.3)*np.log(0.7/0.5))
    return k*(1 - np.log(b/r) - a**2/(b**2 - a**2)*(1 + b**2/r**2)*np.log(b/a))


def tube(checks):
    """Three ways."""
    folder = os.path.join(checks.folder, "tube")
    os.makedirs(folder)
    for name in ("tube_heat", "tube_chained"):
        shutil.copy(os.path.join(TUBE, "chained", name + ".lag"), folder)
    with open(os.path.join(TUBE, "hot_cylinder.lag"), encoding="utf-8") as file:
        staggered = file.read()
    # the other two points of the elements at the walls, for the stress at the walls themselves
    inner = {f"at{i}": 0.5 + 0.2/15*0.5*(1 + (i - 1)*np.sqrt(0.6)) for i in range(3)}
    points = dict(inner, **{name.replace("at", "out"): 1.2 - r for name, r in inner.items()})
    seen = "".join(f"PROBE {name} POINT stress_zz {r!r} 0.005\n" for name, r in points.items()) + "END\n"

    def with_points(text):
        return re.sub(r"(?m)^END\n", lambda _: seen, text)

    runs = [Run(checks, "tube/tube_heat", read(os.path.join(folder, "tube_heat.lag"))),
            Run(checks, "tube/tube_chained", with_points(read(os.path.join(folder, "tube_chained.lag")))),
            Run(checks, "tube/staggered", with_points(staggered)),
            Run(checks, "tube/monolithic", with_points(staggered.replace("SOLVE  ONCE", "SOLVE  MONOLITHIC")))]
    if not all(run.ok for run in runs):
        return
    # the outermost of 3 Gauss points of 15 elements
    inset = 0.2/15*0.5*(1 - np.sqrt(0.6))
    # 0.5 and 0.7 themselves, by the closed form
    checks.small(abs(hoop_stress(0.5)/-158.760e6 - 1), 1e-5, "tube: -158.760 MPa at the bore")
    checks.small(abs(hoop_stress(0.7)/126.954e6 - 1), 1e-5, "tube: 126.954 MPa outside")
    for run in runs[1:]:
        for column, r in (("hoop_in", 0.5 + inset), ("hoop_out", 0.7 - inset)):
            checks.small(abs(run.history[column][-1]/hoop_stress(r) - 1), 5e-3, f"{run.name}: {column} {run.history[column][-1]:.5g}")
        for wall, names, exact in ((0.5, ("at0", "at1", "at2"), -158.760e6), (0.7, ("out0", "out1", "out2"), 126.954e6)):
            places, values = [points[name] for name in names], [run.history[name][-1] for name in names]
            found = np.polyval(np.polyfit(np.array(places) - wall, values, 2), 0.0)
            checks.small(abs(found/exact - 1), 5e-3, f"{run.name}: hoop stress at the wall r = {wall}: {found/1e6:.3f} MPa")
    checks.that("heat_stored" not in runs[1].history, "tube: chained: no books of heat")


def read(path):
    """All of a file."""
    with open(path, encoding="utf-8") as file:
        return file.read()


BAR = """TITLE bar
STATE {state}
KINEM LOG
BLOCK bar PL8LS 4 steel
   0. 0. 4. 0. 4. 1. 0. 1.
   {nx} 1. {ny} 1.
LAW steel EPLA
   TEMP 0.
   200000. 0.3
   LINEAR 400. 500.
   TEMP 1000.
   100000. 0.35
   LINEAR 60. 60.
{heat}FIXED bar 1 Y
FIXED bar 4 X
MOVE bar 3 Y press -0.03
LIC press
   0. 0. 1. 1.
STRAT {step} 1.E-6 {step} 9 3
STOP 1.
SAVE 1
PROBE s MEAN mises bar
PROBE p MEAN plastic_strain bar
PROBE t NODE T 2. 0.
""" + NORMS + "END\n"
OWN = ("ADDEL bar PL8TM heat {kind}\nLAW heat HEAT\n   TEMP 0.\n   30. 3.\n   TEMP 1000.\n   60. 5.\nSTART T 900.\n"
       "CONVE bar 2 H 60. TS 20.\n")


def bar(checks):
    """Chained and staggered; the conducting body does not take part in the motion of the other run, nor is it changed by it."""
    for state in ("PLSTN", "AXISYM"):
        for kind in ("", "BILINEAR"):
            name = f"bar-{state}{kind}"
            # heat alone: the same body without motion
            heat = (BAR.format(state=state, nx=8, ny=2, step=0.05, heat=OWN.format(kind=kind)).replace("KINEM LOG", "KINEM SMALL"))
            together = Run(checks, name, heat)
            same = Run(checks, name + "-chained", BAR.format(state=state, nx=8, ny=2, step=0.05,
                                                             heat=f"TEMPE bar FROM {name}/{name}.g01.h5\n").replace("LOG", "SMALL"))
            fine = Run(checks, name + "-fine", BAR.format(state=state, nx=13, ny=3, step=0.03,
                                                          heat=f"TEMPE bar FROM {name}/{name}.g01.h5\n").replace("LOG", "SMALL"))
            large = Run(checks, name + "-large", BAR.format(state=state, nx=8, ny=2, step=0.05,
                                                            heat=f"TEMPE bar FROM {name}/{name}.g01.h5\n"))
            if not (together.ok and same.ok and fine.ok and large.ok):
                continue
            for column in "spt":
                checks.small(np.max(np.abs(same.history[column]/together.history[column] - 1)), 1e-9, f"{same.name}: {column} as staggered")
                checks.small(abs(fine.history[column][-1]/together.history[column][-1] - 1), 2e-3, f"{fine.name}: {column}")
            checks.small(abs(large.history["s"][-1]/together.history["s"][-1] - 1), 0.1, f"{large.name}: in large strain")
            with same.open() as file:
                step = file["steps/000020/node"]
                checks.that("temperature" in step and "heat_flow" not in step, f"{same.name}: temperatures are shown, no flow of heat")
            checks.small(np.max(np.abs(temperatures(same)[1] - temperatures(together)[1])), 1e-9*900, f"{same.name}: all nodes")


def between(checks):
    """Heated everywhere alike, T = 20 + 500 t: two instants are enough."""
    heat = Run(checks, "even", "TITLE even\nSTATE PLSTN\nKINEM SMALL\nBLOCK bar PL8TM 4 m\n   0. 0. 4. 0. 4. 1. 0. 1.\n   1 1. 1 1.\n"
               "LAW m HEAT\n   1. 2.\nSTART T 20.\nHEATS bar Q 1000.\nSTRAT 0.5 1.E-6 0.5 9 3\nSTOP 1.\nSAVE 100\n" + NORMS + "END\n")
    held = Run(checks, "even-held", "TITLE held\nSTATE PLSTS 1.\nKINEM SMALL\nBLOCK bar PL8LS 9 m\n   0. 0. 4. 0. 4. 1. 0. 1.\n   3 1. 2 1.\n"
               "LAW m ELATH\n   200000. 0.3 1.2E-5\nTEMPE bar FROM even/even.g01.h5\nFIXED bar 2 4 X\nFIXED bar 1 Y\n"
               "STRAT 0.1 1.E-6 0.1 9 3\nSTOP 1.\nPROBE s POINT stress_xx 2. 0.5\nPROBE t NODE T 2. 0.5\n" + NORMS + "END\n")
    if heat.ok and held.ok:
        with heat.open() as file:
            checks.that(len(file["steps"]) == 2, "between: two instants", list(file["steps"]))
        time = held.history["time"]
        checks.small(np.max(np.abs(held.history["t"] - 20 - 500*time)), 1e-9*520, "between: linear in time")
        checks.small(np.max(np.abs(held.history["s"]/(-200000*1.2e-5*500*time) - 1)), 1e-9, "between: stress of a held bar")
    # from an instant on: free of stress at the temperature then
    two = Run(checks, "twice", read(os.path.join(checks.folder, "even.lag")).replace(
        "HEATS bar Q 1000.\nSTRAT 0.5 1.E-6 0.5 9 3\nSTOP 1.\nSAVE 100\n",
        "STRAT 0.5 1.E-6 0.5 9 3\nSAVE 100\nOPERA one\nHEATS bar Q 1000.\nSTOP 0.6\nOPERA two\nHEATS bar Q 2000.\nSTOP 0.4\n"))
    for name, card, rate, stop in (("later", "even/even.g01.h5 AT 0.3", 500, 0.7), ("second", "twice/twice.g02.h5 AT 0.6", 1000, 0.4)):
        later = Run(checks, name, read(os.path.join(checks.folder, "even-held.lag")).replace("even/even.g01.h5", card).replace(
            "STOP 1.", f"STOP {stop}"))
        if two.ok and later.ok:
            time, first = later.history["time"], 20 + 500*float(card.rsplit(" ", 1)[1])
            checks.small(np.max(np.abs(later.history["t"] - first - rate*time)), 1e-9*520, f"between: {name}: linear in time")
            checks.small(np.max(np.abs(later.history["s"]/(-200000*1.2e-5*rate*time) - 1)), 1e-9, f"between: {name}: stress of a held bar")


def given(checks):
    """Bodies apart: one conducts, the other has a temperature of its own."""
    run = Run(checks, "given", "TITLE given\nSTATE PLSTS 1.\nKINEM SMALL\nBLOCK a PL8LS 9 m\n   0. 0. 1. 0. 1. 1. 0. 1.\n   1 1. 1 1.\n"
              "BLOCK b PL8LS 9 m\n   2. 0. 3. 0. 3. 1. 2. 1.\n   1 1. 1 1.\nLAW m ELATH\n   200000. 0.3 1.E-5\nADDEL a PL8TM hot\n"
              "LAW hot HEAT\n   1. 1.\nSTART T 50.\nTEMPE b 100. up\nLIC up\n   0. 1. 1. 3.\nFIXED a 2 4 X\nFIXED a 1 Y\nFIXED b 2 4 X\nFIXED b 1 Y\n"
              "STRAT 0.5 1.E-6 0.5 9 3\nSTOP 1.\nPROBE a POINT stress_xx 0.5 0.5\nPROBE b POINT stress_xx 2.5 0.5\n" + NORMS + "END\n")
    if run.ok:
        checks.small(abs(run.history["b"][-1]/(-200000*1e-5*200) - 1), 1e-9, "given: the body with TEMPE")
        checks.small(abs(run.history["a"][-1]), 1e-9*400, "given: the other one stays")


WALL = ("TITLE wall\nSTATE AXISYM\nKINEM SMALL\nBLOCK {name} PL8TM 9 m{kind}\n   1. 0. 3. 0. 3.5 1. 1. 1.2\n   {n} 0.7 3 1.\nLAW m HEAT\n"
        "   TEMP 0.\n   20. 2.\n   TEMP 1000.\n   40. 3.\n{start}CONVE {name} 2 H 30. TS 20.\nSTRAT 0.01 1.E-6 0.01 9 1\nSTOP {stop}\nSAVE 1\n"
        "PROBE a NODE T 1. 0.\nPROBE b NODE T 3.5 1.\n" + NORMS + "END\n")


def go_on(checks):
    """Half, and the other half from there."""
    for kind in ("", " BILINEAR"):
        tag = kind.strip()
        whole = Run(checks, "whole" + tag, WALL.format(name="w", n=6, kind=kind, start="START T 800.\n", stop=0.2))
        half = Run(checks, "half" + tag, WALL.format(name="w", n=6, kind=kind, start="START T 800.\n", stop=0.1))
        if not (whole.ok and half.ok):
            continue
        other = f"START T FROM half{tag}/half{tag}.g01.h5 AT 0.1"
        rest = Run(checks, "rest" + tag, WALL.format(name="w", n=6, kind=kind, start=other + "\n", stop=0.1))
        named = Run(checks, "named" + tag, WALL.format(name="other", n=6, kind=kind, start=other + " other\n", stop=0.1))
        fine = Run(checks, "rest-fine" + tag, WALL.format(name="w", n=11, kind=kind, start=other + "\n", stop=0.1))
        mean = Run(checks, "mean" + tag, WALL.format(name="w", n=6, kind=kind, start=other.replace("AT 0.1", "AT 0.065") + "\n", stop=0.01))
        if rest.ok and named.ok and fine.ok and mean.ok:
            checks.small(np.max(np.abs(temperatures(rest)[1] - temperatures(whole)[1])), 1e-10*800, f"go_on{kind}: the whole")
            checks.that(np.array_equal(temperatures(rest)[1], temperatures(named)[1]), f"go_on{kind}: a body of another name")
            for probe in "ab":
                checks.small(abs(fine.history[probe][-1] - whole.history[probe][-1]), 4.0 if kind else 1.0, f"go_on{kind}: another mesh, {probe}")
            with mean.open() as file, half.open() as before:
                first = file["steps/000000/node/temperature"][()]
                expected = 0.5*(before["steps/000006/node/temperature"][()] + before["steps/000007/node/temperature"][()])
            checks.small(np.max(np.abs(first - expected)), 1e-10*800, f"go_on{kind}: between two instants")


def call(*options):
    """lagamine."""
    return subprocess.run([LAGAMINE, *options, "--quiet", "--threads", "1"], text=True, check=False, stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=LONGEST_RUN)


LINEAR = """TITLE linear along a bar, growing in time
STATE PLSTN
KINEM SMALL
BLOCK bar PL8TM 9 m
   0. 0. 4. 0. 4. 1. 0. 1.
   4 1. 2 1.
LAW m HEAT
   50. 1.E-9
IMPOS bar 4 T cold 20.
IMPOS bar 2 T hot 20.
START T 20.
LIC cold
   0. 1. 1. 3.
LIC hot
   0. 1. 1. 21.
STRAT 0.1 1.E-6 0.1 9 3
STOP 1.
SAVE 1
""" + NORMS + "END\n"
FREE = """TITLE bar on new meshes
STATE PLSTS 1.
KINEM LOG
BLOCK bar PL8LS 9 m
   0. 0. 4. 0. 4. 1. 0. 1.
   8 1. 3 1.
LAW m ELATH
   200000. 0.3 1.2E-3
TEMPE bar FROM linear/linear.g01.h5
FIXED bar 4 X
FIXED bar 1 Y
STRAT 0.1 1.E-6 0.1 9 3
STOP 1.
{remesh}PROBE t NODE T 4. 1.
PROBE ux NODE UX 4. 0.
PROBE s MEAN mises bar
""" + NORMS + "END\n"


def remeshed(checks):
    """T = 20 (1 + 2 t) at x = 0 to 20 (1 + 20 t) at x = 4, by matter: x is where a node was in the deck's own mesh."""
    other, one = Run(checks, "linear", LINEAR), Run(checks, "one-mesh", FREE.format(remesh=""))
    if not (other.ok and one.ok):
        return
    out = os.path.join(checks.folder, "meshes")
    deck = os.path.join(checks.folder, "meshes.lag")
    with open(deck, "w", encoding="utf-8") as file:
        file.write(FREE.format(remesh="REMSH\n   TIMES 0.35 0.65\n   SIZE 0.3 0.4\n"))
    result = cycle(deck, out)
    if not checks.that(result.returncode == DONE, "remeshed: the cycle ends by itself", said(result)):
        return
    checks.that([row["accepted"] for row in tries(out)] == ["y", "y"], "remeshed: two new meshes", tries(out))
    # the mesh of a remesh, before and after its steps: what is transferred, and what is read from the other run
    for name, time, tolerance in (("g02.start", 0.35, 1e-8), ("g03.start", 0.65, 1e-8), ("g02.end", 0.65, 1e-8), ("ckp", 1.0, 1e-8)):
        with h5py.File(os.path.join(out, f"meshes.{name}.h5")) as file:
            x = file["mesh/origin"][:, 0]
            values = file["fields/temperature/value"][:, 0]
        exact = 20 + 40*time + 360*time*x/4
        checks.small(np.max(np.abs(values - exact))/(360*time), tolerance, f"remeshed: temperatures of the material, {name}")
    columns = history(out)
    checks.small(abs(columns["ux"][-1]/one.history["ux"][-1] - 1), 2e-3, "remeshed: length of the bar as on one mesh")
    checks.small(abs(columns["t"][-1]/one.history["t"][-1] - 1), 1e-6, "remeshed: temperature of a corner")
    checks.small(abs(columns["s"][-1]/one.history["s"][-1] - 1), 0.05, "remeshed: thermal stress as on one mesh")


def resume(checks):
    """From the older checkpoint; and with another run behind it."""
    name = "bar-PLSTN"
    deck = os.path.join(checks.folder, "again.lag")
    with open(deck, "w", encoding="utf-8") as file:
        file.write(BAR.format(state="PLSTN", nx=8, ny=2, step=0.05, heat=f"TEMPE bar FROM {name}/{name}.g01.h5\n").replace(
            "SAVE 1\n", "SAVE 5\nCKPT 3\n"))
    out, again = os.path.join(checks.folder, "again"), os.path.join(checks.folder, "again-2")
    result = call(deck, "--out", out)
    if not checks.that(result.returncode == DONE, "resume: a run", result.stdout):
        return
    shutil.copytree(out, again)
    old = glob.glob(os.path.join(again, "*.ckp.1.h5"))[0]
    result = call(deck, "--out", again, "--resume", old)
    checks.that(result.returncode == DONE and not result_differences(out, again, previous=False), "resume: the same bits", result.stdout)
    changed = Run(checks, name, BAR.format(state="PLSTN", nx=8, ny=2, step=0.05, heat=OWN.format(kind="")).replace("LOG", "SMALL").replace(
        "START T 900.", "START T 901."))
    result = call(deck, "--out", again, "--resume", old)
    checks.that(changed.ok and result.returncode == INPUT, "resume: another run is refused", f"{result.returncode} {result.stdout}")


def refused(checks):
    """One line each."""
    folder = os.path.join(checks.folder, "refused")
    os.makedirs(folder)
    source = Run(checks, "refused/ok", WALL.format(name="w", n=2, kind="", start="START T 800.\n", stop=0.02))
    cold = Run(checks, "refused/cold", "TITLE c\nSTATE AXISYM\nKINEM SMALL\nBLOCK w PL8LS 9 m\n   1. 0. 3. 0. 3. 1. 1. 1.\n   1 1. 1 1.\nLAW m ELA\n"
               "   1. 0.\nFIXED w 1 Y\nMOVE w 3 Y up 0.01\nLIC up\n   0. 0. 1. 1.\nSTRAT 1. 0.1 1. 9 3\nSTOP 1.\nEND\n")
    # two operations: the mesh of the second begins at 0.01
    second = Run(checks, "refused/second", read(os.path.join(checks.folder, "refused/ok.lag")).replace(
        "STOP 0.02\n", "OPERA a\nSTOP 0.01\nOPERA b\nSTOP 0.01\n"))
    if not (source.ok and cold.ok and second.ok):
        return
    for kind in ("cut", "altered", "inner"):
        shutil.copytree(source.out, os.path.join(folder, kind))
        os.rename(os.path.join(folder, kind, "ok.g01.h5"), os.path.join(folder, kind, kind + ".g01.h5"))
        os.rename(os.path.join(folder, kind, "ok.g01"), os.path.join(folder, kind, kind + ".g01"))
    with open(os.path.join(folder, "cut", "cut.g01.h5"), "r+b") as file:
        file.truncate(3000)
    with open(os.path.join(folder, "altered", "altered.g01.h5"), "r+b") as file:
        file.seek(2000)
        file.write(b"!!")
    os.remove(os.path.join(folder, "inner", "inner.g01", "000001.h5"))
    heat = WALL.format(name="w", n=2, kind="", start="{}\n", stop=0.02)
    solid = ("TITLE s\nSTATE AXISYM\nKINEM SMALL\nBLOCK w PL8LS 9 m\n   {place}\n   1 1. 1 1.\nLAW m ELATH\n   1. 0. 1.E-5\n{card}\n"
             "FIXED w 1 Y\nSTRAT 0.01 0.001 0.01 9 3\nSTOP {stop}\n{more}END\n")
    here, apart = "1. 0. 3. 0. 3. 1. 1. 1.", "1. 0. 3. 0. 3. 2. 1. 2."
    good = "TEMPE w FROM ok/ok.g01.h5"

    def of(place=here, card=good, stop=0.02, more=""):
        return solid.format(place=place, card=card, stop=stop, more=more)

    cases = {
        "sound": (of(), None), "start": (heat.format("START T FROM ok/ok.g01.h5 AT 0.015"), None),
        "missing": (of(card="TEMPE w FROM none/none.g01.h5"), "no such file"),
        "folder": (of(card="TEMPE w FROM ok"), "a directory, where a file is wanted"), "no file": (of(card="TEMPE w FROM"), "expected the file of a run"),
        "more": (of(card=good + " 2."), "expected AT"), "still more": (of(card=good + " AT 0. 2."), "expected the end of the line"),
        "cut": (of(card="TEMPE w FROM cut/cut.g01.h5"), "cut short or damaged"),
        "altered": (of(card="TEMPE w FROM altered/altered.g01.h5"), "altered or damaged"),
        "instant": (of(card="TEMPE w FROM inner/inner.g01.h5"), "000001.h5"),
        "no heat": (of(card="TEMPE w FROM cold/cold.g01.h5"), "no body of this run conducts heat"),
        "checkpoint": (of(card="TEMPE w FROM ok/ok.ckp.h5"), "no body of this run conducts heat"),
        "short": (of(stop=0.03), "before the end of this scene"),
        "later": (of(card=good + " AT 0.005", stop=0.015), None),
        "later short": (of(card=good + " AT 0.005"), "before the end of this scene at 0.02, 0.025 of that run"),
        "beyond": (of(card=good + " AT 0.03"), "the instant of that run at which this scene begins, 0 to 0.02"),
        "no AT": (of(card="TEMPE w FROM second/second.g02.h5", stop=0.01), "is at 0.01: expected AT, and the instant"),
        "too early": (of(card="TEMPE w FROM second/second.g02.h5 AT 0.005", stop=0.01), "0.01 to 0.02"),
        "second": (of(card="TEMPE w FROM second/second.g02.h5 AT 0.01", stop=0.01), None),
        "shared": (of(card=good + "\nBLOCK v PL8LS 9 m\n   3. 0. 4. 0. 4. 1. 3. 1.\n   1 1. 1 1.\nJOIN w 2 v 4\n"
                      "TEMPE v FROM ok/ok.g01.h5 AT 0.001", stop=0.01), "of the same run at the same instants"),
        "apart": (of(place=apart), "away from the mesh of 'ok/ok.g01.h5'"),
        "twice": (of(card=good + "\n" + good), "the temperature of 'w' is given twice"),
        "unknown": (of(card=good + "\nADDEL w PL8TM h\nLAW h HEAT\n   1. 1."), "the temperature of w is an unknown of this scene"),
        "imposed": (of(more="IMPOS w 1 T lic\nLIC lic\n   0. 1.\n"), "nodes here are of a body without temperature"),
        "theta": (of(more="THETA 1.\n"), "no body of this scene has a temperature among its unknowns"),
        "solve": (of(more="SOLVE MONOLITHIC\n"), "there is nothing to couple"),
        "remesh": (of(more="REMSH\n   TIMES 0.01\n"), None),
        "no instant": (heat.format("START T FROM ok/ok.g01.h5"), "expected AT"),
        "too late": (heat.format("START T FROM ok/ok.g01.h5 AT 0.03"), "0.03"),
        "no body": (heat.format("START T FROM ok/ok.g01.h5 AT 0.02 ww"), "expected the name of a body"),
        "two starts": (heat.format("START T 20.\nSTART T FROM ok/ok.g01.h5 AT 0.02"), "is given twice"),
    }
    for name, (text, wanted) in cases.items():
        deck = os.path.join(folder, "deck.lag")
        with open(deck, "w", encoding="utf-8") as file:
            file.write(text)
        result = call(deck, "--check")
        lines = [line for line in result.stdout.splitlines() if "deck.lag:" in line]
        if wanted is None:
            checks.that(result.returncode == DONE, f"refused: {name} is accepted", result.stdout)
        else:
            checks.that(result.returncode == INPUT and len(lines) == 1 and wanted in lines[0], f"refused: {name}", result.stdout)


def main():
    """All of them."""
    checks = Checks()
    tube(checks)
    bar(checks)
    between(checks)
    given(checks)
    go_on(checks)
    remeshed(checks)
    resume(checks)
    refused(checks)
    checks.end()


if __name__ == "__main__":
    main()
