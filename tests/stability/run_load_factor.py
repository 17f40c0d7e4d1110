#!/usr/bin/env python3
"""Loads that are found (LOADF): past their limit points, where no given load has an equilibrium.

usage: run_load_factor.py [-v] [-k]      -v prints every check, -k keeps the results

`wall`: a thick cylinder widened by pressure to twice its bore. The pressure rises to a limit and falls: in a rigid plastic one, with
r^2 - R^2 the same everywhere, p = integral of 2/sqrt(3) yield(2/sqrt(3) ln(r/R))/r dr. Found by the motion of the bore and by the
volume that it sweeps. `arch`: snapped through by a force on its crown, found by the motion of the crown; the same as the reaction
where that motion is given. Both are resumed bit for bit. `bulge`: a clamped sheet blown beyond the largest pressure it bears.
"""
import math
import os
import sys

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, os.pardir, "patch"))
from patch_support import NO_CONVERGENCE, Checks, Run  # noqa: E402

WALL = """TITLE  A thick cylinder widened past its largest pressure
STATE  {state}
KINEM  LOG
BLOCK  wall PL8LS 4 metal
   {corners}
   {divisions}
{sides}LAW    metal EPLA
   2000000. 0.3
   SWIFT 500. 0.01 0.1
{held}LOADF  p {measure}
PRES2D wall 4 3 1. p
LIC    grow
   0. 0.   1. 10.
STRAT  0.01 1.E-6 0.02   6 3
PROBE  bore NODE X 10. 0.
END
"""
ROUND = {"state": "AXISYM", "corners": "10. 0.   20. 0.   20. 2.   10. 2.", "divisions": "10 1.   1 1.", "sides": "",
         "held": "FIXED  wall 1 Y\nFIXED  wall 3 Y\n"}
PLANE = {"state": "PLSTN", "corners": "10. 0.   20. 0.   0. 20.   0. 10.", "divisions": "10 1.   8 1.",
         "sides": "   SIDE 2 ARC 0. 0.\n   SIDE 4 ARC 0. 0.\n", "held": "FIXED  wall 1 Y\nFIXED  wall 3 X\n"}

ARCH = """TITLE  A shallow arch snapped through
STATE  PLSTN
KINEM  LOG
BLOCK  arch PL8LS 4 m
   0. 100.   50. 95.   50.2 96.   0. 101.
   20 1.   1 1.
LAW    m ELA
   200000. 0.3
FIXED  arch 4 X
FIXED  arch 2 XY
{load}LIC    down
   0. 0.   1. -12.
STRAT  0.02 1.E-6 0.02   6 3
NORMS  FORCE 1.E-9
PROBE  crown NODE UY 0. 101.
END
"""

BULGE = """TITLE  A clamped sheet blown past its largest pressure
STATE  AXISYM
KINEM  LOG
BLOCK  sheet PL8LS 4 metal
   0. 0.   40. 0.   40. 1.   0. 1.
   40 1.   2 1.
LAW    metal EPLA
   70000. 0.33
   SWIFT 300. 0.005 0.2
FIXED  sheet 2 XY
FIXED  sheet 4 X
LOADF  p POINT 0. 1. Y grow
PRES2D sheet 1 3 1. p
LIC    grow
   0. 0.   1. 40.
STRAT  0.01 1.E-6 0.02   6 3
END
"""

# A clamped cap that is too deep to snap with its apex: a dent forms beside it.
CAP = """TITLE  A cap
STATE  AXISYM
KINEM  LOG
BLOCK  cap PL8LS 4 metal
   99.5*sin(.35) 99.5*cos(.35)   100.5*sin(.35) 100.5*cos(.35)   0. 100.5   0. 99.5
   2 1.   24 1.
   SIDE 2 ARC 0. 0.
   SIDE 4 ARC 0. 0.
LAW    metal ELA
   200000. 0.3
FIXED  cap 1 XY
FIXED  cap 3 X
PRES2D cap 2 4 1. p
{load}STRAT  0.02 1.E-5 0.02   6 3
END
"""


def pressure(bore):
    """Of the rigid plastic cylinder, by Simpson's rule."""
    n, inner, outer = 400, 10.0, 20.0
    shift, total = bore**2 - inner**2, 0.0
    for k in range(n + 1):
        place = inner + (outer - inner)*k/n
        now2 = place**2 + shift
        strain = math.log(now2/place**2)/math.sqrt(3)
        total += (1 if k in (0, n) else 4 if k % 2 else 2)*2/math.sqrt(3)*500*(0.01 + strain)**0.1*place/now2
    return total*(outer - inner)/n/3


def wall(checks):
    for name, scene, measure in (("bore", ROUND, "POINT 10. 0. X grow"), ("volume", ROUND, "WORK grow 400."),
                                 ("plane", PLANE, "POINT 10. 0. X grow"), ("sector", PLANE, "WORK grow 25.*pi")):
        run = Run(checks, "wall-" + name, WALL.format(measure=measure, **scene))
        if not run.ok:
            continue
        bore, found = run.history["bore"], run.history["p"]
        off = max(abs(p/pressure(b) - 1) for b, p in zip(bore, found) if b > 10.5)
        top = max(range(len(found)), key=lambda k: found[k])
        print(f"wall-{name}: {len(found)} steps, {sum(run.history['iterations']):.0f} iterations, pressure {found[top]:.2f} at bore "
              f"{bore[top]:.2f}, then down to {found[-1]:.2f}; off {off:.1e}")
        checks.that(off < 1e-3, f"wall-{name}: the rigid plastic pressure to .1 %", f"{off:.2e}")
        checks.that(found[-1] < 0.9*found[top], f"wall-{name}: past the limit", f"{found[-1]} of {found[top]}")
        if "WORK" in measure:
            # in steps of any length; 2 pi 2 (bore**2 - 100)/2 of the ring, pi/4 (bore**2 - 100) of the sector
            turn = 2*math.pi if scene is ROUND else math.pi/4
            swept = max(abs(turn*(b**2 - 100)/(float(measure.split()[-1].replace("25.*pi", "78.53981634"))*10*t) - 1)
                        for b, t in zip(bore, run.history["time"]) if t > 0)
            checks.that(swept < 2e-3 if scene is PLANE else swept < 1e-6, f"wall-{name}: the volume is the one given", f"{swept:.2e}")
        checks.that(sum(run.history["iterations"]) <= 4*len(found), f"wall-{name}: at most 4 iterations a step")


def arch(checks):
    found = Run(checks, "arch", ARCH.format(load="LOADF  f POINT 0. 101. Y down\nFORCE  POINT 0. 101. Y -1. f\n"))
    work = Run(checks, "arch-work", ARCH.format(load="LOADF  f WORK down -1.\nFORCE  POINT 0. 101. Y -1. f\n"))
    given = Run(checks, "arch-given", ARCH.format(load="MOVE   POINT 0. 101. Y down\nPROBE  r REACT Y POINT 0. 101.\n"))
    if not (found.ok and work.ok and given.ok):
        return
    size = max(abs(given.history["r"]))
    off = max(abs(run.history["f"] + given.history["r"]).max()/size for run in (found, work))
    print(f"arch: force {max(found.history['f'][:20]):.2f}, then {min(found.history['f']):.2f}, at last {found.history['f'][-1]:.2f}; "
          f"off the reaction {off:.1e}")
    checks.that(min(found.history["f"]) < 0 < found.history["f"][-1], "arch: it snaps, and bears a load again")
    checks.that(off < 1e-6, "arch: found as where the motion is given", f"{off:.2e}")


def told(checks):
    """What a run says that stops at a limit: of loads that are given, and of a measure that turns back as a deep cap snaps."""
    for name, load, words in (("given", "LIC    p\n   0. 0.   1. 200.\n", "LOADF finds the loads beyond it"),
                              ("apex", "LOADF  p POINT 0. 100.5 Y grow\nLIC    grow\n   0. 0.   1. -12.\n", "LOADF turns back")):
        stopped = Run(checks, name, CAP.format(load=load), code=NO_CONVERGENCE)
        checks.that(words in stopped.said, f"{name}: what leads past a limit", stopped.said)


def resumed(checks):
    """The sheet, and the same stopped on its way and taken up again."""
    whole = Run(checks, "bulge", BULGE)
    if not whole.ok:
        return
    found = whole.history["p"]
    checks.that(found[-1] < 0.98*max(found), "bulge: past the largest pressure", f"{found[-1]} of {max(found)}")
    part = Run(checks, "part", BULGE.replace("END\n", "CKPT   5\nEND\n"))
    checks.that(part.ok and list(part.history["p"]) == list(found), "bulge: the same with checkpoints")
    again = Run(checks, "part", BULGE.replace("END\n", "CKPT   5\nEND\n"),
                options=["--resume", os.path.join(part.out, "part.ckp.1.h5")])
    checks.that(again.ok and list(again.history["p"]) == list(found), "bulge: resumed to the same bits")


def main():
    checks = Checks()
    wall(checks)
    arch(checks)
    told(checks)
    resumed(checks)
    checks.end()


if __name__ == "__main__":
    main()
