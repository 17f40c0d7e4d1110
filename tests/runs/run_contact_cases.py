#!/usr/bin/env python3
"""Contact that needs no care: an S-shaped die, a thin rib, a corner that enters a side, a part that leaves the end of a die and
comes back, a strip that is bent freely, one that is bent upright, one that lies on its die, one that springs back, a cup that tears. Every other run reaches its end, no
pressure pulls, and the part is nowhere
deeper in the die than allowed: at its points of contact, and between them (on the rough S-shaped die by an eighth more at some instants, which ones goes with the lengths of the steps).

usage: run_contact_cases.py [-v] [-k]

Depth is looked for at 65 places of every side of every saved step, quadratic interpolation between its nodes, against the curve of
parabolas as the fields file has it (die_depth.py), independently of the solver's search. It is compared with the allowed
penetration, 1e-3 of the side, and with what the solver says of it in summary.json.
"""
import math
import re
import sys

sys.dont_write_bytecode = True
from support import DONE, NO_CONVERGENCE, Checks, history, run, said, summary, with_h5py, write  # noqa: E402

ALLOWED = 1.0e-3
# Between points of contact, over what is allowed at them. The S-shaped die with friction 0.2 to 0.4 and steps of 0.01 to 0.04: 0.94 to 1.18; a
# rounded rib of half a side: 1.37 (1.125 and 1 where 20 places are looked at).
BETWEEN = {"s-die-rough": 1.2, "round-rib": 1.4}

HEAD = """TITLE  {title}
STATE  PLSTN
KINEM  LOG
LAW    metal EPLA
   200000. 0.3
   LINEAR 400. 500.
LAW    oil COUL2D
   PENETR 1.E-3   PHI {phi}   AUGMENT 20
CNT2D  block 1  tool {points} oil
"""

PRESSED = """BLOCK  block PL8LS 4 metal
   0. 0.   {width} 0.   {width} 4.   0. 4.
   {width} 1.   4 1.
FIXED  block 3  X
MOVE   block 3  Y press
LIC    press
   0. 0.   1. -{travel}
STRAT  0.02 1.E-6 0.04   5 3
NORMS  PATH 0 RATE 0
SAVE   1
END
"""

# Hills and valleys with a radius of 1.3 at their tops, sides of 1: the part flows over both.
S_DIE = """DIE    tool
   PARAB  0. -1.5   2. 0.   4. -1.5
   PARAB  4. -1.5   6. -3.  8. -1.5
   PARAB  8. -1.5  10. 0.  12. -1.5
"""
# A fifth of a side in width, between the nodes of one.
RIB = """DIE    tool
   SEGM  -5. -2.    4.4 -2.
   SEGM   4.4 -2.   4.4 0.
   SEGM   4.4 0.    4.6 0.
   SEGM   4.6 0.    4.6 -2.
   SEGM   4.6 -2.  13. -2.
"""
# The same with rounded corners.
ROUND_RIB = RIB.replace("   SEGM   4.4 0.    4.6 0.\n", "   FILLT 0.05 1.E-4\n   SEGM   4.4 0.    4.6 0.\n   FILLT 0.05 1.E-4\n")
WEDGE = """DIE    tool
   SEGM   0.5 -4.   4.4 0.
   SEGM   4.4 0.    8.5 -4.
"""
# Pressed down, pushed over the end by 4 sides, lifted, taken back, pressed down again, over the end by half a side.
LEAVING = """BLOCK  block PL8LS 4 metal
   0. 0.   6. 0.   6. 3.   0. 3.
   6 1.   3 1.
DIE    tool
   SEGM  -4. 0.   5.3 0.
MOVE   block 3  Y press
MOVE   block 3  X go
LIC    press
   0. 0.   1. -0.1   4. -0.1   5. 0.2   6. 0.2   7. -0.1
LIC    go
   0. 0.   1. 0.     4. 4.     5. 4.    6. -1.   7. -1.
STRAT  0.02 1.E-6 0.1   5 3
SAVE   1
END
"""

CASES = (
    ("s-die", S_DIE + PRESSED.format(width=12, travel=1.5), -17, 0.1),
    ("s-die-rough", S_DIE + PRESSED.format(width=12, travel=1.5), -17, 0.3),
    ("rib", RIB + PRESSED.format(width=8, travel=0.6), -3, 0.1),
    ("rib-many-points", RIB + PRESSED.format(width=8, travel=0.6), -9, 0.1),
    ("round-rib", ROUND_RIB + PRESSED.format(width=8, travel=0.6), -17, 0.1),
    ("wedge", WEDGE + PRESSED.format(width=8, travel=0.6), -3, 0.1),
    ("wedge-rough", WEDGE + PRESSED.format(width=8, travel=0.6), -9, 0.4),
    ("leaving", LEAVING, -9, 0.1),
    ("leaving-few-points", LEAVING, -3, 0.1),
)

BENDING = """TITLE  A beam bent between a punch and a support, half of it
STATE  PLSTN
KINEM  LOG
BLOCK  beam PL8LS 4 metal
   0. 0.   30. 0.   30. 2.   0. 2.
   40 1.   4 1.
LAW    metal EPLA
   200000. 0.3
   LINEAR 300. 1000.
LAW    dry COUL2D
   PENETR 1.E-3   PHI 0.
DIE    support
   ARC   18. -2.   20. 0.   22. -2.   1.E-4
DIE    punch PILOT 0. 2.
   ARC   3. 5.   0. 2.   -3. 5.   1.E-4
CNT2D  beam 1 support ALONG dry
CNT2D  beam 3 punch ALONG dry
FIXED  beam 4 X
MOVE   punch Y down
LIC    down
   0. 0.   1. -3.
STRAT  0.05 1.E-5 0.1   6 3
END
"""


# Bends between radii of 1.5, with sides of .5; the largest force of the punch on 80 x 4 elements.
FINE = 49.14
STRIP = """TITLE  A strip bent freely by a punch: it bears on a node or two of each die
STATE  PLSTN
KINEM  LOG
BLOCK  strip PL8LS 4 metal
   0. 0.   20. 0.   20. 1.2   0. 1.2
   40 1.   3 1.
LAW    metal EPLA
   200000. 0.3
   SWIFT 500. 0.01 0.2
LAW    film COUL2D
   PENETR 1.E-3   PHI 0.1   AUGMENT 10
DIE    punch PILOT 0. 1.2
   SEGM   8. 80.   8. 1.2
   FILLT  1.5 1.E-3
   SEGM   8. 1.2   -1. 1.2
DIE    die
   SEGM   9.5 -60.   9.5 0.
   FILLT  1.5 1.E-3
   SEGM   9.5 0.   80. 0.
CNT2D  strip 3 punch film
CNT2D  strip 1 die film
FIXED  strip 4 X
LIC    press
   0. 0.   1. -7.
MOVE   punch Y press
STRAT  0.002 1.E-6 0.02   6 3
SAVE   1000
END
"""


# Bends between a punch and a die that have hardly more than the strip between them, and goes on until it is upright; the largest force
# of the punch on 120 x 4 elements.
FINE_U = 19.30
UPRIGHT = """TITLE  A strip bent to a U without a holder
STATE  PLSTN
KINEM  LOG
BLOCK  sheet PL8LS 4 steel
   0. 0.   50. 0.   50. 1.2   0. 1.2
   60 1.   3 1.
LAW    steel EPLA
   210000. 0.3
   SWIFT 500. 0.01 0.2
LAW    film COUL2D
   PENETR 1.E-3   PHI 0.05   AUGMENT 10
DIE    punch PILOT 0. 1.2
   SEGM   15. 60.   15. 1.2
   FILLT  5. 1.E-3
   SEGM   15. 1.2   -1. 1.2
DIE    die PILOT 0. 0.
   SEGM   16.32 -60.   16.32 0.
   FILLT  5. 1.E-3
   SEGM   16.32 0.   80. 0.
CNT2D  sheet 3 punch film
CNT2D  sheet 1 die film
FIXED  sheet 4 X
LIC    press
   0. 0.   1. -30.
MOVE   punch Y press
STRAT  0.002 1.E-7 0.02   6 3
SAVE   1000
END
"""
# Lies on a die, and is bent off it: all of its flange touches at the start.
PUNCH_L, DIE_L, GAP_L = 15.0, 25.1, 1.02
LYING = f"""TITLE  A strip on a die under a holder that hardly leaves it a gap
STATE  PLSTN
KINEM  LOG
PARAM  sides 70
BLOCK  sheet PL8LS 4 steel
   0. 0.   60. 0.   60. 1.   0. 1.
   $sides 1.   4 1.
LAW    steel EPLA
   200000. 0.3
   SWIFT 500. 0.01 0.2
LAW    film COUL2D
   PENETR 0.01   PHI 0.1
DIE    punch PILOT 0. 1.
   SEGM   20. 80.   20. 1.
   FILLT  20-{PUNCH_L} 1.E-3
   SEGM   20. 1.   -1. 1.
DIE    die
   SEGM   21.1 -80.   21.1 0.
   FILLT  {DIE_L}-21.1 1.E-3
   SEGM   21.1 0.   90. 0.
DIE    holder
   SEGM   90. {GAP_L}   21.1 {GAP_L}
CNT2D  sheet 3 punch film
CNT2D  sheet 1 die film
CNT2D  sheet 3 holder film
FIXED  sheet 4 X
LIC    press
   0. 0.   1. -25.
MOVE   punch Y press
STRAT  1.E-4 1.E-6 0.02   5 3
STOP   0.05
SAVE   1000
END
"""
# The wall of a cup whose flange is clamped in a gap that it thickens into.
NECKS = """TITLE a sheet with a narrow middle, pulled
STATE PLSTS 2.
KINEM LOG
BLOCK b PL8LS 9 m
   0. 0.   10. 0.   9.9 20.   0. 20.
   4 1.   12 1.
LAW m EPLA
   200000. 0.3
   SWIFT 500. 0.01 0.05
FIXED b 3 Y
FIXED b 4 X
MOVE b 1 Y go
LIC go
   0. 0.   1. -40.
PROBE left MIN stretch_zz b
STRAT 0.002 1.E-6 0.02 6 3
END
"""
TORN = """TITLE  A cup that tears
STATE  AXISYM
KINEM  LOG
BLOCK  sheet PL8LS 4 steel
   0. 0.   50. 0.   50. 1.   0. 1.
   40 1.   2 1.
LAW    steel EPLA
   210000. 0.3
   SWIFT 500. 0.01 0.2
LAW    film COUL2D
   PENETR 1.E-3   PHI 0.1   AUGMENT 10
DIE    punch PILOT 0. 1.
   SEGM   25. 50.   25. 1.
   FILLT  5. 1.E-3
   SEGM   25. 1.   -1. 1.
DIE    die PILOT 0. 0.
   SEGM   26.2 -50.   26.2 0.
   FILLT  5. 1.E-3
   SEGM   26.2 0.   70. 0.
DIE    holder PILOT 0. 1.
   SEGM   70. 1.02   31.7 1.02
CNT2D  sheet 3 holder film
CNT2D  sheet 3 punch film
CNT2D  sheet 1 die film
FIXED  sheet 4 X
LIC    press
   0. 0.   1. -25.
MOVE   punch Y press
STRAT  0.002 1.E-7 0.02   6 3
SAVE   1000
END
"""


# Air bending without friction, half of it, and release.
THICK, YOUNG, POISSON, OPENING, RADIUS, STROKE = 1.2, 200000.0, 0.3, 16.0, 3.0, 8.0
VEE = f"""TITLE  A strip bent in the air over a die with an opening of 90 degrees, and released
STATE  PLSTN
KINEM  LOG
BLOCK  strip PL8LS 4 metal
   0. 0.   30. 0.   30. {THICK}   0. {THICK}
   60 1.   4 1.
LAW    metal EPLA
   {YOUNG} {POISSON}
   SWIFT 500. 0.01 0.2
LAW    dry COUL2D
   PENETR 1.E-3   PHI 0.   AUGMENT 10
DIE    punch PILOT 0. {THICK}
   SEGM   60. {60 + THICK}   0. {THICK}
   FILLT  {RADIUS} 1.E-3
   SEGM   0. {THICK}   -60. {60 + THICK}
DIE    die
   SEGM   0. {-OPENING}   {OPENING} 0.
   FILLT  {RADIUS} 1.E-3
   SEGM   {OPENING} 0.   80. 0.
CNT2D  strip 3 punch dry
CNT2D  strip 1 die dry
FIXED  strip 4 X
LIC    press
   0. 0.   1. {-STROKE}   1.3 2.
MOVE   punch Y press
STRAT  0.002 1.E-6 0.02   6 3
SAVE   1000
PROBE  in_x NODE X 24. 0.
PROBE  in_y NODE Y 24. 0.
PROBE  out_x NODE X 30. 0.
PROBE  out_y NODE Y 30. 0.
END
"""


def judge(checks, name, cards, points, phi):
    """One case."""
    import die_depth  # pylint: disable=import-outside-toplevel

    deck = write(checks.path(name, "case.lag"), HEAD.format(title=name, points=points, phi=phi) + cards)
    result = run([deck, "--out", checks.path(name, "out"), "--threads", "1"])
    if not checks.that(result.returncode == DONE, f"{name}: done", said(result)):
        return
    rows = die_depth.sampled(checks.path(name, "out", "case.g01.h5"))
    reported = summary(checks.path(name, "out"))
    checks.that(len(rows) == reported["steps"] + 1, f"{name}: all steps saved", f"{len(rows)} of {reported['steps'] + 1}")
    worst = max(rows, key=lambda row: row["share"])
    print(f"{name}: {reported['steps']} steps, {reported['iterations']} iterations, {reported['cutbacks']} cutbacks; deepest {worst['share']:.3g} of a "
          f"side, largest pressure {max(row['most_pressure'] for row in rows):.4g}")
    checks.that(min(row["least_pressure"] for row in rows) >= 0, f"{name}: no pressure below zero")
    checks.that(max(row["most_pressure"] for row in rows) > 100, f"{name}: there is contact")
    at_points = reported["checks"]["max_penetration_over_allowed"]
    checks.that(at_points <= 1, f"{name}: no point of contact deeper than allowed", at_points)
    checks.that(worst["share"] <= BETWEEN.get(name, 1.0)*ALLOWED, f"{name}: nowhere deeper than allowed", worst)
    says = reported["checks"]["max_penetration_sampled_over_allowed"] * ALLOWED
    checks.that(abs(says - worst["share"]) <= 1e-6 * ALLOWED, f"{name}: summary.json says so", f"{says} against {worst['share']}")
    checks.that(abs(reported["checks"]["max_penetration_sampled"] - max(row["depth"] for row in rows)) <= 1e-6 * ALLOWED,
                f"{name}: and how deep", reported["checks"])
    checks.that(reported["checks"]["least_dissipation"] >= 0, f"{name}: friction takes work", reported["checks"]["least_dissipation"])
    if name.startswith("leaving"):
        touching = [row["most_pressure"] > 0 for row in rows]
        changes = sum(a != b for a, b in zip(touching, touching[1:]))
        checks.that(changes >= 3 and touching[-1], f"{name}: it leaves and comes back", changes)


def bending(checks):
    """A beam that nothing holds but its two dies, bent until both touch it between its points alone (ALONG): it does not rest."""
    deck = write(checks.path("bending.lag"), BENDING)
    result = run([deck, "--out", checks.path("bending"), "--threads", "1"])
    if not checks.that(result.returncode == DONE, "bending: done", said(result)):
        return
    ran = summary(checks.path("bending"))
    print(f"bending: {ran['steps']} steps, {ran['iterations']} iterations, {ran['cutbacks']} cutbacks")
    checks.that(ran["steps"] <= 60, "bending: steps as long as with points in contact", ran["steps"])


def free_bending(checks, name, cards, fine):
    """A strip bent by a punch until it is all but upright: it bears on a node or two of each die, and snaps from one to the next.
    Returns its steps."""
    deck = write(checks.path(f"{name}.lag"), cards)
    result = run([deck, "--out", checks.path(name), "--threads", "1"])
    if not checks.that(result.returncode == DONE, f"{name}: done", said(result)):
        return 0
    ran = summary(checks.path(name))
    print(f"{name}: {ran['steps']} steps, {ran['iterations']} iterations, {ran['cutbacks']} cutbacks")
    with open(checks.path(name, f"{name}.log"), encoding="utf-8") as file:
        listing = file.read()
    damped = [range(int(a), int(b) + 1) for a, b in re.findall(r"^note: steps (\d+) to (\d+) were damped", listing, re.MULTILINE)]
    announced = listing.count("steps are damped until") - listing.count("is tried without damping first")
    checks.that(len(damped) == announced, f"{name}: damped steps are named", damped)
    rows = history(checks.path(name))
    largest = max(force for step, force in zip(rows["step"], rows["force_y_punch"]) if not any(int(step) in some for some in damped))
    checks.that(abs(largest - fine) < 0.03 * fine, f"{name}: force of the punch as on a finer mesh", largest)
    return ran["steps"]


def lying(checks):
    """A strip that touches its die all along peels off it in the first step, however many sides there are. The force is that of elastic
    bending between four lines, P c^2 (a + c/3)/EI = travel, a from the middle to the punch's radius, c from there to the die's."""
    deck = write(checks.path("lying.lag"), LYING)
    reach = DIE_L - PUNCH_L
    stiffness = 200000 / (1 - 0.3**2) / 12 / (reach**2 * (PUNCH_L + reach / 3))
    # nodes bear, up to half a side away from where the radii begin
    for sides, limit in ((35, 0.2), (70, 0.04), (140, 0.04)):
        out = checks.path(f"lying-{sides}")
        result = run([deck, "--out", out, "--threads", "1", "-p", f"sides={sides}"])
        if not checks.that(result.returncode == DONE, f"lying on {sides} sides: done", said(result)):
            continue
        rows = history(out)
        expected = stiffness * -rows["displacement_y_punch"][0]
        print(f"lying on {sides} sides: {rows['force_y_punch'][0]:.4g} in the first step, closed form {expected:.4g}")
        checks.that(abs(rows["force_y_punch"][0] / expected - 1) < limit, f"lying on {sides} sides: force of elastic bending",
                    rows["force_y_punch"][0] / expected)
        cutbacks = summary(out)["cutbacks"]
        checks.that(cutbacks < 10, f"lying on {sides} sides: less than 10 cutbacks", cutbacks)


def tears(checks):
    """A cup whose flange cannot thicken: its wall necks until nothing is left of it, and the run says that, not that it folds. A sheet of
    plane stress pulled until it has necked across the plane."""
    result = run([write(checks.path("cup.lag"), TORN), "--out", checks.path("cup"), "--threads", "1"])
    checks.that(result.returncode == NO_CONVERGENCE, "cup: ends with 3", said(result))
    for words in ("a body parts: step", "sheet has thinned to nothing at x = ", "it has necked there and tears"):
        checks.that(words in said(result), f"cup: says '{words}'", said(result))
    checks.that("DIE name SIDES" not in said(result), "cup: nothing of contact with itself", said(result))
    result = run([write(checks.path("sheet.lag"), NECKS), "--out", checks.path("sheet"), "--threads", "1"])
    checks.that(result.returncode == DONE, "sheet: ends with 0", said(result))
    told = [line["text"] for line in summary(checks.path("sheet"))["warnings"] if line["text"].startswith("b has thinned to ")]
    left = history(checks.path("sheet"))["left"][-1]
    checks.that(len(told) == 1 and abs(float(told[0].split()[4])/100/left - 1) < 0.05, "sheet: told how thin it is", (told, left))


def springback(checks):
    """The leg of a strip bent in the air springs back by the elastic bending N s^2/2EI of plane strain: N is the force across it on the
    die's radius, s its length from there to the punch. What is left out, the bend's own curve beside the straight leg, is below 3 %.
    """
    deck = write(checks.path("vee.lag"), VEE)
    result = run([deck, "--out", checks.path("vee"), "--threads", "1"])
    if not checks.that(result.returncode == DONE, "vee: done", said(result)):
        return
    rows = history(checks.path("vee"))
    end = min(range(len(rows["time"])), key=lambda k: abs(rows["time"][k] - 1))
    angles = [math.atan2(rows["out_y"][k] - rows["in_y"][k], rows["out_x"][k] - rows["in_x"][k]) for k in (end, -1)]
    sine, cosine = math.sin(angles[0]), math.cos(angles[0])
    # where the leg touches the die's radius, from the middle of the strip under the tip of the punch
    across = OPENING + RADIUS * math.tan(math.pi / 8) - RADIUS * sine
    up = RADIUS * (cosine - 1) - (THICK / 2 - STROKE + RADIUS * (math.sqrt(2) - 1))
    leg = across * cosine + up * sine
    force = abs(rows["force_y_punch"][end]) / cosine
    bending = YOUNG / (1 - POISSON**2) * THICK**3 / 12
    expected = force * leg**2 / (2 * bending)
    found = angles[0] - angles[1]
    print(f"vee: springs back by {math.degrees(found):.4g} degrees, closed form {math.degrees(expected):.4g}")
    checks.that(abs(found / expected - 1) < 0.03, "vee: springback as of elastic bending", f"{found} against {expected}")


def main():
    with_h5py()
    checks = Checks()
    for name, cards, points, phi in CASES:
        judge(checks, name, cards, points, phi)
    bending(checks)
    free_bending(checks, "strip", STRIP, FINE)
    # 1 444 where a correction past a limit point is reversed
    steps = free_bending(checks, "upright", UPRIGHT, FINE_U)
    checks.that(steps < 900, "upright: at most 900 steps", steps)
    lying(checks)
    tears(checks)
    springback(checks)
    checks.end()


if __name__ == "__main__":
    main()
