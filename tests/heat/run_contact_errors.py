#!/usr/bin/env python3
"""Errors of temperatures that a run tells where heat passes through contact that moves (COU2DC), against the true ones.

usage: run_contact_errors.py [-v] [-k]

- `opens`: two blocks part while heat passes, across a gap that opens, by a film of gas and radiation: the equation of their two temperatures by
  Runge and Kutta; TR-BDF2 is of second order, with what contact conducts at its instants, and implicit Euler tells its error; with
  temperatures found once, and first, what is told has the conductances that are a step behind.
- `near`: a die comes near to a hot block, or touches it, and goes: conductance follows a steep table of the gap in each step; the error in
  time that is told is 0.6 to 2 times that of the heat that came in, by all schemes and ways of coupling, in long first steps too.
- `edges`: a hot billet pressed by an elastic tool that conducts, and held: how far contact reaches is what the motion errs in long steps; the error
  in time that is told is 0.5 to 3 times that in the mean square (without its contact a fifth and less), of all ways to find both fields.
- `lost`: a hot strip that shrinks away from the dies it was bent in: what only its drag resists is no error of its places.
- `pressed`: the same strip while the dies press it, by whose pressure heat passes: the error that is told is 0.4 to 5 times the true one.
- `skin`: the chilled skin of a hot billet, pressed in steps that are far too long, stays on its die.
"""
import math
import os
import sys

sys.dont_write_bytecode = True
TESTS = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path[:0] = [os.path.join(TESTS, folder) for folder in ("patch", "runs")]
from hardening_steel import hardening_steel  # noqa: E402
from patch_support import Checks, Run, np  # noqa: E402
from support import summary  # noqa: E402


def told_at_end(run):
    """Error in time of the temperatures at the end, as the summary tells it."""
    return summary(run.out)["accuracy"]["heat"]["end"]


OPENS = """TITLE  Two blocks that part
STATE  PLSTN
KINEM  LOG
BLOCK  a PL8LS 4 e
   0. 0.   10. 0.   10. 5.   0. 5.
   1 1.   1 1.
BLOCK  b PL8LS 4 e
   0. 5.   10. 5.   10. 10.   0. 10.
   1 1.   1 1.
LAW    e ELA
   200000. 0.3
LAW    k COUL2D
   PENETR 1.E-3   PHI 0.
LAW    m HEAT
   30000. 4.5
ADDEL  a PL8TM m
ADDEL  b PL8TM m
DIE    d SIDES a 3
CNT2D  b 1 d k
COU2DC b 1 d H 2. EPS 0.6 SIGMA 5.67E-11 ZERO 273.15 REACH 5.
   GAP    0. 1.   0.1 0.5   0.5 0.1   2. 0.
START  T 800. a
START  T 20. b
FIXED  a 1 XY
FIXED  b 3 X
LIC    w
   0. 0.   6. 2.
MOVE   b 3 Y w
SOLVE  {solve}
{theta}STRAT  0.01 1.E-6 {step} 20 3
NORMS  FORCE 1.E-6
STOP   6.
PROBE  t NODE T 5. 0.
END
"""


def opens(checks):
    """The hotter block at the end, against the equation; the error that implicit Euler tells."""
    def rate(time, hot, cold):
        gap_now = time/3
        share = np.interp(gap_now, (0, 0.1, 0.5, 2), (1, 0.5, 0.1, 0))
        return (2*share*(hot - cold) + 0.6*5.67e-11*((hot + 273.15)**4 - (cold + 273.15)**4))/(4.5*5)
    hot, cold, n = 800.0, 20.0, 2000
    for k in range(n):   # what one loses the other gains: one equation by the classical rule
        dt, first = 6/n, rate(6*k/n, hot, cold)
        second = rate(6*(k + 0.5)/n, hot - 0.5*dt*first, cold + 0.5*dt*first)
        third = rate(6*(k + 0.5)/n, hot - 0.5*dt*second, cold + 0.5*dt*second)
        change = dt*(first + 2*second + 2*third + rate(6*(k + 1)/n, hot - dt*third, cold + dt*third))/6
        hot, cold = hot - change, cold + change
    errors = {}
    for name, theta, step in (("Euler", "", 0.1), ("TR-BDF2", "THETA  TRBDF2\n", 0.2), ("TR-BDF2", "THETA  TRBDF2\n", 0.1)):
        run = Run(checks, f"opens-{name}-{step:g}", OPENS.format(theta=theta, step=step, solve="CONVERGE"))
        if not run.ok:
            return
        errors[name, step] = run.history["t"][-1] - hot
        if name == "Euler":
            told = told_at_end(run)
            checks.that(0.7 < told/abs(errors[name, step]) < 1.4, "opens: what implicit Euler tells", (told, errors[name, step]))
    # conductances that are a step behind, which no scheme of the temperatures knows: 2 K by TR-BDF2 in steps of 0.1
    for name, theta, step in (("Euler", "", 0.1), ("Euler", "", 0.4), ("TR-BDF2", "THETA  TRBDF2\n", 0.2), ("TR-BDF2", "THETA  TRBDF2\n", 0.1)):
        run = Run(checks, f"opens-once-{name}-{step:g}", OPENS.format(theta=theta, step=step, solve="ONCE"))
        if run.ok:
            told = told_at_end(run)
            true = abs(run.history["t"][-1] - hot)
            checks.that(0.7 < told/true < 1.4, f"{run.name}: what is told of conductances a step behind", (told, true))
    ratio = errors["TR-BDF2", 0.2]/errors["TR-BDF2", 0.1]
    checks.that(2.8 < ratio < 6 and abs(errors["TR-BDF2", 0.1]) < 0.15*abs(errors["Euler", 0.1]), "opens: second order", (ratio, errors))


NEAR = """TITLE a die that comes and goes
STATE PLSTN
KINEM LOG
BLOCK b PL8LS 9 s
   0. 0. 10. 0. 10. 10. 0. 10.
   2 1. 10 0.3
LAW s ELATH
   20000. 0.3 1.2E-5
ADDEL b PL8TM heat BILINEAR
LAW heat HEAT
   30. 4.
START T 800.
FIXED b 1 Y
FIXED b 4 X
DIE upper PILOT 0. 10.3
   SEGM 20. 10.3  -1. 10.3
LAW c COUL2D
   PENETR 1.E-3 PHI 0.1
CNT2D b 3 upper c
TDIE upper T 50.
COU2DC b 3 upper H 5. HO 0.05 REACH 10.
   PRESS 0. 0.6 20. 1.
   GAP 0. 0.6 0.02 0.3 0.1 0.1 0.3 0.03 1. 0.01 2. 0.
LIC go
   0. 0. 1. -{way} 1.5 -{way} 5. 2.
MOVE upper Y go
SOLVE {coupling}
THETA {scheme}
STRAT {step} {step}/1000 {step} 4 3
STOP 5.
END
"""


def near(checks):
    """Conductance of a point goes through its table with the motion."""
    capacity = 4.0*100
    for way in (0.28, 0.305):
        name = f"near-{way:g}"
        fine = Run(checks, f"{name}-fine", NEAR.format(way=way, coupling="CONVERGE", scheme="TRBDF2", step=0.01))
        if not fine.ok:
            continue
        for coupling, scheme, step in (("ONCE", "1.", 1.0), ("ONCE", "1.", 0.25), ("CONVERGE", "1.", 1.0), ("MONOLITHIC", "1.", 0.5),
                                       ("ONCE", "TRBDF2", 1.0), ("ONCE", "TRBDF2", 0.5), ("CONVERGE", "TRBDF2", 0.5),
                                       ("ONCE", "TRBDF2 TOL 3.", 1.0), ("CONVERGE", "TRBDF2 TOL 1.", 1.0)):
            what = f"{name}-{coupling}-{scheme}-{step:g}".replace(" ", "").replace(".", "")
            run = Run(checks, what, NEAR.format(way=way, coupling=coupling, scheme=scheme, step=step))
            if not run.ok:
                continue
            told = told_at_end(run)
            true = abs(run.history["heat_in"][-1] - fine.history["heat_in"][-1])/capacity
            checks.that(0.6 < told/true < 2.0, f"{what}: error in time that is told, over that of the mean temperature", (told, true, told/true))


# Gaps of a micrometre decide where the tool bears.
EDGES = """TITLE edges of contact
STATE AXISYM
KINEM LOG
BLOCK b PL8LS 4 m
   0. 0. 10. 0. 10. 12. 0. 12.
   8 1. 8 1.
BLOCK d PL8LS 4 el
   0. 12. 25. 12. 25. 32. 0. 32.
   12 1. 8 2.
LAW m EVP-NH
   TEMP 500.
   150000. 0.3
   0. 260. 0.06 0.1
   TEMP 1200.
   80000. 0.3
   0. 27. 0.18 0.1
LAW el ELATH
   210000. 0.3 1.2E-5
ADDEL b PL8TM h BILINEAR
ADDEL d PL8TM hd BILINEAR
LAW h HEAT
   28. 4.9
   QUINNEY 0.9
LAW hd HEAT
   30. 4.5
START T 1100. b
START T 250. d
FIXED b 1 Y
FIXED b 4 X
FIXED d 4 X
LAW rub COUL2D
   PENETR 1.E-3 PHI 0.3
DIE tool SIDES d 1
CNT2D b 3 2 tool rub
COU2DC b 3 2 tool H 20. FRIC 1.
MOVE d 3 Y press
LIC press
   0. 0. 0.4 -5. 1. -5.
SOLVE {way}
STRAT 0.001 1.E-7 {step} 6 3
STOP 1.
END
"""


def edges(checks):
    """Edges of contact stand elsewhere in long steps, and with them temperatures err."""
    fine = Run(checks, "edges-fine", EDGES.format(way="ONCE", step=0.01))
    for way, step in (("ONCE", 0.1), ("ONCE", 0.04), ("MONOLITHIC", 0.1)):
        run = Run(checks, f"edges-{way}-{step:g}".replace(".", ""), EDGES.format(way=way, step=step))
        if not (fine.ok and run.ok):
            continue
        true, told = square_mean(run, fine), told_at_end(run)
        checks.that(0.5 < told/true < 3.0, f"{run.name}: error in time that is told, over that of the temperatures", (told, true, told/true))


def square_mean(run, fine, ring=True):
    """Difference of the temperatures at the end, in the mean square over the volume as it began, of a ring or in a plane."""
    places, nodes = run.mesh()
    weight = np.zeros(len(places))
    for corners in nodes[:, :4]:
        (x, y), following = places[corners].T, places[np.roll(corners, -1)].T
        weight[corners] += abs(x @ following[1] - y @ following[0])*(x.mean() if ring else 1)
    last = []
    for one in (run, fine):
        with one.open() as file:
            last.append(file[f"steps/{sorted(file['steps'])[-1]}/node/temperature"][()].ravel())
    of_corners = weight > 0
    return math.sqrt(np.average((last[0] - last[1])[of_corners]**2, weights=weight[of_corners]))


LOST = """TITLE  A strip bent hot and held in dies that it shrinks away from
STATE  PLSTN
KINEM  LOG
BLOCK  strip PL8LS 4 steel
   0. 0.   40. 0.   40. 1.5   0. 1.5
   24 1.   3 1.
LAW    steel ARBTHMET
   STEEL lost.met s
   STRESS 1.
ADDEL  strip PL8TM heat BILINEAR
LAW    heat META
   STEEL lost.met s
   ENERGY 1.
START  T 800.
LAW    film COUL2D
   PENETR 0.02 PHI 0.2
DIE    low
   SEGM   -1. -10.   12. -10.
   FILLT  3. 1.E-3
   SEGM   12. -10.   20. 0.
   FILLT  3. 1.E-3
   SEGM   20. 0.  50. 0.
DIE    punch PILOT 0. 1.5
   SEGM   16.7 11.5   8.7 1.5
   FILLT  3. 1.E-3
   SEGM   8.7 1.5  -1. 1.5
CNT2D  strip 1 low film
CNT2D  strip 3 punch film
FIXED  strip 4 X
TDIE   low T 60.
TDIE   punch T 60.
COU2DC strip 1 low H 3. HO 0.1 REACH 3. FRIC 0.9 SHARE 0.5
   PRESS 0. 0.1 10. 1.
   GAP 0. 0.1 0.3 0.02
COU2DC strip 3 punch H 3. HO 0.1 REACH 3. FRIC 0.9 SHARE 0.5
   PRESS 0. 0.1 10. 1.
   GAP 0. 0.1 0.3 0.02
LIC    down
   0. 0. 1. -10.04 {end} -10.04
MOVE   punch Y down
THETA  TRBDF2
STRAT  {step}/20 1.E-6 {step} 10 5
STOP   {end}
PROBE  m MEAN martensite strip/PL8TM
END
"""

# A block that lies loose on a plate of its own.
LOOSE = (("START  T 800.", """BLOCK  cube PL8LS 4 plain
   100. 0.   110. 0.   110. 4.   100. 4.
   6 1.   2 1.
LAW    plain ELA
   200000. 0.3
ADDEL  cube PL8TM bulk BILINEAR
LAW    bulk HEAT
   30. 4.5
"""), ("CNT2D  strip 1", "DIE    plate\n   SEGM   90. 0.   120. 0.\n"), ("TDIE   low", "CNT2D  cube 1 plate film\n"),
         ("LIC    down", """TDIE   plate T 60.
COU2DC cube 1 plate H 3. HO 0.1 REACH 3.
   PRESS 0. 0.1 10. 1.
   GAP 0. 0.1 0.3 0.02
"""))


def lost(checks):
    """Errors of places of a body that hardly touches anything."""
    with open(os.path.join(checks.folder, "lost.met"), "w", encoding="utf-8") as file:
        file.write(hardening_steel("s", 1500, 6000))
    run = Run(checks, "lost", LOST.format(step=0.03, end=6))
    if not run.ok:
        return
    path = summary(run.out)["accuracy"]["path"]
    checks.that(0 < path["motion_pct"] < 0.2, "lost: error of the motion by the path [%]", path)
    checks.that("contact_places_known" not in summary(run.out)["accuracy"]["heat"], "lost: where contact stands is known", summary(run.out)["accuracy"]["heat"])
    checks.that(path.get("stress_known", True) and path["stress_pct"] < 3, "lost: error of the stress [%]", path)


def pressed(checks):
    """The strip cools while dies press it: how much they press is what errors of its places make of it (without that a seventh is told)."""
    with open(os.path.join(checks.folder, "lost.met"), "w", encoding="utf-8") as file:
        file.write(hardening_steel("s", 1500, 6000))
    long, fine = (Run(checks, f"pressed-{step}".replace(".", ""), LOST.format(step=step, end=2)) for step in (0.1, 0.00625))
    if long.ok and fine.ok:
        true, told = square_mean(long, fine, ring=False), told_at_end(long)
        checks.that(0.4 < told/true < 5, "pressed: error in time that is told, over that of the temperatures", (told, true, told/true))
    # what rests elsewhere takes nothing from what is told
    deck = LOST.format(step=0.1, end=2)
    for before, cards in LOOSE:
        deck = deck.replace(before, cards + before, 1)
    beside = Run(checks, "pressed-beside", deck)
    if long.ok and beside.ok:
        ratio = told_at_end(beside)/told_at_end(long)
        checks.that(0.5 < ratio < 2, "pressed: with a loose block elsewhere, over what is told without", ratio)


def skin(checks):
    """chilled_die of the decks in steps of 0.2 s, against 0.05 s."""
    with open(os.path.join(os.path.dirname(TESTS), "decks", "chilled_die", "chilled_die.lag"), encoding="utf-8") as file:
        deck = file.read()
    long, short = (Run(checks, f"skin-{step}".replace(".", ""), deck, options=("-p", f"step={step}")) for step in (0.2, 0.05))
    if long.ok and short.ok:
        checks.small(abs(long.history["face"][-1] - short.history["face"][-1]), 3.0, "skin: temperature of the middle of the face [K]")
        checks.that("damped_share" not in summary(long.out)["checks"], "skin: no step is damped", summary(long.out)["checks"])


def main():
    checks = Checks()
    opens(checks)
    near(checks)
    edges(checks)
    lost(checks)
    pressed(checks)
    skin(checks)
    checks.end()


if __name__ == "__main__":
    main()
