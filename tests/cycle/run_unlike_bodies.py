#!/usr/bin/env python3
"""Bodies of unlike shape by their contours, with REMSH alone: each has the size of its own shape, finer where another lies on it.

usage: run_unlike_bodies.py [--fine] [-v] [-k]

A sheet is pressed into a die by a thick rubber pad. The pad's far side has elements of the size that its own shape asks for, its side
on the sheet no larger ones than a multiple of the sheet's, on a second mesh too. With --fine (minutes) the force is compared
with that of a run in which both bodies are as fine as the sheet.
"""
import glob
import os
import sys

sys.dont_write_bytecode = True
from remeshed import cycle  # noqa: E402
from support import DONE, Checks, history, said, with_h5py, write  # noqa: E402

with_h5py()
import h5py  # noqa: E402
import numpy as np  # noqa: E402

LENGTH, THICK, HIGH = 12.0, 0.8, 6.0
SHEET = 2 * LENGTH * THICK / (4 * 2 * (LENGTH + THICK))   # a quarter of its thickness, as area over perimeter has it
PAD = (LENGTH * HIGH / 150)**0.5
# Elements of the pad on the sheet over those of the sheet (remesh_defaults), and what a mesher makes of a size.
FACING, MEAN = 2.0, (0.75, 1.3)
LEAST = 0.3           # on a later mesh
SAME_FORCE = 0.005    # found: 0.0004
FEWER = 4.0           # elements of the pad

DECK = f"""TITLE  A sheet pressed into a die by a pad
STATE  PLSTN
KINEM  LOG
BODY   sheet PL8LS 4 metal
   SEGM   0. 0.   {LENGTH} 0.
   SEGM   {LENGTH} 0.   {LENGTH} {THICK}
   SEGM   {LENGTH} {THICK}   0. {THICK}
   SEGM   0. {THICK}   0. 0.
BODY   pad PL8LS 9 rubber MEAN
   SEGM   0. {THICK}   {LENGTH} {THICK}
   SEGM   {LENGTH} {THICK}   {LENGTH} {THICK + HIGH}
   SEGM   {LENGTH} {THICK + HIGH}   0. {THICK + HIGH}
   SEGM   0. {THICK + HIGH}   0. {THICK}
LAW    metal EPLA
   200000. 0.3
   LINEAR 100. 100.
LAW    rubber ELA
   20. 0.49
LAW    film COUL2D
   PENETR 1.E-3   PHI 0.1   AUGMENT 10
DIE    form
   SEGM   -1. -2.   6. -2.
   FILLT  2. 1.E-3
   SEGM   6. -2.   9. 0.
   FILLT  2. 1.E-3
   SEGM   9. 0.   20. 0.
DIE    cushion SIDES pad 1
CNT2D  sheet 1 form film
CNT2D  sheet 3 cushion film
MOVE   pad 3 Y go
FIXED  pad 2 4 X
FIXED  sheet 4 X
LIC    go
   0. 0.   1. -1.
PROBE  force REACT Y pad 3
STRAT  0.01 1.E-6 0.1   6 3
REMSH
"""


def elements(path, body):
    """Middles and sizes of the elements of a body."""
    with h5py.File(path, "r") as file:
        x = file["mesh/coordinates"][:]
        if "fields/displacement/value" in file:
            x = x + file["fields/displacement/value"][:]
        x = x[file[f"groups/{body}/connectivity"][:, :4] - 1]
    area = 0.5 * np.abs(sum(x[:, i, 0] * x[:, (i + 1) % 4, 1] - x[:, (i + 1) % 4, 0] * x[:, i, 1] for i in range(4)))
    return x.mean(axis=1), np.sqrt(area)


def run(checks, name, rows):
    """Deck with rows of REMSH: meshes and the last force."""
    folder = checks.path(name)
    result = cycle(write(checks.path(f"{name}.lag"), DECK + rows + "END\n"), folder)
    checks.that(result.returncode == DONE, f"{name}: ends with 0", said(result))
    meshes = sorted(glob.glob(os.path.join(folder, f"{name}.g??.start.h5")))
    return meshes, history(folder)["force"][-1]


def sizes_are_their_own(checks, path, least):
    name = os.path.basename(path)
    sizes = [elements(path, 1)[1].mean()]
    middles, of_pad = elements(path, 2)
    low, high = middles[:, 1].min(), middles[:, 1].max()
    sizes += [of_pad[middles[:, 1] < low + 0.5 * FACING * SHEET].mean(), of_pad[middles[:, 1] > high - 0.5 * PAD].mean()]
    wanted = (SHEET, FACING * SHEET, PAD)
    for where, size, most in zip(("the sheet", "the pad on the sheet", "the far side of the pad"), sizes, wanted):
        checks.that(least * most < size < MEAN[1] * most, f"{name}: size of elements of {where}", (size, most))
    return len(of_pad)


def main():
    checks = Checks()
    meshes, force = run(checks, "own", "   TIMES 0.5\n")
    checks.that(len(meshes) == 2, "a first mesh and another", meshes)
    number = sizes_are_their_own(checks, meshes[0], MEAN[0])
    # errors may ask for smaller ones
    sizes_are_their_own(checks, meshes[-1], LEAST)
    checks.that(number < LENGTH * HIGH / SHEET**2 / FEWER, "fewer elements than if the pad were as fine as the sheet", number)
    if "--fine" in sys.argv:
        fine_force = run(checks, "fine", f"   SIZE {0.2 * SHEET} {SHEET}\n")[1]
        checks.that(abs(force / fine_force - 1) < SAME_FORCE, "the force is that of a fine pad", (force, fine_force))
    checks.end()


if __name__ == "__main__":
    main()
