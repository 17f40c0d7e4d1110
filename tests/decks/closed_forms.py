"""Closed forms and short integrations that references of decks are computed from; each with its source.

Functions of numbers; those of FORMS are called by name in the column `expected` of reference.csv. `wrong()` holds them against one
another: every formula against a quadrature of what it is the integral of, or against its limits.
Stresses are over the yield stress, friction is the constant fraction m of the shear yield stress of von Mises, sy/sqrt(3).
"""
import math

# Those that reference.csv may name.
FORMS = ("ring_bore", "ring_pressure")


def integral(function, begin, end, parts=200):
    """Gauss's rule of three points in each of equal parts: free of the ends, where these functions may be singular."""
    step = (end - begin)/parts
    away = math.sqrt(0.6)
    total = 0.0
    for k in range(parts):
        middle = begin + (k + 0.5)*step
        total += (5*function(middle - 0.5*away*step) + 8*function(middle) + 5*function(middle + 0.5*away*step))/18*step
    return total


def least(function, low, high):
    """Where a function of one minimum has it: golden section."""
    share = (math.sqrt(5) - 1)/2
    while high - low > 1e-9*max(abs(low), abs(high)):
        left, right = high - share*(high - low), low + share*(high - low)
        if function(left) < function(right):
            high = right
        else:
            low = left
    return 0.5*(low + high)


# Ring of radii ri and ro and full height h between flat dies, parallel flow: with the dies closing at the rate U,
# v_r = U/(2 h) (r - s/r), where s is the square of the neutral radius.
# J.B. Hawkyard, W. Johnson, Int. J. Mech. Sci. 9 (1967) 163-182; B. Avitzur, Metal Forming: Processes and Analysis (1968).

def ring_slope(s, ri, ro, h, m):
    """Derivative by s of the power, but for a positive factor: the strain of the ring, then the slip on the dies."""
    inner, outer = ri*ri, ro*ro
    neutral = math.sqrt(s)
    strain = 0.5*math.log((s + math.sqrt(3*inner**2 + s*s))*outer/((s + math.sqrt(3*outer**2 + s*s))*inner))
    return strain + m/h*(2*max(neutral, ri) - ri - ro)


def ring_neutral(ri, ro, h, m):
    """Square of the neutral radius, at which the power is least."""
    low, high = 0.0, ro*ro
    while high - low > 1e-13*ro*ro:
        s = 0.5*(low + high)
        if ring_slope(s, ri, ro, h, m) < 0:
            low = s
        else:
            high = s
    return 0.5*(low + high)


def ring_power(s, ri, ro, h, m):
    """Power of this flow over U and the area of the face: the mean pressure."""
    def rate(r):
        return math.sqrt(r**4 + s*s/3)/r + m/(math.sqrt(3)*h)*abs(r*r - s)
    neutral = min(max(math.sqrt(s), ri), ro)
    return 2*(integral(rate, ri, neutral) + integral(rate, neutral, ro))/(ro*ro - ri*ri)


def ring_at(m, reduction, outer=6.0, inner=3.0, height=2.0, steps=200):
    """Radii and height (ri, ro, h) of a ring of these diameters and this height when it has fallen by `reduction`."""
    ri, h = 0.5*inner, height
    volume = (0.25*outer*outer - ri*ri)*h

    def rate(ri, h):
        return -(ri - ring_neutral(ri, math.sqrt(volume/h + ri*ri), h, m)/ri)/(2*h)
    dh = -height*reduction/steps
    for _ in range(steps):          # midpoint rule
        middle = ri + 0.5*dh*rate(ri, h)
        ri += dh*rate(middle, h + 0.5*dh)
        h += dh
    return ri, math.sqrt(volume/h + ri*ri), h


def ring_bore(m, reduction, outer=6.0, inner=3.0, height=2.0):
    """Bore over the first bore."""
    return 2*ring_at(m, reduction, outer, inner, height)[0]/inner


def ring_pressure(m, reduction, outer=6.0, inner=3.0, height=2.0):
    """Upper bound of the mean pressure on the ring's face."""
    ri, ro, h = ring_at(m, reduction, outer, inner, height)
    return ring_power(ring_neutral(ri, ro, h, m), ri, ro, h, m)


def wrong():
    """What does not hold among these functions, a line each."""
    lines = []

    def near(what, found, wanted, tolerance):
        if not abs(found - wanted) <= tolerance*max(1.0, abs(wanted)):
            lines.append(f"{what}: {found!r}, wanted {wanted!r}")

    for m in (0.05, 0.2, 0.5, 1.0):
        sought = least(lambda s, m=m: ring_power(s, 3.0, 6.0, 4.0, m), 0.0, 36.0)
        near(f"neutral radius, m = {m}", math.sqrt(ring_neutral(3.0, 6.0, 4.0, m)), math.sqrt(sought), 1e-4)
    # Avitzur's closed form where the neutral radius lies within the bore
    x = (2*math.exp(0.05*6/4*0.5))**2
    form = 0.5*math.sqrt(3)*(x*x/16 - 1)/math.sqrt(x*(x - 1)*(1 - x/16))
    near("neutral radius within the bore", ring_neutral(3.0, 6.0, 4.0, 0.05)/36, form, 1e-9)
    near("ring without friction", ring_bore(0.0, 0.5), math.sqrt(2), 1e-5)
    near("pressure without friction", ring_pressure(0.0, 0.3), 1.0, 1e-9)
    return lines
