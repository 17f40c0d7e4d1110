#!/usr/bin/env python3
"""Memory that is refused: whatever the limit of the process, a run that can begin ends well or with 5 and a line; it never hangs, and no
library or signal ends it.

usage: run_memory.py [-v] [-k]       -v prints every check, -k keeps the results
"""
import os
import re
import resource
import subprocess
import sys

sys.dont_write_bytecode = True
from support import DONE, LAGAMINE, MACHINE, UPSETTING, Checks, mesh, said  # noqa: E402

MEGA = 2**20
LONGEST = 60     # seconds of processor time, and on the wall
STRANGE = ("Backtrace", "Fortran runtime", "Error allocating", "OpenBLAS", "SIG", "terminate", "Memory allocation failed")


def limited(size, arguments):
    """A run that may have so many bytes of address space."""
    def limit():
        resource.setrlimit(resource.RLIMIT_CPU, (LONGEST, LONGEST))
        resource.setrlimit(resource.RLIMIT_AS, (size, size))
    return subprocess.run([LAGAMINE] + arguments, preexec_fn=limit, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, text=True, timeout=LONGEST, check=False,
                          env=dict(os.environ, OPENBLAS_NUM_THREADS="1"))


def begins(size):
    """Is the limit enough for the libraries to be loaded, and a little more?"""
    return limited(size, ["--version"]).returncode == DONE


def main():
    checks = Checks()
    run = [UPSETTING, "--out", checks.path("out"), "--quiet", "-p", "travel=0.05", "--threads", "1"] + mesh(40, 40)
    least = next(size for size in range(16, 4096, 2) if begins(size*MEGA))
    enough, refused, done = None, 0, 0
    for more in list(range(0, 40, 2)) + list(range(40, 400, 8)):
        result = limited((least + more)*MEGA, run)
        lines = result.stderr.splitlines()
        what = f"{more} MB more than the least"
        checks.that(result.returncode in (DONE, MACHINE), f"{what}: done, or 5", said(result))
        checks.that(not any(word in result.stderr for word in STRANGE), f"{what}: no word from libraries", result.stderr[:300])
        if result.returncode == MACHINE:
            refused += 1
            checks.that(1 <= len(lines) <= 2 and "not enough memory" in lines[0] and re.search("[0-9] MB", lines[0]),
                        f"{what}: a line with what was asked for", result.stderr[:300])
            checks.that(enough is None, f"{what}: less was enough", f"{enough} MB")
        elif result.returncode == DONE:
            done += 1
            enough = enough or more
        if done > 3:
            break
    checks.that(refused > 10 and done > 3, "limits on both sides of what is enough", f"{refused} refused, {done} done")
    reported = limited(2**40, [UPSETTING, "--check"]).stdout
    checks.that(re.search(r"(?m)^Factors: .*memory about [0-9.]+ MB$", reported) and re.search(r"(?m)^Memory left: [0-9.e+]+ MB", reported),
                "--check states what is needed, and what is left", reported[-400:])
    refused = limited((least + 60)*MEGA, [UPSETTING, "--check"] + mesh(300, 300))
    checks.that(refused.returncode == MACHINE and "not enough memory" in refused.stderr and "effect     displacement" in refused.stdout,
                "--check of a mesh that is too large for the memory says what the deck holds", said(refused) + refused.stdout[-300:])
    checks.end()


if __name__ == "__main__":
    main()
