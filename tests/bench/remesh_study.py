#!/usr/bin/env python3
"""What remeshing saves: upsetting to 60 % on uniform meshes, and remeshed by the errors it makes, against the finest uniform mesh. All have
the steps of the deck of the uniform meshes.

usage: remesh_study.py [--fine NXxNY] [--repeat N] [--write]    about 5 minutes; --write renews table and picture of tests/bench/README.md

Errors: root mean square, and the largest, of the relative differences of the force from the finest mesh at 30, 30.5, ... 60 %. Cost: the sum of unknowns
over all iterations, and seconds of processor of the whole run (programs, files and all; the least of N), one thread. A remeshed run is held against
the uniform mesh of the same error, between those that were run. Cycles begin with the block of the deck, and with the contour of the billet (`BODY`); these have
the limits of `REMSH` alone with an error of the stress and sizes of their own, and patches (`NORMS PATCH 12`), which large uniform meshes have by themselves. Draws
out/bench/remesh.png. Ends with 1 when a uniform mesh of the same root mean square is as cheap.
"""
import csv
import glob
import json
import math
import os
import re
import resource
import shutil
import subprocess
import sys

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [HERE] + [os.path.join(os.path.dirname(HERE), folder) for folder in ("cycle", "runs")]
from scenes_study import LIMITS  # noqa: E402

ROOT = os.path.dirname(os.path.dirname(HERE))
BIN = os.environ.get("LAGAMINE_BIN", os.path.join(ROOT, "build", "bin"))
OUT = os.path.join(ROOT, "out", "bench", "remesh")
README = os.path.join(HERE, "README.md")
BEGIN, END = "<!-- remesh: written by remesh_study.py --write -->", "<!-- remesh: end -->"
HALF_HEIGHT = 15.0
ASKED = (0.01, 0.005)     # errors of the force that are small enough
PLACES = [30 + 0.5 * k for k in range(61)]
UNIFORM = [(6, 9), (9, 14), (12, 18), (16, 24), (24, 36), (32, 48), (48, 72)]
# First mesh, smallest and largest size, error of stress that asks for a new mesh.
REMESHED = [((8, 12), 0.8, 2.0, 0.1), ((10, 15), 0.6, 1.6, 0.1), ((12, 18), 0.5, 1.25, 0.1), ((12, 18), 0.4, 2.0, 0.1), ((16, 24), 0.2, 1.0, 0.1)]
# Those that begin with the contour: smallest and largest size and error of stress; none: REMSH alone.
OUTLINED = [(0.5, 2.0, 0.1), (0.4, 2.0, 0.1), (0.35, 2.0, 0.1), (0.4, 1.5, 0.06), (0.35, 1.2, 0.07), (0.35, 1.5, 0.06), (0.3, 1.5, 0.06), None]
CONTOUR = ("BODY   billet  PL8LS 4 steel\n   SEGM   0. 0.   10. 0.\n   SEGM   10. 0.   10. 15.\n   SEGM   10. 15.   0. 15.\n   SEGM   0. 15.   0. 0.\n")
MEASURES = {"error": "root mean square", "largest": "largest difference"}
PICTURE = os.path.join(HERE, "remesh.svg")


def run(program, deck, out, *options):
    """Seconds of a run that must reach its end."""
    shutil.rmtree(out, ignore_errors=True)
    start = processor_seconds()
    result = subprocess.run([os.path.join(BIN, program), deck, "--out", out, "--threads", "1", *options], text=True,
                            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False)
    if result.returncode != 0:
        sys.exit(f"{program} {deck}: exit code {result.returncode}\n{result.stderr}")
    return processor_seconds() - start


def processor_seconds():
    """Of all programs that have ended here, and of those that they started: what else the machine does counts little."""
    spent = resource.getrusage(resource.RUSAGE_CHILDREN)
    return spent.ru_utime + spent.ru_stime


def forces(out):
    """Force at every place, straight between steps; and the rows of the history."""
    with open(os.path.join(out, "history.csv"), newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    head = {title.split(" ")[0]: title for title in rows[0]}
    travel = [-float(row[head["displacement_y_upper"]]) for row in rows]
    force = [float(row[head["force_y_upper"]]) for row in rows]
    found = []
    for place in PLACES:
        wanted = HALF_HEIGHT * place / 100
        k = next(k for k, u in enumerate(travel) if u >= wanted - 1e-9)
        share = (wanted - travel[k - 1]) / (travel[k] - travel[k - 1])
        found.append(force[k - 1] + share * (force[k] - force[k - 1]))
    steps = [(int(row[head["step"]]), int(row[head["iterations"]])) for row in rows]
    return found, steps


def cost(out, first):
    """Unknowns times iterations, mesh by mesh: a mesh of n x m elements has 3 n m + 2 (n + m) + 1 nodes of
    two unknowns each, one of remdata, as the first one of a contour, about 3.1 nodes an element."""
    _, steps = forces(out)
    changes = []
    for path in sorted(glob.glob(os.path.join(out, "*.start.h5.json"))):
        with open(path, encoding="utf-8") as file:
            facts = json.load(file)
        changes.append((facts["step"], 3.1 * facts["new_elements"]))
    nodes, total = 3 * first[0] * first[1] + 2 * sum(first) + 1 if first else 0, 0
    for step, iterations in steps:
        while changes and step > changes[0][0]:
            nodes = changes.pop(0)[1]
        total += 2 * nodes * iterations
    return total


def remesh_deck(number, first, smallest, largest, error):
    """The deck of the uniform meshes, with the steps that it has, and the card REMSH of upsetting_remesh with other sizes."""
    texts = []
    for name in ("upsetting", "upsetting_remesh"):
        with open(os.path.join(ROOT, "decks", name, name + ".lag"), encoding="utf-8") as file:
            texts.append(file.read())
    card = re.search(r"^REMSH *\n(?: .*\n)+", texts[1], re.MULTILINE)
    text = texts[0].replace("\nPROBE", "\n" + card[0] + "PROBE", 1)
    for old, new in (("PARAM  nx 12", f"PARAM  nx {first[0]}"), ("PARAM  ny 18", f"PARAM  ny {first[1]}"),
                     ("   ERROR 0.1\n", f"   ERROR {error}\n"), ("   SIZE 0.2 0.5\n", f"   SIZE {smallest} {largest}\n")):
        if old not in text:
            sys.exit(f"the deck has no '{old}'")
        text = text.replace(old, new)
    os.makedirs(OUT, exist_ok=True)
    path = os.path.join(OUT, f"remesh{number}.lag")
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    return path


def outlined_deck(number, sizes):
    """The deck of the uniform meshes with the contour of the billet in place of its block, patches, and REMSH."""
    with open(os.path.join(ROOT, "decks", "upsetting", "upsetting.lag"), encoding="utf-8") as file:
        text = file.read()
    text = re.sub(r"^PARAM +n[xy] .*\n", "", text, flags=re.MULTILINE)
    text = re.sub(r"^BLOCK.*\n(?: .*\n)*", CONTOUR, text, flags=re.MULTILINE)
    rows = f"   ERROR {sizes[2]:g} 0.4\n{LIMITS}   SIZE {sizes[0]:g} {sizes[1]:g}\n   COUNT 450\n" if sizes else ""
    text = re.sub(r"^END$", f"NORMS  PATCH 12\nREMSH\n{rows}END", text, flags=re.MULTILINE)
    os.makedirs(OUT, exist_ok=True)
    path = os.path.join(OUT, f"outlined{number}.lag")
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    return path


def cost_of_error(uniform, error, column, measure="error"):
    """What a uniform mesh of this error costs, on straight lines between the logarithms of those that were run, and a sign before it
    where the error is beyond them. Where a finer mesh happens to be no better than a coarser one, the coarser one counts."""
    curve, least = [], math.inf
    for row in sorted(uniform, key=lambda row: row[column]):
        if row[measure] < least:
            curve.append((math.log(row[measure]), math.log(row[column])))
            least = row[measure]
    wanted = math.log(error)
    if wanted >= curve[0][0]:
        return math.exp(curve[0][1]), "< "
    for (high, cheap), (low, dear) in zip(curve, curve[1:]):
        if wanted >= low:
            return math.exp(cheap + (dear - cheap) * (high - wanted) / (high - low)), ""
    return math.exp(curve[-1][1]), "> "


def compared(uniform, out, first, seconds, reference):
    """A run that was made anew, with its errors and costs; and what uniform meshes of these errors cost."""
    row = dict(errors_of(out, reference), work=cost(out, first), seconds=seconds)
    others = [cost_of_error(uniform, row["error"], "work"), cost_of_error(uniform, row["error"], "seconds"),
              cost_of_error(uniform, row["largest"], "seconds", "largest")]
    return row, others


def told(remeshed, uniform):
    """Lines on the cycles within the errors that are asked for."""
    lines = []
    for measure, words in MEASURES.items():
        for asked in ASKED:
            within = [row for row in remeshed if row[measure] <= asked]
            if not within:
                continue
            best = min(within, key=lambda row: row["seconds"])
            same, sign = cost_of_error(uniform, best[measure], "seconds", measure)
            lines.append(f"- {words} of {100 * asked:g} % at most: the cheapest cycle takes {best['seconds']:.2f} s, for {100 * best[measure]:.2f} %; a uniform mesh of this error "
                         f"{sign}{same:.2f} s (ratio {'< ' if sign == '> ' else ''}{best['seconds'] / same:.2f}), one of {100 * asked:g} % "
                         f"{cost_of_error(uniform, asked, 'seconds', measure)[0]:.2f} s")
    return lines


def main():
    fine, repeat = (64, 96), 2
    if "--fine" in sys.argv:
        fine = tuple(int(n) for n in sys.argv[sys.argv.index("--fine") + 1].split("x"))
    if "--repeat" in sys.argv:
        repeat = int(sys.argv[sys.argv.index("--repeat") + 1])
    plain = os.path.join(ROOT, "decks", "upsetting", "upsetting.lag")
    out = os.path.join(OUT, "fine")
    seconds = run("lagamine", plain, out, "--quiet", "-p", f"nx={fine[0]}", "-p", f"ny={fine[1]}")
    reference = forces(out)[0]
    head = ["| mesh | elements, or first mesh and sizes | meshes | error % | largest % | unknowns x iterations / 1e6 | seconds "
            "| uniform mesh of this error: / 1e6 | seconds | of this largest one: seconds |", "|---|---|---|---|---|---|---|---|---|---|",
            f"| uniform | {fine[0]}x{fine[1]} | 1 | | | {cost(out, fine) / 1e6:.2f} | {seconds:.2f} | | | |"]
    uniform, remeshed, lines = [], [], []
    for mesh in UNIFORM:
        out = os.path.join(OUT, f"uniform{mesh[0]}")
        seconds = min(run("lagamine", plain, out, "--quiet", "-p", f"nx={mesh[0]}", "-p", f"ny={mesh[1]}") for _ in range(repeat if mesh[0] < 48 else 1))
        uniform.append(dict(errors_of(out, reference), work=cost(out, mesh), seconds=seconds))
        lines.append(f"| uniform | {mesh[0]}x{mesh[1]} | 1 | {row_of(uniform[-1])} | | | |")
    failed = []
    cycles = [(f"{first[0]}x{first[1]}, {smallest} to {largest}", first, remesh_deck(k, first, smallest, largest, error))
              for k, (first, smallest, largest, error) in enumerate(REMESHED)]
    cycles += [(f"contour, {sizes[0]} to {sizes[1]}, {100 * sizes[2]:g} %" if sizes else "contour, `REMSH` alone", None, outlined_deck(k, sizes)) for k, sizes in enumerate(OUTLINED)]
    for name, first, deck in cycles:
        out = deck[:-len(".lag")]
        row, others = compared(uniform, out, first, min(run("lagacycle", deck, out) for _ in range(repeat)), reference)
        remeshed.append(row)
        lines.append(f"| remeshed | {name} | {1 + len(glob.glob(os.path.join(out, '*.restart.json')))} | {row_of(row)} | "
                     f"{others[0][1]}{others[0][0] / 1e6:.2f} | {others[1][1]}{others[1][0]:.2f} | {others[2][1]}{others[2][0]:.2f} |")
        failed += [f"{name}: {column}" for column, (other, _) in zip(("work", "seconds"), others) if not row[column] < other]
    lines += [""] + told(remeshed, uniform)
    print("\n".join(head + lines))
    write = "--write" in sys.argv
    draw({"uniform": uniform, "remeshed": remeshed}, PICTURE if write else os.path.join(os.path.dirname(OUT), "remesh.png"))
    if write:
        with open(README, encoding="utf-8") as file:
            before, rest = file.read().split(BEGIN)
        with open(README, "w", encoding="utf-8") as file:
            file.write(before + BEGIN + "\n" + "\n".join(head + lines) + "\n" + END + rest.split(END)[1])
    if failed:
        sys.exit("a uniform mesh of the same error is as cheap: " + "; ".join(failed))


def errors_of(out, reference):
    """Root mean square and largest of the relative differences of the forces."""
    differences = [abs(force / other - 1) for force, other in zip(forces(out)[0], reference)]
    return {"error": math.sqrt(sum(one**2 for one in differences) / len(differences)), "largest": max(differences)}


def row_of(row):
    """Cells of a row: errors, work, seconds."""
    return f"{100 * row['error']:.2f} | {100 * row['largest']:.2f} | {row['work'] / 1e6:.2f} | {row['seconds']:.2f}"


def draw(rows, path):
    """Both errors against seconds."""
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter
    matplotlib.rcParams.update({"svg.hashsalt": "remesh", "svg.fonttype": "none"})
    figure, both = plt.subplots(1, 2, figsize=(10, 4.5), sharey=True)
    for axes, (measure, words) in zip(both, MEASURES.items()):
        for kind, style in (("uniform", "ks--"), ("remeshed", "o")):
            places, errors = zip(*sorted((row["seconds"], 100 * row[measure]) for row in rows[kind]))
            axes.loglog(places, errors, style, label=kind)
        for asked in ASKED:
            axes.axhline(100 * asked, color="0.5", linewidth=0.8)
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
            axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
            axis.set_minor_formatter(NullFormatter())
        axes.set_title(words, fontsize=10)
        axes.set_xlabel("seconds of processor")
        axes.grid(True, which="both", alpha=0.3)
    both[0].set_ylabel("error of the force, %")
    both[0].legend()
    figure.tight_layout()
    figure.savefig(path, metadata={"Date": None} if path.endswith("svg") else None)
    plt.close(figure)


if __name__ == "__main__":
    main()
