#!/usr/bin/env python3
"""Figures of the manual's cards, into decks/figures: drawn from what `lagamine --check` reads of the manual's own examples.

usage: card_figures.py [--programs BIN] [--out DIR]
"""
import argparse
import json
import os
import re
import subprocess
import sys
import tempfile

import numpy as np

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
sys.path.insert(0, os.path.join(ROOT, "src", "report"))
from lagamine_report.deck_scene import Scene  # noqa: E402
from lagamine_report.geometry import all_sides, die_curve, element_curves, hatching, line3, side_curves  # noqa: E402
from lagamine_report.picture import Picture, in_few_colours  # noqa: E402
from lagamine_report.reader import Run  # noqa: E402
from lagamine_report.style import BODIES, DIE_LINE, INK, LINES, SOFT, figure  # noqa: E402

DPI = 100
SIDE, CORNER, ZONE = LINES[0], LINES[1], LINES[3]
MARK = "! your cards here\n"
# Dies above and below a part; the second deck has no FILLT.
DIES = """BLOCK  disc PL8LS 4 steel
   0. 20.   20. 20.   20. 28.   0. 28.
   8 1.   3 1.
DIE    punch PILOT 0. 28.
   SEGM   9. 40.   9. 28.
   FILLT  3. 1.E-3
   SEGM   9. 28.   -1. 28.
DIE    table PILOT 0. 20.
   SEGM   -1. 20.   24. 20.
CNT2D  disc 3 punch rough
CNT2D  disc 1 table rough
MOVE   punch Y press
"""


class Examples:
    """The examples of the manual, and the scenes that the solver reads from them."""

    def __init__(self, programs):
        self.programs = programs
        self.folder = tempfile.TemporaryDirectory(prefix="lagamine-figures-")
        with open(os.path.join(ROOT, "decks", "README.md"), encoding="utf-8") as file:
            self.manual = file.read()
        self.skeleton = re.search(r"```lag skeleton\n(.*?)```", self.manual, re.S).group(1)

    def of(self, card):
        """The first example below the heading of a card."""
        return re.search(rf"^### `{card}`\n.*?```lag\n(.*?)```", self.manual, re.S | re.M).group(1)

    def path(self, text):
        """A file with a deck: the text, or the manual's skeleton with it in its place."""
        path = os.path.join(self.folder.name, "deck.lag")
        with open(path, "w", encoding="utf-8") as file:
            file.write(text if re.search(r"^END", text, re.M) else self.skeleton.replace(MARK, text))
        return path

    def scene(self, text):
        """What `--check` writes of a deck."""
        out = os.path.join(self.folder.name, "scene")
        done = subprocess.run([os.path.join(self.programs, "lagamine"), self.path(text), "--check", "--out", out], text=True, capture_output=True, check=False)
        if done.returncode != 0:
            raise SystemExit(done.stderr)
        with open(os.path.join(out, "deck.scene.json"), encoding="utf-8") as file:
            return Scene(json.load(file), done.stdout)

    def first_mesh(self, text):
        """A run by lagacycle."""
        out = os.path.join(self.folder.name, "out")
        done = subprocess.run([os.path.join(self.programs, "lagacycle"), self.path(text), "--out", out, "--quiet"], text=True, capture_output=True, check=False)
        if done.returncode != 0:
            raise SystemExit(done.stderr)
        return Run(out)


def frame(panel, points, margin=0.12):
    """Equal scales around these points; no axes."""
    low, high = points.min(axis=0), points.max(axis=0)
    more = margin * (high - low).max()
    panel.set_aspect("equal")
    panel.set_xlim(low[0] - more, high[0] + more)
    panel.set_ylim(low[1] - more, high[1] + more)
    panel.set_axis_off()
    return float((high - low).max())


def mesh(panel, x, nodes, colour=BODIES[0]):
    every, outline = all_sides(nodes)
    panel.fill(*np.concatenate([np.vstack([c, [np.nan, np.nan]]) for c in element_curves(x, nodes)]).T, color=colour, lw=0)
    for curves, look in ((side_curves(x, every), {"color": "#8aa0b5", "lw": 0.6}), (side_curves(x, outline), {"color": INK, "lw": 1.2})):
        for curve in curves:
            panel.plot(*curve.T, **look)


def label(panel, at, text, colour=INK, **more):
    panel.text(*at, text, color=colour, **{"ha": "center", "va": "center", "fontsize": 9.5, "fontweight": "bold", **more})


def number(panel, at, text, colour):
    """A number in a circle."""
    panel.plot(*at, marker="o", ms=13, mfc="white", mec=colour, mew=1.2, zorder=6)
    label(panel, at, text, colour, zorder=7, fontsize=8.5)


def group_of(scene, name):
    return next(group for group in scene.bodies() if group["name"] == name)


def beside(x, sides, size, share=0.05):
    """A place outside the middle of a set of sides (side, 3)."""
    a, m, b = x[sides[len(sides) // 2]]
    way = (b - a) / np.hypot(*(b - a))
    return m + share * size * np.array([way[1], -way[0]])


def element(examples):
    """Nodes and sides of an element, in the order of the rows of PL8LS."""
    scene = examples.scene(examples.of("NODES"))
    nodes = group_of(scene, "slab")["nodes"]
    fig, axes = figure(1, 1, (2.9, 2.9))
    panel = axes[0, 0]
    size = frame(panel, scene.x[nodes[0]], 0.2)
    mesh(panel, scene.x, nodes)
    centre = scene.x[nodes[0]].mean(axis=0)
    for k, node in enumerate(nodes[0]):
        number(panel, scene.x[node], str(k + 1), CORNER)
        if k >= 4:
            label(panel, scene.x[node] + 0.13 * size * np.sign(scene.x[node] - centre), f"side {k - 3}", SIDE, rotation=90 if k % 2 else 0)
    return fig


def block(examples):
    """Corners, sides and divisions of a BLOCK."""
    text = examples.of("BLOCK")
    scene = examples.scene(text)
    corners = np.array(text.splitlines()[1].split("!")[0].split(), dtype=float).reshape(4, 2)
    nodes = group_of(scene, "ring")["nodes"]
    fig, axes = figure(1, 1, (4.4, 4.4))
    panel = axes[0, 0]
    size = frame(panel, scene.x[nodes].reshape(-1, 2))
    mesh(panel, scene.x, nodes)
    for k, corner in enumerate(corners):
        number(panel, corner, str(k + 1), CORNER)
    words = {1: "side 1: nx, ratiox", 2: "side 2 (ARC)", 3: "side 3", 4: "side 4 (ARC): ny, ratioy"}
    for k in range(1, 5):
        at = beside(scene.x, scene.sides[f"ring.{k}"], size, 0.09 if k == 4 else 0.045)
        label(panel, at, words[k], SIDE, rotation={1: 0, 2: -45, 3: 90, 4: -45}[k])
    return fig


def walk(panel, curve, size, colour=CORNER):
    """Arrows along a curve, from its first point."""
    length = np.concatenate([[0], np.cumsum(np.hypot(*np.diff(curve, axis=0).T))])
    for share in (0.25, 0.75):
        a, b = (np.array([np.interp(share * length[-1] + shift, length, curve[:, k]) for k in range(2)]) for shift in (-0.04 * size, 0.04 * size))
        panel.annotate("", b, a, arrowprops={"arrowstyle": "-|>", "color": colour, "lw": 2, "shrinkA": 0, "shrinkB": 0}, zorder=6)
    panel.plot(*curve[0], marker="o", ms=5, color=colour, zorder=6)


def dies(examples):
    """Which way a die is walked."""
    scene = examples.scene(DIES)
    fig, axes = figure(1, 1, (4.6, 3.9))
    panel = axes[0, 0]
    nodes = group_of(scene, "disc")["nodes"]
    curves = {name: die_curve(pieces, np.zeros(3)) for name, _, _, pieces in scene.dies if name in ("punch", "table")}
    size = frame(panel, np.vstack([scene.x[nodes].reshape(-1, 2), *curves.values()]), 0.08)
    mesh(panel, scene.x, nodes)
    for curve in curves.values():
        panel.plot(*curve.T, color=DIE_LINE, lw=1.8, zorder=4)
        for stroke in hatching(curve, 0.02 * size, 0.035 * size):
            panel.plot(*stroke.T, color=SOFT, lw=0.8)
        walk(panel, curve, size)
    label(panel, scene.x[nodes].reshape(-1, 2).mean(axis=0), "part: on the left of both walks")
    label(panel, (3.8, 33.0), "body of the die:\non the right", SOFT)
    label(panel, curves["punch"][0] + [1.2, -0.4], "SEGM 9 40  9 28\nbegins here", CORNER, ha="left", va="top", fontweight="normal")
    return fig


def fillet(examples):
    """The corner of two pieces with and without FILLT."""
    round_, sharp = (examples.scene(text) for text in (DIES, re.sub(r"   FILLT.*\n", "", DIES)))
    fig, axes = figure(1, 1, (3.4, 3.2))
    panel = axes[0, 0]
    curves = [die_curve(next(pieces for name, _, _, pieces in scene.dies if name == "punch"), np.zeros(3)) for scene in (sharp, round_)]
    window = np.array([[3.2, 26.6], [11.0, 34.4]])
    size = frame(panel, window, 0.0)
    panel.plot(*curves[0].T, color=SOFT, lw=1.0, dashes=(4, 3))
    panel.plot(*curves[1].T, color=DIE_LINE, lw=1.8)
    for stroke in hatching(curves[1], 0.025 * size, 0.045 * size):
        panel.plot(*stroke.T, color=SOFT, lw=0.8, clip_on=True)
    centre = np.array([6.0, 31.0])
    on_arc = centre + 3.0 * np.array([1, -1]) / np.sqrt(2)
    if not np.isclose(np.hypot(*(curves[1] - on_arc).T).min(), 0, atol=0.15):
        raise SystemExit("the fillet of the figure is not where its arrow points")
    panel.annotate("", on_arc, centre, arrowprops={"arrowstyle": "-|>", "color": CORNER, "lw": 1.5, "shrinkA": 0, "shrinkB": 0})
    label(panel, centre + [-0.15, 0.35], "radius", CORNER)
    label(panel, (9.3, 27.6), "corner of the\ntwo SEGM", SOFT, ha="left", va="top", fontweight="normal")
    for at in ((9.0, 31.0), (6.0, 28.0)):
        panel.plot(*at, marker="o", ms=4, color=CORNER, zorder=6)
    label(panel, (6.0, 27.5), "tangent", CORNER, fontweight="normal")
    return fig


def body(examples):
    """A contour with its rows and zones, and the first mesh."""
    text = examples.of("BODY")
    scene = examples.scene(text)
    pieces, rows, _ = scene.contours["bracket"]
    fig, axes = figure(1, 2, (9.0, 4.0))
    for panel in axes.flat:
        size = frame(panel, pieces.reshape(-1, 2))
    curve = np.einsum("pk,skd->spd", line3(np.linspace(-1, 1, 17)), pieces)
    panel = axes[0, 0]
    panel.fill(*curve.reshape(-1, 2).T, color=BODIES[0], lw=0)
    for one in curve:
        panel.plot(*one.T, color=INK, lw=1.2)
    for row in np.unique(rows):
        three = pieces[rows == row]
        a, m, b = three[len(three) // 2]
        way = (b - a) / np.hypot(*(b - a))
        label(panel, m + 0.045 * size * np.array([way[1], -way[0]]) * (1 if row != 4 else -1), str(row), SIDE)
    zones(panel, scene, size)
    run = examples.first_mesh(text)
    step = run.steps[0]
    mesh(axes[0, 1], run.coordinates(step), step.generation.topology)
    axes[0, 0].set_title("rows of BODY, points of ZPNT, zones", fontsize=9.5)
    axes[0, 1].set_title("the first mesh", fontsize=9.5)
    return fig


def zones(panel, scene, size):
    """Zones, the sides that two of them share, and their points. A side of one zone alone is the contour."""
    places = scene.zone_places()
    seen = set()
    for zone in scene.held["zones"]:
        points = zone["points"]
        label(panel, np.mean([places[point] for point in points], axis=0), zone["name"], ZONE)
        for side in {frozenset(pair) for pair in zip(points, [*points[1:], points[0]])}:
            if side in seen:
                panel.plot(*np.array([places[point] for point in side]).T, color=ZONE, lw=1.6, dashes=(5, 3), zorder=3.6)
            seen.add(side)
    for k, at in places.items():
        panel.plot(*at, marker="D", ms=4.5, color=ZONE, zorder=6)
        label(panel, at + 0.02 * size, scene.held["zone_points"][k - 1]["name"], ZONE, ha="left", va="bottom", fontweight="normal")


def zone(examples):
    """The zones of the example, at the start."""
    scene = examples.scene(examples.of("ZONE"))
    fig, axes = figure(1, 1, (7.2, 4.2))
    panel = axes[0, 0]
    nodes = group_of(scene, "billet")["nodes"]
    curve = die_curve(next(pieces for name, _, _, pieces in scene.dies), np.zeros(3))
    size = frame(panel, np.vstack([scene.x[nodes].reshape(-1, 2), [[0, 19], [24, 12]]]), 0.06)
    mesh(panel, scene.x, nodes)
    panel.plot(*curve.T, color=DIE_LINE, lw=1.8)
    for stroke in hatching(curve, 0.02 * size, 0.03 * size):
        panel.plot(*stroke.T, color=SOFT, lw=0.8, clip_on=True)
    zones(panel, scene, size)
    return fig


FIGURES = {"element": element, "block": block, "die": dies, "fillt": fillet, "body": body, "zone": zone}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--programs", default=os.path.join(ROOT, "build", "bin"))
    parser.add_argument("--out", default=os.path.join(ROOT, "decks", "figures"))
    options = parser.parse_args()
    os.makedirs(options.out, exist_ok=True)
    examples = Examples(os.path.abspath(options.programs))
    for name, draw in FIGURES.items():
        picture = Picture(name, "", draw(examples))
        data = in_few_colours(picture.image(DPI))
        with open(os.path.join(options.out, name + ".png"), "wb") as file:
            file.write(data)
        print(f"{name}.png: {len(data) // 1000} kB")
    return 0


if __name__ == "__main__":
    sys.exit(main())
