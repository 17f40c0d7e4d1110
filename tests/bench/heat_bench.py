#!/usr/bin/env python3
"""What accuracy costs in conduction: the quench of decks/finite_cylinder, whole processes, beside CalculiX where it is installed.

usage: heat_bench.py [--repeat N] [--out FOLDER]

The same 4 x 4 elements of 8 nodes in both; errors are those at the end against the series of H.S. Carslaw and J.C. Jaeger (the table of
the deck). Times are the least of N runs in turns: of the process on the wall, and of the processor. FOLDER (default: a new one under
the folder for temporary files) says which disk the results go to: a run flushes every file that it must not lose. Standard library only.
"""
import argparse
import csv
import os
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import time

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
DECK = os.path.join(ROOT, "decks", "finite_cylinder", "finite_cylinder.lag")
LAGAMINE = os.path.join(os.environ.get("LAGAMINE_BIN") or os.path.join(ROOT, "build", "bin"), "lagamine")
EXACT = {"centre": 468.586, "side": 283.348, "corner": 178.841}
# THETA, and the largest step [s]
SCHEMES = (("1.", 0.1), ("1. TOL 0.1", 5.0), ("TRBDF2", 1.0), ("TRBDF2", 0.5), ("TRBDF2 TOL 0.1", 5.0), ("TRBDF2 TOL 0.01", 5.0))
CCX_STEPS = (0.1, 0.01)
SIZE, DIVISIONS, RATIO = 25.0, 4, 0.4


def our_deck(theta, step):
    """The deck by another scheme: the first step is short, since temperatures jump."""
    with open(DECK, encoding="utf-8") as file:
        text = file.read()
    for old, new in ((r"(?m)^THETA .*$", f"THETA  {theta}"), (r"(?m)^PARAM  (theta|step) .*\n", ""), (r"(?m)^SAVE .*\n", ""),
                     (r"(?m)^STRAT .*$", f"STRAT  {min(0.05, step)} 1.E-6 {step}   5 3")):
        text, count = re.subn(old, new, text)
        if not count:
            sys.exit(f"heat_bench: {DECK} has nothing like {old}")
    return text


def ccx_deck(step):
    """The same mesh and step by step of implicit Euler."""
    shares = [RATIO**(i/(DIVISIONS - 1)) for i in range(DIVISIONS)]
    ends = [SIZE*sum(shares[:i])/sum(shares) for i in range(DIVISIONS + 1)]
    places = [ends[i//2] if i % 2 == 0 else 0.5*(ends[i//2] + ends[i//2 + 1]) for i in range(2*DIVISIONS + 1)]
    label, cards = {}, ["*NODE, NSET=ALL"]
    for j, y in enumerate(places):
        for i, x in enumerate(places):
            if not (i % 2 and j % 2):
                label[i, j] = len(label) + 1
                cards.append(f"{label[i, j]}, {x:.12g}, {y:.12g}, 0.")
    corners = ((0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1))
    cards.append("*ELEMENT, TYPE=CAX8, ELSET=C")
    for j in range(DIVISIONS):
        for i in range(DIVISIONS):
            cards.append(f"{1 + i + DIVISIONS*j}, " + ", ".join(str(label[2*i + a, 2*j + b]) for a, b in corners))
    last = 2*DIVISIONS
    cards += ["*NSET, NSET=SEEN", f"{label[0, 0]}, {label[last, 0]}, {label[last, last]}", "*MATERIAL, NAME=STEEL", "*CONDUCTIVITY", "40.",
              "*DENSITY", "7.8E-9", "*SPECIFIC HEAT", "5.E8", "*SOLID SECTION, ELSET=C, MATERIAL=STEEL",
              "*INITIAL CONDITIONS, TYPE=TEMPERATURE", "ALL, 800.", "*STEP, INC=100000", "*HEAT TRANSFER, DIRECT", f"{step}, 20.", "*FILM"]
    cards += [f"{DIVISIONS*(1 + j)}, F2, 20., 2." for j in range(DIVISIONS)]
    cards += [f"{1 + i + DIVISIONS*(DIVISIONS - 1)}, F3, 20., 2." for i in range(DIVISIONS)]
    cards += ["*NODE PRINT, NSET=SEEN, FREQUENCY=100000", "NT", "*END STEP"]
    return "\n".join(cards) + "\n"


def timed(command, folder):
    """Seconds of a process on the wall and of the processor; ends the bench where it fails."""
    environment = dict(os.environ, OMP_NUM_THREADS="1")
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    start = time.perf_counter()
    result = subprocess.run(command, cwd=folder, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    wall = time.perf_counter() - start
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if result.returncode:
        sys.exit(f"heat_bench: {' '.join(command)}: {result.returncode} {result.stdout[-400:]}")
    return wall, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def our_answer(folder):
    """Steps, and temperatures at the end."""
    with open(os.path.join(folder, "out", "history.csv"), newline="", encoding="utf-8") as file:
        row = list(csv.DictReader(file))[-1]
    names = {title.split(" [")[0]: title for title in row}
    return int(float(row[names["step"]])), {name: float(row[names[name]]) for name in EXACT}


def ccx_answer(folder, step):
    """The same; the last three rows of two numbers are the nodes in their order."""
    with open(os.path.join(folder, "quench.dat"), encoding="utf-8") as file:
        rows = [line.split() for line in file if len(line.split()) == 2 and line.split()[0].isdigit()]
    return round(20/step), {name: float(row[1]) for name, row in zip(EXACT, rows[-3:])}


def main():
    """Run all in turns, print a table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--out", default=None)
    options = parser.parse_args()
    home = tempfile.mkdtemp(prefix="heat-bench-", dir=options.out)
    jobs = [(f"THETA {theta}, steps to {step} s", our_deck(theta, step), None) for theta, step in SCHEMES]
    if shutil.which("ccx"):
        jobs += [(f"CalculiX, steps of {step} s", ccx_deck(step), step) for step in CCX_STEPS]
    else:
        print("heat_bench: ccx is not installed: without it", file=sys.stderr)
    times = {}
    for turn in range(options.repeat):
        for k, (_, text, step) in enumerate(jobs):
            folder = os.path.join(home, f"{turn}-{k}")
            os.makedirs(folder)
            with open(os.path.join(folder, "quench.lag" if step is None else "quench.inp"), "w", encoding="utf-8") as file:
                file.write(text)
            command = [LAGAMINE, "quench.lag", "--out", "out", "--quiet", "--threads", "1"] if step is None else ["ccx", "-i", "quench"]
            times.setdefault(k, []).append((timed(command, folder), our_answer(folder) if step is None else ccx_answer(folder, step)))
    shutil.rmtree(home)
    print("| run | steps | centre [K] | side [K] | corner [K] | wall [ms] | processor [ms] |\n|---|---|---|---|---|---|---|")
    for k, (name, _, _) in enumerate(jobs):
        count, found = times[k][0][1]
        wall, processor = (min(seconds[i] for seconds, _ in times[k]) for i in (0, 1))
        print(f"| {name} | {count} | " + " | ".join(f"{found[place] - EXACT[place]:+.3f}" for place in EXACT)
              + f" | {1000*wall:.0f} | {1000*processor:.0f} |")


if __name__ == "__main__":
    main()
