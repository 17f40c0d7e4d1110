#!/usr/bin/env python3
"""Heat and motion together: ways of coupling, threads, stop and resume, remeshing.

usage: run_coupling.py [-v] [-k]

- `bar`: a thermoelastic block heated at one end and squeezed. In turns until nothing changes (SOLVE CONVERGE) is the answer of all
  together (MONOLITHIC); in turns once (ONCE) differs in proportion to the step. The monolithic Newton method converges
  quadratically: r3 <= C r2^2 with one C for all steps, as in tests/runs/run_newton.py.
- The same bits by any number of threads, and resumed from a checkpoint on the way.
- `wall`: a scene of heat alone has no displacements, and no state of points.
- `tube`: of a steel quenched in its bore, MONOLITHIC: where temperatures alone are out of balance at first, and the motion follows them, no
  correction counts as one past a limit point, and none is searched to death: no step is cut back.
- `judged`: the same tube; the error in time that MONOLITHIC states is that of CONVERGE, and within a factor 2 of what shorter steps
  change, without `TOL` and with it.
- `billet`: hot, pressed and remeshed twice by lagacycle; the content of heat, the integral of T over the volume, is that of the old
  mesh to 1e-3, and temperatures stay within their old bounds to 1e-3 of their range (shape functions of 8 nodes pass between nodes).
"""
import glob
import json
import os
import re
import shutil
import sys

sys.dont_write_bytecode = True
TESTS = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path[:0] = [os.path.join(TESTS, folder) for folder in ("heat", "patch", "runs", "cycle")]
from hardening_steel import hardening_steel  # noqa: E402
from patch_support import Checks, at_points, h5py, np  # noqa: E402
from remeshed import cycle, tries  # noqa: E402
from support import DONE, history, result_differences, run, said, write  # noqa: E402

TUBE = """TITLE  A tube quenched in its bore
STATE  AXISYM
KINEM  SMALL
BLOCK  bar PL8LS 4 steel
   15. 0.  30. 0.  30. 5.  15. 5.
   8 1.  1 1.
LAW    steel ARBTHMET
   STEEL base.met base
   STRESS 1.
ADDEL  bar PL8TM heat BILINEAR
LAW    heat META
   STEEL base.met base
   ENERGY 1.
START  T 860.
FIXED  bar 1 Y
CONVE  bar 4 H 5. TS 20.
SOLVE  MONOLITHIC
STRAT  0.01 1.E-6 {step} 9 3
STOP   40.
NORMS  FORCE 1.E-9 DISPL 1.E-8
PROBE  outside POINT stress_zz 30. 0.
END
"""
BAR = """TITLE  Thermoelastic block: heated at one end, squeezed
STATE  PLSTN
PARAM  step 1.E-3
KINEM  LOG
BLOCK  b PL8LS 9 steel
   0. 0.  1. 0.  1. 0.5  0. 0.5
   6 1.  3 1.
LAW    steel ELATH
   200000. 0.3 1.2E-5
ADDEL  b PL8TM heat
LAW    heat HEAT
   50. 3.6
   SOURCE 2.5E3
START  T 300.
IMPOS  b 4 T hot 300.
FIXED  b 1 Y
FIXED  b 4 X
MOVE   b 2 X push -0.02
LIC    hot
   0. 1.  1.E-3 1.5  1. 1.5
LIC    push
   0. 0.  0.008 1.
STOP   0.008
STRAT  $step 1.E-6 $step 4 3
NORMS  FORCE 1.E-10 DISPL 1.E-10
SOLVE  {solve}
PROBE  mid NODE T 0.5 0.25
PROBE  far NODE T 1. 0.25
PROBE  sx POINT stress_xx 0.5 0.25
PROBE  uy NODE UY 0.5 0.5
SAVE   10
CKPT   3
END
"""
PROBES = ("mid", "far", "sx", "uy")
WAYS = ("ONCE", "CONVERGE", "MONOLITHIC")

WALL = """TITLE  Heat alone
STATE  PLSTN
KINEM  SMALL
BLOCK  wall PL8TM 4 brick BILINEAR
   0. 0.  1. 0.  1. 0.5  0. 0.5
   4 1.  2 1.
LAW    brick HEAT
   2. 1000.
IMPOS  wall 4 T hot 100.
START  T 20.
LIC    hot
   0. 0.2  100. 1.
STRAT  20. 1. 20. 4 3
STOP   200.
PROBE  far NODE T 1. 0.5
CKPT   3
END
"""

BILLET = """TITLE  Billet with heat, remeshed
STATE  AXISYM
KINEM  LOG
BLOCK  billet PL8LS 4 steel
   0. 0.  10. 0.  10. 15.  0. 15.
   6 1.   9 1.
LAW    steel EPLA
   200000. 0.3
   LINEAR 700. 300.
ADDEL  billet PL8TM heat
LAW    heat HEAT
   50. 3.6
START  T 1000.
LAW    rough  COUL2D
   PENETR 1.E-3   PHI 0.2
DIE    upper  PILOT 0. 15.
   SEGM  30. 15.   -1. 15.
CNT2D  billet 3  upper -3 rough
IMPOS  billet 3 T cold
FIXED  billet 1 Y
FIXED  billet 4 X
LIC    press
   0. 0.     1. -6.
LIC    cold
   0. 1000.  1. 500.
MOVE   upper Y press
STRAT  0.05  1.E-5  0.1   4 3
STOP   0.7
REMSH
   TIMES 0.3 0.6
PROBE  core NODE T 0. 0.
END
"""


def call(checks, deck, out, *options):
    """One run; whether it was done."""
    result = run([deck, "--out", out, *options])
    return checks.that(result.returncode == DONE, f"{os.path.basename(out)}: done", said(result))


def ends(folder):
    """Values of the probes at the end."""
    columns = history(folder)
    return np.array([columns[name][-1] for name in PROBES])


def couplings(checks, decks):
    """CONVERGE is MONOLITHIC; ONCE is first order in the step."""
    errors = []
    for step in ("1.E-3", "5.E-4", "2.5E-4"):
        found = {}
        for way in WAYS:
            out = os.path.join(checks.folder, f"bar-{way}-{step}")
            if call(checks, decks[way], out, "--threads", "1", "-p", f"step={step}"):
                found[way] = ends(out)
        if len(found) < 3:
            return
        whole = found["MONOLITHIC"]
        checks.small(np.max(np.abs(found["CONVERGE"]/whole - 1)), 1e-7, f"step {step}: CONVERGE is MONOLITHIC")
        errors.append(abs(found["ONCE"][1] - whole[1]))
    orders = np.log2(np.array(errors[:-1])/np.array(errors[1:]))
    checks.that(errors[0] > 1e-3 and np.all(np.abs(orders - 1) < 0.3), "ONCE: first order in the step", f"{orders}, {errors}")


def quadratic(checks, folder):
    """Residuals of the monolithic steps, the first of a step (the predictor's) left out."""
    with open(glob.glob(os.path.join(folder, "*.log"))[0], encoding="utf-8") as file:
        listing = file.read()
    constants = []
    for part in re.split(r"(?m)^step ", listing)[1:]:
        residuals = [float(row) for row in re.findall(r"(?m)^ +\d+ +(\d\.\d+E[+-]\d+)", part)][1:]
        constants += [b/a**2 for a, b in zip(residuals, residuals[1:]) if 1e-9 < a < 1e-2 and b > 0]
    checks.that(len(constants) >= 2 and max(constants) < 1, "monolithic: quadratic", constants)


def same_bits(checks, decks):
    """Threads, and a run resumed from its older checkpoint."""
    for name, deck in decks.items():
        whole = os.path.join(checks.folder, f"{name}-one")
        two = os.path.join(checks.folder, f"{name}-two")
        if not (call(checks, deck, whole, "--threads", "1") and call(checks, deck, two, "--threads", "2")):
            continue
        wrong = result_differences(whole, two)
        checks.that(not wrong, f"{name}: the same bits with 1 and 2 threads", "; ".join(wrong))
        old = glob.glob(os.path.join(whole, "*.ckp.1.h5"))[0]
        again = os.path.join(checks.folder, f"{name}-again")
        shutil.copytree(whole, again)
        with h5py.File(old, "r") as file:
            step = int(file["progress"].attrs["step"])
        checks.that(0 < step < len(history(whole)["step"]), f"{name}: a checkpoint on the way", step)
        if call(checks, deck, again, "--threads", "1", "--resume", os.path.join(again, os.path.basename(old))):
            wrong = result_differences(whole, again, previous=False)
            checks.that(not wrong, f"{name}: resumed, as in one go", "; ".join(wrong))


def heat_alone(checks, folder):
    """What is not there is not stored."""
    with h5py.File(glob.glob(os.path.join(folder, "*.ckp.h5"))[0], "r") as file:
        checks.that(file["fields/displacement/value"].shape[0] == 0, "heat alone: no displacements in the checkpoint")
        checks.that(file["fields/temperature/value"].shape == (len(file["mesh/labels"]), 1), "heat alone: temperatures of all nodes")
        states = [file[f"groups/{key}/state"].size for key in file["groups"] if "state" in file["groups"][key]]
        checks.that(sum(states) == 0, "heat alone: no state of points", states)


def content(path):
    """Integral of the temperature over the volume (per radian), and the least and largest of a checkpoint's mesh."""
    with h5py.File(path, "r") as file:
        temperature = file["fields/temperature/value"][()][:, 0]
        x = file["mesh/coordinates"][()] + file["fields/displacement/value"][()]
        elements = file["groups/1/connectivity"][()] - 1
    places, values, _, areas = at_points(x[elements], np.stack([temperature[elements]]*2, axis=-1), 3)
    return np.sum(areas*places[..., 0]*values[..., 0]), temperature.min(), temperature.max()


def remeshed(checks):
    """The heat of a billet from mesh to mesh."""
    deck, out = write(os.path.join(checks.folder, "billet.lag"), BILLET), os.path.join(checks.folder, "billet")
    result = cycle(deck, out)
    checks.that(result.returncode == DONE, "billet: lagacycle", said(result))
    checks.that([row["accepted"] for row in tries(out)].count("y") == 2, "billet: two new meshes", tries(out))
    for generation in (1, 2):
        before = os.path.join(out, f"billet.g{generation:02}.end.h5")
        after = os.path.join(out, f"billet.g{generation + 1:02}.start.h5")
        if not checks.that(os.path.exists(before) and os.path.exists(after), f"billet: checkpoints of remesh {generation}"):
            continue
        (old, low, high), (new, least, most) = content(before), content(after)
        checks.small(abs(new/old - 1), 1e-3, f"billet: heat across remesh {generation}")
        slack = 1e-3*(high - low)
        checks.that(low - slack <= least and most <= high + slack, f"billet: bounds of the temperature, remesh {generation}",
                    f"{least} to {most}, were {low} to {high}")
    if result.returncode == DONE:
        core = history(out)["core"]
        checks.that(all(b <= a + 0.1 for a, b in zip(core, core[1:])), "billet: the core cools all the while")


def tube(checks):
    """Steps of three lengths: the work of a correction is that of the matrix of the motion, which temperatures have no part in."""
    write(os.path.join(checks.folder, "base.met"), hardening_steel("base", 1500, 6000))
    for step in (1, 2, 5):
        deck = write(os.path.join(checks.folder, f"tube_{step}.lag"), TUBE.format(step=step))
        result = run([deck, "--out", os.path.join(checks.folder, f"tube_{step}")])
        if checks.that(result.returncode == DONE, f"tube, steps of {step}: done", said(result)):
            rows = history(os.path.join(checks.folder, f"tube_{step}"))
            checks.that(rows["cutbacks"][-1] == 0, f"tube, steps of {step}: no cutback", rows["cutbacks"][-1])
            checks.small(abs(rows["outside"][-1]/137 - 1), 0.02, f"tube, steps of {step}: hoop stress")


def judged(checks):
    """The error in time of the heat, stated with the motion in one system and in turns: on the same steps, and in the end against short ones."""
    def stated(name, way, first, longest, bound):
        """Errors that a run states, and its mean temperature at the end."""
        text = TUBE.format(step=longest).replace("SOLVE  MONOLITHIC\n", f"SOLVE  {way}\n{bound}PROBE  mean MEAN T bar\n")
        out = os.path.join(checks.folder, f"judged-{name}-{way}")
        if not call(checks, write(out + ".lag", text.replace("STRAT  0.01", f"STRAT  {first}")), out):
            return None, np.nan
        with open(os.path.join(out, "summary.json"), encoding="utf-8") as file:
            return json.load(file)["accuracy"].get("heat"), history(out)["mean"][-1]

    _, mean = stated("short", "MONOLITHIC", 0.01, 0.05, "")
    for name, first, longest, bound in (("steps of 0.5", 0.5, 0.5, ""), ("TOL 0.3", 0.01, 2, "THETA  1. TOL 0.3\n")):
        folder = name.replace(" ", "_")
        turns, _ = stated(folder, "CONVERGE", first, longest, bound)
        system, found = stated(folder, "MONOLITHIC", first, longest, bound)
        if not checks.that(bool(system and turns), f"judged, {name}: the error in time is stated", system):
            continue
        for which in ("end", "largest"):
            checks.small(abs(system[which]/turns[which] - 1), 1e-4, f"judged, {name}: {which}, as in turns")
        checks.that(0.5*abs(found - mean) < system["end"] < 2*abs(found - mean), f"judged, {name}: error at the end, {found - mean:.3g} found", system["end"])


def main():
    checks = Checks()
    decks = {way: write(os.path.join(checks.folder, f"bar_{way}.lag"), BAR.format(solve=way)) for way in WAYS}
    couplings(checks, decks)
    decks["wall"] = write(os.path.join(checks.folder, "wall.lag"), WALL)
    same_bits(checks, decks)
    quadratic(checks, os.path.join(checks.folder, "MONOLITHIC-one"))
    heat_alone(checks, os.path.join(checks.folder, "wall-one"))
    tube(checks)
    judged(checks)
    remeshed(checks)
    checks.end()


if __name__ == "__main__":
    main()
