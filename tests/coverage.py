#!/usr/bin/env python3
"""Share of the lines of src/ and remdata/ that ran, file by file, from a build with the preset `coverage`.

usage: coverage.py [BUILD] [--lines]
BUILD: the build folder (default: build-coverage of the project). --lines also names the lines that did not run.
Counts are those of gcov, which comes with the compiler. Ends with 2 if there is nothing to count.
"""
import json
import os
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
LOW = 80.0      # per cent: files below are named once more


def notes(build):
    """The compiler's notes of all objects of our own sources."""
    for top in ("src", "remdata"):
        for folder, _, files in os.walk(os.path.join(build, top)):
            for file in files:
                if file.endswith(".gcno"):
                    yield os.path.join(folder, file)


def count(note, lines):
    """Add what gcov says of an object: how often each line of a file ran."""
    said = subprocess.run(["gcov", "--json-format", "--stdout", note], cwd=os.path.dirname(note), stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, text=True, check=False)
    if said.returncode != 0:
        sys.exit(f"coverage.py: gcov: {said.stderr.strip()}")
    for answer in said.stdout.splitlines():
        for file in json.loads(answer)["files"]:
            path = os.path.relpath(os.path.join(os.path.dirname(note), file["file"]), ROOT)
            if path.startswith("..") or path.startswith("build"):
                continue
            counts = lines.setdefault(path, {})
            for line in file["lines"]:
                number = line["line_number"]
                counts[number] = counts.get(number, 0) + line["count"]


def spans(numbers):
    """Line numbers as text, neighbours together: 3-5 9."""
    text = []
    for number in numbers:
        if text and text[-1][1] == number - 1:
            text[-1][1] = number
        else:
            text.append([number, number])
    return " ".join(str(a) if a == b else f"{a}-{b}" for a, b in text)


def main(arguments):
    with_lines = "--lines" in arguments
    places = [argument for argument in arguments if argument != "--lines"]
    if len(places) > 1 or places and places[0].startswith("-"):
        print(__doc__, file=sys.stderr)
        return 2
    lines = {}
    for note in sorted(notes(places[0] if places else os.path.join(ROOT, "build-coverage"))):
        count(note, lines)
    lines = {path: counts for path, counts in lines.items() if counts}
    if not lines:
        print("coverage.py: no counts: sh tests/run.sh --coverage builds and runs what is counted", file=sys.stderr)
        return 2
    table = []
    for path, counts in lines.items():
        table.append((100*sum(n > 0 for n in counts.values())/len(counts), path))
    print(f"{'lines':>7} {'run':>7}          file")
    for share, path in sorted(table, key=lambda row: row[1]):
        counts = lines[path]
        print(f"{len(counts):7d} {sum(n > 0 for n in counts.values()):7d} {share:6.1f} %  {path}")
        if with_lines and share < 100:
            print(" "*26 + "not: " + spans(sorted(number for number, n in counts.items() if n == 0)))
    total = sum(map(len, lines.values()))
    ran = sum(n > 0 for counts in lines.values() for n in counts.values())
    print(f"{total:7d} {ran:7d} {100*ran/total:6.1f} %  all {len(table)} files")
    low = sorted(row for row in table if row[0] < LOW)
    print(f"below {LOW:.0f} %: " + (", ".join(f"{path} ({share:.0f} %)" for share, path in low) or "none"))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
