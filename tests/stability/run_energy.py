#!/usr/bin/env python3
"""Books of energy: how much of the work is missing in shipped decks, and how it falls with the step.

usage: run_energy.py [-v] [-k]       -v prints every check, -k keeps the results

Each deck runs with steps of one length, of half of it, and of half of that. What is missing between the work that comes in and what
is stored and dissipated is the error of the path within the steps: of first order or better. The table has it in percent of the work
that passed (`energy_imbalance`), and by how much the second and the third run are better than the one before.

Then runs that other books cannot close: bars heated with moduli and expansion by temperature, held and free (no work from outside,
none at all; no drift of volume either), and a block under stress that a die turns by two radians (a rotation makes no work).

Last a block pressed and left by its die, a rigid one and a body, in steps of which the die leaves it in the first tenth or less: what is
missing is that of the pressing, however far the die goes in them. And a strip bent over a knife edge, past which its nodes slide.
"""
import json
import os
import re
import sys

import numpy as np

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), os.pardir, "patch"))
from patch_support import SOURCE, Checks, Run  # noqa: E402

# Deck, and the length of the longest steps.
DECKS = {"upsetting": ("upsetting/upsetting", 0.01), "ring": ("ring/ring", 0.016), "rib": ("forging_rib/forging_rib", 0.004),
         "press fit": ("press_fit/press_fit", 0.02), "necking": ("necking/necking", 0.02)}
# Iterations of a step that are not too many: steps keep their length.
MANY = 40
# The imbalance of the run with the longest steps, and how much better a run with half the step must be.
WORST, BETTER = 0.01, 1.8
# The same, and drift of volume, of runs whose steps are straight but for terms of second order.
OTHERS = 5e-4


def imbalance(checks, deck, step):
    """`energy_imbalance` of a deck with steps of one length."""
    with open(os.path.join(SOURCE, "decks", deck + ".lag"), encoding="utf-8") as file:
        text = file.read()
    text, n = re.subn(r"(?m)^STRAT +\S+ +(\S+) +\S+ +\d+", rf"STRAT  {step} \1 {step} {MANY}", text)
    text = re.sub(r"(?m)^PARAM  dt .*\n", "", text)
    checks.that(n == 1, f"{deck} has one STRAT")
    run = Run(checks, f"energy-{os.path.basename(deck)}-{step}", text)
    if not run.ok:
        return None
    with open(os.path.join(run.out, "summary.json"), encoding="utf-8") as summary:
        return abs(json.load(summary)["checks"]["energy_imbalance"])


HEATED = """TITLE  A heated bar
STATE  {state}
KINEM  {kinematics}
BLOCK  bar PL8LS 4 warm
   0. 0.   2. 0.   2. 3.   0. 3.
   2 1.   2 1.
LAW    warm ELATH
   TEMP 20.
   200000. 0.3   1.1E-5
   TEMP 600.
   140000. 0.28   1.5E-5
   TEMP 1200.
   60000. 0.3   2.E-5
TEMPE  bar 1. heat
LIC    heat
   0. 20.   1. 1200.   2. 300.
FIXED  bar 1 Y
FIXED  bar 4 X
{held}
STRAT  0.05 1.E-6 0.05   9 3
NORMS  FORCE 1.E-9 DISPL 1.E-9
END
"""

TURNED = """TITLE  A block under pressure, turned
STATE  PLSTN
KINEM  {kinematics}
BLOCK  block PL8LS 4 metal
   -1. 0.   1. 0.   1. 1.   -1. 1.
   4 1.   2 1.
LAW    metal ELA
   1000. 0.3
LAW    glue GLUE2D
   PENETR 1.E-3
DIE    table PILOT 0. 0.
   SEGM  -2. 0.   2. 0.
CNT2D  block 1 table 2 glue
PRES2D block 3 2 1. load
MOVE   table A turn 2.
LIC    load
   0. 0.   1. 1.   4. 1.
LIC    turn
   0. 0.   1. 0.   4. 1.
STRAT  0.05 1.E-6 0.05   9 3
END
"""


def books(checks, name, text):
    """Imbalance and drift of volume of a run."""
    run = Run(checks, name, text)
    if not run.ok:
        return
    with open(os.path.join(run.out, "summary.json"), encoding="utf-8") as file:
        summary = json.load(file)
    imbalance, drift = (abs(summary["checks"][key]) for key in ("energy_imbalance", "volume_drift_unloaded"))
    print(f"{name:22s} missing {100*imbalance:9.2e} %   drift of volume {drift:9.2e}")
    checks.small(imbalance, OTHERS, f"{name}: missing")
    checks.small(drift, OTHERS, f"{name}: drift of volume")
    checks.that("energy_imbalance" not in summary["advice"], f"{name}: no warning")


def others(checks):
    """Heat, rotation, loading and unloading."""
    for state in ("PLSTN", "AXISYM", "PLSTS"):
        for kinematics in ("LOG", "JAUMANN", "SMALL"):
            for held in ("", "FIXED  bar 3 Y", "FIXED  bar 3 Y\nFIXED  bar 2 X"):
                books(checks, f"heat-{state}-{kinematics}-{held.count('FIXED')}",
                      HEATED.format(state=state, kinematics=kinematics, held=held))
    for kinematics in ("LOG", "JAUMANN"):
        books(checks, f"turned-{kinematics}", TURNED.format(kinematics=kinematics))


SNAP = """TITLE snap fit: a catch slides over a hook and it springs back
STATE PLSTN
KINEM LOG
BLOCK b1 PL8LS 4 plastic
 0. 0. 24. 0. 24. 2. 0. 2.
 24 1. 3 1.
BLOCK b2 PL8LS 4 plastic
 24. 0. 28. 0. 28. 2. 24. 2.
 8 1. 3 1.
BLOCK b3 PL8LS 4 plastic
 28. 0. 30. 0. 30. 2. 28. 2.
 2 1. 3 1.
BLOCK hook PL8LS 4 plastic
 24. 2. 28. 2. 26. 3.2 24.5 3.2
 8 1. 3 1.
JOIN b1 2 b2 4
JOIN b2 2 b3 4
JOIN hook 1 b2 3
LAW plastic ELA
 2500. 0.35
LAW film COUL2D
 PENETR 1.E-3 PHI 0.1
DIE catch PILOT 40. 2.3
 SEGM 42. 12. 41. 2.3
 FILLT 0.3 1.E-3
 SEGM 41. 2.3 40. 2.3
 FILLT 0.3 1.E-3
 SEGM 40. 2.3 36. 6.
CNT2D hook 2 3 4 catch film
CNT2D b3 3 catch film
CNT2D b1 3 catch film
FIXED b1 4 XY
LIC go
 0. 0. 1. -20.
MOVE catch X go
STRAT 0.005 1.E-7 {step} 6 3
PROBE tip NODE Y 30. 0.
SAVE 20
END
"""
LIFTED = """TITLE  A block pressed, and left by the die
STATE  {state}
KINEM  LOG
BLOCK  b PL8LS 4 steel
   0. 0.   10. 0.   10. 10.   0. 10.
   5 1.   5 1.
LAW    steel EPLA
   200000. 0.3
   LINEAR 300. 500.
LAW    rough COUL2D
   PENETR 1.E-3   PHI 0.2
{die}
FIXED  b 1 Y
FIXED  b 4 X
LIC    way
   0. 0.   1. -1.   1.05 {up}
STRAT  0.02 1.E-6 0.05   9 3
STOP   1.05
END
"""
LEAVING = {"rigid": "DIE    d PILOT 0. 10.\n   SEGM  30. 10.   -5. 10.\nCNT2D  b 3 d -3 rough\nMOVE   d Y way",
           "body": "BLOCK  t PL8LS 4 tool\n   0. 10.   20. 10.   20. 15.   0. 15.\n   7 1.   2 1.\nLAW    tool ELA\n   200000. 0.3\n"
                   "DIE    d SIDES t 1\nCNT2D  b 3 d rough\nFIXED  t 4 X\nMOVE   t 3 Y way"}

KNIFE = """TITLE  A strip bent over a knife edge, its nodes slide past it
STATE  PLSTN
KINEM  LOG
BLOCK  strip PL8LS 4 steel
   0. 0.   30. 0.   30. 2.   0. 2.
   80 1.   4 1.
LAW    steel EPLA
   200000. 0.3
   SWIFT 500. 0.004 0.15
LAW    film COUL2D
   PHI 0.1
DIE    knife
   SEGM 20. -4.   24. 0.
   SEGM 24. 0.   28. -4.
DIE    punch PILOT 0. 2.
   ARC 1.5 5.-3*sqrt(3)/2   0. 2.   -1.5 5.-3*sqrt(3)/2   1.E-4
CNT2D  strip 1 knife film
CNT2D  strip 3 punch film
FIXED  strip 4 X
LIC    down
   0. 0.   0.2 -1.
MOVE   punch Y down
STRAT  0.005 1.E-7 0.02   6 3
END
"""


def past_a_knife(checks):
    """A node beyond a corner has lost most of its pressure there: as it opens the trapezoidal rule is taken of what was left of it."""
    run = Run(checks, "knife", KNIFE)
    if not run.ok:
        return
    with open(os.path.join(run.out, "summary.json"), encoding="utf-8") as file:
        summary = json.load(file)
    checks.small(abs(summary["checks"]["energy_imbalance"]), 5e-3, "knife: balance of energy")
    work = np.diff(run.history["external_work"])
    checks.that(work.min() > 0, "knife: a punch that only presses does work in every step", work.min())


def lifted(checks):
    """What is missing is the same for dies that leave by a tenth, by half, and by twenty times the height of the block."""
    for state in ("AXISYM", "PLSTN"):
        for kind, die in LEAVING.items():
            missing, passed = [], 0.0
            for up in (-0.9, -0.5, 20.0):
                run = Run(checks, f"lifted-{state}-{kind}-{up}", LIFTED.format(state=state, die=die, up=up))
                if not run.ok:
                    return
                with open(os.path.join(run.out, "summary.json"), encoding="utf-8") as file:
                    summary = json.load(file)
                missing.append(summary["energy"]["missing"])
                passed = summary["energy"]["external_work"]
            print(f"lifted-{state}-{kind:6s} missing", " ".join(f"{100*one/passed:.4f}" for one in missing), "% of the work")
            checks.small(max(map(abs, missing))/passed, 3e-3, f"lifted-{state}-{kind}: missing")
            checks.small((max(missing) - min(missing))/passed, 1e-5, f"lifted-{state}-{kind}: however far the die goes")


def snaps_free(checks):
    """What a hook releases when it snaps over a catch is missing however short the steps are, and is told as that."""
    missing = []
    for step in (0.02, 0.005):
        run = Run(checks, f"snap-{step}", SNAP.format(step=step))
        if not run.ok:
            return
        with open(os.path.join(run.out, "summary.json"), encoding="utf-8") as file:
            summary = json.load(file)
        missing.append(summary["energy"]["missing"])
        advice = summary["advice"]["energy_imbalance"]
        checks.that("released suddenly" in advice, f"snap, steps of {step}: told", advice)
    # what the beam holds just before, by both runs
    checks.that(missing[0] > 0 and 0.5 < missing[1]/missing[0] < 1.5, "snap: it does not fall with the step", missing)


def main():
    checks = Checks()
    others(checks)
    lifted(checks)
    past_a_knife(checks)
    snaps_free(checks)
    print(f"{'deck':12s} {'step':>7s} {'missing %':>10s} {'half':>9s} {'better':>7s} {'quarter':>9s} {'better':>7s}")
    for name, (deck, step) in DECKS.items():
        found = [imbalance(checks, deck, step/division) for division in (1, 2, 4)]
        if None in found:
            continue
        better = [found[0]/found[1], found[1]/found[2]]
        print(f"{name:12s} {step:7.3g} {100*found[0]:10.5f} {100*found[1]:9.5f} {better[0]:7.2f} {100*found[2]:9.5f} {better[1]:7.2f}")
        checks.small(found[0], WORST, f"{name}: missing")
        for value, what in zip(better, ("half", "quarter")):
            checks.that(value >= BETTER, f"{name}: better by {BETTER} at {what} the step", value)
    checks.end()


if __name__ == "__main__":
    main()
