#!/usr/bin/env python3
"""Bodies with holes, given by their contours: one that closes until nothing is left of it, and a tube that rolls between its plates.

usage: run_holes.py [-v] [-k]

A plate with a hole, pressed until it closes, ends with 0 without a card for contact of the hole with itself; its force is twice and its work four times that of the quarter
between planes (run_planes_remesh.py), and the hole is left out of the mesh. A whole tube that plates alone hold, of which most points slip, has twice the force of a quarter
with the same sizes of elements, and few steps fail: the close search of a body that contact alone holds.
"""
import glob
import json
import os
import re
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from remeshed import cycle, tries  # noqa: E402
from run_planes_remesh import BODY, CASES, SAME_FORCE  # noqa: E402
from support import DONE, Checks, history, said, write  # noqa: E402

SAME_TUBE, FEW = 0.03, 8
LOWER = """DIE    lower PILOT 0. -10.
   SEGM   -40. -10.   40. -10.
CNT2D  part {rows} lower film
MOVE   lower Y press -1.
"""
PLATE = """   SEGM   -10. -10.  10. -10.
   SEGM   10. -10.   10. 10.
   SEGM   10. 10.    -10. 10.
   SEGM   -10. 10.   -10. -10.
   ARC    -2. 0.   0. 2.   2. 0.   1.E-3
   ARC    2. 0.    0. -2.  -2. 0.  1.E-3
"""
TUBE = """   ARC    -10. 0.  0. -10.  10. 0.   1.E-3
   ARC    10. 0.   0. 10.   -10. 0.  1.E-3
   ARC    -7. 0.   0. 7.    7. 0.    1.E-3
   ARC    7. 0.    0. -7.   -7. 0.   1.E-3
"""
QUARTER = """   SEGM   7. 0.   10. 0.
   ARC    10. 0.  10*sqrt(0.5) 10*sqrt(0.5)   0. 10.   1.E-3
   SEGM   0. 10.  0. 7.
   ARC    0. 7.   7*sqrt(0.5) 7*sqrt(0.5)     7. 0.    1.E-3
"""
SIZES = "   SIZE   0.3 1.\n"


def run_of(checks, name, contour, rows, support, **more):
    """Folder and history of a cycle that ends, else None."""
    folder = checks.path(name)
    text = BODY.format(state="PLSTN", contour=contour, mu=0.1, height=10, left="-40.", rows=rows, support=support.format(rows=more.pop("below", rows)), **{"sizes": "", **more})
    result = cycle(write(folder + ".lag", text), folder, "--quiet")
    if not checks.that(result.returncode == DONE, f"{name}: ends", said(result)):
        return None
    return folder, history(folder)


def closed_hole(checks):
    found = run_of(checks, "plate", PLATE, "2 3 4", LOWER, below="1 2 4", travel=3.5)
    if found is None:
        return
    folder, rows = found
    _, force, work = CASES["pore"]
    off = rows["force_y_upper"][-1]/(2*force) - 1, rows["external_work"][-1]/(4*work) - 1
    checks.that(max(map(abs, off)) <= SAME_FORCE, f"plate: force and work of four quarters within {SAME_FORCE:.0%}", f"{off[0]:.2%} {off[1]:.2%}")
    refused = [row["reason"] for row in tries(folder) if row["accepted"] == "n"]
    checks.that(len(refused) <= 2, "plate: tries refused", refused)
    print(f"plate: force {off[0]:.2%} work {off[1]:.2%} off, {len(glob.glob(os.path.join(folder, '*.restart.json')))} meshes, {len(rows['step'])} steps", flush=True)


def rolling_tube(checks):
    same = {"travel": 6, "sizes": SIZES}
    whole = run_of(checks, "tube", TUBE, "1 2", LOWER, **same)
    quarter = run_of(checks, "quarter", QUARTER, "2", "FIXED  part 1 Y\nFIXED  part 3 X\n", **same)
    if whole is None or quarter is None:
        return
    off = whole[1]["force_y_upper"][-1]/(2*quarter[1]["force_y_upper"][-1]) - 1
    checks.that(abs(off) <= SAME_TUBE, f"tube: twice the force of a quarter within {SAME_TUBE:.0%}", f"{off:.2%}")
    with open(os.path.join(whole[0], "tube.log"), encoding="utf-8") as file:
        lost = len(re.findall(r"^cutback: .* iterations without convergence", file.read(), re.MULTILINE))
    checks.that(lost <= FEW, "tube: few steps find no equilibrium", lost)
    with open(os.path.join(whole[0], "summary.json"), encoding="utf-8") as file:
        imbalance = json.load(file)["checks"]["energy_imbalance"]
    checks.that(abs(imbalance) <= 0.01, "tube: energy in balance", imbalance)
    print(f"tube: force {off:.2%} off, {lost} lost, {len(whole[1]['step'])} steps", flush=True)


def main():
    checks = Checks()
    closed_hole(checks)
    rolling_tube(checks)
    checks.end()


if __name__ == "__main__":
    main()
