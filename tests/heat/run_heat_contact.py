#!/usr/bin/env python3
"""Heat through contact (COU2DC, TDIE) against closed forms, and its books.

usage: run_heat_contact.py [-v] [-k]

- `slab`: on a die with a heat capacity: both temperatures go to their mean by exp(-h A t (1/C1 + 1/C2)); first order in time with
  implicit Euler, what the slab loses the die gains; in a plane and around an axis.
- `wall`: steady, of two bodies with a resistance between them, and on a die whose temperature is given: q = dT/(L1/k1 + 1/h + L2/k2).
- `round`: the same of a quarter of a tube on a round die, and of two tubes with sides of other lengths: curves that are drawn as one are
  closed, however they are cut; a die the wrong way round, one beside the sides and one too rough are told.
- `gap`: steady, across a gap by convection, a film of gas and radiation: the root of the balance.
- `bore`: steady, across the wide gap between a tube and the bore around it by radiation: the area is that of the sides named.
- `half`: two half spaces brought together (H.S. Carslaw, J.C. Jaeger, Conduction of Heat in Solids, sec. 2.7 and 2.15): without resistance
  T = (b1 T1 + b2 T2)/(b1 + b2), b = sqrt(k rho c), at all times; with h T + (T1 - T) exp(g^2 t) erfc(g sqrt(t)), g = h (b1 + b2)/(b1 b2).
- `shock`: a Biot number of 1000 on a coarse mesh, BILINEAR and implicit Euler: no temperature outside those at the start.
- `slide`: a block drawn over a die, over another body: the work of friction is the heat released, less that of the last step where
  temperatures are found once and first; shared by SHARE and by effusivity; all ways of coupling; the same bits by any number of threads
  and resumed.
- `newton`: hot steel whose flow depends on the temperature, pressed on a cold die, by SOLVE MONOLITHIC with heat of plastic work, then with
  heat of friction and a conductance by pressure too, on a rigid die, on one that a force drives, and on a conducting body that deforms:
  at most two solutions lead from a residual below 1e-5 to one below 1e-10, round-off of the smallest steps.
- `shrinks`: a bar held at its hot end, pressed on a die that cools it, so that it shrinks away: steady with a conductance of h p/p0 that
  grows from 0 (J.R. Barber, J. Elast. 8 (1978) 409-423, on those that jump), the root of 3 (T1 - T) = h p/p0 (T - Td); with one that
  jumps as the side opens there is no equilibrium, and the message says what to do; once a step (SOLVE ONCE) too, where it is told.
- `billet`: pressed between chilled dies and remeshed twice: temperatures of the dies and the heat that they got go on, as
  does heat of plastic work and friction, work that has not become heat yet among it.
- `tool`: a hot billet slides over the sides of a conducting tool in long steps, so that their pairs change within steps: all work becomes
  heat (temperatures found once, and first).
- `layer`: a hot billet presses on a cold tool of few elements: new meshes make no heat of the steep temperatures at its face.
"""
import glob
import math
import os
import re
import shutil
import subprocess
import sys

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.abspath(__file__))
TESTS = os.path.dirname(HERE)
sys.path[:0] = [HERE] + [os.path.join(TESTS, folder) for folder in ("patch", "runs", "cycle")]
from patch_support import LAGAMINE, Checks, Run, np  # noqa: E402
from remeshed import cycle, tries  # noqa: E402
from run_coupling import call, content  # noqa: E402
from run_exchange import STEADY, TIGHT, root  # noqa: E402
from support import DONE, NO_CONVERGENCE, history, result_differences, said, summary, write  # noqa: E402

HEAD = "TITLE {0}\nSTATE {1}\nKINEM SMALL\n"
EASY = "NORMS FORCE 1.E-10 DISPL 1.E-10\n"


def slab(checks):
    """A slab of good conductivity, 0.1 high, h = 0.5 over an area of 1."""
    for state, area in (("PLSTN", 1.0), ("AXISYM", math.pi)):
        c1, c2, h = 0.2*area, 0.3*area, 0.5*area
        rate, mean = h*(1/c1 + 1/c2), (c1*1000 + c2*20)/(c1 + c2)
        exact = mean + (1000 - mean)*math.exp(-rate)
        errors = []
        for kind, step in (("BILINEAR", 0.02), ("BILINEAR", 0.01), ("", 0.01)):
            run = Run(checks, f"slab-{state}{kind}{step}", HEAD.format("slab", state)
                      + f"BLOCK slab PL8TM 9 stuff {kind}\n   0. 0. 1. 0. 1. 0.1 0. 0.1\n   2 1. 2 1.\nLAW stuff HEAT\n   1.E9 2.\n"
                      "DIE cold\n   SEGM -1. 0. 2. 0.\n" f"TDIE cold T 20. C {c2}\nCOU2DC slab 1 cold H 0.5\nSTART T 1000.\n"
                      f"PROBE top NODE T 0. 0.1\nSTRAT {step} 1.E-6 {step} 4 3\nSTOP 1.\n" + EASY + "END\n")
            if not run.ok:
                return
            errors.append(abs(run.history["top"][-1] - exact))
            lost = c1*(1000 - run.history["top"][-1])
            checks.small(abs(c2*(run.history["temperature_cold"][-1] - 20)/lost - 1), 1e-7, f"{run.name}: the die gains what is lost")
            checks.small(abs(run.history["heat_imbalance"][-1]), 1e-9, f"{run.name}: books of heat")
        checks.small(abs(math.log2(errors[0]/errors[1]) - 1), 0.05, f"slab {state}: first order in time ({errors[0]:.2f} K)")
        checks.small(errors[1], 4.5, f"slab {state}: {exact:.3f} after 1")
        checks.small(abs(errors[2] - errors[1]), 1e-3, f"slab {state}: 8 temperatures an element and 4 alike")


BODIES = ("BLOCK a PL8TM 9 one {kind}\n   0. 0. 1. 0. 1. 2. 0. 2.\n   {na} 1. 3 1.\n"
          "BLOCK b PL8TM 9 two {kind}\n   0. -1. 1. -1. 1. {gap} 0. {gap}\n   {nb} 1. 2 1.\n"
          "LAW one HEAT\n   {k1} {c1}\nLAW two HEAT\n   {k2} {c2}\nDIE face SIDES b 3\n")


def wall(checks):
    """Steady: flow and the temperatures on both sides of the contact."""
    for kind in ("", "BILINEAR"):
        for na, nb in ((1, 1), (2, 3), (3, 1)):
            q = 100/(2/4.0 + 1/5.0 + 1/10.0)
            run = Run(checks, f"wall{kind}{na}{nb}", HEAD.format("wall", "PLSTN")
                      + BODIES.format(kind=kind, na=na, nb=nb, gap="0.", k1=4., c1=1., k2=10., c2=1.)
                      + "COU2DC a 1 face H 5.\nIMPOS a 3 T on 120.\nIMPOS b 1 T on 20.\nLIC on\n   0. 1.\n"
                      "PROBE up NODE T 0. 2.\nPROBE side NODE T 1. 0.6666666666666667\n" + STEADY + TIGHT + "END\n")
            if run.ok:
                # nodes that do not match share the points' heat by functions with kinks between them, as they do the pressure
                checks.small(abs(run.history["side"][-1] - (120 - q*(2 - 2/3)/4)), 1e-8 if na != 2 else 1e-5, f"{run.name}: steady")
                checks.small(abs(run.history["heat_imbalance"][-1]), 1e-8, f"{run.name}: books of heat")
        q = 100/(2/4.0 + 1/5.0)
        run = Run(checks, f"wall{kind}die", HEAD.format("wall", "PLSTN")
                  + f"BLOCK a PL8TM 9 one {kind}\n   0. 0. 1. 0. 1. 2. 0. 2.\n   2 1. 3 1.\nLAW one HEAT\n   4. 1.\n"
                  "DIE cold\n   SEGM -1. 0. 2. 0.\nTDIE cold T 10. on\nCOU2DC a 1 cold H 5.\nIMPOS a 3 T on 60.\nLIC on\n   0. 2.\n"
                  "PROBE low NODE T 0. 0.\n" + STEADY + TIGHT + "END\n")
        if run.ok:
            checks.small(abs(run.history["low"][-1] - (120 - q*2/4)), 1e-8, f"{run.name}: steady")
            checks.small(abs(run.history["heat_flow_cold"][-1]/q - 1), 1e-8, f"{run.name}: the flow into the die")


RING = ("BLOCK {name} PL8TM 9 {name} {kind}\n   {ri} 0. {ro} 0. 0. {ro} 0. {ri}\n   8 1. {n} 1.\n   SIDE 2 ARC 0. 0.\n   SIDE 4 ARC 0. 0.\n"
        "LAW {name} HEAT\n   {k} 3.\n")
ARC = "DIE face\n   ARC {0}\nTDIE face T 100.\n"
BACK = "2. 0. sqrt(2) sqrt(2) 0. 2. "


def round_faces(checks):
    """Radii 1 and 2, the outer tube to 3; 500 inside, 100 outside."""
    resistance = math.log(2)/20 + 1/(5*2)
    inner = RING.format(name="a", kind="{kind}", ri=1., ro=2., n=6, k=20.)
    cases = [(f"arc{t}", ARC.format(BACK + t), resistance) for t in ("1.E-2", "1.E-3", "1.E-6")]
    cases += [(f"tube{n}", RING.format(name="b", kind="{kind}", ri=2., ro=3., n=n, k=8.) + "DIE face SIDES b 4\nIMPOS b 2 T on 100.\n",
               resistance + math.log(1.5)/8) for n in (5, 6, 9)]
    for name, other, sum_of in cases:
        for kind in ("", "BILINEAR"):
            run = Run(checks, f"round-{name}{kind}", HEAD.format("round", "PLSTN") + (inner + other).format(kind=kind)
                      + "COU2DC a 2 face H 5.\nSTART T 300.\nIMPOS a 4 T on 500.\nLIC on\n   0. 1.\n" + STEADY + TIGHT + "END\n")
            if run.ok:
                flow = -run.history["heat_through_a.2/face/COU2DC"][-1]
                checks.small(abs(flow/(400*0.5*math.pi/sum_of) - 1), 2e-3, f"{run.name}: {flow:.2f}")
                checks.small(abs(flow/run.history["heat_through_a.4/IMPOS"][-1] - 1), 1e-9, f"{run.name}: through")
    for name, arc, words in (("wrong", "0. 2. sqrt(2) sqrt(2) 2. 0. 1.E-3", "no side faces die face, and no heat passes"),
                             ("apart", "2.5 0. 2.5/sqrt(2) 2.5/sqrt(2) 0. 2.5 1.E-3", "the least gap to die face is 0.5, wider than REACH"),
                             ("rough", "2.01 0. 1.99/sqrt(2) 1.99/sqrt(2) 0. 2.01 1.E-3", "points of sides are beside die face by more than 0.1 %")):
        deck = write(os.path.join(checks.folder, f"told-{name}.lag"), HEAD.format("told", "PLSTN") + inner.format(kind="") + ARC.format(arc)
                     + "COU2DC a 2 face H 5.\nSTART T 300.\nSTRAT 1. 0.1 1. 9 3\nSTOP 1.\nEND\n")
        told = subprocess.run([LAGAMINE, deck, "--check"], text=True, check=False, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        checks.that(told.returncode == 0 and words in told.stdout, f"round, {name}: told", told.stdout[-600:])


def gap(checks):
    """Steady, across 0.02: what leaves the wall passes the gap."""
    h, eps, sigma, width = 5.0, 0.6, 5.67e-8, 0.02
    film = h*np.interp(width, [0.0, 0.05], [1.0, 0.2])

    def balance(up):
        q = 4.0*(900 - up)/2
        low = 20 + q*1.0/10.0
        return q - (film + 0.7)*(up - low) - eps*sigma*((up + 273.15)**4 - (low + 273.15)**4)

    up = root(balance, 20.0, 900.0)
    for kind in ("", "BILINEAR"):
        run = Run(checks, f"gap{kind}", HEAD.format("gap", "PLSTN")
                  + BODIES.format(kind=kind, na=2, nb=2, gap=f"-{width}", k1=4., c1=1., k2=10.*(1 - width), c2=1.)
                  + f"COU2DC a 1 face H {h} HO 0.7 EPS {eps} SIGMA {sigma} ZERO 273.15 REACH 0.1\n   GAP 0. 1. 0.05 0.2\n"
                  "IMPOS a 3 T on 900.\nIMPOS b 1 T on 20.\nLIC on\n   0. 1.\nSTART T 400.\nPROBE low NODE T 0. 0.\n" + STEADY + TIGHT
                  + "END\n")
        if run.ok:
            checks.small(abs(run.history["low"][-1] - up), 1e-7*up, f"{run.name}: {up:.4f}")


def half_spaces(checks):
    """As deep as heat comes within the time, steps by their error."""
    b1, b2, t1, t2 = 1.0, 6.0, 100.0, 0.0
    common = (b1*t1 + b2*t2)/(b1 + b2)
    for kind in ("", "BILINEAR"):
        for h in (1e7, 2.0):
            run = Run(checks, f"half{kind}{h:.0f}", HEAD.format("half spaces", "PLSTN")
                      + f"BLOCK a PL8TM 9 one {kind}\n   0. 0. 1. 0. 1. 8. 0. 8.\n   1 1. 60 20.\n"
                      f"BLOCK b PL8TM 9 two {kind}\n   0. -12. 1. -12. 1. 0. 0. 0.\n   1 1. 60 0.05\n"
                      "LAW one HEAT\n   1. 1.\nLAW two HEAT\n   9. 4.\nDIE face SIDES b 3\n"
                      f"COU2DC a 1 face H {h}\nSTART T {t1} a\nSTART T {t2} b\nTHETA TRBDF2 TOL 0.002\n"
                      "PROBE p NODE T 0. 0.\nSTRAT 1.E-6 1.E-7 0.02 4 3\nSTOP 1.\n" + EASY + "END\n")
            if not run.ok:
                continue
            g = h*(b1 + b2)/(b1*b2)
            # exp(g^2 t) erfc(g sqrt(t)) for a large argument: 1/(g sqrt(pi t))
            part = math.exp(g*g)*math.erfc(g) if g < 20 else 1/(g*math.sqrt(math.pi))
            exact = common + (t1 - common)*part
            checks.small(abs(run.history["p"][-1] - exact), 0.05, f"{run.name}: {exact:.4f} at 1")
            checks.small(abs(run.history["heat_imbalance"][-1]), 1e-8, f"{run.name}: books of heat")


def shock(checks):
    """Any step, a coarse mesh: temperatures stay between those of the start."""
    for step in (1e-6, 1e-3, 1.0):
        run = Run(checks, f"shock{step}", HEAD.format("shock", "PLSTN")
                  + BODIES.format(kind="BILINEAR", na=3, nb=2, gap="0.", k1=1., c1=1., k2=3., c2=2.)
                  + f"COU2DC a 1 face H 1000.\nSTART T 1000. a\nSTRAT {step} {step} {step} 4 3\nSTOP {20*step}\n" + EASY
                  + "SAVE 1\nEND\n")
        if not run.ok:
            continue
        with run.open() as file:
            found = [file[f"steps/{name}/node/temperature"][()] for name in file["steps"]]
        checks.that(min(np.min(t) for t in found) > -1e-7 and max(np.max(t) for t in found) < 1000 + 1e-7, f"{run.name}: bounds",
                    [(float(np.min(t)), float(np.max(t))) for t in found][-1])


SLIDE = """TITLE  A block drawn over another
STATE  PLSTN
KINEM  LOG
BLOCK  b PL8LS 4 steel
   0. 0.  10. 0.  10. 5.  0. 5.
   6 1.  3 1.
LAW    steel ELA
   200000. 0.3
ADDEL  b PL8TM hot {kind}
LAW    hot HEAT
   40. 4.
LAW    rough COUL2D
   PENETR 1.E-3   PHI 0.3
{die}
CNT2D  b 1 under {points} rough
COU2DC b 1 under {heat}
START  T 20.
MOVE   b 3 X slide 3.
MOVE   b 3 Y press -0.005
LIC    press
   0. 0.  0.1 1.
LIC    slide
   0. 0.  0.1 0.  1. 1.
STRAT  0.02 1.E-6 0.05   4 3
NORMS  FORCE 1.E-10 DISPL 1.E-10
STOP   1.
SOLVE  {solve}
CKPT   5
END
"""
RIGID = "DIE    under PILOT 0. 0.\n   SEGM -50. 0.  50. 0.\nTDIE   under T 20. C 500."
SIDES = ("BLOCK  u PL8LS 4 steel\n   -5. -4.  18. -4.  18. 0.  -5. 0.\n   9 1.  2 1.\nADDEL  u PL8TM warm {kind}\nLAW    warm HEAT\n"
         "   90. 1.\nDIE    under SIDES u 3\nFIXED  u 1 XY")
WAYS = ("ONCE", "CONVERGE", "MONOLITHIC")


def balance(checks, name, text, once, body_share=None):
    """Heat released is the work of friction; without conductance a die takes its share."""
    run = Run(checks, name, text)
    if not run.ok:
        return
    work = run.history["friction_work"]
    released = run.history["heat_released"]
    checks.that(work[-1] > 1000, f"{name}: friction works", work[-1])
    expected = np.append(0.0, work[:-1]) if once else work
    checks.small(np.max(np.abs(released - expected))/work[-1], 1e-8, f"{name}: its work becomes heat")
    checks.small(abs(run.history["heat_imbalance"][-1]), 1e-8, f"{name}: books of heat")
    if body_share is not None:
        gained = 500*(run.history["temperature_under"][-1] - 20)
        checks.small(abs(gained/released[-1] - (1 - body_share)), 1e-8, f"{name}: the share of the die")


def slide(checks):
    """Friction on a rigid die and on a body."""
    for solve in WAYS:
        once = solve == "ONCE"
        balance(checks, f"share-{solve}", SLIDE.format(kind="BILINEAR", die=RIGID, points="-3", heat="H 0. FRIC 1. SHARE 0.3", solve=solve),
                once, 0.3)
        # effusivity of the block sqrt(40 4), of the die 13
        body = math.sqrt(160.0)/(math.sqrt(160.0) + 13)
        balance(checks, f"effusivity-{solve}", SLIDE.format(kind="", die=RIGID, points="-3", heat="H 0. FRIC 1. EFFUS 13.", solve=solve),
                once, body)
        balance(checks, f"bodies-{solve}", SLIDE.format(kind="BILINEAR", die=SIDES.format(kind="BILINEAR"), points="",
                                                        heat="H 5. FRIC 1.\n   PRESS 0. 0.2  100. 1.", solve=solve), once)


def same_bits(checks):
    """Threads, and resumed from the older checkpoint."""
    decks = {"rigid": SLIDE.format(kind="BILINEAR", die=RIGID, points="-3", heat="H 5. FRIC 1. SHARE 0.5\n   PRESS 0. 0.2 100. 1.",
                                   solve="ONCE"),
             "body": SLIDE.format(kind="", die=SIDES.format(kind=""), points="", heat="H 5. FRIC 1.", solve="MONOLITHIC")}
    for name, text in decks.items():
        deck = write(os.path.join(checks.folder, f"{name}.lag"), text)
        whole, two, again = (os.path.join(checks.folder, f"{name}-{which}") for which in ("one", "two", "again"))
        if not (call(checks, deck, whole, "--threads", "1") and call(checks, deck, two, "--threads", "2")):
            continue
        checks.that(not result_differences(whole, two), f"{name}: the same bits with 1 and 2 threads", result_differences(whole, two))
        old = glob.glob(os.path.join(whole, "*.ckp.1.h5"))[0]
        shutil.copytree(whole, again)
        if call(checks, deck, again, "--threads", "1", "--resume", os.path.join(again, os.path.basename(old))):
            wrong = result_differences(whole, again, previous=False)
            checks.that(not wrong, f"{name}: resumed, as in one go", wrong)


BILLET = """TITLE  Billet between chilled dies, remeshed
STATE  AXISYM
KINEM  LOG
BLOCK  billet PL8LS 4 steel
   0. 0.  10. 0.  10. 15.  0. 15.
   6 1.   9 1.
LAW    steel EPLA
   200000. 0.3
   LINEAR 700. 300.
ADDEL  billet PL8TM heat BILINEAR
LAW    heat HEAT
   50. 3.6
   QUINNEY 0.9
START  T 1000.
LAW    rough  COUL2D
   PENETR 1.E-3   PHI 0.2
DIE    upper  PILOT 0. 15.
   SEGM  30. 15.   -1. 15.
CNT2D  billet 2 3  upper -3 rough
TDIE   upper T 200. C 5.E3
COU2DC billet 2 3 upper H 20. EPS 0.5 SIGMA 5.67E-11 ZERO 273.15 REACH 5. FRIC 1. SHARE 0.5
FIXED  billet 1 Y
FIXED  billet 4 X
LIC    press
   0. 0.     1. -6.
MOVE   upper Y press
STRAT  0.02  1.E-5  0.05   4 3
STOP   0.7
REMSH
   TIMES 0.3 0.6
END
"""


HOT = """TITLE  Hot billet on a cold die
STATE  AXISYM
KINEM  LOG
BLOCK  billet PL8LS 4 steel
   0. 0.   10. 0.   10. 15.   0. 15.
   6 1.   9 0.4
LAW    steel EVP-NH
   TEMP 500.
   150000. 0.3
   0. 260. 0.06 0.1
   TEMP 1200.
   80000. 0.3
   0. 27. 0.18 0.1
ADDEL  billet PL8TM heat BILINEAR
LAW    heat HEAT
   28. 4.9
   QUINNEY 0.9
START  T 1100.
LAW    rough COUL2D
   PENETR 1.E-3   PHI 0.3
{die}
COU2DC billet 3 upper H 20. {friction}
FIXED  billet 1 Y
FIXED  billet 4 X
STRAT  0.002  1.E-7  0.004   9 3
NORMS  FORCE 1.E-11 DISPL 1.E-11
SOLVE  MONOLITHIC
STOP   0.03
END
"""


FLAT = ("DIE    upper PILOT 0. 15.\n   SEGM  40. 15.   -1. 15.\nCNT2D  billet 3 upper -3 rough\nTDIE   upper T 250. C 2.E5\n")
PRESS = "Y press\nLIC    press\n   0. 0.   0.9 -9."
MOVED = FLAT + "MOVE   upper " + PRESS
BENT = MOVED.replace("SEGM  40. 15.   -1. 15.", "PARAB 40. 15.5   10. 15.   -1. 15.5")
PUSHED = FLAT + "FORCE  upper Y 2.E4 load\nLIC    load\n   0. -0.3  0.03 -0.7"
BODY = ("BLOCK  tool PL8LS 4 elastic\n   0. 15.   25. 15.   25. 25.   0. 25.\n   9 1.  3 1.\nLAW    elastic ELA\n   200000. 0.3\n"
        "ADDEL  tool PL8TM warm BILINEAR\nLAW    warm HEAT\n   30. 4.5\nSTART  T 250. tool\nDIE    upper SIDES tool 1\n"
        "CNT2D  billet 3 upper rough\nFIXED  tool 4 X\nMOVE   tool 3 " + PRESS)
ALL = "FRIC 1. EFFUS 13.\n   PRESS  0. 0.2   20. 1.   200. 2."


def newton(checks):
    """Residuals of the listing, those of the predictor and of the first step left out."""
    for name, die, heat in (("newton", MOVED, ""), ("newton-friction", MOVED, ALL), ("newton-bent", BENT, ALL), ("newton-force", PUSHED, ALL),
                            ("newton-body", BODY, ALL.replace("EFFUS 13.", ""))):
        text = HOT.format(friction=heat, die=die)
        if die == BODY:
            text = text.replace("START  T 1100.", "START  T 1100. billet")
        run = Run(checks, name, text)
        if not run.ok:
            continue
        with open(os.path.join(run.out, name + ".log"), encoding="utf-8") as file:
            steps = re.split(r"(?m)^step ", file.read())[1:]
        # as run_newton.py: by a factor 30 an iteration it would be four
        most = 0
        for part in steps[2:]:
            residuals = [float(row) for row in re.findall(r"(?m)^ +\d+ +(\d\.\d+E[+-]\d+)", part)][1:]
            most = max(most, sum(1e-10 < r < 1e-5 for r in residuals))
        checks.that(len(steps) > 6 and most < 3, f"{name}: quadratic, at most {most} solutions from below 1e-5 to 1e-10 in {len(steps)} steps")


SHRINKS = """TITLE a bar that shrinks off its die
STATE PLSTN
KINEM SMALL
BLOCK b PL8LS 9 m
   0. 0. 10. 0. 10. 10. 0. 10.
   1 1. 4 1.
LAW m ELATH
   200000. 0. 1.2E-5
ADDEL b PL8TM h BILINEAR
LAW h HEAT
   30. 4.
START T 500.
FIXED b 3 Y
FIXED b 2 4 X
LAW c COUL2D
   PENETR 1.E-7 PHI 0.
DIE d PILOT 0. 0.
   SEGM -5. 0. 20. 0.
CNT2D b 1 d c
MOVE d Y up
LIC up
   0. 0. 1. 0.01
TDIE d T 20.
COU2DC b 1 d H 10.
   PRESS 0. {touch} 100. 1.
IMPOS b 3 T hot
LIC hot
   0. 500.
SOLVE {solve}
STRAT 0.1 1.E-4 20. 8 5
STOP 500.
PROBE t NODE T 5. 0.
END
"""


def shrinks(checks):
    """Strain of the die .01/10, of the cooled bar 1.2E-5 (T1 - T)/2; E = 2E5."""
    def balance(t):
        pressure = 2e5*(0.01/10 - 1.2e-5*(500 - t)/2)
        return 3*(500 - t) - 10*pressure/100*(t - 20)

    steady = root(balance, 340.0, 500.0)
    for solve in ("MONOLITHIC", "CONVERGE"):
        run = Run(checks, f"shrinks-{solve}", SHRINKS.format(touch=0., solve=solve))
        if run.ok:
            checks.small(abs(run.history["t"][-1] - steady), 0.02, f"{run.name}: {steady:.3f}")
        run = Run(checks, f"shrinks-jumps-{solve}", SHRINKS.format(touch=1., solve=solve), code=NO_CONVERGENCE)
        checks.that("let PRESS begin, at pressure 0" in run.said, f"{run.name}: what to do", run.said)
    # once a step: the same, and no contact that bears and conducts in one step and not in the next
    run = Run(checks, "shrinks-ONCE", SHRINKS.format(touch=0., solve="ONCE"))
    if run.ok:
        last = run.history["time"] > 250
        checks.small(np.max(np.abs(run.history["t"][last] - steady)), 3.0, f"{run.name}: {steady:.3f}, in every step")
        checks.that(np.max(run.history["force_y_d"][last]) < -50, f"{run.name}: pressed in every step", run.history["force_y_d"][last])
    run = Run(checks, "shrinks-jumps-ONCE", SHRINKS.format(touch=1., solve="ONCE"))
    if run.ok:
        whole = summary(run.out)
        told = whole["accuracy"]["heat"]["largest"]
        checks.that(any("do not agree" in warning["text"] for warning in whole["warnings"]), f"{run.name}: among the warnings of the summary",
                    whole["warnings"])
        to_and_fro = np.ptp(run.history["t"][run.history["time"] > 250])
        checks.that("do not agree" in run.said and "let PRESS begin, at pressure 0" in run.said and told > to_and_fro/2,
                    f"{run.name}: told that temperatures go to and fro", (told, to_and_fro, run.said))


def billet(checks):
    """From mesh to mesh."""
    deck, out = write(os.path.join(checks.folder, "billet.lag"), BILLET), os.path.join(checks.folder, "billet")
    result = cycle(deck, out)
    checks.that(result.returncode == DONE, "billet: lagacycle", said(result))
    if result.returncode != DONE:
        return
    checks.that([row["accepted"] for row in tries(out)].count("y") == 2, "billet: two new meshes", tries(out))
    columns = {name: np.array(values) for name, values in history(out).items()}
    die = columns["temperature_upper"]
    checks.that(np.all(np.diff(die) > 0) and die[-1] > 220, "billet: the die warms up all the while", die)
    flow = columns["heat_flow_upper"]*columns["step_length"]
    checks.small(abs(5e3*(die[-1] - 200)/np.sum(flow) - 1), 1e-9, "billet: what the die got is its temperature, over all meshes")
    checks.small(abs(columns["heat_imbalance"][-1]), 1e-8, "billet: books of heat")
    # what slides while equilibrium is restored on a new mesh is counted with the step after it, and makes no heat. Work and heat are of
    # the mass: by the volume where a mesh begins, under pressure, they would differ by 2e-3 on all later meshes
    work = columns["friction_work"] + 0.9*columns["plastic_work"]
    heat, work = np.diff(columns["heat_released"])[1:], np.diff(work)[:-1]
    missing = np.abs(heat - work)/work
    checks.that(np.max(missing[:9]) < 1e-9 and np.sum(missing > 1e-5) <= 4 and np.max(missing) < 1e-3,
                "billet: heat of friction and of plastic work, over all meshes", missing)
    for generation in (1, 2):
        before, after = (os.path.join(out, f"billet.g{generation + k:02}.{end}.h5") for k, end in ((0, "end"), (1, "start")))
        (old, low, high), (new, least, most) = content(before), content(after)
        checks.small(abs(new/old - 1), 1e-3, f"billet: heat across remesh {generation}")
        slack = 1e-3*(high - low)
        checks.that(low - slack <= least and most <= high + slack, f"billet: bounds of the temperature, remesh {generation}",
                    f"{least} to {most}, were {low} to {high}")


BORE = """TITLE  A tube in a bore
STATE  AXISYM
KINEM  SMALL
BLOCK  tube PL8TM 9 m
   5. 0.   10. 0.   10. 2.   5. 2.
   6 1.   1 1.
BLOCK  bore PL8TM 9 m
   15. 0.   20. 0.   20. 2.   15. 2.
   6 1.   1 1.
LAW    m HEAT
   50. 3.6
DIE    wall SIDES bore 4
COU2DC tube 2 wall H 1. EPS 0.6 SIGMA 5.67E-11 ZERO 273.15 REACH 10.
IMPOS  tube 4 T even 1000.
IMPOS  bore 2 T even 100.
LIC    even
   0. 1.
START  T 500.
STRAT  1. 1.E-3 100.   4 3 0.25 2.
STOP   2000.
END
"""


def bore(checks):
    """Q = 2 pi r1 l e s (T1^4 - T2^4), and Q ln(rb/ra)/(2 pi k l) in each tube."""
    deck, out = write(os.path.join(checks.folder, "bore.lag"), BORE), os.path.join(checks.folder, "bore")
    if not call(checks, deck, out):
        return
    low, high = 0.0, 1e6
    for _ in range(200):
        q = (low + high)/2
        one, two = 1273.15 - q*math.log(2)/(200*math.pi), 373.15 + q*math.log(20/15)/(200*math.pi)
        low, high = (q, high) if 40*math.pi*0.6*5.67e-11*(one**4 - two**4) > q else (low, q)
    checks.small(abs(-history(out)["heat_through_tube.2/wall/COU2DC"][-1]/q - 1), 1e-3, "bore: heat by radiation")


LAYER = """TITLE  A hot billet pressed by a cold tool
STATE  AXISYM
KINEM  LOG
BLOCK  billet PL8LS 4 m
   0. 0.   10. 0.   10. 10.   0. 10.
   6 1.   6 1.
BLOCK  tool PL8LS 4 t
   0. 10.   20. 10.   20. 20.   0. 20.
   6 1.   3 1.
LAW    m EPLA
   100000. 0.3
   LINEAR 100. 100.
LAW    t ELA
   200000. 0.3
ADDEL  billet PL8TM h BILINEAR
ADDEL  tool PL8TM h BILINEAR
LAW    h HEAT
   30. 4.
START  T 1000. billet
START  T 200. tool
LAW    film COUL2D
   PENETR 1.E-3   PHI 0.   AUGMENT 10
DIE    face SIDES billet 3
CNT2D  tool 1 face film
COU2DC tool 1 face H 5.
FIXED  billet 1 Y
FIXED  billet 4 X
FIXED  tool 4 X
MOVE   tool 3 Y down
LIC    down
   0. 0.   0.5 -1.
STRAT  0.01 1.E-6 0.02   6 3
REMSH
   TIMES 0.2 0.35
PROBE  t_billet MEAN T billet
PROBE  t_tool MEAN T tool
END
"""


TOOL = """TITLE  A hot billet under a conducting tool over whose sides it slides
STATE  AXISYM
KINEM  LOG
BLOCK  billet PL8LS 4 hot
   0. 0.   10. 0.   10. 12.   0. 12.
   9 1.   4 1.
BLOCK  tool PL8LS 4 elastic
   0. 12.   25. 12.   25. 32.   0. 32.
   12 1.   2 1.
LAW    hot EPLA
   100000. 0.3
   LINEAR 100. 50.
LAW    elastic ELA
   210000. 0.3
ADDEL  billet PL8TM heat BILINEAR
ADDEL  tool PL8TM cold BILINEAR
LAW    cold HEAT
   30. 4.5
LAW    heat HEAT
   28. 4.9
   QUINNEY 0.9
START  T 1100. billet
START  T 250. tool
FIXED  billet 1 Y
FIXED  billet 4 X
FIXED  tool 4 X
LAW    film COUL2D
   PENETR 1.E-3   PHI 0.3
DIE    face SIDES tool 1
CNT2D  billet 3 2 face film
COU2DC billet 3 2 face H 1. FRIC 1.
MOVE   tool 3 Y press
LIC    press
   0. 0.   0.4 -5.   0.41 -5.
STRAT  0.003 1.E-7 0.1   6 3
NORMS  PATH 0 RATE 0
END
"""


def tool(checks):
    """The matrix of heat has another pattern once the motion has found other pairs: the state of the step is the same."""
    deck, out = write(os.path.join(checks.folder, "tool.lag"), TOOL), os.path.join(checks.folder, "tool")
    if not call(checks, deck, out):
        return
    columns, due = history(out), summary(out)["energy"]["heat_due"]
    work = columns["friction_work"][-1] + 0.9*columns["plastic_work"][-1]
    checks.small(abs((columns["heat_released"][-1] + due)/work - 1), 1e-8, "tool: heat of friction and of plastic work")


def layer(checks):
    """What the billet loses the tool gains, over new meshes too: their volumes are 1 to 4, but for the elastic change."""
    deck, out = write(os.path.join(checks.folder, "layer.lag"), LAYER), os.path.join(checks.folder, "layer")
    result = cycle(deck, out)
    checks.that(result.returncode == DONE, "layer: lagacycle", said(result))
    if result.returncode != DONE:
        return
    checks.that([row["accepted"] for row in tries(out)].count("y") == 2, "layer: two new meshes", tries(out))
    rows = history(out)
    gained, lost = 4*(rows["t_tool"][-1] - 200), 1000 - rows["t_billet"][-1]
    checks.small(abs(gained/lost - 1), 5e-3, "layer: heat of the tool over that of the billet")


def shown(checks):
    """What TDIE gives is shown with the die: a temperature by time, one of a heat capacity, of the full circumference."""
    deck = os.path.join(checks.folder, "shown.lag")
    with open(deck, "w", encoding="utf-8") as file:
        file.write("TITLE dies\nSTATE AXISYM\nKINEM SMALL\nBLOCK b PL8TM 4 h BILINEAR\n   0. 0.   10. 0.   10. 10.   0. 10.\n   2 1.   2 1.\n"
                   "LAW h HEAT\n   30. 4.\nSTART T 800.\nDIE low\n   SEGM -1. 0.   20. 0.\nDIE up\n   SEGM 20. 10.   -1. 10.\nTDIE low T 150. C 5.E4\n"
                   "TDIE up T 250. warm\nLIC warm\n   0. 1.   10. 1.2\nCOU2DC b 1 low H 2.\nCOU2DC b 3 up H 2.\nSTRAT 1. 1.E-3 1. 5 3\nSTOP 10.\nEND\n")
    told = subprocess.run([LAGAMINE, deck, "--check"], text=True, check=False, stdout=subprocess.PIPE, stderr=subprocess.STDOUT).stdout
    for words in ("at rest, T = 150 at the start, heat capacity 50000", "at rest, T = 250 x warm"):
        checks.that(words in told, f"shown: {words}", told[:1500])


def main():
    checks = Checks()
    shown(checks)
    slab(checks)
    wall(checks)
    round_faces(checks)
    gap(checks)
    bore(checks)
    half_spaces(checks)
    shock(checks)
    slide(checks)
    same_bits(checks)
    newton(checks)
    shrinks(checks)
    billet(checks)
    tool(checks)
    layer(checks)
    checks.end()


if __name__ == "__main__":
    main()
