#!/usr/bin/env python3
"""The remesher's time grows about as the number of elements: on 2 000 and on 8 000 of them, as tests/bench/remdata_bench.py does it.

usage: run_growth.py [-v] [-k]     seconds of the processor, least of three runs; the limit is wide, for a machine that is at work
"""
import os
import sys

sys.dont_write_bytecode = True
TESTS = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path[:0] = [os.path.join(TESTS, "runs"), os.path.join(TESTS, "bench")]
from remdata_bench import exponent, measure  # noqa: E402
from support import Checks  # noqa: E402

MESHES = [(36, 54), (73, 110)]
TASKS = ["read", "contour", "sizes", "zones", "mesh", "free", "transfer", "contact", "write"]
LARGEST_EXPONENT = 1.5  # 1.0 measured; all pairs of elements would be 2


def main():
    checks = Checks()
    found = [measure(mesh, 3, checks.path()) for mesh in MESHES]
    for old, new, least in found:
        checks.that(list(least)[:len(TASKS)] == TASKS, f"{old} elements: seconds of all tasks", list(least))
        whole = sum(least[task] for task in TASKS)
        checks.that(0 < whole <= least["wall"], f"{old} elements: the tasks are part of the wall's seconds",
                    f"{whole} of {least['wall']}")
        checks.that(0.8 * old < new < 1.5 * old, f"{old} elements: about as many new ones", new)
    growth = exponent(found[0], found[1], "processor")
    checks.that(growth < LARGEST_EXPONENT, f"seconds grow slower than n^{LARGEST_EXPONENT}", f"n^{growth:.2f}")
    checks.end()


if __name__ == "__main__":
    main()
