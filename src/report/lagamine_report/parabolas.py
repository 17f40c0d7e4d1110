"""Sides as curves: a parabola through three nodes is the quadratic curve of a drawing, so many sides are one path of exact curves."""
from typing import Sequence

import numpy as np
from matplotlib.patches import PathPatch
from matplotlib.path import Path

from .geometry import SIDES


def controls(sides: np.ndarray) -> np.ndarray:
    """Control points (side, 2) of sides given by end, middle, end (side, 3, 2): the curve meets the middle node halfway."""
    return 2 * sides[:, 1] - 0.5 * (sides[:, 0] + sides[:, 2])


def sides_patch(sides: np.ndarray, **look) -> PathPatch:
    """Lines along sides (side, 3, 2)."""
    return _patch(np.stack([sides[:, 0], controls(sides), sides[:, 2]], axis=1), (Path.MOVETO, Path.CURVE3, Path.CURVE3), fill=False,
                  capstyle="round", **look)


def elements_patch(x: np.ndarray, topology: np.ndarray, **look) -> PathPatch:
    """Elements (element, 8) of nodes x (node, 2), filled."""
    corners = [x[topology[:, :1]].reshape(-1, 1, 2)]
    for side in SIDES:
        ends = x[topology[:, side]]
        corners += [controls(ends)[:, None], ends[:, 2:]]
    return _patch(np.concatenate(corners, axis=1), (Path.MOVETO, *[Path.CURVE3] * 8), linewidth=0, **look)


def _patch(points: np.ndarray, codes: Sequence[int], **look) -> PathPatch:
    """One path of pieces (piece, point, 2) with the same codes; the limits of the axes are set without it."""
    patch = PathPatch(Path(points.reshape(-1, 2), np.tile(np.array(codes, dtype=Path.code_type), len(points))), **look)
    patch.set_in_layout(False)
    return patch
