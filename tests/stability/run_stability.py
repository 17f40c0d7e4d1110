#!/usr/bin/env python3
"""Stability of formulations: motions that grow by the method and not by the body.

usage: run_stability.py [-v] [-k]       -v prints every check, -k keeps the results

A case answers numbers which must stay below bounds. The table has them beside those of the code before the formulation was changed
(`before`, measured by this script), and what is left up to the bound, as a share of it (`margin`).

- `neck`: the necking round bar by PL8LS 9 MEAN, its elements 4 to 5 times, or 14 times, as wide as high where the neck forms, pulled by
  6 mm at each end. `saw`: how far the middle nodes of the vertical sides of an element stand above their ends on the one side and
  below on the other, over the element's height; it falls with the size of elements where they do not saw. `force`: the last force
  beside that of 4 points on the same mesh; both are within 0.3 % of a fine mesh. `unseen`: `spurious_mode` in summary.json.
"""
import json
import os
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), os.pardir, "patch"))
from patch_support import SOURCE, Checks, Run, np  # noqa: E402

# The last is half of what the listing reports.
BOUND = {"saw": 0.1, "force": 0.01, "unseen": 0.45}
# Meshes of the bar, and what the code before answered.
NECKS = {(6, 18): (0.703, 0.061, 0.732), (8, 24): (0.638, 0.057, 0.861), (12, 36): (0.795, 0.089, 1.0), (4, 36): (14.090, 0.080, 1.0)}


def neck(checks, card, nx, ny):
    """The bar of decks/necking with another element and mesh."""
    with open(os.path.join(SOURCE, "decks", "necking", "necking.lag"), encoding="utf-8") as deck:
        text = deck.read()
    changes = {"PARAM  nx 8\n": f"PARAM  nx {nx}\n", "PARAM  ny 24\n": f"PARAM  ny {ny}\n", "PARAM  pull 7 ": "PARAM  pull 6 ",
               "PARAM  dt 0.002 ": "PARAM  dt 0.02 ", "PL8LS 4 metal": f"PL8LS {card}"}
    for old, new in changes.items():
        checks.that(text.count(old) == 1, f"necking.lag has one line with {old.strip()}")
        text = text.replace(old, new)
    return Run(checks, f"neck-{card.replace(' ', '')}-{nx}x{ny}", text)


def saw(run):
    """Middle nodes of vertical sides: up on one side of an element and down on the other, over its height; the largest."""
    places, nodes = run.mesh()
    height = (places + run.displacement())[nodes, 1]
    left, right = height[:, 7] - (height[:, 0] + height[:, 3])/2, height[:, 5] - (height[:, 1] + height[:, 2])/2
    size = (height[:, 3] - height[:, 0] + height[:, 2] - height[:, 1])/2
    return np.max(np.abs(left - right)/size)


def necks(checks):
    """Rows of the table."""
    rows = []
    for (nx, ny), before in NECKS.items():
        mean, four = neck(checks, "9 metal MEAN", nx, ny), neck(checks, "4 metal", nx, ny)
        if mean.ok and four.ok:
            with open(os.path.join(mean.out, "summary.json"), encoding="utf-8") as summary:
                unseen = json.load(summary)["checks"]["spurious_mode"]
            now = saw(mean), abs(mean.history["force"][-1]/four.history["force"][-1] - 1), unseen
            rows += [(f"neck {nx} x {ny}", what, *values) for what, *values in zip(BOUND, before, now)]
    return rows


def main():
    checks = Checks()
    print(f"{'case':14s} {'number':8s} {'before':>9s} {'now':>9s} {'bound':>7s} {'margin':>7s}")
    for case, what, before, now in necks(checks):
        bound = BOUND[what]
        print(f"{case:14s} {what:8s} {before:9.4f} {now:9.4f} {bound:7.3f} {1 - now/bound:7.2f}")
        checks.small(now, bound, f"{case}: {what}")
    checks.end()


if __name__ == "__main__":
    main()
