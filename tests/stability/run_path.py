#!/usr/bin/env python3
"""Errors that come of the path within steps: bounded by default, and estimated as large as they are.

usage: run_path.py [-v] [-k] [--cost]       -v prints every check, -k keeps the results; --cost times shipped decks with the bounds
                                            and without (seconds of the processor)

`bounded`: a necking bar and the relaxation of a held bar, with long steps allowed. Errors against the bar's converged force and
against the law's own differential equation (Runge and Kutta), with steps that are not bounded by them (`before`: PATH 0 RATE 0),
and by default. `estimated`: the same and an upset billet with steps of one length, PATH and RATE being wide: what the run tells
over the error against a run of short steps (`effectivity`), of the motion in the mean square over the nodes, of the stress as its own.
`carried`: the error of the stress that the closing table tells, over the difference to a run with steps of 1/16, where a load rises, rests,
goes on more slowly, turns and lets go: tubes under pressure, bent beams, a cantilever with a moved end, plastic and in creep; a cylinder that cools, its temperatures known.
`begun`: after elastic steps those in which flow begins have an estimate. `heated`: the same of cylinders whose temperatures, and phases, are found by implicit Euler: their errors are in that of the stress; `elastic`: the same where no law flows.
`tight`: bounds of 1/16 and 1/64. `free`: elastic and uniform plastic bars take the steps they take without bounds, elastic ones on any way. Long steps that a deck allows end with a warning.
"""
import csv
import json
import os
import re
import subprocess
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), os.pardir, "patch"))
from patch_support import LAGAMINE, SOURCE, STRESS, Checks, Run, np  # noqa: E402

CARRIED = (0.5, 3.0)     # told over true errors of the stress
HEATED = (0.5, 2.0)      # the same where temperatures make most of them
ALLOWED = 0.01           # of the necking force at 5 mm, and of the relaxed stress
FACTOR = 3.0             # of an estimate, up and down
WIDE = "NORMS  PATH 0.9 RATE 0.9\n"
OFF = "NORMS  PATH 0 RATE 0\n"

HELD = """TITLE  A bar that is pulled at once and held
STATE  PLSTS
KINEM  SMALL
BLOCK  bar PL8LS 4 m
   0. 0.   1. 0.   1. 1.   0. 1.
   1 1.   1 1.
LAW    m {law}
FIXED  bar 1 Y
FIXED  bar 4 X
LIC    pull
   0. 0.   {ramp} {strain}   {end} {strain}
MOVE   bar 3 Y pull
STRAT  {first} 1.E-7 {step}   40 3
PROBE  force REACT Y bar 3
{more}END
"""
YOUNG, STRAIN, RAMP, END = 200000.0, 0.002, 0.01, 1.01
# Name, law, and its rate of flow at a stress.
CREEP = [("Norton, m = 0.15", f"EVP-NH\n   {YOUNG} 0.3\n   0. 120. 0.15 0.",
          lambda s: (s/(120*3**0.5))**(1/0.15)/3**0.5),
         ("Norton, m = 0.5", f"EVP-NH\n   {YOUNG} 0.3\n   0. 400. 0.5 0.",
          lambda s: (s/(400*3**0.5))**(1/0.5)/3**0.5),
         ("Cowper and Symonds", f"EPLA\n   {YOUNG} 0.3\n   LINEAR 60. 0.\n   RATE0 0.1 COWPER 2.",
          lambda s: 0.1*max(s/60 - 1, 0)**2)]

BILLET = """TITLE  Half a billet that sticks to its die
STATE  AXISYM
KINEM  LOG
BLOCK  billet PL8LS 4 steel
   0. 0.   10. 0.   10. 15.   0. 15.
   6 1.   9 1.
LAW    steel EPLA
   200000. 0.3
   LINEAR 300. 500.
FIXED  billet 1 Y
FIXED  billet 4 X
FIXED  billet 3 X
LIC    press
   0. 0.   1. 1.
MOVE   billet 3 Y press -4.
STRAT  {step} 1.E-6 {step}   40 3
PROBE  force REACT Y billet 3
{more}END
"""

FREE = """TITLE  A bar whose stress is the same everywhere
STATE  {state}
KINEM  LOG
BLOCK  bar PL8LS 4 m
   0. 0.   1. 0.   1. 2.   0. 2.
   2 1.   2 1.
LAW    m {law}
FIXED  bar 1 Y
FIXED  bar 4 X
LIC    pull
   0. 0.   1. 1.   2. 0.
MOVE   bar 3 Y pull 0.5
STRAT  0.05 1.E-6 0.05   40 3
PROBE  force REACT Y bar 3
{more}END
"""

TUBE = """TITLE  A tube under pressure
STATE  AXISYM
KINEM  LOG
BLOCK  part PL8LS 4 m
   10. 0.   25. 0.   25. 5.   10. 5.
   4 1.   2 1.
LAW    m {law}
FIXED  part 1 3 Y
PRES2D part 4 3 {load} p
LIC    p
   {way}
{more}STRAT  {step} 1.E-6 {step}   40 3
END
"""

BEAM = """TITLE  A beam that is clamped at one end
STATE  {state}
KINEM  {kinematics}
BLOCK  part PL8LS 4 m
   0. 0.   60. 0.   60. 6.   0. 6.
   8 1.   2 1.
LAW    m {law}
FIXED  part 4 XY
{load}
LIC    q
   {way}
{more}STRAT  {step} 1.E-6 {step}   40 3
END
"""

EPLA = "EPLA\n   200000. 0.3\n   LINEAR 300. {}"
NORTON = "EVP-NH\n   200000. 0.3\n   0. {} {} 0."
# Deck, what stands in it, and the longest step.
WAYS = {
    "tube": (TUBE, {"law": EPLA.format("500."), "load": "280.", "way": "0. 0.   1. 1."}, 0.05),
    "tube, near its limit": (TUBE, {"law": EPLA.format("500."), "load": "300.", "way": "0. 0.   1. 1."}, 0.05),
    "tube, held": (TUBE, {"law": EPLA.format("500."), "load": "280.", "way": "0. 0.   1. 1.   2. 1."}, 0.1),
    "tube, let go": (TUBE, {"law": EPLA.format("500."), "load": "280.", "way": "0. 0.   1. 1.   1.5 0."}, 0.1),
    "tube, a corner": (TUBE, {"law": EPLA.format("500."), "load": "290.", "way": "0. 0.   1. .9   2. 1."}, 0.1),
    "tube, again": (TUBE, {"law": EPLA.format("500."), "load": "270.", "way": "0. 0.   1. 1.   1.5 0.5   2.5 1.05"}, 0.1),
    "beam, held": (BEAM, {"law": EPLA.format("2000."), "state": "PLSTS 5.", "kinematics": "LOG", "load": "TRACT  part 2 Y -14. q",
                          "way": "0. 0.   1. 1.   1.5 1."}, 0.05),
    "beam, small strain": (BEAM, {"law": EPLA.format("2000."), "state": "PLSTS 5.", "kinematics": "SMALL", "load": "TRACT  part 2 Y -11. q",
                                  "way": "0. 0.   1. .9   2. 1."}, 0.1),
    "cantilever, held": (BEAM, {"law": EPLA.format("1000."), "state": "PLSTN", "kinematics": "LOG", "load": "MOVE   part 2 Y q -6.",
                                "way": "0. 0.   1. 1.   1.5 1."}, 0.1),
    "cantilever, turned": (BEAM, {"law": EPLA.format("1000."), "state": "PLSTN", "kinematics": "LOG", "load": "MOVE   part 2 Y q -6.",
                                  "way": "0. 0.   1. 1.   2. 0."}, 0.1),
    "cantilever, relaxes": (BEAM, {"law": NORTON.format(120, 0.15), "state": "PLSTN", "kinematics": "LOG", "load": "MOVE   part 2 Y q -1.",
                                   "way": "0. 0.   0.1 1.   1.1 1."}, 0.02),
    "beam, creeps": (BEAM, {"law": NORTON.format(120, 0.15), "state": "PLSTS 5.", "kinematics": "LOG", "load": "TRACT  part 2 Y -2. q",
                            "way": "0. 0.   0.1 1.   1.1 1."}, 0.02),
    "tube, creeps": (TUBE, {"law": NORTON.format(120, 0.15), "load": "40.", "way": "0. 0.   0.1 1.   1.1 1.   1.2 0.   2. 0."}, 0.02),
}

COOLED = """TITLE  A cylinder that is quenched
STATE  AXISYM
KINEM  SMALL
BLOCK  part {element} 4 m{order}
   0. 0.   25. 0.   25. 40.   0. 40.
   6 0.4   4 2.
LAW    m {law}
{more}STRAT  {first} 1.E-5 {step}   40 3
STOP   30.
END
"""
STEEL = os.path.join(SOURCE, "decks", "residual_stress", "hot.met")
HEAT = f"META\n   STEEL {STEEL} stable\n   ENERGY 1.\nSTART  T 800.\nCONVE  part 2 3 H 5. TS 20.\nSAVE   1"
HOT = f"ARBTHMET\n   STEEL {STEEL} stable\n   STRESS 1.   TIME 1.\nTEMPE  part FROM heat/heat.g01.h5\nFIXED  part 1 Y\nFIXED  part 4 X"

# A cylinder whose heat is found with the stress: file and steel, law for the mechanics, exchange, and the end.
HARDENING = os.path.join(SOURCE, "decks", "quench_bar_trip", "hardening.met")
QUENCHED = """TITLE  A cylinder that is quenched
STATE  AXISYM
KINEM  SMALL
BLOCK  part PL8LS 4 m
   0. 0.   15. 0.   15. 24.   0. 24.
   6 0.4   4 2.
LAW    m ARBTHMET
   STEEL {steel}
   STRESS 1.   {own}
ADDEL  part PL8TM heat BILINEAR
LAW    heat META
   STEEL {steel}
   ENERGY 1.
START  T 850.
FIXED  part 1 Y
FIXED  part 4 X
CONVE  part 2 3 H {exchange} TS 20.
STRAT  0.02 1.E-5 {step}   40 3
STOP   {end}
{more}END
"""
QUENCHES = {
    "no phases": ({"steel": f"{STEEL} stable", "own": "TIME 1.", "exchange": 3., "end": 12.}, 0.5),
    "phases of the heat": ({"steel": f"{HARDENING} hardening", "own": "", "exchange": 1., "end": 24.}, 1.0),
    "phases of its own": ({"steel": f"{HARDENING} hardening", "own": "TIME 1.", "exchange": 1., "end": 24.}, 1.0),
    "cold, in air": ({"steel": f"{HARDENING} hardening", "own": "", "exchange": 0.3, "end": 300.}, 2.0),
}

# A sheet, free: it has no stress, through martensite and its plasticity too.
DILATOMETER = f"""TITLE  A sheet that cools evenly
STATE  PLSTS
KINEM  SMALL
BLOCK  part PL8LS 4 m
   0. 0.   5. 0.   5. 10.   0. 10.
   1 1.   1 1.
LAW    m ARBTHMET
   STEEL {HARDENING} hardening
   STRESS 1.   {{own}}
ADDEL  part PL8TM heat BILINEAR
LAW    heat META
   STEEL {HARDENING} hardening
   ENERGY 1.
START  T 850.
IMPOS  part 1 2 3 4 T cool
LIC    cool
   0. 850.   100. 20.
FIXED  part 1 Y
FIXED  part 4 X
PROBE  length NODE UY 0. 10.
STRAT  0.1 1.E-6 2.   40 3
{{more}}END
"""

# A plate that a torch crosses: nothing moves before, and all flows within a few steps.
CROSSED = f"""TITLE  A plate that a torch crosses
STATE  GPLSTN 1.
KINEM  LOG
BLOCK  part PL8LS 4 m
   0. 0.   20. 0.   20. 6.   0. 6.
   8 4.   4 0.5
LAW    m ARBTHMET
   STEEL {STEEL} stable
   STRESS 1.   TIME 1.
ADDEL  part PL8TM heat BILINEAR
LAW    heat META
   STEEL {STEEL} stable
   ENERGY 1.
START  T 20.
SECTN  E FREE
SECTN  KX HELD
SECTN  KY FREE
FIXED  part 4 X
FIXED  POINT 20. 0. Y
GOLDAK part P 0.7E6 ETA 0.8 FRONT 3. REAR 6. WIDTH 4. DEPTH 4. INTO 0. -1. CROSS 6. 4.
   0. 0. 6.
CONVE  part 1 2 3 H 0.03 TS 20.
THETA  TRBDF2 TOL {{tol}}
STRAT  0.01 1.E-6 20.   14 9   0.25 1.5
STOP   4.5
END
"""

# Another side goes to and fro meanwhile.
BENT = """LIC    aside
   0. 0.   0.7 0.   1.3 1.   2. -1.
MOVE   bar 2 X aside 0.03
"""


def relaxed(flow, steps=400000):
    """Stress at the end: s' = E (strain rate - flow(s)), by the fourth-order rule of Runge and Kutta."""
    stress = 0.0
    for length, rate in ((RAMP, STRAIN/RAMP), (END - RAMP, 0.0)):
        n = steps//10
        # short steps first: the rate falls by decades
        times = length*np.linspace(0, 1, n + 1)**3 if rate == 0 else length*np.linspace(0, 1, n + 1)
        for dt in np.diff(times):
            def slope(s):
                return YOUNG*(rate - flow(s))
            a = slope(stress)
            b = slope(stress + dt/2*a)
            c = slope(stress + dt/2*b)
            stress += dt/6*(a + 2*b + 2*c + slope(stress + dt*c))
    return stress


def converged():
    """Force of the shipped bar at 5 mm, of its converged runs [N]."""
    with open(os.path.join(SOURCE, "decks", "necking", "reference.csv"), newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            if (row["quantity"], row["at"]) == ("force", "end=5"):
                return float(row["expected"])
    raise KeyError("end=5")


def necking(step, more="", nopti=5, first=4):
    """The shipped bar to 5 mm, coarse along and across, with steps of up to this length of the time."""
    with open(os.path.join(SOURCE, "decks", "necking", "necking.lag"), encoding="utf-8") as file:
        text = file.read()
    text = re.sub(r"(?m)^STRAT .*\n", f"STRAT  $dt/{first} 1.E-6 $dt   {nopti} 3\n{more}", re.sub(r"(?m)^SAVE .*\n", "", text))
    for name, value in (("nx", 6), ("ny", 18), ("pull", 5), ("dt", step)):
        text = re.sub(rf"(?m)^PARAM  {name} .*\n", f"PARAM  {name} {value}\n", text)
    return text


def held(law, step, more="", first=0.001):
    """The held bar."""
    return HELD.format(law=law, ramp=RAMP, strain=STRAIN, end=END, first=min(first, step), step=step, more=more)


def summary(run):
    """The checks in summary.json, and how many steps."""
    with open(os.path.join(run.out, "summary.json"), encoding="utf-8") as file:
        whole = json.load(file)
    return whole["checks"], whole["steps"], whole["advice"]


def bounded(checks):
    """Errors with the bounds as they are by default."""
    print(f"{'bounded':22s} {'steps':>6s} {'before':>9s} {'error':>9s} {'told':>9s}")

    def row(name, deck, true):
        off, run = (Run(checks, "bounded", deck(more)) for more in (OFF, ""))
        if not (off.ok and run.ok):
            return
        was, error = (abs(one.history["force"][-1]/true - 1) for one in (off, run))
        values, steps, advice = summary(run)
        told = max(values["path_error_motion"], values["path_error_stress"])
        print(f"{name:22s} {steps:6d} {was:9.5f} {error:9.5f} {told:9.5f}")
        checks.small(error, ALLOWED, f"{name}: error")
        checks.that(not any(key.startswith("path") for key in advice), f"{name}: no warning", advice)

    for parts in (15, 25, 30):
        row(f"necking 1/{parts}", lambda more, n=parts: necking(1/n, more), converged())
    for name, law, flow in CREEP:
        row(name, lambda more, law=law: held(law, 0.1, more), relaxed(flow))


def estimated(checks):
    """Estimates over errors, with steps of one length."""
    print(f"\n{'estimated':22s} {'steps':>6s} {'error':>9s} {'estimate':>9s} {'effectivity':>11s}")

    def row(name, steps, error, estimate):
        print(f"{name:22s} {steps:6d} {error:9.5f} {estimate:9.5f} {estimate/error:11.2f}")
        checks.that(1/FACTOR <= estimate/error <= FACTOR, f"{name}, {steps} steps: effectivity", estimate/error)

    def motions(name, deck, lengths, finest):
        """Motion at the end, against that of the finest run, over what was moved in sum."""
        fine = Run(checks, f"{name}-fine", deck(finest, OFF))
        for length in lengths:
            run = Run(checks, name, deck(length, WIDE))
            if not (fine.ok and run.ok):
                continue
            values, steps, _ = summary(run)
            u, v = run.displacement(), fine.displacement()
            # the motions of the steps go one way: their sum is the displacement
            row(f"{name}: motion", steps, np.sqrt(((u - v)**2).sum()/(v**2).sum()), values["path_error_motion"])

    motions("necking", lambda step, more: necking(step, more, nopti=40, first=1), (1/30, 1/60, 1/120), 1/960)
    motions("upsetting", lambda step, more: BILLET.format(step=step, more=more), (1/20, 1/40), 1/800)
    for name, law, flow in CREEP:
        true = relaxed(flow)
        for step in (0.1, 0.02):
            run = Run(checks, "held", held(law, step, WIDE))
            if run.ok:
                values, steps, _ = summary(run)
                row(name, steps, abs(run.history["force"][-1]/true - 1), values["path_error_stress"])


def energy(stress):
    """Root of the sum of the elastic energies of stresses (n, 4), but for a factor; nu = 0.3."""
    xx, yy, xy, zz = stress.T
    return np.sqrt((1.3*(xx**2 + yy**2 + zz**2 + 2*xy**2) - 0.3*(xx + yy + zz)**2).sum())


def compare(checks, title, name, deck, words, runs, shortest, exactly, bounds):
    """Told errors of the stress at the end of runs of a deck (length of the step, cards more), against what they differ by from the run
    in the shortest steps, with cards of its own; the ratio of both is within bounds."""
    reference = Run(checks, f"{title}-fine", deck.format(step=shortest, more=exactly, **words))
    if not reference.ok:
        return
    truth = reference.state("part", *STRESS)
    for length, more in runs:
        run = Run(checks, title, deck.format(step=length, more=more, **words))
        if not run.ok:
            continue
        with open(os.path.join(run.out, "summary.json"), encoding="utf-8") as file:
            whole = json.load(file)
        told, true = whole["accuracy"]["path"], 100*energy(run.state("part", *STRESS) - truth)/energy(truth)
        ratio = told["stress_pct"]/true
        print(f"{name:22s} {whole['steps']:6d} {true:9.4f} {told['stress_pct']:9.4f} {ratio:11.2f}")
        checks.that("stress_known" not in told and bounds[0] <= ratio <= bounds[1], f"{name}, {whole['steps']} steps: told error of the stress", ratio)


def carried(checks):
    """Errors of the stress at the end against those of short steps."""
    print(f"\n{'carried':22s} {'steps':>6s} {'error %':>9s} {'told %':>9s} {'effectivity':>11s}")
    heat = Run(checks, "heat", COOLED.format(element="PL8TM", order=" BILINEAR", law=HEAT, more="THETA  TRBDF2\n", first=0.01, step=0.25))
    cooled = {"cylinder, cools": (COOLED, {"element": "PL8LS", "order": "", "law": HOT, "first": 0.02}, 1.0)} if heat.ok else {}
    for name, (deck, words, step) in {**WAYS, **cooled}.items():
        compare(checks, "carried", name, deck, words, ((step, WIDE), (step/2, WIDE), (step, "")), step/16, OFF, CARRIED)


LAYERS = """TITLE  A strip of an elastic layer and one that flows, bent, held, let go and held
STATE  PLSTN
KINEM  LOG
BLOCK  a PL8LS 4 hard
   0. 0. 40. 0. 40. 1. 0. 1.
   20 1. 2 1.
BLOCK  b PL8LS 4 soft
   0. 1. 40. 1. 40. 2. 0. 2.
   20 1. 2 1.
JOIN   a 3 b 1
LAW    hard ELA
   200000. 0.3
LAW    soft EPLA
   70000. 0.33
   LINEAR 50. 700.
FIXED  a 4 XY
FIXED  b 4 XY
TRACT  a 2 Y 4. push
TRACT  b 2 Y 4. push
LIC    push
   0. 0. 1. 1. 3. 1. 4. 0. 6. 0.
STRAT  {step} 1.E-5 {step} 20 4
PROBE  tip NODE UY 40. 0.
END
"""


def layered(checks):
    """A layer that does not flow bears what the errors of the motion strain it by: while nothing moves they do not grow."""
    run, fine = (Run(checks, f"layers-{step:g}", LAYERS.format(step=step)) for step in (0.05, 0.003))
    if run.ok and fine.ok:
        tip = run.history["tip"]
        true = abs(tip[-1] - fine.history["tip"][-1])/np.sum(np.abs(np.diff(tip)))
        told = summary(run)[0]["path_error_motion"]
        print(f"{'layers':22s} {len(tip):6d} {100*true:9.4f} {100*told:9.4f} {told/true:11.2f}")
        checks.that(1/FACTOR <= told/true <= FACTOR, "layers: told error of the motion", told/true)


def heated(checks):
    """Errors of the stress at the end, with those of temperatures and phases, against those of short steps of TR-BDF2."""
    print(f"\n{'heated':22s} {'steps':>6s} {'error %':>9s} {'told %':>9s} {'effectivity':>11s}")
    for name, (words, step) in QUENCHES.items():
        compare(checks, "heated", name, QUENCHED, words, ((step, WIDE), (step/4, WIDE), (step, "")), step/16, "THETA  TRBDF2\n" + OFF, HEATED)


def elastic(checks):
    """The same where no law flows: the stress of a cylinder that cools errs by what its temperatures do."""
    law = "LAW    m ELATH\n   TEMP 0.\n   210000. 0.3 1.E-5\n   TEMP 600.\n   150000. 0.3 1.6E-5\n"
    heat = "LAW    heat HEAT\n   30. 4.5\n"
    deck = re.sub(r"(?m)^LAW    heat .*\n.*\n.*\n", heat, re.sub(r"(?m)^LAW    m .*\n.*\n.*\n", law, QUENCHED)).replace("T 850.", "T 500.")
    fine = Run(checks, "elastic-fine", deck.format(exchange=3., end=10., step=0.03, more="THETA  TRBDF2\n"))
    if not fine.ok:
        return
    truth = fine.state("part", *STRESS)
    for step, more in ((0.5, ""), (0.5, "SOLVE  MONOLITHIC\n"), (1.0, "THETA  TRBDF2\n")):
        run = Run(checks, "elastic-heated", deck.format(exchange=3., end=10., step=step, more=more))
        if not run.ok:
            continue
        with open(os.path.join(run.out, "summary.json"), encoding="utf-8") as file:
            told = json.load(file)["accuracy"]["heat"].get("stress_pct", 0)
        true = 100*energy(run.state("part", *STRESS) - truth)/energy(truth)
        print(f"{'elastic':22s} {len(run.history['step']):6d} {true:9.4f} {told:9.4f} {told/true:11.2f}")
        checks.that(HEATED[0] <= told/true <= HEATED[1], f"elastic, {step:g} s, {more.split()[-1:]}: told error of the stress", told/true)


def begun(checks):
    """Steps in which flow begins after elastic ones have an estimate: they have no error to go by."""
    for tol in (20., 5.):
        run = Run(checks, "begun", CROSSED.format(tol=tol))
        if run.ok:
            first = next(k for k, work in enumerate(run.history["plastic_work"]) if work > 0)
            told = run.history["path_error_motion"][first]
            checks.that(told > 1e-3, f"begun, TOL {tol:g}: error of the motion of the first step that flows", told)


def tight(checks):
    """Bounds of 1/16 and 1/64 of the default: they are kept, at four times the steps, and few attempts are made in vain."""
    print(f"\n{'tight':22s} {'bound':>9s} {'steps':>6s} {'in vain':>8s} {'told':>9s} {'error':>9s}")
    for name, law, flow in (CREEP[0], CREEP[2]):
        steps, errors = [], []
        for factor in (16, 64):
            path, rate = 0.04/factor, 0.008/factor
            run = Run(checks, "tight", held(law, 0.1, f"NORMS  PATH {path} RATE {rate}\n"))
            if not run.ok:
                return
            values, count, _ = summary(run)
            steps.append(count)
            errors.append(abs(run.history["force"][-1]/relaxed(flow) - 1))
            vain = values["steps_shortened_by_path"]
            print(f"{name:22s} {rate:9.6f} {count:6d} {vain:8d} {values['path_error_stress']:9.6f} {errors[-1]:9.6f}")
            checks.that(values["path_error_stress"] <= 1.001*rate, f"{name} / {factor}: the bound is kept", values["path_error_stress"])
            checks.small(errors[-1], 1.1*rate, f"{name} / {factor}: the error of the force too")
            checks.that(vain <= 0.15*count, f"{name} / {factor}: attempts in vain", (vain, count))
        checks.that(steps[1] <= 4.5*steps[0], f"{name}: a quarter of the error in four times the steps", steps)


def free(checks):
    """Steps of runs without such errors."""
    for state in ("PLSTN", "AXISYM", "PLSTS"):
        for law in ("ELA\n   200000. 0.3", "EPLA\n   200000. 0.3\n   LINEAR 300. 500."):
            runs = [Run(checks, "free", FREE.format(state=state, law=law, more=more)) for more in (OFF, "")]
            if all(run.ok for run in runs):
                name = f"{law.split()[0]} {state}"
                steps = [len(run.history["step"]) for run in runs]
                checks.that(steps[1] <= 1.15*steps[0], f"{name}: steps", steps)
                checks.that(runs[0].history["force"][-1] == runs[1].history["force"][-1] or steps[0] != steps[1],
                            f"{name}: the same bits in the same steps")
    for own in ("", "TIME 1."):
        off, run = (Run(checks, "dilatometer", DILATOMETER.format(own=own, more=more)) for more in (OFF, ""))
        if off.ok and run.ok:
            steps = [len(one.history["step"]) for one in (off, run)]
            checks.that(steps[1] <= 3*steps[0], f"a sheet without stress, {own}: steps", steps)
            martensite = 1 - np.exp(-0.015*280)
            checks.small(run.history["length"][-1]/10 - (martensite*0.0105 - 22e-6*830), 1e-9, "its length")
            values, _, advice = summary(run)
            checks.that(not any(key.startswith("path") for key in advice), "no warning", values)
    for kinematics in ("LOG", "SMALL"):
        text = FREE.format(state="PLSTN", law="EPLA\n   200000. 0.3\n   LINEAR 1.E9 500.", more=BENT).replace("KINEM  LOG", f"KINEM  {kinematics}").replace("pull 0.5", "pull 0.05")
        run = Run(checks, "elastic", text)
        if run.ok:
            values, _, _ = summary(run)
            checks.small(max(values["path_error_motion"], values["path_error_stress_worst"]), 1e-9, f"elastic, {kinematics}: no error")
            checks.that(values["steps_shortened_by_path"] == 0, f"elastic, {kinematics}: no step is shortened")
    off = Run(checks, "off", FREE.format(state="PLSTN", law="EPLA\n   200000. 0.3\n   LINEAR 300. 500.", more=OFF))
    checks.that("path_error_motion" not in off.history, "without bounds nothing is estimated")


def warned(checks):
    """Long steps that the deck allows are told."""
    for name, text, key in (("necking", necking(1/12, WIDE, nopti=40, first=1), "path_error_motion"),
                            ("held", held(CREEP[0][1], 0.5, WIDE, first=0.01), "path_error_stress")):
        run = Run(checks, name, text)
        if run.ok:
            values, _, advice = summary(run)
            checks.that(key in advice, f"{name}: a warning", values[key])


COST = ("upsetting/upsetting", "ring/ring", "forging_rib/forging_rib", "stamping/draw", "extrusion/extrusion_cone",
        "hot_upsetting/hot_upsetting", "plastic_forming/squeeze", "punch/punch")


def cost(checks):
    """Seconds of the processor for shipped decks with the bounds and without, the least of three runs each."""
    print(f"{'deck':26s} {'steps':>6s} {'without':>8s} {'s':>8s} {'without':>8s} {'ratio':>6s} {'motion':>8s} {'stress':>8s}")
    for deck in COST:
        path = os.path.join(SOURCE, "decks", deck + ".lag")
        with open(path, encoding="utf-8") as file:
            text = file.read()
        plain = re.sub(r"(?m)^STRAT ", OFF + "STRAT ", text) if "\nNORMS " not in text else \
            re.sub(r"(?m)^NORMS +", OFF.strip() + " ", text)
        off = os.path.join(os.path.dirname(path), f".without-{os.getpid()}.lag")
        try:
            with open(off, "w", encoding="utf-8") as file:
                file.write(plain)
            seconds, found = {path: [], off: []}, {}
            for _ in range(3):
                for which in (path, off):
                    out = os.path.join(checks.folder, "cost")
                    start = os.times()
                    code = subprocess.run([LAGAMINE, which, "--out", out, "--threads", "1", "--quiet"], check=False,
                                          stdin=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode
                    end = os.times()
                    seconds[which].append(end.children_user + end.children_system - start.children_user - start.children_system)
                    checks.that(code in (0, 4), f"{deck}: exit code", code)
                    with open(os.path.join(out, "summary.json"), encoding="utf-8") as file:
                        found[which] = json.load(file)
        finally:
            os.unlink(off)
        now, then = min(seconds[path]), min(seconds[off])
        values = found[path]["checks"]
        print(f"{deck:26s} {found[path]['steps']:6d} {found[off]['steps']:8d} {now:8.2f} {then:8.2f} {now/then:6.2f} "
              f"{values['path_error_motion']:8.5f} {values['path_error_stress']:8.5f}", flush=True)


def main():
    checks = Checks()
    if "--cost" in sys.argv[1:]:
        cost(checks)
    else:
        bounded(checks)
        estimated(checks)
        carried(checks)
        layered(checks)
        heated(checks)
        elastic(checks)
        begun(checks)
        tight(checks)
        free(checks)
        warned(checks)
    checks.end()


if __name__ == "__main__":
    main()
