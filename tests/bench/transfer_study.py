#!/usr/bin/env python3
"""What the methods of state transfer lose in 100 transfers there and back between two unlike meshes, and what they cost.

    python3 tests/bench/transfer_study.py [--write] [--keep]

Needs LAGAMINE_BIN (folder of the programs of a build with its tests) and matplotlib (LAGAMINE_PYTHON names a Python that has it).
Prints the tables, writes out/bench/transfer_*.csv and transfer.png; --write puts the tables into
tests/bench/README.md, --keep draws the numbers of the run before. Measured, not judged: the ranking is a test (tests/remdata).
"""
import argparse
import csv
import math
import os
import subprocess
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
OUT = os.path.join(ROOT, "out", "bench")
README = os.path.join(HERE, "README.md")
BEGIN, END = "<!-- transfer: written by transfer_study.py --write -->", "<!-- transfer: end -->"
COLOURS = {"INVERSE": "tab:red", "SQUARES": "tab:blue", "PATCHES": "tab:green"}
FIELDS = {"hill": "round hill", "band": "band with steep flanks", "edge": "layer at a side"}


def measure(word):
    """Run the program for one table and keep what it prints."""
    program = os.path.join(os.path.dirname(os.path.abspath(os.environ["LAGAMINE_BIN"])), "tests", "transfer_bench")
    answer = subprocess.run([program, word], check=True, capture_output=True, text=True,
                            env={**os.environ, "OMP_NUM_THREADS": "1"})
    with open(os.path.join(OUT, f"transfer_{word}.csv"), "w", encoding="utf-8") as file:
        file.write(answer.stdout)


def rows_of(word):
    with open(os.path.join(OUT, f"transfer_{word}.csv"), encoding="utf-8") as file:
        return list(csv.DictReader(file))


def chosen(losses, **wanted):
    return [row for row in losses if all(row[key] == value for key, value in wanted.items())]


def table_of_losses(losses):
    lines = ["| field | mesh | method | degree | peak lost % | integral % | change % | least % | after 10: change % |",
             "|---|---|---|---|---|---|---|---|---|"]
    for field, title in FIELDS.items():
        for mesh in ("16", "32"):
            for method in COLOURS:
                for degree in ("-", "1", "2"):
                    rows = chosen(losses, field=field, elements=mesh, method=method, degree=degree, limit="material",
                                  conserve="no")
                    if not rows:
                        continue
                    early, last = chosen(rows, transfers="10")[0], chosen(rows, transfers="100")[0]
                    numbers = [100 * float(last[key]) for key in ("peak_loss", "integral_change", "rms_change", "least")]
                    lines.append(f"| {title} | {mesh}x{mesh} | {method} | {degree} | "
                                 + " | ".join(f"{number:.1f}" for number in numbers)
                                 + f" | {100 * float(early['rms_change']):.1f} |")
    return lines


def table_of_neighbours(changes):
    columns = [(field, mesh) for field in FIELDS for mesh in ("16", "32")]
    lines = ["| neighbours | " + " | ".join(f"{FIELDS[field]} {mesh}x{mesh}" for field, mesh in columns) + " |",
             "|---" * (len(columns) + 1) + "|"]
    for number in dict.fromkeys(row["neighbours"] for row in changes):
        values = [float(chosen(changes, neighbours=number, field=field, elements=mesh)[0]["rms_change"])
                  for field, mesh in columns]
        lines.append(f"| {number} | " + " | ".join(f"{100 * value:.1f}" for value in values) + " |")
    return lines


def table_of_seconds(seconds):
    sizes = sorted({int(row["elements"]) for row in seconds})
    lines = ["| method | " + " | ".join(f"{size} elements" for size in sizes) + " | grows as |",
             "|---" * (len(sizes) + 2) + "|"]
    for method in COLOURS:
        taken = {int(row["elements"]): float(row["seconds"]) for row in seconds if row["method"] == method}
        # the least mesh is too quick for the clock
        power = math.log(taken[sizes[-1]] / taken[sizes[1]]) / math.log(sizes[-1] / sizes[1])
        lines.append(f"| {method} | " + " | ".join(f"{taken[size]:.3f}" for size in sizes) + f" | n^{power:.2f} |")
    return lines


def draw(losses, path):
    figure, axes = plt.subplots(2, 3, figsize=(13, 7.5), sharex=True, constrained_layout=True)
    for column, (field, title) in enumerate(FIELDS.items()):
        for method, colour in COLOURS.items():
            for mesh, style in (("16", "-"), ("32", "--")):
                rows = chosen(losses, field=field, elements=mesh, method=method, limit="material", conserve="no",
                              degree="-" if method == "INVERSE" else "2")
                transfers = [int(row["transfers"]) for row in rows]
                for row_of_axes, key in enumerate(("rms_change", "peak_loss")):
                    axes[row_of_axes][column].plot(transfers, [100 * float(row[key]) for row in rows], style, color=colour,
                                                   label=f"{method} {mesh}x{mesh}")
        axes[0][column].set_title(title)
        axes[1][column].set_xlabel("transfers")
        for row_of_axes in axes:
            row_of_axes[column].grid(alpha=0.3)
    axes[0][0].set_ylabel("change of the field, root mean square, %")
    axes[1][0].set_ylabel("peak lost, %")
    axes[0][0].legend(fontsize=8)
    figure.savefig(path, dpi=110)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--keep", action="store_true")
    options = parser.parse_args()
    os.makedirs(OUT, exist_ok=True)
    if not options.keep:
        if "LAGAMINE_BIN" not in os.environ:
            sys.exit("transfer_study.py: LAGAMINE_BIN must name the folder of the programs")
        measure("losses")
        measure("neighbours")
        measure("seconds")
    losses = rows_of("losses")
    text = "\n".join(table_of_losses(losses) + ["", "Change % after 100 transfers by SQUARES over so many neighbours:", ""]
                     + table_of_neighbours(rows_of("neighbours")) + [""] + table_of_seconds(rows_of("seconds")))
    print(text)
    draw(losses, os.path.join(OUT, "transfer.png"))
    if options.write:
        with open(README, encoding="utf-8") as file:
            page = file.read()
        head, rest = page.split(BEGIN)
        with open(README, "w", encoding="utf-8") as file:
            file.write(head + BEGIN + "\n" + text + "\n" + END + rest.split(END)[1])


if __name__ == "__main__":
    main()
