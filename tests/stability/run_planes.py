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
from patch_support import LAGAMINE, Checks, Run, np  # noqa: E402

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
FIXED  left 4 X
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
STEEL = {"young": 200000.0, "flow": "300. 300.", "mu": 0.1, "option": "", "more": "", "n": 6, "m": 6}
SIDES = ((0, 4, 1), (1, 5, 2), (2, 6, 3), (3, 7, 0))
# Name, deck, numbers, sides that reach the plane, components of the planes they reach.
CASES = [("pore", PORE, {"unit": 1, "travel": 3.5}, ("right 4", "top 4"), (0, 1)),
         ("pore-coarse", PORE, {"unit": 1, "travel": 3.5, "n": 4, "m": 4}, ("right 4", "top 4"), (0, 1)),
         ("pore-SI", PORE, {"unit": 0.001, "travel": 0.0035, "young": 2e11, "flow": "3.E8 3.E8"}, ("right 4", "top 4"), (0, 1)),
         ("waist", WAIST, {"state": "PLSTN", "width": 9, "travel": 4, "mu": 0.2}, ("b 2",), (1,)),
         ("waist-round", WAIST, {"state": "AXISYM", "width": 9, "travel": 4, "mu": 0.2}, ("b 2",), (1,)),
         ("groove", GROOVE, {"travel": 1.5, "mu": 0.3}, ("right 1",), (1,))]
BEFORE = {}


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
    return {"option": " NOWALL", "more": cards}


def deepest(run, components):
    """Deepest place of sides behind the planes at all saved instants, over the chord of the side at the start."""
    first, nodes = run.mesh()
    sharing = np.bincount(nodes[:, 4:].ravel(), minlength=len(first))
    sides = np.concatenate([nodes[:, side] for side in SIDES])
    sides = sides[sharing[sides[:, 1]] == 1]
    chord = np.linalg.norm(first[sides[:, 2]] - first[sides[:, 0]], axis=1)
    xi = np.linspace(-1, 1, 201)
    phi = np.array([xi*(xi - 1)/2, 1 - xi**2, xi*(xi + 1)/2])
    least = np.inf
    with run.open() as file:
        for step in sorted(file["steps"]):
            now = first + file[f"steps/{step}/node/displacement"][()][:, :2]
            for c in components:
                least = min(least, ((now[:, c][sides] @ phi).min(axis=1)/chord).min())
    return -least


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
        checks.that(len(carried) == len(run_walls(text)), f"{name}: walls in the summary", carried)
        force = [one.history["force_y_upper"][-1] for one in (run, other)]
        checks.that(carried[0] > 0.01*force[0], f"{name}: the wall carries a part of the force", carried)
        checks.small(abs(force[0]/force[1] - 1), SAME, f"{name}: force against dies along the planes")
        checks.small(abs(run.history["external_work"][-1]/other.history["external_work"][-1] - 1), SAME, f"{name}: work")
        checks.small(abs(run.history["support"][-1]/force[0] - 1), 1e-6, f"{name}: support and wall carry what the die does")
        print(f"| {name} | {BEFORE.get(name, '')} | {depth:.1e} | {100*(force[0]/force[1] - 1):.3f} "
              f"| {100*(run.history['support'][-1]/force[0] - 1):.1e} | {len(run.history['step'])} | {len(other.history['step'])} |")


def run_walls(text):
    """Supports of a deck that are walls."""
    return [line for line in text.splitlines() if line.startswith("FIXED")][:2 if "AXISYM" not in text else 1]


def main():
    checks = Checks()
    folds(checks)
    checks.end()


if __name__ == "__main__":
    main()
