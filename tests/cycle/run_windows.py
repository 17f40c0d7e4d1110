#!/usr/bin/env python3
"""WINDOW of REMSH: elements have the sizes of the windows they are in, wherever the die or the matter has carried these.

usage: run_windows.py [-v] [-k]

A strip is pressed and then dragged along by a die that turns: one window goes with the die, one with the matter, one stays. Sizes of
elements, found here from the nodes of each new mesh, are those of the window that holds their middle, and larger beside them all.
"""
import glob
import os
import sys

sys.dont_write_bytecode = True
from remeshed import cycle  # noqa: E402
from support import DONE, Checks, said, with_h5py, write  # noqa: E402

with_h5py()
import h5py  # noqa: E402
import numpy as np  # noqa: E402

TURN = 0.2            # of the die [rad]
DRAG, PRESS = 4.0, 1.5
PILOT = (6.0, 10.0)
# corners, sizes
DIE, MATTER, PLACE = ((4.5, 8.5, 7.5, 10.5), (0.25, 0.3)), ((9.0, 5.0, 13.0, 8.0), (0.4, 0.5)), ((16.0, 1.0, 18.0, 3.0), (0.3, 0.35))
LARGEST = 2.0
# A mesher meets a size in the mean; elements smaller than asked for stand where sizes change.
MEAN, BESIDE = (0.75, 1.3), 1.3
# In a window and half an element beside it (found 1.1; 1.3 with a jump to the smallest of SIZE at its border).
JUST_BESIDE = 1.2

DECK = f"""TITLE  A strip pressed and dragged by a ball that turns
STATE  PLSTN
KINEM  LOG
BODY   strip PL8LS 4 metal
   SEGM   0. 0.   20. 0.
   SEGM   20. 0.   20. 10.
   SEGM   20. 10.   0. 10.
   SEGM   0. 10.   0. 0.
LAW    metal EPLA
   70000. 0.33
   LINEAR 200. 500.
LAW    film COUL2D
   PENETR 1.E-3   PHI 0.1   AUGMENT 10
DIE    ball PILOT {PILOT[0]} {PILOT[1]}
   ARC    8. 12.   6. 10.   4. 12.   1.E-3
CNT2D  strip 3 ball -3 film
FIXED  strip 1 X
FIXED  strip 1 Y
LIC    down
   0. 0.   0.5 -1.   1. -1.
LIC    along
   0. 0.   0.5 0.   1. 1.
MOVE   ball Y down {PRESS}
MOVE   ball X along {DRAG}
MOVE   ball A along {TURN}
STRAT  0.02 1.E-6 0.1   6 3
REMSH
   TIMES 0.5
   SIZE 0.8 {LARGEST}
   COUNT 3000
   WINDOW {' '.join(map(str, DIE[0]))}  {DIE[1][0]} {DIE[1][1]}  DIE ball
   WINDOW {' '.join(map(str, MATTER[0]))}  {MATTER[1][0]} {MATTER[1][1]}  MATTER
   WINDOW {' '.join(map(str, PLACE[0]))}  {PLACE[1][0]} {PLACE[1][1]}
END
"""


def elements(path):
    """Middles, sizes and first places of the elements of a mesh, and where the die's pilot is."""
    with h5py.File(path, "r") as file:
        nodes = file["mesh/coordinates"][:]
        moved = nodes + file["fields/displacement/value"][:] if "fields/displacement/value" in file else nodes
        origin = file["mesh/origin"][:] if "mesh/origin" in file else nodes
        corners = file["groups/1/connectivity"][:, :4] - 1
        pilot = file["fields/pilot/value"][0] if "fields/pilot/value" in file else np.array([*PILOT, 0.0])
    x = moved[corners]
    area = 0.5 * np.abs(sum(x[:, i, 0] * x[:, (i + 1) % 4, 1] - x[:, (i + 1) % 4, 0] * x[:, i, 1] for i in range(4)))
    return x.mean(axis=1), np.sqrt(area), origin[corners].mean(axis=1), pilot


def distance(box, places):
    """Of places from a box, 0 inside."""
    low, high = np.array(box[:2]), np.array(box[2:])
    return np.linalg.norm(np.maximum(np.maximum(low - places, places - high), 0.0), axis=1)


def back(middles, pilot):
    """Where places that go with the die were at the start."""
    arm, c, s = middles - pilot[:2], np.cos(pilot[2]), np.sin(pilot[2])
    return np.array(PILOT) + np.stack([c * arm[:, 0] + s * arm[:, 1], c * arm[:, 1] - s * arm[:, 0]], axis=1)


def main():
    checks = Checks()
    folder = checks.path("out")
    result = cycle(write(checks.path("strip.lag"), DECK), folder)
    checks.that(result.returncode == DONE, "the cycle ends with 0", said(result))
    meshes = sorted(glob.glob(os.path.join(folder, "strip.g0?.start.h5")))
    checks.that(len(meshes) == 2, "two new meshes", meshes)
    for path in meshes:
        name = os.path.basename(path)
        middles, sizes, origin, pilot = elements(path)
        places = {"die": (DIE, back(middles, pilot)), "matter": (MATTER, origin), "place": (PLACE, middles)}
        away = np.full(len(sizes), np.inf)
        for window, ((box, (smallest, largest)), found) in places.items():
            distances = distance(box, found)
            away = np.minimum(away, distances)
            mean = sizes[distances == 0].mean()
            checks.that(MEAN[0] * smallest < mean < MEAN[1] * largest, f"{name}: size in the window of the {window}", (mean, largest))
        # the window that stays is finer than the smallest of SIZE: where sizes jump at its border elements grow on both sides of it
        around = sizes[distance(PLACE[0], middles) < 0.5 * PLACE[1][1]].mean()
        checks.that(around < JUST_BESIDE * PLACE[1][1], f"{name}: no jump at the border of a window", around)
        checks.that(sizes[away > LARGEST].mean() > BESIDE * MATTER[1][1], f"{name}: larger beside windows", sizes[away > LARGEST].mean())
    checks.end()


if __name__ == "__main__":
    main()
