#!/usr/bin/env python3
"""Phases that form under stress (METAMEC, ISIG): Ms under tension and pressure, and the ways of coupling.

usage: run_stress_phases.py [-v] [-k]

- `tension`, `pressure`: one element on a given temperature under a stress that grows: z = 1 - exp(-BETA (Ms + a p + b q - T)) with
  the mean stress p and von Mises' q, a = .06, b = .03 K/MPa: at every step where both are found together (CONVERGE, or MONOLITHIC with
  the kinetics in the mechanics), with the stress a step behind by ONCE. The same by the laws alone (TEMPE, TIME).
- `quench`: a bar cooled on its side: ONCE with half the step is near MONOLITHIC; stress moves the mean of martensite.
- `quench`, `plane_strain` and `section` in MONOLITHIC: the derivatives of the latent heat by the stress are in the matrix (iterations).
- `held`: in equal steps CONVERGE is MONOLITHIC, in plane strain too, where turns without Anderson's method diverge.
- With ISIG 0 METAMEC is META, to the bit.
- Without stress on the kinetics MONOLITHIC is the same, in as many iterations, with the fractions of META and with those of the law (TIME):
  the cross derivatives are exact. Errors of the path have no bounds here: their estimates in halves of steps differ, and so would the steps.
"""
import math
import sys

sys.dont_write_bytecode = True
import os  # noqa: E402
TESTS = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path[:0] = [os.path.join(TESTS, folder) for folder in ("runs",)]
from support import DONE, Checks, history, run, said, write  # noqa: E402

MS, BETA, A, B = 300.0, 0.011, 0.06, 0.03
SECTION = """STEEL  {name}
SOURCE 'made up, for tests'
TEMPS  MS {ms:g}
MARTEN BETA {beta:g}
{kinetics}EXPAND TOTAL 20
TRIP   DESALOS
PHASE  ALL
   LAMBDA 30
   RHOC   4.5
   LATENT 400
   E      205000
   NU     0.3
   SY     TABLE 20 1200  800 700
   ET     2000
PHASE  AUSTENITE
   ALPHA  22E-6
PHASE  FERRITE
   ALPHA  14E-6
   DEPS   0.009
   KTP    6E-5
PHASE  PEARLITE
   ALPHA  14E-6
   DEPS   0.009
   KTP    6E-5
PHASE  BAINITE
   ALPHA  14E-6
   DEPS   0.009
   KTP    6E-5
PHASE  MARTENSITE
   ALPHA  12E-6
   DEPS   0.0105
   KTP    8E-5
"""
BAINITE = f"""TTT    BAINITE ZERO
   300 20. 2000.
   400 4. 400.
   500 10. 1000.
ISIG
   MARTENSITE SHIFT {A:g} {B:g}
   BAINITE    TIME 2.E-3 1.E-3 SHIFT 0.05 0.02
"""
STEEL = (SECTION.format(name="martensitic", ms=MS, beta=BETA, kinetics=f"ISIG\n   MARTENSITE SHIFT {A:g} {B:g}\n")
         + SECTION.format(name="bainitic", ms=MS, beta=BETA, kinetics=BAINITE) + "END\n")
ELEMENT = """TITLE  One element that becomes martensite under stress
STATE  AXISYM
KINEM  {kinem}
BLOCK  b PL8LS 4 steel
   0. 0.   1. 0.   1. 1.   0. 1.
   1 1.   1 1.
LAW    steel ARBTHMET
   STEEL isig.met martensitic
   STRESS 1.   {own}
{heat}FIXED  b 1 Y
FIXED  b 4 X
TRACT  b 3 Y {axial} pull
TRACT  b 2 X {radial} pull
LIC    pull
   0. 0.5   2. 1.
STRAT  0.25 1.E-4 0.25   9 3
STOP   2.
NORMS  FORCE 1.E-9 DISPL 1.E-10
SAVE   1000
PROBE  z POINT martensite 0.5 0.5
PROBE  p POINT mean_stress 0.5 0.5
PROBE  q POINT mises 0.5 0.5
END
"""
FIELD = """ADDEL  b PL8TM heat BILINEAR
LAW    heat METAMEC
   STEEL isig.met martensitic
   ENERGY 1. STRESS 1. ISIG {isig}
SOLVE  {solve}
START  T 350.
IMPOS  b 1 T cool 1.
IMPOS  b 3 T cool 1.
LIC    cool
   0. 350.   2. 150.
"""
GIVEN = "TEMPE  b 1. cool\nLIC    cool\n   0. 350.   2. 150.\n"
QUENCH = """TITLE  A bar quenched on its side, phases form under its stress
STATE  AXISYM
KINEM  LOG
BLOCK  b PL8LS 4 steel
   0. 0.   10. 0.   10. 10.   0. 10.
   6 0.4   1 1.
LAW    steel ARBTHMET
   STEEL isig.met bainitic
   STRESS 1.   {own}
ADDEL  b PL8TM heat BILINEAR
LAW    heat {law}
   STEEL isig.met bainitic
   ENERGY 1. {isig}
SOLVE  {solve}
START  T 700.
FIXED  b 1 Y
FIXED  b 4 X
CONVE  b 2 H 3. TS 20.
STRAT  0.05 1.E-5 {step}   9 3   0.25 1.3
STOP   30.
NORMS  FORCE 1.E-9 DISPL 1.E-9 PATH 0. RATE 0.
SAVE   1000
PROBE  z MEAN martensite b/PL8TM
PROBE  bain MEAN bainite b/PL8TM
PROBE  side POINT stress_yy 10. 5.
PROBE  core POINT stress_yy 0. 5.
END
"""


def done(checks, name, text):
    """Its history, or None."""
    write(checks.path(name, "isig.met"), STEEL)
    deck = write(checks.path(name, "a.lag"), text)
    result = run([deck, "--out", checks.path(name, "out"), "--threads", "1"])
    return history(checks.path(name, "out")) if checks.that(result.returncode == DONE, f"{name}: runs", said(result)) else None


def element(checks, name, axial, radial):
    """Martensite by its formula under the stress that was found, at each step."""
    for kinem in ("SMALL", "LOG"):
        for way in ("CONVERGE", "MONOLITHIC", "ONCE", "given"):
            own = "TIME 1. ISIG 1" if way in ("MONOLITHIC", "given") else ""
            heat = GIVEN if way == "given" else FIELD.format(isig=1, solve=way)
            rows = done(checks, f"{name}_{kinem}_{way}", ELEMENT.format(kinem=kinem, own=own, heat=heat, axial=axial, radial=radial))
            if not rows:
                continue
            # METAMEC reads Cauchy's stress, a law in LOG has the Kirchhoff stress: more by the elastic volume
            own_stress = kinem == "LOG" and own
            worst = 0.0
            for k, time in enumerate(rows["time"]):
                p, q = (rows[c][max(0, k - 1) if way == "ONCE" else k] for c in ("p", "q"))
                volume = 1.0
                for _ in range(4 if own_stress else 0):
                    volume = math.exp(3*p*volume*(1 - 2*0.3)/205000)
                undercooling = MS + (A*p + B*q)*volume - (350 - 100*time)
                worst = max(worst, abs(rows["z"][k] - 1 + math.exp(-BETA*max(0.0, undercooling))))
            checks.that(worst < 1e-9, f"{name}, {kinem}, {way}: Koistinen and Marburger under stress", worst)
            checks.that(rows["z"][-1] > 0.5, f"{name}, {kinem}, {way}: martensite", rows["z"][-1])


def quench(checks, plain_iterations):
    """The ways of coupling agree, and stress acts."""
    stress, ends = "STRESS 1. ISIG 1", {}
    for way, own, step in (("MONOLITHIC", "TIME 1. ISIG 1", 0.5), ("ONCE", "", 0.25)):
        rows = done(checks, f"quench_{way}", QUENCH.format(own=own, law="METAMEC", isig=stress, solve=way, step=step))
        if rows and way == "MONOLITHIC":
            # 2.0 without the derivatives of latent heat by the stress
            checks.that(sum(rows["iterations"]) < 1.4*plain_iterations, "quench: iterations with stress on the kinetics",
                        (sum(rows["iterations"]), plain_iterations))
        if rows:
            ends[way] = [rows[c][-1] for c in ("z", "bain", "side", "core")]
    if len(ends) == 2:
        scale = [1.0, 1.0] + [max(abs(v) for v in ends["MONOLITHIC"][2:])]*2
        apart = max(abs(a - b)/s for a, b, s in zip(ends["MONOLITHIC"], ends["ONCE"], scale))
        checks.that(apart < 0.01, "quench: MONOLITHIC and ONCE", f"{apart:.2e}, {ends}")
    plain = done(checks, "quench_none", QUENCH.format(own="", law="META", isig="", solve="ONCE", step=0.25))
    off = done(checks, "quench_off", QUENCH.format(own="", law="METAMEC", isig="STRESS 1. ISIG 0", solve="ONCE", step=0.25))
    if plain and off and len(ends) == 2:
        checks.that(plain == off, "quench: METAMEC with ISIG 0 is META, to the bit")
        moved = plain["z"][-1] - ends["ONCE"][0]
        checks.that(abs(moved) > 5e-4, "quench: stress moves the mean of martensite", moved)


def fractions(checks):
    """One system with the fractions of the heat, and with those of the mechanics."""
    rows = {own: done(checks, f"fractions_{bool(own)}", QUENCH.format(own=own, law="META", isig="", solve="MONOLITHIC", step=0.5))
            for own in ("", "TIME 1.")}
    if not all(rows.values()):
        return 0
    for column in ("z", "bain", "side", "core"):
        one, other = (r[column][-1] for r in rows.values())
        checks.that(abs(one - other) < 1e-7*abs(one), f"fractions: {column}", (one, other))
    counts = [sum(r["iterations"]) for r in rows.values()]
    checks.that(counts[0] <= counts[1], "fractions: iterations", counts)
    return counts[0]


def plane_strain(checks):
    """Where a section is held the latent heat that stress drives must be in the matrix: without it no step converged."""
    rows = done(checks, "plane_strain", QUENCH.format(own="TIME 1. ISIG 1", law="METAMEC", isig="STRESS 1. ISIG 1", solve="MONOLITHIC",
                                                      step=0.5).replace("AXISYM", "PLSTN"))
    if rows:
        checks.that(sum(rows["iterations"]) < 4*len(rows["step"]), "plane strain: iterations", (sum(rows["iterations"]), len(rows["step"])))


def section(checks):
    """The section moves: its strain drives the latent heat as well. Without those columns 281 iterations."""
    text = QUENCH.format(own="TIME 1. ISIG 1", law="METAMEC", isig="STRESS 1. ISIG 1", solve="MONOLITHIC", step=0.5)
    rows = done(checks, "section", text.replace("AXISYM", "GPLSTN\nSECTN  E FREE\nSECTN  KX HELD\nSECTN  KY HELD"))
    if rows:
        checks.that(sum(rows["iterations"]) < 3.2*len(rows["step"]), "section: iterations", (sum(rows["iterations"]), len(rows["step"])))
        force = max(abs(value) for value in rows["section_force"])
        checks.that(force < 1e-6*100*abs(rows["side"][-1]), "section: no axial force, of nodal forces", force)


def held(checks):
    """In turns until all agree, and in one system, with the same steps."""
    for state in ("AXISYM", "PLSTN"):
        ends = {}
        for way, own in (("MONOLITHIC", "TIME 1. ISIG 1"), ("CONVERGE", "")):
            text = QUENCH.format(own=own, law="METAMEC", isig="STRESS 1. ISIG 1", solve=way, step=0.25).replace("AXISYM", state)
            text = text.replace("LOG", "SMALL").replace("STRAT  0.05", "STRAT  0.25").replace("9 3 ", "99 3 ").replace("STOP   30.", "STOP   14.")
            rows = done(checks, f"held_{state}_{way}", text)
            if rows:
                ends[way] = [rows[c][-1] for c in ("step", "z", "bain", "side", "core")]
        if len(ends) == 2:
            one, other = ends["MONOLITHIC"], ends["CONVERGE"]
            scale = [1.0, 1.0, 1.0] + [max(map(abs, one[3:]))]*2
            apart = max(abs(a - b)/s for a, b, s in zip(one, other, scale))
            checks.that(apart < 1e-5, f"held, {state}: CONVERGE is MONOLITHIC", f"{apart:.2e}, {ends}")
            checks.that(one[1] > 0.01, f"held, {state}: martensite", one[1])


def main():
    checks = Checks()
    plain_iterations = fractions(checks)
    element(checks, "tension", 400, 0)
    element(checks, "pressure", -300, -300)
    quench(checks, plain_iterations)
    plane_strain(checks)
    section(checks)
    held(checks)
    checks.end()


if __name__ == "__main__":
    main()
