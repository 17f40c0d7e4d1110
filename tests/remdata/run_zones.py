#!/usr/bin/env python3
"""New meshes by ZONE cards in whole runs: a forging with a hub and a flange, a body written out by PL8LS cards, and bodies that have a
contour and no mesh.

usage: run_zones.py [-v] [-k]

The forging of decks/forging_rib on 14 x 7 elements is remeshed three times. Shapes of elements, the line between the zones and the volume
are found here from the nodes of the checkpoints; forces and heights at the end are compared with those of a mesh of 48 x 24 elements
that was never remeshed (decks/forging_rib/reference.csv).
"""
import csv
import json
import os
import subprocess
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "runs"))
from support import BIN, DONE, INPUT, LONGEST_RUN, NO_CONVERGENCE, SOURCE, Checks, add_cards, deck_text, history, run, said, with_h5py, write  # noqa: E402

with_h5py()
import h5py  # noqa: E402
import numpy as np  # noqa: E402

REMESH = 4
FORGING = os.path.join(SOURCE, "decks", "forging_rib", "forging_rib.lag")
LINE = 11.0  # where hub and flange meet
HUB_AND_FLANGE = f"""
REMSH
   TIMES 0.6 0.8 0.9
   STRAIN 0.03
ZPNT   middle CORNER 0. 0.
ZPNT   top    ON X 0. UPPER
ZPNT   foot   ON X {LINE} UPPER
ZPNT   base   ON X {LINE} LOWER
ZPNT   rim    CORNER 22. 0. MATTER
ZPNT   roof   CORNER 22. $height MATTER
ZONE   hub    billet
   middle base foot top
ZONE   flange billet
   base rim roof foot
"""
SMALL_STRIP = """TITLE  A strip of elements written out is pressed
STATE  PLSTN
KINEM  LOG
{mesh}LAW    metal EPLA
   70000. 0.33
   LINEAR 200. 200.
LAW    film COUL2D
   PENETR 1.E-3   PHI 0.1
DIE    upper PILOT 0. 4.
   SEGM   20. 4.   -1. 4.
CNT2D  lid upper -3 film
FIXED  floor Y
FIXED  wall X
MOVE   upper Y press
LIC    press
   0. 0.   1. -1.
STRAT  0.02 1.E-6 0.1   6 3
REMSH
   TIMES 0.5
END
"""
ONE_ZONE = """
ZPNT   a CORNER 0. 0. MATTER
ZPNT   b CORNER 6. 0. MATTER
ZPNT   c CORNER 6. 4. MATTER
ZPNT   d CORNER 0. 4. MATTER
ZONE   all slab
   a b c d
"""


def cards_of_grid(nx, ny, width, height):
    """NODES, PL8LS and SIDES cards of a rectangle."""
    label = {}
    nodes = ["NODES"]
    for j in range(2 * ny + 1):
        for i in range(2 * nx + 1):
            if i % 2 and j % 2:
                continue
            label[i, j] = len(label) + 1
            nodes.append(f"   {label[i, j]}  {width * i / (2 * nx)!r} {height * j / (2 * ny)!r}")
    elements, floor, lid, wall = ["PL8LS  slab 4 metal"], ["SIDES  floor"], ["SIDES  lid"], ["SIDES  wall"]
    places = ((0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1))
    for j in range(ny):
        for i in range(nx):
            number = len(elements)
            elements.append(f"   {number}  " + " ".join(str(label[2 * i + a, 2 * j + b]) for a, b in places))
            floor += [f"   {number} 1"] if j == 0 else []
            lid += [f"   {number} 3"] if j == ny - 1 else []
            wall += [f"   {number} 4"] if i == 0 else []
    return "\n".join(nodes + elements + floor + lid + wall) + "\n"


class Mesh:
    """Nodes now and elements of the first group of a checkpoint."""

    def __init__(self, path):
        with h5py.File(path, "r") as file:
            self.x = self.rows(file["mesh/coordinates"][()], 2) + self.rows(file["fields/displacement/value"][()], 2)
            self.elements = self.rows(file["groups/1/connectivity"][()], 8) - 1

    @staticmethod
    def rows(array, width):
        return array if array.shape[1] == width else array.T

    def jacobians(self):
        """(element, 3 x 3 points) over the largest of the element."""
        values = []
        for r in (-1.0, 0.0, 1.0):
            for s in (-1.0, 0.0, 1.0):
                nr, ns = slopes(r, s)
                points = self.x[self.elements]
                dr, ds = np.einsum("k,ekc->ec", nr, points), np.einsum("k,ekc->ec", ns, points)
                values.append(dr[:, 0] * ds[:, 1] - dr[:, 1] * ds[:, 0])
        values = np.array(values).T
        return values / values.max(axis=1, keepdims=True)

    def volume(self, round_about):
        """Area, or volume over one radian, by 3 x 3 Gauss points: exact."""
        total = 0.0
        for r, a in zip(*np.polynomial.legendre.leggauss(4)):
            for s, b in zip(*np.polynomial.legendre.leggauss(4)):
                nr, ns = slopes(r, s)
                points = self.x[self.elements]
                dr, ds = np.einsum("k,ekc->ec", nr, points), np.einsum("k,ekc->ec", ns, points)
                radius = points[:, :, 0] @ shapes(r, s) if round_about else 1.0
                total += a * b * np.sum((dr[:, 0] * ds[:, 1] - dr[:, 1] * ds[:, 0]) * radius)
        return total


def shapes(r, s):
    """Shape functions of the 8-node element."""
    corners = [((1 + r * a) * (1 + s * b) * (r * a + s * b - 1)) / 4 for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    return np.array(corners + [(1 - r * r) * (1 - s) / 2, (1 + r) * (1 - s * s) / 2, (1 - r * r) * (1 + s) / 2, (1 - r) * (1 - s * s) / 2])


def slopes(r, s, h=1e-5):
    """Their derivatives: central differences are exact for quadratics, and to 1e-10 for these."""
    return (shapes(r + h, s) - shapes(r - h, s)) / (2 * h), (shapes(r, s + h) - shapes(r, s - h)) / (2 * h)


def remesh(checks, what, old, new, code=DONE):
    result = subprocess.run([os.path.join(BIN, "remdata"), old, "--out", new, "--quiet"], text=True, stdin=subprocess.DEVNULL,
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=LONGEST_RUN, check=False)
    checks.that(result.returncode == code, f"{what}: remdata ends with {code}", said(result))
    with open(new + ".json", encoding="utf-8") as file:
        return result.stderr, json.load(file)


def whole_cycle(checks, name, text, options, round_about, most):
    """Run, remesh whenever asked; the meshes made. `most` is the change of volume that a remesh may make."""
    folder = checks.path(name)
    deck = write(os.path.join(folder, "case.lag"), text)
    base = [deck, "--out", folder, "--threads", "1", "--quiet"] + options
    result = run(base)
    meshes = []
    while result.returncode == REMESH and len(meshes) < 5:
        generation = len(meshes) + 2
        what = f"{name}, mesh {generation}"
        old, new = os.path.join(folder, "case.ckp.h5"), os.path.join(folder, f"new{generation}.h5")
        facts = remesh(checks, what, old, new)[1]
        if not facts["accepted"]:
            return folder, meshes
        mesh, before = Mesh(new), Mesh(old)
        checks.that(facts["generation"] == generation and facts["new_elements"] == len(mesh.elements), f"{what}: reported as it is", facts)
        least = mesh.jacobians().min()
        checks.that(least > 0.1, f"{what}: Jacobians above a tenth of the largest of their element", least)
        change = mesh.volume(round_about) / before.volume(round_about) - 1
        checks.that(abs(change) < most, f"{what}: volume within {most}", change)
        meshes.append(mesh)
        result = run(base + ["--resume", new])
    checks.that(result.returncode == DONE, f"{name}: runs to its end", said(result))
    return folder, meshes


def corners_on_line(mesh):
    """Corner nodes at the point where the zones meet, from below: the two ends of the line between them lie there to round-off."""
    on_line = {node for element in mesh.elements for node in element[:4] if abs(mesh.x[node, 0] - LINE) < 1e-9}
    return sorted(on_line, key=lambda node: mesh.x[node, 1])


def forging(checks):
    folder, meshes = whole_cycle(checks, "forging", add_cards(deck_text(FORGING), HUB_AND_FLANGE), ["-p", "nx=14", "-p", "ny=7"],
                                 True, 1e-4)
    checks.that(len(meshes) == 3, "forging: three new meshes", len(meshes))
    for number, mesh in enumerate(meshes, 2):
        heights = mesh.x[corners_on_line(mesh), 1]
        roof = mesh.x[np.abs(mesh.x[:, 0] - LINE) < 0.7, 1].max()
        if checks.that(len(heights) >= 2, f"forging, mesh {number}: two corners of elements at x = {LINE}", heights):
            checks.that(abs(heights[0]) < 1e-12 and heights[-1] > 0.9 * roof, f"forging, mesh {number}: on the floor and at the roof", heights)
    end = {name: column[-1] for name, column in history(folder).items()}
    with open(os.path.join(os.path.dirname(FORGING), "reference.csv"), encoding="utf-8", newline="") as file:
        fine = {(row["at"], row["quantity"]): float(row["expected"]) for row in csv.DictReader(file)
                if "48x24" in (row["source"] or "") and not row["options"]}
    for quantity, at, share in (("force_y_upper", "-displacement_y_upper=5.6", 0.03), ("hub_top", "end", 0.01), ("rim", "end", 0.005)):
        off = end[quantity] / fine[at, quantity] - 1
        checks.that(abs(off) < share, f"forging: {quantity} at the end within {share} of a fine mesh", off)


def bad_zones(checks):
    """A line between zones that leans too far makes no good mesh, nor a finer one: the cycle does without, and the deck's mesher is asked
    again at the next mesh. Where the deck forbids another mesher the cycle ends."""
    leaning = ONE_ZONE.replace("ZONE   all slab\n   a b c d\n", "ZPNT   p ON X 5.97 LOWER\nZPNT   q ON X 0.03 UPPER\n"
                               "ZONE   left slab\n   a p q d\nZONE   right slab\n   p b c q\n")
    for name, rows_of_card in (("leaning", "TIMES 0.4 0.6"), ("kept", "TIMES 0.4 0.6\n   MESHER ZONES")):
        folder = checks.path(name)
        text = SMALL_STRIP.replace("TIMES 0.5", rows_of_card).format(mesh=cards_of_grid(6, 4, 6.0, 4.0))
        deck = write(os.path.join(folder, "case.lag"), add_cards(text, leaning))
        result = subprocess.run([os.path.join(BIN, "lagacycle"), deck, "--out", folder, "--threads", "1", "--quiet"], text=True,
                                stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=LONGEST_RUN, check=False)
        checks.that(result.returncode == (NO_CONVERGENCE if name == "kept" else DONE), f"{name}: exit code", said(result))
        with open(os.path.join(folder, "cycle.csv"), encoding="utf-8", newline="") as file:
            made = [row["action"] for row in csv.DictReader(file)]
        if name == "kept":
            checks.that("finer" in made and "without zones" not in made, f"{name}: the ways to a mesh", made)
        else:
            last = [k for k, way in enumerate(made) if way == "without zones"]
            checks.that(len(last) == 2 and all("finer" in made[k - 2:k] for k in last) and made.count("as the deck says") == 2,
                        f"{name}: zones first at each mesh, then finer, then without", made)


def written_out(checks):
    """A body without blocks, by the zone given for it, or by one between the points where its sets of sides meet."""
    text = SMALL_STRIP.format(mesh=cards_of_grid(6, 4, 6.0, 4.0))
    meshes = whole_cycle(checks, "strip", add_cards(text, ONE_ZONE), [], False, 1e-4)[1]
    checks.that(len(meshes) == 1, "strip: a new mesh", len(meshes))
    folder = checks.path("plain")
    deck = write(os.path.join(folder, "case.lag"), text.replace("TIMES 0.5", "TIMES 0.5\n   MESHER ZONES"))   # by itself with fewer elements without
    result = run([deck, "--out", folder, "--threads", "1", "--quiet"])
    checks.that(result.returncode == REMESH, "strip without zones: stops for a new mesh", said(result))
    new = os.path.join(folder, "new.h5")
    remesh(checks, "strip without zones", os.path.join(folder, "case.ckp.h5"), new, DONE)
    with open(new + ".json", encoding="utf-8") as file:
        checks.that(json.load(file)["mesh"]["mesher"] == "zones", "strip without zones: one of its own")
    good = Mesh(new).jacobians().min()
    checks.that(good > 0.9, "strip without zones: its elements are nearly rectangles", good)


def first_mesh(checks, name, text):
    """A run that begins without a mesh: its folder and the first mesh."""
    folder = checks.path(name)
    deck = write(os.path.join(folder, "case.lag"), text)
    base = [deck, "--out", folder, "--threads", "1", "--quiet"]
    result = run(base)
    checks.that(result.returncode == REMESH, f"{name}: stops for a mesh", said(result))
    with open(os.path.join(folder, "case.log"), encoding="utf-8") as listing:
        checks.that("remesh: no mesh yet" in listing.read(), f"{name}: says why")
    new = os.path.join(folder, "new2.h5")
    remesh(checks, name, os.path.join(folder, "case.ckp.h5"), new)
    result = run(base + ["--resume", new])
    checks.that(result.returncode == DONE, f"{name}: runs on its mesh", said(result))
    return folder, Mesh(new)


def contour_or_block(checks):
    """A rectangle by its contour and by a block, in elements of the same size: one and the same, but for the order of nodes."""
    body = "BODY   slab PL8LS 4 metal\n   SEGM 0. 0. 6. 0.\n   SEGM 6. 0. 6. 4.\n   SEGM 6. 4. 0. 4.\n   SEGM 0. 4. 0. 0.\n"
    block = "BLOCK  slab PL8LS 4 metal\n   0. 0.  6. 0.  6. 4.  0. 4.\n   6 1.  4 1.\n"
    text = SMALL_STRIP.replace("lid upper", "slab 3 upper").replace("FIXED  floor", "FIXED  slab 1").replace("FIXED  wall", "FIXED  slab 4")
    text = text.replace("   TIMES 0.5\n", "   SIZE 0.5 1.\n   ERROR 1.E3\n")
    text = add_cards(text, ONE_ZONE)
    folder, mesh = first_mesh(checks, "contour", text.format(mesh=body))
    checks.that(len(mesh.elements) == 24, "contour: elements of the largest size", len(mesh.elements))
    other = checks.path("block")
    result = run([write(os.path.join(other, "case.lag"), text.format(mesh=block)), "--out", other, "--threads", "1", "--quiet"])
    checks.that(result.returncode == DONE, "block: runs", said(result))
    one, two = history(folder), history(other)
    for name in ("time", "force_y_upper", "external_work", "plastic_work", "volume_drift", "error_stress"):
        first, second = np.array(one[name]), np.array(two[name])
        same = first.shape == second.shape and np.max(np.abs(first - second)) <= 1e-7 * np.max(np.abs(second))
        checks.that(same, f"contour and block: {name} in all steps to 1e-7", (first[-1:], second[-1:]))


def bracket(checks):
    """Arcs and a re-entrant bend, the example of the manual: area of the contour, nodes on the arcs, work of the load."""
    with open(os.path.join(SOURCE, "decks", "README.md"), encoding="utf-8") as manual:
        text = next(block.split("```")[0] for block in manual.read().split("```lag\n") if "TITLE  A bracket\n" in block)
    folder, mesh = first_mesh(checks, "bracket", add_cards(text, "PROBE  pull REACT Y bracket 2"))
    least = mesh.jacobians().min()
    checks.that(least > 0.1, "bracket: Jacobians above a tenth of the largest of their element", least)
    # the arc outside: chord 3.2, height 0.4, hence a radius of 3.4; the bend inside: a quarter of a circle of radius 2
    sector = 3.4**2 * np.arcsin(1.6 / 3.4) - 1.6 * 3.0
    area = 12 * 3.2 + 4 * 6.8 + sector + (2**2 - np.pi * 2**2 / 4)
    checks.that(abs(mesh.volume(False) / area - 1) < 1e-4, "bracket: area as its tolerances of arcs let it", mesh.volume(False) / area - 1)
    bend = mesh.x[np.hypot(mesh.x[:, 0] - 6, mesh.x[:, 1] - 5.2) < 2.1]
    bend = bend[(bend[:, 0] > 4.01) & (bend[:, 0] < 5.99)]
    off = np.abs(np.hypot(bend[:, 0] - 6, bend[:, 1] - 5.2) - 2)
    checks.that(np.sum(off < 1.1e-4) >= 7, "bracket: nodes on the bend", off)
    end = {name: column[-1] for name, column in history(folder).items()}
    work = 0.5 * 0.02 * abs(end["pull"])
    checks.that(abs(end["external_work"] / work - 1) < 1e-3, "bracket: work is half of force times way", (end["external_work"], work))


def lost_point(checks):
    """A line that leaves the part is reported with the point's name."""
    cards = HUB_AND_FLANGE.replace(f"ON X {LINE} UPPER", "ON X 40. UPPER")
    folder = checks.path("lost")
    deck = write(os.path.join(folder, "case.lag"), add_cards(deck_text(FORGING), cards))
    result = run([deck, "--out", folder, "--threads", "1", "--quiet", "-p", "nx=8", "-p", "ny=4"])
    checks.that(result.returncode == REMESH, "lost point: stops for a new mesh", said(result))
    words = remesh(checks, "lost point", os.path.join(folder, "case.ckp.h5"), os.path.join(folder, "new.h5"), INPUT)[0]
    checks.that("ZPNT foot: the contour does not cross x = 40" in words, "lost point: reported by its name", words)


if __name__ == "__main__":
    count = Checks()
    forging(count)
    bad_zones(count)
    written_out(count)
    contour_or_block(count)
    bracket(count)
    lost_point(count)
    count.end()
