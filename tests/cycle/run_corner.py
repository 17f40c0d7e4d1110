#!/usr/bin/env python3
"""Corners of dies through new meshes: a part that fills one, floor and wall as one curve and as two dies, and a part that flows around one.

usage: run_corner.py [-v] [-k]

The ends of both sides lie in the corner, a little in the die or out of it. Each keeps to the face that its side lies on, so that both ways of
saying it give the same force, and no new mesh is refused. The limits are those of REMSH alone but for ERROR: an error that passes its limit a step
sooner or later by round-off makes other meshes of the two runs, whose forces differ by a per cent where they rise steeply.

A flat punch with sharp edges: matter flows around them. Each new contour goes through the edge, where contact ends; the cycle comes to the end.

A nose of a die that stands in a side between two of its nodes, which are out of it: nothing presses there. No more does it on a new mesh that has a node at the place.
"""
import math
import os
import re
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from remeshed import cycle, facts, tries  # noqa: E402
from scenes import deck_of, run_scene  # noqa: E402
from support import DONE, Checks, said, write  # noqa: E402

CORNER = """   SEGM   -1. -20.   5. -20.
   SEGM   5. -20.   5. 0.
"""
WALL = """   SEGM   5. -22.   5. 0.
"""
FLOOR = """DIE    floor
   SEGM   -1. -20.   9. -20.
CNT2D  rod 1 floor film
"""
LIMITS = "REMSH\n   ANGLE 15. 165.\n   MIDDLE 0.4\n   SCALED 0.2\n   ASPECT 10.\n   CONTACT 50.\n   DISTRESS 4\n   LEAST 5\n"
NOSE = """TITLE  A nose of a die between two nodes of a side, and a punch beside it
STATE  PLSTN
KINEM  LOG
BLOCK  block PL8LS 4 metal
   0. 0.   8. 0.   8. 4.   0. 4.
   4 1.   2 1.
LAW    metal EPLA
   70000. 0.33
   LINEAR 200. 200.
LAW    film COUL2D
   PENETR 1.E-3   PHI 0.1   AUGMENT 10
DIE    nose                                              ! its lowest point 0.02 below the side, at x = 0.5
   SEGM   5. 9.   0.5 3.88
   FILLT  0.2 1.E-4
   SEGM   0.5 3.88   -4. 9.
DIE    punch PILOT 9. 4.
   SEGM   20. 4.   5.5 4.
   SEGM   5.5 4.   5.5 9.
CNT2D  block 3 nose film
CNT2D  block 3 punch film
FIXED  block 1 Y
FIXED  block 4 X
LIC    press
   0. 0.   1. -0.02
MOVE   punch Y press
STRAT  0.05 1.E-6 0.1   6 3
REMSH
   TIMES 0.5
   SIZE 0.5 0.5
END
"""
SAME = 1e-3
# New meshes that are refused, as a share of all.
REFUSED = 0.05


def sharp_edge(checks):
    with open(deck_of("indentation"), encoding="utf-8") as file:
        rounded = file.read()
    sharp = re.sub(r"^ *FILLT .*\n|^PARAM +edge .*\n", "", rounded, flags=re.MULTILINE)
    checks.that(len(sharp.splitlines()) == len(rounded.splitlines()) - 2, "the deck has one rounded edge")
    found = run_scene("indentation", checks.path("sharp"), deck=write(checks.path("sharp.lag"), sharp))
    checks.that(found["code"] == DONE, "sharp edge: the cycle ends with 0", found["said"])
    checks.that(found["refused"] <= REFUSED * found["meshes"], "sharp edge: tries refused", (found["refused"], found["meshes"]))


def nose_between_nodes(checks):
    out = checks.path("nose")
    result = cycle(write(checks.path("nose.lag"), NOSE), out, "--quiet")
    if not checks.that(result.returncode == DONE, "nose: the cycle ends with 0", said(result)):
        return
    checks.that([row["accepted"] for row in tries(out)] == ["y"], "nose: the first try is taken", [row["reason"] for row in tries(out)])
    forces = {one["die"]: one for one in facts(out, 2, "restart")["forces"]}
    punch = math.hypot(*forces["punch"]["before"])
    checks.that(math.hypot(*forces["nose"]["before"]) == 0 and punch > 0, "nose: no force before", forces)
    checks.that(math.hypot(*forces["nose"]["carried"]) < 1e-3 * punch, "nose: none on the new mesh", forces)


def main():
    checks = Checks()
    with open(deck_of("heading"), encoding="utf-8") as file:
        one = file.read().replace("REMSH\n", LIMITS)
    two = one.replace(CORNER, WALL).replace("CNT2D  rod 1 2 matrix film\n", "CNT2D  rod 2 matrix film\n" + FLOOR)
    checks.that(LIMITS in one and CORNER in one and FLOOR in two, "the deck has floor and wall in one curve")
    forces = {}
    for name, text in (("one curve", one), ("two dies", two)):
        found = run_scene("heading", checks.path(name.replace(" ", "_")), deck=write(checks.path(name.replace(" ", "_") + ".lag"), text))
        if not checks.that(found["code"] == DONE, f"{name}: the cycle ends with 0", found["said"]):
            continue
        checks.that(found["refused"] == 0, f"{name}: no try refused", found["refused"])
        checks.that(found["meshes"] > 1, f"{name}: new meshes in the corner", found["meshes"])
        forces[name] = found["history"]["force_y_punch"][-1]
    if len(forces) == 2:
        ratio = forces["one curve"] / forces["two dies"]
        checks.that(abs(ratio - 1) < SAME, "the same force at the end", ratio)
    sharp_edge(checks)
    nose_between_nodes(checks)
    checks.end()


if __name__ == "__main__":
    main()
