#!/usr/bin/env python3
"""A flange with a hub forged by lagacycle from a contour: the first mesh too is made by the remesher, from ZONE cards.

usage: run_forging_zones.py [-v] [-k] [--write]     --write puts the tables into decks/forging_zones/README.md

Compared with decks/forging_rib on 48 x 24 elements that are never remeshed. The jump of the force at a remesh is that of the first
step on the new mesh from the straight line through the last two on the old one. Whether contact lies on the contour is found here
from the elements of the new mesh.
"""
import collections
import glob
import math
import os
import sys

sys.dont_write_bytecode = True
from remeshed import ROOT, cycle, facts, jump, put_table, tries, value_at  # noqa: E402
from support import DONE, NO_CONVERGENCE, Checks, history, run, said, summary, with_h5py  # noqa: E402

with_h5py()
import h5py  # noqa: E402

DECK = os.path.join(ROOT, "decks", "forging_zones", "forging_zones.lag")
PLAIN = os.path.join(ROOT, "decks", "forging_rib", "forging_rib.lag")
README = os.path.join(os.path.dirname(DECK), "README.md")
MARK = "<!-- table -->"
RADIUS, HEIGHT, TRAVEL = 22.0, 11.6, 5.6
YOUNG, POISSON = 70000.0, 0.33
STROKES = (1, 3, 4, 4.5, 5, 5.2, 5.4, 5.6)
QUANTITIES = ("force_y_upper", "hub_top", "rim")
LARGEST_JUMP, LARGEST_DEVIATION, LARGEST_DRIFT = 0.02, 0.03, 0.001


def nodes_of(dataset, width):
    """Rows of node numbers, however the file turns them."""
    table = dataset[()]
    return [tuple(int(n) for n in row) for row in (table if table.shape[1] == width else table.T)]


def contact_on_contour(checks, out, generation):
    """Sides in contact are sides of one element alone, each once, and they are all of the body's sides 2 and 3."""
    ending = "end" if generation == 2 else "start"  # on the first mesh it is the deck's cards that set contact up
    with h5py.File(glob.glob(os.path.join(out, f"*.g{generation:02d}.{ending}.h5"))[0], "r") as file:
        elements = nodes_of(file["groups/1/connectivity"], 8)
        contact = nodes_of(file["groups/2/connectivity"], 3)
        asked = [side for k in ("2", "3") for side in nodes_of(file[f"mesh/sides/{k}/nodes"], 3)]
    count = collections.Counter(frozenset((e[i], e[4 + i], e[(i + 1) % 4])) for e in elements for i in range(4))
    inside = [side for side in contact if count[frozenset(side)] != 1]
    checks.that(not inside, f"mesh {generation}: contact lies on the contour", inside[:3])
    once = len({frozenset(side) for side in contact}) == len(contact)
    checks.that(once and {frozenset(s) for s in contact} == {frozenset(s) for s in asked},
                f"mesh {generation}: all of sides 2 and 3 is in contact's care, once", (len(contact), len(asked)))
    joined = all(one[2] == two[0] for one, two in zip(contact, contact[1:]))
    checks.that(joined, f"mesh {generation}: sides of contact follow one another")
    return len(contact)


def new_meshes(checks, out, rows):
    """Rows of the table of meshes; every mesh checked."""
    made_meshes = tries(out)
    checks.that(len(made_meshes) >= 4, "a first mesh and at least three after it", len(made_meshes))
    checks.that(all(t["accepted"] == "y" for t in made_meshes), "every new mesh is taken at the first try",
                [t["reason"] for t in made_meshes if t["accepted"] != "y"])
    volume = summary(out)["initial_volume"]
    checks.that(abs(volume / (math.pi * RADIUS**2 * HEIGHT) - 1) < 1e-12, "the first mesh has the volume of the contour", volume)
    lines = ["| mesh | at mm | elements | sides of contact | scaled Jacobian | first residual | iterations | jump of force % | "
             "volume % |", "|---|---|---|---|---|---|---|---|---|"]
    drift = 0.0
    for one in made_meshes:
        generation, step = int(one["generation [-]"]), int(one["step [-]"])
        made = facts(out, generation, "start")
        sides = contact_on_contour(checks, out, generation)
        checks.that(abs(made["contour"]["volume_error"]) < 1e-12, f"mesh {generation}: the contour keeps the volume",
                    made["contour"]["volume_error"])
        checks.that(made["mesh"]["off_contour"] < 1e-9 * RADIUS, f"mesh {generation}: its nodes lie on the contour",
                    made["mesh"]["off_contour"])
        line = (f"| {generation} | {{at}} | {made['old_elements']} -> {made['new_elements']} | {sides} | "
                f"{made['mesh']['scaled_jacobian']:.2f} |")
        if step == 0:
            lines.append(line.format(at=0) + " | | | |")
            continue
        restart = facts(out, generation, "restart")
        k = rows["step"].index(step)
        change = restart["volume_before"] / (volume * (1 + rows["volume_drift"][k])) - 1
        drift += abs(change)
        leap = jump(rows, "force_y_upper", step)
        checks.that(abs(leap) < LARGEST_JUMP, f"mesh {generation}: jump of the force below {LARGEST_JUMP:.0%}", f"{leap:.2%}")
        lines.append(line.format(at=f"{-rows['displacement_y_upper'][k]:.2f}") + f" {restart['first_residual']:.3f} | "
                     f"{restart['iterations']} | {100 * leap:+.2f} | {100 * change:+.4f} |")
    checks.that(drift < LARGEST_DRIFT, f"all remeshings together change the volume by less than {LARGEST_DRIFT:.1%}",
                f"{drift:.4%}")
    return lines


def no_first_mesh(checks):
    """Without a first mesh there is none to go on with: the cycle ends and says what is wrong."""
    code, words = cycle(DECK, checks.path("none"), "-p", "line=40")
    checks.that(code == NO_CONVERGENCE, "zones that miss the part: the cycle ends", words)
    checks.that("the contour does not cross x = 40" in words, "zones that miss the part: told", words)


def main():
    checks = Checks()
    no_first_mesh(checks)
    out, plain = checks.path("zones"), checks.path("plain")
    code, words = cycle(DECK, out)
    checks.that(code == DONE, "the cycle ends by itself", words)
    rows = history(out)
    rows["travel"] = [-u for u in rows["displacement_y_upper"]]
    checks.that(abs(rows["displacement_y_upper"][-1] + TRAVEL) < 1e-9, "the die is closed", rows["displacement_y_upper"][-1])
    lines = new_meshes(checks, out, rows)

    deep = summary(out)["checks"]
    checks.that(deep["max_penetration_over_allowed"] < 1.000001, "no point deeper in the die than PENETR allows",
                deep["max_penetration_over_allowed"])
    pressure = rows["force_y_upper"][-1] / (math.pi * rows["rim"][-1] ** 2)
    elastic = 3 * (1 - 2 * POISSON) / YOUNG * pressure
    share = -rows["volume_drift"][-1] / elastic
    checks.that(0 < share < 1, "at the end the volume lacks no more than the elastic volume under the mean pressure", share)

    result = run([PLAIN, "--out", plain, "--threads", "1", "-p", "nx=48", "-p", "ny=24"])
    checks.that(result.returncode == DONE, "48 x 24 without remeshing: done", said(result))
    fine, fine_deep = history(plain), summary(plain)["checks"]
    fine["travel"] = [-u for u in fine["displacement_y_upper"]]
    lines += ["", "| stroke mm | force kN | 48 x 24, one mesh, kN | % | hub mm | 48 x 24 | % | rim mm | 48 x 24 | % |",
              "|---|---|---|---|---|---|---|---|---|---|"]
    for stroke in STROKES:
        cells = [f"{stroke:g}"]
        for name in QUANTITIES:
            here, there = (value_at(r, name, "travel", stroke) for r in (rows, fine))
            checks.that(abs(here / there - 1) < LARGEST_DEVIATION, f"{name} at {stroke} mm within {LARGEST_DEVIATION:.0%}",
                        f"{here / there - 1:.2%}")
            unit, digits = (1000.0, 1) if name.startswith("force") else (1.0, 3)
            cells += [f"{here / unit:.{digits}f}", f"{there / unit:.{digits}f}", f"{100 * (here / there - 1):+.2f}"]
        lines.append("| " + " | ".join(cells) + " |")
    lines += ["", "| largest penetration | remeshed | 48 x 24 |", "|---|---|---|"]
    for words, name in (("at points, share of what PENETR allows", "max_penetration_over_allowed"),
                        ("between points, mm", "max_penetration_sampled")):
        lines.append(f"| {words} | {deep[name]:.3f} | {fine_deep[name]:.3f} |")
    print("\n".join(lines))
    if "--write" in sys.argv:
        put_table(README, MARK, lines)
    checks.end()


if __name__ == "__main__":
    main()
