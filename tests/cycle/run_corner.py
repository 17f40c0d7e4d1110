#!/usr/bin/env python3
"""Corners of dies through new meshes: a part that fills one, floor and wall as one curve and as two dies, and a part that flows around one.

usage: run_corner.py [-v] [-k]

The ends of both sides lie in the corner, a little in the die or out of it. Each keeps to the face that its side lies on, so that both ways of
saying it give the same force, and no new mesh is refused. The limits are those of REMSH alone but for ERROR: an error that passes its limit a step
sooner or later by round-off makes other meshes of the two runs, whose forces differ by a per cent where they rise steeply.

A flat punch with sharp edges: matter flows around them. Each new contour goes through the edge, where contact ends; the cycle comes to the end.
"""
import os
import re
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from scenes import deck_of, run_scene  # noqa: E402
from support import DONE, Checks, write  # noqa: E402

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
    checks.end()


if __name__ == "__main__":
    main()
