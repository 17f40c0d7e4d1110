"""What the tests of cycles share: calls of lagacycle, its tries, what the programs say of a mesh, forces at places and jumps."""
import csv
import glob
import json
import os
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
sys.path.insert(0, os.path.join(os.path.dirname(HERE), "runs"))
from force_changes import changes_at_ordinary_steps, changes_at_remeshes, mean_size  # noqa: E402
from support import BIN, LONGEST_RUN  # noqa: E402

CYCLE = os.path.join(os.path.abspath(BIN), "lagacycle")
ON_CONTOUR = 1e-8     # distances from the contour, of its size
NEAR_END = 1e-3       # of a node to an end of contact that is too close to it for another element
# What the restart reports with a limit, NAME_limit.
LIMITED = ("first_residual", "iterations", "force_change", "energy_change", "depth_change")


def cycle(deck, out, *options, **environment):
    """One call of lagacycle, on one thread."""
    return subprocess.run([CYCLE, deck, "--out", out, "--threads", "1", *options], text=True, stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=LONGEST_RUN, check=False,
                          env=dict(os.environ, **environment))


def tries(out):
    """Rows of cycle.csv, none where there is no such table."""
    try:
        with open(os.path.join(out, "cycle.csv"), newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))
    except FileNotFoundError:
        return []


def within_limits(checks, out):
    """What the restart on every accepted mesh found lies within the limits it states, and so do the first steps on it; the contour
    it was made of goes through all ends of contact, which are nodes of the mesh, or too close to one for another element, as remdata says."""
    for one in tries(out):
        generation = int(one["generation [-]"])
        if one["accepted"] != "y" or not one["first_residual [-]"]:
            continue
        restart, steps = facts(out, generation, "restart"), facts(out, generation, "probation")
        made = facts(out, generation, "start")
        checks.that(made["contour"]["off_ends"] < ON_CONTOUR and made["mesh"]["off_ends"] < NEAR_END, f"mesh {generation}: ends of contact",
                    (made["contour"]["off_ends"], made["mesh"]["off_ends"]))
        for name in LIMITED:
            if name not in restart and not restart["restored"]:
                continue   # found by the first step
            checks.that(restart[name] <= restart[name + "_limit"], f"mesh {generation}: {name} within its limit",
                        (restart[name], restart[name + "_limit"]))
        checks.that(restart["least_scaled_jacobian"] >= restart["least_scaled_jacobian_limit"], f"mesh {generation}: shape")
        checks.that(steps["least_step_ratio"] >= steps["least_step_ratio_limit"] > 0 and not steps["remesh_refused"],
                    f"mesh {generation}: its first steps", steps)
        reported = {"first_residual [-]": restart["first_residual"], "iterations [-]": restart["iterations"],
                "depth_change [-]": restart["depth_change"], "least_step_ratio [-]": steps["least_step_ratio"]}
        if restart["restored"]:
            reported.update({"force_change [%]": 100 * restart["force_change"], "energy_change [%]": 100 * restart["energy_change"]})
        wrong = [key for key, value in reported.items() if abs(float(one[key]) - value) > 1e-3 * abs(value)]
        checks.that(not wrong, f"mesh {generation}: cycle.csv states the same", wrong)


def forces_go_on(checks, out, times, bias, drops=False):
    """At the first full steps on new meshes the largest die force goes on as the old meshes' last steps foretell: the mean size of
    the changes is at most so many times that of ordinary steps, their mean at most `bias`. With `drops` rises count as nothing, at remeshes
    and at ordinary steps: where a cavity fills the force rises within a step by more than any line foretells. The table states the same."""
    column = {int(one["generation [-]"]): one["first_step_force_change [%]"] for one in tries(out) if one["accepted"] == "y"}
    found = changes_at_remeshes(out, so_far=True)
    wrong = {g: (change, column.get(g)) for g, change in found.items() if abs(float(column.get(g) or "nan") / 100 - change) > 1e-3 * abs(change)}
    checks.that(found and not wrong, "cycle.csv states the change of the force at the first full step on every mesh", wrong)
    at_remeshes, ordinary = list(changes_at_remeshes(out).values()), changes_at_ordinary_steps(out)
    print(f"change of the largest die force: {', '.join(f'{100 * change:+.2f}' for change in at_remeshes)} % at the first full steps on "
          f"new meshes; mean size {100 * mean_size(ordinary):.2f} % at ordinary steps")
    if drops:
        at_remeshes, ordinary = ([min(change, 0.0) for change in changes] for changes in (at_remeshes, ordinary))
    checks.that(mean_size(at_remeshes) <= times * mean_size(ordinary), f"mean size at most {times} times that of ordinary steps",
                (mean_size(at_remeshes), mean_size(ordinary)))
    mean = sum(at_remeshes) / len(at_remeshes)
    checks.that(abs(mean) < bias, f"in the mean below {bias:.1%}", f"{mean:.2%}")


def value_at(rows, name, along, wanted):
    """A column of the history where another one that ascends has a value, straight between steps."""
    k = next(k for k, u in enumerate(rows[along]) if u >= wanted - 1e-9)
    before, after = rows[along][k - 1], rows[along][k]
    return rows[name][k - 1] + (wanted - before) / (after - before) * (rows[name][k] - rows[name][k - 1])


def jump(rows, name, step):
    """Relative distance of a force after a step from the straight line before it."""
    time, force, k = rows["time"], rows[name], rows["step"].index(step)
    line = force[k] + (force[k] - force[k - 1]) / (time[k] - time[k - 1]) * (time[k + 1] - time[k])
    return force[k + 1] / line - 1


def facts(out, generation, kind):
    """What remdata (start), the restart or the first steps (probation) said of a mesh."""
    pattern = f"*.g{generation:02d}.{kind}{'.h5' if kind == 'start' else ''}.json"
    with open(glob.glob(os.path.join(out, pattern))[0], encoding="utf-8") as file:
        return json.load(file)


def put_table(readme, mark, lines):
    """Lines between two marks of a README."""
    with open(readme, encoding="utf-8") as file:
        head, _, tail = file.read().split(mark)
    with open(readme, "w", encoding="utf-8") as file:
        file.write(head + mark + "\n" + "\n".join(lines) + "\n" + mark + tail)
