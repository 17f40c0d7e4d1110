#!/usr/bin/env python3
"""The scene of a run for CalculiX (ccx), where a number that nobody here made is wanted: how those of reference.csv came about.

usage: calculix.py RESULTS.g01.h5 NAME --travel T --friction MU --law E,NU,RE,ET --penalty K [--run]
       calculix.py NAME --read U... [--nodes R,Y ...]
The first form writes NAME.inp: one block of axisymmetric elements with 2x2 points (CAX8R) on the mesh as it begins, held in y at
y = 0 and in x at x = 0; its die, which moves down by T, as a strip of elements whose nodes are all held; contact of
surfaces with Coulomb friction and a linear penalty; linear hardening. --run runs ccx too. The second form reads NAME.dat and
prints the force of the die, full circumference, at travels U, and where nodes came to that began at R,Y.
"""
import argparse
import os
import subprocess

import numpy as np

WEDGES = 180                # CalculiX makes a wedge of 2 degrees of an axisymmetric body and reports the forces on that
STEPS = "0.002, 1., 1.E-6, 0.01"
LARGEST_STRAIN = 5.0
STRIP = 1.0                 # thickness of the die's elements [length]
PARTS = 20                  # elements of the die for each piece
SIDES = ((0, 1), (1, 2), (2, 3), (3, 0))


def shape(xi):
    return np.array([xi*(xi - 1)/2, 1 - xi*xi, xi*(xi + 1)/2])


def die_points(pieces):
    """Points along the curve, none beyond the axis, and their images in the die's body."""
    along = np.linspace(-1, 1, PARTS, endpoint=False)
    points = np.array([shape(xi) @ piece for piece in pieces for xi in along] + [pieces[-1][2]])
    beyond = np.nonzero(points[:, 0] < 0)[0]
    if beyond.size:
        a, b = points[beyond[0] - 1], points[beyond[0]]
        points = np.vstack([points[:beyond[0]], a + (b - a)*a[0]/(a[0] - b[0])])
    way = np.gradient(points, axis=0)
    inward = np.column_stack([way[:, 1], -way[:, 0]])/np.hypot(way[:, 0], way[:, 1])[:, None]
    image = points + STRIP*inward
    image[:, 0] = np.maximum(image[:, 0], 0)
    return points, image


def read_scene(path):
    """Coordinates, elements, sides in contact, pieces of the die; all numbers of nodes from 0."""
    import h5py

    with h5py.File(path) as file:
        first = file["steps"][sorted(file["steps"])[0]]
        if len(file["dies"]) != 1:
            raise SystemExit(f"{path}: one die is wanted")
        pieces = next(iter(file["dies"].values()))[:] + first["pilots"][0][:2]
        groups = [group["connectivity"][:] for group in file["mesh/groups"].values()]
        return file["mesh/coordinates"][:], file["mesh/topology"][:], [g for g in groups if g.shape[1] == 3], pieces


def input_deck(path, travel, friction, law, penalty):
    """The text of the .inp file."""
    x, elements, contacts, pieces = read_scene(path)
    points, image = die_points(pieces)
    young, poisson, strength, hardening = law
    count, strip = len(x), len(points)
    cards = ["*NODE, NSET=ALL"]
    cards += [f"{k}, {r:.12g}, {y:.12g}, 0." for k, (r, y) in enumerate(np.vstack([x, points, image]), 1)]
    cards += ["*ELEMENT, TYPE=CAX8R, ELSET=BODY"]
    cards += [f"{k}, " + ", ".join(str(node + 1) for node in nodes) for k, nodes in enumerate(elements, 1)]
    cards += ["*ELEMENT, TYPE=CAX4, ELSET=DIE"]
    cards += [f"{len(elements) + k}, {count + k + 1}, {count + k}, {count + strip + k}, {count + strip + k + 1}"
              for k in range(1, strip)]
    sets = {"MIDDLE": np.nonzero(x[:, 1] == 0)[0], "AXIS": np.nonzero(x[:, 0] == 0)[0],
            "HELD": np.arange(count, count + 2*strip)}
    for name, nodes in sets.items():
        if nodes.size:
            cards += [f"*NSET, NSET={name}"] + [f"{node + 1}," for node in nodes]
    side_of = {frozenset((nodes[a], nodes[b])): f"{k}, S{side}"
               for k, nodes in enumerate(elements, 1) for side, (a, b) in enumerate(SIDES, 1)}
    cards += ["*SURFACE, NAME=PART, TYPE=ELEMENT"]
    cards += [side_of[frozenset((side[0], side[2]))] for sides in contacts for side in sides]
    cards += ["*SURFACE, NAME=TOOL, TYPE=ELEMENT"] + [f"{len(elements) + k}, S1" for k in range(1, strip)]
    cards += ["*MATERIAL, NAME=METAL", "*ELASTIC", f"{young}, {poisson}", "*PLASTIC", f"{strength}, 0.",
              f"{strength + LARGEST_STRAIN*hardening}, {LARGEST_STRAIN}", "*SOLID SECTION, ELSET=BODY, MATERIAL=METAL",
              "*MATERIAL, NAME=HARD", "*ELASTIC", f"{young}, {poisson}", "*SOLID SECTION, ELSET=DIE, MATERIAL=HARD",
              "*SURFACE INTERACTION, NAME=FILM", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", f"{penalty}",
              "*FRICTION", f"{friction}, {penalty/10}",
              "*CONTACT PAIR, INTERACTION=FILM, TYPE=SURFACE TO SURFACE", "PART, TOOL",
              "*BOUNDARY", "MIDDLE, 2, 2"] + ["AXIS, 1, 1"]*(sets["AXIS"].size > 0)
    cards += ["HELD, 1, 1", "*STEP, NLGEOM, INC=10000", "*STATIC", STEPS, "*BOUNDARY", f"HELD, 2, 2, {-travel}",
              "*NODE PRINT, NSET=HELD, TOTALS=ONLY", "RF", "*NODE PRINT, NSET=ALL", "U", "*END STEP"]
    return "\n".join(cards) + "\n"


def read_answer(name):
    """Times, forces, and displacements by time and node."""
    times, forces, motions, now, what = [], [], {}, 0.0, ""
    with open(name + ".dat", encoding="utf-8") as file:
        for line in file:
            words = line.split()
            if line.lstrip().startswith(("total force", "displacements")):
                what, now = words[0], float(words[-1])
            elif words and what == "total":
                times.append(now)
                forces.append(WEDGES*abs(float(words[1])))
            elif words and what == "displacements":
                motions.setdefault(now, {})[int(words[0])] = np.array(words[1:3], dtype=float)
    return times, forces, motions


def first_mesh(name):
    """Nodes of NAME.inp and the travel of its die."""
    with open(name + ".inp", encoding="utf-8") as file:
        lines = file.read().split("\n")
    nodes = {}
    for line in lines[1:]:
        if line.startswith("*"):
            break
        words = line.split(",")
        nodes[int(words[0])] = np.array(words[1:3], dtype=float)
    travel = next(-float(line.split(",")[3]) for line in lines if line.startswith("HELD, 2, 2"))
    return nodes, travel


def report(name, travels, places):
    nodes, travel = first_mesh(name)
    times, forces, motions = read_answer(name)
    chosen = {place: min(nodes, key=lambda k, p=place: np.hypot(*(nodes[k] - p))) for place in places}
    for u in travels:
        if u > times[-1]*travel*(1 + 1e-9):
            print(f"u = {u}: not reached, the end is {times[-1]*travel:.4f}")
            continue
        print(f"u = {u}: force {np.interp(u/travel, times, forces):.6g}")
        for place, k in chosen.items():
            where = [np.interp(u/travel, list(motions), [motion[k][c] for motion in motions.values()]) for c in (0, 1)]
            print(f"  {place} is at ({nodes[k][0] + where[0]:.5g}, {nodes[k][1] + where[1]:.5g})")


def numbers(text):
    return tuple(float(word) for word in text.split(","))


def main():
    parser = argparse.ArgumentParser(description="The scene of a run for CalculiX.")
    parser.add_argument("files", nargs="+", metavar="RESULTS NAME | NAME")
    parser.add_argument("--travel", type=float)
    parser.add_argument("--friction", type=float)
    parser.add_argument("--law", type=numbers)
    parser.add_argument("--penalty", type=float)
    parser.add_argument("--run", action="store_true")
    parser.add_argument("--read", type=float, nargs="+")
    parser.add_argument("--nodes", type=numbers, nargs="+", default=[])
    options = parser.parse_args()
    name = options.files[-1]
    if options.read:
        report(name, options.read, options.nodes)
        return
    if len(options.files) != 2 or None in (options.travel, options.friction, options.law, options.penalty):
        parser.error("RESULTS NAME and --travel, --friction, --law, --penalty are wanted")
    with open(name + ".inp", "w", encoding="utf-8") as file:
        file.write(input_deck(options.files[0], options.travel, options.friction, options.law, options.penalty))
    if options.run:
        subprocess.run(["ccx", os.path.basename(name)], cwd=os.path.dirname(os.path.abspath(name)), check=False)


if __name__ == "__main__":
    main()
