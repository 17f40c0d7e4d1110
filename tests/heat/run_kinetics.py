#!/usr/bin/env python3
"""Kinetics of phases in the balance of heat: books, what is there at the start, the end of a curve, the error in time.

usage: run_kinetics.py [-v] [-k]

- `books`: heat taken up is that of the phases there are, by their own RHOC; what is released is their latent heat. Martensite and mixtures that are
  heated release nothing; austenite that is quenched releases the latent heat of its martensite. On corners and on eight nodes.
- `cold`: retained austenite beside martensite at room temperature stays when it is heated, in steps of any length, with META and with ARBTHMET; austenite
  that begins below Ms has the martensite of its first temperature.
- `top`: bainite whose latent heat lifts the temperature to the end of its curve, where growth ends: no step is shortened, at any length, on any mesh, and
  runs by steps of 10, 2 and 0.5 s agree.
- `cycle`: quenched, tempered, made austenite again, twice: no heat is left, without LATENT of TEMPERED and with any; with unlike heat capacities it is so where
  LATENT follows them (Kirchhoff), and otherwise `--check` tells how much is made in a cycle.
- `conducted`: heat is conducted by the phases of the instant at which it flows: TR-BDF2 is of second order where they differ in LAMBDA.
- `error`: the largest error in time that is told is 0.8 to 2 times that of the run, where latent heat of pearlite is most of it.
- `left`: what is told to be left of the errors is 0.7 to 1.4 times that, while pearlite grows and after it.
"""
import os
import sys

sys.dont_write_bytecode = True
TESTS = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path[:0] = [os.path.join(TESTS, folder) for folder in ("runs",)]
from math import exp  # noqa: E402
from support import DONE, Checks, history, run, said, summary, write  # noqa: E402

MS, BETA, LATENT = 350.0, 0.015, 600.0
OWN = {"AUSTENITE": 5.0, "MARTENSITE": 3.0, "PEARLITE": 4.0}
STEELS = f"""STEEL  two
SOURCE 'made up, for tests'
TEMPS  MS {MS:g}
MARTEN BETA {BETA:g}
EXPAND TOTAL 20
PHASE  ALL
   LAMBDA 30
   E      200000
   NU     0.3
   ALPHA  12E-6
PHASE  AUSTENITE
   RHOC   {OWN['AUSTENITE']:g}
PHASE  PEARLITE
   RHOC   {OWN['PEARLITE']:g}
   DEPS   0.004
PHASE  MARTENSITE
   RHOC   {OWN['MARTENSITE']:g}
   LATENT {LATENT:g}
   DEPS   0.01
STEEL  bainitic
SOURCE 'made up, for tests; fast up to the end of its curve'
TEMPS  BS 385
AVRAMI BAINITE 0 385 ZERO VOLUME
   LNB   TABLE 250 -17.1  320 -13.3  350 -10.7  385 -8.2
   N     TABLE 250 3.5  320 2.9  350 2.6  385 2.6
   START TABLE 250 210  300 48  350 13.2  385 8
PHASE  ALL
   LAMBDA 30
   RHOC   4.2
PHASE  BAINITE
   LATENT 980
STEEL  pearlitic
SOURCE 'made up, for tests'
TEMPS  AE3 800 AE1 720
AVRAMI PEARLITE 400 700
   LNB   TABLE 400 -8  700 -6
   N     2.5
PHASE  ALL
   LAMBDA 30
   RHOC   4
PHASE  PEARLITE
   LATENT 400
STEEL  early
SOURCE 'made up, for tests: nothing grows below the lowest row'
TEMPS  AE1 725  AE3 780
TTT    PEARLITE ZERO
   450 100 2000
   500 20 300
   600 10 100
   700 100 3000
PHASE  ALL
   LAMBDA 30
   RHOC   4.5
PHASE  PEARLITE
   LATENT 600
STEEL  conducting
SOURCE 'made up, for tests: martensite conducts three times as well'
TEMPS  MS 350
MARTEN BETA 0.015
PHASE  ALL
   RHOC   4
PHASE  AUSTENITE
   LAMBDA 15
PHASE  MARTENSITE
   LAMBDA 45
   LATENT 640
END
"""
DECK = """TITLE  {title}
STATE  PLSTN
KINEM  SMALL
BLOCK  w PL8TM 4 m {nodes}
   0. 0.   {size} 0.   {size} {size}   0. {size}
   {n} 1.   {n} 1.
LAW    m META
   STEEL k.met {steel}
   ENERGY 1.
{cards}
PROBE  t MEAN T w
{probes}
END
"""
SLOWLY = "START  T {start}\nCONVE  w 2 H {h} TS {ts}\nSTRAT  {strat}\nSTOP   {stop}\nTHETA  {theta}"


def rows_of(checks, name, steel, cards, probes, nodes="BILINEAR", size=10., n=2):
    """History of a deck that must run to its end; None where it does not."""
    write(checks.path(name, "k.met"), STEELS)
    text = DECK.format(title=name, nodes=nodes, size=size, n=n, steel=steel, cards=cards, probes="\n".join(f"PROBE  {p} MEAN {p} w" for p in probes))
    result = run([write(checks.path(name, "a.lag"), text), "--out", checks.path(name, "out"), "--threads", "1"])
    return history(checks.path(name, "out")) if checks.that(result.returncode == DONE, f"{name}: runs", said(result)) else None


def books(checks):
    """100 of area: heated by 200 K at 60 000 of pure martensite."""
    for nodes in ("BILINEAR", ""):
        for number, shares in enumerate(({"MARTENSITE": 1.0}, {"MARTENSITE": 0.4, "PEARLITE": 0.6}, {"AUSTENITE": 0.3, "MARTENSITE": 0.7})):
            name = f"books_{nodes.lower() or 'eight'}_{number}"
            capacity = sum(share*OWN[phase] for phase, share in shares.items())
            start = "START  PHASES " + " ".join(f"{phase} {share:g}" for phase, share in shares.items())
            rows = rows_of(checks, name, "two", f"START  T 20.\n{start}\nFLUX   w 2 Q {capacity*20:g}\nSTRAT  0.5 0.1 1. 5 3\nSTOP   100.", ["martensite"], nodes)
            if not rows:
                continue
            stored, released = rows["heat_stored"][-1], rows["heat_released"][-1]
            checks.that(abs(stored/(capacity*200*100) - 1) < 1e-9, f"{name}: taken up", (stored, capacity*2e4))
            checks.that(abs(released) < 1e-9*stored, f"{name}: released", released)
            checks.that(max(map(abs, rows["heat_imbalance"])) < 1e-9, f"{name}: imbalance", max(map(abs, rows["heat_imbalance"])))
        name = f"books_quench_{nodes.lower() or 'eight'}"
        rows = rows_of(checks, name, "two", "START  T 500.\nCONVE  w 2 H 1. TS 20.\nSTRAT  0.1 1.E-4 1. 5 3\nSTOP   150.", ["martensite"], nodes)
        if not rows:
            continue
        formed = 100*LATENT*rows["martensite"][-1]
        checks.that(abs(rows["heat_released"][-1]/formed - 1) < 1e-3, f"{name}: latent heat", (rows["heat_released"][-1], formed))
        checks.that(max(map(abs, rows["heat_imbalance"])) < 1e-6, f"{name}: imbalance", max(map(abs, rows["heat_imbalance"])))


def cold(checks):
    """From 20 to 220 degC in 1, 5 and 40 steps."""
    formed = 1 - exp(-BETA*(MS - 20))
    for steps in (1, 5, 40):
        for start, expected in (("START  PHASES AUSTENITE 0.5 MARTENSITE 0.5\n", 0.5), ("", formed)):
            name = f"cold_{steps}_{'mixture' if start else 'austenite'}"
            rows = rows_of(checks, name, "two", f"START  T 20.\n{start}IMPOS  w 2 T way\nIMPOS  w 4 T way\nLIC    way\n   0. 20.   10. 220.\n"
                           f"STRAT  {10/steps} 1.E-3 {10/steps} 9 3\nSTOP   10.", ["martensite"], n=1)
            if rows:
                checks.that(all(abs(z - expected) < 1e-12 for z in rows["martensite"][1:]), f"{name}: martensite", rows["martensite"][-1])
    text = """TITLE  cold, by the law itself
STATE  AXISYM
KINEM  SMALL
BLOCK  a PL8LS 4 steel
   0. 0.   1. 0.   1. 1.   0. 1.
   1 1.   1 1.
LAW    steel ARBTHMET
   STEEL k.met two
   STRESS 1.   TIME 1.
TEMPE  a 1. way
LIC    way
   0. 20.   10. 220.
START  PHASES MARTENSITE 0.5 AUSTENITE 0.5
FIXED  a 1 Y
FIXED  a 4 X
STRAT  5. 1.E-4 5.   9 3
STOP   10.
PROBE  martensite MEAN martensite a
END
"""
    write(checks.path("cold_own", "k.met"), STEELS)
    result = run([write(checks.path("cold_own", "a.lag"), text), "--out", checks.path("cold_own", "out"), "--threads", "1"])
    if checks.that(result.returncode == DONE, "cold_own: runs", said(result)):
        rows = history(checks.path("cold_own", "out"))
        checks.that(abs(rows["martensite"][-1] - 0.5) < 1e-12, "cold_own: martensite", rows["martensite"][-1])


def top(checks):
    """The temperature stays within the last kelvins of the curve for most of the run."""
    found = {}
    for name, step, n, nodes, theta in (("top_short", 0.5, 4, "BILINEAR", "TRBDF2"), ("top_middle", 2., 4, "BILINEAR", "TRBDF2"), ("top_long", 10., 4, "BILINEAR", "TRBDF2"),
                                        ("top_one", 2., 1, "", "TRBDF2"), ("top_fine", 2., 8, "", "TRBDF2"), ("top_euler", 2., 4, "", "1.")):
        cards = SLOWLY.format(start=850., h=1., ts=330., strat=f"{step} 1.E-5 {step} 8 3", stop=500., theta=theta)
        rows = rows_of(checks, name, "bainitic", cards, ["bainite"], nodes, 20., n)
        if not rows:
            continue
        found[name] = rows["bainite"][-1]
        checks.that(max(rows["cutbacks"]) == 0, f"{name}: no step is shortened", max(rows["cutbacks"]))
        checks.that(max(t for t, time in zip(rows["t"], rows["time"]) if time > 300) > 380, f"{name}: near the end of the curve", max(rows["t"][-20:]))
        checks.that(max(rows["iterations"][1:]) <= 15, f"{name}: iterations", max(rows["iterations"][1:]))
    if "top_short" in found:
        for name, z in found.items():
            checks.that(abs(z - found["top_short"]) < 0.01, f"{name}: bainite as by short steps", (z, found["top_short"]))


def error(checks):
    """20 mm through pearlite, from within a step to the whole of it."""
    cards = SLOWLY.format(start=720., h=0.5, ts=400., strat="{strat}", stop=40., theta="{theta}")
    for nodes, n in (("BILINEAR", 4), ("", 3)):
        word = nodes.lower() or "eight"
        reference = rows_of(checks, f"error_{word}_fine", "pearlitic", cards.format(strat="0.05 1.E-5 0.05 8 3", theta="TRBDF2"), ["pearlite"], nodes, 20., n)
        for theta in ("TRBDF2 TOL 0.3", "TRBDF2 TOL 0.1", "TRBDF2 TOL 0.03", "TRBDF2 TOL 0.01", "1. TOL 0.1"):
            name = f"error_{word}_{theta.replace(' ', '_')}"
            rows = rows_of(checks, name, "pearlitic", cards.format(strat="0.1 1.E-5 200. 20 9 0.25 4.", theta=theta), ["pearlite"], nodes, 20., n)
            if not (rows and reference):
                continue
            largest = max(abs(t - between(reference["time"], reference["t"], time)) for time, t in zip(rows["time"], rows["t"]))
            told = summary(checks.path(name, "out"))["checks"]["error_in_time_largest"]
            checks.that(0.8*largest < told < 2*largest, f"{name}: told and found", (told, largest))


def left(checks):
    """Within the growth of pearlite and after it: what steps of one length have left of their errors, phases that are behind catching up."""
    for stop in (100, 200):
        cards = SLOWLY.format(start=850., h=0.1, ts=20., strat="0.02 1.E-5 {step} 40 3", stop=stop, theta="{theta}")
        reference = rows_of(checks, "left_fine", "early", cards.format(step=0.2, theta="TRBDF2"), ["pearlite"], "BILINEAR", 10., 2)
        for theta in ("1.", "TRBDF2"):
            rows = rows_of(checks, f"left_{theta}", "early", cards.format(step=4., theta=theta), ["pearlite"], "BILINEAR", 10., 2)
            if not (rows and reference):
                return
            found, told = abs(rows["t"][-1] - reference["t"][-1]), summary(checks.path(f"left_{theta}", "out"))["accuracy"]["heat"]["end"]
            checks.that(0.7*found < told < 1.4*found, f"left: {theta}, {stop} s: told and found", (told, found, reference["pearlite"][-1]))


def conducted(checks):
    """20 mm hardened through, in steps of 0.4 and 0.2 s of TR-BDF2: the error of the mean temperature falls with the square of the step."""
    cards = SLOWLY.format(start=850., h=2., ts=20., strat="0.02 1.E-5 {step} 40 3", stop=30., theta="TRBDF2")
    found = {}
    for step in (0.02, 0.2, 0.4):
        rows = rows_of(checks, f"conducted_{step:g}", "conducting", cards.format(step=step), ["martensite"], "BILINEAR", 20., 4)
        if not rows:
            return
        found[step] = rows["t"][-1]
    ratio = (found[0.4] - found[0.02])/(found[0.2] - found[0.02])
    checks.that(3 < ratio < 5.5, "conducted: errors of steps of 0.4 s over those of 0.2 s", (ratio, found))


def between(times, values, time):
    """Linear between the rows of a history."""
    k = max(1, next((k for k, other in enumerate(times) if other >= time), len(times) - 1))
    return values[k - 1] + (values[k] - values[k - 1])*(time - times[k - 1])/(times[k] - times[k - 1])


CYCLED = """STEEL  cycled
SOURCE 'made up, for tests'
TEMPS  AC1 730 AC3 800 MS 300
MARTEN BETA 0.02
AUSTEN 1. 0.2
TEMPER
   MARTENSITE 1.E9 1.2E5 0.5
PHASE  ALL
   LAMBDA 30
PHASE  AUSTENITE
   RHOC   4.5
PHASE  MARTENSITE
   RHOC   {own:g}
   LATENT {latent}
PHASE  TEMPERED
   RHOC   {own:g}
{tempered}END
"""
CYCLES = """START  T 850.
IMPOS  w 1 2 3 4 T way
LIC    way
   0. 850.      100. 20.    200. 600.    1000. 600.   1100. 850.   1200. 850.
   1300. 20.    1400. 600.  2200. 600.   2300. 850.   2400. 850.
STRAT  5. 1.E-5 5. 5 3
STOP   2400."""

COOLED_ONCE = """START  T 850.
IMPOS  w 1 2 3 4 T way
LIC    way
   0. 700.      100. 20.
STRAT  5. 1.E-5 5. 5 3
STOP   200."""


def cycle(checks):
    """1 of area, twice through martensite at 300 to 20 degC, tempered at 600, austenite from 730 degC on."""
    for name, own, latent, tempered, closed in (("as it was", 4.5, "640", "", 1e-9), ("its own", 4.5, "640", "   LATENT 700\n", 1e-9),
                                                ("Kirchhoff", 3.6, "POLY 370 0.9", "", 2e-3), ("unlike", 3.6, "640", "", None)):
        folder = "cycle_" + name.replace(" ", "_")
        write(checks.path(folder, "k.met"), CYCLED.format(own=own, latent=latent, tempered=tempered))
        text = DECK.format(title=name, nodes="BILINEAR", size=1., n=1, steel="cycled", cards=CYCLES, probes="PROBE  tempered MEAN tempered w")
        deck = write(checks.path(folder, "a.lag"), text)
        told = "MJ/m3 of heat of nothing in each cycle" in run([deck, "--check"]).stdout
        checks.that(told == (closed is None), f"{name}: told before the run" if told else f"{name}: nothing is told before the run")
        if closed is None:
            write(deck, text.replace(CYCLES, COOLED_ONCE))
            checks.that("in each cycle" not in run([deck, "--check"]).stdout, f"{name}: nothing is told of a quench")
        result = run([deck, "--out", checks.path(folder, "out"), "--threads", "1"])
        if closed is None or not checks.that(result.returncode == DONE, f"{name}: runs", said(result)):
            continue
        rows = history(checks.path(folder, "out"))
        checks.that(max(rows["tempered"]) > 0.9, f"{name}: tempered", max(rows["tempered"]))
        checks.that(abs(rows["heat_in"][-1]) < closed*640, f"{name}: heat over two cycles", rows["heat_in"][-1])


def main():
    checks = Checks()
    books(checks)
    cycle(checks)
    cold(checks)
    top(checks)
    error(checks)
    left(checks)
    conducted(checks)
    checks.end()


if __name__ == "__main__":
    main()
