"""What the forgings share whose first mesh too is made by the remesher: the same billet, die and reference.

The jump of the force at a remesh is that of the first step on the new mesh from the straight line through the last two on the old
one. Whether contact lies on the contour is found here from the elements of the new mesh. The reference is decks/forging_rib on
48 x 24 elements that are never remeshed; run_forging_zones.py runs it and keeps what it gave in REFERENCE.
"""
import collections
import csv
import glob
import math
import os

from remeshed import ROOT, facts, forces_go_on, jump, tries, value_at, within_limits
from support import history, summary, with_h5py

with_h5py()
import h5py  # noqa: E402

PLAIN = os.path.join(ROOT, "decks", "forging_rib", "forging_rib.lag")
REFERENCE = os.path.join(os.path.dirname(PLAIN), "mesh_48x24.csv")
MARK = "<!-- table -->"
RADIUS, HEIGHT, TRAVEL = 22.0, 11.6, 5.6
YOUNG, POISSON = 70000.0, 0.33
STROKES = (1, 3, 4, 4.5, 5, 5.2, 5.4, 5.6)
QUANTITIES = ("force_y_upper", "hub_top", "rim")
PENETRATIONS = ("max_penetration_over_allowed", "max_penetration_sampled")
LARGEST_JUMP, LARGEST_DEVIATION, LARGEST_DRIFT = 0.02, 0.03, 0.001
TIMES_ORDINARY, LARGEST_BIAS = 2, 0.015     # change of the force at the first full steps on new meshes


def at_stroke(rows, name, stroke):
    """A column of the history where the die has moved this far, straight between steps."""
    return value_at(dict(rows, travel=[-u for u in rows["displacement_y_upper"]]), name, "travel", stroke)


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


def new_meshes(checks, out, rows, mesher):
    """Rows of the table of meshes; every mesh checked."""
    rows_of_cycle = tries(out)
    checks.that(len(rows_of_cycle) >= 4, "a first mesh and at least three after it", len(rows_of_cycle))
    checks.that(all(t["accepted"] == "y" for t in rows_of_cycle), "every new mesh is taken at the first try",
                [t["reason"] for t in rows_of_cycle if t["accepted"] != "y"])
    within_limits(checks, out)
    forces_go_on(checks, out, TIMES_ORDINARY, LARGEST_BIAS)
    volume = summary(out)["initial_volume"]
    checks.that(abs(volume / (math.pi * RADIUS**2 * HEIGHT) - 1) < 1e-12, "the first mesh has the volume of the contour", volume)
    lines = ["| mesh | at mm | elements | sides of contact | scaled Jacobian | first residual | iterations | jump of force % | "
             "volume % |", "|---|---|---|---|---|---|---|---|---|"]
    drift = 0.0
    for one in rows_of_cycle:
        generation, step = int(one["generation [-]"]), int(one["step [-]"])
        made = facts(out, generation, "start")
        checks.that(made["mesh"]["mesher"] == mesher, f"mesh {generation}: made by {mesher}", made["mesh"]["mesher"])
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


def results(out):
    """What is compared with the reference: quantities at strokes, and penetrations."""
    rows, checks = history(out), summary(out)["checks"]
    values = {(name, stroke): at_stroke(rows, name, stroke) for stroke in STROKES for name in QUANTITIES}
    return values | {(name, TRAVEL): checks[name] for name in PENETRATIONS}


def write_reference(values):
    """The file of the reference."""
    with open(REFERENCE, "w", newline="", encoding="utf-8") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(("quantity", "stroke_mm", "value"))
        table.writerows((name, f"{stroke:g}", f"{value:.9g}") for (name, stroke), value in values.items())


def read_reference():
    """What the run on 48 x 24 elements gave."""
    with open(REFERENCE, newline="", encoding="utf-8") as file:
        return {(row["quantity"], float(row["stroke_mm"])): float(row["value"]) for row in csv.DictReader(file)}


def closed(checks, out, rows):
    """The die is closed, no point is too deep in it, and the volume is there but for what is elastic."""
    checks.that(abs(rows["displacement_y_upper"][-1] + TRAVEL) < 1e-9, "the die is closed", rows["displacement_y_upper"][-1])
    deep = summary(out)["checks"]["max_penetration_over_allowed"]
    checks.that(deep < 1.000001, "no point deeper in the die than PENETR allows", deep)
    pressure = rows["force_y_upper"][-1] / (math.pi * rows["rim"][-1] ** 2)
    elastic = 3 * (1 - 2 * POISSON) / YOUNG * pressure
    share = -rows["volume_drift"][-1] / elastic
    checks.that(0 < share < 1, "at the end the volume lacks no more than the elastic volume under the mean pressure", share)


def compared(checks, mine, fine):
    """Rows of the tables against the reference; every number checked."""
    lines = ["", "| stroke mm | force kN | 48 x 24, one mesh, kN | % | hub mm | 48 x 24 | % | rim mm | 48 x 24 | % |",
             "|---|---|---|---|---|---|---|---|---|---|"]
    for stroke in STROKES:
        cells = [f"{stroke:g}"]
        for name in QUANTITIES:
            here, there = mine[name, stroke], fine[name, stroke]
            checks.that(abs(here / there - 1) < LARGEST_DEVIATION, f"{name} at {stroke} mm within {LARGEST_DEVIATION:.0%}",
                        f"{here / there - 1:.2%}")
            unit, digits = (1000.0, 1) if name.startswith("force") else (1.0, 3)
            cells += [f"{here / unit:.{digits}f}", f"{there / unit:.{digits}f}", f"{100 * (here / there - 1):+.2f}"]
        lines.append("| " + " | ".join(cells) + " |")
    lines += ["", "| largest penetration | remeshed | 48 x 24 |", "|---|---|---|"]
    for words, name in zip(("at points, share of what PENETR allows", "between points, mm"), PENETRATIONS):
        lines.append(f"| {words} | {mine[name, TRAVEL]:.3f} | {fine[name, TRAVEL]:.3f} |")
    return lines
