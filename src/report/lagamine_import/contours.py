"""Layers of a drawing as cards DIE and BODY, the part on the left of each."""
from dataclasses import dataclass, field
from typing import Dict, List, Optional, Sequence, Tuple

import numpy as np

from .chains import Contour, chain, crossings, crossings_of, is_within, side_of, turned_back, walked_around
from .mistakes import Mistakes, at
from .names import Names
from .pieces import Piece, joined_curve, signed_area

GAP = 1e-6      # ends nearer than this share of the size of the drawing are one point, where --gap does not say otherwise


@dataclass
class ContourWishes:
    """What the options say: layers of dies and of bodies, a point of the part (none: found), the gap that is closed, scale, shift."""

    dies: Sequence[str] = ()
    bodies: Sequence[str] = ()
    part: Optional[Tuple[float, float]] = None
    gap: Optional[float] = None
    scale: float = 1.0
    shift: Tuple[float, float] = (0.0, 0.0)
    notes: List[str] = field(default_factory=list)


def build_contours(layers: Dict[str, List[Piece]], present: Sequence[str], wishes: ContourWishes, names: Names, mistakes: Mistakes) -> List[Contour]:
    """The contours asked for, bodies first; refused with all their mistakes at once. `present` are the layers that hold anything."""
    wanted = [*wishes.bodies, *wishes.dies]
    there = ", ".join(f"'{layer}'" for layer in present)
    broken = bool(mistakes.lines)
    if not wanted:
        mistakes.add("layers", f"say which is what by --die LAYER and --body LAYER; there are: {there or 'none'}")
    for layer in wanted:
        if not layers.get(layer) and not broken:
            mistakes.add(f"layer '{layer}'", f"has no lines; there are: {there or 'none'}")
        if wanted.count(layer) > 1:
            mistakes.add(f"layer '{layer}'", "is named more than once by --die and --body")
    left = [f"'{layer}'" for layer in present if layer not in wanted]
    if left:
        wishes.notes.append(f"layers left out: {', '.join(left)}")
    moved = {layer: [_moved(piece, wishes) for piece in layers.get(layer, [])] for layer in dict.fromkeys(wanted)}
    ends = [point for pieces in moved.values() for piece in pieces for point in (piece.start, piece.end)]
    size = float(np.ptp(np.array(ends), axis=0).max()) if ends else 1.0
    gap = wishes.gap if wishes.gap is not None else GAP * size
    bodies = [_contour("BODY", layer, moved[layer], gap, names, mistakes) for layer in dict.fromkeys(wishes.bodies) if moved[layer]]
    dies = [_contour("DIE", layer, moved[layer], gap, names, mistakes) for layer in dict.fromkeys(wishes.dies) if moved[layer]]
    parts = [contour for contour in bodies if contour]
    for die in dies:
        if die:
            _orient(die, parts, wishes, mistakes)
    names.refuse_unknown()
    mistakes.refuse()
    return [*parts, *(die for die in dies if die)]


def _moved(piece: Piece, wishes: ContourWishes) -> Piece:
    def to(point):
        return tuple(float(wishes.scale * value + shift) for value, shift in zip(point, wishes.shift))
    return Piece(piece.form, to(piece.start), to(piece.end), to(piece.middle), piece.where, piece.layer)


def _contour(card: str, layer: str, pieces: List[Piece], gap: float, names: Names, mistakes: Mistakes) -> Optional[Contour]:
    """The curve of a layer, a body's counter-clockwise and its holes clockwise."""
    name = names.name(layer, "layer")
    short = [piece for piece in pieces if piece.size() <= gap]
    for piece in short:
        mistakes.add(piece.where, f"is {piece.size():.3g} long, no longer than the gap that is closed, {gap:.3g} (--gap)")
    found = chain(pieces, gap, card == "BODY", layer, mistakes) if not short else None
    if found is None:
        return None
    crossed = [place for walk, closed in found for place in crossings(walk, closed)]
    crossed += [place for k, (walk, _) in enumerate(found) for other, _ in found[:k] for place in crossings_of(other, walk)[:1]]
    for one, other, place in crossed:
        mistakes.add(one.where, f"crosses {other.where if other.where != one.where else 'itself'} at {at(place)}")
    if crossed:
        return None
    walks = [walked_around(walk) if closed else walk for walk, closed in found]
    walks.sort(key=lambda walk: -abs(signed_area(joined_curve(walk, 16)[:-1])))
    if not _are_holes(walks, layer, mistakes):
        return None
    return Contour(card, name, walks[0], found[0][1], "inside the contour" if card == "BODY" else "", [turned_back(walk) for walk in walks[1:]])


def _are_holes(walks: List[List[Piece]], layer: str, mistakes: Mistakes) -> bool:
    """All curves but the first, the largest one, lie in that one and in no other."""
    curves = [joined_curve(walk, 16) for walk in walks]
    before = len(mistakes.lines)
    for k, walk in enumerate(walks[1:], 1):
        around = [j for j, curve in enumerate(curves[:k]) if is_within(curve, curves[k][:1])[0]]
        if around != [0]:
            where = f"in the hole with {walks[around[-1]][0].where}" if around else f"beside the one with {walks[0][0].where}"
            mistakes.add(f"layer '{layer}'", f"the curve with {walk[0].where} lies {where}: expected one body a layer, and its holes inside it")
    return len(mistakes.lines) == before


def _orient(die: Contour, bodies: Sequence[Contour], wishes: ContourWishes, mistakes: Mistakes) -> None:
    """The part on the left: a point of it is given, or the body nearest to the die shows where it is."""
    curve = die.curve(32)
    if wishes.part is not None:
        side, _, beyond = side_of(curve, np.array(wishes.part))
        die.side_by = f"the point {at(wishes.part)} of --part"
        if side == 0 or beyond:
            mistakes.add(f"layer '{die.pieces[0].layer}'", f"{die.side_by} lies {'beyond an end of' if beyond else 'on'} the curve: expected it to one side")
            return
    elif bodies:
        votes = []
        for body in bodies:
            for point in body.inside():
                side, far, beyond = side_of(curve, point)
                if side and not beyond:
                    votes.append((far, side, body.name))
        if not votes:
            mistakes.add(f"layer '{die.pieces[0].layer}'", "the bodies lie beyond its ends: say where the part is by --part X Y")
            return
        votes.sort()
        side, name = votes[0][1:]
        near = {vote[1] for vote in votes[:max(3, len(votes) // 20)]}
        die.side_by = f"the body '{name}'"
        if len(near) > 1:
            mistakes.add(f"layer '{die.pieces[0].layer}'", f"the body '{name}' lies on both sides of it: say where the part is by --part X Y")
            return
    else:
        mistakes.add(f"layer '{die.pieces[0].layer}'", "on which side the part is cannot be found without a body: give a point of the part by --part X Y")
        return
    if side < 0:
        die.pieces = turned_back(die.pieces)
