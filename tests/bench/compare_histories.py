#!/usr/bin/env python3
"""Histories of all decks by two builds: the same to the last bit, or how far apart.

usage: compare_histories.py FOLDER OTHER [-t N] [DECK...]

FOLDER and OTHER are the `bin` folders of two builds, DECK decks (default: all of decks/; those with a REMSH card run by `lagacycle`).
Both use the same number of threads (-t, default 1). A row per deck: exit codes, steps and iterations of both, and the largest
difference of a column over the column's largest value (0: the same bits). Ends with 0 if all histories agree to the last bit, or to
1e-10 with the same iteration counts.
"""
import csv
import glob
import os
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
LONGEST = 1800  # seconds
AGREES = 1e-10


def run(folder, deck, out, threads):
    """Exit code and rows of the history of a deck."""
    with open(deck, encoding="utf-8") as file:
        remeshed = any(line.startswith("REMSH") for line in file)
    program = os.path.join(folder, "lagacycle" if remeshed else "lagamine")
    done = subprocess.run([program, deck, "--out", out, "--threads", threads], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                          timeout=LONGEST)
    path = os.path.join(out, "history.csv")
    if not os.path.exists(path):
        return done.returncode, []
    with open(path, newline="", encoding="utf-8") as file:
        return done.returncode, list(csv.reader(file))


def difference(one, other):
    """Largest difference of a column over its largest value; None where the tables have other columns or rows."""
    if not one or not other or one[0] != other[0] or len(one) != len(other):
        return None
    worst = 0.0
    for a, b in zip(zip(*one[1:]), zip(*other[1:])):
        a, b = [float(x) for x in a], [float(x) for x in b]
        size = max(map(abs, a + b), default=0.0)
        if size > 0:
            worst = max(worst, max(abs(x - y) for x, y in zip(a, b))/size)
    return worst


def iterations(rows):
    """Iterations of a run."""
    k = rows[0].index("iterations [-]")
    return sum(int(row[k]) for row in rows[1:])


def main(words):
    threads, decks, folders = "1", [], []
    while words:
        word = words.pop(0)
        if word == "-t":
            threads = words.pop(0)
        elif len(folders) < 2:
            folders.append(word)
        else:
            decks.append(word)
    if len(folders) < 2:
        print(__doc__, file=sys.stderr)
        return 2
    decks = decks or sorted(glob.glob(os.path.join(ROOT, "decks", "*", "*.lag")))
    bad = 0
    print("| deck | exit | steps | iterations | difference |")
    print("|---|---|---|---|---|")
    for deck in decks:
        with tempfile.TemporaryDirectory() as place:
            results = [run(folder, deck, os.path.join(place, str(k)), threads) for k, folder in enumerate(folders)]
        (code, rows), (other_code, other_rows) = results
        if not rows and not other_rows and code == other_code:
            continue   # paths of points have no history
        apart = difference(rows, other_rows)
        same = code == other_code and apart is not None and (apart == 0 or apart < AGREES and iterations(rows) == iterations(other_rows))
        bad += not same
        counts = [f"{len(r) - 1} | {iterations(r)}" if r else "- | -" for r in (rows, other_rows)]
        print(f"| {os.path.basename(deck)[:-4]} | {code}{'' if code == other_code else f' / {other_code}'} | "
              f"{counts[0] if counts[0] == counts[1] else ' / '.join(counts)} | "
              f"{'other columns or rows' if apart is None else f'{apart:.1e}' if apart else 'same bits'} |", flush=True)
    print(f"\n{len(decks) - bad} of {len(decks)} agree")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
