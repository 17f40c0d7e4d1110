"""Pieces of contours: segments, parabolas and arcs of circles, each from its start to its end."""
import math
from dataclasses import dataclass, replace
from typing import Tuple

import numpy as np

Point = Tuple[float, float]


@dataclass(frozen=True)
class Piece:
    """A piece as rows SEGM, PARAB and ARC have it; `middle` is none for a segment. `where` names the entity it comes from."""

    form: str                  # SEGM, PARAB, ARC
    start: Point
    end: Point
    middle: Point = (math.nan, math.nan)
    where: str = ""
    layer: str = ""

    def reversed(self) -> "Piece":
        """The same piece, walked the other way."""
        return replace(self, start=self.end, end=self.start)

    def at(self, s) -> np.ndarray:
        """Points at shares s of the way (n, 2): by the parent coordinate of a parabola, by the angle of an arc."""
        s = np.asarray(s, dtype=float)[:, None]
        a, b = np.array(self.start), np.array(self.end)
        if self.form == "SEGM":
            return a + s * (b - a)
        m = np.array(self.middle)
        if self.form == "PARAB":
            return (1 - s) * (1 - 2 * s) * a + 4 * s * (1 - s) * m + s * (2 * s - 1) * b
        centre = circle_centre(a, m, b)
        first = math.atan2(*(a - centre)[::-1])
        angle = math.atan2(*(m - centre)[::-1]) - first
        turn = math.atan2(*(b - centre)[::-1]) - first
        # through the middle: the turn has its sense
        angle, turn = angle % (2 * math.pi), turn % (2 * math.pi)
        if angle > turn:
            turn -= 2 * math.pi
        phi = first + s * turn
        return centre + np.hypot(*(a - centre)) * np.hstack([np.cos(phi), np.sin(phi)])

    def curve(self, n: int = 16) -> np.ndarray:
        """Points from start to end (n + 1, 2); two for a segment."""
        return self.at(np.linspace(0, 1, (1 if self.form == "SEGM" else n) + 1))

    def size(self) -> float:
        """Length of the diagonal of the box around it."""
        return float(np.hypot(*np.ptp(self.curve(), axis=0)))


def circle_centre(a: np.ndarray, m: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Centre of the circle through three points, from the perpendicular bisectors."""
    p, q = m - a, b - a
    twice = 2 * (p[0] * q[1] - p[1] * q[0])
    pp, qq = p @ p, q @ q
    return a + np.array([q[1] * pp - p[1] * qq, p[0] * qq - q[0] * pp]) / twice


def arc_by_bulge(start: Point, end: Point, bulge: float, where: str, layer: str) -> Piece:
    """A side of a polyline: bulge is the tangent of a quarter of the arc's angle, positive to the right of the chord (DXF
    reference, LWPOLYLINE, group 42)."""
    if bulge == 0:
        return Piece("SEGM", start, end, where=where, layer=layer)
    (x1, y1), (x2, y2) = start, end
    middle = ((x1 + x2) / 2 + bulge * (y2 - y1) / 2, (y1 + y2) / 2 - bulge * (x2 - x1) / 2)
    return Piece("ARC", start, end, middle, where, layer)


def signed_area(points: np.ndarray) -> float:
    """Area inside a closed polygon (n, 2), positive when walked counter-clockwise."""
    x, y = (points - points[0]).T
    return 0.5 * float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))


def joined_curve(pieces, n: int = 16) -> np.ndarray:
    """Points along pieces end to end; places where two meet stand once."""
    parts = [piece.curve(n)[:-1] for piece in pieces]
    return np.vstack(parts + [np.array([pieces[-1].end])])
