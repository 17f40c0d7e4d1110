#!/usr/bin/env python3
"""Solid laws from the card to the history: a cylinder pulled, turned about, heated or held, against closed forms.

usage: run_laws.py [-v] [-k]       -v prints every check, -k keeps the results

The cylinder is 1 x 1, free around, held along its axis at the lower end: the stress along y is uniaxial and the same everywhere,
and so every value below is exact but for the step in time where the law depends on the rate.
"""
import math
import sys

sys.dont_write_bytecode = True
from support import DONE, Checks, history, run, said, summary, write  # noqa: E402

DECK = """TITLE  Cylinder under uniaxial stress
STATE  AXISYM
KINEM  {kinem}
BLOCK  rod PL8LS 4 m
   0. 0.   1. 0.   1. 1.   0. 1.
   2 1.   2 1.
FIXED  rod 1 Y
FIXED  rod 4 X
NORMS  FORCE 1.E-10   ITMAX 12
PROBE  stress POINT stress_yy 0.5 0.5
PROBE  top NODE UY 0. 1.
{cards}
END
"""
PULL = "MOVE   rod 3 Y pull\nLIC    pull\n   "
HEAT = "TEMPE  rod 1. heat\nLIC    heat\n   "
E, NU = 200000.0, 0.3


def rod(checks, name, kinem, cards):
    """Run one deck; history and summary, or nothing when it failed."""
    deck = write(checks.path(name + ".lag"), DECK.format(kinem=kinem, cards=cards))
    result = run([deck, "--out", checks.path(name), "--quiet"])
    if not checks.that(result.returncode == DONE, f"{name} runs", said(result)):
        return None, None
    table = history(checks.path(name))
    checks.that(max(table["iterations"]) <= 8, f"{name}: Newton's method converges", table["iterations"])
    return table, summary(checks.path(name))


def near(checks, what, value, expected, tolerance=1.0e-8):
    """A value against its closed form, relative."""
    checks.that(abs(value - expected) <= tolerance * abs(expected), what, f"{value!r}, expected {expected!r}")


def thermal(checks):
    """ELATH held at both ends, and free; alpha linear in the temperature."""
    law = f"LAW    m ELATH\n   TEMP 0.\n   {E} {NU} 1.E-5\n   TEMP 1000.\n   {E / 2} {NU} 2.E-5\n"
    strain = 1.0e-5 * 600 + 0.5 * 1.0e-8 * 600**2
    young = E * (1 - 0.5 * 0.6)
    heat = HEAT + "0. 0.   1. 600.\nSTRAT  0.1 1.E-3 0.1   4 3"
    for kinem, volume in (("SMALL", 1.0), ("LOG", math.exp(-strain * (1 - 2 * NU)))):
        table, _ = rod(checks, "held_" + kinem, kinem, law + PULL + "0. 0.\n" + heat)
        if table:
            near(checks, f"held, {kinem}", table["stress"][-1], -young * strain / volume)
        table, _ = rod(checks, "free_" + kinem, kinem, law + heat)
        if table:
            near(checks, f"free, {kinem}", table["top"][-1], strain if kinem == "SMALL" else math.expm1(strain))
            checks.that(abs(table["stress"][-1]) < 1.0e-8 * E * strain, f"free, {kinem}: no stress", table["stress"][-1])


def cycles(checks):
    """EPLA with linear kinematic hardening: pulled and pushed; work is kept, dissipated, or elastic."""
    yielding, hkin, reach = 400.0, 20000.0, 0.02
    cards = f"LAW    m EPLA\n   {E} {NU}\n   LINEAR {yielding} 0.\n   HKIN {hkin}\n" + PULL \
        + f"0. 0.   1. {reach}   2. -{reach}   3. {reach}\nSTRAT  0.02 1.E-4 0.02   4 3"
    for kinem in ("SMALL", "LOG"):
        table, outcome = rod(checks, "cycles_" + kinem, kinem, cards)
        if not table:
            continue
        for time, side in ((1.0, 1), (2.0, -1), (3.0, 1)):
            k = min(range(len(table["time"])), key=lambda k: abs(table["time"][k] - time))
            strain = side * reach if kinem == "SMALL" else math.log1p(side * reach)
            # stress = side RE + HKIN (strain - stress/E); with LOG that is Kirchhoff's
            stress = (side * yielding + hkin * strain) / (1 + hkin / E)
            if kinem == "LOG":
                stress /= math.exp(stress / E * (1 - 2 * NU))
            near(checks, f"cycles, {kinem}, time {time}", table["stress"][k], stress)
        energy = [table[name][-1] for name in ("external_work", "elastic_energy", "plastic_work")]
        checks.that(abs(energy[0] - energy[1] - energy[2]) < 1.0e-3 * energy[0], f"cycles, {kinem}: energy", energy)
        checks.that(outcome["energy"]["elastic"] > 0, f"cycles, {kinem}: energy is kept")


def softening_by_heat(checks):
    """EPLA, perfectly plastic, held and heated: the stress is the yield stress of the temperature."""
    law = f"LAW    m EPLA\n   TEMP 20.\n   {E} {NU}\n   LINEAR 400. 0.\n   TEMP 520.\n   {E} {NU}\n   LINEAR 150. 0.\n"
    table, _ = rod(checks, "softening", "SMALL", law + PULL + "0. 0.   1. 0.01\n" + HEAT + "0. 20.   1. 20.   2. 220.\n"
                   + "STRAT  0.1 1.E-3 0.1   4 3")
    if table:
        near(checks, "held and heated", table["stress"][-1], 400.0 - 0.4 * 250.0)


def steady_flow(checks):
    """Laws with a rate, pulled at a constant one until the stress stands: the rate of flow is that of the pull."""
    rate = 0.05
    pull = PULL + f"0. 0.   1. {rate}\nSTRAT  0.01 1.E-6 0.02   4 3"
    norton = 120.0 * math.sqrt(3.0) * (math.sqrt(3.0) * rate)**0.15
    sharp = 300.0 * math.sqrt(3.0) * (math.sqrt(3.0) * rate)**0.005
    polymer = 0.5 * math.exp(2000.0 / 400.0) * rate**0.06
    cases = [("EVP-NH", f"{E} {NU}\n   0. 120. 0.15 0.", "", norton),
             ("EVP-NH", f"{E} {NU}\n   0. 300. 0.005 0.", "", sharp),
             ("GSELL", "20000. 0.4\n   0.5 2000. 0. 0.06 2000. 300.", HEAT + "0. 100.\n", polymer),
             ("EPLA", f"{E} {NU}\n   LINEAR 300. 0.\n   RATE0 40. COWPER 5.", "", 300.0 * (1 + (rate / 40.0)**0.2)),
             ("EPLA", f"{E} {NU}\n   LINEAR 300. 0.\n   RATE0 1.E-3 JOHNSON 0.02", "", 300.0 * (1 + 0.02 * math.log(rate / 1e-3)))]
    for number, (law, rows, heat, stress) in enumerate(cases):
        table, outcome = rod(checks, f"steady_{number}", "SMALL", f"LAW    m {law}\n   {rows}\n" + heat + pull)
        if table:
            near(checks, f"steady flow, {law} {number}", table["stress"][-1], stress, 1.0e-6)
            energy = [table[name][-1] for name in ("external_work", "elastic_energy", "plastic_work")]
            checks.that(abs(energy[0] - energy[1] - energy[2]) < 0.01 * energy[0], f"steady flow {number}: energy", energy)


def main():
    """All laws."""
    checks = Checks()
    thermal(checks)
    cycles(checks)
    softening_by_heat(checks)
    steady_flow(checks)
    checks.end()


main()
