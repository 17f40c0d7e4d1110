#!/usr/bin/env python3
"""A billet of a steel with phases pressed while it cools, remeshed twice on the way: fractions, hardening and strains are carried.

usage: run_phases_remesh.py [-v] [-k] [--all]

- `given`: one temperature for the body (TEMPE), the law follows the kinetics (TIME): martensite is Koistinen and Marburger's at every
  point, whatever the mesh.
- `driven`: the body conducts heat and has phases (META), which drive its mechanics: the end is that on the deck's own mesh. Results show
  the temperatures in the middle of sides as the means of their ends (BILINEAR) at every instant, the first on a new mesh too.
- `stressed`: the same under stress on the kinetics (METAMEC), with flow by the rate in each phase (VISCO). With --all (half a minute) also alone,
  and in one system with the kinetics in the mechanics (MONOLITHIC, ISIG).
- `history`: cooled into bainite by a TTT diagram or by the histories of a CCT diagram, heated until it is austenite and its grains grow, quenched, and
  tempered, with a new mesh in each of the four: fractions, Scheil sums, grains, hardness and Hollomon-Jaffe's parameter end as on the deck's own mesh.
"""
import glob
import math
import os
import sys

sys.dont_write_bytecode = True
sys.path.append(os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "heat"))
from hardening_steel import hardening_steel  # noqa: E402
from remeshed import cycle, tries, within_limits  # noqa: E402
from support import DONE, Checks, history, run, said, with_h5py, write  # noqa: E402

with_h5py()
import h5py  # noqa: E402

STEEL = hardening_steel("base", 500, 1000)
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
TTT = """TTT    BAINITE ZERO
   350 40. 900.
   450 10. 300.
   600 60. 3000.
"""
CCT = """CCT    GRAIN 0.01 20
   0.5   600  0 0 0
   0.5   380  0 0 0.9
   50    600  0 0 0
   50    380  0 0 0.1
"""
MORE = """AUSTEN 3 0.5
GRAIN  20 LAMBDA 1E-9 3E4 LIMIT 1E6 1E4
TEMPER
   MARTENSITE 1E9 2E5 0.3
   HV TABLE 10 600 18 300
"""
PHASES = """PHASE  {name}
   ALPHA  {alpha}
   DEPS   0.009
   SY     700
   ET     1000
   KTP    6E-5
   HV     {hv}
"""
HISTORY = HEAD + """   STRESS 1.
ADDEL  billet PL8TM heat BILINEAR
LAW    heat META
   STEEL trip.met base
   ENERGY 1. CONDUCT 300. TIME 60.
START  T 700.
IMPOS  billet 2 T way 1.
LIC    way
   0. 700.   0.15 450.   0.4 380.   0.55 900.   0.65 950.   0.75 60.   0.85 60.   0.95 500.   1. 550.
NORMS  PATH 0. RATE 0.
""" + TAIL + "".join(f"PROBE  {name} MEAN {of} billet/PL8TM\n" for name, of in (
    ("z", "martensite"), ("b", "bainite"), ("t", "tempered"), ("s", "incubation_bainite"), ("g", "growth_bainite"), ("grain", "grain_size"),
    ("hv", "hardness"), ("hj", "hollomon_jaffe"), ("a", "austenite")))
STRESSED = DRIVEN.replace("LAW    heat META\n", "LAW    heat METAMEC\n").replace("ENERGY 1. CONDUCT", "ENERGY 1. STRESS 1. ISIG 1 CONDUCT")
OWN = "   STRESS 1.\nADDEL"
ISIG = STEEL.replace("EXPAND", "ISIG\n   MARTENSITE SHIFT 0.06 0.03\nEXPAND")
BY_RATE = ("PHASE  MARTENSITE\n", "PHASE  MARTENSITE\n   P2     400\n   P3     0.1\n",
           "PHASE  AUSTENITE\n", "PHASE  AUSTENITE\n   P1     0.1\n   P2     150\n   P3     0.2\n   P4     0.2\n")
# how far the columns may be from those on the deck's own mesh, over their largest value there
LIMITS = {"p": 0.01, "r": 0.01, "e": 0.01, "z": 0.003, "force_y_upper": 0.02}

KEPT = {"z": 0.01, "b": 0.01, "t": 0.01, "s": 0.01, "g": 0.01, "grain": 0.005, "hv": 0.005, "hj": 0.003, "a": 0.01}


def steel_of(kinetics):
    """The steel with more phases and more of what a point remembers."""
    text = STEEL.replace("TEMPS  MS 300\n", "TEMPS  MS 300 AC1 740 AC3 800\n").replace("EXPAND", kinetics + MORE + "EXPAND")
    text = text.replace("PHASE  MARTENSITE\n", "PHASE  MARTENSITE\n   HV     700\n").replace("PHASE  AUSTENITE\n", "PHASE  AUSTENITE\n   HV     150\n")
    for name, alpha, hv in (("FERRITE", "14E-6", 150), ("PEARLITE", "14E-6", 200), ("BAINITE", "14E-6", 350), ("TEMPERED", "12E-6", 400)):
        if name == "BAINITE" or name == "TEMPERED" or kinetics == CCT:
            text = text.replace("END\n", PHASES.format(name=name, alpha=alpha, hv=hv) + "END\n")
    return text


def remeshed(checks, name, text, steel=STEEL, times="0.45 0.75", kept=None):
    """The deck with new meshes, and on its own."""
    write(checks.path(name, "trip.met"), steel)
    own = write(checks.path(name, "own.lag"), text + "END\n")
    deck = write(checks.path(name, "new.lag"), text + f"REMSH\n   TIMES {times}\nEND\n")
    result = run([own, "--out", checks.path(name, "own"), "--threads", "1"])
    if not checks.that(result.returncode == DONE, f"{name}: its own mesh", said(result)):
        return None
    result = cycle(deck, checks.path(name, "new"))
    if not checks.that(result.returncode == DONE, f"{name}: remeshed", result.stdout + result.stderr):
        return None
    made = tries(checks.path(name, "new"))
    checks.that([t["accepted"] for t in made] == ["y"]*len(times.split()), f"{name}: {len(times.split())} new meshes, each at the first try", [t["reason"] for t in made])
    within_limits(checks, checks.path(name, "new"))
    rows, plain = history(checks.path(name, "new")), history(checks.path(name, "own"))
    for column, limit in (kept or LIMITS).items():
        # what is used up on the way is compared with what there was of it
        scale = max(abs(v) for v in plain[column]) if kept else abs(plain[column][-1])
        off = rows[column][-1] - plain[column][-1]
        if abs(scale) > 0:
            off /= scale
        checks.that(abs(off) < limit, f"{name}: {column} within {100*limit:g} %", f"{100*off:+.3f} %")
    return rows


def middles(checks, out):
    """How far temperatures in the middle of sides are from the means of their ends, over their range."""
    for path in sorted(glob.glob(os.path.join(out, "*.g??.h5"))):
        with h5py.File(path) as file:
            corners, middle = (file["mesh/topology"][:, k:k + 4] for k in (0, 4))
            for name, instant in file["steps"].items():
                t = instant["node/temperature"][:]
                off = abs(t[middle] - 0.5*(t[corners] + t[corners[:, [1, 2, 3, 0]]])).max()
                checks.that(off < 1e-9*(1 + t.max() - t.min()), f"{os.path.basename(path)}, step {name}: temperatures in the middle of sides", off)


def stressed(checks):
    """Stress on the kinetics and flow by the rate, through new meshes."""
    by_rate = ISIG.replace(*BY_RATE[:2]).replace(*BY_RATE[2:])
    remeshed(checks, "stressed", STRESSED.replace(OWN, OWN.replace("1.\n", "1. VISCO 60.\n")).replace("STRAT  0.02 1.E-5 0.02", "STRAT  0.04 1.E-5 0.04"),
             by_rate, "0.5")
    if "--all" in sys.argv:
        remeshed(checks, "stressed_once", STRESSED, ISIG)
        remeshed(checks, "stressed_own", STRESSED.replace(OWN, OWN.replace("1.\n", "1. TIME 60. ISIG 1\nSOLVE  MONOLITHIC\n")), ISIG)
        remeshed(checks, "by_rate", DRIVEN.replace(OWN, OWN.replace("1.\n", "1. VISCO 60.\n")), STEEL.replace(*BY_RATE[:2]).replace(*BY_RATE[2:]))


def main():
    checks = Checks()
    rows = remeshed(checks, "given", GIVEN)
    if rows:
        exact = 1 - math.exp(-0.011*(300 - 100))
        for column in ("z", "least", "most"):
            checks.that(abs(rows[column][-1] - exact) < 1e-10, f"given: {column}, Koistinen and Marburger", rows[column][-1])
    remeshed(checks, "driven", DRIVEN)
    middles(checks, checks.path("driven", "new"))
    stressed(checks)
    for name, kinetics in (("ttt", TTT), ("cct", CCT)):
        remeshed(checks, f"history_{name}", HISTORY, steel_of(kinetics), "0.3 0.6 0.73 0.96", KEPT)
    checks.end()


if __name__ == "__main__":
    main()
