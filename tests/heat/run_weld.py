#!/usr/bin/env python3
"""Heat of welding torches (GOLDAK) against closed forms.

usage: run_weld.py [-v] [-k]

The source is a Gaussian in every direction, so that in a half space of constant numbers the temperature is an integral over time of
Gaussians (H.S. Carslaw, J.C. Jaeger, Conduction of Heat in Solids, sec. 10.2; for moving sources D. Rosenthal, Trans. ASME 68 (1946)
849-866): a variance of c^2/6 at the start grows by 2 alpha t. The surface is a plane of symmetry. Taken by numpy to 1e-6.

- `cross`: a torch that crosses the plane: temperatures at points near and far, in and beside the source; heat of ETA P/v times the
  thickness by steps of THETA 1 and TRBDF2, in PLSTN and PLSTS; books of heat.
- `moves`: a torch in the plane along its edge, with front and rear of their own: the integral; and Rosenthal's steady field of a line
  source at the surface, P/(pi k) exp(-v xi/(2 alpha)) K0(v r/(2 alpha)), behind the torch, within 1 %. What is left at the torch
  is of the step: .05 % of the centre at steps of .1, .03 at .05, .016 at .025.
- `ring`: all of the power of a ring, through its LIC, at the end of a bar, half of it outside; two bodies share a source as one does.
- `laws`: enthalpy with latent heat by TRBDF2, and phases of a steel: books of heat.
- `motion`: a billet pressed flat (LOG) while a ring heats it, on one mesh and on three: the heat is still the stated one.
- `under`: a plate that moves below a torch at rest is heated as one at rest below a torch that moves: by steps in which it goes
  a third of the torch's semi-axis, within 0.5 K of 100 (6.3 K where its place at the start of the step counts).
- `whole`: a torch that crosses leaves its heat whatever the step and the scheme, exact to round-off, with a multiplier too; one that begins
  or ends in the plane is told.
- `told`: the error in time that is told at the end is that against short steps.
- `off`: a torch that leaves its body with power on stops the run and says why.
"""
import csv
import json
import math
import os
import sys

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [HERE, os.path.join(os.path.dirname(HERE), "patch")]
from patch_support import NO_CONVERGENCE, Checks, Run, np  # noqa: E402
from run_coupling import BILLET, cycle, write  # noqa: E402
from run_exchange import HEAD, TIGHT  # noqa: E402

CONDUCTIVITY, CAPACITY = 30.0, 4.0e6
DIFFUSIVITY = CONDUCTIVITY/CAPACITY
LAW = f"LAW steel HEAT\n   {CONDUCTIVITY} {CAPACITY}\n"
# the torch: power, efficiency, semi-axes
POWER, ETA, FRONT, REAR, WIDTH, DEPTH = 3000.0, 0.8, 0.004, 0.008, 0.004, 0.003
AXES = f"FRONT {FRONT} REAR {REAR} DEPTH {DEPTH}"


def gauss(x, variance):
    """Normal distribution."""
    return np.exp(-x*x/(2*variance))/np.sqrt(2*np.pi*variance)


def checked_integral(function, low, high, breaks=()):
    """Integral over time by Gauss's rule on pieces, refined until it stays the same to 1e-6."""
    nodes, weights = np.polynomial.legendre.leggauss(12)
    edges = sorted({low, high, *[b for b in breaks if low < b < high]})
    previous = None
    for parts in (8, 16, 32, 64, 128, 256):
        total = 0.0
        for a, b in zip(edges[:-1], edges[1:]):
            ends = np.linspace(a, b, parts + 1)
            half = 0.5*np.diff(ends)
            times = (ends[:-1] + half)[:, None] + half[:, None]*nodes
            total += float(np.sum(function(times)*half[:, None]*weights))
        if previous is not None and abs(total - previous) <= 1e-6*abs(total):
            return total
        previous = total
    raise ArithmeticError("the integral does not converge")


def crossing(speed, at, x, depth, time):
    """Temperature in the half space under a torch that crosses: in the plane heat spreads only within it."""
    def rate(s):
        ahead = speed*(at - s)
        axis = np.where(ahead > 0, FRONT, REAR)
        length = 2*math.sqrt(3/math.pi)/(FRONT + REAR)*np.exp(-3*(ahead/axis)**2)
        grown = 2*DIFFUSIVITY*(time - s)
        return ETA*POWER*length/CAPACITY*2*gauss(x, WIDTH**2/6 + grown)*gauss(depth, DEPTH**2/6 + grown)

    return checked_integral(rate, max(0.0, at - 4*FRONT/speed), min(time, at + 4*REAR/speed), [at])


def half_gauss(x, axis, grown):
    """The half x > 0 of exp(-3 (x/axis)^2), spread by a variance: a Gaussian times the error function of the half line."""
    own = axis*axis/6
    total = own + grown
    erf = np.vectorize(math.erf)
    reach = x*np.sqrt(own/(2*total*np.maximum(grown, 1e-300)))
    return axis*math.sqrt(math.pi/3)*gauss(x, total)*0.5*(1 + erf(np.clip(reach, -6, 6)))


def moving(speed, start, x, depth, time):
    """Temperature in the half space under a torch in the plane, along the surface, of power per thickness."""
    def rate(s):
        grown = 2*DIFFUSIVITY*(time - s)
        ahead = x - (start + speed*s)
        along = (half_gauss(ahead, FRONT, grown) + half_gauss(-ahead, REAR, grown))*2/math.sqrt(math.pi/3)/(FRONT + REAR)
        return ETA*POWER/CAPACITY*along*2*gauss(depth, DEPTH**2/6 + grown)

    return checked_integral(rate, 0.0, time)


def bessel_k0(z):
    """Bessel's function K0 by its integral over cosh."""
    t = np.linspace(0, 12, 20001)
    f = np.exp(-z*np.cosh(t))
    return float(np.sum(0.5*(f[1:] + f[:-1]))*(t[1] - t[0]))


def steps(step, time):
    """Equal steps."""
    return f"STRAT {step!r} {step*1e-6!r} {step!r} 99 1\nSTOP {time!r}\n"


def books(checks, run, heat, bound, what):
    """Heat that came in is the stated one, and the books close."""
    got = run.history["heat_in"][-1] + run.history["heat_released"][-1]
    checks.small(abs(got/heat - 1), bound, f"{run.name}: {what} {heat:.6g}")
    checks.small(np.max(np.abs(run.history["heat_imbalance"])), 1e-8, f"{run.name}: books")


def cross(checks):
    """A torch through the plane; the mesh is the half of it, with half of the power."""
    speed, at, end = 0.005, 2.0, 8.0
    places = {"centre": (0.0, 0.0), "beside": (0.004, 0.0), "under": (0.0, 0.004), "far": (0.012, 0.009)}
    probes = "".join(f"PROBE {name} NODE T {x} {-d}\n" for name, (x, d) in places.items())
    exact = {name: crossing(speed, at, x, d, end) for name, (x, d) in places.items()}
    for state, thickness, cases in (
            ("PLSTN", 1.0, (("4", "1.", 0.02, 3e-3), ("9", "TRBDF2", 0.1, 1e-4))),
            ("PLSTS 0.02", 0.02, (("9 BILINEAR", "TRBDF2", 0.1, 3e-3),))):
        for rule, theta, step, bound in cases:
            name = f"cross-{state}-{rule}-{theta}".replace(" ", "").replace(".", "")
            deck = (HEAD.format(title="cross", state=state)
                    + "BLOCK plate PL8TM " + rule.split()[0] + " steel " + rule.partition(" ")[2]
                    + "\n   0. -0.012 0.02 -0.012 0.02 0. 0. 0.\n   40 1. 24 1.\n"
                    + "BLOCK rest PL8TM " + rule.split()[0] + " steel " + rule.partition(" ")[2]
                    + "\n   0.02 -0.012 0.06 -0.012 0.06 0. 0.02 0.\n   20 3. 24 1.\n"
                    + "BLOCK low PL8TM " + rule.split()[0] + " steel " + rule.partition(" ")[2]
                    + "\n   0. -0.052 0.02 -0.052 0.02 -0.012 0. -0.012\n   40 1. 20 0.333333\n"
                    + "BLOCK far PL8TM " + rule.split()[0] + " steel " + rule.partition(" ")[2]
                    + "\n   0.02 -0.052 0.06 -0.052 0.06 -0.012 0.02 -0.012\n   20 3. 20 0.333333\n"
                    + "JOIN plate 2 rest 4\nJOIN plate 1 low 3\nJOIN low 2 far 4\nJOIN rest 1 far 3\n" + LAW
                    + f"GOLDAK plate rest low P {POWER/2} ETA {ETA} {AXES} WIDTH {WIDTH} INTO 0. -1. CROSS {speed} {at}\n   0. 0. 0.\n"
                    + f"THETA {theta}\n" + steps(step, end) + TIGHT + probes + "END\n")
            run = Run(checks, name, deck)
            if not run.ok:
                continue
            books(checks, run, ETA*POWER/2/speed*thickness, 5e-5, "heat of a crossing")
            for place, value in exact.items():
                checks.small(abs(run.history[place][-1]/value - 1), bound, f"{name}: {place} {value:.3f}")


def moves(checks):
    """A torch in the plane, along the surface of a plate; its power is per thickness."""
    speed, start, end = 0.005, -0.03, 12.0
    edge = start + speed*end
    places = {"centre": (edge, 0.0), "ahead": (edge + 0.004, 0.0), "under": (edge - 0.004, 0.004), "behind": (edge - 0.03, 0.002)}
    exact = {name: moving(speed, start, x, d, end) for name, (x, d) in places.items()}
    probes = "".join(f"PROBE {name} NODE T {x!r} {-d!r}\n" for name, (x, d) in places.items())
    left, right = start - 0.03, edge + 0.03
    # behind the torch, a distance away that is long beside the ellipsoid
    back, down = 0.03, 0.002
    reach = math.hypot(back, down)
    rosenthal = (ETA*POWER/(math.pi*CONDUCTIVITY)*math.exp(speed*back/(2*DIFFUSIVITY))
                 * bessel_k0(speed*reach/(2*DIFFUSIVITY)))
    deck = (HEAD.format(title="moves", state="PLSTN")
            + f"BLOCK plate PL8TM 9 steel\n   {left!r} -0.012 {right!r} -0.012 {right!r} 0. {left!r} 0.\n   120 1. 12 1.\n"
            + f"BLOCK low PL8TM 9 steel\n   {left!r} -0.06 {right!r} -0.06 {right!r} -0.012 {left!r} -0.012\n   120 1. 10 0.2\n"
            + "JOIN plate 1 low 3\n" + LAW
            + f"GOLDAK plate P {POWER} ETA {ETA} {AXES} INTO 0. -2.\n   0. {start!r} 0.\n   {end!r} {edge!r} 0.\n"
            + "THETA TRBDF2\n" + steps(0.05, end) + TIGHT + probes + "END\n")
    run = Run(checks, "moves", deck)
    if not run.ok:
        return
    books(checks, run, ETA*POWER*end, 1e-12, "heat of a torch")
    for place, value in exact.items():
        checks.small(abs(run.history[place][-1]/value - 1), 2e-3, f"moves: {place} {value:.4f}")
    checks.small(abs(run.history["behind"][-1]/rosenthal - 1), 1e-2, f"moves: Rosenthal behind the torch {rosenthal:.3f}")


def ring(checks):
    """A ring at the end of a bar, half of it outside; power by a LIC; one body or two that share the source."""
    found = {}
    for name, blocks, bodies in (
            ("one", "BLOCK bar PL8TM 4 steel\n   0. 0. 0.01 0. 0.01 0.05 0. 0.05\n   8 1. 40 1.\n", "bar"),
            ("two", "BLOCK bar PL8TM 4 steel\n   0. 0. 0.01 0. 0.01 0.04 0. 0.04\n   8 1. 32 1.\n"
                    "BLOCK top PL8TM 4 steel\n   0. 0.04 0.01 0.04 0.01 0.05 0. 0.05\n   8 1. 8 1.\nJOIN bar 3 top 1\n", "bar top")):
        run = Run(checks, f"ring-{name}", HEAD.format(title="ring", state="AXISYM") + blocks + LAW
                  + f"GOLDAK {bodies} P {POWER} pulse ETA {ETA} {AXES} INTO -1. 0.\n   0. 0.01 0.03\n   1. 0.01 0.05\n"
                  "LIC pulse\n   0. 0. 0.5 1. 1. 0.5 1.5 0.\nTHETA 0.5\n" + steps(0.05, 2.0) + TIGHT
                  + "PROBE a NODE T 0.01 0.05\nPROBE b NODE T 0. 0.025\nEND\n")
        if run.ok:
            books(checks, run, ETA*POWER*0.75, 1e-12, "heat of a ring, all of it though half is outside")
            found[name] = [run.history["a"][-1], run.history["b"][-1]]
    if len(found) == 2:
        checks.small(max(abs(a/b - 1) for a, b in zip(found["one"], found["two"])), 1e-11, "ring: one body or two")


def laws(checks):
    """A torch on a material that melts, and on a steel whose phases change: the source knows neither, the books close."""
    melting = (f"LAW steel HEATH\n   TEMP 0.\n   {CONDUCTIVITY} 0.\n   TEMP 60.\n   {CONDUCTIVITY} {60*CAPACITY}\n   TEMP 80.\n"
               f"   {CONDUCTIVITY} {80*CAPACITY + 5e8}\n   TEMP 2000.\n   {CONDUCTIVITY} {2000*CAPACITY + 5e8}\n")
    steel = os.path.join(os.path.dirname(os.path.dirname(HERE)), "decks", "steels", "16mnd5.met")
    phases = f"LAW steel META\n   STEEL '{steel}' '16MND5'\n   ENERGY 1.E6\nSTART T 700.\n"
    for name, law, theta in (("melting", melting, "TRBDF2"), ("phases", phases, "1.")):
        run = Run(checks, name, HEAD.format(title=name, state="PLSTN")
                  + "BLOCK bar PL8TM 9 steel BILINEAR\n   0. -0.02 0.04 -0.02 0.04 0. 0. 0.\n   40 1. 20 1.\n" + law
                  + f"GOLDAK bar P 4.E4 pulse ETA 0.9 {AXES} INTO 0. -1.\n   0. 0.01 0.\n   4. 0.03 0.\nLIC pulse\n   0. 1. 3.9 1. 4. 0.\n"
                  f"THETA {theta}\n" + "CONVE bar 1 2 4 H 2000. TS 20.\n" + steps(0.05, 6.0) + TIGHT + "PROBE a NODE T 0.02 0.\nEND\n")
        if run.ok:
            checks.small(np.max(np.abs(run.history["heat_imbalance"])), 1e-8, f"{name}: books")
            checks.that(np.max(run.history["a"]) > run.history["a"][0] + 20, f"{name}: heated", f"{np.max(run.history['a']):.1f}")


def motion(checks):
    """A billet that is pressed while a ring heats it."""
    remeshed = BILLET.replace("IMPOS  billet 3 T cold\n", "").replace(
        "LIC    cold\n   0. 1000.  1. 500.\n", "").replace("PROBE  core", "GOLDAK billet P 500. ETA 0.7 FRONT 2. REAR 3. DEPTH 2.\n"
                                                           "PROBE  core")
    remeshed = remeshed.replace("DEPTH 2.\n", "DEPTH 2. INTO -1. 0.\n   0. 10. 4.\n   0.7 11. 6.\n")
    run = Run(checks, "motion", remeshed.replace("REMSH\n   TIMES 0.3 0.6\n", ""))
    if run.ok:
        got = run.history["heat_in"][-1]
        checks.small(abs(got/(0.7*500*run.history["time"][-1]) - 1), 1e-10, f"motion: heat {got:.4f}")
        checks.small(np.max(np.abs(run.history["heat_imbalance"])), 1e-8, "motion: books")
    # with a formula of the place at the start, from mesh to mesh
    out = os.path.join(checks.folder, "cycled")
    result = cycle(write(os.path.join(checks.folder, "cycled.lag"), remeshed.replace("START  T 1000.", "START  T 1000+2*x-y")), out)
    if checks.that(result.returncode == 0, "motion: lagacycle", result.stderr):
        with open(os.path.join(out, "history.csv"), newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        got = float(rows[-1]["heat_in [energy]"])
        checks.small(abs(got/(0.7*500*0.7) - 1), 1e-10, f"motion: heat over three meshes {got:.4f}")


def under(checks):
    """A plate below a torch: one of both moves."""
    found = {}
    for name, plate, torch in (("plate-moves", 5.0, 0.0), ("torch-moves", 1e-4, -5.0)):
        deck = (HEAD.format(title="under", state="PLSTN").replace("SMALL", "LOG")
                + "BLOCK plate PL8LS 9 rigid\n   0. 0. 40. 0. 40. 10. 0. 10.\n   80 1. 12 1.\nLAW rigid ELA\n   200000. 0.3\n"
                + "ADDEL plate PL8TM heat\nLAW heat HEAT\n   30. 4.\nSTART T 20.\n"
                + f"MOVE plate 1 2 3 4 X go {plate}\nFIXED plate 1 2 3 4 Y\nLIC go\n   0. 0. 4. 4.\n"
                + "GOLDAK plate P 1.E4 ETA 0.8 FRONT 3. REAR 3. DEPTH 3. INTO 0. -1.\n"
                + f"   0. 30. 10.\n   4. {30 + 4*torch} 10.\nTHETA TRBDF2\n" + steps(0.2, 4.0)
                + "PROBE a NODE T 30. 10.\nPROBE b NODE T 20. 10.\nPROBE c NODE T 12. 10.\nPROBE d NODE T 20. 6.\nEND\n")
        run = Run(checks, name, deck)
        if run.ok:
            books(checks, run, 0.8*1e4*4, 1e-10, "heat of a torch and a plate, one of which moves")
            found[name] = [run.history[place][-1] for place in "abcd"]
    if checks.that(len(found) == 2, "under: both runs"):
        off_by = np.max(np.abs(np.subtract(*found.values())))
        checks.small(off_by, 0.5, f"under: {found}")


def off(checks):
    """A torch that goes past the end of its body."""
    deck = (HEAD.format(title="off", state="PLSTN") + "BLOCK bar PL8TM 4 steel\n   0. -0.01 0.02 -0.01 0.02 0. 0. 0.\n   10 1. 5 1.\n"
            + LAW + f"GOLDAK bar P 10. ETA 1. {AXES} INTO 0. -1.\n   0. 0.01 0.\n   1. 0.06 0.\n" + steps(0.05, 1.0) + "END\n")
    run = Run(checks, "off", deck, NO_CONVERGENCE)
    if run.ok:
        with open(os.path.join(run.out, "summary.json"), encoding="utf-8") as file:
            reason = json.load(file)["stop_reason"]
        checks.that("the torch of GOLDAK is off its bodies" in reason, "off: says why", reason)
        with open(os.path.join(run.out, "off.log"), encoding="utf-8") as file:
            listing = file.read()
        checks.that("% of half its ellipse is found in its bodies" in listing, "off: warned before")


def on_the_axis(checks):
    """A spot on the axis of a round plate is all within it, one half a semi-axis inside its rim is not."""
    found = {}
    for place in (0.0, 0.018):
        name = f"spot-{place:g}".replace(".", "")
        run = Run(checks, name, HEAD.format(title="spot", state="AXISYM")
                  + "BLOCK plate PL8TM 4 steel\n   0. -0.01 0.02 -0.01 0.02 0. 0. 0.\n   20 1. 10 1.\n" + LAW
                  + f"GOLDAK plate P 10. ETA 1. FRONT 0.004 REAR 0.004 DEPTH 0.003 INTO 0. -1.\n   0. {place} 0.\n"
                  + steps(0.05, 0.1) + "END\n")
        if run.ok:
            books(checks, run, 10.0*0.1, 1e-10, "heat of a spot")
            with open(os.path.join(run.out, name + ".log"), encoding="utf-8") as file:
                found[place] = "% of half its ellipse" in file.read()
    checks.that(found == {0.0: False, 0.018: True}, "spot: warned of beside the rim alone", found)


def long_steps(checks):
    """Steps end where a torch begins to be felt, crosses, and is gone: what is warned of is how far it goes in such a step; with
    a tolerance of their errors they are as short as it asks."""
    front, speed, at = 0.004, 0.005, 2.0
    for step, times, scheme in ((0.8, None, ""), (1.0, 1.25, ""), (8.0, 1.5, ""), (8.0, None, "THETA  TRBDF2 TOL 5.\n")):
        name = f"long-{step:g}{'-tol' if scheme else ''}"
        run = Run(checks, name, HEAD.format(title="long", state="PLSTN")
                  + "BLOCK bar PL8TM 4 steel\n   0. -0.02 0.02 -0.02 0.02 0. 0. 0.\n   10 1. 10 1.\n" + LAW
                  + f"GOLDAK bar P {POWER} ETA {ETA} {AXES} WIDTH {WIDTH} INTO 0. -1. CROSS {speed} {at}\n   0. 0. 0.\n"
                  + scheme + steps(step, 8.0) + "END\n")
        if not run.ok:
            continue
        with open(os.path.join(run.out, f"{name}.log"), encoding="utf-8") as file:
            said = [line for line in file if "its shorter semi-axis" in line]
        checks.that(bool(said) == (times is not None), f"{name}: warned or not", said)
        if times is None:
            continue
        checks.that(f"it goes {times:g} times its shorter semi-axis" in said[0], f"{name}: {times:g} times", said)
        if step < 8:
            continue
        time = run.history["time"]
        before = np.diff(time)[(time[1:] <= at*(1 + 1e-9)) & (time[:-1] >= at - 1.5*front/speed - 1e-9)]
        checks.small(abs(before.max()*speed/front/times - 1), 1e-9, f"{name}: the longest step as it comes near")


def whole(checks):
    """A crossing within a few steps, or one: the heat is the integral of power over time."""
    speed, end = 0.005, 12.0

    def run(name, step, theta, at, lic, width=0.03):
        return Run(checks, name, HEAD.format(title="whole", state="PLSTN")
                   + f"BLOCK bar PL8TM 4 steel BILINEAR\n   0. -0.02 {width} -0.02 {width} 0. 0. 0.\n   12 1. 8 1.\n" + LAW
                   + f"GOLDAK bar P {POWER/2} {'on' if lic else ''} ETA {ETA} {AXES} WIDTH {WIDTH} INTO 0. -1. CROSS {speed} {at}\n   0. 0. 0.\n"
                   + ("LIC on\n   0. 0. 4. 1. 12. 0.\n" if lic else "") + f"THETA {theta}\n" + steps(step, end) + "END\n")

    times = np.linspace(0, end, 1200001)
    axis = np.where(times < 3, FRONT, REAR)
    rate = ETA*POWER/2*2*math.sqrt(3/math.pi)/(FRONT + REAR)*np.exp(-3*(speed*(3 - times)/axis)**2)
    for lic in (False, True):
        values = rate*(np.interp(times, [0, 4, 12], [0, 1, 0]) if lic else 1)
        heat = float(np.sum(0.5*(values[1:] + values[:-1])*np.diff(times)))
        for theta in ("1.", "0.5 MEAN", "TRBDF2"):
            for step in (0.3, 2.0, 8.0):
                one = run(f"whole-{theta}-{step}-{lic:d}".replace(" ", "").replace(".", ""), step, theta, 3.0, lic)
                if one.ok:
                    books(checks, one, heat, 1e-9, "heat of a crossing within few steps")
    for name, at, share in (("begins", 0.2, "82 %"), ("ends", 12.0, "33.3 %"), ("inside", 3.0, None)):
        one = run(f"whole-{name}", 0.1, "1.", at, False)
        if not one.ok:
            continue
        with open(os.path.join(one.out, f"whole-{name}.log"), encoding="utf-8") as file:
            said = [line for line in file if "of its heat in the plane" in line]
        checks.that(bool(said) == (share is not None) and all(share in line for line in said), f"whole: a torch that {name}: told or not", said)


def told(checks):
    """The error of heat in time that is told at the end is that against short steps: no heat of the torch is missing."""
    def run(theta, step, path):
        return Run(checks, f"told-{theta}-{step}-{len(path)}".replace(".", ""), HEAD.format(title="told", state="PLSTN")
                   + "BLOCK bar PL8TM 4 steel BILINEAR\n   0. -0.02 0.03 -0.02 0.03 0. 0. 0.\n   12 1. 8 1.\n" + LAW
                   + f"GOLDAK bar P {POWER/2} ETA {ETA} {AXES} {path}" + f"THETA {theta}\n" + steps(step, 8.0) + "END\n")

    def temperatures(one):
        with one.open() as file:
            last = sorted(file["steps"])[-1]
            return file[f"steps/{last}/node/temperature"][()].ravel()[file["mesh/topology"][:, :4]]

    for name, path in (("crosses", f"WIDTH {WIDTH} INTO 0. -1. CROSS 0.005 3.\n   0. 0. 0.\n"),
                       ("moves", "INTO 0. -1. \n   0. 0.004 0.\n   8. 0.026 0.\n")):
        exact = run("TRBDF2", 0.01, path)
        for theta, step in (("TRBDF2", 0.4), ("TRBDF2", 0.2), ("1.", 0.2)):
            one = run(theta, step, path)
            if not (one.ok and exact.ok):
                continue
            with open(os.path.join(one.out, "summary.json"), encoding="utf-8") as file:
                end = json.load(file)["accuracy"]["heat"]["end"]
            true = math.sqrt(np.mean((temperatures(one) - temperatures(exact))**2))
            checks.that(0.4 < end/true < 2.5, f"told: a torch that {name}, {theta}, {step} s: error of heat at the end", (end, true, end/true))


def main():
    """All of them."""
    checks = Checks()
    cross(checks)
    moves(checks)
    ring(checks)
    laws(checks)
    motion(checks)
    under(checks)
    off(checks)
    on_the_axis(checks)
    long_steps(checks)
    whole(checks)
    told(checks)
    checks.end()


if __name__ == "__main__":
    main()
