"""Points of a contour in a text file: rows x y, separated by commas, semicolons or blanks."""
import re
from typing import List

import numpy as np

from .mistakes import Mistakes, Refused, at
from .pieces import Piece
from .smooth import cubic_through, parabolas_of


def read_csv(path: str, name: str, smooth: bool, corner: float, tolerance: float, mistakes: Mistakes) -> List[Piece]:
    """Segments from point to point; with `smooth` parabolas within `tolerance` [length] of the cubic spline through the points between
    corners, where the way turns by more than `corner` [degrees]."""
    try:
        with open(path, encoding="utf-8-sig") as file:
            lines = file.read().splitlines()
    except UnicodeDecodeError as error:
        raise Refused(f"{path}: not a text file") from error
    points: List[tuple] = []
    places: List[int] = []
    for number, line in enumerate(lines, 1):
        words = [word for word in re.split(r"[,;\s]+", line.split("#")[0].strip()) if word]
        if not words:
            continue
        values = _numbers(words)
        if values is None and not points and not _numbers(words[:1]):
            continue            # the names of the columns
        if values is None or len(values) != 2:
            mistakes.add(str(number), f"expected two coordinates, x and y, found '{line.strip()[:60]}'")
        elif points and values == points[-1]:
            mistakes.add(str(number), f"the point {at(values)} is that of line {places[-1]}")
        else:
            points.append(values)
            places.append(number)
    if len(points) < 2 and not mistakes.lines:
        mistakes.add("points", f"expected two or more, found {len(points)}")
    mistakes.refuse()
    x = np.array(points)
    if not smooth:
        return [Piece("SEGM", a, b, where=f"segment from line {n}", layer=name) for a, b, n in zip(points[:-1], points[1:], places)]
    pieces: List[Piece] = []
    breaks = _corners(x, corner)
    for first, last in zip(breaks[:-1], breaks[1:]):
        where = f"points of lines {places[first]} to {places[last]}"
        if last - first == 1:
            pieces.append(Piece("SEGM", points[first], points[last], where=where, layer=name))
        else:
            curve, slope, t = cubic_through(x[first:last + 1])
            pieces += parabolas_of(curve, slope, t, tolerance, where, name)
    return pieces


def _numbers(words: List[str]):
    try:
        values = tuple(float(word) for word in words)
    except ValueError:
        return None
    return values if np.isfinite(values).all() else None


def _corners(x: np.ndarray, corner: float) -> List[int]:
    """First, last, and points where the way turns by more than an angle [degrees]."""
    way = np.diff(x, axis=0)
    turn = np.abs(np.degrees(np.arctan2(way[:-1, 0] * way[1:, 1] - way[:-1, 1] * way[1:, 0], (way[:-1] * way[1:]).sum(axis=1))))
    return [0, *(int(k) + 1 for k in np.flatnonzero(turn > corner)), len(x) - 1]
