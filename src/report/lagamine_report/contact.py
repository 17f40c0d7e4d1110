"""Contacts whose points hold a pressure, and the order of their points along the sides."""
from typing import List, Optional, Tuple

import numpy as np

from .geometry import curves_of_sides, side_curves, side_points
from .reader import Group, Run, Step

CONTROL_POINT = "control point"     # rule of sides whose middle point is that of their parabola (Bernstein polynomials)


def contact_groups(run: Run, step: Step) -> List[Group]:
    """Groups whose points hold a pressure."""
    found = []
    for group in step.generation.groups:
        if group.connectivity.ndim != 2 or group.connectivity.shape[1] != 3 or not len(group.connectivity):
            continue
        points = run.points(step, group)
        if points and "pressure" in points[0]:
            found.append(group)
    return found


def contact_points(run: Run, step: Step, group: Group) -> Optional[Tuple[List[str], np.ndarray]]:
    """Component names and state (side, point, component) of a contact, as values at its points.

    A side with a control point has the coefficients of Bernstein polynomials: what they make at its middle is a quarter of the two ends and
    half of the control point, whose integral by Simpson's rule is that of the polynomials.
    """
    held = run.points(step, group)
    if held is None or group.rule != CONTROL_POINT:
        return held
    names, state = held[0], held[1].copy()

    def place(name: str) -> int:
        return names.index(name)

    first, middle, last = np.moveaxis(held[1], 1, 0)
    met = (held[1][:, :, place("die_piece")] > 0).all(axis=1)
    for name in ("pressure", "friction", "penetration"):
        k = place(name)
        between = (first[:, k] + 2 * middle[:, k] + last[:, k]) / 4
        state[:, 1, k] = np.where(met | (name != "penetration"), between, middle[:, k])
    k = place("contact_status")
    state[:, 1, k] = np.where(middle[:, k] > 0, middle[:, k], np.maximum(first[:, k], last[:, k]))
    return names, state


def along_group(run: Run, step: Step, group: Group) -> Tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Arc length along the sides [point], numbers of their points in (side, point) order, ends of the curves."""
    x = run.coordinates(step)
    names, state = run.points(step, group)
    xi = side_points(group.npoint, state.shape[1])
    length, order, ends = [], [], []
    start = 0.0
    for connected in curves_of_sides(group.connectivity):
        for k in connected:
            curve = side_curves(x, group.connectivity[k:k + 1], 24)[0]
            so_far = np.concatenate([[0], np.cumsum(np.hypot(*np.diff(curve, axis=0).T))])
            length.extend(start + np.interp(xi, np.linspace(-1, 1, 25), so_far))
            order.extend(k * state.shape[1] + np.arange(state.shape[1]))
            start += so_far[-1]
        ends.append(len(order))
    return np.array(length), np.array(order), np.array(ends)
