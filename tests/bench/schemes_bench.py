#!/usr/bin/env python3
"""What the schemes in time cost and reach where phases form: the table of THETA in the manual.

usage: schemes_bench.py [--write]

Two decks of quenching by implicit Euler and TR-BDF2 with tolerances, against TR-BDF2 with TOL 0.003: quench_16mnd5 with steps that may grow
(the largest error of three temperatures at 20 and 30 s), and tempering (the temperature of the core at 10 s, its axial stress as quenched, at
200 s). Seconds of the processor, the least of three runs in turns, on one thread. --write puts the table into the manual.
"""
import csv
import os
import re
import resource
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
MANUAL = os.path.join(ROOT, "decks", "README.md")
LAGAMINE = os.path.join(os.environ.get("LAGAMINE_BIN") or os.path.join(ROOT, "build", "bin"), "lagamine")
EXACT, SCHEMES = "TRBDF2 TOL 0.003", [f"{scheme} TOL {tol}" for scheme in ("1.", "TRBDF2") for tol in ("3.", "1.", "0.1")]
REPEAT = 3
# Deck, its lines that are replaced, the times that steps hit, and what is compared: (columns, times)
CASES = (("quench_16mnd5", {"STRAT": "0.01 1.E-5 20. 14 9 0.25 2.", "STOP": "30.", "SAVE": "TIMES 20."},
          [(("side", "near", "core"), (20.0, 30.0))], ("finish", "step", "scheme")),
         ("tempering", {"SAVE": "TIMES 10. 200."}, [(("t_core",), (10.0,)), (("core",), (200.0,))], ("tol",)))


def deck(name, changes, unused, scheme, folder):
    """A deck with another scheme and these cards; parameters that nothing is left to use go."""
    with open(os.path.join(ROOT, "decks", name, name + ".lag"), encoding="utf-8") as file:
        text = file.read()
    for card, rest in {**changes, "THETA": scheme}.items():
        text = re.sub(rf"^{card} .*$", f"{card}   {rest}", text, flags=re.MULTILINE)
    for parameter in unused:
        text = re.sub(rf"^PARAM +{parameter} .*\n", "", text, flags=re.MULTILINE)
    text = text.replace("../", os.path.join(ROOT, "decks") + os.sep)
    text = re.sub(r"^( +STEEL +)(\w)", rf"\1{os.path.join(ROOT, 'decks', name)}/\2", text, flags=re.MULTILINE)
    path = os.path.join(folder, name + ".lag")
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    return path


def run(path, out):
    """Seconds of the processor, and the history by columns."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([LAGAMINE, path, "--out", out, "--quiet"], check=True, env={**os.environ, "OMP_NUM_THREADS": "1"})
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    with open(os.path.join(out, "history.csv"), newline="", encoding="utf-8") as file:
        titles, *rows = csv.reader(file)
    columns = {title.partition(" [")[0]: [float(row[k]) for row in rows] for k, title in enumerate(titles)}
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, columns


def at(columns, name, time):
    """The value at an instant that a step has hit."""
    k = min(range(len(columns["time"])), key=lambda i: abs(columns["time"][i] - time))
    assert abs(columns["time"][k] - time) < 1e-9 * time, (name, time)
    return columns[name][k]


def main():
    cells = {scheme: [] for scheme in SCHEMES}
    with tempfile.TemporaryDirectory() as folder:
        for name, changes, compared, unused in CASES:
            _, exact = run(deck(name, changes, unused, EXACT, folder), os.path.join(folder, "exact"))
            seconds, found = {scheme: [] for scheme in SCHEMES}, {}
            for _ in range(REPEAT):
                for scheme in SCHEMES:
                    spent, found[scheme] = run(deck(name, changes, unused, scheme, folder), os.path.join(folder, "run"))
                    seconds[scheme].append(spent)
            for scheme in SCHEMES:
                cells[scheme].append(f"{len(found[scheme]['time'])}, {min(seconds[scheme]):.1f}")
                for names, times in compared:
                    error = max(abs(at(found[scheme], one, time) - at(exact, one, time)) for one in names for time in times)
                    cells[scheme].append(f"{error:.2g}")
    rows = [f"| `THETA {scheme}` | " + " | ".join(cells[scheme]) + " |" for scheme in SCHEMES]
    print("\n".join(rows))
    if "--write" in sys.argv[1:]:
        with open(MANUAL, encoding="utf-8") as file:
            text = file.read()
        head = re.search(r"^\| \| 16MND5: steps.*\n\|---.*\n", text, re.MULTILINE).end()
        with open(MANUAL, "w", encoding="utf-8") as file:
            file.write(text[:head] + "\n".join(rows) + "\n" + re.sub(r"^(\|.*\n)*", "", text[head:]))


if __name__ == "__main__":
    main()
