"""The picture of what was imported: bodies, sets, dies with their bodies hatched, numbers of rows, the way the curves are walked."""
from typing import List

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.patches import PathPatch
from matplotlib.path import Path

from lagamine_report.geometry import SIDES, all_sides, hatching, side_curves
from lagamine_report.parabolas import elements_patch, sides_patch
from lagamine_report.picture import svg_bytes
from lagamine_report.style import BODIES, DIE_LINE, INK, LINES, SOFT, figure

from .chains import Contour
from .mesh_build import Mesh
from .pieces import joined_curve

MOST_NUMBERS = 80


def _axes(low: np.ndarray, high: np.ndarray, title: str):
    """Axes of equal scales around a box, with a margin."""
    more = 0.07 * (high - low).max()
    width, height = high - low + 2 * more
    scale = min(9.0 / width, 7.0 / height)
    fig, panels = figure(1, 1, (max(width * scale, 3.5) + 0.6, max(height * scale, 2.0) + 0.9), grid=False)
    axes = panels[0, 0]
    axes.set_aspect("equal")
    axes.set_xlim(low[0] - more, high[0] + more)
    axes.set_ylim(low[1] - more, high[1] + more)
    axes.set_title(title)
    return fig, axes


def mesh_sketch(mesh: Mesh, title: str) -> bytes:
    """Bodies in colours, sets of sides as thick lines with their names, as SVG."""
    fig, axes = _axes(mesh.points.min(axis=0), mesh.points.max(axis=0), title)
    for k, body in enumerate(mesh.bodies):
        axes.add_artist(elements_patch(mesh.points, body.nodes, facecolor=BODIES[k % len(BODIES)], label=f"body {body.name}: {len(body.nodes)} elements"))
    nodes = np.concatenate([body.nodes for body in mesh.bodies])
    every, outline = all_sides(nodes)
    axes.add_artist(sides_patch(mesh.points[every], edgecolor="#46627c", linewidth=0.5 if len(nodes) < 2000 else 0.25, zorder=2))
    axes.add_artist(sides_patch(mesh.points[outline], edgecolor=INK, linewidth=1.1, zorder=2))
    row_of = {int(label): row for body in mesh.bodies for label, row in zip(body.labels, body.nodes)}
    for k, (name, sides) in enumerate(mesh.sides.items()):
        curves = side_curves(mesh.points, np.array([row_of[element][SIDES[side - 1]] for element, side in sides]))
        axes.add_collection(LineCollection(curves, colors=LINES[k % len(LINES)], linewidths=3.2, alpha=0.75, zorder=4,
                                           label=f"sides {name}: {len(sides)}"))
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))
    return svg_bytes(fig)


def contour_sketch(contours: List[Contour], title: str) -> bytes:
    """Bodies filled, dies hatched on the side of their own body, numbers of the rows, arrows along the curves, as SVG."""
    curves = [contour.curve(32) for contour in contours]
    every = np.vstack(curves)
    low, high = every.min(axis=0), every.max(axis=0)
    size = float((high - low).max())
    fig, axes = _axes(low, high, title)
    for k, (contour, curve) in enumerate(zip(contours, curves)):
        if contour.card == "BODY":
            around = [curve, *(joined_curve(hole, 32) for hole in contour.holes)]
            axes.add_artist(PathPatch(Path.make_compound_path(*[Path(points, closed=True) for points in around]), color=BODIES[k % len(BODIES)], lw=0))
            for hole in around[1:]:
                axes.plot(*hole.T, color=INK, lw=1.5)
        else:
            axes.add_collection(LineCollection(hatching(curve, 0.012 * size, 0.02 * size), colors=SOFT, linewidths=0.7))
        colour = INK if contour.card == "BODY" else DIE_LINE
        axes.plot(*curve.T, color=colour, lw=1.5, label=f"{contour.card} {contour.name}: part {_words(contour)}")
        ends = np.array([piece.start for piece in contour.rows()] + [contour.pieces[-1].end])
        axes.plot(*ends.T, ls="none", marker="o", ms=2.6, color=colour)
        _numbers(axes, contour, size)
    axes.legend(loc="upper left", bbox_to_anchor=(0.0, -0.06), ncols=1)
    return svg_bytes(fig)


def _words(contour: Contour) -> str:
    return contour.side_by if contour.card == "BODY" else f"on the left, by {contour.side_by}"


def _numbers(axes, contour: Contour, size: float) -> None:
    """Numbers of rows on the part's side, an arrow on the longest piece."""
    pieces = contour.rows()
    lengths = [piece.size() for piece in pieces]
    longest = int(np.argmax(lengths))
    for k, piece in enumerate(pieces):
        a, m, b = piece.at([0.49, 0.5, 0.51])
        way = (b - a) / np.hypot(*(b - a))
        left = np.array([-way[1], way[0]])
        if len(pieces) <= MOST_NUMBERS and lengths[k] > 0.03 * size:
            axes.text(*(m + 0.022 * size * left), str(k + 1), fontsize=7.5, ha="center", va="center", color=LINES[0])
        if k == longest:
            axes.annotate("", m + 0.03 * size * way, m - 0.03 * size * way, arrowprops={"arrowstyle": "-|>", "color": LINES[1], "lw": 1.4})
