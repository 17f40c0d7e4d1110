"""Drawing the part and its dies: equal scales, sides as curves, colours that follow the shape functions."""
from dataclasses import dataclass
from typing import Dict, Optional, Tuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import BoundaryNorm
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from matplotlib.tri import Triangulation

from .geometry import Triangles, all_sides, die_body, die_curve, element_curves, side_curves
from .reader import Generation, Run, Step
from .style import BODIES, DIE_FILL, DIE_LINE, INK, POSITIVE, SIGNED, SOFT

Box = Tuple[float, float, float, float]


class SceneView:
    """Draws instants of a run; keeps what the drawings of one mesh share."""

    def __init__(self, run: Run, mirror: bool = False) -> None:
        self.run = run
        self.mirror = mirror and run.axisymmetric
        self._triangles: Dict[int, Triangles] = {}
        self._sides: Dict[int, Tuple[np.ndarray, np.ndarray]] = {}

    def triangles(self, generation: Generation) -> Triangles:
        if generation.number not in self._triangles:
            self._triangles[generation.number] = Triangles(generation.topology, len(generation.coordinates))
        return self._triangles[generation.number]

    def sides(self, generation: Generation) -> Tuple[np.ndarray, np.ndarray]:
        if generation.number not in self._sides:
            self._sides[generation.number] = all_sides(generation.topology)
        return self._sides[generation.number]

    def box(self, steps, margin: float = 0.08) -> Box:
        """A box around the part at all these steps, with a margin."""
        x = np.vstack([self.run.coordinates(step) for step in steps])
        low, high = x.min(axis=0), x.max(axis=0)
        if self.mirror:
            low[0] = -high[0]
        more = margin * (high - low).max()
        low, high = low - more, high + more
        if self.run.axisymmetric and not self.mirror and low[0] < 0 <= x[:, 0].min():
            low[0] = max(low[0], -0.35 * more)
        return low[0], high[0], low[1], high[1]

    def frame(self, axes: Axes, box: Box, bare: bool = False) -> None:
        """Equal scales, limits, and nothing that distracts."""
        axes.set_aspect("equal")
        axes.set_xlim(box[0], box[1])
        axes.set_ylim(box[2], box[3])
        axes.grid(False)
        for spine in axes.spines.values():
            spine.set_visible(False)
        if bare:
            axes.set_xticks([])
            axes.set_yticks([])
        else:
            axes.xaxis.set_major_locator(MaxNLocator(5))
            axes.yaxis.set_major_locator(MaxNLocator(6))
            axes.tick_params(length=2.5)
        if self.run.axisymmetric:
            axes.axvline(0, color=SOFT, lw=0.8, dashes=(9, 3, 2, 3), zorder=0.5)

    def dies(self, axes: Axes, step: Step, box: Box) -> None:
        """Dies where their pilots stand, a band of their body in grey."""
        thickness = 0.045 * max(box[1] - box[0], box[3] - box[2])
        pilots = self.run.pilots(step)
        for name, pieces in step.generation.dies.items():
            curve = die_curve(pieces, pilots[name])
            for sign in (1, -1) if self.mirror else (1,):
                flip = np.array([sign, 1])
                axes.add_collection(PolyCollection([die_body(curve, thickness) * flip], facecolors=DIE_FILL, edgecolors="none", zorder=0.8), autolim=False)
                axes.plot(*(curve * flip).T, color=DIE_LINE, lw=1.4, zorder=4, solid_joinstyle="round")

    def outline(self, axes: Axes, generation: Generation, x: np.ndarray, **look) -> None:
        sides = self.sides(generation)[1]
        if self.mirror:     # the axis is no side of the whole
            sides = sides[(np.abs(x[sides, 0]) > 1e-9 * np.abs(x).max()).any(axis=1)]
        self._lines(axes, side_curves(x, sides), **{"colors": INK, "linewidths": 1.0, "zorder": 3, **look})

    def mesh(self, axes: Axes, generation: Generation, x: np.ndarray, fill: bool = True, **look) -> None:
        """All sides as curves, bodies in pale colours."""
        if fill:
            bodies = [group for group in generation.groups if group.connectivity.shape[1] == 8 and group.elem not in ("BFORC", "CENTR")]
            for k, group in enumerate(bodies):
                curved = element_curves(x, group.connectivity)
                for sign in (1, -1) if self.mirror else (1,):
                    axes.add_collection(PolyCollection(curved * np.array([sign, 1]), facecolors=BODIES[k % len(BODIES)],
                                                       edgecolors="none", zorder=1), autolim=False)
        width = 0.7 if len(generation.topology) < 1500 else 0.4 if len(generation.topology) < 6000 else 0.2
        self._lines(axes, side_curves(x, self.sides(generation)[0]),
                    **{"colors": "#46627c", "linewidths": width, "zorder": 2, **look})

    def _lines(self, axes: Axes, curves: np.ndarray, **look) -> None:
        for sign in (1, -1) if self.mirror else (1,):
            axes.add_collection(LineCollection(curves * np.array([sign, 1]), capstyle="round", **look), autolim=False)

    def field(self, axes: Axes, step: Step, values: np.ndarray, scale: "Scale", edges: bool = True):
        """Filled contours of nodal values on the deformed shape; returns what a colour bar wants."""
        triangles = self.triangles(step.generation)
        x = self.run.coordinates(step)
        at, fine, levels = triangles.at(x), triangles.bounded(values), scale.levels
        fine = np.clip(np.nan_to_num(fine, nan=levels[0]), levels[0], levels[-1])
        norm = BoundaryNorm(levels, 256)
        drawn = None
        for sign in (1, -1) if self.mirror else (1,):
            mesh = Triangulation(at[:, 0] * sign, at[:, 1], triangles.cells)
            drawn = axes.tricontourf(mesh, fine, levels=levels, cmap=scale.colours, norm=norm, zorder=1.5, antialiased=False)
        if edges:
            self.mesh(axes, step.generation, x, fill=False, colors="black", linewidths=0.35, alpha=0.22)
        self.outline(axes, step.generation, x, linewidths=0.8)
        return drawn


@dataclass
class Scale:
    """Round levels of a field and its colours."""

    levels: np.ndarray
    colours: str


def scale_for(low: float, high: float, count: int = 16) -> Scale:
    """Levels between two values; a field of both signs is centred on 0."""
    signed = low < 0 < high and min(-low, high) > 0.1 * max(-low, high)
    if signed:
        high = max(-low, high)
        low = -high
    if not high > low:
        high = low + max(abs(low), 1.0) * 1e-3
    return Scale(MaxNLocator(count, steps=[1, 2, 2.5, 4, 5, 10]).tick_values(low, high), SIGNED if signed else POSITIVE)


def colour_bar(fig: Figure, drawn, panels, title: str = "", shrink: float = 0.86) -> None:
    """A colour bar without ornaments."""
    bar = fig.colorbar(drawn, ax=panels, shrink=shrink, aspect=20, pad=0.02)
    levels = np.asarray(drawn.levels)
    stride = max(1, -(-len(levels) // 7))
    bar.set_ticks(levels[int(np.abs(levels).argmin()) % stride::stride])     # 0 is among them
    bar.ax.minorticks_off()
    bar.outline.set_visible(False)
    bar.ax.tick_params(length=0, labelsize=8)
    if title:
        bar.set_label(title)


def value_range(values: np.ndarray) -> Optional[Tuple[float, float]]:
    """Least and largest value, None when nothing is finite."""
    finite = values[np.isfinite(values)]
    return (float(finite.min()), float(finite.max())) if finite.size else None
