#!/usr/bin/env python3
"""Nonlinear elimination (NORMS PATCH): PATCH 0 leaves all bits, PATCH 12 finds the same equilibria with far fewer matrices.

usage: run_patches.py [-v] [-k]       -v prints every check, -k keeps the results

The upsetting deck, whose side folds onto the die: 246 matrices without patches, 137 with them; force and radius at the end differ by
.05 %, as the steps are others. A block that slides, and one under a die that a FORCE drives, whose free pilot is among the unknowns
of the patch. A blank one side of which snaps off its die: attempts at a step after one that failed have no patch, or the run ends with
3 (`run_chatter.py`). Results with a patch are the same bits for any number of threads.
"""
import re
import sys

sys.dont_write_bytecode = True
from run_chatter import DRAW, SNAP  # noqa: E402
from run_newton import SLIDING  # noqa: E402
from support import DONE, UPSETTING, Checks, deck_text, history, mesh, result_differences, run, said, summary, with_h5py, write  # noqa: E402

MOST_MATRICES, SAME_FORCE, SAME_SLIDE = 200, 5.0e-3, 1.0e-3

DRIVEN = SLIDING.replace("MOVE   upper Y down", "FORCE  upper Y 4000. load").replace(
    "LIC    down\n   0. 0.   0.3 -0.3   1. -0.6", "LIC    load\n   0. 0.   0.3 -1.   1. -1.")


def with_norms(text, norms):
    """A deck with these NORMS, before its steps."""
    return text.replace("\nSTRAT ", f"\nNORMS  {norms}\nSTRAT ", 1)


def ran(checks, name, text, *options):
    """Folder of a run that must end with 0."""
    out = checks.path(name)
    result = run([write(checks.path("decks", name, "deck.lag"), text), "--out", out, *options])
    checks.that(result.returncode == DONE, f"{name}: done", said(result))
    return out


def end_of(folder, column):
    """The last value of a column of the history."""
    return history(folder)[column][-1]


def main():
    with_h5py()
    checks = Checks()
    text = deck_text(UPSETTING)
    plain = ran(checks, "plain", with_norms(text, "FORCE 1.E-6"))
    off = ran(checks, "off", with_norms(text, "FORCE 1.E-6   PATCH 0"))
    # the checkpoint knows the text of its deck
    wrong = [name for name in result_differences(plain, off) if "ckp" not in name]
    checks.that(not wrong, "PATCH 0: the same bits as without the word", "; ".join(wrong))

    on = ran(checks, "on", with_norms(text, "FORCE 1.E-6   PATCH 12"), "--threads", "1")
    matrices = summary(on)["factorisations"]
    checks.that(matrices <= MOST_MATRICES, f"PATCH 12: at most {MOST_MATRICES} matrices", matrices)
    checks.that(summary(plain)["factorisations"] > MOST_MATRICES, "without patches it takes more",
                summary(plain)["factorisations"])
    for column in ("force_x_upper", "force_y_upper", "mid_radius", "max_plastic_strain"):
        error = abs(end_of(on, column)/end_of(plain, column) - 1)
        checks.that(error < SAME_FORCE, f"{column} at the end as without patches", f"{100*error:.3f} % apart")
    log = deck_text(f"{on}/deck.log")
    told = re.findall(r"^step .* iterations (\d+), (\d+) with a patch \((\d+) inner\)$", log, re.M)
    checks.that(len(told) > 20, "the listing tells iterations with a patch", len(told))
    checks.that(all(int(some) <= int(all_) and int(some) <= int(inner) for all_, some, inner in told), "its numbers agree", told)
    checks.that("with a patch" not in deck_text(f"{off}/deck.log"), "and nothing of them without")

    two = ran(checks, "two", with_norms(text, "FORCE 1.E-6   PATCH 12"), "--threads", "2")
    wrong = result_differences(on, two)
    checks.that(not wrong, "the same bits with 1 and 2 threads", "; ".join(wrong))
    # so large that the linear solver is MIXED, and shares its fronts out
    large = [ran(checks, f"large{n}", with_norms(text, "PATCH 12"), "--threads", str(n), "-p", "travel=4.5", *mesh(30, 45))
             for n in (1, 2)]
    wrong = result_differences(*large)
    checks.that(not wrong, "30x45: the same bits with 1 and 2 threads", "; ".join(wrong))
    checks.that("with a patch" in deck_text(f"{large[0]}/deck.log"), "and patches by MIXED",
                summary(large[0])["linear_solver"])

    for name, deck in (("sliding", SLIDING), ("driven", DRIVEN)):
        without = ran(checks, f"{name}0", deck)
        with_patch = ran(checks, f"{name}8", with_norms(deck, "PATCH 8"))
        checks.that("with a patch" in deck_text(f"{with_patch}/deck.log"), f"{name}: there are patches")
        for column in ("force_x_upper", "force_y_upper", "displacement_x_upper", "displacement_y_upper"):
            one, other = end_of(without, column), end_of(with_patch, column)
            checks.that(abs(other - one) <= SAME_SLIDE*abs(one), f"{name}: {column} at the end as without patches", (one, other))
    snap = ran(checks, "snap", with_norms(deck_text(DRAW), "PATCH 12"), *SNAP[0])
    checks.that("with a patch" in deck_text(f"{snap}/deck.log"), "snap: there are patches")
    checks.end()


if __name__ == "__main__":
    main()
