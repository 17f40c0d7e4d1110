#!/usr/bin/env python3
"""Conduction of heat and thermal stress against closed forms.

usage: run_heat.py [-v] [-k]

- `wall`: steady, linear across; `cylinder`: steady, T = Ta + (Tb - Ta) ln(r/a)/ln(b/a), by order of convergence.
- `slab` (H.S. Carslaw, J.C. Jaeger, Conduction of Heat in Solids, 2nd ed., section 3.4): one face at 1 from t = 0 on, the other
  insulated, T = 1 - sum 4/(m pi) sin(m pi x/2) a(t), m = 1, 3, 5 ..., a = exp(-k t) with k = (m pi/2)^2 LAMBDA/RHOC. Implicit Euler
  by equal steps has a = (1 + k dt)^-n instead, so that the order in space is seen without an error in time, and the order in time
  against the series itself.
- `cooled`: a bar held at its ends: stress -E ALPHA dT where it is free across, -E ALPHA dT/(1 - NU) where one direction more is held;
  with KINEM LOG the stress is this over the elastic change of volume.
- `starts`: bodies apart that start with temperatures of their own keep them; the rest has that of all.
- `cold`: a flux that takes more heat than there is ends the run at absolute zero.
- `squeezed`: change of volume without conduction across: dT = -SOURCE e/RHOC.
"""
import os
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "patch"))
from patch_support import DONE, NO_CONVERGENCE, Checks, Run, at_points, np, num  # noqa: E402

NORMS = "NORMS FORCE 1.E-12 DISPL 1.E-12\n"
SECTION = "SECTN E FREE\nSECTN KX HELD\nSECTN KY HELD\n"


def temperatures(run):
    """Places of the nodes and their temperatures at the end."""
    with run.open() as file:
        last = sorted(file["steps"])[-1]
        return file["mesh/coordinates"][()][:, :2], file[f"steps/{last}/node/temperature"][()].reshape(-1)


def mean_error(run, exact):
    """Square root of the mean of (T - exact(x, y))^2 over the area, by 4 x 4 points an element."""
    x, found = temperatures(run)
    with run.open() as file:
        elements = file["mesh/topology"][()]
    places, values, _, areas = at_points(x[elements], np.stack([found[elements]]*2, axis=-1), 4)
    return np.sqrt(np.sum(areas*(values[..., 0] - exact(places[..., 0], places[..., 1]))**2)/np.sum(areas))


def orders(checks, errors, least, what):
    """Errors of meshes or steps, each half of the one before: the last observed order."""
    found = np.log2(np.array(errors[:-1])/np.array(errors[1:]))
    checks.that(least - 0.15 <= found[-1] <= least + 0.6, f"{what}: order {least}", f"{found.round(2)}, errors {errors}")


def steady(checks):
    """Linear across a wall, to round-off; of any plane state, rule and option."""
    for state in ("PLSTN", "PLSTN 3.", "PLSTS 2.", "AXISYM", "GPLSTN"):
        for rule in ("4", "9", "4 BILINEAR", "9 BILINEAR"):
            npoint, _, option = rule.partition(" ")
            run = Run(checks, f"wall-{state}-{rule}".replace(" ", ""),
                      f"TITLE wall\nSTATE {state}\n{SECTION if 'GP' in state else ''}KINEM SMALL\nBLOCK wall PL8TM {npoint} brick {option}\n"
                      "   0. 0.   1. 0.   1. 2.   0. 2.\n   3 1.   5 2.\nLAW brick HEAT\n   2. 1.E-3\nIMPOS wall 1 T hot 100.\n"
                      "IMPOS wall 3 T hot 20.\nSTART T 50.\nLIC hot\n   0. 1.\nSTRAT 1.E12 1. 1.E12 4 3\nSTOP 1.E12\n" + NORMS + "END\n")
            if run.ok:
                x, found = temperatures(run)
                checks.small(np.max(np.abs(found - (100 - 40*x[:, 1]))), 1e-10*100, f"{run.name}: linear")


def cylinder(checks):
    """A wall between two radii, in an axisymmetric scene and as a quarter of a ring."""
    a, b = 1.0, 4.0
    ring = (f"BLOCK p PL8TM 9 m OPTION\n   {num(a, 0, b, 0, 0, b, 0, a)}\n   NX 2. NY 1.\n   SIDE 2 ARC 0. 0.\n   SIDE 4 ARC 0. 0.\n")
    tube = f"BLOCK p PL8TM 9 m OPTION\n   {num(a, 0, b, 0, b, 1, a, 1)}\n   NX 2. 1 1.\n"
    exact = {"PLSTN": lambda x, y: 300 - 200*np.log(np.hypot(x, y)/a)/np.log(b/a),
             "AXISYM": lambda x, _: 300 - 200*np.log(x/a)/np.log(b/a)}
    for state, body in (("PLSTN", ring), ("AXISYM", tube)):
        for option, order in (("", 3), ("BILINEAR", 2)):
            errors = []
            for n in (4, 8, 16):
                run = Run(checks, f"cylinder-{state}-{n}{option}",
                          f"TITLE cylinder\nSTATE {state}\nKINEM SMALL\n"
                          + body.replace("OPTION", option).replace("NX 2.", f"{n} {2**(1 - 1/n)}").replace("NY", f"{n}")
                          + "LAW m HEAT\n   2. 1.E-3\nIMPOS p 4 T on 300.\nIMPOS p 2 T on 100.\nSTART T 100.\nLIC on\n   0. 1.\n"
                          "STRAT 1.E12 1. 1.E12 4 3\nSTOP 1.E12\n" + NORMS + "END\n")
                if run.ok:
                    errors.append(mean_error(run, exact[state]))
            if len(errors) == 3:
                orders(checks, errors, order, f"cylinder {state} {option}")
                checks.small(errors[-1], 0.15 if option else 0.01, f"cylinder {state} {option}: error of 16 elements")


LAMBDA, RHOC, TIME = 2.0, 4.0, 0.5   # steps are TIME over powers of 2: no rounding


def series(amplitude):
    """Temperature of the slab, from the amplitude of a mode by its rate k."""
    m = np.arange(1, 400, 2)

    def exact(x, _):
        modes = np.sin(0.5*np.pi*np.multiply.outer(x, m))*(4/(np.pi*m)*amplitude((0.5*np.pi*m)**2*LAMBDA/RHOC))
        return 1 - modes.sum(axis=-1)
    return exact


def slab(n, step, option, time=TIME):
    """A slab of n x 1 elements by equal steps."""
    return (f"TITLE slab\nSTATE PLSTN\nKINEM SMALL\nBLOCK p PL8TM 9 m {option}\n   0. 0. 1. 0. 1. {num(1/n)} 0. {num(1/n)}\n   {n} 1. 1 1.\n"
            f"LAW m HEAT\n   {num(LAMBDA, RHOC)}\nIMPOS p 4 T on\nSTART T 0.\nLIC on\n   0. 1.\nSTRAT {num(step, step/2, step)} 4 3\n"
            f"STOP {num(time)}\n{NORMS}END\n")


def transient(checks):
    """A face that is suddenly hot: first order in time; third order in space, second with BILINEAR."""
    errors = []
    for steps in (8, 16, 32, 64):
        run = Run(checks, f"slab-steps-{steps}", slab(16, TIME/steps, ""))
        if run.ok:
            checks.that(run.history["step"][-1] == steps, f"{run.name}: equal steps", run.history["step"][-1])
            errors.append(mean_error(run, series(lambda k: np.exp(-k*TIME))))
    if len(errors) == 4:
        orders(checks, errors, 1, "slab: in time")
        checks.small(errors[-1], 3e-3, "slab: error of 64 steps")
    for option, order in (("", 3), ("BILINEAR", 2)):
        errors = []
        for n in (4, 8, 16):
            run = Run(checks, f"slab-{n}{option}", slab(n, TIME/16, option))
            if run.ok:
                errors.append(mean_error(run, series(lambda k: (1 + k*TIME/16)**-16.0)))
        if len(errors) == 3:
            orders(checks, errors, order, f"slab {option}: in space")
    # a shock of one short step: corners with lumped capacity stay between what was there and what is imposed
    run = Run(checks, "shock", slab(8, 1e-4, "BILINEAR", time=1e-4))
    if run.ok:
        found = temperatures(run)[1]
        checks.that(found.min() >= 0 and found.max() <= 1, "BILINEAR: no undershoot", f"{found.min()} to {found.max()}")


YOUNG, NU, ALPHA, FALL = 200000.0, 0.3, 1.2e-5, -400.0


def cooled(checks):
    """A bar held at its ends cools; the temperature is that of the run."""
    free = -YOUNG*ALPHA*FALL
    cases = {"PLSTS 2.": ("X", free, 2), "PLSTN": ("X", free/(1 - NU), 1), "AXISYM": ("Y", free, 2), "GPLSTN": ("X", free, 2)}
    for state, (way, exact, nfree) in cases.items():
        held = "FIXED p 4 X\nFIXED p 2 X\nFIXED p 1 Y\n" if way == "X" else "FIXED p 1 Y\nFIXED p 3 Y\nFIXED p 4 X\n"
        # strain of the directions without stress
        across = ALPHA*FALL - NU*exact*(3 - nfree)/YOUNG
        for kinem, factor in (("SMALL", 1.0), ("LOG", np.exp(3*ALPHA*FALL - nfree*across))):
            for option in ("", "BILINEAR"):
                run = Run(checks, f"cooled-{state[:6].strip()}-{kinem}{option}",
                          f"TITLE bar\nSTATE {state}\n{SECTION if 'GP' in state else ''}KINEM {kinem}\nBLOCK p PL8LS 9 steel\n"
                          f"   0. 0. 3. 0. 3. 1. 0. 1.\n   3 1. 2 1.\nLAW steel ELATH\n   {num(YOUNG, NU, ALPHA)}\nADDEL p PL8TM heat {option}\n"
                          f"LAW heat HEAT\n   1. 1.E-9\n{held}IMPOS p 1 T fall\nSTART T 600.\nLIC fall\n   0. 600.   1. {num(600 + FALL)}\n"
                          f"STRAT 0.25 0.1 0.25 4 3\nSTOP 1.\n{NORMS}SAVE 100\nEND\n")
                if not run.ok:
                    continue
                stress = run.state("p", f"stress_{way.lower()*2}")
                checks.small(np.max(np.abs(stress/(exact*factor) - 1)), 1e-7, f"{run.name}: stress {exact*factor:.4g}")


def starts(checks):
    """Three bodies apart, without any exchange."""
    for option in ("", "BILINEAR"):
        blocks = "".join(f"BLOCK {name} PL8TM 9 m {option}\n   {num(x, 0, x + 1, 0, x + 1, 1, x, 1)}\n   2 1. 2 1.\n"
                         for name, x in (("hot", 0), ("warm", 2), ("cold", 4)))
        run = Run(checks, f"starts{option}", f"TITLE starts\nSTATE PLSTN\nKINEM SMALL\n{blocks}LAW m HEAT\n   2. 4.\nSTART T 900. hot\n"
                  f"START T 300.\nSTART T 20. cold\nSTRAT 0.25 0.1 0.25 4 3\nSTOP 1.\n{NORMS}END\n")
        if run.ok:
            x, found = temperatures(run)
            exact = np.where(x[:, 0] < 1.5, 900.0, np.where(x[:, 0] < 3.5, 300.0, 20.0))
            checks.small(np.max(np.abs(found - exact)), 1e-9, f"{run.name}: 900, 300 and 20")


def squeezed(checks):
    """A block held all round but for one side that moves in: it warms by what the change of volume gives off."""
    source, rhoc = 2.5e3, 3.6
    for state in ("PLSTN", "AXISYM"):
        way, sides = ("X", "FIXED p 4 X\nFIXED p 1 3 Y\n") if state == "PLSTN" else ("Y", "FIXED p 2 4 X\nFIXED p 1 Y\n")
        for kinem in ("SMALL", "LOG"):
            strain = np.log(0.91) if kinem == "LOG" else -0.09
            for solve in ("MONOLITHIC", "CONVERGE"):
                run = Run(checks, f"squeezed-{state}-{kinem}-{solve}",
                          f"TITLE squeezed\nSTATE {state}\nKINEM {kinem}\nBLOCK p PL8LS 9 steel\n   0. 0. 2. 0. 2. 2. 0. 2.\n   2 1. 2 1.\n"
                          f"LAW steel ELA\n   200000. 0.3\nADDEL p PL8TM heat\nLAW heat HEAT\n   50. {rhoc}\n   SOURCE {source}\n{sides}"
                          f"MOVE p {2 if way == 'X' else 3} {way} in\nSTART T 300.\nLIC in\n   0. 0. 1. -0.18\nSTRAT 0.2 0.1 0.2 4 3\nSTOP 1.\n"
                          f"SOLVE {solve}\n{NORMS}END\n")
                if run.ok:
                    found = temperatures(run)[1] - 300
                    checks.small(np.max(np.abs(found/(-source*strain/rhoc) - 1)), 1e-8, f"{run.name}: rise {-source*strain/rhoc:.4g}")


def cold(checks):
    """A flux that takes more heat than there is ends the run below absolute zero; where none is known, the end warns."""
    for name, radiation, code in (("kelvin", "RADIA  b 4 EPS 0.5 SIGMA 5.67E-11 ZERO 0. TS 200.\n", NO_CONVERGENCE), ("any", "", DONE)):
        run = Run(checks, f"cold-{name}", "TITLE cold\nSTATE PLSTN\nKINEM SMALL\nBLOCK b PL8TM 4 m BILINEAR\n"
                  "   0. 0.   10. 0.   10. 2.   0. 2.\n   5 1.   1 1.\nLAW m HEAT\n   40. 4.\nSTART T 200.\nFLUX b 2 Q -300.\n"
                  + radiation + "STRAT 1. 0.1 1. 4 3\nPROBE coldest MIN T b\nSTOP 100.\nEND\n", code)
        if not run.ok:
            continue
        with open(os.path.join(run.out, f"cold-{name}.log"), encoding="utf-8") as file:
            listing = file.read()
        checks.that("below absolute zero" in listing, f"cold, {name}: says why")
        coldest = run.history["coldest"]
        if code == DONE:
            checks.that("below absolute zero of any scale" in listing and coldest[-1] < -460, f"cold, {name}: a warning", coldest[-1])
        else:
            checks.that(coldest[-1] >= -1 > 2*coldest[-1] - coldest[-2], f"cold, {name}: as it gets there", coldest[-2:])


def main():
    checks = Checks()
    steady(checks)
    cylinder(checks)
    transient(checks)
    cooled(checks)
    starts(checks)
    squeezed(checks)
    cold(checks)
    checks.end()


if __name__ == "__main__":
    main()
