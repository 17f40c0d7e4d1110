#!/usr/bin/env python3
"""What remeshing saves in the scenes with REMSH alone: seconds at equal error of the force, over those of meshes that are uniform and never replaced.

usage: scenes_study.py [NAME... | all] [--ladder F,F,...]      all: an hour or more on an idle machine, by hand; without names: side_pressing, short

Each scene is run as it is, and on first meshes of squares of one size, F times the largest size of the deck's own (default 1, 0.67, 0.44, 0.3). The error is the
root mean square of the difference of the force from that of the finest uniform mesh which comes to the end, at 40 instants of its last four fifths, over
its largest; it cannot tell errors below those of that mesh. Seconds are those of processor. The seconds a uniform mesh of the same error takes lie on the straight line through those runs, in logarithms; `<` and
`>`: outside of them. Scenes that no uniform mesh finishes are named. Prints the table and draws out/bench/scenes.png. Ends with 1 when fewer than 8 in 12 of
the scenes that uniform meshes finish are done in half of their seconds.
"""
import math
import os
import re
import sys

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [os.path.join(os.path.dirname(HERE), folder) for folder in ("cycle", "runs")]
from remeshed import ROOT  # noqa: E402
from scenes import SCENES, checked, deck_of, run_scene  # noqa: E402
from support import DONE, write  # noqa: E402

OUT = os.path.join(ROOT, "out", "bench", "scenes")
LADDER = (1.0, 0.67, 0.44, 0.3)
PLACES = [0.2 + 0.02 * (k + 1) for k in range(40)]
SAVED, SHARE = 0.5, 8 / 12
HEAD = ["| scene | steps | error % | seconds | uniform meshes: error % in seconds | seconds at equal error | ratio |", "|---|---|---|---|---|---|---|"]


def uniform_deck(name, size, folder):
    """The scene on a first mesh of squares of this size, for good; None for bodies that are not given by their contours."""
    with open(deck_of(name), encoding="utf-8") as file:
        text = file.read()
    if not re.search(r"^BODY", text, re.MULTILINE):
        return None
    rows = f"REMSH\n   SIZE {size} {size}\n   COUNT 1000000\n"
    return write(os.path.join(folder, name + ".lag"), re.sub(r"^REMSH.*\n", rows, text, flags=re.MULTILINE))


def force_at(found):
    """The force on the scene's die at the places; the sum of all forces where it names none."""
    rows = found["history"]
    name = "force_y_" + SCENES[found["name"]][0]
    names = [name] if name in rows else [key for key in rows if key.startswith("force_y_")][:1]
    values = []
    for place in PLACES:
        wanted = place * rows["time"][-1]
        k = next((k for k, time in enumerate(rows["time"]) if time >= wanted), len(rows["time"]) - 1)
        share = (wanted - rows["time"][k - 1]) / (rows["time"][k] - rows["time"][k - 1]) if k else 1.0
        values.append(rows[names[0]][k - 1] * (1 - share) + rows[names[0]][k] * share if k else rows[names[0]][0])
    return values


def error_of(found, reference):
    here, there = force_at(found), force_at(reference)
    return math.sqrt(sum((a - b)**2 for a, b in zip(here, there)) / len(here)) / max(abs(b) for b in there)


def at_equal_error(error, points):
    """Seconds at an error, by the line through neighbours of (error, seconds) in logarithms, and '<', '>' or ''."""
    points = sorted(points)
    if error <= points[0][0]:
        return points[0][1], ">"
    if error >= points[-1][0]:
        return points[-1][1], "<"
    for (e1, s1), (e2, s2) in zip(points, points[1:]):
        if e1 <= error <= e2:
            share = (math.log(error) - math.log(e1)) / (math.log(e2) - math.log(e1)) if e2 > e1 else 0.0
            return math.exp(math.log(s1) * (1 - share) + math.log(s2) * share), ""
    raise AssertionError(points)


def study(name, ladder):
    """A row of the table, the ratio (None where no uniform mesh finishes), and what is drawn."""
    cycle = run_scene(name, os.path.join(OUT, name))
    if cycle["code"] != DONE:
        return f"| {name} | {cycle['steps']} | | {cycle['processor']:.0f} | the cycle ended with {cycle['code']} | | |", None, None
    largest = float(re.search(r"elements of [-+.eE0-9]+ to ([-+.eE0-9]+)", checked(name))[1])
    uniform = []
    for factor in ladder:
        folder = os.path.join(OUT, f"{name}.{factor}")
        os.makedirs(folder, exist_ok=True)
        deck = uniform_deck(name, factor * largest, folder)
        if deck:
            uniform.append(run_scene(name, os.path.join(folder, name), deck=deck))
    ended = [found for found in uniform if found["code"] == DONE]
    if len(ended) < 2:
        return f"| {name} | {cycle['steps']} | | {cycle['processor']:.0f} | none comes to the end | | |", None, None
    error = error_of(cycle, ended[-1])
    points = [(error_of(found, ended[-1]), found["processor"]) for found in ended[:-1]]
    seconds, sign = at_equal_error(error, points)
    words = ", ".join(f"{100 * e:.2f} in {s:.0f}" for e, s in points) + f", the finest in {ended[-1]['processor']:.0f}"
    ratio = cycle["processor"] / seconds
    return (f"| {name} | {cycle['steps']} | {100 * error:.2f} | {cycle['processor']:.0f} | {words} | {sign}{seconds:.0f} | {ratio:.2f} |", ratio,
            (name, (error, cycle["processor"]), points))


def draw(drawn):
    try:
        import matplotlib
        matplotlib.use("Agg")
        import matplotlib.pyplot as plt
    except ImportError:
        return
    columns = min(3, len(drawn))
    figure, axes = plt.subplots(-(-len(drawn) // columns), columns, figsize=(4 * columns, 3 * -(-len(drawn) // columns)), squeeze=False)
    for axis, (name, cycle, points) in zip(axes.flat, drawn):
        axis.loglog(*zip(*[(seconds, 100 * error) for error, seconds in sorted(points)]), "s-", color="0.5", label="uniform")
        axis.loglog(cycle[1], 100 * cycle[0], "o", color="C3", label="REMSH alone")
        axis.set_title(name)
        axis.set_xlabel("seconds")
        axis.set_ylabel("error of the force, %")
        axis.legend()
    for axis in list(axes.flat)[len(drawn):]:
        axis.axis("off")
    figure.tight_layout()
    figure.savefig(os.path.join(os.path.dirname(OUT), "scenes.png"), dpi=100)


def main():
    ladder = LADDER
    words = sys.argv[1:]
    if "--ladder" in words:
        k = words.index("--ladder")
        ladder = tuple(float(word) for word in words[k + 1].split(","))
        del words[k:k + 2]
    names = words or ["side_pressing"]
    names = list(SCENES) if names == ["all"] else names
    os.makedirs(OUT, exist_ok=True)
    print("\n".join(HEAD), flush=True)
    ratios, drawn = {}, []
    for name in names:
        row, ratio, picture = study(name, ladder)
        print(row, flush=True)
        if ratio is not None:
            ratios[name] = ratio
            drawn.append(picture)
    if drawn:
        draw(drawn)
    halved = sum(ratio <= SAVED for ratio in ratios.values())
    print(f"{halved} of {len(ratios)} in half of the seconds; not finished by uniform meshes: "
          f"{', '.join(name for name in names if name not in ratios) or 'none'}")
    sys.exit(0 if ratios and halved >= SHARE * len(ratios) else 1)


if __name__ == "__main__":
    main()
