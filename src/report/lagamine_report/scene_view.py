"""Drawing the part and its dies: equal scales, sides as curves, colours that follow the shape functions."""
from dataclasses import dataclass
from typing import Dict, Optional, Tuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.colors import BoundaryNorm
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from matplotlib.tri import Triangulation

from .geometry import Triangles, all_sides, die_body, die_curve, element_thickness, part_thickness
from .parabolas import elements_patch, sides_patch
from .reader import Generation, Run, Step
from .style import BODIES, DIE_FILL, DIE_LINE, DIE_SHARE, INK, LINE_SHARE, POINTS, POSITIVE, SIGNED, SOFT, panel_size

UNIFORM = 1e-5  # share of a value below which differences are not drawn: they would be all digits and no picture
ABOVE = 1.0     # where titles stand when no ticks are above: matplotlib looks for them otherwise, at the cost of a layout
Box = Tuple[float, float, float, float]


class SceneView:
    """Draws instants of a run; keeps what the drawings of one mesh share."""

    def __init__(self, run: Run, mirror: bool = False) -> None:
        self.run = run
        self.mirror = mirror and run.axisymmetric
        self._triangles: Dict[Tuple[int, bool], Triangles] = {}
        self._sides: Dict[int, Tuple[np.ndarray, np.ndarray]] = {}
        self._places: Dict[Tuple[str, str], np.ndarray] = {}
        self.paper = np.inf     # points of paper per length, in the panels of now

    def triangles(self, generation: Generation, small: bool = False) -> Triangles:
        key = generation.number, small
        if key not in self._triangles:
            self._triangles[key] = Triangles(generation.topology, len(generation.coordinates), small)
        return self._triangles[key]

    def sides(self, generation: Generation) -> Tuple[np.ndarray, np.ndarray]:
        if generation.number not in self._sides:
            self._sides[generation.number] = all_sides(generation.topology)
        return self._sides[generation.number]

    def coordinates(self, step: Step) -> np.ndarray:
        """Where the nodes are at a saved step: every picture of it asks."""
        key = step.generation.path, step.place
        if key not in self._places:
            self._places[key] = self.run.coordinates(step)
        return self._places[key]

    def box(self, steps, margin: float = 0.08) -> Box:
        """A box around the part at all these steps, with a margin."""
        x = np.vstack([self.coordinates(step) for step in steps])
        low, high = x.min(axis=0), x.max(axis=0)
        if self.mirror:
            low[0] = -high[0]
        more = margin * (high - low).max()
        low, high = low - more, high + more
        if self.run.axisymmetric and not self.mirror and low[0] < 0 <= x[:, 0].min():
            low[0] = max(low[0], -0.35 * more)
        return low[0], high[0], low[1], high[1]

    def panel(self, box: Box, widest: float, highest: float) -> Tuple[float, float]:
        """Inches of the panels that are drawn next; widths of lines follow from them."""
        inches = panel_size(box[1] - box[0], box[3] - box[2], widest, highest)
        self.paper = POINTS * min(inches[0] / (box[1] - box[0]), inches[1] / (box[3] - box[2]))
        return inches

    def part_width(self, generation: Generation, x: np.ndarray) -> float:
        """How thin the part is on paper [point]."""
        return self.paper * part_thickness(x, generation.topology, self.sides(generation)[1])

    def frame(self, axes: Axes, box: Box, bare: bool = False) -> None:
        """Equal scales, limits, and nothing that distracts."""
        axes.set_aspect("equal")
        axes.set_xlim(box[0], box[1])
        axes.set_ylim(box[2], box[3])
        if bare:
            axes.set_axis_off()
            axes.set_title("", y=ABOVE)
        else:
            for spine in axes.spines.values():
                spine.set_visible(False)
            axes.xaxis.set_major_locator(MaxNLocator(5))
            axes.yaxis.set_major_locator(MaxNLocator(6))
            axes.tick_params(length=2.5)
        self.axis(axes, box)

    def axis(self, axes, box: Box) -> None:
        """The axis of revolution, where there is one."""
        if self.run.axisymmetric:
            axes.plot([0, 0], box[2:], color=SOFT, lw=0.8, dashes=(9, 3, 2, 3), zorder=0.5)

    def dies(self, axes: Axes, step: Step, box: Box) -> None:
        """Dies where their pilots stand, a band of their body in grey."""
        thickness = 0.045 * max(box[1] - box[0], box[3] - box[2])
        pilots = self.run.pilots(step)
        room = DIE_SHARE * self.part_width(step.generation, self.coordinates(step))
        line = {"lw": 1.4, "zorder": 4} if room > 1.4 else {"lw": max(room, 0.3), "zorder": 1.3}      # beside a thin part, not on it
        for name, pieces in step.generation.dies.items():
            curve = die_curve(pieces, pilots[name])
            for sign in (1, -1) if self.mirror else (1,):
                flip = np.array([sign, 1])
                axes.add_collection(PolyCollection([die_body(curve, thickness) * flip], facecolors=DIE_FILL, edgecolors="none", zorder=0.8), autolim=False)
                axes.plot(*(curve * flip).T, color=DIE_LINE, solid_joinstyle="round", **line)

    def outline(self, axes: Axes, generation: Generation, x: np.ndarray, **look) -> None:
        sides = self.sides(generation)[1]
        look = {"edgecolor": INK, "linewidth": 1.0, "zorder": 3, **look}
        look["linewidth"] = min(look["linewidth"], LINE_SHARE * self.part_width(generation, x))
        if self.mirror:     # the axis is no side of the whole
            sides = sides[(np.abs(x[sides, 0]) > 1e-9 * np.abs(x).max()).any(axis=1)]
        self._lines(axes, x[sides], **look)

    def mesh(self, axes: Axes, generation: Generation, x: np.ndarray, fill: bool = True, **look) -> None:
        """All sides as curves, bodies in pale colours."""
        if fill:
            bodies = [group for group in generation.groups if group.connectivity.shape[1] == 8 and group.elem not in ("BFORC", "CENTR")]
            for k, group in enumerate(bodies):
                for sign in (1, -1) if self.mirror else (1,):
                    axes.add_artist(elements_patch(x * np.array([sign, 1]), group.connectivity, facecolor=BODIES[k % len(BODIES)], zorder=1))
        width = 0.7 if len(generation.topology) < 1500 else 0.4 if len(generation.topology) < 6000 else 0.2
        look = {"edgecolor": "#46627c", "linewidth": width, "zorder": 2, **look}
        look["linewidth"] = min(look["linewidth"], LINE_SHARE * self.paper * element_thickness(x, generation.topology))
        self._lines(axes, x[self.sides(generation)[0]], **look)

    def _lines(self, axes: Axes, sides: np.ndarray, **look) -> None:
        """Sides (side, 3, 2); an artist and not a patch of the axes, whose limits are set."""
        for sign in (1, -1) if self.mirror else (1,):
            axes.add_artist(sides_patch(sides * np.array([sign, 1]), **look))

    def field(self, axes: Axes, step: Step, values: np.ndarray, scale: "Scale", small: bool = False):
        """Filled contours of nodal values on the deformed shape, with the mesh unless the picture is small; returns what a colour bar wants."""
        triangles = self.triangles(step.generation, small)
        x = self.coordinates(step)
        at, fine, levels = triangles.at(x), triangles.bounded(values), scale.levels
        fine = np.clip(np.nan_to_num(fine, nan=levels[0]), levels[0], levels[-1])
        norm = BoundaryNorm(levels, 256)
        drawn = None
        for sign in (1, -1) if self.mirror else (1,):
            mesh = Triangulation(at[:, 0] * sign, at[:, 1], triangles.cells)
            drawn = axes.tricontourf(mesh, fine, levels=levels, cmap=scale.colours, norm=norm, zorder=1.5, antialiased=False)
        if not small:
            self.mesh(axes, step.generation, x, fill=False, edgecolor="black", linewidth=0.35, alpha=0.22)
        self.outline(axes, step.generation, x, linewidth=0.8)
        return drawn


@dataclass
class Scale:
    """Round levels of a field and its colours."""

    levels: np.ndarray
    colours: str


def is_uniform(low: float, high: float) -> bool:
    """Whether two values are the same to a reader: no difference in the digits that are shown of them."""
    return high - low <= UNIFORM * max(abs(low), abs(high))


def scale_for(low: float, high: float, count: int = 16) -> Scale:
    """Levels between two values; a field of both signs is centred on 0."""
    signed = low < 0 < high and min(-low, high) > 0.1 * max(-low, high)
    if signed:
        high = max(-low, high)
        low = -high
    if is_uniform(low, high):       # levels that can be read
        high = low + 1e-3 * (max(abs(low), abs(high)) or 1.0)
    return Scale(MaxNLocator(count, steps=[1, 2, 2.5, 4, 5, 10]).tick_values(low, high), SIGNED if signed else POSITIVE)


def colour_bar(fig: Figure, drawn, panels, title: str = "", shrink: float = 0.86) -> None:
    """A colour bar without ornaments."""
    bar = fig.colorbar(drawn, ax=panels, shrink=shrink, aspect=20, pad=0.02)
    levels = np.asarray(drawn.levels)
    stride = max(1, -(-len(levels) // 7))
    bar.set_ticks(levels[int(np.abs(levels).argmin()) % stride::stride])     # 0 is among them
    bar.ax.set_title("", y=ABOVE)
    bar.ax.xaxis.set_visible(False)
    bar.ax.minorticks_off()
    bar.outline.set_visible(False)
    bar.ax.tick_params(length=0, labelsize=8)
    if title:
        bar.set_label(title)


def value_range(values: np.ndarray) -> Optional[Tuple[float, float]]:
    """Least and largest value, None when nothing is finite."""
    finite = values[np.isfinite(values)]
    return (float(finite.min()), float(finite.max())) if finite.size else None
