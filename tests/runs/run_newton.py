#!/usr/bin/env python3
"""Newton's method converges quadratically: read off the listing of upsetting (gluing, folding) and of a block that slides.

usage: run_newton.py [-v] [-k]       -v prints every check and the orders, -k keeps the results

Every accepted step is one or more sequences of residuals (a new one begins when contact is augmented). The last three of a
sequence, r1 > r2 > r3, have the order log(r3/r2)/log(r2/r1); it shows quadratic convergence from 1.6 on, since a step ends as
soon as it has converged and the last fall is seldom the first within reach of round-off. A sequence that ends below 1e-9 counts
as well, for what is round-off has no order. Sequences of fewer than three residuals are not judged; nor are those in which the
prescribed motion was still to be spread (the first residual of a step is then no residual of Newton's method).
Besides, each scene runs with FORCE 1E-11 and the fall of the residual below 1e-3 is judged in pairs: r(k+1) <= C r(k)^1.6, with
C from the pairs themselves; a tangent that is only nearly right shows up here as a constant rate.
"""
import math
import re
import sys

sys.dont_write_bytecode = True
from support import DONE, UPSETTING, Checks, add_cards, deck_text, run, said, write  # noqa: E402

ORDER, ROUND_OFF = 1.6, 1.0e-9

SLIDING = """TITLE  Block pressed down, then pushed sideways under Coulomb friction
STATE  PLSTN
KINEM  LOG
BLOCK  block PL8LS 4 steel
   0. 0.   20. 0.   20. 10.   0. 10.
   10 1.   5 1.
LAW    steel EPLA
   200000. 0.3
   LINEAR 400. 500.
LAW    rough COUL2D
   PENETR 1.E-3   PHI 0.2
DIE    upper PILOT 0. 10.
   SEGM  40. 10.   -20. 10.
CNT2D  block 3 upper 2 rough
FIXED  block 1 XY
LIC    down
   0. 0.   0.3 -0.3   1. -0.6
LIC    aside
   0. 0.   0.3 0.   1. 3.
MOVE   upper Y down
MOVE   upper X aside
STRAT  0.02 1.E-5 0.05   5 3
END
"""


def sequences(listing):
    """Residuals of all accepted steps, cut where an augmentation begins anew; and the number of points slipping."""
    found, slipping, now = [], 0, None
    for line in listing.splitlines():
        if line.startswith("step "):
            now = []
        elif line.startswith(("cut:", "event:")):
            now = None
        elif now is not None and re.match(r" +\d+ +\S+E", line):
            words = line.split()
            if len(words) > 2 and float(words[2]) == 0:
                found.append(now)
                now = []
            now.append((float(words[1]), float(words[3]) if len(words) > 3 else 1.0))
        elif now is not None and "strain increment" in line:
            found.append(now)
            slipping += int(re.search(r"(\d+) slip", line).group(1)) > 0
            now = None
    return [[residual for residual, _ in one] for one in found], slipping


def order(residuals):
    """Order of the last three residuals; None when there are no three that fall."""
    if len(residuals) < 3:
        return None
    first, second, third = residuals[-3:]
    if not first > second > third > 0:
        return None
    return math.log(third / second) / math.log(second / first)


def judge(checks, name, deck, least_share, options=()):
    """Share of the sequences that end quadratically."""
    out = checks.path(name)
    result = run([deck, "--out", out, "--threads", "1"] + list(options))
    if not checks.that(result.returncode == DONE, f"{name}: done", said(result)):
        return 0
    stem = deck.rsplit("/", 1)[1].replace(".lag", ".log")
    with open(f"{out}/{stem}", encoding="utf-8") as file:
        found, slipping = sequences(file.read())
    orders = [(order(one), one[-1]) for one in found]
    judged = [(p, last) for p, last in orders if p is not None]
    good = [last < ROUND_OFF or p >= ORDER for p, last in judged]
    share = sum(good) / max(len(judged), 1)
    median = sorted(p for p, _ in judged)[len(judged) // 2] if judged else float("nan")
    print(f"{name}: {sum(good)} of {len(judged)} sequences quadratic ({share:.0%}), median order {median:.2f}, "
          f"{len(found)} sequences, {slipping} steps with slip")
    checks.that(len(judged) >= 10, f"{name}: enough to judge", f"{len(judged)} sequences")
    checks.that(share >= least_share, f"{name}: share of quadratic ends at least {least_share:.0%}", f"{share:.0%}")
    checks.that(median >= ORDER, f"{name}: median order at least {ORDER}", f"{median:.2f}")
    return slipping


def tight(checks, name, text, least_share, options=()):
    """With the residual driven down to round-off: how it falls, pair by pair."""
    deck = write(checks.path(name + ".lag"), add_cards(text, "NORMS  FORCE 1.E-11   DISPL 1.E-9"))
    out = checks.path(name)
    result = run([deck, "--out", out, "--threads", "1"] + list(options))
    if not checks.that(result.returncode == DONE, f"{name}: done", said(result)):
        return
    with open(f"{out}/{name}.log", encoding="utf-8") as file:
        found, _ = sequences(file.read())
    # Pairs between 1e-3, where Newton's method has begun to see the end, and round-off.
    falls = [math.log(b) / math.log(a) for one in found for a, b in zip(one, one[1:]) if 1e-3 > a > 1e-7 and 1 > b > 1e-15]
    good = sum(fall >= 1.3 for fall in falls) / max(len(falls), 1)
    worst = [math.log10(a / b) for one in found for a, b in zip(one, one[1:]) if 1e-3 > a > 1e-7 and b > 1e-15]
    print(f"{name}: {len(falls)} falls from below 1e-3, median exponent {sorted(falls)[len(falls) // 2]:.2f}, "
          f"median fall 10^{sorted(worst)[len(worst) // 2]:.1f}, least 10^{min(worst):.1f}")
    checks.that(good >= least_share, f"{name}: exponent of the fall at least 1.3 in {least_share:.0%}", f"{good:.0%}")


def main():
    checks = Checks()
    # While the side folds, points come into contact within the last iterations of some steps: no order is to be had there.
    judge(checks, "upsetting", UPSETTING, 0.7)
    judge(checks, "gluing", UPSETTING, 0.9, ["-p", "travel=4"])
    slipping = judge(checks, "sliding", write(checks.path("sliding.lag"), SLIDING), 0.9)
    checks.that(slipping > 10, "sliding: it slides", f"{slipping} steps with slip")
    tight(checks, "tight-upsetting", deck_text(UPSETTING), 0.7, ["-p", "travel=4"])
    tight(checks, "tight-sliding", SLIDING, 0.9)
    checks.end()


if __name__ == "__main__":
    main()
