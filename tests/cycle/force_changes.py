#!/usr/bin/env python3
"""Change of the largest die force from step to step, at remeshes and at ordinary steps.

usage: force_changes.py [--each] DIR...     DIR: results of lagacycle; --each prints every remesh

The force is foretold by the straight line in time through the last four steps (least squares), of the rigid die that has the
largest force then; of a die of sides, which may be the body itself, where none is rigid. At a remesh these are the last steps of the old mesh, and it is compared at the first full step on the new one: the
first that ends half a step of the old mesh or more after the remesh. An ordinary step is one on the same mesh as the four before
it, and at least half as long. Where the force before or after is below a fifth of the largest in the run it is left out. The column
`first_step_force_change` of cycle.csv is the same, with the largest in the run so far (remdata/cycle/first_step_force.f90).
"""
import csv
import math
import os
import sys

BEFORE, AFTER, FULL, LEAST = 4, 5, 0.5, 0.2


class Forces:
    """Steps of a run: times, numbers, sizes of the force on each die."""

    def __init__(self, out):
        with open(os.path.join(out, "history.csv"), newline="", encoding="utf-8") as file:
            head, *rows = list(csv.reader(file))
        names = [title.partition(" [")[0] for title in head]
        dies = [name[len("force_x_"):] for name in names if name.startswith("force_x_")]
        # a die of sides has no columns of motion
        self.dies = [die for die in dies if "displacement_x_" + die in names] or dies
        self.time = [float(row[names.index("time")]) for row in rows]
        self.step = [int(row[names.index("step")]) for row in rows]
        places = [(names.index("force_x_" + die), names.index("force_y_" + die)) for die in self.dies]
        self.force = [[math.hypot(float(row[x]), float(row[y])) for x, y in places] for row in rows]
        self.largest = max(map(max, self.force))

    def foretold(self, row, die, time):
        """By the line through the rows up to this one."""
        rows = range(row - BEFORE + 1, row + 1)
        middle = sum(self.time[k] for k in rows) / BEFORE
        mean = sum(self.force[k][die] for k in rows) / BEFORE
        slope = sum((self.time[k] - middle) * self.force[k][die] for k in rows) / sum((self.time[k] - middle) ** 2 for k in rows)
        return mean + slope * (time - middle)

    def full_length(self, row):
        """Least length of a full step after this one."""
        return FULL * (self.time[row] - self.time[row - BEFORE + 1]) / (BEFORE - 1)

    def change_of(self, row, time, force):
        """From what the steps up to `row` foretell to the forces on the dies at a time."""
        die = max(range(len(self.dies)), key=lambda k: self.force[row][k])
        return force[die] / self.foretold(row, die, time) - 1

    def change(self, row, after, largest):
        """The same to the row `after`; None where the force is low."""
        if max(self.force[row]) < LEAST * largest:
            return None
        die = max(range(len(self.dies)), key=lambda k: self.force[row][k])
        # a die that has left says nothing either
        if self.force[after][die] < LEAST * largest:
            return None
        return self.change_of(row, self.time[after], self.force[after])


def remeshes(out):
    """Generation and step of every new mesh that the run went on with, in order: the last one where several were made at a step."""
    try:
        with open(os.path.join(out, "cycle.csv"), newline="", encoding="utf-8") as file:
            rows = [row for row in csv.DictReader(file) if row["accepted"] == "y" and row["action"] != "old mesh"]
    except FileNotFoundError:
        return []
    return [(generation, step) for step, generation in {int(row["step [-]"]): int(row["generation [-]"]) for row in rows}.items()]


def changes_at_remeshes(out, so_far=False):
    """Change at the first full step of every new mesh, by its generation; what says nothing is left out."""
    run, found, first = Forces(out), {}, 0
    for generation, step in remeshes(out):
        began, first = first, step
        if step - began < BEFORE or step not in run.step or step == run.step[-1]:
            continue
        row = run.step.index(step)
        last = min(row + AFTER, len(run.step) - 1)
        full = [k for k in range(row + 1, last) if run.time[k] - run.time[row] >= run.full_length(row)]
        largest = max(map(max, run.force[:row + 1])) if so_far else run.largest
        change = run.change(row, full[0] if full else last, largest)
        if change is not None:
            found[generation] = change
    return found


def changes_at_ordinary_steps(out):
    """The same for all steps on the mesh of the four before them."""
    run, found = Forces(out), []
    starts = {step for _, step in remeshes(out)}
    for row in range(BEFORE - 1, len(run.step) - 1):
        if starts & set(run.step[row - BEFORE + 1:row + 1]) or run.time[row + 1] - run.time[row] < run.full_length(row):
            continue
        change = run.change(row, row + 1, run.largest)
        if change is not None:
            found.append(change)
    return found


def mean_size(values):
    """Of changes without their sign."""
    return sum(map(abs, values)) / len(values)


def described(values):
    """Cells of a table: how many, mean, median, share below 0, mean size, size that 95 % stay below; in percent."""
    if not values:
        return ["0"] + 5 * ["-"]
    ordered, sizes, n = sorted(values), sorted(map(abs, values)), len(values)
    median = (ordered[(n - 1) // 2] + ordered[n // 2]) / 2
    return [str(n), f"{100 * sum(values) / n:+.2f}", f"{100 * median:+.2f}", f"{100 * sum(v < 0 for v in values) / n:.0f}",
            f"{100 * mean_size(values):.2f}", f"{100 * sizes[min(n - 1, math.ceil(0.95 * n) - 1)]:.2f}"]


def main():
    folders = [word for word in sys.argv[1:] if not word.startswith("-")]
    if not folders:
        sys.exit(__doc__.strip())
    print("| run | steps | number | mean % | median % | below 0 % | mean size % | 95 % below % |")
    print("|---|---|---|---|---|---|---|---|")
    every = {"remeshes": [], "ordinary": []}
    for out in folders:
        name, made = os.path.basename(os.path.normpath(out)), changes_at_remeshes(out)
        if "--each" in sys.argv[1:]:
            for generation, change in made.items():
                print(f"| {name} | mesh {generation} | 1 | {100 * change:+.2f} | | | | |")
        for kind, values in (("remeshes", list(made.values())), ("ordinary", changes_at_ordinary_steps(out))):
            every[kind] += values
            print("| " + " | ".join([name, kind] + described(values)) + " |")
    if len(folders) > 1:
        for kind, values in every.items():
            print("| " + " | ".join(["all", kind] + described(values)) + " |")


if __name__ == "__main__":
    main()
