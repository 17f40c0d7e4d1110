"""Closed forms and short integrations that references of decks are computed from; each with its source.

Functions of numbers; those of FORMS are called by name in the column `expected` of reference.csv. `wrong()` holds them against one
another: every formula against a quadrature of what it is the integral of, or against its limits.
Stresses are over the yield stress, friction is the constant fraction m of the shear yield stress of von Mises, sy/sqrt(3).
"""
import math

# Those that reference.csv may name.
FORMS = ("ring_bore", "ring_pressure", "extrusion_work", "extrusion_avitzur", "extrusion_parallel", "extrusion_container")


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


# Rod pushed from the radius r0 of a container to r1; the pressure of the punch.

def extrusion_work(r0, r1):
    """Work of homogeneous deformation: a lower bound where the die has no friction."""
    return 2*math.log(r0/r1)


def extrusion_avitzur(m, r0, r1, angle, land):
    """Upper bound of a cone, and of its land: flow towards the apex between two spheres.

    B. Avitzur, Metal Forming: Processes and Analysis (1968), ch. 6-8; `angle` is half that of the cone.
    """
    strain = avitzur_f(angle)*2*math.log(r0/r1)
    shear = angle/math.sin(angle)**2 - 1/math.tan(angle)
    friction = m*(math.log(r0/r1)/math.tan(angle) + land/r1)
    return strain + 2/math.sqrt(3)*(shear + friction)


def avitzur_f(angle):
    """Strain work of the flow towards the apex over that of homogeneous deformation."""
    k = math.sqrt(11/12)
    root = math.sqrt(1 - (k*math.sin(angle))**2)
    return (1 - math.cos(angle)*root + math.log((1 + k)/(k*math.cos(angle) + root))/math.sqrt(132))/math.sin(angle)**2


def extrusion_parallel(m, r0, r1, angle, fillet, land):
    """Upper bound of a die of two fillets and, between them, a cone of this angle to the axis, and of its land.

    Plane sections stay plane: v_z = r0^2/R^2, v_r = v_z R' r/R. No velocity jumps, since the profile R(z) is smooth. With
    e = r0^2 R'/R^3 and g = de/dz the strain rates are e, e, -2 e and the shear g r.
    """
    sag, rise = fillet*(1 - math.cos(angle)), fillet*math.sin(angle)
    cone = (r0 - r1 - 2*sag)/math.tan(angle)

    def power(radius, slope, bend):
        e = r0**2*slope/radius**3
        g = r0**2*(bend/radius**3 - 3*slope**2/radius**4)
        a, b = 4*e*e, g*g/3*radius**2
        # 2/R^2 times the integral of r sqrt(4 e^2 + r^2 g^2/3) over r, free of cancellation for small g
        whole, part = math.sqrt(a + b), math.sqrt(a)
        strain = 2/3*(a + b + whole*part + a)/(whole + part)
        return strain*radius**2 + 2/math.sqrt(3)*m*r0**2/radius*(1 + slope**2)

    def exit_arc(t):
        return power(r1 + fillet*(1 - math.cos(t)), math.tan(t), 1/(fillet*math.cos(t)**3))*fillet*math.cos(t)

    def entry_arc(t):
        return power(r0 - fillet*(1 - math.cos(t)), math.tan(t), -1/(fillet*math.cos(t)**3))*fillet*math.cos(t)

    def straight(z):
        return power(r1 + sag + z*math.tan(angle), math.tan(angle), 0.0)
    total = integral(exit_arc, 0.0, angle) + integral(entry_arc, 0.0, angle) + integral(straight, 0.0, cone)
    return total/r0**2 + 2/math.sqrt(3)*m*land/r1


def extrusion_container(m, r0, length):
    """Friction on this length of the container."""
    return 2/math.sqrt(3)*m*length/r0


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
    for angle in (0.01, 0.3, 1.2):
        near(f"Avitzur's f({angle})", avitzur_f(angle), 2/math.sin(angle)**2
             *integral(lambda t: math.sqrt(1 - 11/12*math.sin(t)**2)*math.sin(t), 0.0, angle), 1e-6)
    # a slender die without friction needs no more than the work of homogeneous deformation, with it the slab's too
    near("slender die", extrusion_parallel(0.0, 10.0, 9.0, 0.001, 20.0, 0.0), extrusion_work(10.0, 9.0), 1e-3)
    near("slender die, cone", extrusion_avitzur(0.2, 10.0, 9.0, 0.01, 3.0), extrusion_parallel(0.2, 10.0, 9.0, 0.01, 20.0, 3.0), 0.02)
    return lines
