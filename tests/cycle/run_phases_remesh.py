#!/usr/bin/env python3
"""A billet of a steel with phases pressed while it cools, remeshed twice on the way: fractions, hardening and strains are carried.

usage: run_phases_remesh.py [-v] [-k]

- `given`: one temperature for the body (TEMPE), the law follows the kinetics (TIME): martensite is Koistinen and Marburger's at every
  point, whatever the mesh.
- `driven`: the body conducts heat and has phases (META), which drive its mechanics: the end is that on the deck's own mesh.
"""
import math
import sys

sys.dont_write_bytecode = True
from remeshed import cycle, tries, within_limits  # noqa: E402
from support import DONE, Checks, history, run, said, write  # noqa: E402

STEEL = """STEEL  base
SOURCE 'made up, for tests'
TEMPS  MS 300
MARTEN BETA 0.011
EXPAND TOTAL 20
TRIP   DESALOS
PHASE  ALL
   LAMBDA 30
   RHOC   4.5
   E      TABLE 20 205000  800 140000
   NU     0.3
PHASE  AUSTENITE
   ALPHA  22E-6
   SY     TABLE 20 220  800 50
   ET     500
PHASE  MARTENSITE
   ALPHA  12E-6
   DEPS   0.0105
   SY     1200
   ET     1000
   KTP    8E-5
END
"""
HEAD = """TITLE  Billet of a steel with phases
STATE  AXISYM
KINEM  LOG
BLOCK  billet PL8LS 4 steel
   0. 0.   10. 0.   10. 15.   0. 15.
   8 1.   12 1.
LAW    steel ARBTHMET
   STEEL trip.met base
"""
TAIL = """DIE    upper PILOT 0. 15.
   SEGM  30. 15.   -1. 15.
CNT2D  billet 3 upper stick
LAW    stick GLUE2D
   PENETR 1.E-3
FIXED  billet 1 Y
FIXED  billet 4 X
LIC    press
   0. 0.   1. -3.
MOVE   upper Y press
STRAT  0.02 1.E-5 0.02   9 3
SAVE   1000
PROBE  p MEAN plastic_strain billet
PROBE  r MEAN hardening_austenite billet
PROBE  e MEAN transformation_plasticity billet
"""
GIVEN = HEAD + "   STRESS 1.   TIME 60.\nTEMPE  billet 1. cool\nLIC    cool\n   0. 600.   0.3 400.   1. 100.\n" + TAIL + (
    "PROBE  z MEAN martensite billet\nPROBE  least MIN martensite billet\nPROBE  most MAX martensite billet\n")
DRIVEN = HEAD + "   STRESS 1.\nADDEL  billet PL8TM heat BILINEAR\nLAW    heat META\n   STEEL trip.met base\n   ENERGY 1. CONDUCT 60. TIME 60.\n" + (
    "START  T 500.\nCONVE  billet 2 H 60. TS 20.\n") + TAIL + "PROBE  z MEAN martensite billet/PL8TM\n"
# how far the columns may be from those on the deck's own mesh
LIMITS = {"p": 0.01, "r": 0.01, "e": 0.01, "z": 0.003, "force_y_upper": 0.02}


def remeshed(checks, name, text):
    """The deck with new meshes, and on its own."""
    write(checks.path(name, "trip.met"), STEEL)
    own = write(checks.path(name, "own.lag"), text + "END\n")
    deck = write(checks.path(name, "new.lag"), text + "REMSH\n   TIMES 0.45 0.75\nEND\n")
    result = run([own, "--out", checks.path(name, "own"), "--threads", "1"])
    if not checks.that(result.returncode == DONE, f"{name}: its own mesh", said(result)):
        return None
    result = cycle(deck, checks.path(name, "new"))
    if not checks.that(result.returncode == DONE, f"{name}: remeshed", result.stdout + result.stderr):
        return None
    made = tries(checks.path(name, "new"))
    checks.that([t["accepted"] for t in made] == ["y", "y"], f"{name}: two new meshes, each at the first try", [t["reason"] for t in made])
    within_limits(checks, checks.path(name, "new"))
    rows, plain = history(checks.path(name, "new")), history(checks.path(name, "own"))
    for column, limit in LIMITS.items():
        off = rows[column][-1]/plain[column][-1] - 1
        checks.that(abs(off) < limit, f"{name}: {column} within {100*limit:g} %", f"{100*off:+.3f} %")
    return rows


def main():
    checks = Checks()
    rows = remeshed(checks, "given", GIVEN)
    if rows:
        exact = 1 - math.exp(-0.011*(300 - 100))
        for column in ("z", "least", "most"):
            checks.that(abs(rows[column][-1] - exact) < 1e-10, f"given: {column}, Koistinen and Marburger", rows[column][-1])
    remeshed(checks, "driven", DRIVEN)
    checks.end()


if __name__ == "__main__":
    main()
