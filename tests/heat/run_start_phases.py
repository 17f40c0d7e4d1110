#!/usr/bin/env python3
"""Bodies that begin with a mixture of phases (START PHASES).

usage: run_start_phases.py [-v] [-k]

- `heated`: pearlite and ferrite held above Ac3 become austenite as 1 - exp(-t/tau), in proportion, then martensite by Koistinen and Marburger; the change of
  length from the start is that of the phases: with META, and with ARBTHMET that follows the kinetics itself.
- `retained`: austenite beside martensite transforms only below the temperature that has left it, Ms + ln(z_a)/BETA.
- `two`: each of two bodies has its own mixture. What is wrong in the card is refused.
"""
import math
import os
import sys

sys.dont_write_bytecode = True
TESTS = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path[:0] = [os.path.join(TESTS, folder) for folder in ("runs",)]
from support import DONE, Checks, history, run, said, write  # noqa: E402

MS, BETA, TAU, AC1, AC3, ALPHA, DEPS = 300.0, 0.011, 5.0, 720.0, 800.0, (22e-6, 14e-6, 12e-6), (0.0, 0.008, 0.0105)
STEEL = f"""STEEL  s
SOURCE 'made up, for tests'
TEMPS  MS {MS:g} AC1 {AC1:g} AC3 {AC3:g}
AUSTEN {TAU:g} {TAU:g}
MARTEN BETA {BETA:g}
EXPAND TOTAL 20
PHASE  ALL
   LAMBDA 30
   RHOC   4.5
   E      200000
   NU     0.3
PHASE  AUSTENITE
   ALPHA  {ALPHA[0]:g}
PHASE  FERRITE
   ALPHA  {ALPHA[1]:g}
   DEPS   {DEPS[1]:g}
PHASE  PEARLITE
   ALPHA  {ALPHA[1]:g}
   DEPS   {DEPS[1]:g}
PHASE  MARTENSITE
   ALPHA  {ALPHA[2]:g}
   DEPS   {DEPS[2]:g}
END
"""
DECK = """TITLE  Phases at the start
STATE  AXISYM
KINEM  SMALL
BLOCK  a PL8LS 4 steel
   0. 0.   1. 0.   1. 1.   0. 1.
   1 1.   1 1.
BLOCK  b PL8LS 4 steel
   2. 0.   3. 0.   3. 1.   2. 1.
   1 1.   1 1.
LAW    steel ARBTHMET
   STEEL s.met s
   STRESS 1.   TIME {own}
{heat}
{start}
FIXED  a 1 Y
FIXED  a 4 X
FIXED  b 1 Y
STRAT  0.5 1.E-4 0.5   9 3
STOP   {stop}
SAVE   1000
PROBE  length NODE UY 1. 1.
PROBE  za POINT austenite 0.5 0.5
PROBE  zf POINT ferrite 0.5 0.5
PROBE  zp POINT pearlite 0.5 0.5
PROBE  zm POINT martensite 0.5 0.5
PROBE  other POINT martensite 2.5 0.5
END
"""
FIELD = """ADDEL  a PL8TM heat BILINEAR
ADDEL  b PL8TM heat BILINEAR
LAW    heat META
   STEEL s.met s
   ENERGY 1.
START  T {first}
IMPOS  a 1 T way
IMPOS  a 3 T way
IMPOS  b 1 T way
IMPOS  b 3 T way
LIC    way
   {way}"""
GIVEN = "TEMPE  a 1. way\nTEMPE  b 1. way\nLIC    way\n   {way}"


def deck(checks, name, way, stop, start, own, steel=STEEL):
    first = way.split()[1]
    text = DECK.format(own=f"{own:g}", heat=(GIVEN if own else FIELD).format(first=first, way=way), start=start, stop=stop)
    write(checks.path(name, "s.met"), steel)
    return run([write(checks.path(name, "a.lag"), text), "--out", checks.path(name, "out"), "--threads", "1"])


def rows_of(checks, name, *arguments):
    result = deck(checks, name, *arguments)
    return history(checks.path(name, "out")) if checks.that(result.returncode == DONE, f"{name}: runs", said(result)) else None


def heated(checks, own):
    """The jump to 850 degC is at once, so the time above Ac1 is that of the hold."""
    name = f"heated_{own}"
    rows = rows_of(checks, name, "0. 20.   0.01 850.   6. 850.   6.01 20.   7. 20.", 7., "START  PHASES PEARLITE 0.7 FERRITE 0.3", own)
    if not rows:
        return
    at = min(range(len(rows["time"])), key=lambda k: abs(rows["time"][k] - 6.0))
    z = 1 - math.exp(-(rows["time"][at] - 0.01*(1 - (AC3 - 20)/830))/TAU)
    checks.that(abs(rows["za"][at] - z) < 2e-3, f"{name}: austenite", (rows["za"][at], z))
    checks.that(abs(rows["zf"][at]/rows["zp"][at] - 3/7) < 1e-9, f"{name}: in proportion", rows["zf"][at]/rows["zp"][at])
    length = z*ALPHA[0]*830 + (1 - z)*(ALPHA[1]*830 + DEPS[1]) - DEPS[1]
    checks.that(abs(rows["length"][at] - length) < 3e-5, f"{name}: length", (rows["length"][at], length))
    formed = rows["za"][at]*(1 - math.exp(-BETA*(MS - 20)))
    checks.that(abs(rows["zm"][-1] - formed) < 1e-3, f"{name}: martensite", (rows["zm"][-1], formed))


def retained(checks):
    coldest = MS + math.log(0.2)/BETA
    rows = rows_of(checks, "retained", "0. 400.   10. 100.", 10., "START  PHASES MARTENSITE 0.8 AUSTENITE 0.2 a\nSTART  PHASES PEARLITE 1. b", 0)
    if not rows:
        return
    for k, time in enumerate(rows["time"]):
        t = 400 - 30*time
        left = 0.2*math.exp(-BETA*max(0.0, coldest - t))
        if not checks.that(abs(rows["za"][k] - left) < 1e-9, "retained: austenite", (t, rows["za"][k], left)):
            break
    checks.that(max(rows["other"]) == 0, "two: the other body has its own", max(rows["other"]))


def refused(checks):
    for start, say in (("START  PHASES PEARLITE 0.7 FERRITE 0.2", "add up to 0.9"), ("START  PHASES PEARLITE 0.5 PEARLITE 0.5", "given twice"),
                       ("START  PHASES PERLITE 1.", "expected a phase"), ("START  PHASES PEARLITE 1.2", "at most 1"),
                       ("START  PHASES PEARLITE 1.\nSTART  PHASES FERRITE 1. a", "are given twice"), ("START  PHASES PEARLITE 1. c", "name of a body")):
        result = deck(checks, "refused", "0. 400.   10. 100.", 10., start, 0)
        checks.that(result.returncode == 2 and say in said(result), f"refused: {start!r}", said(result))
    for own in (0, 1):
        result = deck(checks, "refused", "0. 400.   10. 100.", 10., "START  PHASES PEARLITE 1.", own, STEEL.replace("TEMPS", "TEMP", 1))
        checks.that(result.returncode == 2 and "s.met:3:1" in said(result), "refused: a steel with mistakes that bodies with phases at the start are of", said(result))


def without_data(checks):
    """Phases that the steel has no numbers of, and that would not form, are refused: nothing would conduct heat, or take it up."""
    for own, kept, say in ((0, "", ("begins with phases without numbers: ", "no LAMBDA of FERRITE; ", "either RHOC or H of FERRITE", "no E of FERRITE", "no ALPHA of FERRITE")),
                           (1, "", ("no E of FERRITE; ", "no DEPS of FERRITE")), (0, "PHASE FERRITE\n   LAMBDA 30\n   RHOC 4.5\n", ("no E of FERRITE",)),
                           (0, "PHASE FERRITE\n   LAMBDA 30\n   RHOC 4.5\n   E 200000\n   NU 0.3\n   ALPHA 14E-6\n   DEPS 0.008\n", ())):
        steel = STEEL.replace("PHASE  ALL", "PHASE  AUSTENITE").split("\nPHASE  FERRITE")[0]
        steel += ("\nPHASE  MARTENSITE\n   LAMBDA 30\n   RHOC 4.5\n   E 200000\n   NU 0.3\n   ALPHA 12E-6\n   DEPS 0.0105\n" + kept + "END\n")
        result = deck(checks, "without", "0. 400.   10. 390.", 10., "START  PHASES FERRITE 1.", own, steel)
        told = said(result)
        checks.that(result.returncode == (2 if say else DONE) and all(words in told for words in say), f"phases without numbers, {own}, {kept!r}", (result.returncode, told))


def main():
    checks = Checks()
    heated(checks, 0)
    heated(checks, 1)
    retained(checks)
    refused(checks)
    without_data(checks)
    checks.end()


if __name__ == "__main__":
    main()
