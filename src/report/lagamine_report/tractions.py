"""Pressure and friction of a contact as a person can use them: recovered from the stresses in the body.

What the points of a contact hold is what makes consistent nodal forces of a side: beside a glued or sharp corner of a die, where the exact
pressure is infinite, it alternates from point to point. The traction of the body's stresses does not; it is scaled (pressure) or moved
(friction) by what stretches of a few sides need for the force of their points, so that each interval of closed points has the force that
its points have.
"""
from typing import List, Optional, Tuple

import numpy as np

from .contact import along_group, contact_points
from .geometry import line3, side_points
from .reader import Group, Run, Step

STRESSES = ("stress_xx", "stress_yy", "stress_xy")
STRETCH = 2               # sides
FEWEST = 4                # closed points of an interval that is recovered
FACTOR = (0.4, 2.5)       # the body's pressure may differ by so much from that of the points


def side_weights(npoint: int, found: int) -> np.ndarray:
    """Weights of the points of a side, with sum 2: Gauss; Simpson's rule on equal parts; Gregory's rule for 33 points and more."""
    if npoint > 0 and found <= 4:
        return np.polynomial.legendre.leggauss(found)[1]
    weights = np.full(found, 2.0 / (found - 1))
    if found <= 17:
        weights = np.where(np.arange(found) % 2, 4.0, 2.0) * 2 / (3 * (found - 1))
        weights[[0, -1]] /= 2
    else:
        weights[:3] *= np.array([9, 28, 23]) / 24
        weights[:-4:-1] = weights[:3]
    return weights


def recovered_tractions(run: Run, step: Step, group: Group) -> Optional[Tuple[np.ndarray, np.ndarray]]:
    """Pressure and friction at the points (side*point,) of a contact, 0 where nothing touches; none where the bodies have no stresses."""
    names, state = contact_points(run, step, group)
    if not {"pressure", "friction", "contact_status"} <= set(names) or not set(STRESSES) <= set(run.names(step, "node")):
        return None
    pressure, friction, status = (state[:, :, names.index(name)].ravel() for name in ("pressure", "friction", "contact_status"))
    # open points bear what is in contact beside them, where no point of their side is (ALONG)
    if "pressure_between" in names:
        status = np.where(state[:, :, names.index("pressure_between")].ravel() > 0, np.maximum(status, 1), status)
    normal_stress, shear_stress, area = _body_tractions(run, step, group, state.shape[1])
    shown = np.zeros((2, len(pressure)))
    for interval, place in _intervals(run, step, group, status):
        weight, inner = area[interval], np.maximum(normal_stress[interval], 0)
        hats = _hats(place, max(1, len(interval) // (STRETCH * state.shape[1])))
        of_points, of_body = hats @ (weight * pressure[interval]), hats @ (weight * inner)
        factors = of_points / np.maximum(of_body, 1e-300)
        if len(interval) < FEWEST or not ((FACTOR[0] < factors) & (factors < FACTOR[1])).all():
            shown[:, interval] = pressure[interval], friction[interval]
            continue
        scaled = inner * (factors @ hats)
        shown[0, interval] = scaled * of_points.sum() / (weight * scaled).sum()
        miss = hats @ (weight * (friction[interval] - shear_stress[interval])) / (hats @ weight)
        moved = shear_stress[interval] + miss @ hats
        shown[1, interval] = moved + (weight * (friction[interval] - moved)).sum() / weight.sum()
    return shown[0], shown[1]


def _hats(place: np.ndarray, count: int) -> np.ndarray:
    """Piecewise linear functions of the place with sum 1 (count + 1, point), one for an interval that is short."""
    if count < 2 or not np.ptp(place) > 0:
        return np.ones((1, len(place)))
    knots = np.linspace(place[0], place[-1], count + 1)
    return np.array([np.interp(place, knots, row) for row in np.eye(count + 1)])


def _body_tractions(run: Run, step: Step, group: Group, npoint: int) -> Tuple[np.ndarray, np.ndarray, np.ndarray]:
    """-n.sigma.n, -t.sigma.n and the area (per unit of thickness, or per radian) at the points, n the outer normal, t along the walk."""
    xi = side_points(group.npoint, npoint)
    nodes = run.coordinates(step)[group.connectivity]
    place = np.einsum("pk,skd->spd", line3(xi), nodes)
    slopes = np.stack([xi - 0.5, -2 * xi, xi + 0.5], axis=1)        # of line3
    tangent = np.einsum("pk,skd->spd", slopes, nodes)
    length = np.hypot(tangent[..., 0], tangent[..., 1])
    t = tangent / length[..., None]
    n = np.stack([t[..., 1], -t[..., 0]], axis=2)       # the part is on the left
    xx, yy, xy = (np.einsum("pk,sk->sp", line3(xi), run.nodal(step, name)[group.connectivity]) for name in STRESSES)
    force = np.stack([xx * n[..., 0] + xy * n[..., 1], xy * n[..., 0] + yy * n[..., 1]], axis=2)
    area = length * (np.abs(place[..., 0]) if run.axisymmetric else 1) * side_weights(group.npoint, npoint)
    return -(force * n).sum(axis=2).ravel(), -(force * t).sum(axis=2).ravel(), area.ravel()


def _intervals(run: Run, step: Step, group: Group, status: np.ndarray) -> List[Tuple[np.ndarray, np.ndarray]]:
    """Numbers of closed points that follow one another, and where they are along the sides."""
    length, order, ends = along_group(run, step, group)
    found = []
    for first, last in zip(np.concatenate([[0], ends[:-1]]), ends):
        closed = status[order[first:last]] > 0.5
        for stretch in np.split(np.arange(first, last), np.flatnonzero(np.diff(closed)) + 1):
            if len(stretch) and closed[stretch[0] - first]:
                found.append((order[stretch], length[stretch]))
    return found
