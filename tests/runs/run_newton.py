#!/usr/bin/env python3
"""Newton's method converges quadratically: read off the listing of upsetting (gluing, folding) and of a block that slides.

usage: run_newton.py [-v] [-k]       -v prints every check and the orders, -k keeps the results

Every accepted step is one or more sequences of residuals; a new one begins when contact is augmented.

As the decks are, a step ends as soon as it has converged. Newton's method is quadratic when r3 = C r2^2 with a constant that does
not depend on the sequence; here C is 4 to 60. A sequence whose last fall keeps C below 100 is taken for quadratic, and so is an
end below 1e-9, since round-off has no order. A tangent wrong by 2 % ends with r3 = 0.02 r2, C = 2000 where r2 = 1e-5. (The order
log(r3/r2)/log(r2/r1) is printed, and its median must be near 2; of one sequence it says little, since the fall before the last
often ends with the last change of the set of points that flow or touch, and is then a leap.) The residual a sequence starts from
(the predictor's, or an augmentation's) is not Newton's and does not count; sequences with fewer than three others are not judged.
A share is asked for, of all scenes together, since the set may still change in the last solution.

With FORCE 1E-11 in the same scenes the fall can be followed down to round-off (near 1e-13): a sequence shows quadratic
convergence when at most two more solutions lead from below 1e-5 to below 1e-11. A tangent wrong by 2 % takes four.
"""
import math
import re
import sys

sys.dont_write_bytecode = True
from support import DONE, UPSETTING, Checks, add_cards, deck_text, run, said, write  # noqa: E402

ORDER, ROUND_OFF, SHARE = 1.6, 1.0e-9, 0.9
CONSTANT = 100.0
START, END, MOST = 1.0e-5, 1.0e-11, 2

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
        elif line.startswith(("cutback:", "event:")):
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
    """Order of the last three residuals, the one a sequence starts from left out; None when there are no three that fall."""
    if len(residuals) < 4:
        return None
    first, second, third = residuals[-3:]
    if not first > second > third > 0:
        return None
    return math.log(third / second) / math.log(second / first)


def judge(checks, name, deck, options=()):
    """Sequences that end quadratically, sequences judged, and steps that slip."""
    out = checks.path(name)
    result = run([deck, "--out", out, "--threads", "1"] + list(options))
    if not checks.that(result.returncode == DONE, f"{name}: done", said(result)):
        return 0, 0, 0
    stem = deck.rsplit("/", 1)[1].replace(".lag", ".log")
    with open(f"{out}/{stem}", encoding="utf-8") as file:
        found, slipping = sequences(file.read())
    judged = [one for one in found if order(one) is not None]
    good = [one[-1] < ROUND_OFF or one[-1] <= CONSTANT * one[-2] ** 2 for one in judged]
    median = sorted(map(order, judged))[len(judged) // 2] if judged else float("nan")
    print(f"{name}: {sum(good)} of {len(judged)} sequences quadratic, median order {median:.2f}, "
          f"{len(found)} sequences, {slipping} steps with slip")
    checks.that(len(judged) >= 5, f"{name}: enough to judge", f"{len(judged)} sequences")
    checks.that(median >= ORDER, f"{name}: median order at least {ORDER}", f"{median:.2f}")
    return sum(good), len(judged), slipping


def tight(checks, name, text, least_share, options=()):
    """With the residual driven down to round-off: solutions from below 1e-5 to below 1e-11."""
    deck = write(checks.path(name + ".lag"), add_cards(text, f"NORMS  FORCE {END:g}   DISPL 1.E-9"))
    out = checks.path(name)
    result = run([deck, "--out", out, "--threads", "1"] + list(options))
    if not checks.that(result.returncode == DONE, f"{name}: done", said(result)):
        return
    with open(f"{out}/{name}.log", encoding="utf-8") as file:
        found, _ = sequences(file.read())
    solutions = [fall for fall in map(fall_length, found) if fall is not None]
    good = sum(fall <= MOST for fall in solutions) / max(len(solutions), 1)
    counts = ", ".join(f"{solutions.count(n)} in {n}" for n in sorted(set(solutions)))
    print(f"{name}: from below {START:g} to below {END:g}: {counts} solutions ({good:.0%} quadratic)")
    checks.that(len(solutions) >= 10, f"{name}: enough to judge", len(solutions))
    checks.that(good >= least_share, f"{name}: quadratic in at least {least_share:.0%}", f"{good:.0%}")


def fall_length(residuals):
    """Solutions from the first residual below START to the first one below END; the predictor's own does not count."""
    first = next((k for k, residual in enumerate(residuals) if k > 0 and residual < START), None)
    last = next((k for k, residual in enumerate(residuals) if k > 0 and residual < END), None)
    return None if first is None or last is None else last - first


def main():
    checks = Checks()
    scenes = [judge(checks, "upsetting", UPSETTING),
              judge(checks, "gluing", UPSETTING, ["-p", "travel=6"]),
              judge(checks, "sliding", write(checks.path("sliding.lag"), SLIDING))]
    good, judged = (sum(scene[k] for scene in scenes) for k in range(2))
    checks.that(judged >= 50 and good >= SHARE * judged, f"share of quadratic ends at least {SHARE:.0%} of 50 or more",
                f"{good} of {judged}")
    checks.that(scenes[2][2] > 10, "sliding: it slides", f"{scenes[2][2]} steps with slip")
    tight(checks, "tight-upsetting", deck_text(UPSETTING), 0.95)
    tight(checks, "tight-gluing", deck_text(UPSETTING), 0.95, ["-p", "travel=6"])
    tight(checks, "tight-sliding", SLIDING, 0.95)
    tight(checks, "tight-jaumann", SLIDING.replace("KINEM  LOG", "KINEM  JAUMANN"), 0.95)
    checks.end()


if __name__ == "__main__":
    main()
