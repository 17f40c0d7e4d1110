#!/usr/bin/env python3
"""Meshes of the free mesher on the outlines of bench/mesher_bench.py, each as it is and turned, with other sizes.

usage: run_outlines.py [-v] [-k] [N]     N: turned ones of each, default 2; angles and sizes are drawn with a fixed seed
"""
import math
import os
import random
import sys

sys.dont_write_bytecode = True
TESTS = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path[:0] = [os.path.join(TESTS, "runs"), os.path.join(TESTS, "bench")]
from mesher_bench import mesh, outlines, write_outline  # noqa: E402
from support import Checks  # noqa: E402

SEED = 1
# The least an element may have, where the contour itself has no sharper corner; 45 and .55 are found over 200 turned outlines, but for
# the flash: its sides have ends of elements where their own lengths put them, and the strip between is skewed.
ANGLE, JACOBIAN, ANGLE_OF_FLASH = 37.0, 0.55, 30.0
LARGEST = "large"     # takes too long here


def turned(contours, smallest, largest, places, angle, factor):
    """An outline about the origin, with other sizes."""
    def at(point):
        c, s = math.cos(angle), math.sin(angle)
        return point[0] * c - point[1] * s, point[0] * s + point[1] * c
    return ([[tuple(at(point) for point in piece) for piece in loop] for loop in contours], smallest * factor, largest * factor,
            [(*at(place[:2]), place[2] * factor, place[3]) for place in places])


def good(checks, name, contours, smallest, largest, places, corner):
    """One mesh: made at the first attempt, of good shape."""
    path = checks.path("outline.txt")
    write_outline(path, contours, smallest, largest, places)
    values, why = mesh(path, "free", checks.path("mesh.txt"))
    if not checks.that(values is not None, f"{name}: there is a mesh", why):
        return
    least = min(ANGLE_OF_FLASH if "flash" in name else ANGLE, 0.99 * corner)
    checks.that(values["attempts"] == 1, f"{name}: at the first attempt", values)
    checks.that(values["angle"] > least, f"{name}: smallest angle", values)
    checks.that(values["jacobian"] > min(JACOBIAN, 0.99 * math.sin(math.radians(corner))), f"{name}: scaled Jacobian", values)


def main():
    checks = Checks()
    numbers = [int(word) for word in sys.argv[1:] if word.isdigit()]
    draw = random.Random(SEED)
    for name, (contours, smallest, largest, places, corner) in outlines().items():
        if name == LARGEST:
            continue
        good(checks, name, contours, smallest, largest, places, corner)
        for _ in range(numbers[0] if numbers else 2):
            factor, angle = draw.uniform(0.4, 1.4), draw.uniform(0, 2 * math.pi)
            other = turned(contours, smallest, largest, places, angle, factor)
            good(checks, f"{name}, turned by {angle:.4f}, sizes times {factor:.4f}", *other, corner)
    checks.end()


if __name__ == "__main__":
    main()
