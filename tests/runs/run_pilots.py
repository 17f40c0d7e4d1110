#!/usr/bin/env python3
"""Dies that are free: forces, moments and springs on pilots, gaps and pauses, what is said of dies that nothing holds, and friction
by the factor m, against closed forms.

usage: run_pilots.py [-v] [-k]       -v prints every check, -k keeps the results
"""
import math
import re
import sys

sys.dont_write_bytecode = True
from support import DONE, NO_CONVERGENCE, Checks, history, run, said, summary, write  # noqa: E402

# A block under a die that is wider than it; the die's pilot stands over the middle of the block.
BLOCK = """TITLE  {title}
STATE  {state}
KINEM  {kinematics}
BLOCK  block PL8LS 4 stuff
   0. 0.   10. 0.   10. 5.   0. 5.
   8 1.   4 1.
LAW    stuff {law}
LAW    skin COUL2D
   {skin}
DIE    press PILOT {pilot}
   SEGM  40. 5.   -20. 5.
CNT2D  block 3 press -3 skin
{fixed}
LIC    load
   0. 0.   1. 1.
{cards}
STRAT  0.1 1.E-4 0.1   5 3
END
"""
ELASTIC = "ELA\n   1000. 0."
PLASTIC = "EPLA\n   1000. 0.3\n   LINEAR 10. 50."
SMOOTH = "PENETR 1.E-3 PHI 0."


def deck_of(checks, name, replaced=None, **parts):
    """Write a deck, with some of its text replaced; its path."""
    text = BLOCK.format(**{"state": "PLSTN", "kinematics": "SMALL", "law": ELASTIC, "skin": SMOOTH, "pilot": "5. 5.",
                           "fixed": "FIXED  block 1 Y\nFIXED  block 4 X", "title": name, **parts})
    for old, new in (replaced or {}).items():
        assert old in text, old
        text = text.replace(old, new)
    deck = checks.path(name + ".lag")
    write(deck, text)
    return deck


def run_deck(checks, name, **parts):
    """Run a deck; the columns of its history."""
    result = run([deck_of(checks, name, **parts), "--out", checks.path(name)])
    checks.that(result.returncode == DONE, f"{name}: runs to its end", said(result))
    return history(checks.path(name))


def fail_deck(checks, name, **parts):
    """Run a deck that finds no equilibrium; what the run says."""
    result = run([deck_of(checks, name, **parts), "--out", checks.path(name)])
    checks.that(result.returncode == NO_CONVERGENCE, f"{name}: finds no equilibrium", said(result))
    return result


def close(checks, what, found, wanted, tolerance):
    scale = abs(wanted) or 1.0
    checks.that(abs(found - wanted) <= tolerance * scale, f"{what}: {found:.12g} for {wanted:.12g}", f"within {tolerance}")


def compression(checks):
    """Uniform compression: w F/(E A) h in the block, and p/AKP in the penalty, AKP = E/100/(PENETR side)."""
    force, young, side = 20.0, 1000.0, 10.0 / 8
    rows = run_deck(checks, "compression", cards=f"FORCE  press Y -{force} load")
    pressure = force / 10
    sunk = pressure / young * 5 + pressure * 1e-3 * side / (0.01 * young)
    close(checks, "depth under a force", -rows["displacement_y_press"][-1], sunk, 1e-7)
    for step, time in enumerate(rows["time"]):
        close(checks, f"force on the die, step {step + 1}", rows["force_y_press"][step], force * time, 1e-8)

    rows = run_deck(checks, "axisymmetric", state="AXISYM", cards=f"FORCE  press Y -{force} load", pilot="0. 5.")
    pressure = force / (math.pi * 100)
    sunk = pressure / young * 5 + pressure * 1e-3 * side / (0.01 * young)
    close(checks, "depth under a total force, axisymmetric", -rows["displacement_y_press"][-1], sunk, 1e-7)
    close(checks, "total force on the die", rows["force_y_press"][-1], force, 1e-8)


def springs(checks):
    """Half of the way goes into the spring when it is as stiff as block and penalty together."""
    force, young, side = 20.0, 1000.0, 10.0 / 8
    stiffness = 1 / (5 / (young * 10) + 1e-3 * side / (0.01 * young * 10))
    rows = run_deck(checks, "spring", cards=f"FORCE  press Y -{force} load\nSPRNG  press Y {stiffness!r}")
    close(checks, "depth with a spring", -rows["displacement_y_press"][-1], force / (2 * stiffness), 1e-7)
    close(checks, "force that is left for the block", rows["force_y_press"][-1], force / 2, 1e-7)


def balance(checks):
    """A die free to turn, pressed off the middle of a plastic block: no moment about its pilot, the given force."""
    rows = run_deck(checks, "balance", kinematics="LOG", law=PLASTIC, skin="PENETR 1.E-3 PHI 0.2", pilot="6. 5.",
                    fixed="FIXED  block 1 XY", cards="FORCE  press Y -130. load\nFREE   press A")
    for step, time in enumerate(rows["time"]):
        close(checks, f"force, step {step + 1}", rows["force_y_press"][step], 130 * time, 1e-8)
        checks.that(abs(rows["moment_press"][step]) <= 1e-8 * 130 * time * 10, f"no moment, step {step + 1}", rows["moment_press"][step])
    checks.that(rows["rotation_press"][-1] < -1e-2, "the die has turned", rows["rotation_press"][-1])

    rows = run_deck(checks, "moment", pilot="5. 5.", cards="FORCE  press Y -20. load\nFORCE  press A -5. load")
    close(checks, "moment that is given", rows["moment_press"][-1], 5.0, 1e-8)
    rows = run_deck(checks, "shared", pilot="5. 5.", cards="FORCE  press Y -20. load\nFORCE  press A -5. load\nSPRNG  press A 1.E4")
    checks.that(rows["rotation_press"][-1] < -1e-4, "the die turns against its spring", rows["rotation_press"][-1])
    # the history has what acts on the pilot from outside: force given, spring and all
    close(checks, "moment the spring leaves", rows["moment_press"][-1], 5.0 + 1e4 * rows["rotation_press"][-1], 1e-8)


def friction_factor(checks):
    """A die slides over a block that has not hardened: friction m sigma_y/sqrt(3) on the face, whatever the pressure; with PHI 1
    from this pressure on, else the pressure."""
    for m, phi, depth in ((0.3, "", 0.02), (1.0, "", 0.02), (1.0, "PHI 1.", 0.02), (1.0, "PHI 1.", 0.04)):
        rows = run_deck(checks, f"factor_{m}_{phi[4:]}_{depth}", law="EPLA\n   1000. 0.3\n   LINEAR 10. 0.",
                        skin=f"PENETR 1.E-3 M {m} {phi} AKTAU 1.E4",
                        fixed="FIXED  block 1 XY\nFIXED  block 2 X\nFIXED  block 4 X\nFIXED  block 3 X",
                        cards=f"MOVE   press Y load -{depth}\nMOVE   press X load 0.5")
        friction, pressed = m*10/math.sqrt(3)*10, abs(rows["force_y_press"][-1])
        checks.that((pressed < friction) == (m > 0.5 and depth < 0.03), "on both sides of the limit", (pressed, friction))
        close(checks, f"friction by the factor {m} {phi}, depth {depth}", -rows["force_x_press"][-1],
              min(friction, pressed) if phi else friction, 1e-9)


def cohesion(checks):
    """A block that rocks as it is pulled to and fro by its top, which is glued: its heel leaves the ground, and what is left slides
    with friction by the pressure and by cohesion; friction is never more than with cohesion on the whole ground."""
    deck = checks.path("cohesion.lag")
    write(deck, """TITLE  A block pulled to and fro
STATE  PLSTN
KINEM  LOG
BLOCK  block PL8LS 4 stuff
   0. 0.   4. 0.   4. 2.   0. 2.
   8 1.   4 1.
LAW    stuff ELA
   1000. 0.3
LAW    skin COUL2D
   PENETR 1.E-3   PHI 0.2   PBOUE 1.
LAW    glue GLUE2D
DIE    ground
   SEGM  -10. 0.   20. 0.
DIE    top PILOT 0. 2.
   SEGM  20. 2.   -10. 2.
CNT2D  block 1 ground skin
CNT2D  block 3 top glue
FORCE  top Y -20. down
MOVE   top X pull
LIC    down
   0. 0.   1. 1.
LIC    pull
   0. 0.   1. 0.   2. 0.3   4. -0.3
STRAT  0.1 1.E-5 0.1   5 3
END
""")
    result = run([deck, "--out", checks.path("cohesion")])
    if checks.that(result.returncode == DONE, "cohesion where a heel opens", said(result)):
        friction = [abs(force) for force in history(checks.path("cohesion"))["force_x_ground"]]
        largest = 0.2*20 + 4*1.
        checks.that(0.9*largest < friction[-1] <= largest and max(friction) <= largest*(1 + 1e-6), "friction with cohesion",
                    (friction[-1], max(friction), largest))


def gaps(checks):
    """A force takes its die over a gap, at once, to the depth that it has without one; a die that no force acts on rests where it
    is, and is taken up again."""
    force, side = 20.0, 10.0 / 8
    sunk = force / 10 / 1000.0 * 5 + force / 10 * 1e-3 * side / (0.01 * 1000.0)
    raised = "SEGM  40. 5.   -20. 5."
    for name, gap, cards in (("gap", 1.0, ""), ("oblique", 0.5, "FIXED  block 2 X\nFORCE  press X 5. load\nSPRNG  press X 10."),
                             ("far", 8.0, "FREE   press X")):
        rows = run_deck(checks, name, cards=f"FORCE  press Y -{force} load\n{cards}", pilot=f"5. {5 + gap}",
                        replaced={raised: f"SEGM  40. {5 + gap}   -20. {5 + gap}"})
        close(checks, f"depth over a gap, {name}", -rows["displacement_y_press"][-1], sunk + gap, 1e-7)
        for step, time in enumerate(rows["time"]):
            close(checks, f"force over a gap, {name}, step {step + 1}", rows["force_y_press"][step], force * time, 1e-8)
        # what the die does to the block and to its penalties, from 0 to F: the way over the gap is no work on the part
        if name != "oblique":
            close(checks, f"work over a gap, {name}", summary(checks.path(name))["energy"]["work_of_dies"], force*sunk/2, 1e-6)
            checks.that(not summary(checks.path(name))["warnings"], f"work over a gap, {name}: no warning", summary(checks.path(name))["warnings"])
        if name == "far":
            checks.that(not any(rows["displacement_x_press"]), "nothing moves it along X", rows["displacement_x_press"])
    checked = run([checks.path("gap.lag"), "--check"])
    checks.that("gap 1 at the start, which its FORCE closes" in checked.stdout and "WARNING" not in checked.stdout,
                "a gap that a force closes, before the run", said(checked))

    # off and on again, twice; in the second pause the die has no force for some steps
    rows = run_deck(checks, "paused", cards=f"FORCE  press Y -{force} load",
                    replaced={"0. 0.   1. 1.": "0. 0.   0.2 1.   0.4 0.   0.5 1.   0.6 0.   0.9 0.   1. 1."})
    close(checks, "depth after two pauses", -rows["displacement_y_press"][-1], sunk, 1e-7)
    paused = [k for k, time in enumerate(rows["time"]) if 0.6 < time < 0.9]
    checks.that(len(paused) > 1 and not any(rows["force_y_press"][k] for k in paused), "no force in the pause", paused)
    checks.that(len({rows["displacement_y_press"][k] for k in paused}) == 1, "it rests in the pause", paused)


def stops(checks):
    """A fixed body beside the part limits the way of a die under a force, and in an operation a die that begins far off comes to the
    part."""
    stop = "BLOCK  stop PL8LS 4 hard\n   20. 0.   22. 0.   22. 4.8   20. 4.8\n   1 1.   1 1.\nLAW    hard ELA\n   1.E6 0.\nFIXED  stop 1 XY\n"
    alone = run_deck(checks, "unstopped", kinematics="LOG", law=PLASTIC, cards="FORCE  press Y -200. load")
    rows = run_deck(checks, "stopped", kinematics="LOG", law=PLASTIC, cards=stop + "CNT2D  stop 3 press skin\nFORCE  press Y -200. load")
    close(checks, "force that block and stop share", rows["force_y_press"][-1], 200.0, 1e-8)
    checks.that(alone["displacement_y_press"][-1] < -0.5 and abs(rows["displacement_y_press"][-1] + 0.2) < 2e-3, "a stop bears the rest",
                (alone["displacement_y_press"][-1], rows["displacement_y_press"][-1]))

    # the same die begins again at its first place, half a unit off
    deck = deck_of(checks, "again", kinematics="LOG", law=PLASTIC, cards="")
    with open(deck, encoding="utf-8") as file:
        text = file.read().replace("END\n", "")
    die, load = text[text.index("DIE"):text.index("FIXED")], text[text.index("LIC"):text.index("STRAT")]
    text = text.replace(die, "").replace(load, "")
    write(deck, f"{text}OPERA  first\n{die}{load}MOVE   press Y load -0.5\nOPERA  second\n{die}{load}FORCE  press Y -200. load\nEND\n")
    result = run([deck, "--out", checks.path("again")])
    if checks.that(result.returncode == DONE, "a second operation under a force", said(result)):
        rows = history(checks.path("again"))
        close(checks, "depth in a second operation", rows["displacement_y_press"][-1], alone["displacement_y_press"][-1], 5e-3)


def across(checks):
    """A die presses a block flat, and is pulled across it by less than friction bears: it slides with the block that spreads, and
    some point of it sticks, another one as the block gets wider. Without friction nothing says where it is, and no force is on it."""
    tall = {"0. 0.   10. 0.   10. 5.   0. 5.": "0. 0.   10. 0.   10. 15.   0. 15.", "8 1.   4 1.": "8 1.   6 1.",
            "SEGM  40. 5.   -20. 5.": "SEGM  40. 15.   -1. 15."}
    between = "FIXED  block 4 X\nDIE    anvil\n   SEGM  -1. 0.   40. 0.\nCNT2D  block 1 2 anvil skin"
    steel = "EPLA\n   200000. 0.3\n   SWIFT 700. 0.01 0.2"
    for name, force, coefficient in (("across", 100.0, 0.1), ("smooth", 0.0, 0.0)):
        rows = run_deck(checks, name, kinematics="LOG", law=steel, skin=f"PENETR 1.E-3 PHI {coefficient}", fixed=between, replaced=tall,
                        pilot="5. 15.", cards="MOVE   press Y load -5.\n" + (f"FORCE  press X -{force} load" if force else "FREE   press X"))
        for step, time in enumerate(rows["time"]):
            close(checks, f"force {name}, step {step + 1}", rows["force_x_press"][step], force * time, 1e-6)
        way = rows["displacement_x_press"][-1]
        checks.that(way > 1.0 or not force, f"way {name}", way)
        checks.that(len(rows["time"]) < 150, f"number of steps {name}", len(rows["time"]))


def lost(checks):
    """A free die that nothing holds cannot be solved for: the run says which, when, and what to do; and of friction by M alone, what
    bounds it."""
    pulled = "FORCE  press Y 1. load"
    for name, skin, word, told in (("lost", SMOOTH, "SPRNG", True), ("by_factor", "PENETR 1.E-3 M 0.3", "PHI 1 beside M", True),
                                   ("by_both", "PENETR 1.E-3 M 0.3 PHI 1.", "PHI 1 beside M", False)):
        result = fail_deck(checks, name, kinematics="SMALL", law="EPLA\n   1000. 0.3\n   LINEAR 10. 0.", skin=skin, pilot="5. 6.",
                           cards=pulled, replaced={"SEGM  40. 5.   -20. 5.": "SEGM  40. 6.   -20. 6."})
        checks.that((word in result.stderr) == told, f"a die that touches nothing is reported, {skin}", said(result))

    result = fail_deck(checks, "let_go", cards="FORCE  press Y -20. load", replaced={"0. 0.   1. 1.": "0. 0.   0.5 1.   1. -1."})
    checks.that("die press is free along Y, and at time 0.7" in result.stderr and "block.3/press, the side at node" in result.stderr
                and "SPRNG" in result.stderr and "limit load" not in result.stderr, "a force that pulls a die off", said(result))

    result = fail_deck(checks, "slides", skin="PENETR 1.E-3 PHI 0.1", fixed="FIXED  block 1 XY",
                       cards="FORCE  press Y -20. load\nFORCE  press X 3. load")
    checks.that("die press is free along X, and nothing resists it there: what touches it slides" in result.stderr,
                "a force that friction cannot bear", said(result))

    # 11.5 on each unit of length: 2/sqrt(3) of the yield stress
    result = fail_deck(checks, "limit", law="EPLA\n   1000. 0.3\n   LINEAR 10. 0.", cards="FORCE  press Y -130. load")
    words = re.search(r"die press under FORCE goes (\S+) times as far for a little more force as it did for all of it, (\S+),",
                      result.stderr)
    checks.that(words and "MOVE in place of FORCE leads beyond it" in result.stderr, "a limit load is told", said(result))
    if words:
        checks.that(abs(float(words[2])/(20/math.sqrt(3)*10) - 1) < 0.01, "the limit load", words[2])

    result = fail_deck(checks, "sudden", kinematics="LOG", law="EPLA\n   1000. 0.3\n   LINEAR 10. 5.", cards="FORCE  press Y -200. load",
                       replaced={"0. 0.   1. 1.": "0. 1.   1. 1."})
    checks.that("the FORCE on die press acts at once, with 200 in the first step" in result.stderr, "a force at once", said(result))


def floating(checks):
    """Two dies under forces, and a part between them that nothing else holds, are anywhere: told before the run."""
    both = "FORCE  press Y -20. load\nDIE    anvil\n   SEGM  -20. 0.   40. 0.\nCNT2D  block 1 anvil skin\nFORCE  anvil Y 20. load"
    for name, more, told in (("floating", "", True), ("tied", "\nSPRNG  anvil Y 1.", False)):
        deck = deck_of(checks, name, fixed="FIXED  block 4 X", cards=both + more)
        checked = run([deck, "--check"])
        checks.that(("block: nothing says where it is along Y" in checked.stdout) == told, f"dies and part float, {name}", said(checked))


def main():
    checks = Checks()
    for part in (compression, springs, balance, friction_factor, cohesion, gaps, stops, across, lost, floating):
        part(checks)
    checks.end()


if __name__ == "__main__":
    main()
