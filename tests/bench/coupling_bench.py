#!/usr/bin/env python3
"""Heat and mechanics in turns once, in turns to convergence, in one system: seconds, iterations, differences; and longer steps.

usage: coupling_bench.py [--write]
  --write   put the tables into decks/quench_bar_trip/README.md, between its lines <!-- ways -->
The bar of quench_bar_trip, its mechanics with kinetics of their own and heat of the change of volume (own=1, source=3500), by each way of SOLVE, one
thread; differences to MONOLITHIC in steps a fifth as long. Then coupled decks with the error in time that they ask for and ten times as
much (`tol`), or with longest steps ten times as long: the change of the mean fractions at the end, which must stay below 1e-3. LAGAMINE_BIN: folder of
`lagamine`. Ends with 1 where a run fails, a bound is not kept, or ways differ by more than the error that the README states (0.2 % of the stress).
"""
import argparse
import csv
import json
import os
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
SOURCE = os.path.dirname(os.path.dirname(HERE))
BIN = os.path.abspath(os.environ.get("LAGAMINE_BIN") or os.path.join(SOURCE, "build", "bin"))
README = os.path.join(SOURCE, "decks", "quench_bar_trip", "README.md")
MARK = "<!-- ways -->\n"
STATED = 0.2     # percent
FRACTIONS = 1e-3
COUPLED = ["own=1.", "source=3500."]
# Deck, parameters of the long and of the short steps, columns of fractions.
LONGER = [("quench_bar_trip", ["step=20."], ["step=2."], ["z"]),
          ("quench_bar_trip", ["step=2."], ["step=0.2"], ["z"]),
          ("quench_ring_100cr6", ["tol=5.", "n=4", "m=9"], ["tol=0.5", "n=4", "m=9"], ["martensite", "bainite"]),
          ("tempering", ["tol=10."], ["tol=1."], ["martensite", "tempered"]),
          ("jominy", ["tol=5."], ["tol=0.5"], ["martensite", "bainite", "ferrite", "pearlite"])]


def go(folder, deck, parameters):
    """Last row of the history and the summary."""
    out = os.path.join(folder, "out")
    command = [os.path.join(BIN, "lagamine"), os.path.join(SOURCE, "decks", deck, deck + ".lag"), "--quiet", "--threads", "1", "--out", out]
    for parameter in parameters:
        command += ["-p", parameter]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{deck} {' '.join(parameters)}: exit code {done.returncode}: {done.stderr.strip()}")
    with open(os.path.join(out, "history.csv"), newline="") as file:
        rows = list(csv.DictReader(file))
    with open(os.path.join(out, "summary.json")) as file:
        summary = json.load(file)
    return {name.split(" [")[0]: float(value) for name, value in rows[-1].items()}, summary


def run(deck, parameters):
    with tempfile.TemporaryDirectory(prefix="lagamine-") as folder:
        return go(folder, deck, parameters)


def table_of_ways():
    """Lines of the table, and the largest difference in percent."""
    best, _ = run("quench_bar_trip", [*COUPLED, "way=MONOLITHIC", "step=0.4"])
    scale = max(abs(best["side"]), abs(best["core"]))
    ends = {way: run("quench_bar_trip", [*COUPLED, "way=" + way]) for way in ("ONCE", "CONVERGE", "MONOLITHIC")}
    lines = ["| `way` | side [MPa] | core [MPa] | from `MONOLITHIC` % | from steps a fifth as long % | steps | iterations | processor s |", "|---|---|---|---|---|---|---|---|"]
    worst = 0.0
    for way, (end, summary) in ends.items():
        apart = 100*max(abs(end[k] - ends["MONOLITHIC"][0][k]) for k in ("side", "core"))/scale
        error = 100*max(abs(end[k] - best[k]) for k in ("side", "core"))/scale
        worst = max(worst, apart)
        lines.append(f"| `{way}` | {end['side']:.3f} | {end['core']:.3f} | {apart:.3f} | {error:.2f} | {summary['steps']} | {summary['iterations']} | {summary['cpu_s']:.1f} |")
    return lines, worst


def table_of_steps():
    """The same of longer steps: largest change of a mean fraction."""
    lines = ["| deck | longer | shorter | steps | largest change of a mean fraction |", "|---|---|---|---|---|"]
    worst = 0.0
    for deck, long, short, columns in LONGER:
        (one, first), (other, second) = run(deck, long), run(deck, short)
        columns = [name for name in columns if name in one]
        change = max(abs(one[name] - other[name]) for name in columns)
        worst = max(worst, change)
        lines.append(f"| `{deck}` | `{' '.join(long)}` | `{' '.join(short)}` | {first['steps']}, {second['steps']} | {change:.1e} ({', '.join(columns)}) |")
    return lines, worst


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--write", action="store_true")
    arguments = parser.parse_args()
    ways, apart = table_of_ways()
    steps, change = table_of_steps()
    text = "\n".join(ways) + "\n\nSteps ten times as long, coupled with step control:\n\n" + "\n".join(steps) + "\n"
    print(text)
    if arguments.write:
        with open(README, encoding="utf-8") as file:
            parts = file.read().split(MARK)
        if len(parts) != 3:
            sys.exit(f"{README}: wants two lines {MARK.strip()}")
        with open(README, "w", encoding="utf-8") as file:
            file.write(parts[0] + MARK + text + MARK + parts[2])
    print(f"ways differ by {apart:.3f} % (stated: {STATED}), fractions by {change:.1e} (asked: {FRACTIONS:g})")
    sys.exit(apart > STATED or change > FRACTIONS)


if __name__ == "__main__":
    main()
