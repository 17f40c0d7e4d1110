#!/usr/bin/env python3
"""What remeshing saves: upsetting to 60 % on uniform meshes, and remeshed by the errors it makes, against the finest uniform mesh.

usage: remesh_study.py [--fine NXxNY] [--write]       about 3 minutes; --write renews the table in tests/bench/README.md

Error: root mean square of the relative differences of the force from the finest mesh at 30, 35, ... 60 %. Cost: the sum of unknowns
over all iterations, and seconds of the whole run (programs, files and all), one thread. Draws out/bench/remesh.png.
"""
import csv
import glob
import json
import math
import os
import shutil
import subprocess
import sys
import time

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
BIN = os.environ.get("LAGAMINE_BIN", os.path.join(ROOT, "build", "bin"))
OUT = os.path.join(ROOT, "out", "bench", "remesh")
README = os.path.join(HERE, "README.md")
BEGIN, END = "<!-- remesh: written by remesh_study.py --write -->", "<!-- remesh: end -->"
HALF_HEIGHT = 15.0
PLACES = range(30, 61, 5)
UNIFORM = [(6, 9), (9, 14), (12, 18), (16, 24), (24, 36)]
# First mesh, smallest and largest size, error of stress that asks for a new mesh.
REMESHED = [((6, 9), 0.8, 2.5, 0.2), ((8, 12), 0.7, 2.0, 0.15), ((12, 18), 0.5, 1.25, 0.1), ((16, 24), 0.4, 1.0, 0.1)]


def run(program, deck, out, *options):
    """Seconds of a run that must reach its end."""
    shutil.rmtree(out, ignore_errors=True)
    start = time.perf_counter()
    result = subprocess.run([os.path.join(BIN, program), deck, "--out", out, "--threads", "1", *options], text=True,
                            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False)
    if result.returncode != 0:
        sys.exit(f"{program} {deck}: exit code {result.returncode}\n{result.stderr}")
    return time.perf_counter() - start


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
    two unknowns each, one of remdata about 3.1 nodes an element."""
    _, steps = forces(out)
    changes = []
    for path in sorted(glob.glob(os.path.join(out, "*.start.h5.json"))):
        with open(path, encoding="utf-8") as file:
            facts = json.load(file)
        changes.append((facts["step"], 3.1 * facts["new_elements"]))
    nodes, total = 3 * first[0] * first[1] + 2 * sum(first) + 1, 0
    for step, iterations in steps:
        while changes and step > changes[0][0]:
            nodes = changes.pop(0)[1]
        total += 2 * nodes * iterations
    return total


def remesh_deck(first, smallest, largest, error):
    """The deck upsetting_remesh to 60 % with other sizes."""
    with open(os.path.join(ROOT, "decks", "upsetting_remesh", "upsetting_remesh.lag"), encoding="utf-8") as file:
        text = file.read()
    for old, new in (("PARAM  nx 12", f"PARAM  nx {first[0]}"), ("PARAM  ny 18", f"PARAM  ny {first[1]}"),
                     ("   ERROR 0.1", f"   ERROR {error}"), ("   SIZE 0.5 1.25", f"   SIZE {smallest} {largest}")):
        if old not in text:
            sys.exit(f"the deck has no '{old}'")
        text = text.replace(old, new)
    os.makedirs(OUT, exist_ok=True)
    path = os.path.join(OUT, f"remesh{first[0]}.lag")
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    return path


def main():
    fine = (48, 72)
    if "--fine" in sys.argv:
        fine = tuple(int(n) for n in sys.argv[sys.argv.index("--fine") + 1].split("x"))
    plain = os.path.join(ROOT, "decks", "upsetting", "upsetting.lag")
    rows, reference = [], None
    for mesh in [fine] + UNIFORM:
        out = os.path.join(OUT, f"uniform{mesh[0]}")
        seconds = run("lagamine", plain, out, "--quiet", "-p", f"nx={mesh[0]}", "-p", f"ny={mesh[1]}")
        found, _ = forces(out)
        reference = reference or found
        rows.append(["uniform", f"{mesh[0]}x{mesh[1]}", 1, found, cost(out, mesh), seconds])
    for first, smallest, largest, error in REMESHED:
        out = os.path.join(OUT, f"remeshed{first[0]}")
        seconds = run("lagacycle", remesh_deck(first, smallest, largest, error), out, "-p", "travel=9")
        found, _ = forces(out)
        meshes = 1 + len(glob.glob(os.path.join(out, "*.restart.json")))
        rows.append(["remeshed", f"{first[0]}x{first[1]}, {smallest} to {largest}", meshes, found, cost(out, first), seconds])
    lines = ["| mesh | elements, or first mesh and sizes | meshes | error % | unknowns x iterations / 1e6 | seconds |", "|---|---|---|---|---|---|"]
    points = {"uniform": [], "remeshed": []}
    for kind, name, meshes, found, work, seconds in rows:
        error = math.sqrt(sum((f / r - 1) ** 2 for f, r in zip(found, reference)) / len(found))
        lines.append(f"| {kind} | {name} | {meshes} | {100 * error:.2f} | {work / 1e6:.2f} | {seconds:.2f} |")
        if error > 0:
            points[kind].append((seconds, 100 * error, work))
    print("\n".join(lines))
    draw(points)
    if "--write" in sys.argv:
        with open(README, encoding="utf-8") as file:
            head, rest = file.read().split(BEGIN)
        with open(README, "w", encoding="utf-8") as file:
            file.write(head + BEGIN + "\n" + "\n".join(lines) + "\n" + END + rest.split(END)[1])


def draw(points):
    """Error against seconds."""
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    figure, axes = plt.subplots(figsize=(6, 4.5))
    for kind, style in (("uniform", "ks--"), ("remeshed", "o-")):
        seconds, errors, _ = zip(*sorted(points[kind]))
        axes.loglog(seconds, errors, style, label=kind)
    axes.set_xlabel("seconds")
    axes.set_ylabel("error of the force, %")
    axes.legend()
    axes.grid(True, which="both", alpha=0.3)
    figure.tight_layout()
    figure.savefig(os.path.join(os.path.dirname(OUT), "remesh.png"), dpi=120)


if __name__ == "__main__":
    main()
