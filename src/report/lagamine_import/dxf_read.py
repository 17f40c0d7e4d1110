"""Drawings in DXF, by ezdxf: entities of the plane as pieces, layer by layer."""
import contextlib
import io
import math
from dataclasses import dataclass, field
from typing import Dict, List

import numpy as np

from .mistakes import Mistakes, Refused, count
from .pieces import Piece, arc_by_bulge
from .smooth import parabolas_of

# No lines of the part: left out, and said so.
NO_CURVES = {"TEXT", "MTEXT", "DIMENSION", "ARC_DIMENSION", "LARGE_RADIAL_DIMENSION", "LEADER", "MLEADER", "MULTILEADER", "HATCH", "POINT",
             "ATTDEF", "ATTRIB", "IMAGE", "WIPEOUT", "VIEWPORT", "TOLERANCE", "XLINE", "RAY"}
SOLID = {"3DFACE", "3DSOLID", "BODY", "MESH", "POLYFACE", "REGION", "SURFACE", "EXTRUDEDSURFACE", "LOFTEDSURFACE", "REVOLVEDSURFACE",
         "SWEPTSURFACE"}
UNITS = {1: "inches", 2: "feet", 4: "mm", 5: "cm", 6: "m", 13: "micrometres", 14: "dm"}
FLAT = 1e-9              # of the size of the drawing


@dataclass
class Drawing:
    """Pieces of the layers asked for, the names of all layers that hold entities, notes for the user."""

    layers: Dict[str, List[Piece]] = field(default_factory=dict)
    present: List[str] = field(default_factory=list)
    notes: List[str] = field(default_factory=list)


def read_dxf(path: str, tolerance: float, wanted, mistakes: Mistakes) -> Drawing:
    """Entities of the model space on the layers `wanted` as pieces; splines and ellipses within `tolerance` [length]."""
    import ezdxf
    try:
        with contextlib.redirect_stdout(io.StringIO()):
            document = ezdxf.readfile(path)
    except OSError as error:
        raise Refused(f"{path}: not a DXF file: {' '.join(str(error).split())}") from error
    except Exception as error:       # ezdxf fails in many ways on files that are cut short
        raise Refused(f"{path}: not a DXF file that can be read: {' '.join(str(error).split()) or type(error).__name__}") from error
    drawing, skipped = Drawing(), {}
    for entity in document.modelspace():
        layer, kind = entity.dxf.layer, entity.dxftype()
        if layer not in drawing.present:
            drawing.present.append(layer)
        if layer not in wanted:
            continue
        drawing.layers.setdefault(layer, [])
        where = f"{kind} {entity.dxf.handle} on layer '{layer}'"
        if kind in NO_CURVES:
            skipped[kind] = skipped.get(kind, 0) + 1
            continue
        try:
            drawing.layers[layer] += _pieces(entity, kind, where, layer, tolerance, mistakes)
        except (ValueError, ZeroDivisionError, ezdxf.DXFError) as error:
            mistakes.add(where, f"cannot be evaluated: {' '.join(str(error).split())}")
    if skipped:
        drawing.notes.append("left out: " + ", ".join(count(number, kind) for kind, number in skipped.items()))
    unit = UNITS.get(document.header.get("$INSUNITS", 0))
    if unit:
        drawing.notes.append(f"the drawing is in {unit}")
    return drawing


def _pieces(entity, kind: str, where: str, layer: str, tolerance: float, mistakes: Mistakes) -> List[Piece]:
    """The pieces of one entity, in the order it is drawn."""
    if kind == "INSERT":
        mistakes.add(where, f"is a block ('{entity.dxf.name}'): expected its lines themselves (EXPLODE)")
        return []
    if kind in SOLID or (kind == "POLYLINE" and not entity.is_2d_polyline):
        mistakes.add(where, "is in three dimensions: expected lines, arcs, polylines, splines of a plane section")
        return []
    if kind not in ("LINE", "ARC", "CIRCLE", "ELLIPSE", "SPLINE", "LWPOLYLINE", "POLYLINE"):
        mistakes.add(where, "is of a kind that is not read: expected LINE, ARC, CIRCLE, ELLIPSE, LWPOLYLINE, POLYLINE or SPLINE")
        return []
    if kind in ("LINE", "ELLIPSE", "SPLINE"):
        turned = [1.0]
    else:
        turned = list(entity.dxf.get("extrusion", (0, 0, 1)))
        if abs(turned[0]) > FLAT or abs(turned[1]) > FLAT:
            mistakes.add(where, "is not in the plane x y: expected a plane section")
            return []
    pieces, heights = _plane_pieces(entity, kind, where, layer, tolerance, mistakes)
    size = max((max(map(abs, piece.start + piece.end)) for piece in pieces), default=1.0)
    if any(abs(z - heights[0]) > FLAT * size for z in heights):
        mistakes.add(where, f"leaves the plane (z from {min(heights):g} to {max(heights):g}): expected a plane section")
        return []
    if turned[-1] < 0:       # seen from behind: x of the entity is -x of the drawing
        pieces = [Piece(p.form, (-p.start[0], p.start[1]), (-p.end[0], p.end[1]), (-p.middle[0], p.middle[1]), p.where, p.layer)
                  for p in pieces]
    for piece in pieces:
        if not np.isfinite(piece.start + piece.end).all():
            mistakes.add(where, "a coordinate is not a finite number")
            return []
    kept = [piece for piece in pieces if piece.size() > 0]
    if not kept:
        mistakes.add(where, "has no length")
    return kept


def _plane_pieces(entity, kind: str, where: str, layer: str, tolerance: float, mistakes: Mistakes):
    """Pieces in the entity's own plane, and the heights of its points over it."""
    dxf = entity.dxf
    if kind == "LINE":
        return [Piece("SEGM", _xy(dxf.start), _xy(dxf.end), where=where, layer=layer)], [dxf.start.z, dxf.end.z]
    if kind == "CIRCLE":
        return _round(dxf.center, dxf.radius, 0.0, 360.0, 2, where, layer), [dxf.center.z]
    if kind == "ARC":
        span = (dxf.end_angle - dxf.start_angle) % 360 or 360.0
        return _round(dxf.center, dxf.radius, dxf.start_angle, span, 1 if span <= 270 else 2, where, layer), [dxf.center.z]
    if kind == "LWPOLYLINE":
        return _polyline(list(entity.get_points("xyb")), bool(entity.closed), where, layer), [dxf.get("elevation", 0.0)]
    if kind == "POLYLINE":
        if dxf.get("flags", 0) & 6:
            mistakes.add(where, "is a fitted or splined polyline: expected a SPLINE, or a polyline of lines and arcs")
            return [], [0.0]
        rows = [(v.dxf.location.x, v.dxf.location.y, v.dxf.get("bulge", 0.0)) for v in entity.vertices]
        return _polyline(rows, bool(entity.is_closed), where, layer), [v.dxf.location.z for v in entity.vertices] or [0.0]
    if kind == "ELLIPSE":
        return _ellipse(entity, where, layer, tolerance)
    return _spline(entity, where, layer, tolerance)


def _xy(point):
    return float(point[0]), float(point[1])


def _round(centre, radius: float, first: float, span: float, parts: int, where: str, layer: str) -> List[Piece]:
    """A circle or a part of one, in so many arcs; angles in degrees, counter-clockwise."""
    if not radius > 0:
        raise ValueError(f"its radius is {radius:g}")

    def on(angle):
        return centre[0] + radius * math.cos(math.radians(angle)), centre[1] + radius * math.sin(math.radians(angle))
    step = span / parts
    ends = [on(first + k * step) for k in range(parts + 1)]
    if span == 360:
        ends[-1] = ends[0]
    return [Piece("ARC", ends[k], ends[k + 1], on(first + (k + 0.5) * step), where, layer) for k in range(parts)]


def _polyline(rows, closed: bool, where: str, layer: str) -> List[Piece]:
    """Sides of a polyline: rows x, y, bulge."""
    if len(rows) < 2:
        raise ValueError("a polyline of fewer than two points")
    places = range(len(rows)) if closed else range(len(rows) - 1)
    pieces = []
    for k in places:
        x, y, bulge = (float(value) for value in rows[k])
        end = rows[(k + 1) % len(rows)]
        if (x, y) != (float(end[0]), float(end[1])):
            pieces.append(arc_by_bulge((x, y), (float(end[0]), float(end[1])), bulge, where, layer))
    return pieces


def _ellipse(entity, where: str, layer: str, tolerance: float):
    """An ellipse or a part of one: by its axes and its parameter (DXF reference, ELLIPSE)."""
    dxf = entity.dxf
    normal = np.array(dxf.get("extrusion", (0, 0, 1)), dtype=float)
    if np.abs(normal[:2]).max() > FLAT:
        raise ValueError("it is not in the plane x y: expected a plane section")
    centre, major = np.array(dxf.center), np.array(dxf.major_axis)
    minor = np.cross(normal / np.linalg.norm(normal), major) * dxf.ratio
    first, last = dxf.start_param, dxf.end_param
    if last <= first:
        last += 2 * math.pi

    def curve(t):
        return centre[:2] + np.cos(t)[:, None] * major[:2] + np.sin(t)[:, None] * minor[:2]

    def slope(t):
        return -np.sin(t)[:, None] * major[:2] + np.cos(t)[:, None] * minor[:2]
    # no interval of more than an eighth of the way round
    breaks = np.linspace(first, last, max(1, math.ceil((last - first) / (math.pi / 4) - 1e-9)) + 1)
    return parabolas_of(curve, slope, breaks, tolerance, where, layer), [centre[2], centre[2] + major[2]]


def _spline(entity, where: str, layer: str, tolerance: float):
    """A B-spline, rational or not, by its control points; one that has fit points alone is interpolated as ezdxf does."""
    tool = entity.construction_tool()
    if tool.order < 3:      # chords
        points = [tuple(map(float, p)) for p in tool.control_points]
        return [Piece("SEGM", a[:2], b[:2], where=where, layer=layer) for a, b in zip(points[:-1], points[1:]) if a[:2] != b[:2]], \
            [p[2] for p in points]
    knots = np.unique(np.array(tool.knots(), dtype=float))
    low, high = float(tool.knots()[tool.order - 1]), float(tool.knots()[len(tool.control_points)])
    inner = knots[(knots > low) & (knots < high)]

    def curve(t):
        return np.array([tuple(p)[:2] for p in tool.points(list(map(float, t)))], dtype=float)

    def slope(t):
        return np.array([tuple(d[1])[:2] for d in tool.derivatives(list(map(float, t)), 1)], dtype=float)
    breaks = [low, *inner, high]
    return parabolas_of(curve, slope, breaks, tolerance, where, layer), [float(p[2]) for p in tool.control_points]
