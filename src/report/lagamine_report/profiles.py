"""Values along a line through the bodies, and along the sides of a contact."""
import csv
import io
from dataclasses import dataclass
from typing import Dict, List, Sequence, Tuple

import numpy as np

from .contact import along_group, contact_groups, contact_points
from .errors import ReportError
from .geometry import CORNERS, line3, quad8, side_points
from .reader import Run, Step
from .tractions import recovered_tractions

PLACES = 201         # along a line
OF_SIDES = ("pressure_recovered", "pressure", "friction_recovered", "friction", "penetration")
WITHIN = 1e-6        # parent coordinates beyond an element's end that still belong to it


@dataclass
class Profile:
    """Values over a length: `x` (place, 2), `values` by name (place,); of a line the places within the bodies. `breaks`: places where it goes
    on after a gap, `shown`: what pictures have of it."""

    title: str
    length: np.ndarray
    x: np.ndarray
    values: Dict[str, np.ndarray]
    breaks: np.ndarray
    shown: Sequence[str]

    def csv(self) -> bytes:
        """A table: length, x, y, values."""
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(["length", "x", "y", *self.values])
        for row in zip(self.length, *self.x.T, *self.values.values()):
            writer.writerow([repr(float(value)) for value in row])
        return text.getvalue().encode("utf-8")


def along_line(run: Run, step: Step, ends: Sequence[float], fields: Sequence[str], places: int = PLACES) -> Profile:
    """Nodal fields on a straight line (x1, y1, x2, y2) through the shape at a saved instant."""
    start, end = np.array(ends[:2], dtype=float), np.array(ends[2:], dtype=float)
    if not np.hypot(*(end - start)) > 0:
        raise ReportError(f"a line from {start[0]:g} {start[1]:g} to itself has no length")
    share = np.linspace(0, 1, places)
    points = start + share[:, None] * (end - start)
    topology = step.generation.topology
    element, parent = find_places(run.coordinates(step), topology, points)
    held = element >= 0
    if not held.any():
        raise ReportError(f"the line from {start[0]:g} {start[1]:g} to {end[0]:g} {end[1]:g} meets no body at time {step.time:g}")
    phi = quad8(parent[held, 0], parent[held, 1])
    values = {}
    for name in fields:
        of_nodes = run.nodal(step, name)[topology[element[held]]]
        # a parabola goes beyond the range of its nodes
        values[name] = np.clip((phi * of_nodes).sum(axis=1), of_nodes.min(axis=1), of_nodes.max(axis=1))
    title = f"from {start[0]:g} {start[1]:g} to {end[0]:g} {end[1]:g}"
    breaks = np.flatnonzero(np.diff(np.flatnonzero(held)) > 1) + 1
    return Profile(title, share[held] * np.hypot(*(end - start)), points[held], values, breaks, list(fields))


def along_sides(run: Run, step: Step, name: str) -> Profile:
    """What the points of a contact hold, along its sides."""
    groups = {group.name: group for group in contact_groups(run, step)}
    if name not in groups:
        raise ReportError(f"no contact '{name}' at time {step.time:g}; there are: {', '.join(groups) or 'none'}{_last_with(run, name)}")
    names, state = contact_points(run, step, groups[name])
    length, order, curve_ends = along_group(run, step, groups[name])
    ends = run.coordinates(step)[groups[name].connectivity]
    x = np.einsum("pk,skd->spd", line3(side_points(groups[name].npoint, state.shape[1])), ends).reshape(-1, 2)
    flat = state.reshape(-1, state.shape[2])[order]
    shown = [component for component in names if not component.startswith(("corner_", "die_", "augmentation"))]
    recovered = recovered_tractions(run, step, groups[name])
    values = {component: flat[:, names.index(component)] for component in shown}
    if recovered is not None:
        values.update(pressure_recovered=recovered[0][order], friction_recovered=recovered[1][order])
    return Profile(f"along {name}", length, x[order], values, curve_ends[:-1], [one for one in OF_SIDES if one in values])


def _last_with(run: Run, name: str) -> str:
    """The last saved instant at which there is such a contact, in words; nothing where there is none: an operation may have ended it."""
    for step in reversed(run.steps):
        if any(group.name == name for group in contact_groups(run, step)):
            return f"; the last saved instant with it is at time {step.time:g} (--time)"
    return ""


def find_places(x: np.ndarray, topology: np.ndarray, points: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
    """The element of each point, -1 outside all, and its parent coordinates there (point, 2)."""
    nodes = x[topology]
    low, high = nodes.min(axis=1), nodes.max(axis=1)
    slack = 0.2 * (high - low).max(axis=1)[:, None]      # sides may bulge beyond their nodes
    found, parent = np.full(len(points), -1), np.full((len(points), 2), np.nan)
    for k, point in enumerate(points):
        near = np.flatnonzero(((point >= low - slack) & (point <= high + slack)).all(axis=1))
        if not len(near):
            continue
        xi = _parent_coordinates(nodes[near], point)
        beyond = np.abs(xi).max(axis=1)
        best = int(np.nanargmin(np.where(np.isfinite(beyond), beyond, np.inf)))
        if beyond[best] <= 1 + WITHIN:
            found[k], parent[k] = near[best], np.clip(xi[best], -1, 1)
    return found, parent


def _parent_coordinates(nodes: np.ndarray, point: np.ndarray) -> np.ndarray:
    """Newton's method from the middle of each element (element, 8, 2) to a point; not a number where it fails."""
    xi = np.zeros((len(nodes), 2))
    with np.errstate(all="ignore"):
        for _ in range(20):
            miss = point - np.einsum("ek,ekd->ed", quad8(xi[:, 0], xi[:, 1]), nodes)
            slope = np.einsum("ekj,ekd->edj", _quad8_slopes(xi), nodes)
            det = slope[:, 0, 0] * slope[:, 1, 1] - slope[:, 0, 1] * slope[:, 1, 0]
            change = np.stack([miss[:, 0] * slope[:, 1, 1] - miss[:, 1] * slope[:, 0, 1],
                               miss[:, 1] * slope[:, 0, 0] - miss[:, 0] * slope[:, 1, 0]], axis=1) / det[:, None]
            xi = np.clip(xi + change, -3, 3)
            if np.nanmax(np.abs(change), initial=0) < 1e-12:
                break
    return np.where(np.abs(xi) < 3, xi, np.nan)


def _quad8_slopes(xi: np.ndarray) -> np.ndarray:
    """Derivatives of the shape functions by both parent coordinates (point, 8, 2)."""
    slopes: List[np.ndarray] = []
    s, t = xi[:, 0], xi[:, 1]
    for a, b in CORNERS:
        slopes.append(0.25 * np.stack([a * (1 + b * t) * (2 * a * s + b * t), b * (1 + a * s) * (a * s + 2 * b * t)], axis=1))
    slopes += [np.stack([-s * (1 - t), -0.5 * (1 - s**2)], axis=1), np.stack([0.5 * (1 - t**2), -t * (1 + s)], axis=1),
               np.stack([-s * (1 + t), 0.5 * (1 - s**2)], axis=1), np.stack([-0.5 * (1 - t**2), -t * (1 - s)], axis=1)]
    return np.stack(slopes, axis=1)
