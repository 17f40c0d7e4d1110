#!/usr/bin/env python3
"""Scenes with elements that may be longer than wide in thin parts: what REMSH's row STRETCH saves, and what it costs.

usage: stretch_study.py [NAME...] [--limit SECONDS] [--fresh]      default: springback can h_section piercing

Each scene runs as it is, with the rows that REMSH alone means, and with STRETCH 1, 2 and 3; errors of the force are those of scenes_study.py, against
the scene with elements of half the size and STRETCH 1. Prints a table; seconds are those of processor, programs and files and all.
"""
import csv
import os
import re
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import scenes_study as study  # noqa: E402

NAMES, RATIOS = ("springback", "can", "h_section", "piercing"), (1, 2, 3)
FINEST = 0.5


def deck(name, factor, ratio):
    """The scene with sizes so many times its own, and rows for all that REMSH alone means."""
    sizes = re.search(r"elements of ([-+.eE0-9]+) to ([-+.eE0-9]+), at most (\d+)", study.checked(name))
    rows = (f"REMSH\n{study.ERROR}{study.LIMITS}   SIZE {float(sizes[1]) * factor:.6g} {float(sizes[2]) * factor:.6g}\n"
            f"   COUNT {round(int(sizes[3]) / factor**2)}\n   STRETCH {ratio}.\n")
    return study.scaled(name, 1.0, rows)


def meshes_of(out):
    """Accepted meshes, tries refused, elements in the mean over meshes."""
    with open(os.path.join(out, "cycle.csv"), encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    taken = [int(row["new_elements [-]"]) for row in rows if row["accepted"] == "y" and row["new_elements [-]"]]
    return len(taken), sum(row["accepted"] == "n" for row in rows), sum(taken) / max(len(taken), 1)


def main():
    words = sys.argv[1:]
    limit = float(words[words.index("--limit") + 1]) if "--limit" in words else 600.0
    names = [word for word in words if word in study.SCENES] or list(NAMES)
    print("| scene | STRETCH | meshes | tries refused | elements, mean | processor s | error of the force % |")
    print("|---|---|---|---|---|---|---|")
    for name in names:
        fine = study.made(name, "stretch finest", deck(name, FINEST, 1), limit, "--fresh" in words)
        for ratio in RATIOS:
            found = study.made(name, f"stretch {ratio}", deck(name, 1.0, ratio), limit, "--fresh" in words)
            error = study.error_of(found, fine) if fine["code"] == found["code"] == 0 else None
            meshes, refused, elements = meshes_of(found["out"])
            print(f"| {name} | {ratio} | {meshes} | {refused} | {elements:.0f} | {found['seconds']:.1f} | "
                  f"{'-' if error is None else f'{100 * error:.2f}'} |", flush=True)


if __name__ == "__main__":
    main()
