#!/usr/bin/env python3
"""Balance of heat in time: TR-BDF2 and implicit Euler with their errors, bounds of temperatures, factors that are kept.

usage: run_schemes.py [-v] [-k]

- `order`: the order in the step, from the differences of runs whose steps are each half of the one before (L.F. Richardson): a side
  that follows a wave; convection, radiation and numbers by temperature; a wide interval of melting; heat with the motion of a body,
  solved for until nothing changes. Books of heat close in all of them.
- `t3` (NAFEMS T3): 36.603 after 32 s.
- `error`: the estimate of a smooth problem falls with the third power of the step (second: implicit Euler), and the sum of all is no
  less than the error of the run; TOL is met, and the error falls with it.
- `carried`: the estimate of what all steps have left at the end is half to twice the error of the run, by both schemes: with numbers by
  temperature, latent heat, motion and after a shock.
- `dies`: of a slab and a die with heat of its own it is 0.9 to 1.15 times the error against the closed form.
- `meshes`: over two new meshes it is 0.8 to 1.25 times the error against the closed form, and dies away after them.
- `bounds`: a body of Biot number 1000 on a coarse mesh: with BILINEAR no temperature is outside at any step, TR-BDF2 falls back to
  implicit Euler and says how often; with eight temperatures an element the steps outside are counted. On skew and on flat elements, with
  numbers by temperature, every scheme makes steps again, in the end without flows against the fall of the temperature: none is outside.
- `latent`: freezing of a half space (F. Neumann) by intervals of melting, meshes and steps that differ by 1000, 5 and 10: within 1 %
  and with one cutback at most (68 of the first of them once); a corner that melts, in the plane.
- `steel`: a steel of austenite alone that melts has the steps and the errors of HEATH by the same numbers, walked either way.
- `factors`: a linear problem factorises once for each length of a step; one by temperature at every iteration.
- `phases`: what forms of a phase in a cooling that takes long, by TR-BDF2 as by implicit Euler: kinetics see the whole time.
- `resume`: from the older checkpoint on, the same bits.
"""
import json
import math
import os
import subprocess
import sys

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [HERE] + [os.path.join(os.path.dirname(HERE), folder) for folder in ("patch", "runs", "cycle")]
from patch_support import LAGAMINE, LONGEST_RUN, Checks, Run, np  # noqa: E402
from run_exchange import HEAD, TIGHT, wall  # noqa: E402
from run_heat import temperatures  # noqa: E402
from remeshed import cycle, tries  # noqa: E402
from support import DONE, history, said, write  # noqa: E402


def checks_of(run):
    """The checks of summary.json."""
    return summary(run)["checks"]


def summary(run):
    """The whole of summary.json."""
    with open(os.path.join(run.out, "summary.json"), encoding="utf-8") as file:
        return json.load(file)


def steps(count, time, first=None):
    """Equal steps; the first, by implicit Euler, is a 16th, and what is left of it in one more."""
    step = time/count
    return f"STRAT {first or step/16!r} {step*1e-6!r} {step!r} 99 1 0.5 1.E6\nSTOP {time}\n"


WAVE = HEAD.format(title="wave", state="PLSTN") + wall("9", 20) + (
    "LAW steel HEAT\n   35. 7200*440.5\nSTART T 0.\nIMPOS wall 4 T zero\nIMPOS wall 2 T wave 100.\nLIC zero\n   0. 0.\n"
    "PROBE a NODE T 0.08 0.\n" + TIGHT + "LIC wave\n")
RAMP = WAVE + "   0. 0. 32. 1.\n"
EXCHANGE = HEAD.format(title="exchange", state="AXISYM") + wall("4", 6) + (
    "LAW steel HEAT\n   TEMP 0.\n   20. 3.E6\n   TEMP 1000.\n   40. 5.E6\nSTART T 900.\n"
    "CONVE wall 2 H 400. TS 20.\n   0. 1. 1000. 3.\nRADIA wall 4 EPS 0.8 SIGMA 5.67E-8 ZERO 273.15 TS 20.\n" + TIGHT)
# the same from equilibrium: surroundings cool as the square of the time, in many corners
SMOOTH = EXCHANGE.replace("TS 20.", "TS 1. cool") + "LIC cool\n" + "".join(
    f"   {40*k/32!r} {900 - 880*(k/32)**2!r}\n" for k in range(33))
MELTING = HEAD.format(title="melting", state="PLSTN") + wall("4 BILINEAR", 10) + (
    "LAW steel HEATH\n   TEMP 0.\n   100. 0.\n   TEMP 100.\n   100. 3.E8\n   TEMP 700.\n   60. 6.E9\n   TEMP 800.\n   60. 6.3E9\n"
    "START T 650.\nCONVE wall 2 H 5000. TS 120.\n" + TIGHT)
MOTION = HEAD.format(title="motion", state="AXISYM").replace("SMALL", "LOG") + (
    "BLOCK wall PL8LS 9 solid\n   0. 0. 2. 0. 2. 2. 0. 2.\n   3 1. 2 1.\nLAW solid ELATH\n   200000. 0.3 1.2E-5\n"
    "ADDEL wall PL8TM heat\nLAW heat HEAT\n   50. 3.6\n   SOURCE 2500.\nFIXED wall 4 X\nFIXED wall 1 Y\nMOVE wall 3 Y in\n"
    "LIC in\n   0. 0. 4. -0.4\nSTART T 300.\nCONVE wall 2 H 40. TS 20.\nSOLVE CONVERGE\n" + TIGHT)
CASES = {"ramp": (RAMP, 32.0, (16, 32, 64, 128)), "exchange": (EXCHANGE, 40.0, (16, 32, 64, 128)),
         "melting": (MELTING, 40.0, (16, 32, 64, 128)), "motion": (MOTION, 0.4, (8, 16, 32))}


def order(checks):
    """Second order of TR-BDF2, first of implicit Euler by its error."""
    for name, (text, time, counts) in CASES.items():
        found = []
        for count in counts:
            run = Run(checks, f"{name}-{count}", text + steps(count, time) + "THETA TRBDF2\nEND\n")
            if run.ok:
                found.append(temperatures(run)[1])
                checks.small(abs(checks_of(run)["heat_imbalance"]), 1e-8, f"{run.name}: books of heat")
        if len(found) == len(counts):
            change = [np.sqrt(np.mean((b - a)**2)) for a, b in zip(found, found[1:])]
            orders = np.log2(np.array(change[:-1])/np.array(change[1:]))
            checks.that(1.8 <= orders[-1] <= 2.6, f"{name}: second order", f"{orders.round(2)}, differences {change}")


def t3(checks):
    """NAFEMS T3."""
    wave = "".join(f"   {t/8!r} {math.sin(math.pi*t/8/40)!r}\n" for t in range(257))
    run = Run(checks, "t3", WAVE + wave + steps(128, 32.0) + "THETA TRBDF2\nEND\n")
    if run.ok:
        checks.small(abs(run.history["a"][-1]/36.60312 - 1), 1e-4, "t3: 36.603")


def carried(checks):
    """What earlier steps have left of their errors, at the end: against runs of short steps."""
    for name, (text, time, counts) in dict(CASES, smooth=(SMOOTH, 40.0, (64,)), shock=(EXCHANGE, 40.0, (64,))).items():
        exact = Run(checks, f"{name}-short", text + steps(16*counts[-1], time) + "THETA TRBDF2\nEND\n")
        for scheme in ("1.", "TRBDF2"):
            run = Run(checks, f"{name}-carried-{scheme.strip('.')}", text + steps(counts[-1]//2, time) + f"THETA {scheme}\nEND\n")
            if not (run.ok and exact.ok):
                continue
            true = np.sqrt(np.mean((temperatures(run)[1] - temperatures(exact)[1])**2))
            found = checks_of(run)["error_in_time_end"]
            checks.that(0.5*true <= found <= 2*true, f"{run.name}: estimated error at the end", f"{found:.3g}, error {true:.3g}")
            checks.that(found <= checks_of(run)["error_in_time_largest"], f"{run.name}: the largest is no less", checks_of(run))


def dies(checks):
    """Two lumps that exchange heat, a slab of good conductivity and a die with heat of its own: both keep their errors."""
    h = 0.5
    for slab, die in ((0.2, 0.3), (2.0, 0.1), (0.2, 3.0)):
        mean = (slab*1000 + die*20)/(slab + die)
        exact = mean + (1000 - mean)*math.exp(-h*(1/slab + 1/die))
        for scheme in ("1.", "TRBDF2"):
            run = Run(checks, f"die-{slab}-{die}-{scheme.strip('.')}", HEAD.format(title="die", state="PLSTN")
                      + "BLOCK slab PL8TM 9 steel BILINEAR\n   0. 0. 1. 0. 1. 0.1 0. 0.1\n   2 1. 2 1.\n"
                      + f"LAW steel HEAT\n   1.E9 {slab/0.1!r}\nDIE cold\n   SEGM -1. 0. 2. 0.\nTDIE cold T 20. C {die}\n"
                      + f"COU2DC slab 1 cold H {h}\nSTART T 1000.\nPROBE top NODE T 0. 0.1\nSTRAT 0.02 1.E-6 0.02 4 3\nSTOP 1.\n"
                      + f"THETA {scheme}\n" + TIGHT + "END\n")
            if run.ok:
                true, found = abs(run.history["top"][-1] - exact), checks_of(run)["error_in_time_end"]
                checks.that(0.9*true <= found <= 1.15*true, f"{run.name}: estimated error at the end", f"{found:.3g}, error {true:.3g}")


def error(checks):
    """Estimates against what runs of short steps show."""
    end = temperatures(Run(checks, "error-exact", SMOOTH + steps(1024, 40.0) + "THETA TRBDF2\nEND\n"))[1]
    for scheme, power in (("TRBDF2", 3), ("1. TOL 1.E6", 2), ("1.", 2)):
        late = []
        for count in (64, 128):
            run = Run(checks, f"error-{count}-{scheme.replace(' ', '').strip('.')}", SMOOTH + steps(count, 40.0) + f"THETA {scheme}\nEND\n")
            if not run.ok:
                continue
            true = np.sqrt(np.mean((temperatures(run)[1] - end)**2))
            values = checks_of(run)
            checks.that(true <= values["error_in_time_sum"] <= 100*true, f"{run.name}: the sum of the estimates bounds the error",
                        f"{values['error_in_time_sum']:.3g}, error {true:.3g}")
            late.append(values["error_in_time_sum"])
        if len(late) == 2:
            rate = np.log2(late[0]/late[1])
            checks.that(power - 1.4 <= rate <= power - 0.3, f"{scheme}: power {power} of the step, less one in the sum", f"{rate:.2f}")
    end = temperatures(Run(checks, "shock-exact", EXCHANGE + steps(1024, 40.0) + "THETA TRBDF2\nEND\n"))[1]
    for scheme in ("TRBDF2", "1."):
        errors, counts = [], []
        for tolerance in (1.0, 0.1, 0.01):
            run = Run(checks, f"tol-{scheme[:2].strip('.')}-{tolerance}", EXCHANGE + "STRAT 0.1 1.E-6 40. 99 1 0.5 5.\nSTOP 40.\n"
                      f"THETA {scheme} TOL {tolerance}\nEND\n")
            if not run.ok:
                continue
            values = checks_of(run)
            checks.small(values["error_in_time_worst"], tolerance, f"{run.name}: every step")
            checks.that(values["least_steps_above_error"] == 0, f"{run.name}: no step above", values)
            checks.small(abs(values["heat_imbalance"]), 1e-8, f"{run.name}: books of heat")
            errors.append(np.sqrt(np.mean((temperatures(run)[1] - end)**2)))
            counts.append(run.history["step"][-1])
        checks.that(len(errors) == 3 and errors[0] > 2*errors[1] > 4*errors[2], f"{scheme}: errors fall with the tolerance", errors)
        checks.that(len(counts) == 3 and counts[0] < counts[1] < counts[2], f"{scheme}: at a price", counts)
    run = Run(checks, "tol-least", EXCHANGE + "STRAT 4. 4. 4. 99 1 0.5 5.\nSTOP 40.\nTHETA 1. TOL 1.E-3\nEND\n")
    if run.ok:
        checks.that(checks_of(run)["least_steps_above_error"] == 10, "steps of the least length are made, and counted", checks_of(run))


def bounds(checks):
    """Conduction of 1, sides of 1, exchange of 1000."""
    for step in (1e-5, 1e-3, 0.1, 10.0):
        for scheme in ("1.", "TRBDF2"):
            for option in (" BILINEAR", ""):
                run = Run(checks, f"bounds-{step}-{scheme[:2].strip('.')}{option[1:3]}", HEAD.format(title="Biot 1000", state="AXISYM")
                          + f"BLOCK wall PL8TM 9 m{option}\n   0. 0. 1. 0. 1. 1. 0. 1.\n   3 1. 3 1.\nLAW m HEAT\n   1. 1.\nSTART T 800.\n"
                          f"CONVE wall 2 3 H 1000. TS 20.\nSTRAT {step} {step} {step} 99 1\nSTOP {20*step!r}\nTHETA {scheme}\nSAVE 1\n{TIGHT}END\n")
                if not run.ok:
                    continue
                with run.open() as file:
                    low, high = (function(function(file[f"steps/{s}/node/temperature"][()]) for s in file["steps"])
                                 for function in (min, max))
                values = checks_of(run)
                told = f"{low:.6g} to {high:.6g}, {values['steps_outside_bounds']} outside, {values['steps_made_again_for_bounds']} again"
                if option:
                    checks.that(20 - 1e-2 <= low and high <= 800 + 1e-2, f"{run.name}: between 20 and 800", told)
                    checks.that(values["steps_outside_bounds"] == 0, f"{run.name}: none outside", told)
                else:
                    outside = values["steps_outside_bounds"]
                    checks.that((low < 20 or high > 800) if outside else (low > 20 - 1e-2 and high < 800 + 1e-2),
                                f"{run.name}: what is outside is counted", told)
                if option and scheme == "TRBDF2" and step == 1e-3:
                    checks.that(values["steps_made_again_for_bounds"] > 0, f"{run.name}: falls back", told)
                if not option and step == 1e-5:
                    checks.that(values["excess_of_bounds"] > 1, f"{run.name}: a shock is not resolved", told)
                warned = [line["text"] for line in summary(run)["warnings"] if "beyond those that can be there" in line["text"]]
                checks.that(len(warned) == (values["excess_of_bounds"] > 0.05*780), f"{run.name}: told", (told, warned))
    # a steel with phases: overshoot of many short steps, and none where elements are small
    with open(os.path.join(checks.folder, "shock.met"), "w", encoding="utf-8") as file:
        file.write("STEEL s\nSOURCE 'round numbers'\nTEMPS MS 300\nMARTEN BETA 0.011\nPHASE ALL\n   LAMBDA 30\n   RHOC 4.5\nPHASE MARTENSITE\n   LATENT 640\nEND\n")
    for elements, option, outside in ((4, "", True), (64, "", False), (4, " BILINEAR", False)):
        run = Run(checks, f"shock-{elements}{option[1:3]}", HEAD.format(title="quenched in salt", state="PLSTN")
                  + f"BLOCK bar PL8TM 4 m{option}\n   0. 0. 20. 0. 20. 2. 0. 2.\n   {elements} 1. 1 1.\nLAW m META\n   STEEL shock.met s\n   ENERGY 1.\nSTART T 850.\n"
                  "CONVE bar 2 H 20. TS 200.\nTHETA TRBDF2 TOL 1.\nSTRAT 0.002 1.E-6 1. 6 3\nSTOP 20.\nPROBE most MAX T bar\nEND\n")
        if run.ok:
            warned = [line["text"] for line in summary(run)["warnings"] if "beyond those that can be there" in line["text"]]
            most = run.history["most"].max()
            checks.that((most > 850 + 0.05*650) == outside and len(warned) == outside, f"{run.name}: overshoot is told", (most, warned))


SKEW = (("parallelograms", "0. 0. 1. 0. 3. 1. 2. 1."), ("flat", "0. 0. 4. 0. 4. 0.3 0. 0.3"), ("both", "0. 0. 1. 0. 2. 0.3 1. 0.3"))


def bounds_of_any(checks):
    """Skew and flat elements, two sides suddenly cooled. A step may miss the bounds by 1e-5 of the range (heat_bounds), ten of them by 0.08."""
    for name, place in SKEW:
        again = {}
        for scheme in ("1.", "0.5", "TRBDF2"):
            for step in (1e-5, 1e-3, 0.1):
                run = Run(checks, f"any-{name}-{scheme[:2]}-{step}", HEAD.format(title="Biot 1000", state="AXISYM")
                          + f"BLOCK wall PL8TM 9 m BILINEAR\n   {place}\n   3 1. 6 1.\nLAW m HEAT\n   TEMP 0.\n   1. 1.\n   TEMP 1000.\n   2. 1.5\n"
                          f"START T 800.\nCONVE wall 2 3 H 1000. TS 20.\nSTRAT {step} {step} {step} 99 1\nSTOP {10*step!r}\nTHETA {scheme}\nSAVE 1\n"
                          f"{TIGHT}END\n")
                if not run.ok:
                    continue
                with run.open() as file:
                    low, high = (function(function(file[f"steps/{s}/node/temperature"][()]) for s in file["steps"])
                                 for function in (min, max))
                values = checks_of(run)
                checks.that(20 - 0.08 <= low and high <= 800 + 0.08 and values["steps_outside_bounds"] == 0, f"{run.name}: between 20 and 800",
                            (low, high, values["steps_outside_bounds"]))
                checks.small(abs(values["heat_imbalance"]), 1e-8, f"{run.name}: books of heat")
                again[scheme] = again.get(scheme, 0) + values["steps_made_again_for_bounds"]
        checks.that(again.get("1.", 0) > 0 and again.get("0.5", 0) > 0, f"any-{name}: steps made again are counted", again)


def latent(checks):
    """Neumann's solution, and a corner."""
    exact = ((3.0, 672.55), (6.0, 651.83))
    for width in (0.001, 0.1, 2.0):
        for nx, step in ((40, 0.02), (40, 0.2), (100, 0.05), (200, 0.02)):
            for scheme in ("1.", "TRBDF2") if nx == 100 else ("1.",):
                solid, melt = (660 - width)*3e6, (140 - width)*2.5759e6
                run = Run(checks, f"latent-{width}-{nx}-{step}-{scheme[:2].strip('.')}", HEAD.format(title="Stefan", state="PLSTN")
                          + f"BLOCK half PL8TM 4 alu BILINEAR\n   0. 0.  0.1 0.  0.1 0.005  0. 0.005\n   {nx} 1. 1 1.\nLAW alu HEATH\n"
                          f"   TEMP 0.\n   210. 0.\n   TEMP {660 - width}\n   210. {solid}\n   TEMP {660 + width}\n   95. {solid + 1.08e9}\n"
                          f"   TEMP 800.\n   95. {solid + 1.08e9 + melt}\nSTART T 740.\nIMPOS half 4 T on 580.\nLIC on\n   0. 1.\n"
                          f"STRAT {step/2} 1.E-6 {step} 9 3\nSTOP 6.\nSAVE TIMES 3.\nTHETA {scheme}\nPROBE p NODE T 0.01 0.\nEND\n")
                if not run.ok:
                    continue
                checks.that(summary(run)["cutbacks"] <= 1, f"{run.name}: one cutback at most", summary(run)["cutbacks"])
                checks.small(abs(checks_of(run)["heat_imbalance"]), 1e-8, f"{run.name}: books of heat")
                for time, value in exact:
                    k = int(np.argmin(np.abs(run.history["time"] - time)))
                    checks.small(abs(run.history["p"][k]/value - 1), 1e-2, f"{run.name}: {value} after {time} s")
    for width in (0.01, 1.0):
        run = Run(checks, f"corner-{width}", HEAD.format(title="corner", state="PLSTN")
                  + "BLOCK c PL8TM 4 alu BILINEAR\n   0. 0.  0.1 0.  0.1 0.1  0. 0.1\n   12 2. 12 2.\nLAW alu HEATH\n"
                  f"   TEMP 0.\n   210. 0.\n   TEMP 660.\n   210. 2.E9\n   TEMP {660 + width}\n   95. 3.E9\n   TEMP 900.\n   95. 3.6E9\n"
                  "START T 600.\nCONVE c 3 H 20000. TS 900.\nIMPOS c 4 T on 800.\nLIC on\n   0. 1.\nSTRAT 0.1 1.E-6 2. 9 3\nSTOP 30.\nEND\n")
        if run.ok:
            checks.that(summary(run)["cutbacks"] <= 1, f"{run.name}: one cutback at most", summary(run)["cutbacks"])
            checks.small(abs(checks_of(run)["heat_imbalance"]), 1e-8, f"{run.name}: books of heat")


def steel(checks):
    """The error of the heat content is one over the least capacity of the material, whatever law has it, and whichever node of an
    element comes first."""
    with open(os.path.join(checks.folder, "melts.met"), "w", encoding="utf-8") as file:
        file.write("STEEL s\nSOURCE 'round numbers'\nEXPAND TOTAL 20\nPHASE AUSTENITE\n   LAMBDA 30\n"
                   "   H TABLE 0 0  1400 6300  1500 9000  1700 10000\nEND\n")
    rows = "".join(f"   TEMP {t}.\n   30. {h}.\n" for t, h in ((0, 0), (1400, 6300), (1500, 9000), (1700, 10000)))
    laws = {"heath": "LAW hot HEATH\n" + rows, "meta": "LAW hot META\n   STEEL melts.met s\n   ENERGY 1.\n"}
    ends = []
    for law, text in laws.items():
        for corners, side in (("0. 0. 10. 0. 10. 1. 0. 1.", 2), ("10. 1. 0. 1. 0. 0. 10. 0.", 4)):
            for option in ("BILINEAR", ""):
                run = Run(checks, f"steel-{law}-{side}{option[:1]}", HEAD.format(title="steel", state="PLSTN")
                          + f"BLOCK bar PL8TM 4 hot {option}\n   {corners}\n   10 1. 1 1.\n{text}START T 1550.\n"
                          f"CONVE bar {side} H 2. TS 20.\nTHETA 1. TOL 5.\nSTRAT 0.1 1.E-5 2. 9 3\nSTOP 5.\nPROBE t NODE T 0. 0.\nEND\n")
                if run.ok:
                    ends.append((option, checks_of(run)["error_in_time_end"], run.history["t"][-1], len(run.history["t"])))
    for option in ("BILINEAR", ""):
        alike = np.array([end[1:] for end in ends if end[0] == option])
        checks.small(np.max(np.abs(alike/alike[0] - 1)), 1e-6, f"steel {option}: error, temperature, steps {alike[0]} by either law and way")


def factors(checks):
    """How often a matrix is factorised."""
    for scheme in ("1.", "0.5 MEAN", "TRBDF2"):
        run = Run(checks, f"factors-{scheme[:3].strip('.')}", RAMP + "STRAT 0.25 0.01 0.25 99 1\nSTOP 32.\n" + f"THETA {scheme}\nEND\n")
        if run.ok:
            whole = summary(run)
            # the first step of TR-BDF2 is another one
            least = 2 if scheme == "TRBDF2" else 1
            checks.that(whole["factorisations"] == least and whole["factorisations_spared"] >= whole["steps"] - 1,
                        f"{run.name}: once", f"{whole['factorisations']} and {whole['factorisations_spared']} spared")
    run = Run(checks, "factors-by-temperature", EXCHANGE + "STRAT 1. 0.1 1. 99 1\nSTOP 20.\nEND\n")
    if run.ok:
        whole = summary(run)
        checks.that(whole["factorisations"] == whole["iterations"] and whole["factorisations_spared"] == 0,
                    "by temperature: every iteration", whole["factorisations"])


def phases(checks):
    """A wall of one temperature that cools through the range of a phase: Avrami, n = 1, b = .002/s."""
    with open(os.path.join(checks.folder, "slow.met"), "w", encoding="utf-8") as file:
        file.write("STEEL slow\nSOURCE 'made up'\nAVRAMI BAINITE 200. 600.\n   LNB -6.2146080984\n   N 1.\nPHASE ALL\n   LAMBDA 30.\n"
                   "   RHOC 4.\nEND\n")
    # 4E6 J/m3/K, 0.1 m thick, 4000 W/m2/K to 20 degC: T = 20 + 780 exp(-t/100 s), from 600 to 200 degC in 100 ln(580/180) s
    exact = 1 - math.exp(-0.002*100*math.log(580/180))
    for scheme in ("1.", "TRBDF2"):
        run = Run(checks, f"phases-{scheme[:2].strip('.')}", HEAD.format(title="phases", state="PLSTN") + wall("4 BILINEAR", 1)
                  + "LAW steel META\n   STEEL slow.met slow\n   ENERGY 1.E6 CONDUCT 1.E4\nSTART T 800.\nCONVE wall 2 H 4000. TS 20.\n"
                  + f"THETA {scheme}\nPROBE z MEAN bainite wall\n" + TIGHT + steps(800, 200.0) + "END\n")
        if run.ok:
            checks.small(abs(run.history["z"][-1]/exact - 1), 2e-3, f"{run.name}: the whole time counts")
            checks.small(abs(checks_of(run)["heat_imbalance"]), 1e-8, f"{run.name}: books of heat")


def resume(checks):
    """A run that goes on from its older checkpoint."""
    run = Run(checks, "resume", EXCHANGE + "STRAT 0.1 1.E-6 40. 99 1 0.5 5.\nSTOP 40.\nTHETA TRBDF2 TOL 0.05\nCKPT 5\nEND\n")
    if not run.ok:
        return
    with open(os.path.join(run.out, "history.csv"), encoding="utf-8") as file:
        whole = file.read()
    before = checks_of(run)
    checks.that(before["steps_shortened_by_error"] > 0, "resume: steps were shortened", before)
    result = subprocess.run([LAGAMINE, run.out + ".lag", "--out", run.out, "--quiet", "--resume", os.path.join(run.out, "resume.ckp.1.h5")],
                            text=True, check=False, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=LONGEST_RUN)
    checks.that(result.returncode == 0, "resume: done", result.stdout)
    with open(os.path.join(run.out, "history.csv"), encoding="utf-8") as file:
        checks.that(file.read() == whole, "resume: the same history")
    checks.that(checks_of(run) == before, "resume: the same checks", checks_of(run))


MESHES = """TITLE  A plate of good conductivity that cools, over new meshes
STATE  {state}
KINEM  SMALL
BLOCK  plate PL8TM 4 m BILINEAR
   0. 0.   20. 0.   20. 5.   0. 5.
   5 1.   2 1.
LAW    m HEAT
   1.E6 4.
START  T 800.
CONVE  plate 3 H 0.5 TS 20.
STRAT  2. 1.E-6 2.   9 3
NORMS  FORCE 1.E-10 DISPL 1.E-10
STOP   {stop}
PROBE  t NODE T 0. 0.
REMSH
   TIMES 20. 30.
END
"""


def meshes(checks):
    """20 + 780 exp(-H t/(RHOC 5)), shortly after new meshes and when all has cooled."""
    for state, stop in (("PLSTN", 40), ("AXISYM", 40), ("PLSTN", 300)):
        name = f"meshes-{state}-{stop}"
        deck, out = write(os.path.join(checks.folder, name + ".lag"), MESHES.format(state=state, stop=stop)), os.path.join(checks.folder, name)
        result = cycle(deck, out)
        if not checks.that(result.returncode == DONE and [row["accepted"] for row in tries(out)].count("y") == 2, f"{name}: two new meshes", said(result)):
            continue
        true = abs(history(out)["t"][-1] - 20 - 780*math.exp(-0.5*stop/20))
        with open(os.path.join(out, "summary.json"), encoding="utf-8") as file:
            told = json.load(file)["accuracy"]["heat"]["end"]
        checks.that(0.8 < told/true < 1.25, f"{name}: what errors before them have left", (told, true))


def main():
    """All cases."""
    checks = Checks()
    order(checks)
    t3(checks)
    error(checks)
    carried(checks)
    dies(checks)
    meshes(checks)
    bounds(checks)
    bounds_of_any(checks)
    latent(checks)
    steel(checks)
    factors(checks)
    phases(checks)
    resume(checks)
    checks.end()


if __name__ == "__main__":
    main()
