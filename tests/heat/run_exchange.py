#!/usr/bin/env python3
"""Heat that passes sides, and numbers by temperature, against closed forms.

usage: run_exchange.py [-v] [-k]

- `t2` (NAFEMS, The Standard NAFEMS Benchmarks, T2): a wall of 1000 K on one side that radiates to 300 K on the other, 927.0 K there:
  the root of LAMBDA (1000 - T)/L = EPS SIGMA (T^4 - 300^4).
- `t3` (NAFEMS T3): a side that follows 100 sin(pi t/40): 36.603 after 32 s, by the series of H.S. Carslaw, J.C. Jaeger.
- `annulus` (NAFEMS, heat flow into a part of the bore): 332.97 K.
- `fins`: convection with coefficients by temperature, at both ends of a wall, to surroundings that change in time; steady at the end:
  flows agree, q = h(T1) (Ts - T1) = LAMBDA (T1 - T2)/L = h(T2) (T2 - Tr), by bisection.
- `flows`: heat through every boundary is what the books have, by all schemes.
- `cylinder`: cooled by convection, Biot numbers 1 and 20: the series of Bessel's functions, and the order in time.
- `wall_by_temperature`: LAMBDA linear in T: Kirchhoff's transform, T from a (T - T1) + b (T^2 - T1^2)/2 linear in place.
- `source`: heat from the volume, a parabola; a body that only warms up.
- `fin`: a sheet that loses heat through its faces (H.S. Carslaw, J.C. Jaeger, sec. 4.2): temperature and heat by cosh(m L), m = sqrt(2 h/(LAMBDA
  thickness)), and the order in space; two cards of one face each are one of both.
- `drawn`: a sheet drawn to 1.5 times its length, heated after that: heat of the volume is that of its thickness then, heat through its faces
  that of their area.
- `stated`: FLUX, HEATS and the power of GOLDAK by a LIC that rises and falls: all of it comes in, by all schemes.
- `stefan`: freezing of a half space (F. Neumann): LAMBDA jumps and RHOC holds the latent heat: within 1 %.
- `squeezed`: a block of perfect plasticity pressed to a plastic strain of 1 without loss of heat: QUINNEY sigma p/(rho c), in all ways of
  coupling.
- `pressed_hot`: the same of a cylinder that has expanded before it is pressed: heat over plastic work is QUINNEY, exactly where heat comes a step
  later (1e-9), else but for the elastic strain of the steps in which it flows first (3e-4); it keeps its plastic work when it cools (1e-12).
"""
import math
import os
import sys

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [HERE, os.path.join(os.path.dirname(HERE), "patch"), os.path.join(os.path.dirname(HERE), "runs")]
from patch_support import Checks, Run, np  # noqa: E402
from run_heat import NORMS, mean_error, orders, temperatures  # noqa: E402
from support import write  # noqa: E402

HEAD = "TITLE {title}\nSTATE {state}\nKINEM SMALL\n"
STEADY = "STRAT 1.E14 1. 1.E14 9 3\nSTOP 1.E14\n"
TIGHT = "NORMS FORCE 1.E-11 DISPL 1.E-11\n"


def root(function, low, high):
    """Root of a function by bisection."""
    rising = function(high) > 0
    for _ in range(200):
        middle = 0.5*(low + high)
        if (function(middle) > 0) == rising:
            high = middle
        else:
            low = middle
    return 0.5*(low + high)


def wall(rule="4", divisions=5):
    """A block of 0.1 by 0.01."""
    return f"BLOCK wall PL8TM {rule.split()[0]} steel {rule.partition(' ')[2]}\n   0. 0. 0.1 0. 0.1 0.01 0. 0.01\n   {divisions} 1. 1 1.\n"


def radiation(checks):
    """T2, in kelvin and in degrees Celsius."""
    exact = root(lambda t: 0.98*5.67e-8*(t**4 - 300.0**4) - 55.6*(1000 - t)/0.1, 300.0, 1000.0)
    checks.small(abs(exact - 927.01), 0.01, "t2: the equation gives the published value")
    for rule in ("4", "9", "4 BILINEAR"):
        for zero in (0.0, 273.15):
            run = Run(checks, f"t2-{rule}-{zero}".replace(" ", ""), HEAD.format(title="t2", state="PLSTN") + wall(rule)
                      + "LAW steel HEAT\n   55.6 3.6E6\n"
                      f"START T {1000 - zero}\nIMPOS wall 4 T on {1000 - zero}\n"
                      f"RADIA wall 2 EPS 0.98 SIGMA 5.67E-8 ZERO {zero} TS {300 - zero}\nLIC on\n   0. 1.\n" + STEADY + TIGHT
                      + "PROBE tb NODE T 0.1 0.\nEND\n")
            if run.ok:
                checks.small(abs(run.history["tb"][-1] + zero - exact), 1e-8*exact, f"{run.name}: {exact:.4f} K")


def wave(checks):
    """T3."""
    rows = "".join(f"   {0.1*k:.4f} {math.sin(math.pi*0.1*k/40):.15f}\n" for k in range(321))
    run = Run(checks, "t3", HEAD.format(title="t3", state="PLSTN") + wall("4", 10) + "LAW steel HEAT\n   35. 7200*440.5\n"
              "IMPOS wall 4 T cold\nIMPOS wall 2 T wave 100.\nLIC cold\n   0. 0.\nLIC wave\n" + rows
              + "STRAT 0.05 0.01 0.05 9 3\nSTOP 32.\n" + NORMS + "PROBE p NODE T 0.08 0.\nPROBE q NODE T 0.06 0.\nEND\n")
    if run.ok:
        checks.small(abs(run.history["p"][-1]/36.60312 - 1), 2e-3, "t3: 36.603 at 0.08")
        checks.small(abs(run.history["q"][-1]/8.66777 - 1), 1e-2, "t3: 8.668 at 0.06")


def annulus(checks):
    """Heat flow into a part of a bore."""
    blocks = ""
    for name, low, high, n in (("low", 0.0, 0.04, 8), ("mid", 0.04, 0.10, 12), ("top", 0.10, 0.14, 8)):
        blocks += f"BLOCK {name} PL8TM 4 steel\n   0.02 {low} 0.10 {low} 0.10 {high} 0.02 {high}\n   16 1. {n} 1.\n"
    run = Run(checks, "annulus", HEAD.format(title="annulus", state="AXISYM") + blocks + "JOIN low 3 mid 1\nJOIN mid 3 top 1\n"
              "LAW steel HEAT\n   52. 3.6E6\nSTART T 273.15\nFLUX mid 4 Q 5.E5\nIMPOS low 1 2 T on 273.15\nIMPOS mid 2 T on 273.15\n"
              "IMPOS top 2 3 T on 273.15\nLIC on\n   0. 1.\n" + STEADY + TIGHT + "PROBE p NODE T 0.04 0.04\nEND\n")
    if run.ok:
        checks.small(abs(run.history["p"][-1] - 332.97), 0.005, "annulus: 332.97 K")


def convection(checks):
    """Both ends of a wall in a medium."""
    length, conductivity = 0.1, 20.0

    def h(t):
        return float(np.interp(t, [0, 200, 400, 900], [50, 120, 300, 310]))

    def residual(t1):
        q = h(t1)*(900 - t1)
        t2 = t1 - q*length/conductivity
        return q - 2*h(t2)*(t2 - 40)

    t1 = root(residual, 100.0, 900.0)
    t2 = t1 - h(t1)*(900 - t1)*length/conductivity
    table = "   0. 50. 200. 120.\n   400. 300. 900. 310.\n"
    for rule in ("4", "9", "4 BILINEAR"):
        run = Run(checks, f"fins-{rule}".replace(" ", ""), HEAD.format(title="fins", state="PLSTS 0.5") + wall(rule)
                  + f"LAW steel HEAT\n   {conductivity} 3.6E6\nSTART T 300.\n"
                  f"CONVE wall 4 H 1. TS 900. up\n{table}CONVE wall 2 TS 20. H 2. up\n{table}LIC up\n   0. 0. 1. 1.\n".replace(
                      "TS 20. H 2. up", "TS 40. H 2.") + STEADY + TIGHT + "PROBE a NODE T 0. 0.\nPROBE b NODE T 0.1 0.\nEND\n")
        if run.ok:
            found = np.array([run.history["a"][-1], run.history["b"][-1]])
            checks.small(np.max(np.abs(found/np.array([t1, t2]) - 1)), 1e-9, f"{run.name}: {t1:.3f} and {t2:.3f}")
            # 0.01 high, 0.5 thick
            power = h(t1)*(900 - t1)*0.01*0.5
            through = [run.history[f"heat_through_wall.{side}/CONVE"][-1]/power for side in (4, 2)]
            checks.small(max(abs(through[0] - 1), abs(through[1] + 1)), 1e-8, f"{run.name}: {power:.4f} W in and out")


FLOWS = (HEAD + "BLOCK w PL8TM 9 m {kind}\n   1. 0. 2. 0. 2. 1. 1. 1.\n   4 1. 3 1.\nLAW m HEAT\n   20. 3.\nSTART T 430.\n"
         "CONVE w 2 H 30. TS 20.\nRADIA w 2 EPS 0.8 SIGMA 5.67E-8 ZERO 273.15 TS 20.\nFLUX w 3 Q 1.E3 on\nHEATS w Q 100.\n"
         "IMPOS w 4 T on 300.\nIMPOS w 1 T on 300.\nLIC on\n   0. 1. 0.1 0.5\nDIE d\n   SEGM 3. 1. 0. 1.\nCOU2DC w 3 d H 5.\nTDIE d T 100.\n"
         "STRAT 0.001 1.E-6 0.01 9 3\nSTOP 0.1\nTHETA {scheme}\n" + TIGHT + "END\n")


def flows(checks):
    """Heat through every boundary, in all ways through a side, from the volume and into a die: together what the books have."""
    names = ["w.2/CONVE", "w.2/RADIA", "w.3/FLUX", "w/HEATS", "w.3/d/COU2DC", "w.4/IMPOS", "w.1/IMPOS"]
    for scheme in ("1.", "0.5 MEAN", "TRBDF2"):
        for kind in ("", "BILINEAR"):
            run = Run(checks, f"flows-{scheme[:3].strip('.')}{kind}", FLOWS.format(title="flows", state="AXISYM", kind=kind, scheme=scheme))
            if not run.ok:
                return
            steps = run.history["step_length"]
            passed = [np.sum(run.history["heat_through_" + name]*steps) for name in names]
            whole = run.history["heat_in"][-1] + run.history["heat_released"][-1]
            checks.small(abs(sum(passed) - whole)/sum(map(abs, passed)), 1e-12, f"{run.name}: sum over the boundaries")
            checks.that(min(map(abs, passed)) > 50, f"{run.name}: heat through all of them", passed)
            checks.small(np.max(np.abs(run.history["heat_through_w.3/d/COU2DC"] + run.history["heat_flow_d"])), 1e-9*5e3, f"{run.name}: the die")
            if scheme == "0.5 MEAN":
                # both ends of the step, the side 3 pi wide
                exact = 3*math.pi*1e3*(1 - 0.5*(run.history["time"] - 0.5*steps)/0.1)
                checks.small(np.max(np.abs(run.history["heat_through_w.3/FLUX"]/exact - 1)), 1e-9, f"{run.name}: FLUX by time")


def bessel(order, x):
    """Bessel's function of the first kind, order 0 or 1, by its integral."""
    angle = (np.arange(400) + 0.5)*np.pi/400
    return np.mean(np.cos(order*angle - x*np.sin(angle)))


def cooled(biot, fourier, place, terms=40):
    """(T - Ts)/(T0 - Ts) in a long cylinder (Carslaw and Jaeger, section 7.7), place over the radius."""
    total, low = 0.0, 1e-9
    step = 0.01
    found = 0
    while found < terms and low < 200:
        if (low*bessel(1, low) - biot*bessel(0, low))*((low + step)*bessel(1, low + step) - biot*bessel(0, low + step)) <= 0:
            z = root(lambda v: v*bessel(1, v) - biot*bessel(0, v), low, low + step)
            total += 2*biot*bessel(0, z*place)*math.exp(-z*z*fourier)/((z*z + biot*biot)*bessel(0, z))
            found += 1
            if z*z*fourier > 40:
                break
        low += step
    return total


def nearest(run, radius):
    """Radius of the node of the axis' end that is nearest to one."""
    x, _ = temperatures(run)
    return min(x[np.abs(x[:, 1]) < 1e-9][:, 0], key=lambda r: abs(r - radius))


def cylinder(checks):
    """Cooling of a long cylinder: by steps of implicit Euler, and every number of the table to .1 %."""
    known = {(1, 0.1): (0.976817, 0.920502, 0.684565), (1, 0.5): (0.548586, 0.495884, 0.352786), (20, 0.1): (0.878959, 0.665699, 0.064472)}
    for (biot, fourier), values in known.items():
        exact = [cooled(biot, fourier, r) for r in (0.0, 0.5, 1.0)]
        checks.small(max(abs(a - b) for a, b in zip(exact, values)), 1e-5, f"cylinder, Biot {biot}, Fourier {fourier}: series")
        errors = []
        for steps in (100, 200):
            run = Run(checks, f"cylinder-{biot}-{fourier}-{steps}", HEAD.format(title="cylinder", state="AXISYM")
                      + "BLOCK bar PL8TM 4 steel\n   0. 0. 1. 0. 1. 0.1 0. 0.1\n   20 0.3 1 1.\nLAW steel HEAT\n   1. 1.\nSTART T 1.\n"
                      f"CONVE bar 2 H {biot}. TS 0.\nSTRAT {fourier/steps} 1.E-9 {fourier/steps} 9 3\nSTOP {fourier}\n" + NORMS
                      + "PROBE a NODE T 0. 0.\nPROBE c NODE T 1. 0.\nEND\n")
            if run.ok:
                errors.append(max(abs(run.history["a"][-1] - exact[0]), abs(run.history["c"][-1] - exact[2])))
        if len(errors) == 2:
            checks.small(errors[1], 5e-3, f"cylinder, Biot {biot}, Fourier {fourier}")
            checks.that(1.7 < errors[0]/errors[1] < 2.3, "cylinder: order 1 in time", errors)
        run = Run(checks, f"cylinder-{biot}-{fourier}-second", HEAD.format(title="cylinder", state="AXISYM")
                  + "BLOCK bar PL8TM 4 steel\n   0. 0. 1. 0. 1. 0.1 0. 0.1\n   12 0.3 1 1.\nLAW steel HEAT\n   1. 1.\nSTART T 1.\n"
                  f"CONVE bar 2 H {biot}. TS 0.\nTHETA TRBDF2 TOL 1.E-5\nSTRAT 1.E-6 1.E-9 {fourier/10} 9 3\nSTOP {fourier}\n" + TIGHT
                  + "PROBE a NODE T 0. 0.\nPROBE b NODE T 0.5 0.\nPROBE c NODE T 1. 0.\nEND\n")
        if run.ok:
            # the node nearest to half the radius, and the table itself where that is on it
            found = [run.history[name][-1] for name in "abc"]
            place = nearest(run, 0.5)
            exact[1] = cooled(biot, fourier, place)
            checks.small(max(abs(one/other - 1) for one, other in zip(found, exact)), 1e-3,
                         f"cylinder, Biot {biot}, Fourier {fourier}, TRBDF2: table of Bessel's functions, {run.history['step'][-1]:.0f} steps")


def by_temperature(checks):
    """Kirchhoff's transform."""
    a, b, hot, cold = 10.0, 0.05, 800.0, 100.0

    def exact(x, _):
        total = a*(hot - cold) + 0.5*b*(hot**2 - cold**2)
        c = a*cold + 0.5*b*cold**2 + total*(1 - x/0.1)
        return (-a + np.sqrt(a*a + 2*b*c))/b

    errors = []
    for divisions in (8, 16, 32):
        run = Run(checks, f"kirchhoff-{divisions}", HEAD.format(title="kirchhoff", state="PLSTN") + wall("9", divisions)
                  + f"LAW steel HEAT\n   TEMP 0.\n   {a} 1.\n   TEMP 1000.\n   {a + 1000*b} 1.\n"
                  f"START T {cold}\nIMPOS wall 4 T on {hot}\nIMPOS wall 2 T on {cold}\nLIC on\n   0. 1.\n" + STEADY + TIGHT + "END\n")
        if run.ok:
            errors.append(mean_error(run, exact))
    if len(errors) == 3:
        orders(checks, errors, 3, "LAMBDA by temperature")


def source(checks):
    """Heat from the volume: a parabola between sides at 0, which 8-node temperatures hold exactly; and a body that only warms up."""
    for rule in ("4", "9"):
        run = Run(checks, f"source-{rule}", HEAD.format(title="source", state="PLSTN 0.5") + wall(rule)
                  + "LAW steel HEAT\n   20. 3.6E6\nHEATS wall Q 2.E5 on\nIMPOS wall 2 T even\nIMPOS wall 4 T even\nLIC on\n   0. 0.5 1. 1.\n"
                  "LIC even\n   0. 0.\n" + STEADY + TIGHT + "PROBE a NODE T 0.02 0.\nPROBE b NODE T 0.05 0.\nEND\n")
        if run.ok:
            found = np.array([run.history["a"][-1], run.history["b"][-1]])
            exact = np.array([2e5/40*x*(0.1 - x) for x in (0.02, 0.05)])
            checks.small(np.max(np.abs(found/exact - 1)), 1e-10, f"{run.name}: parabola")
    for rule in ("4", "4 BILINEAR"):
        run = Run(checks, f"warm-{rule}".replace(" ", ""), HEAD.format(title="warm", state="AXISYM") + wall(rule)
                  + "LAW steel HEAT\n   20. 2.\nHEATS wall Q 3. on\n   0. 1. 10. 1.\nLIC on\n   0. 1. 1. 2.\nSTRAT 0.1 1.E-3 0.1 4 3\nSTOP 1.\n"
                  "THETA 0.5\n" + TIGHT + "PROBE a NODE T 0.02 0.\nEND\n")
        if run.ok:
            checks.small(abs(run.history["a"][-1]/2.25 - 1), 1e-10, f"{run.name}: integral of the source")
            checks.small(np.max(np.abs(run.history["heat_imbalance"])), 1e-11, f"{run.name}: books")


FIN = (HEAD + "BLOCK fin PL8TM 4 steel {kind}\n   0. 0. 50. 0. 50. 2. 0. 2.\n   {n} 1. 1 1.\nLAW steel HEAT\n   50. 3.6\nSTART T 20.\n"
       "IMPOS fin 4 T on 120.\nLIC on\n   0. 1.\n{cards}\n" + STEADY + TIGHT + "PROBE tip NODE T 50. 0.\nEND\n")


def fin(checks):
    """Heat through the faces of a sheet in plane stress, 1.5 thick, 2 wide and 50 long."""
    both, each = "CONVE fin FACES 1 2 H 0.08 TS 20.", "CONVE fin FACES 1 H 0.08 TS 20.\nCONVE fin FACES 2 H 0.08 TS 20."
    length = math.sqrt(2*0.08/(50*1.5))*50
    power = 100*50*1.5*2*length/50*math.tanh(length)
    for kind, order, bound in (("", 4, 1e-5), ("BILINEAR", 2, 1e-2)):
        errors = []
        for n in (5, 10, 20):
            run = Run(checks, f"fin{kind}{n}", FIN.format(title="fin", state="PLSTS 1.5", kind=kind, n=n, cards=both if n < 20 else each))
            if not run.ok:
                return
            errors.append(abs((run.history["tip"][-1] - 20)/100*math.cosh(length) - 1))
            taken = run.history["heat_through_fin.4/IMPOS"][-1]
        orders(checks, errors, order, f"fin {kind}")
        checks.small(errors[-1], bound, f"fin {kind}: its tip")
        checks.small(abs(taken/power - 1), bound, f"fin {kind}: heat at its root")
        passed = sum(run.history[f"heat_through_fin.face{face}/CONVE"][-1] for face in (1, 2))
        checks.small(abs(passed/taken + 1), 1e-8, f"fin {kind}: heat through its faces")


def drawn(checks):
    """The body is that of the cards of mechanics or of heat; 8 mm2 of it become a thinner sheet."""
    for body, other in (("PL8LS 4 solid", "PL8TM hot"), ("PL8TM 4 hot", "PL8LS solid")):
        for card, kind in (("HEATS s Q 36. on", "volume"), ("FLUX s FACES 1 2 Q 12. on", "faces")):
            run = Run(checks, f"drawn-{body[:5]}-{kind}", f"TITLE drawn\nSTATE PLSTS 0.8\nKINEM LOG\nBLOCK s {body}\n   0. 0. 4. 0. 4. 2. 0. 2.\n"
                      f"   1 1. 1 1.\nLAW solid EPLA\n   2.E5 .3\n   LINEAR 200. 200.\nADDEL s {other}\nLAW hot HEAT\n   50. 3.6\n{card}\n"
                      "FIXED s 4 X\nFIXED s 1 Y\nMOVE s 2 X pull\nLIC pull\n   0. 0. 1. 2.\nLIC on\n   0. 0. 1. 0. 1.000001 1. 2. 1.\n"
                      f"STRAT .05 1.E-7 .05 9 3\nSTOP 2.\n{TIGHT}PROBE t NODE T 4. 2.\n"
                      f"PROBE thick MEAN stretch_zz s{'' if body[:5] == 'PL8LS' else '/PL8LS'}\n"
                      "PROBE x NODE X 4. 2.\nPROBE y NODE Y 4. 2.\nEND\n")
            if not run.ok:
                return
            thick, x, y = (run.history[name][-1] for name in ("thick", "x", "y"))
            exact = (36*thick if kind == "volume" else 2*12/0.8)*x*y/(3.6*8)
            checks.that(thick < 0.85, f"{run.name}: thinner", thick)
            # heating begins over a millionth of its time
            checks.small(abs(run.history["t"][-1]/exact - 1), 1e-6, f"{run.name}: {exact:.4f}")


def stated(checks):
    """Heat that a LIC states comes in as stated, by every scheme and in steps of any length: 1.25 times its value at 1."""
    cards = (("flux", "FLUX wall 2 Q 3. on", 3*0.02), ("heats", "HEATS wall Q 3. on", 3*0.1*0.02),
             ("goldak", "GOLDAK wall P 3. on ETA 0.5 FRONT 0.02 REAR 0.02 DEPTH 0.02 INTO 1. 0.\n   0. 0. 0.01", 1.5))
    for name, card, rate in cards:
        for scheme in ("1.", "0.7", "0.7 MEAN", "TRBDF2", "1. TOL 1."):
            run = Run(checks, f"stated-{name}-{scheme.replace(' ', '').replace('.', '')}", HEAD.format(title="stated", state="PLSTN")
                      + "BLOCK wall PL8TM 4 steel\n   0. 0. 0.1 0. 0.1 0.02 0. 0.02\n   8 1. 2 1.\nLAW steel HEAT\n   20. 2.E3\n" + card
                      + "\nLIC on\n   0. 0. 0.5 1. 1. 1. 2. 0.\nSTRAT 0.3 1.E-5 0.3 9 3\nSTOP 4.\nTHETA " + scheme + "\n" + TIGHT + "END\n")
            if run.ok:
                taken = run.history["heat_in"][-1] + run.history["heat_released"][-1]
                checks.small(abs(taken/(1.25*rate) - 1), 1e-10, f"{run.name}: heat")


def stefan(checks):
    """Two-phase freezing."""
    solid, liquid = 3.0e6, 2.5759e6
    width = 0.1
    run = Run(checks, "stefan", HEAD.format(title="stefan", state="PLSTN") + "BLOCK wall PL8TM 4 alu BILINEAR\n"
              "   0. 0. 0.1 0. 0.1 0.005 0. 0.005\n   200 1. 1 1.\nLAW alu HEATH\n"
              f"   TEMP 0.\n   210. 0.\n   TEMP {660 - width}\n   210. {(660 - width)*solid}\n"
              f"   TEMP {660 + width}\n   95. {(660 - width)*solid + 1.08e9}\n"
              f"   TEMP 800.\n   95. {(660 - width)*solid + 1.08e9 + (140 - width)*liquid}\n"
              "START T 740.\nIMPOS wall 4 T on 580.\nLIC on\n   0. 1.\nSTRAT 0.005 1.E-6 0.01 9 3\nSTOP 6.\nPROBE p NODE T 0.01 0.\nEND\n")
    if run.ok:
        for time, exact in ((0.5, 726.60), (1.0, 707.14), (3.0, 672.55), (6.0, 651.83)):
            k = int(np.argmin(np.abs(np.array(run.history["time"]) - time)))
            checks.small(abs(run.history["p"][k]/exact - 1), 1e-2, f"stefan: {exact} after {time} s")


STEEL = """STEEL  metal
SOURCE 'an austenite that does not expand, for a closed form'
EXPAND TOTAL 20
PHASE  AUSTENITE
   LAMBDA 30
   RHOC   {capacity}
   E      {young}
   NU     0.3
   ALPHA  0
   SY     {flow}
   ET     0
END
"""


def plastic(checks):
    """Heat of plastic work: perfectly plastic, pressed to ln(length) = -1 and a little more for the elastic part; of a metal, and of a
    steel with phases by both of its laws for heat."""
    young, flow, capacity, share = 200000.0, 700.0, 3.60318, 0.9   # N, mm, K: rho c of 7833 kg/m3 and 460 J/kg/K
    stretch = math.exp(-1 - flow/young)
    write(os.path.join(checks.folder, "metal.met"), STEEL.format(capacity=capacity, young=young, flow=flow))
    steel = "\n   STEEL 'metal.met' metal\n"
    laws = {"HEAT": (f"EPLA\n   {young} 0.3\n   LINEAR {flow} 0.", f"HEAT\n   0.001 {capacity}\n   QUINNEY {share}"),
            "META": (f"ARBTHMET{steel}   STRESS 1. TIME $time", f"META{steel}   ENERGY 1. QUINNEY {share}"),
            "METAMEC": (f"ARBTHMET{steel}   STRESS 1. TIME $time", f"METAMEC{steel}   ENERGY 1. QUINNEY {share} STRESS 1. ISIG 0")}
    for law, (solid, heat) in laws.items():
        for way in ("ONCE", "CONVERGE", "MONOLITHIC"):
            # in one system mechanics finds its phases by itself
            time = f"PARAM time {1 if way == 'MONOLITHIC' else 0}\n" if "$time" in solid else ""
            run = Run(checks, f"plastic-{law}-{way}", f"TITLE plastic\n{time}STATE PLSTS 1.\nKINEM LOG\nBLOCK bar PL8LS 4 steel\n"
                      f"   0. 0. 1. 0. 1. 1. 0. 1.\n   1 1. 1 1.\nLAW steel {solid}\n"
                      f"ADDEL bar PL8TM heat\nLAW heat {heat}\nFIXED bar 4 X\nFIXED bar 1 Y\n"
                      f"MOVE bar 2 X pull {stretch - 1}\nLIC pull\n   0. 0. 1. 1.\nSTOP 1.\nSTRAT 0.01 1.E-5 0.01 9 3\n"
                      f"NORMS FORCE 1.E-9 DISPL 1.E-9\nSOLVE {way}\nPROBE t NODE T 1. 1.\nPROBE p POINT plastic_strain 0.5 0.5\nEND\n")
            if run.ok:
                p, t = run.history["p"][-2 if way == "ONCE" else -1], run.history["t"][-1]
                checks.small(abs(t/(share*flow*p/capacity) - 1), 1e-4,
                             f"plastic work to heat, {law} {way}: {share*flow/capacity:.2f} at strain {p:.3f}")


EXPANDING = STEEL.replace("metal\n", "expanding\n", 1).replace("does not expand", "expands").replace("ALPHA  0", "ALPHA  22E-6")


def pressed_hot(checks):
    """Plastic work is per volume of the hot body: a twentieth more than of the cold one; what was done does not shrink with it."""
    write(os.path.join(checks.folder, "expanding.met"), EXPANDING.format(capacity=4.0, young=150000.0, flow=300.0))
    imposed = "".join(f"IMPOS bar {side} T {{0}}\n" for side in (1, 2, 3, 4))
    for way, find in (("ONCE", ""), ("CONVERGE", ""), ("MONOLITHIC", " TIME 1.")):
        run = Run(checks, f"pressed-hot-{way}", "TITLE pressed hot\nSTATE AXISYM\nKINEM LOG\nBLOCK bar PL8LS 4 steel\n"
                  "   0. 0. 10. 0. 10. 10. 0. 10.\n   1 1. 1 1.\nLAW steel ARBTHMET\n   STEEL 'expanding.met' expanding\n"
                  f"   STRESS 1.{find}\nADDEL bar PL8TM heat BILINEAR\nLAW heat META\n   STEEL 'expanding.met' expanding\n"
                  "   ENERGY 1. QUINNEY 0.9\nSTART T 20.\nFIXED bar 4 X\nFIXED bar 1 Y\nNORMS FORCE 1.E-9 DISPL 1.E-9\n"
                  f"SOLVE {way}\nSTRAT 0.05 1.E-5 0.05 9 3\nOPERA heat\n{imposed.format('up')}LIC up\n   0. 20. 1. 1000.\nSTOP 1.\n"
                  "OPERA press\nMOVE bar 3 Y down\nLIC down\n   0. 0. 1. -5.  1.1 -5.\nSTOP 1.1\n"
                  f"OPERA cool\n{imposed.format('back')}LIC back\n   0. 1000. 1. 20.\nSTOP 1.\nEND\n")
        if not run.ok:
            continue
        rows = run.history
        last = {int(operation): k for k, operation in enumerate(rows["operation"])}
        heat = rows["heat_released"][last[2]] - rows["heat_released"][last[1]]
        checks.small(abs(heat/(0.9*rows["plastic_work"][last[2]]) - 1), 1e-9 if way == "ONCE" else 3e-4, f"pressed hot, {way}: heat of plastic work")
        checks.small(abs(rows["plastic_work"][last[3]]/rows["plastic_work"][last[2]] - 1), 1e-12, f"pressed hot, {way}: work kept in cooling")


def main():
    """All cases."""
    checks = Checks()
    for case in (radiation, wave, annulus, convection, flows, cylinder, by_temperature, source, fin, drawn, stated, stefan, plastic, pressed_hot):
        case(checks)
    checks.end()


if __name__ == "__main__":
    main()
