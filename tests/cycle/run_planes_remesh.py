#!/usr/bin/env python3
"""Bodies that fold onto planes of symmetry, by REMSH alone: a pore that closes onto both planes of a quarter, waists in plane strain and round the axis.

usage: run_planes_remesh.py [--blocks] [-v] [-k]

--blocks prints force and work on the meshes of blocks, of 14 x 14 elements each for the pore and 20 x 20 for waists.

All end with 0, hardly a try at a new mesh is refused, nothing of the last mesh is behind a plane, and force and work are those of the same decks on their first meshes of blocks, which
tests/stability/run_planes.py compares with dies along the planes and with the whole plate. Support and wall carry what the die does, on every mesh,
but in steps that the listing says were damped: viscous forces carry a part there, on some processors for a dozen steps of waist, with hardly any energy.
"""
import glob
import json
import os
import re
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from remeshed import cycle, tries  # noqa: E402
from support import DONE, Checks, history, run, said, write  # noqa: E402

SAME_FORCE, SAME_WORK, DAMPED = 0.01, 0.005, 1e-4
BODY = """TITLE  Folds onto a plane of symmetry
STATE  {state}
KINEM  LOG
BODY   part PL8LS 4 metal
{contour}LAW    metal EPLA
   200000. 0.3
   LINEAR 300. 300.
LAW    film COUL2D
   PENETR 1.E-3   PHI {mu}
DIE    upper PILOT 0. {height}
   SEGM   40. {height}   {left} {height}
CNT2D  part {rows} upper film
{support}LIC    press
   0. 0.   1. -{travel}
MOVE   upper Y press
STRAT  0.01 1.E-5 0.02   5 3
REMSH
{sizes}SAVE   10
END
"""
PLANES = {"left": "-2.", "rows": "2 3", "support": "FIXED  part 1 Y\nFIXED  part 4 X\nPROBE  support REACT Y part 1\n", "sizes": ""}
PORE = """   SEGM   2. 0.   10. 0.
   SEGM   10. 0.   10. 10.
   SEGM   10. 10.   0. 10.
   SEGM   0. 10.   0. 2.
   ARC    0. 2.   sqrt(2) sqrt(2)   2. 0.   1.E-3
"""
WAIST = """   SEGM   0. 0.   5. 0.
   SEGM   5. 0.   9. 8.
   SEGM   9. 8.   0. 8.
   SEGM   0. 8.   0. 0.
"""
# Name: numbers; force and work at the end on meshes of blocks (--blocks).
CASES = {"pore": ({"state": "PLSTN", "contour": PORE, "mu": 0.1, "height": 10, "travel": 3.5}, 8073.2, 17700.4),
         "waist": ({"state": "PLSTN", "contour": WAIST, "mu": 0.2, "height": 8, "travel": 4}, 10456.2, 19419.9),
         "waist-round": ({"state": "AXISYM", "contour": WAIST, "mu": 0.2, "height": 8, "travel": 4}, 165335.2, 341297.9)}


def on_blocks(checks):
    """What the cases are held against."""
    sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), os.pardir, "stability"))
    import run_planes  # pylint: disable=import-outside-toplevel
    for name, text, numbers, _, _ in run_planes.CASES:
        if name not in CASES:
            continue
        n = 14 if name == "pore" else 20
        folder = checks.path(name)
        result = run([write(folder + ".lag", run_planes.deck(text, numbers, n=n, m=n)), "--out", folder, "--quiet"])
        if checks.that(result.returncode == DONE, f"{name} on blocks: ends", said(result)):
            print(name, history(folder)["force_y_upper"][-1], history(folder)["external_work"][-1])
    checks.end()


def damped_steps(folder, name):
    """Steps whose forces have viscous ones in them, as the listing says."""
    with open(os.path.join(folder, name + ".log"), encoding="utf-8") as file:
        said_so = re.findall(r"^note: steps (\d+) to (\d+) were damped", file.read(), re.MULTILINE)
    return {step for first, last in said_so for step in range(int(first), int(last) + 1)}


def main():
    checks = Checks()
    if "--blocks" in sys.argv:
        on_blocks(checks)
    for name, (numbers, force, work) in CASES.items():
        folder = checks.path(name)
        result = cycle(write(folder + ".lag", BODY.format(**PLANES, **numbers)), folder, "--quiet")
        if not checks.that(result.returncode == DONE, f"{name}: ends", said(result)):
            continue
        refused = [row["reason"] for row in tries(folder) if row["accepted"] == "n"]
        checks.that(len(refused) <= 1, f"{name}: tries refused", refused)
        rows = history(folder)
        off = rows["force_y_upper"][-1]/force - 1, rows["external_work"][-1]/work - 1
        checks.that(abs(off[0]) <= SAME_FORCE, f"{name}: force within {SAME_FORCE:.0%}", f"{off[0]:.2%}")
        checks.that(abs(off[1]) <= SAME_WORK, f"{name}: work within {SAME_WORK:.1%}", f"{off[1]:.2%}")
        with open(os.path.join(folder, "summary.json"), encoding="utf-8") as file:
            summary = json.load(file)
        checks.that(summary["checks"].get("damped_share", 0) <= DAMPED, f"{name}: energy taken by damping", summary["checks"])
        damped = damped_steps(folder, name)
        apart = max(abs(support/die - 1) for step, support, die in zip(rows["step"], rows["support"], rows["force_y_upper"])
                    if die > 0.01*force and int(step) not in damped)
        checks.that(apart <= 1e-3, f"{name}: support and wall carry what the die does", f"{apart:.1e}")
        walls = summary["walls"]
        checks.that(walls and walls[0]["support"] == "FIXED part.1 Y", f"{name}: the wall is kept by all meshes", walls)
        checks.that(walls and walls[0]["force_beside_support"] > 0.05*force, f"{name}: the wall carries", walls)
        checks.that(summary["remeshings"] > 2, f"{name}: remeshed", summary["remeshings"])
        print(f"| {name} | {len(glob.glob(os.path.join(folder, '*.restart.json')))} | {len(refused)} | {len(rows['step'])} | {off[0]:.2%} | {off[1]:.2%} | {apart:.0e} |", flush=True)
    checks.end()


if __name__ == "__main__":
    main()
