#!/usr/bin/env python3
"""Meshes that went wrong are refused, with the stage that did it: a remesher whose checkpoints are sound but for one fault each.

usage: run_acceptance.py [-v] [-k]       -v prints every check, -k keeps the results

The faults are made in the checkpoint of the first try, with a hash that is right. Tries after it are sound: the cycle ends,
killed on its way or not. And a first mesh of contours that is made again, sound or not.
"""
import math
import os
import random
import shutil
import subprocess
import sys

sys.dont_write_bytecode = True
from remeshed import cycle, facts, tries, within_limits  # noqa: E402
from support import (BIN, DONE, NO_CONVERGENCE, UPSETTING, Checks, add_cards, deck_text, history, run, said,  # noqa: E402
                     summary, with_h5py, write)

with_h5py()
from run_cycle import kills  # noqa: E402
from sealed import alter, columns_of  # noqa: E402

CAN = os.path.join(os.path.dirname(os.path.dirname(UPSETTING)), "can", "can.lag")
KILLS = 2
REMESH_DUE = 4
REMDATA = os.path.join(os.path.abspath(BIN), "remdata")
# The remesher with a fault in one mesh it makes, the first unless it is named; as ever, that mesh is there as a whole or not.
FAULTY = """#!{python}
import os, subprocess, sys
sys.dont_write_bytecode = True
words = list(sys.argv[1:])
place = words.index("--out") + 1 if "--out" in words else 0
if not (place and words[place].endswith(os.environ.get("FAULT_IN", ".g02.try1.h5"))):
    os.execv(os.environ["REAL"], [os.environ["REAL"]] + words)
sys.path[:] = {places!r}
import run_acceptance
whole, words[place] = words[place], words[place] + str(os.getpid()) + ".tmp"
code = subprocess.call([os.environ["REAL"]] + words)
if code == 0:
    run_acceptance.alter(words[place], run_acceptance.FAULTS[os.environ["FAULT"]][0])
    os.rename(words[place], whole)
    os.rename(words[place] + ".json", whole + ".json")
sys.exit(code)
"""


def scale_state(file, group, names, factor):
    state = file[f"groups/{group}/state"]
    values = state[()]
    for name in names:
        values[:, :, columns_of(file, group, name)] *= factor
    state[...] = values


def half_the_stress(file):
    """The law goes on from the elastic strain, the energy is that of both."""
    scale_state(file, 1, ("stress", "elastic_strain"), 0.5)


def no_pressure(file):
    for group in (2, 3):
        scale_state(file, group, ("pressure",), 0.0)


def die_off(way):
    """The die stands away from where the contour was fitted to it."""
    def fault(file):
        upper = next(int(k) - 1 for k, die in file["dies"].items() if die.attrs["name"] == b"upper")
        file["fields/pilot/value"][upper, 1] += way
    return fault


def flat_corner(file):
    """A corner inside the part is moved nearly onto the diagonal of an element; its sides stay straight."""
    elements, x = file["groups/1/connectivity"][()] - 1, file["mesh/coordinates"][()]
    count = {}
    for element in elements:
        for node in element[:4]:
            count[node] = count.get(node, 0) + 1
    inner = min(node for node, n in count.items() if n == 4)
    element = next(element for element in elements if inner in element[:4])
    opposite = element[(list(element[:4]).index(inner) + 2) % 4]
    x[inner] += 0.47 * (x[opposite] - x[inner])
    for element in elements:
        for k in range(4):
            first, last = element[k], element[(k + 1) % 4]
            if inner in (first, last):
                x[element[4 + k]] = 0.5 * (x[first] + x[last])
    file["mesh/coordinates"][...] = x


def not_a_number(file):
    file["groups/1/state"][0, 0, 0] = float("nan")


def tiny_steps(file):
    """As of a mesh that converges in very short steps only."""
    progress = file["progress"].attrs
    progress["next_step"] = 1e-3 * progress["next_step"]


def no_strength(file):
    """A plastic strain at which the hardening of the card leaves no strength: elastic equilibrium is found, no step."""
    state = file["groups/1/state"]
    values = state[()]
    values[:, :, columns_of(file, 1, "plastic_strain")] = -3.0
    state[...] = values


# The fault, the responsible stage, and what the row must state.
FAULTS = {
    "stress": (half_the_stress, "transfer", "the force of a die changes"),
    "pressure": (no_pressure, "contact", "the pressures carried over miss"),
    "die away": (die_off(0.1), "contour", "sides lie"),
    "corner": (flat_corner, "mesh", "scaled Jacobian"),
    "nan": (not_a_number, "checkpoint", "not finite"),
    "steps": (tiny_steps, "transfer", "its steps fall to"),
    "strength": (no_strength, "transfer or contact", "its steps fall to"),   # what is left is at the dies, whose forces find no answer
    "none": (lambda file: None, "", ""),
}


ON_PROBATION = ("steps", "strength")


def environment(checks, fault):
    script = write(checks.path("bin", "remdata"), FAULTY.format(python=sys.executable, places=sys.path))
    os.chmod(script, 0o755)
    return {"REMDATA": script, "REAL": REMDATA, "FAULT": fault}


def refused_with_stage(checks, deck, fault, stage, phrase):
    out = checks.path("fault", fault.replace(" ", "-"))
    result = cycle(deck, out, **environment(checks, fault))
    if not checks.that(result.returncode == DONE, f"{fault}: the cycle ends with another try", said(result)):
        return
    rows = tries(out)
    first = rows[0]
    checks.that(first["accepted"] == "n" and first["stage"] in stage.split(" or ") and phrase in first["reason"],
                f"{fault}: refused, stage {stage}", (first["result"], first["stage"], first["reason"]))
    checks.that(all(row["accepted"] == "y" for row in rows[1:]) and rows[1]["generation [-]"] == "2",
                f"{fault}: the next try is taken", [(row["action"], row["accepted"]) for row in rows])
    within_limits(checks, out)
    steps = history(out)["step"]
    checks.that(steps == list(range(1, len(steps) + 1)), f"{fault}: one row of the history a step", steps)
    left = [name for name in os.listdir(out) if ".try" in name or ".tmp" in name]
    checks.that(not left, f"{fault}: nothing is left of the try", left)
    if fault in ON_PROBATION:
        checks.that("on probation" in first["result"] and 0 < float(first["least_step_ratio [-]"]) < 0.05
                    and float(first["first_residual [-]"]) > 0, f"{fault}: on probation, with its numbers", first)


def sound(checks, deck):
    """The same remesher without a fault: nothing is refused, so that what is refused above is so by its fault."""
    out = checks.path("sound")
    result = cycle(deck, out, **environment(checks, "none"))
    checks.that(result.returncode == DONE and [row["accepted"] for row in tries(out)] == ["y", "y"], "without a fault: taken",
                said(result))
    within_limits(checks, out)
    reported = facts(out, 2, "restart")
    die = reported["forces"][0]
    change = math.dist(die["after"], die["before"]) / math.hypot(*die["before"])
    checks.that(die["die"] == "upper" and abs(change - reported["force_change"]) < 1e-9, "the change is that of the die's force", die)


def number_of_tries(checks, text):
    """REMSH TRIES, and --tries in its place."""
    strict = text.replace("   TIMES 0.1 0.25", "   TIMES 0.1 0.25\n   TRIES 1\n   ACCEPT FORCE 1.E-9")
    deck = write(checks.path("few", "case.lag"), strict)
    for options, number in (((), 2), (("--tries", "0"), 1), (("--tries", "2"), 3)):
        out = checks.path("few", "out")
        shutil.rmtree(out, ignore_errors=True)
        result = cycle(deck, out, *options)
        checks.that(result.returncode == NO_CONVERGENCE and len(tries(out)) == number,
                    f"TRIES 1 {' '.join(options)}: {number} made", said(result))


def softer(wrong, *more, left=0.7):
    """This share of the stress is left, and the old mesh is said to have had this error of the stress; further faults."""
    def fault(file):
        scale_state(file, 1, ("stress", "elastic_strain"), left)
        file["estimate"].attrs["previous_stress"] = wrong
        for one in more:
            one(file)
    return fault


def agreed(checks, text):
    """`--agreed`: a mesh that the force of a die alone refuses is taken up, with a warning, where the stress of the old mesh was as
    wrong; not where the pressures speak against it too, where the deck gives the limit of the force, or beyond half of the force."""
    force = "the force of a die changes"
    for name, card, fault, options, phrase in (
            ("agreed", "", softer(0.5), ("--agreed",), ""), ("not asked for", "", softer(0.5), (), force),
            ("a good old mesh", "", softer(0.1), ("--agreed",), force),
            ("no pressure", "", softer(0.5, no_pressure), ("--agreed",), "the pressures carried over miss"),
            ("more than half", "", softer(0.9, left=0.4), ("--agreed",), "where new meshes agree, at most 50 %"),
            ("limit of the deck", "\n   ACCEPT FORCE 0.1", softer(0.5), ("--agreed",), force)):
        folder = checks.path("agreed", name.replace(" ", "-"))
        deck = write(os.path.join(folder, "case.lag"), text.replace("   TIMES 0.1 0.25", "   TIMES 0.1 0.25" + card))
        new = os.path.join(folder, "new.h5")
        checks.that(run([deck, "--out", folder, "--threads", "1"]).returncode == REMESH_DUE
                    and subprocess.run([REMDATA, os.path.join(folder, "case.ckp.h5"), "--out", new, "--quiet"], check=False).returncode == DONE,
                    f"--agreed, {name}: a new mesh")
        alter(new, fault)
        result = run([deck, "--resume", new, "--out", folder, "--threads", "1", *options])
        checks.that(result.returncode == (NO_CONVERGENCE if phrase else REMESH_DUE) and phrase in result.stderr, f"--agreed, {name}", said(result))
        warned = [warning["text"] for warning in summary(folder)["warnings"] if "several new ones agree" in warning["text"]]
        checks.that(len(warned) == (not phrase), f"--agreed, {name}: the warning", warned)


def first_mesh_again(checks):
    """A first mesh that errs is made again and the scene begins anew; where that fails, the first one is taken up again, and the ways go on."""
    deck = write(checks.path("again", "case.lag"), add_cards(deck_text(CAN), "STOP 0.1"))
    for name, fault, expected in (("made again", "none", [("as the deck says", "y"), ("first mesh again", "y")]),
                                  ("fails", "nan", [("as the deck says", "y"), ("first mesh again", "n"), ("as the deck says", "y")])):
        out = checks.path("again", name.replace(" ", "-"))
        result = cycle(deck, out, **environment(checks, fault), FAULT_IN=".g03.try1.h5")
        checks.that(result.returncode == DONE, f"first mesh, {name}: the cycle ends", said(result))
        rows = tries(out)
        checks.that([(row["action"], row["accepted"]) for row in rows[:len(expected)]] == expected, f"first mesh, {name}: the tries",
                    [(row["action"], row["accepted"], row["reason"]) for row in rows])
        again = next(row for row in rows if row["action"] == "first mesh again")
        checks.that(again["generation [-]"] == "3" and again["step [-]"] == "0" and int(again["stop_step [-]"]) > 0
                    and "stress_error" in again["trigger"], f"first mesh, {name}: from the start", again)
        steps = history(out)["step"]
        checks.that(steps == list(range(1, len(steps) + 1)), f"first mesh, {name}: one row of the history a step", steps)
        checks.that(os.path.exists(os.path.join(out, "case.g02.h5")) == (fault != "none"), f"first mesh, {name}: results are of the run that goes on")


def main():
    checks = Checks()
    text = add_cards(deck_text(UPSETTING).replace("SAVE   20", "SAVE   3").replace("travel 9", "travel 4"),
                     "CKPT 2\nSTOP 0.35\nREMSH\n   TIMES 0.1 0.25").replace("nx 12", "nx 3").replace("ny 18", "ny 4")
    deck = write(checks.path("case.lag"), text)
    sound(checks, deck)
    for fault, (_, stage, phrase) in FAULTS.items():
        if stage:
            refused_with_stage(checks, deck, fault, stage, phrase)
    kills(checks, random.Random(1), deck, checks.path("fault", "strength"), KILLS, 2.0, **environment(checks, "strength"))
    number_of_tries(checks, text)
    agreed(checks, text)
    first_mesh_again(checks)
    checks.end()


if __name__ == "__main__":
    main()
