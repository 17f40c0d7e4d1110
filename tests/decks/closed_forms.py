"""Closed forms and short integrations that references of decks are computed from; each with its source.

Functions of numbers; those of FORMS are called by name in the column `expected` of reference.csv. `wrong()` holds them against one
another: every formula against a quadrature of what it is the integral of, or against its limits.
Stresses are over the yield stress, but of polymers in MPa; friction is the constant fraction m of the shear yield stress of von
Mises, sy/sqrt(3).
"""
import math

# Those that reference.csv may name.
FORMS = ("ring_bore", "ring_pressure", "extrusion_work", "extrusion_avitzur", "extrusion_parallel", "extrusion_container",
         "disc_stress", "disc_radius", "disc_friction", "tube_pressure", "squeeze_scott", "squeeze_bound",
         "slab_cooled")


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


# Disc of a polymer between flat dies; the parameters are those of the decks, the law that of C. G'Sell, J.J. Jonas,
# J. Mater. Sci. 14 (1979) 583-591.

def gsell(p, rate, temperature, m=0.1, k=0.004, w=30.0, h=0.3, a=2500.0):
    """Flow stress at a strain, a rate and a temperature in degrees Celsius."""
    return k*math.exp(a/(temperature + 273.15))*(1 - math.exp(-w*p))*math.exp(h*p*p)*rate**m


def disc_stress(travel, speed, temperature, half=5.0, modulus=500.0, rounds=4):
    """Axial stress of a disc of this half height that stays a cylinder, its dies moving at a constant speed.

    Strain and rate are e = ln(H/h) and e' = v/h = v/H exp(e), less the elastic ones, s/E and ds/de e'/E: found from the stress
    of the round before; the first takes the polymer as rigid. Each round shrinks what is left by about ds/de/E.
    """
    def stress(e, rounds):
        rate = speed/half*math.exp(e)
        if rounds == 0:
            return gsell(e, rate, temperature)
        near, step = stress(e, rounds - 1), 1e-3*e
        slope = (stress(e + step, rounds - 1) - stress(e - step, rounds - 1))/(2*step)
        return gsell(e - near/modulus, rate*(1 - slope/modulus), temperature)
    return stress(math.log(half/(half - travel)), rounds)


def disc_radius(travel, stress=0.0, half=5.0, radius=20.0, modulus=500.0, poisson=0.45):
    """Radius of this disc: its volume falls by the elastic strain of the axial stress alone."""
    return radius*math.sqrt(half/(half - travel)*math.exp((2*poisson - 1)*stress/modulus))


def disc_friction(m, travel, half=5.0, radius=20.0):
    """Mean pressure over the stress without friction, if the disc stays a cylinder: slab, and upper bound.

    B. Avitzur, Metal Forming: Processes and Analysis (1968), ch. 5. Strain and rate are the same everywhere.
    """
    return 1 + m/(3*math.sqrt(3))*disc_radius(travel, 0.0, half, radius)/(half - travel)


def tube_pressure(travel, speed, temperature, inner=10.0, outer=15.0):
    """Pressure in a rigid-viscoplastic tube without strain along its axis, its bore moving out at a constant speed.

    Volume: r^2 = R^2 + a^2 - A^2, r r' = a a'. Hoop and radial strain are +-ln(r/R), so that the equivalent one is 2/sqrt(3) ln(r/R),
    and the stresses differ by 2/sqrt(3) s; equilibrium gives the integral of this over r, here by the place R at the start.
    """
    bore = inner + travel
    share = 2/math.sqrt(3)

    def layer(start):
        square = start**2 + bore**2 - inner**2
        return share*gsell(share*0.5*math.log(square/start**2), share*bore*speed/square, temperature)*start/square
    return integral(layer, inner, outer)


# Thin disc of a power law, s = c rate^n, that sticks to its dies; force on a die. b is half the gap, v the speed of a die, each of
# volume R^2 b. In shear tau = c/3^((n+1)/2) gamma'^n.

def squeeze_scott(n, travel, speed, temperature, radius=40.0, half=1.0):
    """Theory of lubrication: J.R. Scott, Trans. Inst. Rubber Ind. 7 (1931) 169-186.

    Flux between plates Q = 2 b^2 n/(2n+1) (b G/c')^(1/n) = r v (volume), where G = -dp/dr and tau = c' gamma'^n; the force is
    pi times the integral of r^2 G.
    """
    b = half - travel
    r = radius*math.sqrt(half/b)
    c = gsell(1.0, 1.0, temperature, w=1000.0, h=0.0)/3**((n + 1)/2)
    return math.pi*c/(n + 3)*((2*n + 1)*speed/(2*n*b*b))**n*r**(n + 3)/b


def squeeze_bound(n, travel, speed, temperature, radius=40.0, half=1.0):
    """Upper bound: the power of v_r = v r/(2 b) g(z/b), v_z to match, with g(s) = (q+1)/q (1 - s^q), for the best q.

    In Scott's theory q = 1 + 1/n; here the stretching counts as well as the shear. Why a bound: the stress is the derivative of a
    potential, c rate^(n+1)/(n+1), which is convex, so that by virtual power its integral is least for the true flow among all that
    the dies allow; and the power is n+1 times this integral.
    """
    b = half - travel
    edge = radius*math.sqrt(half/b)
    c = gsell(1.0, 1.0, temperature, w=1000.0, h=0.0)

    def power(q):
        def layer(s):
            stretch = speed/b*(q + 1)/q*(1 - s**q)
            shear = speed/(2*b*b)*(q + 1)*s**(q - 1)/math.sqrt(3)
            # integral of (stretch^2 + (shear r)^2)^((n+1)/2) 2 r dr
            begin, end = stretch**2, stretch**2 + (shear*edge)**2
            k = (n + 3)/2
            if end - begin < 1e-6*begin:
                return begin**(k - 1)*edge**2
            return (end**k - begin**k)/(k*shear**2)
        return math.pi*c*b*integral(layer, 0.0, 1.0)/speed
    q = least(power, 0.5, 3 + 2/n)
    return power(q)


def slab_cooled(place, biot, fourier, terms=60):
    """Share of the difference to the surroundings that is left at `place`, 0 in the middle to 1 at the surface, of a slab that cools by
    convection; H.S. Carslaw, J.C. Jaeger, Conduction of Heat in Solids, 2nd ed., section 3.11."""
    left = 0.0
    for n in range(terms):
        low, high = n*math.pi, (n + 0.5)*math.pi
        for _ in range(100):
            root = 0.5*(low + high)
            if root*math.sin(root) < biot*math.cos(root) if n % 2 == 0 else root*math.sin(root) > biot*math.cos(root):
                low = root
            else:
                high = root
        left += 2*math.sin(root)/(root + math.sin(root)*math.cos(root))*math.cos(root*place)*math.exp(-root*root*fourier)
    return left


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
    # disc: the stress is that of the formula at its plastic strain and rate, and that of a rigid disc where E is large
    for travel in (1.0, 2.0, 3.0):
        e, s = math.log(5/(5 - travel)), disc_stress(travel, 2.0, 140.0)
        rise = (disc_stress(travel + 1e-4, 2.0, 140.0) - disc_stress(travel - 1e-4, 2.0, 140.0))/2e-4
        near(f"disc, travel {travel}", s, gsell(e - s/500, 2*(1/(5 - travel) - rise/500), 140.0), 1e-6)
        near(f"rigid disc, travel {travel}", disc_stress(travel, 2.0, 140.0, modulus=1e9),
             gsell(e, 2/(5 - travel), 140.0), 1e-6)
    # a thin tube is pulled around: p a = t s 2/sqrt(3)
    e = 2/math.sqrt(3)*math.log(1.5)
    near("thin tube", tube_pressure(5.0, 1.0, 150.0, 10.0, 10.001)*15/(0.001/1.5),
         2/math.sqrt(3)*gsell(e, 2/math.sqrt(3)/15, 150.0), 1e-3)
    # the work of the pressure is that of the stress: over the volume R dR, from 0 to the travel
    def work(start):
        def rate(u):
            square = start**2 + (10 + u)**2 - 100
            dp = 2/math.sqrt(3)*(10 + u)/square
            return gsell(1/math.sqrt(3)*math.log(square/start**2), dp, 150.0)*dp
        return integral(rate, 0.0, 5.0)*start
    near("work of a tube", integral(lambda u: tube_pressure(u, 1.0, 150.0)*(10 + u), 0.0, 5.0), integral(work, 10.0, 15.0), 1e-6)
    # a slab that cools: all of it at the start; with a small Biot number one temperature; as a half space for a short time
    near("slab at the start", slab_cooled(0.3, 2.0, 0.0), 1.0, 1e-2)
    near("slab of one temperature", slab_cooled(0.5, 1e-4, 5000.0), math.exp(-0.5), 1e-4)
    near("slab as a half space", slab_cooled(1.0, 2.0, 1e-2), math.exp(0.04)*math.erfc(0.2), 1e-6)
    # tau = m s/sqrt(3) on the face: s + 2 tau (R - r)/(2 h), its mean
    radius = disc_radius(2.0)
    mean = integral(lambda r: (1 + 0.3/math.sqrt(3)*(radius - r)/3.0)*2*r, 0.0, radius)/radius**2
    near("slab", disc_friction(0.3, 2.0), mean, 1e-9)
    # J. Stefan, Sitzungsber. Akad. Wiss. Wien 69 (1874) 713-735: force of a Newtonian film, 3 pi mu R^4 V/(2 h^3)
    viscosity = gsell(1.0, 1.0, 150.0, w=1000.0, h=0.0)/3
    near("Newtonian film", squeeze_scott(1.0, 0.0, 0.3, 150.0)/(3*math.pi*viscosity*40**4*0.6/(2*2**3)), 1.0, 1e-9)
    for n in (0.1, 0.3, 1.0):
        disc = n, 0.0, 0.02, 150.0
        near(f"very thin disc, n = {n}", squeeze_bound(*disc, radius=4e4)/squeeze_scott(*disc, radius=4e4), 1.0, 1e-3)
        if squeeze_bound(*disc) < squeeze_scott(*disc):
            lines.append(f"n = {n}: stretching takes no power")
    return lines
