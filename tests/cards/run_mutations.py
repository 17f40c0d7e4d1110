#!/usr/bin/env python3
"""Slips of the finger on a good deck: whatever is typed, `lagamine --check` accepts or refuses it, and never crashes.

usage: run_mutations.py [COUNT [SEED]]        default 400 and 1: the same decks every time
LAGAMINE_BIN is the folder of `lagamine` (default: build/bin of this project). Damages tests/refused/base.lag: lines are
dropped, doubled, swapped; fields are dropped, doubled, swapped, replaced by numbers and words from elsewhere.
"""
import os
import random
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
BIN = os.environ.get("LAGAMINE_BIN") or os.path.join(HERE, "..", "..", "build", "bin")
STRANGE = ["0", "-1", "1.E300", "-1.E-300", "1/3", "99999999999", "$nx", "X", "'a b'", "0.5", "2", "pi", "NODE", "POINT", "3.", "inf"]


def mutate(lines, draw):
    """One slip on a copy of the lines."""
    lines = list(lines)
    at = draw.randrange(len(lines))
    kind = draw.randrange(8)
    fields = lines[at].split()
    start = "   " if lines[at].startswith(" ") else ""
    if kind == 0:
        del lines[at]
        return lines
    if kind == 1:
        lines.insert(draw.randrange(len(lines)), lines[at])
        return lines
    if kind == 2:
        other = draw.randrange(len(lines))
        lines[at], lines[other] = lines[other], lines[at]
        return lines
    if not fields:      # a line that earlier slips have emptied
        return lines
    k = draw.randrange(len(fields))
    if kind == 3:
        del fields[k]
    elif kind == 4:
        fields.insert(k, fields[k])
    elif kind == 5:
        fields[k] = draw.choice(STRANGE)
    elif kind == 6:
        fields[k] = draw.choice(draw.choice(lines).split() or ["1"])
    else:
        other = draw.randrange(len(fields))
        fields[k], fields[other] = fields[other], fields[k]
    lines[at] = start + " ".join(fields)
    return lines


def main():
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 400
    draw = random.Random(int(sys.argv[2]) if len(sys.argv) > 2 else 1)
    base = open(os.path.join(HERE, "..", "refused", "base.lag")).read().splitlines()
    passed = failed = refused = 0
    with tempfile.TemporaryDirectory() as folder:
        for number in range(count):
            lines = base
            for _ in range(draw.choice([1, 1, 1, 2, 4])):
                lines = mutate(lines, draw)
            with open(os.path.join(folder, "deck.lag"), "w") as deck:
                deck.write("\n".join(lines) + "\n")
            run = subprocess.run([os.path.join(BIN, "lagamine"), "deck.lag", "--check"], cwd=folder, text=True, timeout=60,
                                 stdout=subprocess.PIPE, stderr=subprocess.STDOUT, errors="replace")
            reported = [line for line in run.stdout.splitlines() if line.startswith("deck.lag")]
            good = run.returncode == 0 or (run.returncode == 2 and reported)
            passed += bool(good)
            failed += not good
            refused += run.returncode == 2
            if not good:
                print(f"FAILED deck {number}: exit code {run.returncode}\n{run.stdout[:1500]}")
                print("\n".join(line for line in lines if line not in base))
    print(f"{refused} of {count} decks refused")
    print(f"{passed} passed, {failed} failed")
    return 1 if failed or not passed else 0


if __name__ == "__main__":
    sys.exit(main())
