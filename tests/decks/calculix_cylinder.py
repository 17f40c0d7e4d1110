#!/usr/bin/env python3
"""The bar of decks/residual_stress for CalculiX (ccx): how the numbers of its reference.csv came about that nobody here made.

usage: calculix_cylinder.py RESULTS.g01.h5 NAME
Writes NAME.inp, the same mesh of axisymmetric elements of 8 nodes with 2x2 points (CAX8R), with temperatures at all of them; heat, then stress
in each increment, of the steel of calculix_bar.py; runs ccx in the folder of NAME, and prints the stresses at the end next to axis and side.
"""
import numpy as np

from calculix_bar import BATH, FILM, calculate, lines_of, material, steps

TIMES, END, LARGEST = (0.1, 2.0, 10.0), 150.0, 5.0      # s, s, largest change of temperature in an increment [K]
SIDES = ((0, 1), (1, 2), (2, 3), (3, 0))


def input_deck(x, elements):
    """The text of the .inp file."""
    radius = x[:, 0].max()
    near = 1e-9*radius
    cards = ["*NODE, NSET=ALL"] + [f"{k}, {a:.12g}, {b:.12g}, 0." for k, (a, b) in enumerate(x, 1)]
    cards += ["*ELEMENT, TYPE=CAX8R, ELSET=BAR"] + [f"{k}, " + ", ".join(map(str, e)) for k, e in enumerate(elements + 1, 1)]
    for name, axis in (("X0", 0), ("Y0", 1)):
        cards += [f"*NSET, NSET={name}", *lines_of(np.nonzero(x[:, axis] < near)[0] + 1)]
    films = [f"{k}, F{side}, {BATH}, {FILM}" for k, e in enumerate(elements, 1) for side, (a, b) in enumerate(SIDES, 1)
             if min(x[e[a], 0], x[e[b], 0]) > radius - near]
    cards += material() + ["*BOUNDARY", "X0, 1, 1", "Y0, 2, 2"] + steps(TIMES, END, LARGEST, films)
    return "\n".join(cards) + "\n"


def main():
    x, elements, answer = calculate(input_deck)
    stress = answer["stresses", END]
    # the first element at the axis and the last one at the side, in the middle of the length
    below = [k for k, e in enumerate(elements, 1) if x[e[:2], 1].max() <= 0]
    for label, element, point in (("core", below[0], 1), ("side", below[-1], 2)):
        row, = stress[(stress[:, 0] == element) & (stress[:, 1] == point)]
        print(f"{label}: stress_xx {row[2]:.2f}, stress_yy {row[3]:.2f}, stress_zz {row[4]:.2f}")


if __name__ == "__main__":
    main()
