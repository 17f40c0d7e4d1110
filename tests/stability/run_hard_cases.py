#!/usr/bin/env python3
"""Hard cases that must stay stable: a table of survival.

usage: run_hard_cases.py [-v] [-k] [-a] [--table FILE] [NAME...]     -a long cases too, --table writes the table as CSV

Every case has a closed form, an invariance, or a finer run beside it; `off` is how far the program is from it, `bound` how far it may be.
"""
import csv
import sys
import time

sys.dont_write_bytecode = True
import hard_free  # noqa: E402
import hard_heat  # noqa: E402
import hard_loads  # noqa: E402
import hard_mechanics  # noqa: E402
from hard_support import Hard  # noqa: E402


TITLES = ("case", "off", "bound", "steps", "iterations", "seconds", "ok")


def main(words):
    checks = Hard()
    table = words.pop(words.index("--table") + 1) if "--table" in words else None
    wanted = [word for word in words if not word.startswith("-")]
    rows = []
    print("| %s |\n|%s" % (" | ".join(TITLES), "---|"*len(TITLES)))
    for case in hard_mechanics.CASES + hard_free.CASES + hard_loads.CASES + hard_heat.CASES:
        if any(word in case.name for word in wanted) if wanted else ("-a" in words or not case.long):
            begun, steps, iterations = time.time(), checks.steps, checks.iterations
            try:
                off = case.run(checks)
            except RuntimeError as failure:
                print(failure)
                off = float("nan")
            holds = checks.that(off <= case.bound, case.name, f"off {off:.2e}, bound {case.bound:.0e}")
            rows.append((case.name, "%.1e" % off, "%.0e" % case.bound, checks.steps - steps, checks.iterations - iterations,
                         "%.1f" % (time.time() - begun), "yes" if holds else "NO"))
            print("| %s |" % " | ".join(map(str, rows[-1])), flush=True)
    if table:
        with open(table, "w", newline="", encoding="utf-8") as file:
            csv.writer(file).writerows([TITLES] + rows)
    checks.end()


if __name__ == "__main__":
    main(sys.argv[1:])
