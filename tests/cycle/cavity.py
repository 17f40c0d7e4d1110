"""How full a die's cavity is: the part inside the closed cavity, on true parabolas.

The cavity lies between the axis x = 0, the plane of symmetry y = 0, the die and the radius `mouth` where the flash leaves it. Dies
here are walked with x falling all the way, so that the die is a graph y = Y(x). By Green's theorem, walking around the part with
the part on the left, its volume inside the cavity is the integral of -2 pi x min(y, Y(x)) dx over what lies within the mouth:
sides that turn back, and bays of air, count rightly. Between crossings of part and die all integrands are polynomials, which
Gauss's rule with three points integrates exactly.
"""
import numpy
from parabolas import point, slope

GAUSS = numpy.array([-numpy.sqrt(0.6), 0.0, numpy.sqrt(0.6)]), numpy.array([5.0, 8.0, 5.0]) / 9
LOOKS = 16      # parts of a side between which crossings are looked for
HALVINGS = 60


def swept(parabola, first, last):
    """Integral of -2 pi x y dx from one parent coordinate to another: exact, the integrand is of degree 5."""
    xi = 0.5 * (first + last) + 0.5 * (last - first) * GAUSS[0]
    x, y = point(parabola, xi).T
    return -2 * numpy.pi * numpy.sum(GAUSS[1] * x * y * slope(parabola, xi)[:, 0]) * 0.5 * (last - first)


def crossings(parabola, x):
    """Parent coordinates within a parabola where its first coordinate is x."""
    a = 0.5 * (parabola[0, 0] + parabola[2, 0]) - parabola[1, 0]
    b = 0.5 * (parabola[2, 0] - parabola[0, 0])
    c = parabola[1, 0] - x
    if abs(a) <= 1e-14 * abs(b):
        roots = [-c / b] if b else []
    else:
        inner = b * b - 4 * a * c
        if inner < 0:
            return []
        q = -0.5 * (b + numpy.copysign(numpy.sqrt(inner), b))
        roots = [q / a] + ([c / q] if q else [])
    return [r for r in roots if -1 <= r <= 1]


class Graph:
    """A die walked with x falling, as a function of x."""

    def __init__(self, pieces):
        self.pieces = numpy.asarray(pieces)
        ends = self.pieces[:, [0, 2], 0]
        if not (numpy.all(ends[:, 0] > ends[:, 1]) and numpy.all(slope_signs(self.pieces) < 0)):
            raise ValueError("the die turns back: x does not fall all along it")
        self.joints = ends[:, 1]

    def place(self, x):
        """Piece and parent coordinate at x; the die ends are carried on."""
        k = min(int(numpy.searchsorted(-self.joints, -x)), len(self.pieces) - 1)
        roots = crossings(self.pieces[k], min(max(x, self.pieces[k][2, 0]), self.pieces[k][0, 0]))
        return k, roots[0] if roots else (1.0 if x <= self.joints[k] else -1.0)

    def height(self, x):
        """Y(x)."""
        k, xi = self.place(x)
        return point(self.pieces[k], xi)[1]

    def below(self, first, last):
        """Integral of -2 pi x Y dx from one x to another."""
        if first < last:
            return -self.below(last, first)
        (k, xi), (last_k, last_xi) = self.place(first), self.place(last)
        total = 0.0
        while k < last_k:
            total += swept(self.pieces[k], xi, 1.0)
            k, xi = k + 1, -1.0
        return total + swept(self.pieces[k], xi, last_xi)


def slope_signs(pieces):
    """Larger of dx/dxi at the ends of each piece: below zero where x falls all along it."""
    return numpy.array([max(slope(p, -1.0)[0], slope(p, 1.0)[0]) for p in pieces])


def cavity_volume(die, mouth):
    """Volume between axis, plane of symmetry, die and mouth."""
    return die.below(mouth, 0.0)


def volume_in_cavity(sides, die, mouth):
    """Volume of a part within the cavity; `sides` (n, 3, 2) are all of its boundary, the part on their left."""
    total = 0.0
    for side in sides:
        cuts = [-1.0, 1.0] + [xi for x in (mouth, *die.joints) for xi in crossings(side, x)]
        a = 0.5 * (side[0, 0] + side[2, 0]) - side[1, 0]
        if abs(a) > 0:
            turn = -0.25 * (side[2, 0] - side[0, 0]) / a
            cuts += [turn] if -1 < turn < 1 else []
        limits = numpy.unique(cuts)
        for first, last in zip(limits, limits[1:]):
            if point(side, 0.5 * (first + last))[0] > mouth:
                continue
            total += under_both(side, die, first, last)
    return total


def under_both(side, die, first, last):
    """Integral of -2 pi x min(y, Y) dx over a part of a side under one piece of the die."""
    def above(xi):
        x, y = point(side, xi)
        return y - die.height(x)

    looks = numpy.linspace(first, last, LOOKS + 1)
    gaps = [above(xi) for xi in looks]
    limits = [first]
    for k in range(LOOKS):
        if gaps[k] * gaps[k + 1] < 0:
            low, high = looks[k], looks[k + 1]
            for _ in range(HALVINGS):
                middle = 0.5 * (low + high)
                low, high = (middle, high) if above(middle) * gaps[k] > 0 else (low, middle)
            limits.append(0.5 * (low + high))
    limits.append(last)
    total = 0.0
    for one, next_one in zip(limits, limits[1:]):
        if above(0.5 * (one + next_one)) > 0:
            total += die.below(point(side, one)[0], point(side, next_one)[0])
        else:
            total += swept(side, one, next_one)
    return total
