#!/usr/bin/env python3
"""Whether a change of the die force at a remesh comes of the transfer or of the old mesh: each new mesh is made again in other ways.

usage: remesh_force.py DECK DIR [--steps N] [MESH...]     DIR: results of lagacycle with that deck; MESH: generations, default all
       remesh_force.py --same-sizes DIR...                  deck and parameters are those that the summary names

From where the old mesh stopped the new one is made as the deck says, with elements 1.6 times smaller, and by every method of
transfer, and the solver goes on for N steps (default 3). Printed is the change of the largest die force at each step from the straight
line in time through the old mesh's last four steps, in percent. A change that stays on finer meshes is that of the old mesh; one
that fades over the steps is that of the stresses carried over. DIR is left as it is.

With --same-sizes every new mesh of the runs is made again with elements of the size that the old ones have in each place, and the solver
goes on to the first full step. What the force changes by then does not come of a finer or coarser mesh; printed are the statistics of
force_changes.py, for the runs as they went, for these meshes, and for ordinary steps.
"""
import glob
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(ROOT, "tests", "cycle"))
from force_changes import AFTER, BEFORE, Forces, changes_at_ordinary_steps, changes_at_remeshes, described, remeshes  # noqa: E402

BIN = os.path.abspath(os.environ.get("LAGAMINE_BIN") or os.path.join(ROOT, "build", "bin"))
WAYS = {"as the deck says": [], "1.6 times finer": ["--finer", "1.6"], "inverse distances": ["--transfer", "0"],
        "moving least squares": ["--transfer", "1"], "patches": ["--transfer", "2"]}
LONGEST, PAUSE = 300.0, 0.1     # seconds: one way at most; between looks at the table of steps


def steps_made(out, last):
    """Steps after the one of the remesh that the table holds."""
    try:
        with open(os.path.join(out, "history.csv"), encoding="utf-8") as file:
            lines = file.read().split("\n")[1:-1]
        return sum(int(line.split(",")[1]) > last for line in lines)
    except FileNotFoundError:
        return 0


def go_on(deck, checkpoint, folder, last, steps):
    """The solver on a new mesh, stopped by a signal when it has made its steps."""
    solver = subprocess.Popen([os.path.join(BIN, "lagamine"), *deck, "--out", folder, "--quiet", "--threads", "1", "--resume", checkpoint],
                              stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    begun = time.monotonic()
    while solver.poll() is None and steps_made(folder, last) < steps and time.monotonic() - begun < LONGEST:
        time.sleep(PAUSE)
    if solver.poll() is None:
        solver.terminate()
    return solver.communicate()[1].strip().split("\n")[0]


def deck_of(out):
    """Deck of a run and its parameters, as words of a command."""
    with open(os.path.join(out, "summary.json"), encoding="utf-8") as file:
        told = json.load(file)
    return [told["deck"]] + [word for item in told["parameters"].items() for word in ("-p", "=".join(item))]


def one_way(deck, out, generation, last, words, steps, chosen=None):
    """Elements of the mesh, and the changes or what is `chosen` of them; or None and why there is no such mesh or step. Without a
    deck that of the run's summary."""
    with tempfile.TemporaryDirectory(prefix="lagamine-force-") as folder:
        old, = glob.glob(os.path.join(out, f"*.g{generation - 1:02d}.end.h5"))
        name = os.path.basename(old)[:-len(f".g{generation - 1:02d}.end.h5")]
        new = os.path.join(folder, f"{name}.g{generation:02d}.start.h5")
        made = subprocess.run([os.path.join(BIN, "remdata"), old, "--out", new, "--quiet", *words], stdout=subprocess.DEVNULL,
                              stderr=subprocess.PIPE, text=True, check=False)
        if made.returncode != 0:
            return None, made.stderr.strip().split("\n")[0]
        deck = [deck] if deck else deck_of(out)
        shutil.copy(os.path.join(out, "history.csv"), folder)
        cut = Forces(folder)
        keep_up_to(folder, last)
        said = go_on(deck, new, folder, last, steps)
        run = Forces(folder)
        row = cut.step.index(last)
        changes = [cut.change_of(row, time_now, force) for time_now, force, step in zip(run.time, run.force, run.step) if step > last]
        with open(new + ".json", encoding="utf-8") as file:
            elements = json.load(file)["new_elements"]
        if not changes:
            return elements, said
        return elements, chosen(run, row, changes[:steps]) if chosen else changes[:steps]


def keep_up_to(folder, last):
    """Drop the rows of later steps."""
    path = os.path.join(folder, "history.csv")
    with open(path, encoding="utf-8") as file:
        head, *rows = file.read().split("\n")
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n".join([head] + [row for row in rows if row and int(row.split(",")[1]) <= last]) + "\n")


def first_full_step(run, row, changes):
    """The change at the first full step after a row, of those at the steps after it."""
    for k, change in enumerate(changes):
        if run.time[row + 1 + k] - run.time[row] >= run.full_length(row):
            return change
    return changes[-1]


def same_sizes(folders):
    """Statistics over all new meshes of the runs, made again with the sizes of the old elements."""
    went, same, ordinary = [], [], []
    for out in folders:
        found = changes_at_remeshes(out)
        ordinary += changes_at_ordinary_steps(out)
        lasts = dict(remeshes(out))
        for generation, change in found.items():
            _, again = one_way(None, out, generation, lasts[generation], ["--same-sizes"], AFTER, first_full_step)
            print(f"| {os.path.basename(os.path.normpath(out))} | mesh {generation} | {100 * change:+.2f} | "
                  + (again if isinstance(again, str) else f"{100 * again:+.2f}") + " |", flush=True)
            if not isinstance(again, str):
                went.append(change)
                same.append(again)
    print("| | number | mean % | median % | below 0 % | mean size % | 95 % below % |\n|---|---|---|---|---|---|---|")
    for words, values in (("as the runs went", went), ("elements of the old sizes", same), ("ordinary steps", ordinary)):
        print("| " + " | ".join([words] + described(values)) + " |")


def main():
    words = sys.argv[1:]
    if words[:1] == ["--same-sizes"] and words[1:]:
        same_sizes(words[1:])
        return
    steps = int(words.pop(words.index("--steps") + 1)) if "--steps" in words else 3
    words = [word for word in words if word != "--steps"]
    if len(words) < 2:
        sys.exit(__doc__.strip())
    deck, out, wanted = words[0], words[1], [int(word) for word in words[2:]]
    print("| mesh | made | elements | change of the force at steps 1, 2 ... % |\n|---|---|---|---|")
    first = 0
    for generation, last in remeshes(out):
        began, first = first, last
        if last - began < BEFORE or (wanted and generation not in wanted):
            continue
        for way, options in WAYS.items():
            elements, found = one_way(deck, out, generation, last, options, steps)
            shown = found if isinstance(found, str) else ", ".join(f"{100 * change:+.2f}" for change in found)
            print(f"| {generation} | {way} | {elements or '-'} | {shown} |", flush=True)


if __name__ == "__main__":
    main()
