#!/usr/bin/env python3
"""Upsetting to 85 % by lagacycle: every mesh after the first is made without a person.

usage: run_upsetting_remesh.py [-v] [-k] [--write]     --write puts the tables into decks/upsetting_remesh/README.md

Compared with the same billet on 24 x 36 elements that are never remeshed, as far as these go (60 %). The jump of the force at a
remesh is that of the first step on the new mesh from the straight line through the last two on the old one.
"""
import os
import sys

sys.dont_write_bytecode = True
from remeshed import ROOT, cycle, facts, forces_go_on, jump, put_table, tries, value_at, within_limits  # noqa: E402
from support import DONE, Checks, history, run, said, summary  # noqa: E402

DECK = os.path.join(ROOT, "decks", "upsetting_remesh", "upsetting_remesh.lag")
PLAIN = os.path.join(ROOT, "decks", "upsetting", "upsetting.lag")
README = os.path.join(os.path.dirname(DECK), "README.md")
MARK = "<!-- table -->"
HALF_HEIGHT = 15.0
PERCENT = (30, 44, 50, 55, 60)
LARGEST_JUMP, LARGEST_DEVIATION, LARGEST_DRIFT = 0.02, 0.03, 0.001
TIMES_ORDINARY, LARGEST_BIAS = 3, 0.005     # change of the force at the first full steps on new meshes: five, where it is high enough


def main():
    checks = Checks()
    out, plain = checks.path("remeshed"), checks.path("plain")
    result = cycle(DECK, out)
    checks.that(result.returncode == DONE, "the cycle ends by itself", said(result))
    within_limits(checks, out)
    forces_go_on(checks, out, TIMES_ORDINARY, LARGEST_BIAS)
    rows, made_meshes = history(out), tries(out)
    rows["travel"] = [-u for u in rows["displacement_y_upper"]]
    checks.that(abs(rows["displacement_y_upper"][-1] + 0.85 * HALF_HEIGHT) < 1e-9, "85 % reached",
                rows["displacement_y_upper"][-1])
    checks.that(len(made_meshes) >= 5, "at least 5 remeshings", len(made_meshes))
    checks.that(all(t["accepted"] == "y" for t in made_meshes), "every new mesh is taken at the first try",
                [t["reason"] for t in made_meshes if t["accepted"] != "y"])

    lines = ["| mesh | at % | why | elements | scaled Jacobian | first residual | iterations | jump of force % | volume % |",
             "|---|---|---|---|---|---|---|---|---|"]
    drift, first_volume = 0.0, None
    for one in made_meshes:
        generation, step = int(one["generation [-]"]), int(one["step [-]"])
        made, restart = facts(out, generation, "start"), facts(out, generation, "restart")
        k = rows["step"].index(step)
        if first_volume is None:
            first_volume = summary(out)["initial_volume"]
        change = restart["volume_before"] / (first_volume * (1 + rows["volume_drift"][k])) - 1
        drift += abs(change)
        leap = jump(rows, "force_y_upper", step)
        checks.that(abs(leap) < LARGEST_JUMP, f"mesh {generation}: jump of the force below {LARGEST_JUMP:.0%}", f"{leap:.2%}")
        checks.that(abs(made["contour"]["volume_error"]) < 1e-12, f"mesh {generation}: the contour keeps the volume",
                    made["contour"]["volume_error"])
        reason = "; ".join(t.split(" ")[0] for t in one["trigger"].split("; "))
        lines.append(f"| {generation} | {-100 * rows['displacement_y_upper'][k] / HALF_HEIGHT:.1f} | {reason} | "
                     f"{made['old_elements']} -> {made['new_elements']} | {made['mesh']['scaled_jacobian']:.2f} | "
                     f"{restart['first_residual']:.3f} | {restart['iterations']} | {100 * leap:+.2f} | {100 * change:+.4f} |")
    checks.that(drift < LARGEST_DRIFT, f"all remeshings together change the volume by less than {LARGEST_DRIFT:.1%}", f"{drift:.4%}")

    unloaded = summary(out)["checks"]["volume_drift_unloaded"]
    checks.that(abs(unloaded) < LARGEST_DRIFT, f"at the end the volume without elastic strain is kept to {LARGEST_DRIFT:.1%}",
                f"{unloaded:.4%}")

    result = run([PLAIN, "--out", plain, "--threads", "1", "-p", "nx=24", "-p", "ny=36"])
    checks.that(result.returncode == DONE, "24 x 36 without remeshing: done", said(result))
    fine = history(plain)
    fine["travel"] = [-u for u in fine["displacement_y_upper"]]
    lines += ["", "| upset % | remeshed kN | 24 x 36, one mesh, kN | deviation % |", "|---|---|---|---|"]
    for percent in PERCENT:
        here, there = (value_at(r, "force_y_upper", "travel", HALF_HEIGHT * percent / 100) for r in (rows, fine))
        checks.that(abs(here / there - 1) < LARGEST_DEVIATION, f"force at {percent} % within {LARGEST_DEVIATION:.0%}",
                    f"{here / there - 1:.2%}")
        lines.append(f"| {percent} | {here / 1000:.1f} | {there / 1000:.1f} | {100 * (here / there - 1):+.2f} |")
    print("\n".join(lines))
    if "--write" in sys.argv:
        put_table(README, MARK, lines)
    checks.end()


if __name__ == "__main__":
    main()
