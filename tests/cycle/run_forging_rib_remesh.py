#!/usr/bin/env python3
"""A flange with a hub forged by lagacycle until the cavity is full, new meshes whenever the deck's limits ask for them.

usage: run_forging_rib_remesh.py [-v] [-k] [--write]     --write puts the tables into decks/forging_rib/README.md

What is judged here is computed from nodes and dies alone: how full the cavity is (cavity.py), how far points and sides are from the
die, whether the places where contact began and ended on the old mesh lie on the contour of the new one. Forces are compared with
those of 48 x 24 elements that are never remeshed (decks/forging_rib/reference.csv).
"""
import csv
import glob
import math
import os
import sys

sys.dont_write_bytecode = True
from remeshed import ON_CONTOUR, ROOT, cycle, facts, forces_go_on, jump, put_table, tries, value_at, within_limits  # noqa: E402
from support import DONE, Checks, history, summary, with_h5py  # noqa: E402

with_h5py()
import h5py  # noqa: E402
import numpy  # noqa: E402
from cavity import Graph, cavity_volume, volume_in_cavity  # noqa: E402
from parabolas import boundary, point, rows, signed_distance  # noqa: E402

FOLDER = os.path.join(ROOT, "decks", "forging_rib")
DECK = os.path.join(FOLDER, "forging_rib_remesh.lag")
README = os.path.join(FOLDER, "README.md")
MARK = "<!-- remeshed -->"
HEIGHT, TRAVEL, DRAFT, PENETR = 11.6, 5.7, math.radians(7), 1e-3
TANGENT = math.tan(math.pi / 4 - DRAFT / 2)       # length of a fillet of radius 1 at a corner of 90 degrees less the draft
MOUTH = 28.5 + 1.5 * TANGENT                      # where the fillet towards the flash ends
FULL = 0.98
LARGEST_JUMP, LARGEST_DEVIATION, LARGEST_DRIFT = 0.02, 0.03, 0.001
TIMES_ORDINARY, LARGEST_BIAS = 2, 0.005           # change of the force at the first full steps on new meshes
SHORTEST, GAP = 0.05, 0.01                        # shares of a side: ends so near to a node go there; width of gaps
ON_AXIS = 1e-9
SAMPLES = numpy.linspace(-1, 1, 21)
AT_POINTS = slice(None, None, 10)                 # of these, where CNT2D has its three points
BETWEEN = 0.1                                     # depth of sides in fillets between points, share of the smallest element
SMALLEST = 0.5


def closed_forms(checks):
    """The measure itself, against cones, a paraboloid, and the deck's die with true circles."""
    def segment(x1, y1, x2, y2):
        return [[x1, y1], [(x1 + x2) / 2, (y1 + y2) / 2], [x2, y2]]

    cone = Graph([segment(12, 2, 10, 2), segment(10, 2, 4, 8), segment(4, 8, -1, 8)])
    exact = math.pi * (100 * 2 + (100 + 40 + 16) / 3 * 6)
    checks.that(abs(cavity_volume(cone, 10) / exact - 1) < 1e-13, "cavity: a frustum on a disc", cavity_volume(cone, 10) / exact - 1)
    bowl = Graph([[[4, 0], [2, 3], [0, 4]]])                             # y = 4 - x^2/4
    checks.that(abs(cavity_volume(bowl, 4) / (32 * math.pi) - 1) < 1e-13, "cavity: a paraboloid", cavity_volume(bowl, 4))

    def cylinder(radius, height):
        return numpy.array([segment(0, 0, radius, 0), segment(radius, 0, radius, height), segment(radius, height, 0, height),
                            segment(0, height, 0, 0)])

    inside = math.pi * (25 * 5 - (25 * 5 - 4.0**2 * 5)) + math.pi * (25 - 16) * 5    # wholly inside up to y = 5
    checks.that(abs(volume_in_cavity(cylinder(5, 5), cone, 10) / inside - 1) < 1e-13, "part in the cavity: a cylinder inside")
    cut = math.pi * (64 * 4 + 16 * 4) + math.pi / 3 * (64 + 32 + 16 - 3 * 16) * 4    # a cylinder cut by the cone from y = 4 to 8
    checks.that(abs(volume_in_cavity(cylinder(8, 9), cone, 10) / cut - 1) < 1e-12, "part in the cavity: a cylinder cut by the cone",
                volume_in_cavity(cylinder(8, 9), cone, 10) / cut - 1)
    checks.that(abs(volume_in_cavity(cylinder(11, 2), cone, 10) / (200 * math.pi) - 1) < 1e-13, "part in the cavity: cut at the mouth")


def die_volume():
    """The closed die's cavity with true circles: a polygon about the axis, its fillets by Pappus' theorem."""
    x2, x3 = 28.5 - 5 * math.tan(DRAFT), 8 + 10 * math.tan(DRAFT)
    corners = [(MOUTH, 1.0, 0), (28.5, 1.0, 1.5), (x2, 6.0, -3.0), (x3, 6.0, 4.0), (8.0, 16.0, -2.5), (0.0, 16.0, 0)]
    total = 0.0
    for (xa, ya, _), (xb, yb, _) in zip(corners, corners[1:]):
        total += 2 * math.pi * (xa - xb) * (ya * (2 * xa + xb) + yb * (xa + 2 * xb)) / 6
    for before, (x, y, radius), after in zip(corners, corners[1:-1], corners[2:]):
        ways = [numpy.array(end[:2]) - (x, y) for end in (before, after)]
        ways = [way / numpy.hypot(*way) for way in ways]
        half = math.acos(numpy.clip(ways[0] @ ways[1], -1, 1)) / 2
        middle = (ways[0] + ways[1]) / numpy.hypot(*(ways[0] + ways[1]))
        size, turn = abs(radius), math.pi / 2 - half                     # half the angle of the circle's sector
        kite, sector = size**2 / math.tan(half), size**2 * turn
        out = size / math.sin(half)                                      # from the corner to the centre
        # centroids along the bisector: of the kite's two triangles, and of the sector, counted from the corner
        at_kite = (size / math.tan(half) * math.cos(half) + out) / 3
        at_sector = out - 2 * size * math.sin(turn) / (3 * turn)
        moment = kite * (x + at_kite * middle[0]) - sector * (x + at_sector * middle[0])
        total += math.copysign(2 * math.pi * moment, radius)
    return total


def instants(out):
    """Every saved instant in order: generation, nodes now, elements, sides of contact, the penetration allowed for each, pilot,
    pressures (side, point)."""
    for path in sorted(glob.glob(os.path.join(out, "*.g[0-9][0-9].h5"))):
        with h5py.File(path, "r") as file:
            start = rows(file["mesh/coordinates"], 2)
            elements, contact = rows(file["mesh/groups/1/connectivity"], 8), rows(file["mesh/groups/2/connectivity"], 3)
        allowed = PENETR * numpy.hypot(*(start[contact[:, 2]] - start[contact[:, 0]]).T)
        for instant in sorted(glob.glob(os.path.join(path[:-3], "*.h5"))):
            with h5py.File(instant, "r") as file:
                nodes = start + file["node/displacement"][()][:, :2]
                yield int(path[-5:-3]), nodes, elements, contact, allowed, file["pilots"][0], file["points/2/state"][()][:, :, 0]


def pieces_of_die(out):
    """Pieces of the die in the pilot's axes."""
    with h5py.File(glob.glob(os.path.join(out, "*.g02.start.h5"))[0], "r") as file:
        return next(die["pieces"][()] for die in file["dies"].values() if die.attrs["name"] == b"upper")


def filling(checks, out):
    """Rows of the table of filling; the cavity full at the end."""
    pieces = pieces_of_die(out)
    closed = cavity_volume(Graph(pieces + (0.0, HEIGHT - 5.6)), MOUTH)
    off = closed / die_volume() - 1
    checks.that(abs(off) < 1e-4, "closed cavity: arcs within 1e-3 mm keep the volume of circles", off)
    lines, stroke = ["| stroke mm | cavity mm³ | part in it mm³ | full % |", "|---|---|---|---|"], -1.0
    for _, nodes, elements, _, _, pilot, _ in instants(out):
        if abs(HEIGHT - pilot[1] - stroke) < 1e-9:
            continue
        stroke, die = HEIGHT - pilot[1], Graph(pieces + pilot[:2])
        cavity, part = cavity_volume(die, MOUTH), volume_in_cavity(boundary(nodes, elements), die, MOUTH)
        full = part / cavity
        lines.append(f"| {stroke:.2f} | {cavity:.0f} | {part:.0f} | {100 * full:.2f} |")
    checks.that(full >= FULL, f"the cavity is full to {FULL:.0%}", f"{full:.2%}")
    return lines


def true_contact(checks, out):
    """At all saved instants: contact on the boundary alone, pressure only where the part touches, and nothing deeper than allowed."""
    pieces, worst = pieces_of_die(out), {"gap": -1.0, "depth": -1.0, "between": -1.0}
    for generation, nodes, elements, contact, allowed, pilot, pressure in instants(out):
        outside = {frozenset(map(tuple, side)) for side in boundary(nodes, elements)}
        sides = nodes[contact]
        checks.that(all(frozenset(map(tuple, side)) in outside for side in sides), f"mesh {generation}: contact lies on the boundary")
        points = numpy.array([point(side, SAMPLES) for side in sides])
        apart = signed_distance(pieces + pilot[:2], points.reshape(-1, 2)).reshape(points.shape[:2])
        at_points, closed = apart[:, AT_POINTS] / allowed[:, None], pressure > 0
        at_points[points[:, AT_POINTS, 0] < ON_AXIS * MOUTH] = 0.0    # no force acts on the axis: nothing holds a point there
        if numpy.any(closed):
            worst["gap"] = max(worst["gap"], numpy.max(at_points[closed]))
        worst["depth"] = max(worst["depth"], numpy.max(-at_points))
        worst["between"] = max(worst["between"], numpy.max(-apart))
    checks.that(worst["gap"] < 1, "no pressure where the die is farther than the penetration allowed", worst)
    checks.that(worst["depth"] < 1 + 1e-6, "no point deeper in the die than allowed", worst)
    checks.that(worst["between"] < BETWEEN * SMALLEST, "sides cut fillets by less than a tenth of the smallest element", worst)
    return worst


def length(side):
    """Of the chord of a side or of sides."""
    return numpy.hypot(*(side[..., 2, :] - side[..., 0, :]).T)


def ends_of_contact(checks, out, generation):
    """Where contact began and ended on the old mesh lies on the contour of the new one; cells of the table: how many ends, their
    largest distance from the corrected contour over the size of the part, that of those which are nodes from the new sides, how
    many more in gaps.

    The corrected contour goes through all ends, and new meshes have nodes where it begins and ceases to follow the die. One that is
    less than 5 % of a side beside a corner or a point in contact has its node there: the new side may be off the end itself by what
    penetration is allowed. On the axis nothing holds a node of the old mesh: the end is no deeper in the die than is allowed, wherever
    that has sunk. Ends that are not kept are those of gaps narrower than 1 % of a side, which are contact too, and of a node that touches
    beyond a free side shorter than the smallest element, which is left out."""
    names = [glob.glob(os.path.join(out, f"*.g{g:02d}.{kind}.h5"))[0] for g, kind in ((generation - 1, "end"), (generation, "start"))]
    with h5py.File(names[0], "r") as old, h5py.File(names[1], "r") as new:
        nodes = old["mesh/coordinates"][()] + old["fields/displacement/value"][()]
        contour = boundary(new["mesh/coordinates"][()] + new["fields/displacement/value"][()], new["groups/1/connectivity"][()] - 1)
        contact = nodes[old["groups/2/connectivity"][()] - 1]
        ends = [old[f"contact_ends/{k}"].attrs for k in range(1, 1 + old["contact_ends"].attrs["count"])]
        sides, places = [end["side"] - 1 for end in ends], [end["position"] for end in ends]
        begins = [end["begins"] != 0 for end in ends]
    size = numpy.max(numpy.ptp(nodes, axis=0))
    reported = facts(out, generation, "start")
    limits = reported["contour"]["limits"]
    kept = [(limit["begins"], numpy.array([limit["x"], limit["y"]])) for limit in limits]
    found = numpy.array([point(contact[side], place) for side, place in zip(sides, places)])
    off = abs(signed_distance(contour, found))
    checks.that(reported["contour"]["off_ends"] < ON_CONTOUR, f"mesh {generation}: the corrected contour goes through the ends of contact",
                reported["contour"]["off_ends"])
    for _, x in kept:
        away = numpy.hypot(*(contour[:, 0] - x).T)
        k = numpy.argmin(away)
        checks.that(away[k] < max(ON_CONTOUR * size, SHORTEST * length(contour[k])), f"mesh {generation}: a node where the contour "
                    "begins or ceases to follow the die, or within 5 % of a side of it", (x, away[k]))
    # contact of a single node, ended beside where it begins
    alone = [min(numpy.hypot(*(found[other] - found[k])) for other in range(len(found)) if begins[other] != begins[k])
             < SHORTEST * length(contact[sides[k]]) for k in range(len(found))]
    outer, exact = 0, 0.0
    for k, (side, first) in enumerate(zip(sides, begins)):
        near = min([numpy.hypot(*(x - found[k])) for begin, x in kept if begin == first], default=numpy.inf)
        if near < ON_CONTOUR * size:
            outer += 1
            exact = max(exact, off[k] / size)
            checks.that(off[k] < ON_CONTOUR * size, f"mesh {generation}: an end of contact lies on the contour", (found[k], off[k]))
        elif found[k][0] < ON_AXIS * size:
            axial = [limit["depth"] for limit in limits if limit["begins"] == first and limit["x"] < ON_AXIS * size]
            outer += len(axial)
            checks.that(len(axial) == 1 and abs(axial[0]) < PENETR * length(contact[side]),
                        f"mesh {generation}: contact that ends on the axis is no deeper there than allowed", (found[k], axial))
        elif near < SHORTEST * length(contact[side]):
            outer += 1
            checks.that(off[k] < PENETR * length(contact[side]), f"mesh {generation}: an end beside a node lies on the contour but for "
                        "what penetration is allowed", (found[k], off[k]))
        elif alone[k]:
            # a side of the smallest size goes past what is shorter
            checks.that(off[k] <= reported["contour"]["largest_move"] + SHORTEST * SMALLEST, f"mesh {generation}: a node that touches "
                        "beyond a free side too short for the mesh is off the contour by what that was moved, and 5 % of a side",
                        (found[k], off[k]))
        else:
            new = contour[numpy.argmin(numpy.hypot(*(contour[:, 1] - found[k]).T))]
            checks.that(off[k] < GAP * length(new), f"mesh {generation}: the end of a gap in contact is within 1 % of the side of "
                        "the contour", (found[k], off[k], length(new)))
    checks.that(outer == len(kept), f"mesh {generation}: every end that is kept is one of the old mesh", (outer, kept, found))
    return f"{outer} | {reported['contour']['off_ends']:.0e} | {exact:.0e} | {len(sides) - outer}"


def new_meshes(checks, out, rows):
    """Rows of the table of meshes; every mesh checked."""
    made = tries(out)
    checks.that(len(made) >= 5, "at least five new meshes", len(made))
    checks.that(all(one["accepted"] == "y" for one in made), "every new mesh is taken at the first try",
                [one["reason"] for one in made if one["accepted"] != "y"])
    lines = ["| mesh | at mm | why | elements | scaled Jacobian | ends of contact | off the contour, of the size | nodes off the "
             "new sides | ends of gaps | first residual | iterations | jump of force % | volume % |",
             "|---|---|---|---|---|---|---|---|---|---|---|---|---|"]
    initial, drift = summary(out)["initial_volume"], 0.0
    for one in made:
        generation, k = int(one["generation [-]"]), rows["step"].index(int(one["step [-]"]))
        start, restart = facts(out, generation, "start"), facts(out, generation, "restart")
        change = restart["volume_before"] / (initial * (1 + rows["volume_drift"][k])) - 1
        drift += abs(change)
        leap = jump(rows, "force_y_upper", rows["step"][k])
        checks.that(abs(leap) < LARGEST_JUMP, f"mesh {generation}: jump of the force below {LARGEST_JUMP:.0%}", f"{leap:.2%}")
        checks.that(abs(start["contour"]["volume_error"]) < 1e-12, f"mesh {generation}: the contour keeps the volume",
                    start["contour"]["volume_error"])
        lines.append(f"| {generation} | {rows['travel'][k]:.2f} | {one['trigger'].split(' ')[0]} | {start['old_elements']} -> "
                     f"{start['new_elements']} | {start['mesh']['scaled_jacobian']:.2f} | {ends_of_contact(checks, out, generation)} | "
                     f"{restart['first_residual']:.3f} | {restart['iterations']} | {100 * leap:+.2f} | {100 * change:+.4f} |")
    checks.that(drift < LARGEST_DRIFT, f"all remeshings together change the volume by less than {LARGEST_DRIFT:.1%}", f"{drift:.4%}")
    return lines


def against_one_mesh(checks, rows):
    """Rows of the table of forces and heights."""
    lines = ["| quantity | stroke mm | remeshed | 48 x 24, one mesh | % |", "|---|---|---|---|---|"]
    with open(os.path.join(FOLDER, "reference.csv"), newline="", encoding="utf-8") as file:
        fine = [row for row in csv.DictReader(file) if "48x24" in row["source"] and not row["options"]
                and row["quantity"] in ("force_y_upper", "hub_top", "rim")]
    for row in fine:
        stroke = 5.6 if row["at"] == "end" else float(row["at"].split("=")[1])
        here, there = value_at(rows, row["quantity"], "travel", stroke), float(row["expected"])
        checks.that(abs(here / there - 1) < LARGEST_DEVIATION, f"{row['quantity']} at {stroke} mm within {LARGEST_DEVIATION:.0%}",
                    f"{here / there - 1:.2%}")
        lines.append(f"| `{row['quantity']}` | {stroke:g} | {here:.6g} | {there:.6g} | {100 * (here / there - 1):+.2f} |")
    checks.that(len(fine) >= 6, "compared with the fine mesh", len(fine))
    return lines


def main():
    checks = Checks()
    closed_forms(checks)
    out = checks.path("remeshed")
    result = cycle(DECK, out)
    checks.that(result.returncode == DONE, "the cycle ends by itself", result.stdout + result.stderr)
    rows = history(out)
    rows["travel"] = [-u for u in rows["displacement_y_upper"]]
    checks.that(abs(rows["travel"][-1] - TRAVEL) < 1e-9, "the die has come to its end", rows["travel"][-1])
    within_limits(checks, out)
    forces_go_on(checks, out, TIMES_ORDINARY, LARGEST_BIAS, drops=True)
    lines = new_meshes(checks, out, rows) + [""] + filling(checks, out) + [""] + against_one_mesh(checks, rows)
    worst, deep = true_contact(checks, out), summary(out)["checks"]
    checks.that(deep["max_penetration_over_allowed"] < 1 + 1e-6, "the solver too: no point deeper than allowed, in any step",
                deep["max_penetration_over_allowed"])
    checks.that(worst["between"] < deep["max_penetration_sampled"] * (1 + 1e-6), "the solver has seen the deepest place of a side",
                (worst["between"], deep["max_penetration_sampled"]))
    lines += ["", "| of all points and saved instants | largest |", "|---|---|",
              f"| distance of a point with pressure from the die, over the penetration allowed | {worst['gap']:.2f} |",
              f"| depth of a point in the die, over the penetration allowed | {worst['depth']:.2f} |",
              f"| depth of a side between its points, mm | {worst['between']:.3f} |"]
    print("\n".join(lines))
    if "--write" in sys.argv:
        put_table(README, MARK, lines)
    checks.end()


if __name__ == "__main__":
    main()
