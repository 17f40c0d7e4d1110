#!/usr/bin/env python3
"""Decks that know nothing of remeshing, remeshed half-way with the sizes that are taken when none are given.

usage: run_any_deck.py [-v] [-k]

Every kind of scene: small and large strains, all plane states, loads and imposed motions, rigid and deformable dies, one body and
several. The end is that of the deck on its own mesh, within the error of that mesh (the finer of the two is nearer to the truth, so
each deviation has a limit of its own), or that on a mesh four times as fine; work of friction never falls. Bodies without stress, that springs hold against their weight, wait
for a die, or expand freely, get their new mesh at the first try as others do: what is round-off of a stress is no error of a new mesh.
"""
import os
import re
import sys

sys.dont_write_bytecode = True
from remeshed import ROOT, cycle, facts, tries, within_limits  # noqa: E402
from support import DONE, Checks, history, run, said, summary, write  # noqa: E402

# Deck, options, how far each column may be from the deck's own at the end, and options of the deck it is compared with, where those are
# others: of the drawn sheet the own mesh has 4 % less plastic work than one four times as fine, and one with single elements across it 2 % more.
DECKS = [
    ("cook/cook", [], {"u_corner": 0.02, "elastic_energy": 0.02}),
    ("elliptic_membrane/elliptic_membrane", [], {"elastic_energy": 0.001}),
    ("thick_cylinder/thick_cylinder", ["nx=20"], {"u_inner": 0.003, "elastic_energy": 0.001}),
    ("thick_cylinder/thick_cylinder_plastic", [], {"u_inner": 0.01, "plastic_work": 0.01}),
    ("plastic_forming/disc", [], {"force_y_upper": 0.001, "plastic_work": 0.001}),
    ("plastic_forming/tube", [], {"push": 0.001}),
    ("thick_cylinder/plastic_expansion", [], {"force": 0.001}),
    ("hertz/hertz", [], {"force_y_ball": 0.002, "peak_pressure": 0.005}),
    ("incline/drag", [], {"force": 0.001, "slip_min": 0.01}),
    ("ring/ring", [], {"force_y_upper": 0.01, "bore_mid": 0.01, "friction_work": 0.02}),
    ("stamping/stretch", [], {"force_y_punch": 0.005, "pull": 0.005}),
    ("stamping/draw", [], {"top": 0.001, "end_x": 0.001, "plastic_work": 0.03}, ["nx=240", "ny=12"]),
    ("press_fit/press_fit", [], {"push_force": 0.001, "friction_work": 0.002}),
    ("upsetting_frictionless/upsetting_frictionless", [], {"force_y_upper": 0.0005, "radius": 0.0005}),
]
# A die that a spring holds: an element without nodes.
SPRING = """TITLE  Block under a die that a spring holds sideways
STATE  PLSTN
KINEM  LOG
BLOCK  block PL8LS 4 rubber
   0. 0.   4. 0.   4. 4.   0. 4.
   4 1.   4 1.
LAW    rubber ELA
   1000. 0.3
LAW    film COUL2D
   PENETR 1.E-3   PHI 0.
DIE    upper PILOT 0. 4.
   SEGM   6. 4.   -1. 4.
CNT2D  block 3 upper -3 film
FIXED  block 1 Y
FIXED  block 4 X
LIC    press
   0. 0.   1. -0.1
MOVE   upper Y press
FREE   upper X
SPRNG  upper X 10.
STRAT  0.1 1.E-3 0.1   4 3
END
"""
# A body by its contour that a force of volume pushes against springs: each part of it moves by force over stiffness, b A/K = 0.32.
PUSHED = """TITLE  Square held by springs against a force of volume
STATE  PLSTN
KINEM  LOG
BODY   block PL8LS 4 rubber
   SEGM   0. 0.   4. 0.
   SEGM   4. 0.   4. 4.
   SEGM   4. 4.   0. 4.
   SEGM   0. 4.   0. 0.
LAW    rubber ELA
   1000. 0.3
FIXED  block 1 Y
LIC    push
   0. 0.     1. 1.
BFORC  block X 0.002 push
SPRNG  block X 0.1
STRAT  0.1 1.E-3 0.1   4 3
REMSH
PROBE  right NODE UX 4. 4.
END
"""
# Bodies without stress.
UNSTRESSED = """TITLE  A block without stress
STATE  {state}
KINEM  {kinematics}
BLOCK  block PL8LS {points}
   0. 0.   20. 0.   20. 10.   0. 10.
   8 1.   4 1.
{law}
LIC    up
   0. 0.   1. 1.
STRAT  0.1 1.E-6 0.25   6 3
STOP   1.
{cards}END
"""
ELASTIC, EXPANDING = "LAW    steel ELA\n   200000. 0.3", "LAW    steel ELATH\n   200000. 0.3   1.E-5"
FLOATS = "SPRNG  block X {0}\nSPRNG  block Y {0}\nBFORC  block Y -{1} up\n"
HELD = "FIXED  block 1 Y\nFIXED  block 4 X\n"
WAITS = HELD + """LAW    film COUL2D
   PENETR 1.E-3   PHI 0.1
DIE    upper PILOT 0. 15.
   SEGM   40. 15.   -1. 15.
CNT2D  block 3 upper film
SPRNG  upper Y 100.
FORCE  upper Y -100. up
"""
EXPANDS = HELD + "TEMPE  block 100. up\n"
UNSTRESSED_CASES = {
    "floats": ("PLSTN", "LOG", "4 steel", FLOATS.format("10.", "1.E-2")),
    "floats_far": ("PLSTN", "LOG", "9 steel MEAN", FLOATS.format("0.1", "1.E-3")),
    "floats_softly": ("PLSTS 1.", "LOG", "4 steel", FLOATS.format("1.E-3", "1.E-6")),
    "floats_small": ("PLSTN", "SMALL", "4 steel", FLOATS.format("10.", "1.E-2")),
    "waits": ("PLSTN", "LOG", "4 steel", WAITS),
    "expands": ("PLSTS 1.", "LOG", "4 steel", EXPANDS),
    "expands_round": ("AXISYM", "LOG", "9 steel", EXPANDS),
}
# How far the forces of dies that the new mesh bears before it is in balance may be from those of the old one.
CARRIED = 0.05


# A block with a notch in its side, upset until the notch has closed from its ground to its mouth; and its lower half, whose flank meets
# the plane of symmetry: both flanks go the same way, so nothing slides in the fold.
NOTCH = """TITLE  a notch that closes
STATE  PLSTN
KINEM  LOG
BODY   part PL8LS 4 metal
   SEGM  0. 0.     12. 0.
   SEGM  12. 0.    12. 8.
   SEGM  12. 8.    8. 10.
   SEGM  8. 10.    12. 12.
   SEGM  12. 12.   12. 20.
   SEGM  12. 20.   0. 20.
   SEGM  0. 20.    0. 0.
LAW    metal EPLA
   70000. 0.33
   SWIFT 250. 0.01 0.15
LAW    film COUL2D
   PENETR 1.E-3   PHI 0.2   AUGMENT 10
DIE    base
   SEGM  -40. 0.   40. 0.
CNT2D  part 1 2 base film
DIE    top PILOT 0. 20.
   SEGM  40. 20.  -40. 20.
CNT2D  part 5 6 top film
FIXED  part 7 X
DIE    skin SIDES part 3 4
CNT2D  skin skin film
LIC    down
   0. 0.  1. -7.
MOVE   top Y down
STRAT  0.002 1.E-6 0.01   6 3
STOP   1.
REMSH
END
"""
SMALLEST, LOOKS = 0.3, (0.7, 0.85)     # size of elements [length]; times of new meshes in `askew`
HALF_NOTCH = """TITLE  half of a notch that closes
STATE  PLSTN
KINEM  LOG
BODY   part PL8LS 4 metal
   SEGM  0. 0.     12. 0.
   SEGM  12. 0.    12. 8.
   SEGM  12. 8.    8. 10.
   SEGM  8. 10.    0. 10.
   SEGM  0. 10.    0. 0.
LAW    metal EPLA
   70000. 0.33
   SWIFT 250. 0.01 0.15
LAW    film COUL2D
   PENETR 1.E-3   PHI 0.2   AUGMENT 10
LAW    smooth COUL2D
   PENETR 1.E-3   PHI 0.   AUGMENT 10
DIE    base PILOT 0. 0.
   SEGM  -40. 0.   40. 0.
CNT2D  part 1 2 base film
DIE    plane
   SEGM  40. 10.   -40. 10.
CNT2D  part 2 3 plane smooth
FIXED  part 4 Y
FIXED  part 5 X
LIC    up
   0. 0.  1. 3.5
MOVE   base Y up
STRAT  0.002 1.E-6 0.02   6 3
STOP   1.
REMSH
END
"""


def with_remesh(deck, path):
    """The deck with a new mesh at half its time."""
    with open(deck, encoding="utf-8") as file:
        text, count = re.subn(r"(?m)^END", "REMSH\n   TIMES 0.5\nEND", file.read())
    if count != 1:
        sys.exit(f"{deck} has {count} END cards")
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)


def remeshed(checks, deck, options, limits, compared=None):
    short = os.path.splitext(os.path.basename(deck))[0]
    path, out, plain = checks.path(short + ".lag"), checks.path(short), checks.path(short + "-own")
    words, other = ([word for option in of for word in ("-p", option)] for of in (options, options if compared is None else compared))
    with_remesh(deck, path)
    result = run([deck, "--out", plain, "--threads", "1", *other])
    if not checks.that(result.returncode == DONE, f"{short}: its own mesh", said(result)):
        return
    result = cycle(path, out, *words)
    if not checks.that(result.returncode == DONE, f"{short}: remeshed", result.stdout + result.stderr):
        return
    made = tries(out)
    if not checks.that(len(made) == 1 and made[0]["accepted"] == "y", f"{short}: one new mesh, at the first try", [t["reason"] for t in made]):
        return
    within_limits(checks, out)
    carried = facts(out, 2, "restart")["carried_force_change"]
    checks.that(carried < CARRIED, f"{short}: forces of dies carried within {100 * CARRIED:g} %", carried)
    rows, own = history(out), history(plain)
    for column, limit in limits.items():
        off = rows[column][-1] / own[column][-1] - 1
        checks.that(abs(off) < limit, f"{short}: {column} within {100 * limit:g} %", f"{100 * off:+.3f} %")
    work = rows["friction_work"]
    checks.that(all(after >= before - 1e-9 * abs(work[-1]) for before, after in zip(work, work[1:])),
                f"{short}: work of friction never falls")


def pushed(checks):
    """Loads on a body that has no mesh when its deck is read."""
    out = checks.path("pushed.out")
    result = cycle(write(checks.path("pushed.lag"), PUSHED), out)
    if not checks.that(result.returncode == DONE, "loads on a contour: the cycle ends with 0", result.stdout + result.stderr):
        return
    moved = history(out)["right"][-1]
    checks.that(abs(moved / 0.32 - 1) < 1e-6, "loads on a contour: force over stiffness", moved)


def closing(checks):
    """A notch that closes on itself: its flanks are wavy where they press on each other, down to the ground that they have in common,
    and new meshes follow them both. The force is that of its half."""
    out, half = checks.path("notch.out"), checks.path("half_notch.out")
    result = cycle(write(checks.path("notch.lag"), NOTCH), out)
    if not checks.that(result.returncode == DONE, "a notch that closes: the cycle ends with 0", result.stdout + result.stderr):
        return
    meshes = tries(out)
    checks.that(all(one["accepted"] == "y" for one in meshes), "a notch that closes: every new mesh at the first try",
                [one["reason"] for one in meshes])
    # the flanks are 4.5 long
    checks.that(4.3 < float(meshes[-1]["lap_depth [length]"]) < 5, "a notch that closes: its lap is told", meshes[-1])
    if not checks.that(cycle(write(checks.path("half_notch.lag"), HALF_NOTCH), half).returncode == DONE, "half a notch: ends with 0"):
        return
    force, alone = [abs(history(folder)["force_y_base"][-1]) for folder in (out, half)]
    checks.that(abs(force/alone - 1) < 0.005, "a notch that closes: the force of its half", [force, alone])


def askew(checks):
    """A notch with flanks of unlike length: how deep the fold is when it has closed in part, and later, on elements of two sizes, with new meshes at the
    same instants. The run on the finer ones takes half a minute: it is the reference."""
    depths = []
    for name, smallest in (("coarse", SMALLEST), ("fine", SMALLEST / 2)):
        sizes = f"REMSH\n   TIMES {' '.join(map(str, LOOKS))}\n   ERROR 0.05 0.4\n   ANGLE 15. 165.\n   LEAST 5\n   SIZE {smallest:g} {4 * smallest:g}\n"
        text = NOTCH.replace("12. 8.    8. 10.", "12. 7.    8. 10.").replace("12. 0.    12. 8.", "12. 0.    12. 7.")
        out = checks.path(f"askew.{name}.out")
        result = cycle(write(checks.path(f"askew.{name}.lag"), text.replace("STOP   1.", f"STOP   {LOOKS[-1] + 0.01}").replace("REMSH\n", sizes)), out)
        if not checks.that(result.returncode == DONE, f"a notch askew, {name}: the cycle ends with 0", result.stdout + result.stderr):
            return
        looked = {float(one["stop_time [time]"]): float(one["lap_depth [length]"]) for one in tries(out) if one["accepted"] == "y" and one["lap_depth [length]"]}
        depths.append([looked[time] for time in LOOKS])
    off = max(abs(here - there) for here, there in zip(*depths))
    checks.that(off < SMALLEST, "a notch askew: depth of the fold within one element of that on elements of half the size", depths)


def main():
    checks = Checks()
    pushed(checks)
    closing(checks)
    askew(checks)
    for name, *more in DECKS:
        remeshed(checks, os.path.join(ROOT, "decks", name + ".lag"), *more)
    remeshed(checks, write(checks.path("decks", "spring.lag"), SPRING), [], {"force_y_upper": 0.001, "elastic_energy": 0.001})
    for name, (state, kinematics, points, cards) in UNSTRESSED_CASES.items():
        law = EXPANDING if cards == EXPANDS else ELASTIC
        text = UNSTRESSED.format(state=state, kinematics=kinematics, points=points, law=law, cards=cards)
        remeshed(checks, write(checks.path("decks", name + ".lag"), text), [], {})
    checks.end()


if __name__ == "__main__":
    main()
