#!/usr/bin/env python3
"""Cards with many rows are read in a time that grows with their number, not with its square.

usage: run_long_cards.py [-v] [-k] [ROWS]      -v prints every time; ROWS of the shorter deck, default 10000
For each kind of card: processor time of `--check` with twice the rows over that with ROWS, the least of three each, in turns; of up to
nine where the ratio is too large. A quadratic part that matters brings it near 4.
"""
import math
import os
import subprocess
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "runs"))
from support import DONE, LAGAMINE, Checks, write  # noqa: E402

LARGEST_RATIO, REPEATS, MOST = 3.0, 3, 9

HEAD = """TITLE  Long cards
STATE  PLSTN
KINEM  LOG
"""
BLOCK = """BLOCK  block PL8LS 4 steel
   0. 0.   10. 0.   10. 5.   0. 5.
   1 1.   1 1.
FIXED  block 1 XY
"""
LAW = """LAW    steel ELA
   200000. 0.3
"""
LOAD = """MOVE   block 3 Y press 0.01
"""
LIC = """LIC    press
   0. 0.   1. 1.
"""
END = """STRAT  0.1 1.E-5 1.   4 3
END
"""
CONTACT = """LAW    rough COUL2D
   PHI 0.1
CNT2D  block 3 die 2 rough
"""


def rows(lines):
    return "".join(f"   {line}\n" for line in lines)


def die(n):
    return HEAD + BLOCK + LAW + LOAD + LIC + CONTACT + "DIE    die\n" + rows(
        f"SEGM {100 - 200*k/n!r} 20. {100 - 200*(k + 1)/n!r} 20." for k in range(n)) + END


def body(n):
    x = [(10*math.cos(2*math.pi*k/n), 10*math.sin(2*math.pi*k/n)) for k in range(n)] + [(10.0, 0.0)]
    return HEAD + LAW + LIC + "BODY   block PL8LS 9 steel\n" + rows(
        f"SEGM {x[k][0]!r} {x[k][1]!r} {x[k + 1][0]!r} {x[k + 1][1]!r}" for k in range(n)) + (
            "FIXED  block 1 XY\nMOVE   block 3 Y press 0.01\nREMSH\n   SIZE 0.1 1.\n") + END


def multiplier(n):
    return HEAD + BLOCK + LAW + LOAD + "LIC    press\n" + rows(f"{k/n!r} {math.sin(k)!r}" for k in range(n + 1)) + END


def table(n):
    return HEAD + BLOCK + LOAD + LIC + f"LAW    steel EPLA\n   200000. 0.3\n   TABLE {n}\n" + rows(
        f"{k/n!r} {300 + 10*k/n!r}" for k in range(n)) + END


def temperatures(n):
    return HEAD + BLOCK + LOAD + LIC + "TEMPE  block 20. press\nLAW    steel ELA\n" + "".join(
        f"   TEMP {20 + k}.\n   {200000 - k}. 0.3\n" for k in range(n)) + END


def elements(n):
    """A strip of n elements, all nodes and sides written out."""
    x = [f"{3*k + 1} {k/2!r} 0.\n   {3*k + 2} {k/2!r} 1." for k in range(2*n + 1)]
    middles = [f"{3*k + 3} {k/2!r} 0.5" for k in range(0, 2*n + 1, 2)]
    cells = []
    for e in range(n):
        a, m, b = 3*(2*e), 3*(2*e + 1), 3*(2*e + 2)
        cells.append(f"{e + 1} {a + 1} {b + 1} {b + 2} {a + 2} {m + 1} {b + 3} {m + 2} {a + 3}")
    return (HEAD + LAW + LIC + "NODES\n" + rows(x) + rows(middles) + "PL8LS  block 4 steel\n" + rows(cells) + "SIDES  under\n"
            + rows(f"{e + 1} 1" for e in range(n)) + "SIDES  above\n" + rows(f"{e + 1} 3" for e in range(n))
            + "FIXED  under XY\nMOVE   above Y press 0.01\n" + END)


FAMILIES = {"DIE": die, "BODY": body, "LIC": multiplier, "EPLA TABLE": table, "TEMP": temperatures, "NODES, PL8LS, SIDES": elements}


def seconds(deck):
    """Processor time of a check, and how it ended."""
    process = subprocess.Popen([LAGAMINE, deck, "--check"], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                               stderr=subprocess.PIPE, text=True)
    said = process.stderr.read()
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    process.stderr.close()
    return usage.ru_utime + usage.ru_stime, process.returncode, said


def main():
    checks = Checks()
    n = next((int(word) for word in sys.argv[1:] if word.isdigit()), 10000)
    for name, deck_of in FAMILIES.items():
        decks = {count: write(checks.path(f"deck{count}.lag"), deck_of(count)) for count in (n, 2*n)}
        least = dict.fromkeys(decks, math.inf)
        for k in range(MOST):
            for count, deck in decks.items():
                took, *ended = seconds(deck)
                least[count] = min(least[count], took)
                if k == 0:
                    checks.that(ended[0] == DONE, f"{name}, {count} rows: read", ended)
            # a busy machine is no quadratic part: it is looked at again
            if k + 1 >= REPEATS and least[2*n] < LARGEST_RATIO*least[n]:
                break
        ratio = least[2*n]/least[n]
        checks.that(ratio < LARGEST_RATIO, f"{name}: {least[n]:.3f} s for {n} rows, {least[2*n]:.3f} s for {2*n}: ratio {ratio:.2f}")
    checks.end()


if __name__ == "__main__":
    main()
