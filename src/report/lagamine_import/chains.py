"""Pieces joined end to end: one contour a layer, of a body with its holes, walked with the part on the left."""
from dataclasses import dataclass, field
from typing import List, Optional, Sequence, Tuple

import numpy as np

from .mistakes import Mistakes, at
from .pieces import Piece, joined_curve, signed_area

SPLIT = 40      # chords of a piece where sides of a curve are looked for


@dataclass
class Contour:
    """A card DIE or BODY: pieces in order, the part on the left."""

    card: str
    name: str
    pieces: List[Piece]
    closed: bool
    side_by: str = ""        # how the side of the part was found
    holes: List[List[Piece]] = field(default_factory=list)

    def rows(self) -> List[Piece]:
        """Pieces in the order of the card's rows: around the contour, then around each hole."""
        return [*self.pieces, *(piece for hole in self.holes for piece in hole)]

    def inside(self) -> np.ndarray:
        """Points of a lattice in the body (m, 2)."""
        points = points_inside(self.curve())
        for hole in self.holes:
            points = points[~is_within(joined_curve(hole, 16), points)]
        return points

    def curve(self, n: int = 16) -> np.ndarray:
        """Points along it (n, 2)."""
        return joined_curve(self.pieces, n)


def chain(pieces: Sequence[Piece], gap: float, must_close: bool, layer: str, mistakes: Mistakes) -> Optional[List[Tuple[List[Piece], bool]]]:
    """The curves of a layer, and whether each is closed; none where there are mistakes.

    Ends nearer to each other than `gap` [length] are one point. A curve that branches or comes twice is refused; one in several parts unless they
    must close and do; and an open one where it must close.
    """
    before = len(mistakes.lines)
    pieces = _without_repeats(pieces, gap, mistakes)
    nodes, at_node = _nodes(pieces, gap)
    degree = [len(ends) for ends in at_node]
    for k, number in enumerate(degree):
        if number > 2:
            held = ", ".join(dict.fromkeys(pieces[p].where for p, _ in at_node[k]))
            mistakes.add(f"layer '{layer}'", f"{number} ends meet at {at(nodes[k])} ({held}): expected one curve without branches")
    if len(mistakes.lines) > before:
        return None
    parts = _walks(pieces, at_node)
    closed = [walk[1] for walk in parts]
    loose = [k for k, number in enumerate(degree) if number == 1]
    if len(parts) > 1 and not (must_close and all(closed)):
        _refuse_parts(parts, pieces, nodes, at_node, loose, layer, mistakes)
    elif must_close and not closed[0]:
        a, b = loose
        mistakes.add(f"layer '{layer}'", f"the contour is open between {at(nodes[a])} ({pieces[at_node[a][0][0]].where}) and {at(nodes[b])} "
                     f"({pieces[at_node[b][0][0]].where}), {_far(nodes[a], nodes[b])} apart: expected it closed (--gap joins ends)")
    if len(mistakes.lines) > before:
        return None
    return [(_with_common_ends(walk, is_closed), is_closed) for walk, is_closed in parts]


def _far(a: np.ndarray, b: np.ndarray) -> str:
    return f"{float(np.hypot(*(a - b))):.4g}"


def _without_repeats(pieces: Sequence[Piece], gap: float, mistakes: Mistakes) -> List[Piece]:
    """A line that is drawn twice is a mistake."""
    kept: List[Piece] = []
    seen = {}
    scale = max(gap, 1e-300)
    for piece in pieces:
        key = tuple(sorted(tuple(np.round(piece.at([s])[0] / scale).astype(np.int64)) for s in (0.0, 0.5, 1.0)))
        if key in seen:
            mistakes.add(piece.where, f"lies on {seen[key]}: expected every line once")
        else:
            seen[key] = piece.where
            kept.append(piece)
    return kept


def _nodes(pieces: Sequence[Piece], gap: float):
    """Places where ends meet, and the ends (piece, 0 or 1) at each."""
    nodes: List[np.ndarray] = []
    at_node: List[List[Tuple[int, int]]] = []
    for p, piece in enumerate(pieces):
        for end, point in enumerate((piece.start, piece.end)):
            point = np.array(point)
            k = int(np.argmin(np.hypot(*(np.array(nodes) - point).T))) if nodes else -1
            if k < 0 or np.hypot(*(nodes[k] - point)) > gap:
                nodes.append(point)
                at_node.append([])
                k = len(nodes) - 1
            at_node[k].append((p, end))
    return nodes, at_node


def _walks(pieces: Sequence[Piece], at_node) -> List[Tuple[List[Piece], bool]]:
    """Pieces in the order of a walk, one walk a connected part, and whether it comes back."""
    partner = {}
    for ends in at_node:
        if len(ends) == 2:
            partner[ends[0]], partner[ends[1]] = ends[1], ends[0]
    left = dict.fromkeys(range(len(pieces)))
    heads = [ends[0] for ends in at_node if len(ends) == 1]
    walks = []
    for head in heads + [(p, 0) for p in range(len(pieces))]:
        if head[0] not in left:
            continue
        walk, end = [], head
        while end is not None and end[0] in left:
            p, begin = end
            del left[p]
            walk.append(pieces[p] if begin == 0 else pieces[p].reversed())
            end = partner.get((p, 1 - begin))
        walks.append((walk, end is not None))
    return walks


def _refuse_parts(parts, pieces, nodes, at_node, loose, layer: str, mistakes: Mistakes) -> None:
    """Several curves on a layer: the nearest loose ends, or that they are closed."""
    if len(loose) > 1:
        gaps = []
        for i, a in enumerate(loose):
            for b in loose[i + 1:]:
                gaps.append((float(np.hypot(*(nodes[a] - nodes[b]))), a, b))
        far, a, b = min(gaps)
        mistakes.add(f"layer '{layer}'", f"the contour is open between {at(nodes[a])} ({pieces[at_node[a][0][0]].where}) and {at(nodes[b])} "
                     f"({pieces[at_node[b][0][0]].where}), {far:.4g} apart: expected one curve (--gap joins ends)")
    else:
        firsts = ", ".join(walk[0].where for walk, _ in parts[:3])
        mistakes.add(f"layer '{layer}'", f"{len(parts)} curves, with {firsts}: expected one a layer")


def _with_common_ends(walk: List[Piece], closed: bool) -> List[Piece]:
    """Every piece begins exactly where the last one ends."""
    result = []
    for k, piece in enumerate(walk):
        start = result[-1].end if result else piece.start
        end = result[0].start if closed and k == len(walk) - 1 and result else piece.end
        result.append(Piece(piece.form, start, end, piece.middle, piece.where, piece.layer))
    return result


def crossings(pieces: Sequence[Piece], closed: bool) -> List[Tuple[Piece, Piece, np.ndarray]]:
    """Where a curve meets itself away from its joints: pairs of pieces and the place."""
    number = len(pieces)
    curves = [piece.curve(16) for piece in pieces]
    lows, highs = np.array([c.min(axis=0) for c in curves]), np.array([c.max(axis=0) for c in curves])
    found = []
    for i in range(number):
        near = np.flatnonzero((lows[i + 1:] <= highs[i]).all(axis=1) & (highs[i + 1:] >= lows[i]).all(axis=1)) + i + 1
        for j in near:
            place = _meeting(curves[i], curves[j])
            if place is None:
                continue
            joined = j == i + 1 or (closed and i == 0 and j == number - 1)
            ends = [np.array(pieces[i].start), np.array(pieces[i].end)]
            size = max(pieces[i].size(), pieces[j].size())
            if joined and min(np.hypot(*(place - end)) for end in ends) <= 1e-6 * size:
                continue
            found.append((pieces[i], pieces[j], place))
    return found


def crossings_of(one: Sequence[Piece], other: Sequence[Piece]) -> List[Tuple[Piece, Piece, np.ndarray]]:
    """Where two curves cross: pairs of pieces and the place."""
    found = []
    for a in one:
        for b in other:
            place = _meeting(a.curve(16), b.curve(16))
            if place is not None:
                found.append((a, b, place))
    return found


def _meeting(a: np.ndarray, b: np.ndarray) -> Optional[np.ndarray]:
    """A place where two lines of chords cross, none where they do not; ends that only touch do not count."""
    p, r = a[:-1, None], (a[1:] - a[:-1])[:, None]
    q, s = b[None, :-1], (b[1:] - b[:-1])[None]
    across = r[..., 0] * s[..., 1] - r[..., 1] * s[..., 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        t = ((q - p)[..., 0] * s[..., 1] - (q - p)[..., 1] * s[..., 0]) / across
        u = ((q - p)[..., 0] * r[..., 1] - (q - p)[..., 1] * r[..., 0]) / across
    inside = (t > 1e-9) & (t < 1 - 1e-9) & (u > 1e-9) & (u < 1 - 1e-9)
    if not inside.any():
        return None
    i, j = np.argwhere(inside)[0]
    return (p + t[..., None] * r)[i, j]


def walked_around(pieces: List[Piece]) -> List[Piece]:
    """A closed contour, counter-clockwise: its inside on the left."""
    return pieces if signed_area(joined_curve(pieces, SPLIT)[:-1]) > 0 else turned_back(pieces)


def turned_back(pieces: Sequence[Piece]) -> List[Piece]:
    """The same curve, walked the other way."""
    return [piece.reversed() for piece in reversed(pieces)]


def side_of(curve: np.ndarray, point: np.ndarray) -> Tuple[int, float, bool]:
    """The side of a curve (n, 2) a point lies on: 1 left, -1 right; its distance; whether the nearest place is an open end, beyond which
    there is no side."""
    a, b = curve[:-1], curve[1:]
    chord = b - a
    share = np.clip(((point - a) * chord).sum(axis=1) / np.maximum((chord**2).sum(axis=1), 1e-300), 0, 1)
    off = point - a - share[:, None] * chord
    far = np.hypot(*off.T)
    k = int(np.argmin(far))
    closed = bool(np.allclose(curve[0], curve[-1], rtol=0, atol=1e-12 * np.ptp(curve, axis=0).max()))
    direction = chord[k] / np.hypot(*chord[k])
    beyond = False
    if share[k] in (0.0, 1.0):       # a corner: the mean of both directions decides
        other = k - 1 if share[k] == 0.0 else k + 1
        if closed:
            other %= len(chord)
        if 0 <= other < len(chord):
            direction = direction + chord[other] / np.hypot(*chord[other])
        else:
            beyond = abs(direction @ off[k]) > 1e-6 * far[k]
    cross = direction[0] * off[k][1] - direction[1] * off[k][0]
    return (1 if cross > 0 else -1 if cross < 0 else 0), float(far[k]), beyond


def points_inside(contour: np.ndarray, n: int = 40) -> np.ndarray:
    """Points of a lattice inside a closed contour (m, 2)."""
    low, high = contour.min(axis=0), contour.max(axis=0)
    x, y = (low[k] + (high[k] - low[k]) * (np.arange(n) + 0.5) / n for k in range(2))
    grid = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    return grid[is_within(contour, grid)]


def is_within(contour: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Which of points (m, 2) are inside a closed contour (n, 2)."""
    a, b = contour[:-1], contour[1:]
    above = (a[:, 1] > points[:, 1:2]) != (b[:, 1] > points[:, 1:2])
    with np.errstate(divide="ignore", invalid="ignore"):
        cut = a[:, 0] + (points[:, 1:2] - a[:, 1]) * (b[:, 0] - a[:, 0]) / (b[:, 1] - a[:, 1])
    return (above & (points[:, :1] < cut)).sum(axis=1) % 2 == 1
