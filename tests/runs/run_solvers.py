#!/usr/bin/env python3
"""Every linear solver carries a run: shipped decks with SOLVR against the default, what is reported of the choice, threads, resume.

usage: run_solvers.py [-v] [-k]       -v prints every check and the differences, -k keeps the results

A deck takes the same steps and its history agrees to 1e-8 of the largest number of each column: solutions of the linear systems differ
in round-off alone, and Newton's method ends within its norms, which are a ten thousandth of the defaults here. With norms of a hundredth it
takes as many iterations, but for one. A part that slides on a die adds up the round-off of its places over the depth, which pressures
follow, in every step.
"""
import os
import re
import signal
import sys

sys.dont_write_bytecode = True
from support import (DONE, SIGNAL, SOURCE, Checks, add_cards, deck_text, history, mesh, read_bytes, result_differences, run, said,  # noqa: E402
                     start, stop_after, summary, with_h5py, write)

AGREE = 1.0e-8
# Decks whose part slides all the way.
SLIDES = ("press fit",)
# Norms with which iterations are counted, and with which histories are compared: points at the limit of friction multiply what Newton's
# method leaves.
COUNTED, COMPARED = "NORMS  FORCE 1.E-8 DISPL 1.E-7", "NORMS  FORCE 1.E-10 DISPL 1.E-9"
OTHERS = ("MUMPS",)
# Matrices that are large enough for single precision; contact begins within a few steps of the largest length.
LARGE = mesh(26, 38) + ["-p", "travel=2"]
DECKS = {"upsetting": ("upsetting/upsetting.lag", mesh(4, 6)), "press fit": ("press_fit/press_fit.lag", []),
         "thick cylinder": ("thick_cylinder/thick_cylinder.lag", []), "cook": ("cook/cook.lag", []), "hertz": ("hertz/hertz.lag", [])}


def difference(one, two, allowed):
    """The largest difference of two histories, relative to the largest number of its column, and the column.

    A point at the limit of friction sticks or slips by round-off, at the same stress: both together are compared, and a run may take
    one iteration more for it. Depths in dies are compared to what is allowed: they are differences of places.
    """
    worst = (0.0, "")
    one, two = (dict(each, points_sticking=[sum(both) for both in zip(each["points_sticking"], each["points_slipping"])],
                     points_slipping=[], iterations=[]) for each in (one, two))
    for name, column in one.items():
        size = max((abs(value) for value in column), default=0.0)
        if name == "max_penetration":
            size = max(size, allowed)
        for a, b in zip(column, two[name]):
            if abs(a - b) > 0:
                worst = max(worst, (abs(a - b) / max(size, abs(b)), name))
    return worst


def run_both(checks, name, deck, options, solver, norms, default):
    """Folders of one deck with the default, which is `default` for its matrices, and with another solver; none where a run fails."""
    text = deck_text(os.path.join(SOURCE, "decks", deck))
    folders = []
    for label, cards in (("default", norms), (solver, f"{norms}\nSOLVR  {solver}")):
        path = write(checks.path(name.replace(" ", "_"), label, "deck.lag"), add_cards(text, cards))
        folders.append(os.path.join(os.path.dirname(path), f"out{norms.split()[2]}"))
        result = run([path, "--threads", "1", "--quiet", "--out", folders[-1]] + options)
        if not checks.that(result.returncode == DONE, f"{name}, {label}: runs", said(result)):
            return []
    reported = [summary(folder)["linear_solver"] for folder in folders]
    checks.that(reported == [default, solver], f"{name}, {solver}: summary.json states the solver", reported)
    # lengths of steps follow strains, and have their round-off
    steps = [len(history(folder)["time"]) for folder in folders]
    return folders if checks.that(steps[0] == steps[1], f"{name}, {solver}: the same steps", steps) else []


def largest_coordinate(folder):
    """Of the nodes, at any saved instant."""
    import h5py  # pylint: disable=import-outside-toplevel

    with h5py.File(os.path.join(folder, "deck.g01.h5"), "r") as file:
        return max(float(abs(step["coordinates"][()]).max()) for step in file["steps"].values())


def compare(checks, name, deck, options, solver, default="FRONT"):
    """One deck with the default and with another solver: iterations, and the history."""
    counted = run_both(checks, name, deck, options, solver, COUNTED, default)
    if counted:
        iterations = [sum(history(folder)["iterations"]) for folder in counted]
        checks.that(abs(iterations[0] - iterations[1]) <= 1, f"{name}, {solver}: the same number of iterations", iterations)
    compared = run_both(checks, name, deck, options, solver, COMPARED, default)
    if compared:
        depths = summary(compared[0])["checks"]
        share = depths.get("max_penetration_over_allowed", 0.0)
        one, two = (history(folder) for folder in compared)
        worst = difference(one, two, depths["max_penetration"]/share if share > 0 else 0.0)
        floor = sys.float_info.epsilon*largest_coordinate(compared[0])/depths["max_penetration"]*len(one["time"]) if name in SLIDES else 0.0
        checks.that(worst[0] <= max(AGREE, floor), f"{name}, {solver}: the same history", (*worst, floor))
        if checks.verbose:
            print(f"       {len(one['time'])} steps, largest difference {worst[0]:.1e} {worst[1]}")


def check_choice(checks):
    """--check and the listing state the solver and what its factors cost."""
    for solver in ("MIXED", "FRONT") + OTHERS:
        deck = write(checks.path("reported", f"{solver}.lag"), add_cards(deck_text(), f"SOLVR  {solver}"))
        result = run([deck, "--check"])
        checks.that(result.returncode == DONE and re.search(rf"(?m)^solver +{solver} +\S", result.stdout), f"{solver}: --check states it",
                    said(result))
        cost = re.search(r"(?m)^Factors: (\S+) entries, (\S+) operations", result.stdout)
        checks.that(cost and float(cost[1]) > 1000 and float(cost[2]) > 1000, f"{solver}: --check states the cost", result.stdout[-300:])


def check_threads_and_resume(checks, solver, options=()):
    """The same bits with two threads, and after a stop."""
    deck = write(checks.path(solver, "deck.lag"), add_cards(deck_text(), f"SOLVR  {solver}"))
    whole, two, parts = (checks.path(solver, name) for name in ("whole", "two", "parts"))
    for threads, out in (("1", whole), ("2", two)):
        result = run([deck, "--threads", threads, "--quiet", "--out", out, *options])
        checks.that(result.returncode == DONE, f"{solver}, {threads} threads: runs", said(result))
    checks.that(read_bytes(os.path.join(whole, "history.csv")) == read_bytes(os.path.join(two, "history.csv")),
                f"{solver}: the same history with two threads")
    common = [deck, "--threads", "1", "--quiet", "--out", parts, *options]
    code, _, reported = stop_after(start(common), parts, 10, signal.SIGTERM)
    if checks.that(code == SIGNAL + signal.SIGTERM, f"{solver}: stops", (code, reported)):
        result = run(common + ["--resume", os.path.join(parts, "deck.ckp.h5")])
        checks.that(result.returncode == DONE, f"{solver}: resumes", said(result))
        wrong = result_differences(whole, parts)
        checks.that(not wrong, f"{solver}: stopped and resumed, the same results", wrong)


def main():
    with_h5py()
    checks = Checks()
    check_choice(checks)
    for solver in OTHERS:
        for name, (deck, options) in DECKS.items():
            compare(checks, name, deck, options, solver)
        check_threads_and_resume(checks, solver)
    compare(checks, "large billet", DECKS["upsetting"][0], LARGE, "FRONT", "MIXED")
    check_threads_and_resume(checks, "MIXED", LARGE)
    checks.end()


if __name__ == "__main__":
    main()
