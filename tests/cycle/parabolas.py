"""Parabolas through three points: sides of elements and pieces of dies; boundaries of meshes, distances. Arrays (..., 3, 2)."""
import collections

import numpy

LOOKS = 17        # points of a parabola from which the closest one is searched
ITERATIONS = 6    # of Newton's method, from the nearest of them


def point(parabola, xi):
    """Points at parent coordinates of one parabola."""
    xi = numpy.asarray(xi, dtype=float)[..., None]
    return 0.5 * xi * (xi - 1) * parabola[0] + (1 - xi * xi) * parabola[1] + 0.5 * xi * (xi + 1) * parabola[2]


def slope(parabola, xi):
    """d point / d xi."""
    xi = numpy.asarray(xi, dtype=float)[..., None]
    return (xi - 0.5) * parabola[0] - 2 * xi * parabola[1] + (xi + 0.5) * parabola[2]


def rows(table, width):
    """Rows of so many entries, however the file turns them."""
    table = table[()]
    return table if table.shape[1] == width else table.T


def boundary(coordinates, connectivity):
    """Sides of one element alone, the part on their left (n, 3, 2); nodes count from 0."""
    sides = numpy.concatenate([connectivity[:, [i, 4 + i, (i + 1) % 4]] for i in range(4)])
    count = collections.Counter(sides[:, 1])
    return coordinates[numpy.array([side for side in sides if count[side[1]] == 1])]


def signed_distance(parabolas, points):
    """Distance of points (n, 2) to the nearest of some parabolas, below zero on their right."""
    best = numpy.full(len(points), numpy.inf)
    sign = numpy.ones(len(points))
    looks = numpy.linspace(-1, 1, LOOKS)
    for one in parabolas:
        a, b = 0.5 * (one[0] + one[2]) - one[1], 0.5 * (one[2] - one[0])
        arms = point(one, looks)[None] - points[:, None]
        xi = looks[numpy.argmin(numpy.sum(arms**2, axis=2), axis=1)]
        for _ in range(ITERATIONS):
            arm, tangent = point(one, xi) - points, b + 2 * xi[:, None] * a
            bend = numpy.sum(tangent**2, axis=1) + 2 * arm @ a
            xi = numpy.clip(xi - numpy.sum(arm * tangent, axis=1) / numpy.where(bend > 0, bend, numpy.inf), -1, 1)
        arm, tangent = points - point(one, xi), slope(one, xi)
        distance = numpy.hypot(*arm.T)
        nearer = distance < best
        best[nearer] = distance[nearer]
        side = tangent[:, 0] * arm[:, 1] - tangent[:, 1] * arm[:, 0]
        sign[nearer] = numpy.where(side[nearer] < 0, -1.0, 1.0)
    return sign * best
