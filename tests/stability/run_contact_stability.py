#!/usr/bin/env python3
"""Contact that needs no care: unlike sides of two bodies, nodes at the corner of a die.

usage: run_contact_stability.py [-v] [-k]       -v prints every check, -k keeps the results

A case answers numbers which must stay below bounds. The table has them beside those of the code before contact was changed (`before`,
measured by this script; the upper block faces the lower one with -3 points there; inf: it stopped), and what is left up to the bound (`margin`).

- `unlike`: two blocks under a uniform pressure, with sides of other lengths, by the points that a card without their number gets;
  the largest error of a stress in either, over the pressure.
- `corner`: a flat punch without friction whose corner stands on a node, pressed into a block. `lateral`: its lateral force over the
  vertical one where it is pressed in by less than the allowed depth. `moved`: its force beside that with the corner 1e-4 further out or
  further in.
- `along`: sides that do not follow their die, with ALONG: a billet whose side folds onto a flat die under glue and friction, and one
  pressed over a shoulder, whose sides span its fillet. `depth`: the largest depth of 65 places of each side in all saved steps, over
  the penetration allowed, found from nodes and die alone (tests/runs/die_depth.py). `flat`: a ring under friction whose sides follow
  their die; the force on it beside that of -3 points, in all steps.
- `bezier`: the billet that folds on two meshes, its free side with BEZIER, and the ring; numbers as in `along`.
- `ribs`: a rib of a die, narrower than half a side, pressed into a block where both of its corners lie between two points of a side.
  `beside`: its force over the mean of those with the rib a twelfth of the side to either side, less one.
- `augmented`: a billet between dies with much friction and a small allowed depth, whose multipliers are carried forward up to 20 or 50
  times a step. `cutbacks`: steps that were cut back though they had been in equilibrium, for an augmentation after it had none.
"""
import os
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), os.pardir, "patch"))
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), os.pardir, "runs"))
from die_depth import sampled  # noqa: E402
from patch_support import STRESS, Checks, Run, np, num  # noqa: E402
from run_contact_pair import PRESSURE, stacked  # noqa: E402

BOUND = {"unlike": 0.01, "lateral": 1.0e-12, "moved": 0.002, "cutbacks": 0.5, "depth": 2.0, "flat": 0.002, "beside": 0.1}
# Sides of the lower and of the upper block; before: plane strain, axisymmetric.
UNLIKE = {(4, 5): (0.095, 0.118), (5, 4): (0.166, 0.331), (7, 4): (0.225, 0.506), (4, 7): (0.056, 0.063), (10, 3): (0.776, 1.107),
          (3, 10): (0.001, 0.004), (20, 2): (np.inf, np.inf), (2, 20): (0.001, 0.001)}
# Material and its depth of indentation, points and card of the contact law, sides under the punch; before: lateral, moved.
PUNCHES = {"elastic": ("ELA", 0.02, -3, "", 5, (0.021, 0.040)), "elastic AUGMENT": ("ELA", 0.02, -3, " AUGMENT 10", 5, (0.021, 0.010)),
           "elastic fine": ("ELA", 0.02, -3, "", 10, (0.018, 0.017)), "elastic -9": ("ELA", 0.02, -9, "", 5, (0.0079, 0.0002)),
           "hardening": ("HARD", 0.1, -3, "", 5, (0.021, 0.0001)), "plastic": ("PLASTIC", 0.02, -3, "", 5, (0.021, 0.0001)),
           "plastic -5": ("PLASTIC", 0.02, -5, "", 5, (0.012, 0.0001))}
# PENETR, PHI, AUGMENT; before.
AUGMENTED = {"1e-4 phi .2": ("1.E-4", 0.2, 20, 1), "1e-5 phi .3": ("1.E-5", 0.3, 50, 1)}
# Elements along radius and height, radius, height, law, die, contact, travel; before: with -3 points.
FOLD = ("DIE d PILOT 0. 15.\n   SEGM 30. 15. -1. 15.\n", "CNT2D b 3 d {points} glue\nCNT2D b 2 d {points} film\n")
FOLD_BEZIER = (FOLD[0], "CNT2D b 3 d -3 glue\nCNT2D b 2 d {points} film\n")
SHOULDER = ("DIE d PILOT 0. 10.\n   SEGM 30. 10. 7. 10.\n   FILLT 2. 1.E-3\n   SEGM 7. 10. 7. 20.\n", "CNT2D b 2 3 d {points} film\n")
RING = ("DIE d PILOT 0. 7.\n   SEGM 30. 7. -1. 7.\n", "CNT2D b 2 3 4 d {points} film\n")
ALONG = {"fold 6x9": ("6 1. 9 1.", 0, 10, 15, FOLD, -9, 23.1), "shoulder": ("8 1. 6 1.", 0, 14, 10, SHOULDER, -3, 76.3)}
BEZIER = {"fold 6x9": ("6 1. 9 1.", 0, 10, 15, FOLD_BEZIER, -9, 23.1), "fold 12x18": ("12 1. 18 1.", 0, 10, 15, FOLD_BEZIER, -9, 30.7)}
# Width of a rib, material, friction, travel; before.
RIBS = {"elastic": (0.05, "ELA", 0.0, 0.01, np.inf), "elastic thin phi .3": (0.02, "ELA", 0.3, 0.01, np.inf),
        "plastic phi .4": (0.03, "PLASTIC", 0.4, 0.05, np.inf)}
MATERIALS = {"ELA": "LAW m ELA\n   200000. 0.3\n", "HARD": "LAW m EPLA\n   200000. 0.3\n   LINEAR 300. 500.\n",
             "PLASTIC": "LAW m EPLA\n   200000. 0.3\n   LINEAR 300. 0.\n"}


def unlike_sides(checks):
    """Rows of the table: either body faces the other."""
    rows = []
    for (low, top), both in UNLIKE.items():
        for state, before in zip(("PLSTN", "AXISYM"), both):
            run = Run(checks, f"{low}-{top}-{state}", stacked(state, "LOG", low, top, ""))
            if run.ok:
                error = max(np.abs(run.state(body, *STRESS) + (0, PRESSURE, 0, 0)).max() for body in ("low", "top"))/PRESSURE
                rows.append((f"{top} on {low} {state.lower()}", "unlike", before, error))
    return rows


def punch(checks, name, material, depth, points, card, sides, shift):
    """A punch of half width 1 on half a block; its forces in the end."""
    edge = num(1 + shift)
    text = ("TITLE flat punch\nSTATE PLSTN\nKINEM LOG\nBLOCK b PL8LS 4 m\n   0. 0. 3. 0. 3. 1.5 0. 1.5\n"
            f"   {3*sides} 1. {3*sides//2} 1.\n{MATERIALS[material]}LAW c COUL2D\n   PHI 0. PENETR 1.E-3{card}\n"
            f"DIE punch PILOT 0. 1.5\n   SEGM {edge} 3. {edge} 1.5\n   SEGM {edge} 1.5 -1. 1.5\nCNT2D b 3 punch {points} c\n"
            f"FIXED b 1 Y\nFIXED b 4 X\nLIC t\n   0. 0. 1. 1.\nMOVE punch Y t -{num(depth)}\nSTRAT 0.1 1.E-6 0.1 8 3\nSTOP 1.\nEND\n")
    run = Run(checks, name.replace(" ", "-"), text)
    return (run.history["force_x_punch"][-1], run.history["force_y_punch"][-1]) if run.ok else None


def corners(checks):
    """Rows of the table: nodes at the corner of a die."""
    rows = []
    for name, (material, depth, points, card, sides, before) in PUNCHES.items():
        setting = material, depth, points, card, sides
        slight = punch(checks, name + " slight", material, 1.0e-4/sides, points, card, sides, 0.0)
        on, out, within = (punch(checks, name + kind, *setting, shift) for kind, shift in (("", 0.0), (" out", 1e-4), (" in", -1e-4)))
        if slight:
            rows.append((f"corner {name}", "lateral", before[0], abs(slight[0]/slight[1])))
        if on and out and within:
            rows.append((f"corner {name}", "moved", before[1], max(abs(on[1]/other[1] - 1) for other in (out, within))))
    return rows


def rib(checks, name, width, material, phi, travel, place):
    """Force of a rib at a place between the middle of a block, which is a node, and the next node of a corner, 0.125 away."""
    points = [(place - side*(width/2 + slope), 0.5 + rise) for side, slope, rise in ((-1, 0.15, 0.2), (-1, 0, 0), (1, 0, 0), (1, 0.15, 0.2))]
    pieces = "".join(f"   SEGM {a[0]!r} {a[1]!r} {b[0]!r} {b[1]!r}\n" for a, b in zip(points, points[1:]))
    text = (f"TITLE rib\nSTATE PLSTN\nKINEM LOG\nBLOCK b PL8LS 4 m\n   -0.5 0. 0.5 0. 0.5 0.5 -0.5 0.5\n   8 1. 4 1.\n{MATERIALS[material]}"
            f"LAW c COUL2D\n   PENETR 1.E-3 PHI {phi}\nDIE d PILOT 0. 0.5\n{pieces}CNT2D b 3 d c\nFIXED b 1 XY\nLIC t\n   0. 0. 1. 1.\n"
            f"MOVE d Y t -{travel}\nSTRAT .05 1.E-6 .05 5 3\nEND\n")
    run = Run(checks, name, text)
    return run.history["force_y_d"][-1] if run.ok else np.inf


def ribs(checks):
    """Rows of the table: two corners of a die between two points of a side."""
    rows = []
    for name, (*setting, before) in RIBS.items():
        low, force, high = (rib(checks, f"rib-{name.replace(' ', '-')}-{k}", *setting, k/96) for k in (2, 3, 4))
        rows.append((f"ribs {name}", "beside", before, abs(2*force/(low + high) - 1)))
    return rows


def augmented(checks):
    """Rows of the table: steps cut back after they had been in equilibrium."""
    rows = []
    for name, (allowed, phi, times, before) in AUGMENTED.items():
        text = ("TITLE billet\nSTATE AXISYM\nKINEM LOG\nBLOCK b PL8LS 4 m\n   0. 0. 10. 0. 10. 15. 0. 15.\n   6 1. 9 1.\n"
                f"LAW m EPLA\n   200000. 0.3\n   LINEAR 700. 300.\nLAW c COUL2D\n   PENETR {allowed} PHI {phi} AUGMENT {times}\n"
                "DIE d PILOT 0. 15.\n   SEGM 30. 15. -1. 15.\nCNT2D b 3 d -3 c\nCNT2D b 2 d -3 c\nFIXED b 1 Y\nFIXED b 4 X\n"
                "LIC t\n   0. 0. 1. -9.\nMOVE d Y t\nSTRAT 0.01 1.E-5 0.05 5 3\nEND\n")
        run = Run(checks, name.replace(" ", "-"), text)
        if run.ok:
            rows.append((f"augmented {name}", "cutbacks", before, cutbacks_after_equilibrium(os.path.join(run.out, run.name + ".log"))))
    return rows


def billet(checks, name, points, mesh, inner, outer, height, parts, travel):
    """A billet or ring pressed by a die; its run."""
    die, contact = parts
    text = (f"TITLE along\nSTATE AXISYM\nKINEM LOG\nBLOCK b PL8LS 4 m\n   {inner}. 0. {outer}. 0. {outer}. {height}. {inner}. {height}.\n   {mesh}\n"
            "LAW m EPLA\n   200000. 0.3\n   LINEAR 700. 300.\nLAW film COUL2D\n   PENETR 1.E-3 PHI 0.3 AUGMENT 10\n"
            + ("LAW glue GLUE2D\n   PENETR 1.E-3 AUGMENT 10\n" if "glue" in contact else "")
            + die + contact.format(points=points) + "FIXED b 1 Y\n" + ("" if inner else "FIXED b 4 X\n")
            + f"LIC t\n   0. 0. 1. {travel}.\nMOVE d Y t\nSTRAT 0.01 1.E-5 0.05 5 3\nSAVE 2\nEND\n")
    return Run(checks, name, text)


def whole_sides(checks, word, cases):
    """Rows of the table: sides that do not follow their die, and sides that do, with a word that sees the whole side."""
    rows = []
    kind = word.lower()
    for name, (*setting, before) in cases.items():
        run = billet(checks, f"{kind}-{name.replace(' ', '-')}", word, *setting)
        if run.ok:
            deepest = max(row["share"] for row in sampled(os.path.join(run.out, run.name + ".g01.h5"), 65))
            rows.append((f"{kind} {name}", "depth", before, deepest/1.0e-3))
    flat = [billet(checks, f"flat-{kind}-{points}", points, "6 1. 6 1.", 6, 12, 7, RING, -2) for points in (word, "-3")]
    if all(run.ok for run in flat):
        new, old = (run.history for run in flat)
        force = np.interp(-old["displacement_y_d"], -new["displacement_y_d"], new["force_y_d"])
        rows.append((f"{kind} ring", "flat", 0.0, np.abs(force/old["force_y_d"] - 1)[old["displacement_y_d"] < -0.2].max()))
    return rows


def along(checks):
    """Rows of the table: ALONG."""
    return whole_sides(checks, "ALONG", ALONG)


def bezier(checks):
    """Rows of the table: BEZIER."""
    return whole_sides(checks, "BEZIER", BEZIER)


def cutbacks_after_equilibrium(listing):
    """Steps that were cut back with a residual below the norm among their iterations."""
    cutbacks, within = 0, False
    with open(listing, encoding="utf-8") as file:
        for line in file:
            words = line.split()
            if line.startswith(("cutback:", "step ", "event:")):
                within = line.startswith("cutback:")
            elif within and len(words) == 4 and words[0].isdigit() and float(words[1]) <= 1.0e-6:
                cutbacks, within = cutbacks + 1, False
    return cutbacks


def main():
    checks = Checks()
    print(f"{'case':24s} {'number':8s} {'before':>9s} {'now':>9s} {'bound':>9s} {'margin':>7s}")
    for part in (unlike_sides, corners, along, bezier, ribs, augmented):
        for case, what, before, now in part(checks):
            bound = BOUND[what]
            print(f"{case:24s} {what:8s} {before:9.2g} {now:9.2g} {bound:9.2g} {1 - now/bound:7.2f}", flush=True)
            checks.small(now, bound, f"{case}: {what}")
    checks.end()


if __name__ == "__main__":
    main()
