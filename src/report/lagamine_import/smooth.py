"""Smooth curves as parabolas within a tolerance."""
from typing import Callable, List, Sequence

import numpy as np

from .pieces import Piece

DEEPEST = 16             # halvings of an interval
SAMPLES = 24             # places on an interval where the distance is measured
MIDDLE_HALF = (0.26, 0.74)   # over the chord; the solver asks for 0.25 to 0.75
STRAIGHT = 1e-3          # a curve is a segment where it leaves the chord by this share of the tolerance


def parabolas_of(curve: Callable, slope: Callable, breaks: Sequence[float], tolerance: float, where: str, layer: str) -> List[Piece]:
    """Parabolas along curve(t) (n, 2), with slope(t) its derivative, between the parameters `breaks` and as few halvings between
    them as stay within `tolerance` [length].

    Between two ends a parabola takes the tangents of the curve, its Bezier point where they meet: neighbours are tangent to each other,
    and the distance falls with the fourth power of the length. Where tangents do not meet between the ends (an inflection)
    the interval is halved, or at last the parabola goes through the curve's point half-way.
    """
    pieces: List[Piece] = []
    for a, b in zip(breaks[:-1], breaks[1:]):
        pieces += _between(curve, slope, a, b, tolerance, where, layer, 0)
    return pieces


def _between(curve, slope, a: float, b: float, tolerance: float, where: str, layer: str, depth: int) -> List[Piece]:
    t = np.linspace(a, b, SAMPLES + 1)
    x = curve(t)
    start, end = x[0], x[-1]
    chord = end - start
    length = np.hypot(*chord)
    if length > 0:
        off = np.abs(chord[0] * (x - start)[:, 1] - chord[1] * (x - start)[:, 0]) / length
        along = (x - start) @ chord / length**2
        if off.max() <= STRAIGHT * tolerance and (np.diff(along) > 0).all():
            return [Piece("SEGM", tuple(start), tuple(end), where=where, layer=layer)]
        for middle in _middles(curve, slope, a, b, start, end):
            share = (middle - start) @ chord / length**2
            piece = Piece("PARAB", tuple(start), tuple(end), tuple(middle), where, layer)
            if MIDDLE_HALF[0] < share < MIDDLE_HALF[1] and distance(x, piece.at(np.linspace(0, 1, 8 * SAMPLES + 1))) <= tolerance:
                return [piece]
    if depth == DEEPEST:
        return [Piece("SEGM", tuple(start), tuple(end), where=where, layer=layer)] if length > 0 else []
    half = 0.5 * (a + b)
    return _between(curve, slope, a, half, tolerance, where, layer, depth + 1) \
        + _between(curve, slope, half, b, tolerance, where, layer, depth + 1)


def _middles(curve, slope, a: float, b: float, start: np.ndarray, end: np.ndarray):
    """Middle points of parabolas worth a try: with the tangents at the ends; through the curve half-way along the chord."""
    t1, t2 = slope(np.array([a, b]))
    turn = t1[0] * t2[1] - t1[1] * t2[0]
    chord = end - start
    if turn != 0:
        reach = (chord[0] * t2[1] - chord[1] * t2[0]) / turn
        back = (chord[0] * t1[1] - chord[1] * t1[0]) / turn
        if reach > 0 and back < 0:
            yield 0.25 * start + 0.5 * (start + reach * t1) + 0.25 * end
    elif t1 @ chord > 0 and abs(t1[0] * chord[1] - t1[1] * chord[0]) <= 1e-12 * np.hypot(*t1) * np.hypot(*chord):
        yield 0.5 * (start + end)
    yield curve(np.array([0.5 * (a + b)]))[0]


def distance(points: np.ndarray, line: np.ndarray) -> float:
    """Largest distance of points (n, 2) from a line of chords (m, 2)."""
    a, b = line[:-1], line[1:]
    chord = b - a
    square = np.maximum((chord**2).sum(axis=1), 1e-300)
    share = np.clip(((points[:, None] - a) * chord).sum(axis=2) / square, 0, 1)
    return float(np.hypot(*np.moveaxis(points[:, None] - a - share[..., None] * chord, 2, 0)).min(axis=1).max())


def cubic_through(points: np.ndarray):
    """The cubic spline through points (n, 2), n >= 3, over the length of chords, without curvature at its ends (natural spline: de
    Boor, A Practical Guide to Splines, chapter IV). Returns curve, slope and the parameters of the points."""
    t = np.concatenate([[0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])
    n, h = len(t), np.diff(t)
    matrix, right = np.zeros((n, n)), np.zeros((n, 2))
    matrix[0, 0] = matrix[-1, -1] = 1
    for k in range(1, n - 1):
        matrix[k, k - 1:k + 2] = h[k - 1], 2 * (h[k - 1] + h[k]), h[k]
        right[k] = 6 * ((points[k + 1] - points[k]) / h[k] - (points[k] - points[k - 1]) / h[k - 1])
    second = np.linalg.solve(matrix, right)

    def place(s):
        k = np.clip(np.searchsorted(t, s, side="right") - 1, 0, n - 2)
        return k, (t[k + 1] - s)[:, None], (s - t[k])[:, None], h[k][:, None]

    def curve(s):
        k, left, done, width = place(np.asarray(s, dtype=float))
        return (second[k] * left**3 + second[k + 1] * done**3) / (6 * width) \
            + (points[k] / width - second[k] * width / 6) * left + (points[k + 1] / width - second[k + 1] * width / 6) * done

    def slope(s):
        k, left, done, width = place(np.asarray(s, dtype=float))
        return (second[k + 1] * done**2 - second[k] * left**2) / (2 * width) \
            + (points[k + 1] - points[k]) / width - (second[k + 1] - second[k]) * width / 6

    return curve, slope, t
