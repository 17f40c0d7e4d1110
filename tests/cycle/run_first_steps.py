#!/usr/bin/env python3
"""First steps on new meshes, and a mesh that is worn to the end.

usage: run_first_steps.py [-v] [-k]

The first step on a new mesh starts at the motion of its onset there, not at the one that was interpolated from the old mesh: a block that is indented by
rounded edges, where sides roll onto the punch, needs no more of its iterations than of ordinary ones, twice, and steps go on as long as they were.
Beside a bore that closes, where the old mesh is too coarse to close it, the new one moves far at once, however short its first step: that is found in
parts, so that hardly a mesh is refused for it.
Sides that are in contact between their points too (ALONG) are carried to new meshes: no side is deeper in the punch than twice the allowed, the books of energy close,
and die forces go on.
A load that is found with the motion (LOADF): where whole corrections lead nowhere, shares of them that keep the residual below a ceiling do
(19 cutbacks of the sheet without them, 2 with them).
A mesh that is never replaced turns over at corners of elements, where errors are estimated beyond the points of the element: the run comes to its end.
"""
import os
import re
import sys

import numpy as np

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from scenes import deck_of, run_scene  # noqa: E402
from support import DONE, Checks, summary, write  # noqa: E402

# Of an ordinary step; of a new mesh (over twenty new meshes of six scenes .35, and .9 where steps start as on any mesh).
MOST_ITERATIONS, MOST_CUTBACKS = 2.0, 0.5


def steps_of(out, name):
    """Of every step in the listing: (first on a new mesh, iterations, cutbacks)."""
    found, first, cutbacks = [], False, 0
    with open(os.path.join(out, name + ".log"), encoding="utf-8") as file:
        for line in file:
            first = first or bool(re.match(r"mesh \d+ +after step", line))
            cutbacks += line.startswith("cutback: step")
            step = re.match(r"step \d+ .* iterations (\d+)", line)
            if step:
                found.append((first, int(step[1]), cutbacks))
                first, cutbacks = False, 0
    return found


def mean(values):
    return sum(values) / len(values)


def first_steps(checks):
    found = run_scene("indentation", checks.path("indentation"))
    if not checks.that(found["code"] == DONE, "indentation: the cycle ends with 0", found["said"]):
        return
    steps = steps_of(found["out"], "indentation")
    firsts, others = ([step for step in steps if step[0] == new] for new in (True, False))
    checks.that(len(firsts) > 2, "new meshes", len(firsts))
    iterations = [mean([step[1] for step in some]) for some in (firsts, others)]
    checks.that(iterations[0] <= MOST_ITERATIONS * iterations[1], f"at most {MOST_ITERATIONS:g} times the iterations of ordinary steps", iterations)
    cutbacks = mean([step[2] for step in firsts])
    checks.that(cutbacks <= MOST_CUTBACKS, f"at most {MOST_CUTBACKS:g} cutbacks a new mesh", cutbacks)


def whole_sides(checks):
    with open(deck_of("indentation"), encoding="utf-8") as file:
        text = file.read()
    plain = run_scene("indentation", checks.path("points"), {"travel": 2.5})
    deck = write(checks.path("along", "indentation.lag"), text.replace("punch film", "punch ALONG film"))
    found = run_scene("indentation", checks.path("along"), {"travel": 2.5}, deck=deck)
    if not checks.that(found["code"] == plain["code"] == DONE, "ALONG: the cycle ends with 0", (found["said"], plain["said"])):
        return
    told, was = (summary(one["out"])["checks"] for one in (found, plain))
    checks.that(found["meshes"] > 1, "ALONG: new meshes", found["meshes"])
    deepest = [one["max_penetration_sampled_over_allowed"] for one in (told, was)]
    checks.that(deepest[0] <= 2, "ALONG: at most twice the depth allowed, anywhere", deepest)
    checks.that(deepest[1] > 10, "points alone: deeper between them", deepest)
    checks.that(abs(told["energy_imbalance"]) < 0.01, "ALONG: energy is not missing", told["energy_imbalance"])
    forces = [np.interp(np.linspace(0.2, 1, 9), one["history"]["time"], one["history"]["force_y_punch"]).mean() for one in (found, plain)]
    checks.that(abs(forces[0]/forces[1] - 1) < 0.02, "ALONG: the mean force of points alone", forces)


def closing_bore(checks):
    found = run_scene("ring_70", checks.path("bore"), {"mu": 0.35})
    checks.that(found["code"] == DONE, "a bore that closes: the cycle ends with 0", found["said"])
    # one of fifteen is by the kernels of some processors
    checks.that(found["refused"] <= 1, "hardly a new mesh is refused", found["refused"])
    with open(os.path.join(found["out"], "ring_70.log"), encoding="utf-8") as file:
        parts = re.findall(r"^step .* iterations \d+ in \d+ parts$", file.read(), re.MULTILINE)
    checks.that(parts, "first steps in parts", parts)


def worn_mesh(checks):
    with open(deck_of("can"), encoding="utf-8") as file:
        text = re.sub(r"^REMSH.*\n", "REMSH\n   SIZE 0.8 0.8\n   COUNT 1000000\n", file.read(), flags=re.MULTILINE)
    found = run_scene("can", checks.path("worn"), deck=write(checks.path("worn.lag"), text))
    checks.that(found["code"] == DONE and found["meshes"] == 1, "a mesh that is worn comes to the end", found["said"])


# A clamped sheet that is blown up; the pressure is found, and is far below its largest when the first mesh is replaced.
BLOWN = """TITLE  A clamped sheet blown up on new meshes
STATE  AXISYM
KINEM  LOG
BODY   sheet PL8LS 4 metal
   SEGM   0. 0.   40. 0.
   SEGM   40. 0.   40. 1.
   SEGM   40. 1.   0. 1.
   SEGM   0. 1.   0. 0.
LAW    metal EPLA
   200000. 0.3
   SWIFT 550. 0.01 0.22
FIXED  sheet 4 X
FIXED  sheet 2 XY
LOADF  p POINT 0. 0. Y up
PRES2D sheet 1 3 1. p
LIC    up
   0. 0.   1. 20.
STRAT  0.002 1.E-6 0.02   6 3
REMSH
   TIMES 0.3 0.6 0.9
END
"""


def found_load(checks):
    found = run_scene("blown", checks.path("blown"), deck=write(checks.path("blown.lag"), BLOWN))
    if not checks.that(found["code"] == DONE, "a load that is found: the cycle ends with 0", found["said"]):
        return
    steps = steps_of(found["out"], "blown")
    checks.that(sum(first for first, _, _ in steps) == 3, "a load that is found: new meshes", steps)
    cutbacks = sum(cut for _, _, cut in steps)
    checks.that(cutbacks <= 6, "a load that is found: few steps fail", cutbacks)


def main():
    checks = Checks()
    first_steps(checks)
    found_load(checks)
    whole_sides(checks)
    closing_bore(checks)
    worn_mesh(checks)
    checks.end()


if __name__ == "__main__":
    main()
