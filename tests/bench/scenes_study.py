#!/usr/bin/env python3
"""What remeshing saves in the scenes with REMSH alone: seconds at equal error of the force, over those of uniform meshes that are never replaced.

usage: scenes_study.py [NAME... | all] [--limit SECONDS] [--fresh] [--write]      all: an hour or two, by hand; without names: two_strokes

Each scene is run on cycles of meshes and on first meshes that are kept. The cycles are the deck as it is (`REMSH` alone) and the same with the sizes that
`--check` prints times 2 and 1.41, with the number of elements to match and the same limits of shape and contact: what a user has who begins with a coarser mesh; and with the
smallest size of the deck, twice the largest, two thirds of the elements and an ERROR of 0.1 and of 0.05. Uniform meshes
are squares of 2, 1.5, 1, 0.67, 0.44 and 0.3 times the largest size of the deck. The reference is the finest run: a cycle with half of the deck's sizes and all limits
of REMSH alone, that of the error among them: without it a fine first mesh may wear to the end (that of deformable_punch came to an error of the stress of 14 %, and
was .4 to .6 % from all other fine runs, uniform ones too, which are .15 % from this one). Sizes are 0.7 times the deck's where that one does not come to the
end; otherwise it is the finest uniform mesh.

Error: root mean square of the difference of the force from the reference at 40 instants of the last four fifths, over the largest force; the force is the
largest along y on any die. Instants are left out where the reference's force changes by a fifth of its largest within a largest step to either side, as where a die
withdraws or comes back: what is found there is how long steps are. Seconds are those of processor, programs and files and all. The seconds that a uniform mesh
takes for the error of a cycle lie on straight lines in logarithms through those uniform meshes that are better than all that are cheaper. An error that none of
them reaches takes more than the best of them, and more than any of them that errs by more than ten times as much, which no error of the reference makes (`<` before
the ratio; where that leaves open whether it is half, there is one of 0.2 times the size too), and one that the cheapest stays below takes less (`>`). A run that takes longer than --limit (default 600 s on the wall) is none.

Runs of the same deck are not made again, unless with --fresh, and the table is written after every scene. --write puts the rows of these scenes in place of
theirs in tests/bench/README.md, and draws tests/bench/scenes.svg. Ends with 1 when in fewer than 8 in 12 of the scenes that uniform meshes finish a cycle takes half of
their seconds at most.
"""
import json
import math
import os
import re
import shutil
import signal
import subprocess
import sys

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [os.path.join(os.path.dirname(HERE), folder) for folder in ("cycle", "runs")]
from remeshed import CYCLE, ROOT, put_table, tries  # noqa: E402
from scenes import SCENES, checked, deck_of, spent  # noqa: E402
from support import DONE, history, write  # noqa: E402

OUT = os.path.join(ROOT, "out", "bench", "scenes")
README, PICTURE, MARK = os.path.join(HERE, "README.md"), os.path.join(HERE, "scenes.svg"), "<!-- scenes: written by scenes_study.py --write -->"
UNIFORM, FINER, FINEST = (2.0, 1.5, 1.0, 0.67, 0.44, 0.3), 0.2, (0.5, 0.7)
# Sizes over the deck's, and ERROR.
CYCLES = {"sizes 2": (2.0, None), "sizes 1.41": (1.41, None), "REMSH alone": (1.0, None), "ERROR 0.1": (2.0, 0.1), "ERROR 0.05": (2.0, 0.05)}
PLACES = [0.2 + 0.02 * (k + 1) for k in range(40)]
CLEARLY = 10      # times an error: that is not reached
JUMP = 0.2        # of the largest force in one step: no error of the mesh is told there
SAVED, ENOUGH, SHARE = 0.5, 8 / 12, 2 / 3
LIMITS = "   ANGLE 15. 165.\n   MIDDLE 0.4\n   SCALED 0.2\n   ASPECT 10.\n   CONTACT 50.\n   NARROW\n   CORNER\n   DISTRESS 4\n   LEAST 5\n"   # those of REMSH alone
ERROR = "   ERROR 0.05 0.4\n"   # and of the error
HEAD = [f"| scene | uniform meshes: error % in s | cycles ({', '.join(CYCLES)}): error % in s | least ratio | `REMSH` alone | |", "|---|---|---|---|---|---|"]


def scaled(name, factor, remsh):
    """The deck with other rows of REMSH, and with blocks divided for elements of so many times the size."""
    with open(deck_of(name), encoding="utf-8") as file:
        text = file.read()
    text = re.sub(r"^   (\d+) (1\.)   (\d+) (1\.)$", lambda m: f"   {max(1, round(int(m[1]) / factor))} 1.   {max(1, round(int(m[3]) / factor))} 1.", text,
                  flags=re.MULTILINE)
    return re.sub(r"^REMSH.*\n", remsh, text, flags=re.MULTILINE)


def cycle_deck(name, factor, error=None, limits=LIMITS):
    """The scene with sizes so many times those of the deck, and elements to match; with an error that asks for new meshes as fine as the deck's
    where it is large, and two thirds of the elements."""
    sizes = re.search(r"elements of ([-+.eE0-9]+) to ([-+.eE0-9]+), at most (\d+)", checked(name))
    if factor == 1:
        with open(deck_of(name), encoding="utf-8") as file:
            return file.read()
    if error:
        return scaled(name, factor, f"REMSH\n   ERROR {error}\n{LIMITS}   SIZE {sizes[1]} {float(sizes[2]) * factor:.4g}\n"
                                    f"   COUNT {round(int(sizes[3]) * SHARE)}\n")
    return scaled(name, factor, f"REMSH\n{limits}   SIZE {float(sizes[1]) * factor:.4g} {float(sizes[2]) * factor:.4g}\n"
                                f"   COUNT {round(int(sizes[3]) / factor**2)}\n")


def uniform_deck(name, factor):
    """The scene on a first mesh of squares, so many times as large as the largest elements of the deck, for good."""
    size = factor * float(re.search(r"elements of [-+.eE0-9]+ to ([-+.eE0-9]+)", checked(name))[1])
    with open(deck_of(name), encoding="utf-8") as file:
        outlined = re.search(r"^BODY", file.read(), re.MULTILINE)
    return scaled(name, factor, f"REMSH\n   SIZE {size:.6g} {size:.6g}\n   COUNT 1000000\n" if outlined else "")


def made(name, kind, text, limit, fresh):
    """A run of a deck, or what is there of the same one: exit code, seconds of processor; -1: beyond the limit."""
    folder = os.path.join(OUT, name, kind)
    told, deck, out = os.path.join(folder, "run.json"), os.path.join(folder, name + ".lag"), os.path.join(folder, "run")
    if not fresh and os.path.exists(told):
        with open(told, encoding="utf-8") as file, open(deck, encoding="utf-8") as before:
            if before.read() == text:
                return dict(json.load(file), out=out)
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    write(deck, text)
    program = CYCLE if re.search("^REMSH", text, re.MULTILINE) else os.path.join(os.path.dirname(CYCLE), "lagamine")
    begun = spent()
    process = subprocess.Popen([program, deck, "--out", out, "--threads", "1", "--quiet"], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                               stderr=subprocess.DEVNULL, start_new_session=True)
    try:
        code = process.wait(limit)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGTERM)
        process.wait()
        code = -1
    found = {"code": code, "seconds": spent() - begun, "meshes": sum(row["accepted"] == "y" and row["action"] != "old mesh" for row in tries(out))}
    with open(told, "w", encoding="utf-8") as file:
        json.dump(found, file)
    return dict(found, out=out)


def forces_of(rows):
    """The largest force along y on any die, after every step."""
    names = [key for key in rows if key.startswith("force_y_")]
    return [max(abs(rows[key][k]) for key in names) for k in range(len(rows["time"]))]


def places_of(rows):
    """Instants at which forces are compared."""
    forces, times, end = forces_of(rows), rows["time"], rows["time"][-1]
    largest = max(b - a for a, b in zip([0.0] + times, times))

    def change(place):
        around = [force_at(rows, place - largest), force_at(rows, min(place + largest, end))]
        around += [force for time, force in zip(times, forces) if abs(time - place) <= largest]
        return max(around) - min(around)
    return [place * end for place in PLACES if not change(place * end) > JUMP * max(forces)]


def force_at(rows, wanted):
    """The force at an instant, straight between steps."""
    forces, times = forces_of(rows), rows["time"]
    k = next((k for k, time in enumerate(times) if time >= wanted), len(times) - 1)
    if k == 0:
        return forces[0]
    share = min((wanted - times[k - 1]) / (times[k] - times[k - 1]), 1.0)
    return forces[k - 1] * (1 - share) + forces[k] * share


def error_of(found, reference):
    rows, others = history(found["out"]), history(reference["out"])
    places = places_of(others)
    squares = [(force_at(rows, place) - force_at(others, place))**2 for place in places]
    return math.sqrt(sum(squares) / len(squares)) / max(forces_of(others))


def at_equal_error(error, points):
    """Seconds at an error, by the line through neighbours of (error, seconds) in logarithms, and '<', '>' or ''. Only runs that are better than
    all that are cheaper count. An error that none reaches takes longer than all that are clearly worse, however long they took."""
    front = []
    for one, seconds in sorted(points, key=lambda point: point[1]):
        if not front or one < front[-1][0]:
            front.append((one, seconds))
    if error >= front[0][0]:
        return front[0][1], "<"
    for (e1, s1), (e2, s2) in zip(front, front[1:]):
        if error >= e2:
            return math.exp(math.log(s1) + math.log(s2 / s1) * math.log(e1 / error) / math.log(e1 / e2)), ""
    return max([front[-1][1]] + [seconds for worse, seconds in points if worse > CLEARLY * error]), ">"


def compared(cycles, ours, points):
    """The best of the cycles, and by kind the ratio of its seconds to those of a uniform mesh of its error, and '<', '>' or ''."""
    equal = [at_equal_error(error, points) for error, _ in ours]
    ratios = {kind: seconds / there for (kind, _), (_, seconds), (there, _) in zip(cycles, ours, equal)}
    # "takes more than" of the uniform mesh is "less than" of the ratio
    signs = {kind: {">": "<", "<": ">"}.get(sign, "") for (kind, _), (_, sign) in zip(cycles, equal)}
    return min(ratios, key=ratios.get), ratios, signs


def study(name, limit, fresh):
    """The row of the table, and what is drawn."""
    cycles = [(kind, made(name, f"cycle_{factor}" + (f"_error_{error}" if error else ""), cycle_deck(name, factor, error), limit, fresh))
              for kind, (factor, error) in CYCLES.items()]
    uniform = [(f"uniform {factor:g}", made(name, f"uniform_{factor}", uniform_deck(name, factor), limit, fresh)) for factor in UNIFORM]
    failed = [f"{kind}: code {found['code']}" for kind, found in uniform + cycles if found["code"] != DONE]
    cycles, uniform = ([one for one in runs if one[1]["code"] == DONE] for runs in (cycles, uniform))
    if not uniform:
        spent_by = ", ".join(f"{found['seconds']:.1f} s" for _, found in cycles)
        return f"| {name} | none | {spent_by} | | | {'; '.join(failed)} |", None
    for factor in FINEST:
        finest = made(name, f"reference_{factor}", cycle_deck(name, factor, limits=ERROR + LIMITS), limit, fresh)
        if finest["code"] == DONE:
            break
        failed.append(f"reference {factor:g}: code {finest['code']}")
    if finest["code"] != DONE:
        failed.append("reference: the finest uniform mesh")
        finest = uniform.pop()[1]
    points = [(error_of(found, finest), found["seconds"]) for _, found in uniform]
    ours = [(error_of(found, finest), found["seconds"]) for _, found in cycles]
    words = [", ".join(f"{100 * e:.2f} in {s:.1f}" for e, s in row) for row in (points, ours)]
    if not points or not ours:
        return f"| {name} | {words[0] or 'none'} | {words[1]} | | | {'; '.join(failed)} |", (name, points, ours)
    least, ratios, signs = compared(cycles, ours, points)
    if signs[least] == "<" and ratios[least] > SAVED:
        found = made(name, f"uniform_{FINER}", uniform_deck(name, FINER), limit, fresh)
        if found["code"] == DONE:
            points.append((error_of(found, finest), found["seconds"]))
            words[0] += f", {100 * points[-1][0]:.2f} in {points[-1][1]:.1f}"
            least, ratios, signs = compared(cycles, ours, points)
        else:
            failed.append(f"uniform {FINER:g}: code {found['code']}")
    told = [f"{signs[kind]}{ratios[kind]:.2f}" if kind in ratios else "" for kind in (least, "REMSH alone")]
    return f"| {name} | {words[0]} | {words[1]} | {told[0]} ({least}) | {told[1]} | {'; '.join(failed)} |", (name, points, ours)


def draw(drawn, path):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator
    matplotlib.rcParams.update({"svg.hashsalt": "scenes", "svg.fonttype": "none"})
    columns = min(4, len(drawn))
    figure, axes = plt.subplots(-(-len(drawn) // columns), columns, figsize=(3.2 * columns, 2.6 * -(-len(drawn) // columns)), squeeze=False)
    for axis, (name, points, ours) in zip(axes.flat, drawn):
        for runs, style, colour, label in ((points, "s--", "0.5", "uniform"), (ours, "o", "C3", "cycle")):
            if runs:
                errors, seconds = zip(*sorted(runs, key=lambda one: one[1]))
                axis.loglog(seconds, [100 * error for error in errors], style, color=colour, label=label)
        axis.set_title(name, fontsize=10)
        for one in (axis.xaxis, axis.yaxis):
            one.set_major_locator(LogLocator(subs=(1, 2, 5)))
            one.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
            one.set_minor_locator(NullLocator())
            one.set_tick_params(labelsize=7)
        axis.margins(0.15)
        axis.grid(True, alpha=0.3)
    axes[0][0].legend(fontsize=8)
    for axis in list(axes.flat)[len(drawn):]:
        axis.axis("off")
    figure.supxlabel("seconds of processor")
    figure.supylabel("error of the force, %")
    figure.tight_layout()
    figure.savefig(path, metadata={"Date": None} if path.endswith("svg") else None)
    plt.close(figure)


def kept_rows(names):
    """Rows of the table in the README of scenes that were not run now, by name."""
    with open(README, encoding="utf-8") as file:
        rows = file.read().split(MARK)[1].split("\n")
    cells = {row.split("|")[1].strip(): row for row in rows if row.startswith("| ") and row.count("|") >= 7}
    return {name: row for name, row in cells.items() if name in SCENES and name not in names}


def ratios_in(row):
    """The two ratios of a row of the table: of the best of the cycles, and of REMSH alone; None where uniform meshes do not come to the end."""
    found = [re.match(r"[<>]?([0-9.]+)", cell.strip()) for cell in row.split("|")[4:6]]
    return tuple(float(match[1]) if match else math.inf for match in found) if found[0] else None


def points_in(cell):
    """Errors and seconds of a cell of the table."""
    return [(float(error) / 100, float(seconds)) for error, seconds in re.findall(r"([0-9.]+) in ([0-9.]+)", cell)]


def summed_up(rows):
    """How many scenes are done in half of the seconds, and which are not; rows by name."""
    ratios = {name: ratios_in(row) for name, row in rows.items()}
    others = [name for name in ratios if not ratios[name]]
    ratios = {name: pair for name, pair in ratios.items() if pair}
    halved = [name for name in ratios if ratios[name][0] <= SAVED]
    alone = [name for name in ratios if ratios[name][1] <= SAVED]
    return len(halved), len(ratios), [
        f"In half of the seconds of a uniform mesh of the same error, or less: {len(halved)} of {len(ratios)} scenes that uniform meshes finish by the "
        f"best of the cycles, {len(alone)} by `REMSH` alone. More: {', '.join(name for name in ratios if name not in halved) or 'none'}. Not finished by "
        f"uniform meshes: {', '.join(others) or 'none'}."]


def main():
    words, limit = sys.argv[1:], 600
    fresh, to_write = "--fresh" in words, "--write" in words
    words = [word for word in words if word not in ("--fresh", "--write")]
    if "--limit" in words:
        k = words.index("--limit")
        limit = float(words[k + 1])
        del words[k:k + 2]
    names = words or ["two_strokes"]
    names = list(SCENES) if names == ["all"] else names
    os.makedirs(OUT, exist_ok=True)
    print("\n".join(HEAD), flush=True)
    rows, drawn = {}, []
    for name in names:
        rows[name], picture = study(name, limit, fresh)
        print(rows[name], flush=True)
        if picture:
            drawn.append(picture)
        write(os.path.join(OUT, "scenes.md"), "\n".join(HEAD + list(rows.values())) + "\n")
    if to_write:
        kept = kept_rows(names)
        drawn += [(name, *(points_in(cell) for cell in row.split("|")[2:4])) for name, row in kept.items() if ratios_in(row)]
        drawn.sort(key=lambda one: list(SCENES).index(one[0]))
        rows = {name: {**kept, **rows}[name] for name in SCENES if name in kept or name in rows}
    halved, counted, words = summed_up(rows)
    print("\n".join(words))
    if drawn:
        draw(drawn, PICTURE if to_write else os.path.join(os.path.dirname(OUT), "scenes.png"))
    if to_write:
        put_table(README, MARK, HEAD + list(rows.values()) + [""] + words)
    sys.exit(0 if counted and halved >= ENOUGH * counted else 1)


if __name__ == "__main__":
    main()
