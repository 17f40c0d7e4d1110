#!/usr/bin/env python3
"""What the remesher costs: its seconds by task on meshes of 500 to 50 000 elements, how they grow, and its share of a cycle.

usage: remdata_bench.py [--repeat N] [--most N] [--no-cycle] [--write]      about 6 minutes; --write renews the tables in
tests/bench/README.md. --most: no mesh of more elements (a look while working).

Every mesh is that of decks/upsetting_remesh after its first step or steps against the sticking die, so that state, contact and
errors are there; the new mesh has about as many elements. One thread; the least of N runs (3). Exit code 1 when a limit is passed.
"""
import argparse
import csv
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
OUT = os.path.join(ROOT, "out", "bench", "remdata")
README = os.path.join(HERE, "README.md")
BEGIN, END = "<!-- remdata: written by remdata_bench.py --write -->", "<!-- remdata: end -->"
RADIUS, HALF_HEIGHT = 10.0, 15.0
# First meshes: 486, 1 944, 5 046, 12 558 and 50 142 elements. The cycle is that of the third, to half the height.
MESHES = [(18, 27), (36, 54), (58, 87), (91, 138), (183, 274)]
CYCLE, TRAVEL, TIMES = (58, 87), 7.5, "0.15 0.3 0.45 0.6 0.75 0.9"
LARGEST_EXPONENT, LARGEST_SHARE = 1.2, 0.05


def deck(path, mesh, changes):
    """Write the deck with other divisions and other lines; changes: first words of a line, what stands there instead."""
    with open(os.path.join(ROOT, "decks", "upsetting_remesh", "upsetting_remesh.lag"), encoding="utf-8") as file:
        lines = file.read().splitlines()
    changes = {"PARAM  nx ": f"PARAM  nx {mesh[0]}", "PARAM  ny ": f"PARAM  ny {mesh[1]}", **changes}
    for start, line in changes.items():
        places = [k for k, old in enumerate(lines) if old.startswith(start)]
        if len(places) != 1:
            sys.exit(f"the deck has {len(places)} lines that begin with '{start}'")
        lines[places[0]] = line
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")


def run(program, *words, code=0):
    """Wall seconds, processor seconds and largest memory [MB] of a run that must end with this code."""
    start = time.perf_counter()
    process = subprocess.Popen([os.path.join(BIN, program), *words], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                               env={**os.environ, "OMP_NUM_THREADS": "1"})
    _, status, usage = os.wait4(process.pid, 0)
    wall = time.perf_counter() - start
    process.returncode = os.WEXITSTATUS(status) if os.WIFEXITED(status) else -os.WTERMSIG(status)
    if process.returncode != code:
        sys.exit(f"{program} {' '.join(words)}: exit code {process.returncode}, expected {code}")
    return wall, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024


def measure(mesh, repeat, folder):
    """A checkpoint on this mesh, and remdata on it: elements before and after, least seconds of all tasks and of the program."""
    size, out = RADIUS / mesh[0], os.path.join(folder, f"mesh{mesh[0]}")
    deck(out + ".lag", mesh, {"STRAT ": "STRAT  0.005  1.E-5  0.005   5 3", "   ERROR ": "   TIMES 0.005",
                              "   SIZE ": f"   SIZE {0.5 * size} {size}"})
    shutil.rmtree(out, ignore_errors=True)
    run("lagamine", out + ".lag", "--out", out, "--quiet", "--threads", "1", code=4)
    old, new, best = os.path.join(out, os.path.basename(out) + ".ckp.h5"), os.path.join(out, "new.h5"), None
    for _ in range(repeat):
        wall, seconds, memory = run("remdata", old, "--out", new, "--quiet")
        with open(new + ".json", encoding="utf-8") as file:
            facts = json.load(file)
        row = {**facts["seconds"], "wall": wall, "processor": seconds, "memory": memory}
        best = row if best is None else {key: min(row[key], best[key]) for key in row}
    return facts["old_elements"], facts["new_elements"], best


def exponent(one, other, key):
    """Growth between two meshes; elements are those of old and new mesh together."""
    (old, new, first), (old_later, new_later, last) = one, other
    return math.log(last[key] / first[key]) / math.log((old_later + new_later) / (old + new))


def growth(repeat, most):
    """Table of tasks, and whether the growth is within its limit."""
    meshes = [mesh for mesh in MESHES if mesh[0] * mesh[1] <= most]
    if len(meshes) < 2:
        sys.exit("growth is seen on two meshes at least")
    found = [measure(mesh, repeat, OUT) for mesh in meshes]
    tasks = list(found[0][2])
    names = {"wall": "wall", "processor": "processor", "memory": "memory MB"}
    lines = ["| elements | " + " | ".join(names.get(task, task) for task in tasks) + " |", "|---" * (len(tasks) + 1) + "|"]
    for old, new, best in found:
        cells = [f"{best[task]:.0f}" if task == "memory" else f"{best[task]:.4f}" for task in tasks]
        lines.append(f"| {old} -> {new} | " + " | ".join(cells) + " |")
    # the least meshes cost what starting a program costs
    start = next((one for one in found if one[0] >= 5000), found[0])
    for title, first in (("all", found[0]), (f"from {start[0]}", start)):
        if first is not found[-1] and (title == "all" or first is not found[0]):
            lines.append(f"| {title}: n^ | " + " | ".join(f"{exponent(first, found[-1], task):.2f}" for task in tasks) + " |")
    worst = max(exponent(first, found[-1], "processor") for first in (found[0], start) if first is not found[-1])
    passed = worst <= LARGEST_EXPONENT
    return lines, verdict(f"seconds of the processor grow no faster than n^{LARGEST_EXPONENT}", f"n^{worst:.2f}", passed), passed


def share_of_cycle():
    """Table of the cycle, and whether the share of the remesher is within its limit."""
    size, out = RADIUS / CYCLE[0], os.path.join(OUT, "cycle")
    deck(out + ".lag", CYCLE, {"PARAM  travel ": f"PARAM  travel {TRAVEL}", "   ERROR ": f"   TIMES {TIMES}",
                               "   LEAST ": f"   COUNT {CYCLE[0] * CYCLE[1]}", "   SIZE ": f"   SIZE {0.8 * size} {1.05 * size}"})
    shutil.rmtree(out, ignore_errors=True)
    wall, seconds, _ = run("lagacycle", out + ".lag", "--out", out, "--threads", "1")
    with open(os.path.join(out, "cycle.csv"), newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    if len(rows) < len(TIMES.split()) or any(row["accepted"] != "y" for row in rows):
        sys.exit(f"{len(rows)} tries at a new mesh, not all of them good: {[row['reason'] for row in rows]}")
    elements = sum(int(row["new_elements [-]"]) for row in rows) / len(rows)
    remdata, restart = (sum(float(row[key] or 0) for row in rows) for key in ("remdata [s]", "restart [s]"))
    lines = ["| cycle | new meshes | elements | wall s | processor s | remdata s | restarts s | remdata's share % |",
             "|---|---|---|---|---|---|---|---|",
             f"| to {100 * TRAVEL / HALF_HEIGHT:.0f} % | {len(rows)} | {elements:.0f} | {wall:.1f} | {seconds:.1f} | {remdata:.2f} | "
             f"{restart:.2f} | {100 * remdata / wall:.2f} |"]
    passed = remdata <= LARGEST_SHARE * wall
    return lines, verdict(f"remdata's share of a cycle of 5 000 elements <= {100 * LARGEST_SHARE:.0f} %",
                          f"{100 * remdata / wall:.2f} %", passed), passed


def verdict(limit, measured, passed):
    return f"| {limit} | {measured} | {'reached' if passed else 'MISSED'} |"


def processor():
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        return next((line.split(":")[1].strip() for line in file if line.startswith("model name")), "unknown processor")


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--most", type=int, default=10**6)
    parser.add_argument("--no-cycle", action="store_true")
    parser.add_argument("--write", action="store_true")
    options = parser.parse_args()
    if options.write and (options.no_cycle or options.most < MESHES[-1][0] * MESHES[-1][1]):
        parser.error("--write wants all meshes and the cycle")
    os.makedirs(OUT, exist_ok=True)
    parts = [growth(options.repeat, options.most)] + ([] if options.no_cycle else [share_of_cycle()])
    lines = [f"{time.strftime('%Y-%m-%d')}, {processor()}, one thread, the least of {options.repeat} runs of remdata; seconds."]
    for table, _, _ in parts:
        lines += ["", *table]
    lines += ["", "| limit | measured | |", "|---|---|---|"] + [line for _, line, _ in parts]
    print("\n".join(lines))
    if options.write:
        with open(README, encoding="utf-8") as file:
            head, rest = file.read().split(BEGIN)
        with open(README, "w", encoding="utf-8") as file:
            file.write(head + BEGIN + "\n" + "\n".join(lines) + "\n" + END + rest.split(END)[1])
    sys.exit(0 if all(passed for _, _, passed in parts) else 1)


if __name__ == "__main__":
    main()
