#!/usr/bin/env python3
"""Results are the same bits for any number of threads: history, fields, XDMF and checkpoint of the upsetting deck.

usage: run_threads.py [-v] [-k]       -v prints every check, -k keeps the results
"""
import sys

sys.dont_write_bytecode = True
from support import DONE, UPSETTING, Checks, mesh, result_differences, run, said, summary, with_h5py  # noqa: E402


def main():
    with_h5py()
    checks = Checks()
    # The deck as it is; a mesh of an odd number of elements with more threads than divide it; the first steps of one so large that
    # the linear solver shares its fronts out, too.
    for name, options, numbers in (("12x18", [], (1, 2)), ("7x11", mesh(7, 11), (1, 2, 3, 8)),
                                   ("30x45", mesh(30, 45) + ["-p", "travel=0.5"], (1, 2, 3))):
        for threads in numbers:
            out = checks.path(name, str(threads))
            result = run([UPSETTING, "--threads", str(threads), "--out", out] + options)
            checks.that(result.returncode == DONE, f"{name}, {threads} threads: done", said(result))
            if result.returncode == DONE:
                checks.that(summary(out)["threads"] == threads, f"{name}: {threads} threads asked for and used",
                            summary(out)["threads"])
        for threads in numbers[1:]:
            wrong = result_differences(checks.path(name, "1"), checks.path(name, str(threads)))
            checks.that(not wrong, f"{name}: the same bits with 1 and {threads} threads", "; ".join(wrong))
    checks.end()


if __name__ == "__main__":
    main()
