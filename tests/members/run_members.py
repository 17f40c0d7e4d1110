#!/usr/bin/env python3
"""Laws of another program: members beside the library, without a change of it, on decks against closed forms.

usage: run_members.py [-v] [-k]

The program (tests/members/driver) is the solver with member lists of its own:
- STEEL5, a law for solids with five numbers of hardening, driven by a field `hydrogen`, with a relation between two numbers of its
  card. A bar drawn in plane stress while hydrogen enters: stress = yield(p) (1 - WEAK c), p = strain - stress/E, at all points.
- WORN, a contact law with history, driven by the temperature. A block under pressure whose die is drawn along it: every point obeys
  tau = phi(T, s) p with the way s of the step before, and the force is that of the way the die went, but for the elastic slip.
Both go on from a checkpoint bit for bit; a wrong card, and a driver that nothing in the scene gives, are reported.
"""
import math
import os
import subprocess
import sys

sys.dont_write_bytecode = True
TESTS = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path[:0] = [os.path.join(TESTS, folder) for folder in ("patch", "runs")]
from patch_support import BIN, Checks, h5py, np  # noqa: E402
from support import history, write  # noqa: E402

PROGRAM = os.path.join(os.path.dirname(os.path.abspath(BIN)), "tests", "members")

E, NU = 200000.0, 0.3
HARDENING = {"RE": 250.0, "Q1": 300.0, "B1": 2.0, "Q2": 80.0, "B2": 60.0}
WEAK = 0.02
BAR = f"""TITLE  A bar drawn while hydrogen enters
STATE  PLSTS 1.
KINEM  SMALL
BLOCK  bar PL8LS 4 steel
   0. 0.  2. 0.  2. 1.  0. 1.
   2 1.  1 1.
LAW    steel STEEL5
   {E} {NU}
   {' '.join(str(v) for v in HARDENING.values())} {WEAK}
ADDEL  bar PL8HY diffusion
LAW    diffusion HEAT
   1.E9 1.
START  H 1.
IMPOS  bar 1 H entry
IMPOS  bar 3 H entry
FIXED  bar 4 X
FIXED  bar 1 Y
MOVE   bar 2 X pull 0.08
LIC    entry
   0. 1.  1. 9.
LIC    pull
   0. 0.  1. 1.
STOP   1.
STRAT  0.05 1.E-4 0.05 5 3
NORMS  FORCE 1.E-10 DISPL 1.E-10
PROBE  stress POINT stress_xx 1. 0.5
PROBE  pull REACT X bar 2
SAVE   1
CKPT   10
END
"""

PHI, SOFT, RISE, WAY = 0.2, 1.0e-3, 0.5, 0.4
PRESSURE, LENGTH, GOES = 20.0, 4.0, 1.0
BLOCK = f"""TITLE  A die drawn along a block under pressure
STATE  PLSTN
KINEM  LOG
BLOCK  block PL8LS 4 steel
   0. 0.  {LENGTH} 0.  {LENGTH} 0.5  0. 0.5
   8 1.  1 1.
LAW    steel ELATH
   1.E6 0. 0.
TEMPE  block 1. warm
LAW    coat WORN
   PENETR 1.E-5   PHI0 {PHI}   SOFT {SOFT}   RISE {RISE}   WAY {WAY}
DIE    plate
   SEGM   -100. 1.E-6   100. 1.E-6
CNT2D  block 1 plate 2 coat
PRES2D block 3 2 {PRESSURE} on
FIXED  block 2 X
FIXED  block 4 X
MOVE   plate X draw -{GOES}
LIC    on
   0. 0.  0.1 1.
LIC    draw
   0. 0.  0.1 0.  1.1 1.
LIC    warm
   0. 100.  0.1 100.  1.1 500.
STOP   1.1
STRAT  0.02 1.E-5 0.02 8 3
NORMS  FORCE 1.E-10 DISPL 1.E-10
SAVE   1
CKPT   20
END
"""


def go(checks, name, text, *arguments, code=0):
    """Run the program on a deck: its folder and what it said."""
    path = os.path.join(checks.folder, name + ".lag")
    write(path, text)
    out = os.path.join(checks.folder, name)
    done = subprocess.run([PROGRAM, path, "--out", out, *arguments], text=True, capture_output=True, timeout=120, check=False,
                          stdin=subprocess.DEVNULL)
    said = done.stdout + done.stderr
    checks.that(done.returncode == code, f"{name} {' '.join(arguments[:1])} ends with {code}", said[-400:])
    return out, said


def stress_of(strain, hydrogen):
    """Stress of the bar by bisection of stress = yield(strain - stress/E) (1 - WEAK c)."""
    low, high = 0.0, E*strain
    for _ in range(200):
        middle = 0.5*(low + high)
        p = strain - middle/E
        h = HARDENING
        flow = h["RE"] + h["Q1"]*(1 - math.exp(-h["B1"]*p)) + h["Q2"]*(1 - math.exp(-h["B2"]*p))
        if middle < flow*(1 - WEAK*hydrogen):
            low = middle
        else:
            high = middle
    return low


def bar(checks):
    """STEEL5."""
    out, _ = go(checks, "bar", BAR)
    rows = history(out)
    worst = max(abs(stress/stress_of(0.04*time, 1 + 8*time) - 1) for time, stress in zip(rows["time"], rows["stress"]) if time > 0)
    checks.small(worst, 1e-8, "bar: stress at every instant by the closed form")
    checks.that(len(rows["time"]) > 15, "bar: all steps", len(rows["time"]))
    resumed(checks, "bar", BAR, out)


def resumed(checks, name, text, out):
    """Resumed from the checkpoint before the last: the same bits."""
    again, _ = go(checks, name + "_again", text, "--resume", os.path.join(out, name + ".ckp.1.h5"))
    one, two = history(out), history(again)
    checks.that(0 < len(two["time"]) < len(one["time"]), f"{name}: resumed on the way", len(two["time"]))
    wrong = [key for key, column in two.items() if column != one[key][-len(column):]]
    checks.that(not wrong, f"{name}: resumed bit for bit", wrong)


def block(checks):
    """WORN."""
    out, _ = go(checks, "block", BLOCK)
    rows = history(out)
    files = sorted(os.listdir(os.path.join(out, "block.g01")))
    before, worst, slipping = None, 0.0, 0
    for time, name in zip(rows["time"], files[1:]):
        with h5py.File(os.path.join(out, "block.g01", name)) as file:
            state = contact_state(file)
        if before is not None and time > 0.12:
            warm = 100 + 400*(time - 0.1)
            phi = PHI*(1 - SOFT*warm)*(1 + RISE*(1 - np.exp(-before["worn_way"]/WAY)))
            worst = max(worst, np.max(np.abs(np.abs(state["friction"]) - phi*state["pressure"]))/PRESSURE)
            slipping += np.count_nonzero(state["contact_status"] == 2)
        before = state
    checks.that(slipping >= 16*45, "block: its points slip", slipping)
    checks.small(worst, 1e-9, "block: friction of every point by its temperature and its way")
    way = GOES - GOES*(rows["time"][-1] - rows["time"][-2])
    force = PHI*(1 - SOFT*500)*(1 + RISE*(1 - math.exp(-way/WAY)))*PRESSURE*LENGTH
    found = abs(rows["force_x_plate"][-1])
    checks.small(abs(found/force - 1), 2e-3, f"block: force of the way gone ({found:.4f} of {force:.4f})")
    resumed(checks, "block", BLOCK, out)


def contact_state(file):
    """State of the points of the contact, group 2, in a saved instant, by name."""
    names = [name.decode() for name in file["points/2/components"][()]]
    return {name: file["points/2/state"][()][:, :, k].ravel() for k, name in enumerate(names)}


def refusals(checks):
    """Wrong numbers, and a driver that nothing gives."""
    _, said = go(checks, "slow", BAR.replace(" 60.0 ", " 1.0 "), "--check", code=2)
    checks.that("B2 is the rate of the fast part: it must be above B1" in said, "a relation between numbers is reported", said)
    lines = [line for line in BAR.split("\n") if not line.startswith(("ADDEL", "START", "IMPOS", "LIC    entry", "   0. 1.  1. 9."))]
    text = "\n".join(lines).replace("LAW    diffusion HEAT\n   1.E9 1.\n", "")
    for arguments in (("--check",), ()):
        _, said = go(checks, "dry", text, *arguments, code=2)
        checks.that("'hydrogen'" in said and "steel" in said and "dry.lag:7" in said, "a driver that nothing gives is reported", said)
    done = subprocess.run([PROGRAM, "--law", "STEEL5"], text=True, capture_output=True, timeout=60, check=False)
    checks.that("hydrogen" in done.stdout, "--law names the drivers", done.stdout)


def main():
    """All of it."""
    checks = Checks()
    bar(checks)
    block(checks)
    refusals(checks)
    checks.end()


if __name__ == "__main__":
    main()
