#!/usr/bin/env python3
"""ACCURACY of decks with new meshes: pilots are cycles, the accuracy drives the sizes of all meshes, and a stop changes nothing.

usage: run_accuracy_remesh.py [-v] [-k]

The billet, coarse and pressed a little way, with a new mesh half-way; the can, whose meshes are those of its contour.
"""
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "patch"))
from patch_support import BIN, SOURCE, Checks, Run, np  # noqa: E402

LAGAMINE, LAGACYCLE = (os.path.join(os.path.abspath(BIN), name) for name in ("lagamine", "lagacycle"))
DONE, REFUSED, NO_CONVERGENCE, PILOT_DUE, TERMINATED = 0, 2, 3, 7, 128 + signal.SIGTERM
WITHIN = 2.0
# Elements of new meshes are squares of the wanted sizes only about.
FINER = 1.6
LONGEST = 60


def deck(checks, name, changes, card, file="upsetting_remesh/upsetting_remesh"):
    """A shipped deck with lines exchanged (by their beginnings) and the card; its path."""
    with open(os.path.join(SOURCE, "decks", file + ".lag"), encoding="utf-8") as source:
        text = source.read()
    for old, new in changes:
        text, number = re.subn(rf"(?m)^{old}.*$", new, text)
        assert number == 1, (name, old, number)
    path = os.path.join(checks.folder, name + ".lag")
    with open(path, "w", encoding="utf-8") as target:
        target.write(text.replace("\nEND", f"\n{card}\nEND"))
    return path


SMALL = [("PARAM  nx", "PARAM  nx 4"), ("PARAM  ny", "PARAM  ny 6"), ("PARAM  travel", "PARAM  travel 3."), (r"   SIZE", "   SIZE 1.2 5."),
         (r"   ERROR 0.1", "   TIMES 0.5"), ("STRAT", "STRAT  0.05  1.E-5  0.1   5 3")]


def call(checks, program, *words, code=DONE):
    """What a program says that must end with this code."""
    done = subprocess.run([program, *words, "--threads", "1"], check=False, stdin=subprocess.DEVNULL, capture_output=True, text=True)
    checks.that(done.returncode == code, f"{' '.join(os.path.basename(word) for word in (program, *words))}: exit code {code}",
                f"{done.returncode} {done.stderr[:400]}")
    return done.stdout + done.stderr


def history(folder):
    run = Run.__new__(Run)
    run.out = folder
    return run.read_history()


def summary(folder):
    with open(os.path.join(folder, "summary.json"), encoding="utf-8") as file:
        return json.load(file)


def same(a, b):
    """The same bits of all columns but times on the wall."""
    return set(a) == set(b) and all(np.array_equal(a[q], b[q], equal_nan=True) for q in a)


def pilots(folder):
    return {name: os.stat(os.path.join(folder, name, "history.csv")).st_mtime_ns for name in sorted(os.listdir(folder)) if name.startswith("pilot_")}


def new_elements(folder, name):
    """Of the first new mesh."""
    with open(os.path.join(folder, name + ".g02.start.h5.json"), encoding="utf-8") as file:
        return json.load(file)["new_elements"]


def drives_all_meshes(checks):
    name = "billet"
    path, out = deck(checks, name, SMALL, "ACCURACY 12 % OF force_y_upper"), os.path.join(checks.folder, name)
    said = call(checks, LAGAMINE, path, "--out", os.path.join(checks.folder, "alone"), code=PILOT_DUE)
    checks.that("needs new meshes" in said and "lagacycle" in said, "the solver alone names the program that makes pilots", said)
    forecast = call(checks, LAGACYCLE, path, "--forecast", "--out", out)
    expected = re.search(r"(?m)^ +run: .*$", forecast)
    checks.that(expected and "asked of force_y_upper" in forecast and not os.path.exists(os.path.join(out, "history.csv")),
                "--forecast: pilots, no run", forecast[-400:])
    made = pilots(out)
    said = call(checks, LAGACYCLE, path, "--out", out)
    checks.that(expected and expected.group() in said and "    spent  " in said, "the run says before what was forecast, and after what it spent", said)
    checks.that(pilots(out) == made and len(made) >= 4, "pilots are not made again", list(made))
    run, told = history(out), summary(out)["accuracy"]
    asked = told["asked"]
    checks.that(asked["met"] and asked["reached"]["error_pct"] <= 12, "reached what was asked", asked)
    checks.that(1/WITHIN <= asked["spent_steps"]/asked["expected_steps"] <= WITHIN, "steps as expected", asked)
    checks.that(told["cycle"]["meshes"] == 2 and 0 < told["cycle"]["remesher_s"] < told["cycle"]["processor_s"]
                and abs(told["cycle"]["processor_s"] - asked["spent_s"]) < 1e-9, "the cost is that of both meshes and of the remesher", told)
    worst = history(out)["error_stress"].max()
    # what is left of the first mesh's error counts at the end
    worst = max(100*worst, told["space"]["stress_pct"])
    carried = told["space"]["stress_carried_pct"]
    own = history(out)["error_stress"][-1]
    checks.that(abs(told["space"]["stress_worst_pct"] - worst) < 1e-9*worst, "the largest error is that over both meshes", (told["space"], worst))
    checks.that(carried > 0 and abs(told["space"]["stress_pct"] - np.hypot(100*own, carried)) < 1e-9*worst, "the error of the first mesh that is left",
                (told["space"], own))
    coarse, fine = (new_elements(os.path.join(out, pilot), name) for pilot in ("pilot_0.5_1_1", "pilot_1_1_1"))
    checks.that(fine > FINER*coarse, "new meshes are finer too", (coarse, fine))
    # the same fineness without any pilot
    other = os.path.join(checks.folder, "by_hand")
    call(checks, LAGACYCLE, path, "--out", other, "--fineness", ",".join(repr(asked[q]) for q in ("mesh", "steps", "depth")), "--quiet")
    checks.that(same(run, history(other)) and not pilots(other), "a run of that fineness has the same bits")
    return path, run


def goes_on(checks, path, run):
    """Stopped in the middle of a pilot, and of the run: the same command goes on to the same bits."""
    out = os.path.join(checks.folder, "stopped")
    for what in ("pilot_1_1_1", "."):
        started = subprocess.Popen([LAGACYCLE, path, "--out", out, "--threads", "1", "--quiet"], stdin=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        table, begun = os.path.join(out, what, "history.csv"), time.monotonic()
        while started.poll() is None and not os.path.exists(table) and time.monotonic() - begun < LONGEST:
            time.sleep(0.005)
        started.terminate()
        checks.that(started.wait() == TERMINATED, f"stopped while {table} grows", started.returncode)
    call(checks, LAGACYCLE, path, "--out", out, "--quiet")
    checks.that(same(run, history(out)), "stopped twice: the same bits")
    # another deck in the same folder: pilots are made anew
    with open(path, encoding="utf-8") as file:
        text = file.read()
    changed = os.path.join(checks.folder, "other", os.path.basename(path))
    os.makedirs(os.path.dirname(changed))
    with open(changed, "w", encoding="utf-8") as file:
        file.write(text.replace("PARAM  travel 3.", "PARAM  travel 2.5"))
    before = pilots(out)
    call(checks, LAGACYCLE, changed, "--forecast", "--out", out)
    after = pilots(out)
    checks.that(before.keys() <= after.keys() and all(after[q] != before[q] for q in before), "pilots of another deck are not taken", (before, after))


def of_a_contour(checks):
    """A body by its contour: elements as pilots have them, not by the square of the factor; the whole run, and a truth that is finer in all."""
    path = deck(checks, "can", [("PARAM  travel", "PARAM  travel 1"), ("REMSH", "REMSH\n   SIZE 1.2 4.")], "ACCURACY 3 % OF force_y_punch", file="can/can")
    out, finest = os.path.join(checks.folder, "can"), os.path.join(checks.folder, "can_finest")
    forecast = call(checks, LAGACYCLE, path, "--forecast", "--out", out)
    call(checks, LAGACYCLE, path, "--out", out, "--quiet")
    call(checks, LAGACYCLE, path, "--out", finest, "--fineness", "4,0.25,0.25", "--quiet")
    told = summary(out)
    asked = told["accuracy"]["asked"]
    line = r"(?m)^ +{}: +elements along a line x (\S+), steps x 1, penetration x 1: (?:about )?(\d+) elements"
    pilots, expected = re.findall(line.format("pilot"), forecast), re.search(line.format("run"), forecast)
    if checks.that(len(pilots) == 2 and expected, "a contour: elements of pilots and run", forecast):
        coarse, fine = (int(elements) for _, elements in pilots)
        factor, elements = float(expected.group(1)), int(expected.group(2))
        checks.that(elements == round(coarse*(fine/coarse)**np.log2(factor)), "a contour: elements as those of the pilots grow", (forecast, elements))
        # a mesh of so few elements grows by whole rows
        checks.that(1/1.5 <= elements/new_elements(out, "can") <= 1.5, "a contour: elements as forecast", (elements, told["elements"]))
    checks.that(asked["met"] and 1/WITHIN <= asked["spent_steps"]/asked["expected_steps"] <= WITHIN, "a contour: met, steps as expected", asked)
    force, true = (history(folder)["force_y_punch"] for folder in (out, finest))
    checks.that(abs(force[-1] - true[-1]) <= 0.03*np.ptp(true), "a contour: true error below what was asked", (force[-1], true[-1]))


def pilot_that_fails(checks, path):
    """A pilot that does not reach its end is not made again and again: the run is made, and a warning names it."""
    solver = os.path.join(checks.folder, "failing")
    with open(solver, "w", encoding="utf-8") as file:
        file.write(f'#!/bin/sh\ncase "$*" in *"--fineness 0.5,0.5,1.0"*) echo no convergence >&2; exit 3 ;; esac\nexec "{LAGAMINE}" "$@"\n')
    os.chmod(solver, 0o755)
    out = os.path.join(checks.folder, "fails")
    for _ in range(2):
        done = subprocess.run([LAGACYCLE, path, "--forecast", "--out", out, "--threads", "1"], check=False, stdin=subprocess.DEVNULL,
                              capture_output=True, text=True, env=dict(os.environ, LAGAMINE=solver))
        checks.that(done.returncode == DONE and "the pilot with elements along a line x 0.5, steps x 0.5, penetration x 1 did not reach its end" in done.stdout
                    and "errors in time are not known" in done.stdout, "a pilot that fails is named", (done.returncode, done.stderr[:300], done.stdout[-600:]))


def main():
    checks = Checks()
    path, run = drives_all_meshes(checks)
    goes_on(checks, path, run)
    pilot_that_fails(checks, path)
    of_a_contour(checks)
    for numbers in ("1,0", "1,,1", "1,2,3,4", "1,-1,1"):
        said = call(checks, LAGAMINE, path, "--fineness", numbers, code=REFUSED)
        checks.that(said.startswith("--fineness: expected three numbers"), f"--fineness {numbers}", said)
    checks.end()


if __name__ == "__main__":
    main()
