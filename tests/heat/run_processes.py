#!/usr/bin/env python3
"""Heat treatment and hot processes against closed forms.

usage: run_processes.py [-v] [-k]

- `melting`: the one-phase problem of Stefan (H.S. Carslaw, J.C. Jaeger, Conduction of Heat in Solids, 2nd ed., section 11.2) on
  temperatures of 8 nodes with an interval of 0.01 K, and a square bar that freezes with a jump of the conductivity: no step is cut.
- `bree`: a wall under tension whose one face is heated in cycles (J. Bree, J. Strain Analysis 2 (1967) 226-238). With X the tension
  and Y the largest thermal stress over the yield stress, it shakes down at X = .6, Y = 1.5 (X + Y/4 < 1), and at Y = 2.5 it
  grows by 2 Y (1 - 2 sqrt((1 - X)/Y)) times the yield strain in a cycle.
- `waits`: a section before its torch comes, in which nothing moves yet: as few steps as elsewhere.
- `probes`: the mean temperature of a body is the heat that it took up over its capacity; the extremes are those of its nodes.
- `mirrored`: a quench of a tooth and of its mirror image, whose nodes are numbered otherwise: the same steps, iterations and temperatures.
- `stretched`: a bar drawn to twice its length conducts a quarter of the heat, in plane stress as in generalised plane strain.
- `first_geometry`: sides that lose heat stay where they began with small strains, as volumes do.
- `told`: warnings before a run.
- `pressed`: a ring quenched between rough dies, the upper one under a force that rests: Newton's method is not caught between points
  that stick and slip, where its matrix leads uphill; and an arch under a force that rests, which snaps through as it cools, to where it
  is pushed to by the same force when it is cold.
- `exchanged`: a disc quenched under a light die whose conductance grows with the pressure, by turns and in one system.
- `buckles`: a strip between walls that is heated beyond Euler's load (S.P. Timoshenko, J.M. Gere, Theory of Elastic Stability, 2nd ed.,
  section 2.1) bulges to the side that it is bent to by a fiftieth of its thickness, at any length of steps, and bears that load. A straight one stays as it is, and the run says
  that it is not stable.
- `rests`: a disc that becomes pearlite as it cools in turn fast and slowly, and then is warmed and cools without flow: the error of the stress that
  the closing table states is within a factor 3 of that against short steps, though steps of the hold err in round-off alone.
- `spent`: a polynomial of a steel whose conductivity, capacity or yield stress falls below 0 on the way: the run ends with 3 and says which, where.
"""
import json
import math
import os
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "patch"))
from hardening_steel import hardening_steel  # noqa: E402
from patch_support import Checks, Run  # noqa: E402

STEEL = """STEEL  s
SOURCE 'round numbers'
EXPAND TOTAL 0
PHASE  AUSTENITE
   LAMBDA 50
   RHOC   3.6
   E      200000
   NU     0.3
   ALPHA  1.E-5
   SY     200
   ET     0
STEEL  r
SOURCE 'conductivity that falls to a third, as that of martensite beside austenite'
EXPAND TOTAL 0
PHASE  AUSTENITE
   LAMBDA TABLE 20 45 860 15
   RHOC   4.5
   E      200000
   NU     0.3
   ALPHA  1.E-5
   SY     200
   ET     0
""" + hardening_steel("m", 1500, 6000)


PEARLITE = """STEEL  p
SOURCE 'round numbers of a steel that becomes pearlite'
TEMPS  MS 100
TTT    PEARLITE ZERO
   500 8 200
   550 2 40
   600 3 60
   680 30 600
   720 500 20000
MARTEN BETA 0.011
EXPAND TOTAL 20
TRIP   DESALOS
PHASE  ALL
   NU     0.3
   LAMBDA 30
   RHOC   4.5
   E      TABLE 20 205000  800 140000
PHASE  AUSTENITE
   ALPHA  22E-6
   SY     TABLE 20 140  300 100  800 40
   ET     500
PHASE  PEARLITE
   LATENT 400
   ALPHA  14E-6
   DEPS   0.008
   SY     TABLE 20 450  300 350  800 80
   ET     1500
   KTP    6E-5
PHASE  MARTENSITE
   ALPHA  12E-6
   DEPS   0.0105
   SY     1200
   ET     3000
   KTP    1E-4
"""

PRESSED = """LAW film COUL2D
   PHI 0.1
DIE die
   SEGM 4. -1.   4. 5.
CNT2D bar 2 die film
COU2DC bar 2 die H {conductance} HO {conductance} REACH 1.
TDIE die T 50.
"""


def law_file(checks):
    """The steel of these decks, beside them."""
    with open(os.path.join(checks.folder, "steel.met"), "w") as file:
        file.write(STEEL)


def last(run, name):
    return run.history[name][-1]


def summary(run):
    with open(os.path.join(run.out, "summary.json"), encoding="utf-8") as file:
        return json.load(file)


def told_of(run):
    """Warnings of a run but for that of its mesh, one element across a part is coarse for temperatures, and those of checks of its steps: these checks are of
    neither."""
    return [line["text"] for line in summary(run)["warnings"]
            if "check" not in line and not line["text"].startswith("the mesh is coarse for its temperatures: ")]


def melting(checks):
    conductivity, capacity, latent, cold, end = 2.2, 1.9e6, 3.06e8, -20., 7200.
    stefan = -cold*capacity/latent
    low, high = 0., 1.
    for _ in range(100):
        front = 0.5*(low + high)
        low, high = (front, high) if front*math.exp(front**2)*math.erf(front) < stefan/math.sqrt(math.pi) else (low, front)
    ice = """LAW    ice HEATH
   TEMP -50.
   2.2 0.
   TEMP -0.01
   2.2 49.99*1.9E6
   TEMP 0.
   %s 49.99*1.9E6+3.06E8
   TEMP 50.
   %s 49.99*1.9E6+3.06E8+50.*%s
"""
    run = Run(checks, "melting", "TITLE ice\nSTATE PLSTN\nKINEM SMALL\nBLOCK slab PL8TM 9 ice\n   0. 0.   0.1 0.   0.1 0.01   0. 0.01\n"
              "   20 1.   1 1.\n" + ice % ("2.2", "2.2", "1.9E6") + "START T 0.\nIMPOS slab 4 T cold\nLIC cold\n   0. -20.\n"
              "STRAT 1. 0.001 60. 6 3\nSTOP 7200.\nPROBE a NODE T 0.01 0.\nPROBE b NODE T 0.03 0.\nEND\n")
    if run.ok:
        for name, x in (("a", 0.01), ("b", 0.03)):
            share = math.erf(x/2/math.sqrt(conductivity/capacity*end))/math.erf(front)
            checks.small(abs(last(run, name) - cold*(1 - share)), 0.1, f"melting: temperature at {x} [K]")
        checks.that(last(run, "cutbacks") == 0, "melting: no step is cut")
    run = Run(checks, "bar", "TITLE ice\nSTATE PLSTN\nKINEM SMALL\nBLOCK bar PL8TM 9 ice\n   0. 0.   0.05 0.   0.05 0.05   0. 0.05\n"
              "   4 1.   4 1.\n" + ice % ("0.55", "0.55", "4.2E6") + "START T 10.\nCONVE bar 2 3 H 200. TS -20.\n"
              "STRAT 1. 0.001 100. 6 3\nSTOP 4000.\nEND\n")
    if run.ok:
        checks.that(last(run, "cutbacks") == 0, "bar that freezes: no step is cut")


def bree(checks):
    for hot, growth in ((300., 0.), (500., 2*2.5e-3*(1 - 2*math.sqrt(0.4/2.5)))):
        run = Run(checks, f"bree-{hot:.0f}", f"TITLE Bree\nSTATE GPLSTN\nSECTN E FORCE 120.*0.02 load\nSECTN KX HELD\nSECTN KY HELD\n"
                  "KINEM SMALL\nBLOCK wall PL8LS 4 steel\n   0. 0.   1. 0.   1. .02   0. .02\n   20 1.   1 1.\nLAW steel ARBTHMET\n"
                  "   STEEL steel.met s\n   STRESS 1.\nADDEL wall PL8TM hot\nLAW hot META\n   STEEL steel.met s\n   ENERGY 1.\nSTART T 0.\n"
                  "FIXED wall 4 X\nFIXED wall 1 Y\nIMPOS wall 4 T zero\nIMPOS wall 2 T cycle " + f"{hot}\n"
                  "LIC zero\n   0. 0.\nLIC load\n   0. 0. 1. 1.\nLIC cycle\n   0. 0. 10. 0. 20. 1. 30. 0. 40. 1. 50. 0. 60. 1.\n"
                  "STRAT 0.5 1.E-4 2. 5 3\nEND\n")
        if not run.ok:
            continue
        at = dict(zip((round(t, 6) for t in run.history["time"]), run.history["section_strain"]))
        checks.small(abs(at[60.] - at[40.] - growth)/5e-4, 5e-3, f"Bree, {hot:.0f} K: growth in a cycle")


def waits(checks):
    run = Run(checks, "waits", "TITLE torch\nSTATE GPLSTN\nSECTN E FREE\nSECTN KX HELD\nSECTN KY FREE\nKINEM SMALL\n"
              "BLOCK plate PL8LS 4 steel\n   0. 0.   20. 0.   20. 6.   0. 6.\n   8 4.   2 1.\nLAW steel ARBTHMET\n   STEEL steel.met s\n"
              "   STRESS 1.\nADDEL plate PL8TM hot BILINEAR\nLAW hot META\n   STEEL steel.met s\n   ENERGY 1.\nSTART T 20.\n"
              "FIXED plate 4 X\nFIXED POINT 20. 0. Y\nCONVE plate 1 2 H 0.02 TS 20.\n"
              "GOLDAK plate P 1.E6 on ETA 0.8 FRONT 4. REAR 8. WIDTH 3. DEPTH 3. INTO 0. -1. CROSS 6. 2.\n   0. 0. 6.\nLIC on\n   0. 1.\n"
              "STRAT 0.02 1.E-5 0.5 6 3\nSTOP 2.\nEND\n")
    if run.ok:
        checks.that(last(run, "step") < 120, "torch that is waited for: few steps")


def exchanged(checks):
    """Turns went to and fro (31 cutbacks), and one system without the columns of points that slide took 311 steps."""
    for way, force, stop, most in (("CONVERGE", 2e4, 1.0, 60), ("MONOLITHIC", 2e3, 0.2, 60)):
        run = Run(checks, f"exchanged-{way}", "TITLE disc\nSTATE AXISYM\nKINEM LOG\nBLOCK disc PL8LS 4 steel\n   20. 0.   60. 0.   60. 6.   20. 6.\n"
                  "   10 1.   4 0.5\nLAW steel ARBTHMET\n   STEEL steel.met m\n   STRESS 1.\nADDEL disc PL8TM heat BILINEAR\nLAW heat META\n"
                  "   STEEL steel.met m\n   ENERGY 1.\nSTART T 850.\nLAW film COUL2D\n   PENETR 1.E-3 PHI 0.15\nFIXED disc 1 Y\n"
                  "DIE upper PILOT 0. 6.\n   SEGM 80. 6. 1. 6.\nCNT2D disc 3 upper film\nTDIE upper T 40.\nCOU2DC disc 3 upper H 10. REACH 1.\n"
                  "   PRESS 0. 0.2   20. 1.\n   GAP 0. 0.2   0.05 0.05   0.5 0.02\nCONVE disc 2 4 H 4. TS 40.\n"
                  f"FORCE upper Y {-force}/(2*pi) f\nLIC f\n   0. 1.\nSOLVE {way}\nSTRAT 0.001 1.E-6 0.5 6 3\nSTOP {stop}\nEND\n")
        if not run.ok:
            continue
        checks.that(last(run, "cutbacks") <= 2, f"{run.name}: cutbacks", last(run, "cutbacks"))
        checks.that(last(run, "step") <= most, f"{run.name}: steps", last(run, "step"))


def pressed(checks):
    run = Run(checks, "pressed", "TITLE press quench\nSTATE AXISYM\nKINEM LOG\nBLOCK ring PL8LS 4 steel\n   25. 0.   75. 0.   75. 8.   25. 8.\n"
              "   16 1.   3 1.\nLAW steel ARBTHMET\n   STEEL steel.met m\n   STRESS 1.\nADDEL ring PL8TM heat BILINEAR\nLAW heat META\n"
              "   STEEL steel.met m\n   ENERGY 1.\nSTART T 850.\nLAW dry COUL2D\n   PENETR 1.E-3 PHI 0.4\n"
              "DIE lower PILOT 0. 0.\n   SEGM 40. -5. 40. 0.\n   FILLT 1. 1.E-3\n   SEGM 40. 0. 68. 0.\n   FILLT 1. 1.E-3\n   SEGM 68. 0. 68. -5.\n"
              "DIE upper PILOT 0. 8.\n   SEGM 64. 13. 64. 8.\n   FILLT 1. 1.E-3\n   SEGM 64. 8. 30. 8.\n   FILLT 1. 1.E-3\n   SEGM 30. 8. 30. 13.\n"
              "DIE mandrel PILOT 0. 0.\n   SEGM 24.9 13. 24.9 -5.\nCNT2D ring 1 lower dry\nCNT2D ring 3 upper dry\nCNT2D ring 4 mandrel dry\n"
              "FORCE upper Y -2.E5 hold\nLIC hold\n   0. 0.   0.1 1.\nCONVE ring 2 4 H 3. TS 50.\nCONVE ring 1 H 0.8 TS 50.\nCONVE ring 3 H 2. TS 50.\n"
              "COU2DC ring 1 lower H 3.\nCOU2DC ring 3 upper H 3.\nCOU2DC ring 4 mandrel H 3.\nTDIE lower T 60.\nTDIE upper T 60.\nTDIE mandrel T 60.\n"
              "THETA 1. TOL 3.\nSTRAT 0.01 1.E-6 5. 14 9 0.25 1.5\nSTOP 12.\nEND\n")
    if run.ok:
        # 24 before, the shortest step 1e-6
        checks.that(last(run, "cutbacks") <= 3, "pressed: no step is caught", last(run, "cutbacks"))
        checks.small(abs(last(run, "force_y_upper")/2e5 - 1), 1e-6, "pressed: the force is borne")
        checks.that(summary(run)["accuracy"]["heat"].get("contact_places_known") is False, "pressed: errors of where contact stands are not among those told",
                    summary(run)["accuracy"]["heat"])
    tips = []
    # cold before it is pushed, or pushed before it is cold
    for name, heat, motion in (("cools", "0. 600.   1. 600.   2. 20.", "FORCE POINT 0. 6. Y -25. push\nLIC push\n   0. 0.   1. 1.\n"),
                               ("pushed", "0. 600.   0.5 20.", "MOVE POINT 0. 6. Y push {tip}\nLIC push\n   0. 0.   0.5 0.   2. 1.\n"
                                "PROBE force REACT Y POINT 0. 6.\n")):
        run = Run(checks, f"arch-{name}", "TITLE arch\nSTATE PLSTN\nKINEM LOG\nBLOCK arch PL8LS 4 steel\n   0. 5.   50. 0.   50. 1.   0. 6.\n"
                  "   20 1.   2 1.\nLAW steel ELATH\n   200000. 0.3 1.2E-5\nTEMPE arch 1. heat\n"
                  f"LIC heat\n   {heat}\nFIXED arch 2 XY\nFIXED arch 4 X\nPROBE tip NODE UY 0. 6.\n" + motion.format(tip=tips[-1] if tips else 0)
                  + "STRAT 0.01 1.E-6 0.05 5 3\nSTOP 2.\nEND\n")
        if not run.ok:
            return
        tips.append(last(run, "tip"))
    checks.that(tips[0] < -3, "arch: it has snapped through", tips)
    checks.small(abs(last(run, "force")/-25 - 1), 1e-4, "arch: the force that it was cooled under")


STRIP = """TITLE  A strip between walls, heated
STATE  PLSTS
KINEM  LOG
BLOCK  strip PL8LS 4 steel
   0. 0.   50. {bend}   50. 1+{bend}   0. 1.
   40 1.   2 1.
   SIDE 1 MID 25. .55*{bend}
   SIDE 3 MID 25. 1+.55*{bend}
LAW    steel ELATH
   200000. 0.3 1.E-5
TEMPE  strip 400. up
LIC    up
   0. 0.   1. 1.
FIXED  strip 4 XY
FIXED  strip 2 X
STRAT  {step} 1.E-6 {step} 5 3
STOP   1.
PROBE  middle NODE UY 50. {bend}
PROBE  force REACT X strip 4
END
"""


def buckles(checks):
    euler = 4*math.pi**2*200000/12/100**2
    ends = []
    for bend, step in ((0.02, 0.01), (0.02, 0.05), (0.02, 0.2), (0.02, 1.0), (0.0002, 1.0)):
        run = Run(checks, f"buckles-{bend}-{step}", STRIP.format(bend=bend, step=step))
        if not run.ok:
            return
        ends.append(last(run, "middle"))
        checks.small(abs(last(run, "force")/euler - 1), 0.012, f"buckles from {bend} in steps of {step}: Euler's load")
    # matrices that are not symmetric; a strip that cannot stretch sideways expands by 1 + nu of it more along itself
    heated = STRIP.format(bend=0.02, step=0.2)
    for name, text in (("objective rates", heated.replace("KINEM  LOG", "KINEM  JAUMANN")),
                       ("mean dilatation", heated.replace("STATE  PLSTS", "STATE  PLSTN").replace("PL8LS 4 steel", "PL8LS 9 steel MEAN")
                        .replace("400. up", "400./1.3 up")),
                       ("heat in one system", heated.replace("TEMPE  strip 400. up", "ADDEL strip PL8TM heat BILINEAR\nLAW heat HEAT\n   28. 4.9\n"
                                                             "SOLVE MONOLITHIC\nSTART T 0.\nIMPOS strip 1 T up 400.\nIMPOS strip 3 T up 400.")),
                       ("pressure that follows", heated.replace("TEMPE ", "PRES2D strip 1 2 .001 up\nTEMPE "))):
        run = Run(checks, f"buckles-{name.replace(' ', '-')}", text)
        if run.ok:
            checks.small(abs(last(run, "middle")/ends[0] - 1), 0.01, f"buckles with {name}: to the side that it is bent to")
    run = Run(checks, "buckles-straight", STRIP.format(bend=0, step=0.2))
    if run.ok:
        checks.that(last(run, "force") > 10*euler and any("are not stable" in line["text"] for line in summary(run)["warnings"]),
                    "buckles: a straight strip stays so, and that is told", summary(run)["warnings"])
    checks.that(ends[0] > 3, "buckles: to the side that it is bent to", ends[0])
    checks.small(max(abs(end/ends[0] - 1) for end in ends[:-1]), 1e-4, "buckles: the same in steps of any length")
    checks.small(abs(ends[-1]/ends[0] - 1), 0.01, "buckles: nearly the same from a hundredth of the bend, in one step")


def rests(checks):
    """Claimed error of the stress of a part that has cooled and is warmed, against short steps."""
    with open(os.path.join(checks.folder, "pearlite.met"), "w") as file:
        file.write(PEARLITE + "END\n")
    names = [f"{part}{k}" for k in range(6) for part in ("stress_xx", "stress_yy", "stress_zz")]
    probes = "".join(f"PROBE {part}{k} POINT {part} {8*k}. {2*k}.\n" for k in range(6) for part in ("stress_xx", "stress_yy", "stress_zz"))
    stops = (("water", 6., 20., 4., 2.), ("air", 0.04, 20., 60., 20.), ("oil", 1., 60., 300., 20.))
    operations = "".join(f"OPERA {name}\nCONVE d 2 3 H {h} TS {around}\nSTRAT 0.01 1.E-5 {step} 8 4 0.25 2.\nSTOP {stop}\n"
                         for name, h, around, stop, step in stops)
    stress = {}
    for name, bounds in (("usual", ""), ("short", "NORMS PATH 0.01 RATE 0.0005\n")):
        run = Run(checks, f"rests-{name}", "TITLE rests\nSTATE AXISYM\nKINEM LOG\nBLOCK d PL8LS 4 s\n   0. 0.   40. 0.   40. 10.   0. 10.\n   8 0.4   5 0.4\n"
                  "LAW s ARBTHMET\n   STEEL pearlite.met p\n   STRESS 1.\nADDEL d PL8TM h BILINEAR\nLAW h META\n   STEEL pearlite.met p\n   ENERGY 1.\n"
                  f"THETA TRBDF2 TOL 2.\nSTART T 870.\nFIXED d 1 Y\nFIXED d 4 X\n{bounds}{probes}{operations}"
                  "OPERA temper\nCONVE d 2 3 H 0.1 TS 1. f\nLIC f\n   0. 60.   600. 560.   4200. 560.   4800. 20.   5200. 20.\n"
                  "STRAT 0.01 1.E-5 2000. 8 4 0.25 3.\nSTOP 5200.\nEND\n")
        if not run.ok:
            return
        stress[name] = [last(run, column) for column in names]
        if name == "usual":
            claimed = summary(run)["accuracy"]["path"]["stress_pct"]
    error = 100*math.dist(stress["usual"], stress["short"])/math.hypot(*stress["short"])
    checks.that(error/3 < claimed < 3*error, f"rests: error of the stress, claimed {claimed:.2f} %, {error:.2f} % found", claimed)


def spent(checks):
    # each falls with the temperature and is 0 at 400
    for word, number in (("LAMBDA", "POLY -80 0.2"), ("RHOC", "POLY -4 0.01"), ("SY", "POLY -400 1.")):
        with open(os.path.join(checks.folder, "spent.met"), "w") as file:
            file.write("STEEL p\nSOURCE 'round numbers'\nEXPAND TOTAL 0\nPHASE AUSTENITE\n" + "".join(
                f"   {name} {number if name == word else value}\n"
                for name, value in (("LAMBDA", "50"), ("RHOC", "3.6"), ("E", "200000"), ("NU", "0.3"), ("ALPHA", "1.E-5"), ("SY", "200"), ("ET", "0"))) + "END\n")
        run = Run(checks, f"spent-{word.lower()}", "TITLE spent\nSTATE PLSTN\nKINEM SMALL\nBLOCK bar PL8LS 4 steel\n   0. 0.   4. 0.   4. 4.   0. 4.\n"
                  "   2 1.   2 1.\nLAW steel ARBTHMET\n   STEEL spent.met p\n   STRESS 1.\nADDEL bar PL8TM hot BILINEAR\nLAW hot META\n"
                  "   STEEL spent.met p\n   ENERGY 1.\nSTART T 700.\nFIXED bar 1 Y\nFIXED bar 4 X\nIMPOS bar 2 T cools 1.\nLIC cools\n   0. 700.   10. 100.\n"
                  "STRAT 0.1 1.E-5 0.2 5 3\nSTOP 10.\nEND\n", code=3)
        checks.that(f"{word} of austenite" in run.said.lower().replace(word.lower(), word), f"spent: {word} is named", run.said[-400:])


def probes(checks):
    for option in ("", " BILINEAR"):
        run = Run(checks, "probes" + option.strip(), f"TITLE ball\nSTATE AXISYM\nKINEM SMALL\nBLOCK ball PL8TM 9 steel{option}\n"
                  "   0.5 0.   2. 0.   0. 2.   0. 0.5\n   3 1.   6 1.\n   SIDE 2 ARC 0. 0.\n   SIDE 4 ARC 0. 0.\nLAW steel HEAT\n   4. 4.\n"
                  "START T 20.\nFLUX ball 2 Q 3.\nSTRAT 0.1 1.E-3 0.1 4 3\nSTOP 1.\nPROBE mean MEAN T ball\nPROBE most MAX T ball\n"
                  "PROBE least MIN T ball\nPROBE skin NODE T 2. 0.\nPROBE bore NODE T 0.5 0.\nNORMS FORCE 1.E-12 DISPL 1.E-12\nEND\n")
        if not run.ok:
            continue
        volume = 2*math.pi/3*(2**3 - 0.5**3)
        checks.small(abs(last(run, "heat_stored")/(4*volume)/(last(run, "mean") - 20) - 1), 1e-3, f"{run.name}: mean temperature")
        checks.that(last(run, "most") >= last(run, "skin") > last(run, "bore") >= last(run, "least") > 20, f"{run.name}: extremes")


def mirrored(checks):
    """The conductivity of a steel changes with its temperature, and its matrix is not symmetric: Newton's method must not depend on
    which half of it the numbers of the nodes put above the diagonal."""
    runs = []
    for sign in (1, -1):
        corners = [(0, 0), (3, 0), (1.5, 6), (0, 6)]
        if sign < 0:
            corners = [(-corners[k][0], corners[k][1]) for k in (1, 0, 3, 2)]
        flank = 2 if sign > 0 else 4
        points = " ".join(f"{x} {y}" for x, y in corners)
        runs.append(Run(checks, f"mirrored-{'right' if sign > 0 else 'left'}", f"TITLE mirrored\nSTATE PLSTN\nKINEM SMALL\n"
                        f"BLOCK tooth PL8TM 4 heat BILINEAR\n   {points}\n   4 1. 6 0.5\nLAW heat META\n   STEEL steel.met r\n   ENERGY 1.\n"
                        f"START T 860.\nCONVE tooth {flank} 3 H 4. TS 60.\nSTRAT 0.05 1.E-5 1. 4 3\nSTOP 10.\nPROBE t NODE T 0. 0.\nEND\n"))
    if all(run.ok for run in runs):
        right, left = (run.history for run in runs)
        checks.that(not summary(runs[0])["symmetric"], "mirrored: the matrix is not symmetric")
        checks.that(len(right["t"]) == len(left["t"]) and all(right["iterations"] == left["iterations"]), "mirrored: the same steps and iterations",
                    (list(right["iterations"]), list(left["iterations"])))
        checks.small(abs(right["t"][-1] - left["t"][-1]), 1e-6, f"mirrored: {right['t'][-1]:.6f} degC, in K")
        checks.that(max(right["iterations"]) <= 3, "mirrored: quadratic convergence", list(right["iterations"]))


def stretched(checks):
    """A body that keeps its volume, drawn to twice its length, conducts a quarter of the heat: half the section, twice the way."""
    for state, more in (("PLSTS 0.5", ""), ("GPLSTN 0.5", "SECTN E FREE\nSECTN KX HELD\nSECTN KY HELD\n")):
        for kind, solve in (("", "ONCE"), ("BILINEAR", "MONOLITHIC")):
            run = Run(checks, f"stretched-{state[:5]}-{solve}", f"TITLE stretched\nSTATE {state}\n{more}KINEM LOG\nBLOCK b PL8LS 4 s\n   0. 0. 10. 0. 10. 10. 0. 10.\n"
                      f"   3 1. 3 1.\nLAW s EPLA\n   200000. 0.3\n   LINEAR 1. 1.\nADDEL b PL8TM h {kind}\nLAW h HEAT\n   10. 1.E-3\nIMPOS b 4 T on 0.\n"
                      "IMPOS b 2 T on 100.\nFIXED b 1 Y\nFIXED b 4 X\nMOVE b 2 X pull 10.\nLIC on\n   0. 1.\nLIC pull\n   0. 0. 1. 1. 1.2 1.\n"
                      f"SOLVE {solve}\nSTRAT 0.02 1.E-6 0.04 50 3\nEND\n")
            if run.ok:
                flow = run.history["heat_through_b.2/IMPOS"][-1]
                checks.small(abs(flow/(10*100/10*10*0.5/4) - 1), 3e-4, f"{run.name}: {flow:.3f}")


def first_geometry(checks):
    """With small strains sides stay where they began: a block that shrinks by 4 % as it cools loses what one without expansion loses."""
    for state in ("PLSTN", "AXISYM", "PLSTS"):
        for solve in ("ONCE", "MONOLITHIC"):
            runs = [Run(checks, f"first-{state}-{solve}-{alpha}", f"TITLE first\nSTATE {state}\nKINEM SMALL\nBLOCK b PL8LS 4 s\n   2. 0. 10. 0. 10. 4. 2. 4.\n"
                        f"   3 1. 2 1.\nLAW s ELATH\n   200000. 0.3 {alpha}\nADDEL b PL8TM h BILINEAR\nLAW h HEAT\n   30. 4.5\nSTART T 500.\nFIXED b 1 Y\n"
                        f"FIXED POINT 2. 0. X\nCONVE b 2 H 3. TS 20.\nRADIA b 3 EPS 0.8 SIGMA 5.67E-9 ZERO 273.15 TS 20.\nFLUX b 4 Q -50.\nSOLVE {solve}\n"
                        "STRAT 0.1 1.E-3 0.2 5 3\nSTOP 4.\nPROBE t NODE T 10. 4.\nEND\n") for alpha in ("0.", "1.E-4")]
            if all(run.ok for run in runs):
                for name in ("t", "heat_through_b.2/CONVE", "heat_through_b.3/RADIA", "heat_through_b.4/FLUX"):
                    still, moved = (last(run, name) for run in runs)
                    checks.small(abs(moved/still - 1), 1e-7, f"{runs[0].name[:-3]}: {name}, {still:.6g}")


def told(checks):
    with open(os.path.join(checks.folder, "firm.met"), "w") as file:
        file.write("STEEL s\nSOURCE 'round numbers'\nTEMPS MS 300\nMARTEN BETA 0.011\nEXPAND TOTAL 20\nTRIP TANAKA\nPHASE ALL\n   LAMBDA 30\n   RHOC 4.5\n   E 2E5\n   NU 0.3\n"
                   "   ALPHA 1E-5\n   SY 300\nPHASE MARTENSITE\n   DEPS 0.01\n   KTP 0\nEND\n")
    steel = "STEEL s\nSOURCE 'round numbers'\nTEMPS MS 300\nMARTEN BETA 0.011\nPHASE ALL\n   LAMBDA 30\n   RHOC 4.5\nEND\n"
    with open(os.path.join(checks.folder, "soft.met"), "w") as file:
        file.write(steel)
    run = Run(checks, "told", "TITLE told\nSTATE PLSTN\nKINEM SMALL\nBLOCK bar PL8TM 4 hot BILINEAR\n   0. 0.   4. 0.   4. 4.   0. 4.\n"
              "   2 1.   2 1.\nLAW hot META\n   STEEL soft.met s\n   ENERGY 1.\nCONVE bar 2 H 1. TS 20.\nCONVE bar 2 3 H 1. TS 20.\n"
              "PROBE h MEAN hardness bar\nSTRAT 1. 1. 1. 4 3\nSTOP 1.\nEND\n")
    if run.ok:
        warnings = summary(run)["warnings"]
        for words in ("bar: it begins as austenite at 0, below Ms of the steel s (300 degC)", "2 sides of elements are on both",
                      "the steel s has no hardness"):
            checks.that(sum(words in line["text"] for line in warnings) == 1, f"told: {words}", warnings)
    # hardness by Maynier of a bearing steel, of what is there at the start; none of these where phases have HV, or nothing is beyond
    for carbon, start, hv, beyond, unknown in ((1.0, "", "", True, False), (0.05, "", "", True, False), (0.4, "", "", False, False),
                                               (0.4, "START PHASES PEARLITE 1.\n", "", False, True),
                                               (1.0, "START PHASES PEARLITE 1.\n", "PHASE ALL\n   HV 300\n", False, False)):
        with open(os.path.join(checks.folder, "hard.met"), "w") as file:
            file.write(f"STEEL s\nSOURCE 'round numbers'\nCOMPO C {carbon} MN 0.7 SI 0.2\nLI 7\nHARDN MAYNIER\nPHASE ALL\n   LAMBDA 30\n   RHOC 4.5\n"
                       f"{hv[10:]}END\n")
        run = Run(checks, f"hard-{carbon}-{len(start)}-{len(hv)}", "TITLE hard\nSTATE PLSTN\nKINEM SMALL\nBLOCK bar PL8TM 4 hot BILINEAR\n   0. 0.   4. 0.   4. 4.   0. 4.\n"
                  f"   2 1.   2 1.\nLAW hot META\n   STEEL hard.met s\n   ENERGY 1.\nSTART T 600.\n{start}CONVE bar 2 H 1. TS 20.\nPROBE h MEAN hardness bar\n"
                  "STRAT 1. 1. 1. 4 3\nSTOP 1.\nEND\n")
        if run.ok:
            lines = [line["text"] for line in summary(run)["warnings"]]
            checks.that(sum(f"the steel s: C {carbon:g} (0.1 to 0.5) is beyond the mass per cent that Maynier" in line for line in lines) == beyond, f"{run.name}: range told", lines)
            checks.that(sum("has no HV of PEARLITE, which START PHASES gives" in line for line in lines) == unknown, f"{run.name}: start told", lines)
            checks.that(sum(f"the steel s: C {carbon:g} (0.2 to 0.41) is beyond the mass per cent of the steels that Li" in line for line in lines)
                        == (carbon != 0.4), f"{run.name}: range of kinetics told", lines)
    # numbers that no steel has beside others
    sound = ("STEEL s\nSOURCE 'round numbers'\nTEMPS AE1 727 AE3 780 AC1 740 AC3 800 BS 550 MS 300\nTTT BAINITE ZERO\n   350 10 100\n   540 10 100\nMARTEN BETA 0.011\n"
             "AUSTEN 1 1\nPHASE ALL\n   LAMBDA 30\n   RHOC 4.5\n   E 2E5\n   SY TABLE 20 300 800 30\nEND\n")
    for old, new, words in (("", "", ""), ("MS 300", "MS 573", "Ms (573) is above Bs (550)"), ("AE1 727", "AE1 827", "Ae1 (827) is above Ae3 (780)"),
                            ("   540", "   640", "the curve of BAINITE (640) is above Bs (550)"), ("TEMPS", "COMPO C 0.0037 MN 0.0077 CR 0.0098\nTEMPS", "elements of COMPO are 0.0212 per cent in all, less than in any steel"),
                            ("BETA 0.011", "BETA 11", "BETA of MARTEN is 11 1/K, that of steels 0.002 to 0.2"),
                            ("E 2E5", "E 200", "AUSTENITE yields at 1.5 of E at 20 degC, steels below 0.03: SY and E are in MPa"),
                            ("END", "PHASE MARTENSITE\n   LATENT 640\nEND", ""),
                            ("END", "PHASE MARTENSITE\n   LATENT 82000\nEND", "LATENT of MARTENSITE is 82000 MJ/m3 at 400 degC, that of steels below 3000"),
                            ("END", "TRIP DESALOS\nPHASE MARTENSITE\n   KTP 8E-11\nEND", "KTP of MARTENSITE is 8e-11 1/MPa, that of steels 1e-5 to 2e-4"),
                            ("END", "TEMPER\n   MARTENSITE 1E9 1.2E5 0.5\n   HV TABLE 9000 632 18718 269\nEND", "HV of TEMPER is by P/1000, 8 to 30, not by P up to 18718"),
                            ("END", "EXPAND TOTAL 20\nPHASE AUSTENITE\n   ALPHA 22E-6\nPHASE MARTENSITE\n   ALPHA 12E-6\n   DEPS -0.0105\nEND",
                             "MARTENSITE is smaller than the austenite that it forms from, by a strain of 0.0133 at Ms"),
                            ("END", "EXPAND TOTAL 20\nPHASE AUSTENITE\n   ALPHA 22E-6\nPHASE MARTENSITE\n   ALPHA 12E-6\n   DEPS 0.0105\nEND", "")):
        with open(os.path.join(checks.folder, "odd.met"), "w") as file:
            file.write(sound.replace(old, new))
        run = Run(checks, f"odd-{words[:6] or 'none'}", "TITLE odd\nSTATE PLSTN\nKINEM SMALL\nBLOCK bar PL8TM 4 hot BILINEAR\n   0. 0.   4. 0.   4. 4.   0. 4.\n   2 1.   2 1.\n"
                  "LAW hot META\n   STEEL odd.met s\n   ENERGY 1.\nSTART T 850.\nCONVE bar 2 H 1. TS 20.\nSTRAT 1. 1. 1. 4 3\nSTOP 1.\nEND\n")
        if run.ok:
            lines = [line["text"] for line in summary(run)["warnings"] if "the steel s: " in line["text"]]
            checks.that(len(lines) == (words != "") and all(words in line and line.endswith("odd.met:1:7)") for line in lines), f"{run.name}: told", lines)
    # heat capacities in other units, where nothing moves
    for numbers, stop, told in (("50. 3.6E6", 100., True), ("5.E-5 3.6", 100., True), ("50. 3.6", 100., False), ("50. 3.6", 0.1, False)):
        run = Run(checks, f"capacity-{numbers.replace(' ', '-')}-{stop:g}", "TITLE capacity\nSTATE PLSTN\nKINEM SMALL\nBLOCK bar PL8TM 4 hot BILINEAR\n   0. 0.   40. 0.   40. 10.   0. 10.\n"
                  f"   8 1.   4 1.\nLAW hot HEAT\n   {numbers}\nSTART T 900.\nCONVE bar 2 H 1. TS 20.\nSTRAT {stop/10} {stop/1000} {stop/4} 4 3\nSTOP {stop}\nEND\n")
        if run.ok:
            lines = [line["text"] for line in summary(run)["warnings"] if "LAMBDA and RHOC heat goes no further" in line["text"]]
            checks.that(len(lines) == told, f"{run.name}: told", lines)
    # cold phases above Ac3; heat in other units
    with open(os.path.join(checks.folder, "odd.met"), "w") as file:
        file.write(sound)
    for more, start, words in (("START PHASES PEARLITE 1.\n", 850, "bar: it begins at 850, above Ac3 of the steel s (800 degC), and is no austenite"),
                               ("START PHASES PEARLITE 1.\n", 750, ""), ("HEATS bar Q 1.E8\n", 850, "hotter than where any metal boils"), ("HEATS bar Q 1.E3\n", 850, "")):
        run = Run(checks, f"hot-{start}-{len(more)}-{len(words)}", "TITLE hot\nSTATE PLSTN\nKINEM SMALL\nBLOCK bar PL8TM 4 hot BILINEAR\n   0. 0.   4. 0.   4. 4.   0. 4.\n   2 1.   2 1.\n"
                  f"LAW hot META\n   STEEL odd.met s\n   ENERGY 1.\nSTART T {start}.\n{more}CONVE bar 2 H 1. TS 20.\nSTRAT 1. 1. 1. 4 3\nSTOP 1.\nEND\n")
        if run.ok:
            lines = [line["text"] for line in summary(run)["warnings"] if "no austenite" in line["text"] or "boils" in line["text"]]
            checks.that(len(lines) == (words != "") and all(words in line for line in lines), f"{run.name}: told", lines)
    # heat of a change of volume in plane stress
    for state, source, words in (("PLSTS", 1207.5, True), ("PLSTN", 1207.5, False), ("PLSTS", 0., False)):
        run = Run(checks, f"sheet-{state}-{source:g}", f"TITLE sheet\nSTATE {state}\nKINEM SMALL\nBLOCK bar PL8LS 4 s\n   0. 0.   4. 0.   4. 4.   0. 4.\n   2 1.   2 1.\n"
                  f"LAW s ELATH\n   70000. 0.3 23.E-6\nADDEL bar PL8TM h BILINEAR\nLAW h HEAT\n   200. 2.4\n   SOURCE {source}\nSTART T 300.\nFIXED bar 1 Y\nFIXED bar 4 X\n"
                  "TRACT bar 3 Y 200. up\nLIC up\n   0. 0. 1. 1.\nSOLVE CONVERGE\nSTRAT 0.5 1.E-5 0.5 4 3\nPROBE t MEAN T bar\nEND\n")
        if run.ok:
            lines = [line["text"] for line in summary(run)["warnings"] if "the change of the area" in line["text"]]
            checks.that(len(lines) == words and all(line.startswith("LAW h: ") for line in lines), f"{run.name}: told", lines)
    # a torch by its card
    run = Run(checks, "torches", "TITLE torches\nSTATE PLSTN\nKINEM SMALL\nBLOCK bar PL8TM 4 hot BILINEAR\n   0. 0.   40. 0.   40. 20.   0. 20.\n   20 1.   10 1.\n"
              "LAW hot HEAT\n   30. 4.5\nSTART T 20.\nGOLDAK bar P 2.E6 ETA 0.8 FRONT 3. REAR 6. WIDTH 4. DEPTH 4. INTO 0. -1. CROSS 8. 3.\n   0. 20. 20.\n"
              "GOLDAK bar P 2.E6 ETA 0.8 FRONT 3. REAR 6. WIDTH 4. DEPTH 4. INTO 0. -1. CROSS 8. 6.\n   0. 0. 20.\nTHETA TRBDF2 TOL 5.\nSTRAT 0.1 1.E-4 1. 6 3\nSTOP 9.\nEND\n")
    if run.ok:
        lines = [line["text"] for line in summary(run)["warnings"] if "GOLDAK" in line["text"]]
        checks.that(len(lines) == 1 and lines[0].startswith("GOLDAK 2 (") and "deck.lag:12:1): where it crosses only 50 %" in lines[0].replace("torches.lag", "deck.lag"),
                    "a torch is named by its card", lines)
    # START in degC, ZERO for absolute temperatures
    for start, zero, cold in ((-50, 0., True), (20, 0., False), (-50, 273.15, False), (-300, 273.15, True)):
        run = Run(checks, f"radiates-{start}-{zero:g}", "TITLE radiates\nSTATE PLSTN\nKINEM SMALL\nBLOCK bar PL8TM 4 hot BILINEAR\n   0. 0.   4. 0.   4. 4.   0. 4.\n"
                  f"   2 1.   2 1.\nLAW hot HEAT\n   30. 4.5\nSTART T 40.\nSTART T {start} bar\nRADIA bar 2 EPS 0.8 SIGMA 5.67E-11 ZERO {zero} TS 20.\n"
                  "GOLDAK bar P 0. ETA 0.8 FRONT 2. REAR 2. DEPTH 2. INTO -1. 0.\n   0. 4. 2.\nSTRAT 1. 1. 1. 4 3\nSTOP 2.\nEND\n")
        if run.ok:
            lines = [line["text"] for line in summary(run)["warnings"] if "below absolute zero" in line["text"]]
            checks.that(len(lines) == cold, f"radiates from {start} with ZERO {zero}: told", summary(run)["warnings"])
            checks.that(abs(run.history["heat_through_bar/GOLDAK"][-1]) == 0, "a torch without power heats nothing")
    # a body that nothing heats or cools, beside one that air cools
    for more, isolated in (("", True), ("JOIN hot 2 cold 4\n", False), ("HEATS hot Q 1.\n", False), ("START T 900+x hot\n", False),
                           ("IMPOS hot 4 T on 900.\nLIC on\n   0. 1.\n", False), ("DIE d SIDES hot 2\nCOU2DC cold 4 d H 1.\n", False)):
        run = Run(checks, f"isolated-{more[:5].strip() or 'alone'}", "TITLE isolated\nSTATE PLSTN\nKINEM SMALL\nBLOCK hot PL8TM 4 s BILINEAR\n   0. 0.   4. 0.   4. 4.   0. 4.\n"
                  "   2 1.   2 1.\nBLOCK cold PL8TM 4 s BILINEAR\n   4. 0.   8. 0.   8. 4.   4. 4.\n   2 1.   2 1.\nLAW s HEAT\n   30. 4.5\nSTART T 900.\n"
                  f"CONVE cold 2 H 1. TS 20.\n{more}STRAT 1. 1. 1. 4 3\nSTOP 1.\nEND\n")
        if run.ok:
            lines = [line["text"] for line in summary(run)["warnings"] if "keeps its temperature" in line["text"]]
            checks.that(len(lines) == isolated and all(line.startswith("hot: ") and " of 900:" in line for line in lines), f"{run.name}: told", lines)
    # of a steel: austenite above all its curves keeps its temperature, other mixtures may release heat
    for start, phases, isolated in ((900, "", True), (250, "", False), (900, "START PHASES PEARLITE 1.\n", False)):
        run = Run(checks, f"isolated-{start}-{len(phases)}", "TITLE isolated\nSTATE PLSTN\nKINEM SMALL\nBLOCK hot PL8TM 4 s BILINEAR\n   0. 0.   4. 0.   4. 4.   0. 4.\n"
                  f"   2 1.   2 1.\nLAW s META\n   STEEL soft.met s\n   ENERGY 1.\nSTART T {start}.\n{phases}STRAT 1. 1. 1. 4 3\nSTOP 1.\nEND\n")
        if run.ok:
            lines = [line["text"] for line in summary(run)["warnings"] if "keeps its temperature" in line["text"]]
            checks.that(len(lines) == isolated, f"{run.name}: told", lines)
    # 273.15 for -273.15
    for zero in (0., -273.15, 273.15, 20.):
        run = Run(checks, f"zero-{zero:g}", "TITLE zero\nSTATE PLSTN\nKINEM SMALL\nBLOCK bar PL8TM 4 hot BILINEAR\n   0. 0.   4. 0.   4. 4.   0. 4.\n"
                  f"   2 1.   2 1.\nLAW hot META\n   STEEL soft.met s\n   ENERGY 1. ZERO {zero}\nSTART T {900 - zero}\nCONVE bar 2 H 1. TS {20 - zero}\n"
                  "STRAT 1. 1. 1. 4 3\nSTOP 1.\nEND\n")
        if run.ok:
            checks.that(any("-273.15 for a deck in kelvin" in line["text"] for line in summary(run)["warnings"]) == (zero > 200),
                        f"ZERO {zero}: told", summary(run)["warnings"])
    # kelvin without ZERO: surroundings of 293 are a room, unless something is colder
    for off, cold, told in ((273.15, "", True), (0., "", False), (273.15, "IMPOS bar 4 T low 1.\nLIC low\n   0. 20.\nCONVE bar 3 H 1. TS 100.\n", False)):
        run = Run(checks, f"kelvin-{off:g}-{len(cold)}", "TITLE kelvin\nSTATE PLSTN\nKINEM SMALL\nBLOCK bar PL8TM 4 hot BILINEAR\n   0. 0.   4. 0.   4. 4.   0. 4.\n"
                  f"   2 1.   2 1.\nLAW hot META\n   STEEL soft.met s\n   ENERGY 1.\nSTART T {900 + off}\nCONVE bar 2 H 1. TS {20 + off}\n{cold}"
                  "STRAT 1. 1. 1. 4 3\nSTOP 1.\nEND\n")
        if run.ok:
            lines = [line["text"] for line in summary(run)["warnings"]]
            checks.that(["are 293.1 degC by ZERO 0 of LAW hot" in line for line in lines].count(True) == told, f"kelvin {off:g}, {len(cold)}: told", lines)
    # a steel in degC by ZERO of its law; what begins as martensite is not told to begin below Ms
    for start, zero, cold in ((-300, 0., True), (-200, 0., False), (20, -300., True), (20, -273.15, False)):
        run = Run(checks, f"begins-{start}-{zero:g}", "TITLE begins\nSTATE PLSTN\nKINEM SMALL\nBLOCK bar PL8TM 4 hot BILINEAR\n   0. 0.   4. 0.   4. 4.   0. 4.\n"
                  f"   2 1.   2 1.\nLAW hot META\n   STEEL soft.met s\n   ENERGY 1. ZERO {zero}\nSTART T {start}.\nSTART PHASES MARTENSITE 1. bar\n"
                  f"CONVE bar 2 H 1. TS {start}.\nSTRAT 1. 1. 1. 4 3\nSTOP 1.\nEND\n")
        if run.ok:
            lines = [line["text"] for line in summary(run)["warnings"]]
            checks.that([f"bar: it begins at {start}, which is {start + zero:g} degC" in line for line in lines] == [True]*cold,
                        f"begins at {start} with ZERO {zero}: told", lines)
    # absolute zero is one temperature, whichever card says it; 273 for 273.15 is no mistake
    for steel_zero, zero, apart in ((0., 273.15, False), (0., 273., False), (-273.15, 0., False), (-273.15, 273.15, True), (0., 0., True)):
        run = Run(checks, f"zeros{steel_zero:g}{zero:g}", "TITLE zeros\nSTATE PLSTN\nKINEM SMALL\nBLOCK bar PL8TM 4 hot BILINEAR\n   0. 0.   4. 0.   4. 4.   0. 4.\n"
                  f"   2 1.   2 1.\nLAW hot META\n   STEEL soft.met s\n   ENERGY 1. ZERO {steel_zero}\nSTART T 1200.\n"
                  f"RADIA bar 2 EPS 0.8 SIGMA 5.67E-11 ZERO {zero} TS 320.\nSTRAT 1. 1. 1. 4 3\nSTOP 1.\nEND\n")
        if run.ok:
            lines = told_of(run)
            checks.that(["absolute zero is" in line and "by bar.2/RADIA" in line and "by LAW hot" in line for line in lines] == [True]*apart,
                        f"zeros {steel_zero:g} and {zero:g}: told", lines)
    # units that cannot be of one deck: what is wrong, the numbers of META, and more
    units = [("one deck", "ENERGY 1.", "", "CONVE bar 2 H 50. TS 20.\nRADIA bar 3 EPS 0.8 SIGMA 5.67E-11 ZERO 273.15 TS 20.\n", None),
             ("in m", "ENERGY 1.E6", "", "CONVE bar 2 H 5.E4 TS 20.\nRADIA bar 3 EPS 0.8 SIGMA 5.67E-8 ZERO 273.15 TS 20.\n", "4000 x 4000 mm large"),
             ("minutes", "ENERGY 1. TIME 60.", "", "CONVE bar 2 H 1. TS 20.\n", "the unit of length is 7.75 mm, which none is"),
             ("W/m2/K", "ENERGY 1.", "", "CONVE bar 2 H 1000. TS 20.\n", "H reaches 1000000 W/m2/K"),
             ("pressed", "ENERGY 1.", "", PRESSED.format(conductance=50.), None),
             ("pressed in W/m2/K", "ENERGY 1.", "", PRESSED.format(conductance=5000.), "bar.2/die/COU2DC: H reaches 5000000 W/m2/K"),
             ("W/m2/K4", "ENERGY 1.", "", "RADIA bar 3 EPS 0.8 SIGMA 5.67E-8 ZERO 273.15 TS 20.\n", "SIGMA is 5.67e-11 there"),
             ("two times", "ENERGY 1.", "TIME 60.", "CONVE bar 2 H 1. TS 20.\n", "both are the seconds of the unit of time"),
             ("two stresses", "ENERGY 1.E-3 CONDUCT 1.E-3 QUINNEY 0.9", "", "CONVE bar 2 H 1.E-3 TS 20.\n", "1 MJ/m3 is 1 MPa"),
             ("two units of energy", "ENERGY 1.E-3 CONDUCT 1.E-3", "", "CONVE bar 2 H 1.E-3 TS 20.\n", None)]
    for name, heat, solid, cooling, words in units:
        run = Run(checks, f"units-{name}".replace(" ", "-").replace("/", "-"), "TITLE units\nSTATE PLSTN\nKINEM SMALL\nBLOCK bar PL8LS 4 firm\n   0. 0.   4. 0.   4. 4.   0. 4.\n"
                  f"   2 1.   2 1.\nLAW firm ARBTHMET\n   STEEL firm.met s\n   STRESS 1. {solid}\nADDEL bar PL8TM hot BILINEAR\nLAW hot META\n   STEEL firm.met s\n"
                  f"   {heat}\nSTART T 900.\nFIXED bar 1 XY\n{cooling}STRAT 0.01 0.01 0.01 4 3\nSTOP 0.01\nEND\n")
        if run.ok:
            lines = told_of(run)
            checks.that(len(lines) == (words is not None) and all(words in line for line in lines), f"units, {name}: told", lines)
    # 20 is 20 K where ZERO is 0; nothing is colder than what only takes up
    for around, zero, cold in ((20., 0., True), (293., 0., False), (20., 273.15, False), (0., 0., False)):
        run = Run(checks, f"around-{around:g}-{zero:g}", "TITLE around\nSTATE PLSTN\nKINEM SMALL\nBLOCK bar PL8TM 4 hot BILINEAR\n   0. 0.   4. 0.   4. 4.   0. 4.\n"
                  f"   2 1.   2 1.\nLAW hot HEAT\n   30. 4.5\nSTART T 900.\nRADIA bar 2 EPS 0.8 SIGMA 5.67E-11 ZERO {zero} TS {around}\nSTRAT 1. 1. 1. 4 3\nSTOP 1.\nEND\n")
        if run.ok:
            lines = told_of(run)
            checks.that(["colder than liquid nitrogen" in line for line in lines] == [True]*cold, f"surroundings of {around:g}, ZERO {zero:g}: told", lines)
    # temperatures of a steel in kelvin: more than any steel has, or than its composition has
    for k, (temperatures, more, words) in enumerate((("AC1 730 AC3 850 MS 350", "", None), ("AC1 1003 AC3 1123 MS 623", "", "Ac1 at 1003, that of steels is below 960"),
                                                     ("AC1 730 AC3 850 MS 650", "", None), ("MS 623", "COMPO C 0.4 MN 0.8\n", "Ms at 623, by its composition about 345"),
                                                     ("MS 350", "COMPO C 0.4 MN 0.8\n", None), ("AC1 730 AC3 1200 MS 350", "", "Ac3 at 1200, that of steels is below 1150"))):
        with open(os.path.join(checks.folder, "kelvin.met"), "w") as file:
            file.write(steel.replace("TEMPS MS 300\n", f"TEMPS {temperatures}\n{more}"))
        run = Run(checks, f"kelvin-{k}", "TITLE kelvin\nSTATE PLSTN\nKINEM SMALL\nBLOCK bar PL8TM 4 hot BILINEAR\n   0. 0.   4. 0.   4. 4.   0. 4.\n"
                  "   2 1.   2 1.\nLAW hot META\n   STEEL kelvin.met s\n   ENERGY 1.\nSTART T 900.\nCONVE bar 2 H 1. TS 20.\nSTRAT 1. 1. 1. 4 3\nSTOP 1.\nEND\n")
        if run.ok:
            lines = told_of(run)
            checks.that([words is not None and words in line and "kelvin.met:1:" in line for line in lines] == [True]*(words is not None),
                        f"temperatures of a steel, {temperatures}: told", lines)
    # power in W where the deck has mW, or the other way
    for power, wrong in ((2.e3, True), (2.e6, False), (2.e9, True)):
        run = Run(checks, f"torch-{power:g}", "TITLE torch\nSTATE PLSTN\nKINEM SMALL\nBLOCK bar PL8TM 4 hot BILINEAR\n   0. 0.   20. 0.   20. 10.   0. 10.\n"
                  f"   10 1.   6 1.\nLAW hot HEAT\n   30. 4.5\nSTART T 20.\nGOLDAK bar P {power} ETA 0.8 FRONT 3. REAR 6. WIDTH 4. DEPTH 4. INTO 0. -1. CROSS 6. 4.\n"
                  "   0. 10. 10.\nSTRAT 0.25 0.25 0.25 4 3\nSTOP 10.\nEND\n")
        if run.ok:
            lines = [line for line in told_of(run) if "boils" not in line]
            checks.that(["is P in the unit of power of the deck" in line for line in lines] == [True]*wrong, f"torch of {power:g}: told", lines)
    # air until water comes: never both
    run = Run(checks, "in-turns", "TITLE in turns\nSTATE PLSTN\nKINEM SMALL\nBLOCK bar PL8TM 4 hot BILINEAR\n   0. 0.   4. 0.   4. 4.   0. 4.\n"
              "   2 1.   2 1.\nLAW hot HEAT\n   30. 4.5\nSTART T 100.\nLIC air\n   0. 1.   1. 1.   1.1 0.   2. 0.\nLIC water\n   0. 0.   1. 0.   1.1 1.   2. 1.\n"
              "CONVE bar 2 H 1. air TS 20.\nCONVE bar 2 3 H 5. water TS 20.\nSTRAT 1. 1. 1. 4 3\nSTOP 2.\nEND\n")
    if run.ok:
        checks.that(not told_of(run), "in turns: nothing is told", told_of(run))


if __name__ == "__main__":
    all_checks = Checks()
    law_file(all_checks)
    for case in (melting, bree, waits, pressed, exchanged, buckles, probes, mirrored, stretched, first_geometry, rests, spent, told):
        case(all_checks)
    sys.exit(all_checks.end())
