#!/usr/bin/env python3
"""The point of a die that enters large elements, by REMSH alone: wedges and cones whose load one node bears at first.

usage: run_noses.py [all] [-v] [-k]          without `all`: the quick ones

The slope of the faces to the plane [degrees], friction, the number of elements along each side of a block of 10 x 10, and the radius of the point. All end, no try at a new mesh is
refused, and the force at the end is that on a mesh of 24 x 24 (the point enters 2.5). Where the point is round it is that on a mesh of 32 x 32 from a tenth of the stroke on:
while few sides of large elements bore it, it was up to three times as much, and such a contact is a reason for a new mesh (`NARROW`).
"""
import itertools
import os
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from remeshed import cycle, tries, value_at  # noqa: E402
from support import DONE, Checks, history, said, write  # noqa: E402

# State, elements, slope, friction, radius: force at the end on 24 x 24 [N, or N/mm].
QUICK = {("AXISYM", 4, 60.0, 0.2, 0.0): 6236.0, ("AXISYM", 12, 60.0, 0.2, 0.0): 6236.0, ("AXISYM", 12, 50.0, 0.0, 0.0): None,
         ("PLSTN", 4, 60.0, 0.0, 0.0): None, ("PLSTN", 12, 60.0, 0.2, 0.0): 830.0, ("PLSTN", 12, 75.0, 0.2, 0.0): 494.4,
         ("AXISYM", 4, 60.0, 0.0, 1.0): 8721.0, ("PLSTN", 4, 45.0, 0.2, 1.0): 1164.0}
# Mean force from 0.07 to 0.13 of the stroke, on 32 x 32 with steps of 0.01.
EARLY = {("PLSTN", 9, 60.0, 0.0, 0.3): 188.9, ("AXISYM", 9, 60.0, 0.0, 0.3): 218.6, ("AXISYM", 4, 45.0, 0.0, 1.0): 982.7}
SLOPES, FRICTION, ELEMENTS, RADII = (10.0, 20.0, 30.0, 40.0, 50.0, 60.0), (0.0, 0.1, 0.3), (4, 8, 12), (0.0, 1.0)
# A contact that is as wide as ten elements of a mesh is known to a tenth: 4 elements across 10 are remeshed to a smallest size of 1.
SAME_FORCE = 0.1
SAME_EARLY = 0.15

DECK = """TITLE  A pointed nose enters a block
PARAM  angle 20
PARAM  mu 0.1
PARAM  n 8
PARAM  slope tan($angle*pi/180)
PARAM  apex 10-{radius}*(1/cos($angle*pi/180)-1)
STATE  {state}
KINEM  LOG
BLOCK  block PL8LS 4 metal
   0. 0.   10. 0.   10. 10.   0. 10.
   $n 1.   $n 1.
LAW    metal EPLA
   70000. 0.33
   LINEAR 200. 100.
LAW    film COUL2D
   PENETR 1.E-3   PHI $mu   AUGMENT 10
DIE    nose PILOT 0. 10.
   SEGM   30. $apex+30*$slope   0. $apex
{fillet}   SEGM   0. $apex   -30. $apex+30*$slope
CNT2D  block 3 nose film
FIXED  block 1 Y
FIXED  block 4 X
LIC    press
   0. 0.     1. -2.5
MOVE   nose Y press
STRAT  0.002 1.E-6 0.03   6 3
REMSH
END
"""


def main():
    checks = Checks()
    cases = dict(QUICK)
    cases.update({case: None for case in EARLY})
    if "all" in sys.argv:
        cases.update({case: None for case in itertools.product(("AXISYM", "PLSTN"), ELEMENTS, SLOPES, FRICTION, RADII) if case not in cases})
    for (state, n, slope, mu, radius), expected in cases.items():
        name = f"{state} {n} x {n}, {slope:g} degrees, friction {mu:g}, radius {radius:g}"
        folder = checks.path(f"{state}.{n}.{slope:g}.{mu:g}.{radius:g}")
        deck = write(folder + ".lag", DECK.format(state=state, radius=radius, fillet=f"   FILLT  {radius} 1.E-3\n" if radius else ""))
        result = cycle(deck, folder, "--quiet", "-p", f"n={n}", "-p", f"angle={slope}", "-p", f"mu={mu}")
        if not checks.that(result.returncode == DONE, f"{name}: ends", said(result)):
            continue
        refused = [row["reason"] for row in tries(folder) if row["accepted"] == "n"]
        checks.that(not refused, f"{name}: no try refused", refused)
        force = history(folder)["force_y_nose"][-1]
        case = (state, n, slope, mu, radius)
        if case in EARLY:
            rows = history(folder)
            early = sum(value_at(rows, "force_y_nose", "time", 0.07 + 0.0075 * k) for k in range(9)) / 9
            checks.that(abs(early / EARLY[case] - 1) < SAME_EARLY, f"{name}: force of 32 x 32 at a tenth of the stroke", (early, EARLY[case]))
        if expected:
            checks.that(abs(force / expected - 1) < SAME_FORCE, f"{name}: force of 24 x 24", (force, expected))
    checks.end()


if __name__ == "__main__":
    main()
