#!/usr/bin/env python3
"""Planes of symmetry are walls that nothing crosses: a pore that closes onto both planes, flanks and a groove that fold onto one.

usage: run_planes.py [-v] [-k]       -v prints every check, -k keeps the results

What must hold: the run ends with 0, no place of any side lies behind the plane by more than 1e-3 of the side, the force agrees with
that of the same deck with a frictionless DIE along the plane, and of the pore with the whole plate, whose hole touches itself; what
support and wall carry is the force of the die. The table has the deepest place behind the plane over its side. `before`: the same by
the code without these walls, measured by this script.
"""
import json
import os
import subprocess
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), os.pardir, "patch"))
from patch_support import LAGAMINE, SIDES, Checks, Run, least_place, np  # noqa: E402

DEPTH, SAME = 1e-3, 1e-2
METAL = """LAW    metal EPLA
   {young} 0.3
   LINEAR {flow}
LAW    film COUL2D
   PENETR 1.E-3   PHI {mu}
"""
PRESS = """LIC    press
   0. 0.   1. -{travel}
MOVE   upper Y press
STRAT  0.01 1.E-5 0.02   5 3
SAVE   10
END
"""
# A quarter of a plate of half width 10 with a hole of radius 2.
PORE = """TITLE  pore
PARAM  u {unit}
PARAM  a 2*$u
PARAM  s 10*$u
PARAM  c sqrt(0.5)*$a
STATE  PLSTN
KINEM  LOG
BLOCK  right PL8LS 4 metal
   $a 0.   $s 0.   $s $s   $c $c
   {n} 5.   {m} 1.
   SIDE 4 ARC 0. 0.
BLOCK  top PL8LS 4 metal
   $c $c   $s $s   0. $s   0. $a
   {n} 5.   {m} 1.
   SIDE 4 ARC 0. 0.
JOIN   right 3 top 1
""" + METAL + """DIE    upper PILOT 0. $s
   SEGM   3*$s $s   -1*$a $s
CNT2D  top 2 upper -3 film
CNT2D  right 2 upper -3 film
FIXED  right 1 Y{option}
FIXED  top 3 X{option}
PROBE  support REACT Y right 1
PROBE  hole NODE X $a 0.
{more}""" + PRESS
# A waist in the plane y = 0: flanks go out from it to the width at the top.
WAIST = """TITLE  waist
STATE  {state}
KINEM  LOG
BLOCK  b PL8LS 4 metal
   0. 0.   5. 0.   {width} 8.   0. 8.
   {n} 1.   {m} 1.
""" + METAL + """DIE    upper PILOT 0. 8.
   SEGM   40. 8.   -2. 8.
CNT2D  b 2 3 upper -3 film
FIXED  b 1 Y{option}
FIXED  b 4 X
PROBE  support REACT Y b 1
{more}""" + PRESS
# A groove of 20 degrees in the plane, beside what is held.
GROOVE = """TITLE  groove
STATE  PLSTN
KINEM  LOG
BLOCK  left PL8LS 4 metal
   0. 0.   4. 0.   4. 6.   0. 6.
   {n} 1.   {m} 1.
BLOCK  right PL8LS 4 metal
   4. 0.   8. 4.*tan(pi/18)   8. 6.   4. 6.
   {n} 1.   {m} 1.
JOIN   left 2 right 4
""" + METAL + """DIE    upper PILOT 0. 6.
   SEGM   40. 6.   -2. 6.
CNT2D  left 3 upper -3 film
CNT2D  right 2 3 upper -3 film
FIXED  left 1 Y{option}
FIXED  left 4 {held}
PROBE  support REACT Y left 1
{more}""" + PRESS
FLOOR = """DIE    floor
   SEGM   -1*{length} 0.   10*{length} 0.
LAW    slip COUL2D
   PENETR 1.E-4   PHI 0.
"""
LEFT = """DIE    left
   SEGM   0. 10*{length}   0. -1*{length}
"""
STEEL = {"young": 200000.0, "flow": "300. 300.", "mu": 0.1, "option": "", "held": "X", "more": "", "n": 6, "m": 6}
# Name, deck, numbers, sides that reach the plane, components of the planes they reach.
CASES = [("pore", PORE, {"unit": 1, "travel": 3.5}, ("right 4", "top 4"), (0, 1)),
         ("pore-coarse", PORE, {"unit": 1, "travel": 3.5, "n": 4, "m": 4}, ("right 4", "top 4"), (0, 1)),
         ("pore-SI", PORE, {"unit": 0.001, "travel": 0.0035, "young": 2e11, "flow": "3.E8 3.E8"}, ("right 4", "top 4"), (0, 1)),
         ("waist", WAIST, {"state": "PLSTN", "width": 9, "travel": 4, "mu": 0.2}, ("b 2",), (1,)),
         ("waist-round", WAIST, {"state": "AXISYM", "width": 9, "travel": 4, "mu": 0.2}, ("b 2",), (1,)),
         ("groove", GROOVE, {"travel": 1.5, "mu": 0.3}, ("right 1",), (1,))]
# Elements along an eighth of the hole, and across the plate.
COARSE = ((4, 3), (5, 3), (6, 3), (6, 4))
# Depth over side of the code before, which ended with 0 all the same.
BEFORE = {"pore": 5.86, "pore-coarse": 3.87, "pore-SI": 5.86, "waist": 0.85, "waist-round": 0.30, "groove": 1.52}


def deck(text, numbers, **more):
    """A deck of the text; numbers that it does not name are those of STEEL."""
    return text.format(**{**STEEL, **numbers, **more})


def with_dies(numbers, sides, components):
    """Frictionless dies along the planes, which are no walls."""
    length = 10*numbers.get("unit", 1)
    cards = FLOOR.format(length=length)
    if 0 in components:
        cards += LEFT.format(length=length)
    names = ["left", "floor"]
    cards += "".join(f"CNT2D  {side} {names[c]} -17 slip\n" for side in sides for c in components)
    return {"more": cards}


def deepest(run, components):
    """Deepest place of sides behind the planes at all saved instants, over the chord of the side at the start."""
    return -min(least_place(run, c) for c in components)


def folds(checks):
    """Every case ends with its sides on the plane, with the force of dies along it."""
    print("| case | before | depth over side | force by dies % | support and wall % | steps | with dies |\n|---|---|---|---|---|---|---|")
    for name, text, numbers, sides, components in CASES:
        run = Run(checks, name, deck(text, numbers))
        other = Run(checks, name + "-dies", deck(text, numbers, **with_dies(numbers, sides, components)))
        if not (run.ok and other.ok):
            continue
        depth = deepest(run, components)
        checks.that(depth <= DEPTH, f"{name}: nothing crosses the plane", f"{depth:.1e} of the side")
        with open(os.path.join(run.out, "summary.json"), encoding="utf-8") as file:
            summary = json.load(file)
        carried = [wall["force_beside_support"] for wall in summary["walls"]]
        checks.that(len(carried) == (1 if numbers.get("state") == "AXISYM" else 2), f"{name}: walls in the summary", carried)
        force = [one.history["force_y_upper"][-1] for one in (run, other)]
        checks.that(carried[0] > 0.01*force[0], f"{name}: the wall carries a part of the force", carried)
        checks.small(abs(force[0]/force[1] - 1), SAME, f"{name}: force against dies along the planes")
        checks.small(abs(run.history["external_work"][-1]/other.history["external_work"][-1] - 1), SAME, f"{name}: work")
        checks.small(abs(run.history["support"][-1]/force[0] - 1), 1e-6, f"{name}: support and wall carry what the die does")
        print(f"| {name} | {BEFORE.get(name, '')} | {depth:.1e} | {100*(force[0]/force[1] - 1):.3f} "
              f"| {100*(run.history['support'][-1]/force[0] - 1):.1e} | {len(run.history['step'])} | {len(other.history['step'])} |")


def whole_plate(checks):
    """The quarter against the plate of four, whose hole touches itself: force, and area of the hole."""
    numbers = {"unit": 1, "travel": 3.5}
    runs = [Run(checks, "quarter", deck(PORE, numbers)), Run(checks, "whole", whole(numbers))]
    if not all(run.ok for run in runs):
        return
    force = [run.history["force_y_upper"][-1]*factor for run, factor in zip(runs, (2, 1))]
    checks.small(abs(force[0]/force[1] - 1), SAME, "whole plate: force")
    areas = []
    for run, quarters in zip(runs, (1, 4)):
        first, nodes = run.mesh()
        with run.open() as file:
            steps = sorted(file["steps"])
            areas.append([hole(first + file[f"steps/{step}/node/displacement"][()][:, :2], first, nodes)/quarters for step in steps])
    # both save every so many steps of their own: what the hole is left with at the end, over what it began with
    checks.that(areas[0][0] > 3 and areas[0][-1] < 0.02*areas[0][0], "whole plate: the hole of the quarter closes", areas[0])
    checks.small(abs(areas[0][-1] - areas[1][-1])/areas[0][0], SAME, "whole plate: area of the hole")


def coarse_wholes(checks):
    """The same on coarse meshes, whose sides turn back from their chords at the ends of the hole: a corner of the body, no contact."""
    for n, m in COARSE:
        numbers = {"unit": 1, "travel": 2.1, "n": n, "m": m}
        quarter, run = Run(checks, f"quarter-{n}-{m}", deck(PORE, numbers)), Run(checks, f"whole-{n}-{m}", whole(numbers))
        if quarter.ok and run.ok:
            for name, factor in ("force_y_upper", 2), ("external_work", 4):
                checks.small(abs(run.history[name][-1]/quarter.history[name][-1]/factor - 1), 1e-3, f"whole plate, {n} x {m}: {name}")


def met_anew(checks):
    """Sides of the hole that meet others in the last correction of a step: its errors are found with the matrix of these."""
    Run(checks, "met-anew", whole({"unit": 1, "travel": 3.5, "n": 6, "m": 8}).replace("1. -3.5", "0.43 -1.505"))


def whole(numbers):
    """The deck of the plate of four: eight blocks around the hole."""
    corners = [("$a 0.", "$s 0."), ("$c $c", "$s $s"), ("0. $a", "0. $s"), ("-$c $c", "-$s $s"), ("-$a 0.", "-$s 0."),
               ("-$c -$c", "-$s -$s"), ("0. -$a", "0. -$s"), ("$c -$c", "$s -$s")]
    text = PORE[:PORE.index("BLOCK")]
    for k in range(8):
        (inner, outer), (inner_after, outer_after) = corners[k], corners[(k + 1) % 8]
        text += f"BLOCK  b{k} PL8LS 4 metal\n   {inner}  {outer}  {outer_after}  {inner_after}\n   {{n}} 5.   {{m}} 1.\n   SIDE 4 ARC 0. 0.\n"
    text += "".join(f"JOIN   b{k} 3 b{(k + 1) % 8} 1\n" for k in range(8)) + METAL
    text += "DIE    upper PILOT 0. $s\n   SEGM   3*$s $s   -3*$s $s\nDIE    lower PILOT 0. -$s\n   SEGM   -3*$s -$s   3*$s -$s\n"
    text += "".join(f"CNT2D  b{k} 2 {'upper' if k < 4 else 'lower'} -3 film\n" for k in range(8))
    text += "DIE    hole SIDES " + " ".join(f"b{k} 4" for k in range(8)) + "\nLAW    slip COUL2D\n   PENETR 1.E-4   PHI 0.\n"
    text += "".join(f"CNT2D  b{k} 4 hole slip\n" for k in range(8))
    text += "FIXED  POINT 0. $s X\nFIXED  POINT 0. -$s X\nMOVE   lower Y press -1.\n" + PRESS
    return deck(text, numbers)


def hole(now, first, nodes):
    """Area inside the sides that were on the hole at the start, to the origin."""
    sharing = np.bincount(nodes[:, 4:].ravel(), minlength=len(first))
    sides = np.concatenate([nodes[:, side] for side in SIDES])
    sides = sides[(sharing[sides[:, 1]] == 1) & (np.linalg.norm(first[sides[:, 1]], axis=1) < 2.1)
                  & (np.linalg.norm(first[sides[:, 0]], axis=1) < 2.1) & (np.linalg.norm(first[sides[:, 2]], axis=1) < 2.1)]
    points, weights = np.polynomial.legendre.leggauss(3)
    area = 0.0
    for xi, weight in zip(points, weights):
        place = np.array([xi*(xi - 1)/2, 1 - xi**2, xi*(xi + 1)/2]) @ now[sides]
        along = np.array([xi - 0.5, -2*xi, xi + 0.5]) @ now[sides]
        # the part is on the left: the hole is walked against the clock's other way
        area -= 0.5*weight*(place[:, 0]*along[:, 1] - place[:, 1]*along[:, 0]).sum()
    return area


def resumed(checks):
    """A run that goes on from a checkpoint in which the wall bears ends with the same bits."""
    numbers = {"travel": 1.2, "mu": 0.3, "more": "CKPT 4\nNORMS PATH 0 RATE 0\n"}
    run = Run(checks, "begun", deck(GROOVE, numbers))
    if not run.ok:
        return
    again = os.path.join(checks.folder, "again")
    result = subprocess.run([LAGAMINE, run.out + ".lag", "--resume", os.path.join(run.out, "begun.ckp.1.h5"), "--out", again,
                             "--threads", "1", "--quiet"], check=False, stdin=subprocess.DEVNULL, capture_output=True, text=True,
                            timeout=120)
    if not checks.that(result.returncode == 0, f"resumed: ends with {result.returncode}", result.stderr[-300:]):
        return
    last = []
    for folder in (run.out, again):
        with open(os.path.join(folder, "history.csv"), encoding="utf-8") as file:
            last.append(file.read().splitlines()[-1])
    checks.that(last[0] == last[1], "resumed: the last row of the history, bit for bit", last)


PAD = """TITLE  plate on a pad
STATE  PLSTN
KINEM  LOG
BLOCK  mid PL8LS 4 metal
   0. 0.   4. 0.   4. 1.   0. 1.
   4 1.   2 1.
BLOCK  arm PL8LS 4 metal
   4. 0.   12. 0.   12. 1.   4. 1.
   8 1.   2 1.
JOIN   mid 2 arm 4
""" + METAL.split("LAW    film")[0] + """FIXED  mid 1 Y
FIXED  mid 4 X
MOVE   POINT 12. 1. Y press
PROBE  tip NODE Y 12. 0.
LIC    press
   0. 0.   1. -2.
STRAT  0.01 1.E-5 0.05   5 3
SAVE   10
END
"""


def no_walls(checks):
    """A plate on a pad bends below the level of the pad: beside what is held its free sides lie in the line, which is no wall."""
    run = Run(checks, "pad", deck(PAD, {}))
    if not run.ok:
        return
    checks.small(abs(run.history["tip"][-1] + 2), 0.1, "pad: the arm goes below the line")
    said = subprocess.run([LAGAMINE, "--check", run.out + ".lag"], check=False, stdin=subprocess.DEVNULL, capture_output=True, text=True,
                          timeout=60).stdout
    checks.that("no wall    FIXED mid.1 Y           y = 0: free sides of the body lie in it" in said, "pad: told", said)
    checks.that("wall       FIXED mid.4 X           mid, arm does not cross x = 0" in said, "pad: the other plane is a wall", said)


def clamped(checks):
    """A part held XY on one side: its corner is in the plane of another support, which is a wall all the same."""
    numbers = {"travel": 1.5, "mu": 0.3, "held": "XY"}
    runs = [Run(checks, "clamped", deck(GROOVE, numbers)),
            Run(checks, "clamped-dies", deck(GROOVE, numbers, **with_dies(numbers, ("right 1",), (1,))))]
    if not all(run.ok for run in runs):
        return
    checks.that(deepest(runs[0], (1,)) <= DEPTH, "clamped: nothing crosses the plane", deepest(runs[0], (1,)))
    force = [run.history["force_y_upper"][-1] for run in runs]
    checks.small(abs(force[0]/force[1] - 1), SAME, "clamped: force against a die along the plane")
    with open(runs[0].out + "/clamped.log", encoding="utf-8") as file:
        checks.that("is no wall now" not in file.read(), "clamped: not told that there is no wall")


def operations(checks):
    """The flank folds in one operation and goes on in the next: the plane stays a wall, and the force is that of one stroke."""
    whole_way = deck(WAIST, {"state": "PLSTN", "width": 9, "travel": 3})
    # the second operation is the same press, from where the first has left it
    shared, press = whole_way.split("DIE    upper")
    first = "DIE    upper" + press.replace("END\n", "")
    second = first.replace("1. -3", "1. -1.5").replace("PILOT 0. 8.", "PILOT 0. 6.5").replace("40. 8.   -2. 8.", "40. 6.5   -2. 6.5")
    text = shared + "OPERA  one\n" + first.replace("1. -3", "1. -1.5") + "OPERA  two\n" + second + "END\n"
    runs = [Run(checks, "one-stroke", whole_way), Run(checks, "two-strokes", text)]
    if not all(run.ok for run in runs):
        return
    force = [run.history["force_y_upper"][-1] for run in runs]
    checks.small(abs(force[1]/force[0] - 1), 0.02, "operations: force of two strokes against one")
    checks.small(abs(runs[1].history["support"][-1]/force[1] - 1), 1e-4, "operations: support and wall carry what the die does")


def main():
    checks = Checks()
    folds(checks)
    whole_plate(checks)
    coarse_wholes(checks)
    met_anew(checks)
    resumed(checks)
    no_walls(checks)
    clamped(checks)
    operations(checks)
    checks.end()


if __name__ == "__main__":
    main()
