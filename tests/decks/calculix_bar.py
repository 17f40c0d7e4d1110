#!/usr/bin/env python3
"""The bar of decks/cooling_gps for CalculiX (ccx): how the numbers of its reference.csv came about that nobody here made.

usage: calculix_bar.py RESULTS.g01.h5 NAME
Writes NAME.inp, a slice of the bar of one layer of 20-node elements with 2x2x2 points (C3D20R) on the same mesh, whose upper face stays plane and
parallel by equations; heat, then stress in each increment (*UNCOUPLED TEMPERATURE-DISPLACEMENT); runs ccx in the folder of NAME, and prints
temperatures at times, and stresses and displacements at the end.
"""
import os
import subprocess
import sys

import h5py
import numpy as np

END, FILM, BATH, HOT, LARGEST = 300.0, 5.0, 20.0, 800.0, 15.0       # s, N/mm/s/K, degC, degC, largest change of temperature in an increment [K]
TIMES = (0.1, 2.0, 10.0, 30.0)
THICKNESS = 2.0
# decks/residual_stress/hot.met: property by temperature
LAMBDA, RHOC = ((15.0, 20.0), (26.0, 800.0)), ((3.8, 20.0), (4.8, 800.0))
YOUNG, POISSON, ALPHA = ((195000.0, 20.0), (130000.0, 800.0)), 0.3, 18e-6
YIELD, HARDENING = ((250.0, 20.0), (150.0, 400.0), (80.0, 800.0)), ((2500.0, 20.0), (600.0, 800.0))
FACES = {(0, 1): "F3", (1, 2): "F4", (2, 3): "F5", (3, 0): "F6"}


def at(table, temperature):
    values, temperatures = zip(*table)
    return float(np.interp(temperature, temperatures, values))


def extruded(x, elements):
    """Nodes (node, 3) and elements (element, 20) of one layer: a copy of the plane mesh below and above, corners in the middle."""
    count = len(x)
    corners = np.unique(elements[:, :4])
    middle = {node: 2*count + k for k, node in enumerate(corners)}
    nodes = np.vstack([np.column_stack([x, np.zeros(count)]), np.column_stack([x, np.full(count, THICKNESS)]),
                       np.column_stack([x[corners], np.full(len(corners), THICKNESS/2)])])
    solid = [[*e[:4], *(e[:4] + count), *e[4:], *(e[4:] + count), *(middle[node] for node in e[:4])] for e in elements]
    return nodes, np.array(solid), count


def lines_of(numbers):
    """A list of labels, eight on a line."""
    return [", ".join(map(str, numbers[k:k + 8])) + "," for k in range(0, len(numbers), 8)]


def material():
    """The steel, of all elements, and their temperature at the start."""
    cards = ["*MATERIAL, NAME=STEEL", "*ELASTIC"] + [f"{e}, {POISSON}, {t}" for e, t in YOUNG]
    cards += ["*PLASTIC"]
    for t in (20.0, 400.0, 800.0):
        cards += [f"{at(YIELD, t)}, 0., {t}", f"{at(YIELD, t) + at(HARDENING, t)}, 1., {t}"]
    cards += [f"*EXPANSION, ZERO={HOT}", f"{ALPHA}", "*DENSITY", "1."]
    for name, table in (("CONDUCTIVITY", LAMBDA), ("SPECIFIC HEAT", RHOC)):
        cards += [f"*{name}"] + [f"{value}, {t}" for value, t in table]
    return cards + ["*SOLID SECTION, ELSET=BAR, MATERIAL=STEEL", "*INITIAL CONDITIONS, TYPE=TEMPERATURE", f"ALL, {HOT}"]


def steps(times, last, largest, films):
    """One step from each time to the next: the least increment is a millionth of it."""
    cards = []
    for begin, end in zip((0.0,) + times, times + (last,)):
        cards += ["*STEP, INC=100000", f"*UNCOUPLED TEMPERATURE-DISPLACEMENT, DELTMX={largest}", f"{(end - begin)/1000:.6g}, {end - begin:.6g}, {(end - begin)/1e6:.6g}, 10.",
                  "*FILM", *films, "*NODE PRINT, NSET=ALL, FREQUENCY=100000", "NT, U", "*EL PRINT, ELSET=BAR, FREQUENCY=100000", "S", "*END STEP"]
    return cards


def input_deck(x, elements):
    """The text of the .inp file."""
    nodes, solid, count = extruded(x, elements)
    half = x.max()
    near = 1e-9*half
    cards = ["*NODE, NSET=ALL"] + [f"{k}, {a:.12g}, {b:.12g}, {c:.12g}" for k, (a, b, c) in enumerate(nodes, 1)]
    cards += ["*ELEMENT, TYPE=C3D20R, ELSET=BAR"]
    for k, e in enumerate(solid + 1, 1):
        cards += [f"{k}, " + ", ".join(map(str, e[:10])) + ",", ", ".join(map(str, e[10:]))]
    for name, which in (("X0", nodes[:, 0] < near), ("Y0", nodes[:, 1] < near), ("Z0", nodes[:, 2] < near)):
        cards += [f"*NSET, NSET={name}", *lines_of(np.nonzero(which)[0] + 1)]
    top = np.nonzero(nodes[:, 2] > THICKNESS - near)[0] + 1
    for node in top[1:]:
        cards += ["*EQUATION", "2", f"{node}, 3, 1., {top[0]}, 3, -1."]
    cards += material() + ["*BOUNDARY", "X0, 1, 1", "Y0, 2, 2", "Z0, 3, 3"]
    films = []
    for k, e in enumerate(elements, 1):
        for (a, b), face in FACES.items():
            for axis in (0, 1):
                if min(x[e[a], axis], x[e[b], axis]) > half - near:
                    films.append(f"{k}, {face}, {BATH}, {FILM}")
    cards += steps(TIMES, END, LARGEST, films)
    return "\n".join(cards) + "\n"


def read_answer(path):
    """Blocks of NAME.dat: (first word, time) -> rows of numbers."""
    blocks, now = {}, None
    with open(path, encoding="utf-8") as file:
        for line in file:
            words = line.split()
            if words and words[0][0].isalpha():
                now = blocks.setdefault((words[0], round(float(words[-1]), 6)), [])
            elif words:
                now.append([float(word) for word in words])
    return {key: np.array(rows) for key, rows in blocks.items()}


def calculate(deck_of):
    """Mesh of RESULTS (nodes, and elements by their places), and what CalculiX answers to NAME.inp, the deck that `deck_of` writes of it."""
    results, name = sys.argv[1:]
    with h5py.File(results) as file:
        x, elements = file["mesh/coordinates"][:], file["mesh/topology"][:]
    with open(name + ".inp", "w", encoding="utf-8") as file:
        file.write(deck_of(x, elements))
    subprocess.run(["ccx", os.path.basename(name)], cwd=os.path.dirname(os.path.abspath(name)), check=True, stdout=subprocess.DEVNULL)
    return x, elements, read_answer(name + ".dat")


def main():
    x, _, held = calculate(input_deck)
    places = {"core": (0, 0), "side": (x.max(), 0), "edge": (x.max(), x.max())}
    nodes = {label: int(np.hypot(*(x - place).T).argmin()) for label, place in places.items()}
    for time in TIMES:
        temperatures = held["temperatures", time]
        print(f"time {time:g}: " + ", ".join(f"t_{label} {temperatures[node, 1]:.2f}" for label, node in nodes.items()))
    motion, stress = held["displacements", END], held["stresses", END]
    print(f"time {END:g}: strain {motion[len(x), 3]/THICKNESS:.6f}, u_side {motion[nodes['side'], 1]:.5f}, u_edge {motion[nodes['edge'], 1]:.5f}")
    corner = 0.5/np.sqrt(3)
    for label, place in places.items():
        best = None
        for k, e in enumerate(elements, 1):
            c = x[e[:4]]
            for p, (s, t) in enumerate(((-corner, -corner), (corner, -corner), (-corner, corner), (corner, corner)), 1):
                point = (0.5 - s)*(0.5 - t)*c[0] + (0.5 + s)*(0.5 - t)*c[1] + (0.5 + s)*(0.5 + t)*c[2] + (0.5 - s)*(0.5 + t)*c[3]
                far = np.hypot(*(point - place))
                if best is None or far < best[0] - 1e-12:
                    best = far, k, p
        row, = stress[(stress[:, 0] == best[1]) & (stress[:, 1] == best[2])]
        print(f"  {label}: stress_xx {row[2]:.2f}, stress_yy {row[3]:.2f}, stress_zz {row[4]:.2f}")


if __name__ == "__main__":
    main()
