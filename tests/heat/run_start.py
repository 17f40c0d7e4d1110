#!/usr/bin/env python3
"""Temperatures at the start by formulas of the place, against closed forms.

usage: run_start.py [-v] [-k]

- `wave`: T = A + B cos(pi x/L) in a wall without loss of heat decays as exp(-alpha (pi/L)^2 t) (H.S. Carslaw, J.C. Jaeger, sec. 3.3).
- `bodies`: a formula for all and another for one body: temperatures that are even in the end are the mean of it, in the plane and,
  with the radius as weight, in an axisymmetric scene.
- `same`: a formula that is the same number everywhere gives the bits of that number.
"""
import math
import os
import sys

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [HERE, os.path.join(os.path.dirname(HERE), "patch")]
from patch_support import Checks, Run, np  # noqa: E402
from run_exchange import HEAD, TIGHT  # noqa: E402

LAW = "LAW steel HEAT\n   20. 2.\n"
WALL = "BLOCK wall PL8TM 9 steel\n   0. 0. 0.4 0. 0.4 0.1 0. 0.1\n   20 1. 2 1.\n"


def wave(checks):
    """A cosine that decays."""
    time = 0.005
    exact = [300 + 80*math.exp(-10*(math.pi/0.4)**2*time)*math.cos(math.pi*x/0.4) for x in (0.0, 0.1, 0.3)]
    run = Run(checks, "wave", "PARAM mean 300.\nPARAM length 0.4\n" + HEAD.format(title="wave", state="PLSTN") + WALL + LAW
              + "START T $mean+80*cos(pi*x/$length)\nTHETA TRBDF2\n"
              + f"STRAT 1.E-5 1.E-9 1.E-5 99 1\nSTOP {time}\n" + TIGHT
              + "PROBE a NODE T 0. 0.\nPROBE b NODE T 0.1 0.1\nPROBE c NODE T 0.3 0.\nEND\n")
    if run.ok:
        found = [run.history[name][-1] for name in "abc"]
        checks.small(max(abs(a - b) for a, b in zip(found, exact))/80, 1e-5, "wave: decays as it must")


def bodies(checks):
    """Two bodies without loss of heat, each of which comes to the mean of its formula."""
    for state, first, second in (("PLSTN", 20 + 100*0.15, 7 + 1000*0.05),
                                 ("AXISYM", 20 + 100*0.2, 7 + 1000*0.05)):
        run = Run(checks, f"bodies-{state}", HEAD.format(title="bodies", state=state)
                  + "BLOCK wall PL8TM 9 steel\n   0. 0. 0.3 0. 0.3 0.1 0. 0.1\n   6 1. 2 1.\n"
                  "BLOCK other PL8TM 9 steel\n   0.4 0. 0.5 0. 0.5 0.1 0.4 0.1\n   3 1. 2 1.\n" + LAW
                  + "START T 20+100*x\nSTART T 7+1000*y other\nSTRAT 1. 1. 1.E4 9 3\nSTOP 1.E5\n" + TIGHT
                  + "PROBE a NODE T 0. 0.\nPROBE b NODE T 0.5 0.1\nEND\n")
        if run.ok:
            checks.small(abs(run.history["a"][-1] - first), 1e-8*first, f"bodies, {state}: {first:.4f}")
            checks.small(abs(run.history["b"][-1] - second), 1e-8*second, f"bodies, {state}: {second:.4f}")


def same(checks):
    """A formula without variation."""
    rows = []
    for name, value in (("number", "250."), ("formula", "250.+0*x")):
        run = Run(checks, f"same-{name}", HEAD.format(title="same", state="AXISYM") + WALL + LAW + f"START T {value}\n"
                  "CONVE wall 2 H 5. TS 20.\nSTRAT 1.E-3 1.E-9 1.E-3 9 3\nSTOP 0.01\n" + TIGHT + "PROBE a NODE T 0.4 0.\nEND\n")
        if run.ok:
            rows.append(run.history["a"])
    checks.that(len(rows) == 2 and np.array_equal(rows[0], rows[1]), "same: number and formula, bit by bit")


def main():
    """All of them."""
    checks = Checks()
    wave(checks)
    bodies(checks)
    same(checks)
    checks.end()


if __name__ == "__main__":
    main()
