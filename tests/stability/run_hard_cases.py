#!/usr/bin/env python3
"""Hard cases that must stay stable: a table of survival.

usage: run_hard_cases.py [-v] [-k] [-a] [--table FILE] [NAME...]     -a long cases too, --table writes the table as CSV

Every case has a closed form, an invariance, or a finer run beside it; `off` is how far the program is from it, `bound` how far it may be.
"""
import sys
import time

sys.dont_write_bytecode = True
import hard_heat  # noqa: E402
import hard_mechanics  # noqa: E402
from hard_support import Hard  # noqa: E402


def main(words):
    checks = Hard()
    wanted = [word for word in words if not word.startswith("-")]
    rows = []
    for case in hard_mechanics.CASES + hard_heat.CASES:
        if wanted and not any(word in case.name for word in wanted):
            continue
        begun, steps, iterations = time.time(), checks.steps, checks.iterations
        try:
            off = case.run(checks)
        except RuntimeError as failure:
            print(f"{case.name}: {failure}")
            off = float("nan")
        checks.that(off <= case.bound, case.name, f"off {off:.2e}, bound {case.bound:.0e}")
        rows.append((case.name, off, case.bound, checks.steps - steps, checks.iterations - iterations, time.time() - begun))
        print("| %-26s | %.1e | %.0e | %d | %d | %.1f |" % rows[-1], flush=True)
    checks.end()


if __name__ == "__main__":
    main(sys.argv[1:])
