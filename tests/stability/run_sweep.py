#!/usr/bin/env python3
"""Dies that move further in a step than a side's search for them reaches: none goes through a part unseen.

usage: run_sweep.py [-v] [-k]       -v prints every check, -k keeps the results

`one step`: a flat die that a card moves by half the block's height in a single step, beside the same in 100 steps. `soft spring`: a die
under a force that only a weak spring holds before it meets the block; beside the press that is moved to the same force. `rib`: a closed
die, thinner than a side is long, whose way ends below the block: the run must not end with 0. `slide`: a block that slides along a
curved floor by two sides a step passes nothing, and takes no more steps than its deck asks for. `round`: a round die that a force
takes over a gap onto the block, its bottom between two pieces over a node, free along X, to turn, or both as well; how far it goes in
beside the same die that begins without a gap, less one.
The table has the error of the die's force (`rib`: the exit code, `slide`: the steps too many), of the code before the sweep of a step
was searched (`before`, measured by this script), and now.
"""
import os
import subprocess
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), os.pardir, "patch"))
from patch_support import LAGAMINE, Checks, Run, np  # noqa: E402

BLOCK = """TITLE die and block
STATE {state}
KINEM LOG
BLOCK b PL8LS 4 m
   0. 0. 10. 0. 10. 10. 0. 10.
   {n} 1. {n} 1.
LAW m ELA
   1000. 0.3
LAW c COUL2D
   PENETR 1.E-3 PHI {phi}
DIE d PILOT {pilot}
{die}CNT2D b {side} d -3 c
{more}END
"""
HELD = "FIXED b 1 Y\nFIXED b 4 X\n"
FLAT = "   SEGM 14. 12. -2. 12.\n"
RIB = "   SEGM 8. 12. 2. 12.\n   SEGM 2. 12. 2. 13.\n   SEGM 2. 13. 8. 13.\n   SEGM 8. 13. 8. 12.\n"
FLOOR = "   ARC -30. 0. 20. -2.2 70. 0. 1.E-4\n"
FORCE = 0.01             # of a force against the same reached in small steps
STATES = ("PLSTN", "AXISYM")


def force_of(checks, name, more, state, n=4, phi=0.1):
    """The die's force in the end; not a number where the run failed."""
    run = Run(checks, name, BLOCK.format(state=state, n=n, phi=phi, pilot="0. 12.", die=FLAT, side=3, more=HELD + more))
    return (run.history["force_y_d"][-1], run) if run.ok else (np.nan, None)


def one_step(checks, state, n, travel):
    """Error of the force of a die moved in one step."""
    card = f"LIC w\n   0. 0. 1. 1.\nMOVE d Y w -{travel}\nSTRAT %s 1.E-6 %s 5 3\n"
    fine, _ = force_of(checks, f"fine-{state}-{n}-{travel}", card % (0.01, 0.01), state, n)
    coarse, _ = force_of(checks, f"coarse-{state}-{n}-{travel}", card % (1.0, 1.0), state, n)
    return abs(coarse/fine - 1)


def soft_spring(checks, state, spring):
    """Error of the force that a spring and the block hold together, at the place that the die has found."""
    card = f"SPRNG d Y {spring}\nFORCE d Y -500. w\nLIC w\n   0. 0. 1. 1.\nSTRAT 1. 1.E-6 1. 5 3\n"
    _, run = force_of(checks, f"spring-{state}-{spring}", card, state, phi=0)
    if run is None:
        return np.nan
    travel = -float(run.history["displacement_y_d"][-1])
    card = f"LIC w\n   0. 0. 1. 1.\nMOVE d Y w -{travel!r}\nSTRAT .02 1.E-6 .02 5 3\n"
    moved, _ = force_of(checks, f"moved-{state}-{spring}", card, state, phi=0)
    return abs((500 - spring*travel)/moved - 1) if moved > 0 else 1.0


def round_die(checks, free, gap):
    """How far a round die goes into the block under a force."""
    def point(a):
        return f"{5 + 5*np.cos(a):.15g} {15 + gap + 5*np.sin(a):.15g}"
    arcs = "".join(f"   ARC {point(k*np.pi/2)} {point((k - 0.5)*np.pi/2)} {point((k - 1)*np.pi/2)} 1.E-3\n" for k in (4, 3, 2, 1))
    more = ("FIXED b 1 XY\nFORCE d Y -5. w\n" + "".join(f"FREE d {c}\n" for c in free)
            + "LIC w\n   0. 0. 1. 1.\nSTRAT .02 1.E-6 .05 5 3\n")
    run = Run(checks, f"round-{free}-{gap}", BLOCK.format(state="PLSTN", n=8, phi=0.1, pilot=f"5. {15 + gap}", die=arcs, side=3, more=more))
    return -run.history["displacement_y_d"][-1] - gap if run.ok else np.nan


def rib(checks):
    """Exit code of a die that would have to cut the block."""
    text = BLOCK.format(state="PLSTN", n=4, phi=0.1, pilot="5. 12.", die=RIB, side=3,
                        more=HELD + "LIC w\n   0. 0. 1. 1.\nMOVE d Y w -40.\nSTRAT 1. 1.E-3 1. 5 3\n")
    path = os.path.join(checks.folder, "rib.lag")
    with open(path, "w", encoding="utf-8") as deck:
        deck.write(text)
    return subprocess.run([LAGAMINE, path, "--out", os.path.join(checks.folder, "rib"), "--threads", "1", "--quiet"], check=False,
                          stdin=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=120).returncode


def slide(checks):
    """Steps beyond the 10 that the deck asks for."""
    more = "MOVE d X w -50.\nFIXED b 3 X\nFIXED b 3 Y\nLIC w\n   0. 0. 1. 1.\nSTRAT .1 1.E-6 .1 5 3\n"
    run = Run(checks, "slide", BLOCK.format(state="PLSTN", n=4, phi=0.0, pilot="0. 0.", die=FLOOR, side=1, more=more))
    return run.history["step"][-1] - 10 if run.ok else np.nan


def main():
    checks = Checks()
    rows = []
    for state, n, travel, before in (("PLSTN", 4, 5.0, 1.0), ("PLSTN", 8, 4.5, 1.0), ("AXISYM", 4, 5.0, 1.0), ("PLSTN", 3, 5.5, 1.0)):
        rows.append((f"one step {state.lower()} {n} {travel:g}", before, one_step(checks, state, n, travel), FORCE))
    for state in STATES:
        for spring in (0.1, 10.0):
            rows.append((f"soft spring {state.lower()} {spring:g}", 1.0, soft_spring(checks, state, spring), FORCE))
    for free in ("", "X", "A", "XA"):
        rows.append((f"round {free}", np.inf, abs(round_die(checks, free, 0.02)/round_die(checks, free, 0) - 1), FORCE))
    rows.append(("slide", 0, slide(checks), 0.5))
    print(f"{'case':28s} {'before':>9s} {'now':>9s} {'bound':>9s}")
    for name, before, now, bound in rows:
        print(f"{name:28s} {before:9.2g} {now:9.2g} {bound:9.2g}")
        checks.small(now, bound, name)
    code = rib(checks)
    print(f"{'rib':28s} {0:9d} {code:9d} {3:9d}")
    checks.that(code == 3, "rib: ends with 3", code)
    checks.end()


if __name__ == "__main__":
    main()
