"""What the tests of lagaimport share: the program, its rows read back, decks around them."""
import os
import subprocess
import sys

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
SOURCE = os.path.abspath(os.environ.get("LAGAMINE_SOURCE") or os.path.dirname(os.path.dirname(HERE)))
BIN = os.path.abspath(os.environ.get("LAGAMINE_BIN") or os.path.join(SOURCE, "build", "bin"))
sys.path.insert(0, os.path.join(SOURCE, "src", "report"))


def run(*command, folder=None, **environment):
    """A program to its end."""
    return subprocess.run([str(word) for word in command], capture_output=True, text=True, cwd=folder, timeout=600, check=False,
                          env=dict(os.environ, PYTHONDONTWRITEBYTECODE="1", **environment))


def lagaimport(*arguments, folder=None, **environment):
    """The program that was built."""
    return run(os.path.join(BIN, "lagaimport"), *arguments, folder=folder, **environment)


def read_cards(path):
    """Cards of an included file: (keyword, words of the head, rows of words)."""
    cards = []
    with open(path, encoding="ascii") as file:
        for line in file:
            words = line.split("!")[0].split()
            if not words:
                continue
            if line[0] == " ":
                cards[-1][2].append(words)
            else:
                cards.append((words[0], words[1:], []))
    return cards


def mesh_of(path):
    """Coordinates by label, elements (label: nodes) by body, sides by set."""
    nodes, bodies, sides = {}, {}, {}
    for keyword, head, rows in read_cards(path):
        if keyword == "NODES":
            nodes = {int(row[0]): (float(row[1]), float(row[2])) for row in rows}
        elif keyword == "PL8LS":
            bodies[head[0]] = {int(row[0]): [int(word) for word in row[1:]] for row in rows}
        elif keyword == "SIDES":
            sides[head[0]] = [(int(row[0]), int(row[1])) for row in rows]
    return nodes, bodies, sides


def side_points(nodes, bodies, sides):
    """Places of the corners and the middle of sides, each side sorted."""
    ring = (1, 5, 2), (2, 6, 3), (3, 7, 4), (4, 8, 1)
    elements = {label: row for body in bodies.values() for label, row in body.items()}
    return [np.array([nodes[elements[label][k - 1]] for k in ring[side - 1]]) for label, side in sides]


def pieces_of(path, name):
    """Rows of a DIE or BODY as (form, points)."""
    for keyword, head, rows in read_cards(path):
        if keyword in ("DIE", "BODY") and head[0] == name:
            return [(row[0], np.array(list(map(float, row[1:]))[:6 if row[0] != "SEGM" else 4]).reshape(-1, 2)) for row in rows]
    raise KeyError(name)


def piece_curve(form, x, n=200):
    """Points along a row, by its definition in the deck's manual: segment, parabola by parent coordinate, circle through three points."""
    s = np.linspace(0, 1, n + 1)[:, None]
    if form == "SEGM":
        return x[0] + s * (x[1] - x[0])
    a, m, b = x
    if form == "PARAB":
        return (1 - s) * (1 - 2 * s) * a + 4 * s * (1 - s) * m + s * (2 * s - 1) * b
    # centre: equally far from the three
    centre = np.linalg.solve(2 * np.array([m - a, b - a]), np.array([m @ m - a @ a, b @ b - a @ a]))
    radius = np.hypot(*(a - centre))
    turn = [np.arctan2(*(p - centre)[::-1]) for p in (a, m, b)]
    ways = [np.unwrap([turn[0], turn[1] + k * 2 * np.pi, turn[2] + j * 2 * np.pi], period=1e9) for k in (-1, 0, 1) for j in (-1, 0, 1)]
    way = min((w for w in ways if (w[1] - w[0]) * (w[2] - w[1]) > 0), key=lambda w: abs(w[2] - w[0]))
    phi = way[0] + s * (way[2] - way[0])
    return centre + radius * np.hstack([np.cos(phi), np.sin(phi)])


def area_left(pieces):
    """Area inside closed contours, positive where it is on the left."""
    curves = [piece_curve(form, points, 2000) for form, points in pieces]
    x, y = np.vstack([curve[:-1] for curve in curves]), np.vstack([curve[1:] for curve in curves])
    return 0.5 * float((x[:, 0] * y[:, 1] - x[:, 1] * y[:, 0]).sum())


def check_deck(folder, lines):
    """`lagamine --check` of a deck of these lines."""
    path = os.path.join(folder, "deck.lag")
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")
    return run(os.path.join(BIN, "lagamine"), path, "--check")
