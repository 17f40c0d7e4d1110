#!/usr/bin/env python3
"""Heat of the last step of an operation: SOLVE ONCE releases the work of a step in the next one, of whichever operation that is.

usage: run_last_heat.py [-v] [-k]

- `drawn`: a block drawn over a die, which is gone in the next operation, or without FRIC there, or goes on: all work of friction becomes
  heat, as it does by the other ways of coupling; in bodies it is found again, with a rigid die its share is gone. Large and small
  strains, in a plane and around an axis, four and nine points, with a new mesh in the next operation too.
- `pulled`: plastic work of an operation whose law has QUINNEY becomes heat in the next one without it; work that was done without
  QUINNEY makes none later.
- The end of a run says what is left (`heat_due`). The same bits after a stop.
"""
import os
import signal
import sys

sys.dont_write_bytecode = True
TESTS = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path[:0] = [os.path.join(TESTS, folder) for folder in ("runs", "cycle")]
from remeshed import cycle  # noqa: E402
from support import DONE, SIGNAL, Checks, history, result_differences, run, said, start, stop_after, summary, with_h5py, write  # noqa: E402

BLOCK = """TITLE  A block drawn over a die
STATE  {state}
KINEM  {kinem}
BLOCK  b PL8LS {points} steel
   2. 0.  12. 0.  12. 5.  2. 5.
   6 1.  3 1.
LAW    steel EPLA
   200000. 0.3
   LINEAR 300. 500.
ADDEL  b PL8TM hot {kind}
START  T 20.
STRAT  0.02 1.E-6 0.05   4 3
NORMS  FORCE 1.E-10 DISPL 1.E-10
CKPT   3
"""
DRAW = """LAW    rough COUL2D
   PENETR 1.E-3   PHI 0.3
CNT2D  b 1 under {rule} rough
MOVE   b 3 X slide {way}
MOVE   b 3 Y press -0.02
LIC    press
   0. 0.  0.1 1.  1. 1.
LIC    slide
   0. 0.  0.1 0.  1. 1.
STOP   1.
SOLVE  {solve}
"""
HOT = "LAW    hot HEAT\n   40. 4.\n"
RIGID = "DIE    under PILOT 0. 0.\n   SEGM -50. 0.  50. 0.\n"
OTHER = ("BLOCK  u PL8LS {points} steel\n   1. -4.  20. -4.  20. 0.  1. 0.\n   9 1.  2 1.\nADDEL  u PL8TM warm {kind}\nLAW    warm HEAT\n"
         "   90. 1.\nFIXED  u 1 XY\n")
REST = "OPERA  rest\nFIXED  b 3 XY\nSTOP   0.2\n"
TDIE = "TDIE   under T 20. C 500.\n"


def done(checks, name, text, by=run):
    """A deck run to its end: its path, its folder, its history."""
    deck, out = write(checks.path(name + ".lag"), text + "END\n"), checks.path(name)
    result = by([deck, "--out", out, "--threads", "1"]) if by is run else by(deck, out, "--quiet")
    if not checks.that(result.returncode == DONE, f"{name} ends", said(result)):
        return deck, out, None
    return deck, out, history(out)


def last_of(rows, number):
    """The last row of an operation."""
    return len(rows["operation"]) - 1 - rows["operation"][::-1].index(number)


def books(checks, name, rows, share=1.0):
    """All work of friction has become heat, and the bodies have it, or a share of the last step's."""
    if rows is None:
        return
    end = last_of(rows, 1)
    work, released, stored = rows["friction_work"][end], rows["heat_released"], rows["heat_stored"]
    left = work - released[end]
    checks.that(work > 100 and left > 0.01*work, f"{name}: the last step has made heat", (work, left))
    checks.that(abs(released[-1]/work - 1) < 1e-8, f"{name}: all work of friction becomes heat", (released[-1], work))
    checks.that(abs((stored[-1] - stored[end])/left - share) < 1e-6, f"{name}: the bodies take it up", (stored[-1] - stored[end], left))
    checks.that(abs(rows["heat_imbalance"][-1]) < 1e-8, f"{name}: books of heat", rows["heat_imbalance"][-1])


def drawn(checks):
    """Friction."""
    cases = [("plane", "PLSTN", "LOG", 4, "BILINEAR"), ("small", "PLSTN", "SMALL", 9, ""), ("axis", "AXISYM", "LOG", 4, ""),
             ("nine", "AXISYM", "LOG", 9, "BILINEAR")]
    for name, state, kinem, points, kind in cases:
        # a ring that is drawn inwards becomes thicker, and stays on the die
        way = 1.5 if state == "PLSTN" else -0.8
        head = BLOCK.format(state=state, kinem=kinem, points=points, kind=kind) + HOT
        draw = DRAW.format(rule=-3, way=way, solve="ONCE")
        rigid = RIGID + TDIE + "COU2DC b 1 under H 0. FRIC 1. SHARE 0.3\n" + draw
        deck, out, rows = done(checks, name, head + "OPERA  draw\n" + rigid + REST)
        books(checks, name, rows, 0.3)
        if rows is None:
            continue
        told = summary(out, "summary.draw.json")["energy"]["heat_due"]
        end = last_of(rows, 1)
        checks.that(abs(told/(rows["friction_work"][end] - rows["heat_released"][end]) - 1) < 1e-8, f"{name}: told at the end", told)
        checks.that(abs(summary(out)["energy"]["heat_due"]) < 1e-12*told, f"{name}: nothing is left", summary(out)["energy"]["heat_due"])
        under = OTHER.format(points=points, kind=kind)
        both = "COU2DC b 1 under H 5. FRIC 1.\n" + DRAW.format(rule="", way=way, solve="ONCE")
        deck, out, rows = done(checks, name + "-bodies", head + under + "OPERA  draw\n" + "DIE    under SIDES u 3\n" + both + REST)
        books(checks, name + "-bodies", rows)
        if name == "plane" and rows:
            again(checks, name, deck, out, end + 1)
            again(checks, name, deck, out, end + 2)
    # the contact goes on, by the same way of coupling and another, and without FRIC
    head = BLOCK.format(state="PLSTN", kinem="LOG", points=4, kind="BILINEAR") + HOT + RIGID + TDIE
    share = "COU2DC b 1 under H 0. {} SHARE 0.3\n"
    draw = DRAW.format(rule=-3, way=1.5, solve="ONCE")
    stay = "LAW    rough COUL2D\n   PENETR 1.E-3   PHI 0.3\nCNT2D  b 1 under -3 rough\nFIXED  b 3 XY\nSTOP   0.2\n"
    for solve in ("ONCE", "MONOLITHIC"):
        _, _, rows = done(checks, "goes-on-" + solve, head + "OPERA  draw\n" + share.format("FRIC 1.") + draw + "OPERA  stay\n"
                          + share.format("FRIC 1.") + stay + f"SOLVE  {solve}\n")
        if rows:
            checks.that(abs(rows["heat_released"][-1]/rows["friction_work"][-1] - 1) < 1e-6, f"goes on, {solve}: all work becomes heat",
                        (rows["heat_released"][-1], rows["friction_work"][-1]))
    _, _, rows = done(checks, "without", head + "OPERA  draw\n" + share.format("FRIC 1.") + draw + "OPERA  stay\n"
                      + "COU2DC b 1 under H 0.\n" + stay)
    books(checks, "without", rows, 0.3)
    # a new mesh in the next operation
    text = head + "OPERA  draw\n" + share.format("FRIC 1.") + draw + REST.replace("STOP", "REMSH\n   SIZE 0.8 2.\n   TIMES 0.1\nSTOP")
    text = text.replace("CKPT   3\n", "").replace(RIGID + TDIE, "").replace("OPERA  draw\n", "OPERA  draw\n" + RIGID + TDIE)
    _, _, rows = done(checks, "new-mesh", text, cycle)
    books(checks, "new-mesh", rows, 0.3)


def again(checks, name, deck, whole, row):
    """Stopped after a row of the history, and resumed."""
    out = checks.path(f"{name}-stopped-{row}")
    code, _, stderr = stop_after(start([deck, "--out", out, "--threads", "1"]), out, row, signal.SIGTERM, 0)
    checks.that(code in (SIGNAL + signal.SIGTERM, DONE), f"{name}: stopped after {row} rows", f"{code} {stderr}")
    if code != DONE:
        result = run([deck, "--out", out, "--threads", "1", "--resume", os.path.join(out, os.path.basename(deck)[:-4] + ".ckp.h5")])
        checks.that(result.returncode == DONE, f"{name}: resumed after {row} rows", said(result))
    wrong = result_differences(whole, out)
    checks.that(not wrong, f"{name}: after {row} rows as in one go", "; ".join(wrong))


def pulled(checks):
    """Plastic work."""
    pull = "FIXED  b 4 X\nFIXED  b 1 Y\nMOVE   b 2 X pull 1.\nLIC    pull\n   0. 0. 1. 1.\nSTOP   1.\n"
    hold = "FIXED  b 4 X\nFIXED  b 1 Y\nSTOP   0.2\n"
    quinney = HOT + "   QUINNEY 0.9\n"
    for name, first, second in (("both", quinney, quinney), ("first", quinney, HOT), ("second", HOT, quinney)):
        for state in ("PLSTN", "AXISYM"):
            # the bar in the ring of an axisymmetric scene is free at its bore
            head = BLOCK.format(state=state, kinem="LOG", points=9, kind="")
            _, _, rows = done(checks, f"{name}-{state}", head + "OPERA  pull\n" + first + pull + "OPERA  hold\n" + second + hold)
            if rows is None:
                continue
            wanted = 0.9*rows["plastic_work"][-1] if name != "second" else 0.0
            checks.that(abs(rows["heat_released"][-1] - wanted) < 2e-5*rows["plastic_work"][-1], f"{name}, {state}: heat of plastic work",
                        (rows["heat_released"][-1], wanted))
            checks.that(abs(rows["heat_imbalance"][-1]) < 1e-8, f"{name}, {state}: books of heat", rows["heat_imbalance"][-1])


def main():
    with_h5py()
    checks = Checks()
    drawn(checks)
    pulled(checks)
    checks.end()


if __name__ == "__main__":
    main()
