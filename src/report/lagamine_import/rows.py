"""Cards of a deck: NODES, PL8LS, SIDES, DIE, BODY."""
from typing import List, Optional, Sequence, Tuple

from .chains import Contour
from .mesh_build import Mesh
from .pieces import Piece


def number(value: float) -> str:
    """The shortest text that reads back as the same number."""
    text = repr(float(value) + 0.0)       # no -0
    return text[:-1] if text.endswith(".0") else text


def mesh_rows(mesh: Mesh, npoint: int, mean: bool, law: Optional[str]) -> List[str]:
    """NODES, a PL8LS a body, a SIDES a set."""
    lines = ["NODES"]
    lines += [f"   {label} {number(x)} {number(y)}" for label, (x, y) in zip(mesh.labels, mesh.points)]
    for body in mesh.bodies:
        lines.append(f"PL8LS  {body.name} {npoint} {law or body.law}" + (" MEAN" if mean else ""))
        labels = mesh.labels[body.nodes]
        lines += [f"   {label}   " + " ".join(map(str, row)) for label, row in zip(body.labels, labels)]
    for name, sides in mesh.sides.items():
        lines.append(f"SIDES  {name}")
        lines += [f"   {element} {side}" for element, side in sides]
    return lines


def contour_rows(contour: Contour, npoint: int, mean: bool, law: Optional[str], pilot: Optional[Tuple[float, float]],
                 tolerance: float) -> List[str]:
    """A DIE or a BODY, rows with their numbers behind."""
    if contour.card == "DIE":
        head = f"DIE    {contour.name}" + (f" PILOT {number(pilot[0])} {number(pilot[1])}" if pilot else "")
    else:
        head = f"BODY   {contour.name} PL8LS {npoint} {law or contour.name}" + (" MEAN" if mean else "")
    lines = [head]
    rows = [_row(piece, tolerance) for piece in contour.rows()]
    wide = max(map(len, rows))
    for k, (row, piece) in enumerate(zip(rows, contour.rows()), 1):
        lines.append(f"   {row:<{min(wide, 100)}}   ! {k}: {_ascii(piece.where)}")
    return lines


def _row(piece: Piece, tolerance: float) -> str:
    places: Sequence = [piece.start, piece.middle, piece.end] if piece.form != "SEGM" else [piece.start, piece.end]
    words = "   ".join(f"{number(x)} {number(y)}" for x, y in places)
    return f"{piece.form:<5}  {words}" + (f"   {number(tolerance)}" if piece.form == "ARC" else "")


def _ascii(text: str) -> str:
    return "".join(c if " " <= c <= "~" else "?" for c in text)
