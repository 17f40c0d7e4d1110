#!/usr/bin/env python3
"""Draws rib.dxf with ezdxf: a billet and the die of a rib with a round crown. Lengths in mm.

usage: draw_rib.py [FILE]       default: rib.dxf beside this script
"""
import os
import sys

import ezdxf

QUARTER = 2**0.5 - 1        # bulge of a quarter of a circle: the tangent of a quarter of its angle


def draw(path):
    """Layers: billet (a closed polyline), die (a line, a polyline with bulges, a spline), axis (a line for the eye), notes."""
    document = ezdxf.new("R2000", setup=False)
    document.header["$INSUNITS"] = 4        # mm
    for name in ("billet", "die", "axis", "notes"):
        document.layers.new(name)
    space = document.modelspace()
    space.add_lwpolyline([(0, 0), (20, 0), (20, 12), (0, 12)], close=True, dxfattribs={"layer": "billet"})
    die = {"layer": "die"}
    space.add_line((0, 15.2), (-1, 15.2), dxfattribs=die)
    # roof of the flange, fillet of radius 1.5 at the foot of the rib
    space.add_lwpolyline([(34, 12, 0), (10.5, 12, -QUARTER), (9, 13.5, 0)], format="xyb", dxfattribs=die)
    # crown: from the fillet, which it continues, to the axis, which it meets at a right angle
    crown = space.add_spline(degree=3, dxfattribs=die)
    crown.control_points = [(9, 13.5, 0), (9, 14.7, 0), (5, 15.2, 0), (0, 15.2, 0)]
    crown.knots = [0, 0, 0, 0, 1, 1, 1, 1]
    space.add_line((0, -2), (0, 18), dxfattribs={"layer": "axis"})
    space.add_text("rib, R1.5 at its foot", dxfattribs={"layer": "notes", "height": 0.8}).set_pos((22, 14))
    document.saveas(path)


if __name__ == "__main__":
    draw(sys.argv[1] if len(sys.argv) > 1 else os.path.join(os.path.dirname(os.path.abspath(__file__)), "rib.dxf"))
