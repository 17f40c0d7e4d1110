#!/usr/bin/env python3
"""Forming scenes whose decks say REMSH and nothing else of meshes: the cycle goes to the end of the stroke.

usage: run_scenes.py [NAME... | all] [--finer] [--write] [-v] [-k]     without names: the quick ones

Every scene ends with 0, its die has made its stroke, the volume without elastic strain stays within 0.1 %, no single step but the shortest 2
in a hundred is shorter than a thousandth of the mean one, and refused tries are at most 5 in a hundred (or one). --finer runs each a second
time with elements of half the size and compares forces. Prints a table; --write puts the row of each scene into its README. What a README
says is what is found, but for what other compilers and processors change: a tenth of the meshes and of the steps, and one.
"""
import os
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from remeshed import put_table  # noqa: E402
from scenes import (HEAD, LEAST_ANGLE, MARK, SCENES, asks_by_remsh_alone, badly_shaped, checked, deck_of, finer_deck, force_table,  # noqa: E402
                    line, readme_of, run_scene, said_in_readme, totals)
from support import DONE, Checks  # noqa: E402

QUICK = ("bimetal", "side_pressing", "teeth")
DRIFT, SMALLEST, REFUSED = 0.1, 1e-3, 0.05
# Steps follow events of contact, which rounding shifts: side_pressing takes 263 to 337 steps on 4 to 7 meshes with the kernels of nine processors,
# at forces within 0.3 % and largest strains within 1.4 %.
AS_SAID = 0.3
LIMITS = ("stress_error", "least_angle", "largest_angle", "middle_share", "scaled_jacobian", "aspect_ratio", "contact", "narrow_contact", "distress", "new mesh   elements of")


def force(found, share):
    """Largest die force near a share of the time, the mean of three steps."""
    rows, name = found["history"], "force_y_" + SCENES[found["name"]][0]
    if name not in rows:
        return float("nan")
    at = share * rows["time"][-1]
    k = min(range(len(rows["time"])), key=lambda i: abs(rows["time"][i] - at))
    near = rows[name][max(0, k - 1):k + 2]
    return sum(near) / len(near)


def main():
    checks = Checks()
    names = [word for word in sys.argv[1:] if not word.startswith("-")] or list(QUICK)
    names = list(SCENES) if names == ["all"] else names
    print("\n".join(HEAD))
    for name in names:
        checks.that(asks_by_remsh_alone(deck_of(name)), f"{name}: REMSH alone")
        text = checked(name)
        for word in LIMITS:
            checks.that(word in text, f"{name}: --check states {word}")
        found = run_scene(name, checks.path(name))
        print(line(found), flush=True)
        if not checks.that(found["code"] == DONE, f"{name}: the cycle ends with 0", found["said"]):
            continue
        checks.that(abs(found["drift"]) < DRIFT, f"{name}: volume", found["drift"])
        checks.that(found["smallest"] > SMALLEST, f"{name}: steps", found["smallest"])
        checks.that(found["refused"] <= max(1, REFUSED * found["meshes"]), f"{name}: tries refused", found["refused"])
        checks.that(not badly_shaped(found), f"{name}: shape of the meshes", badly_shaped(found))
        if "--write" in sys.argv[1:]:
            put_table(readme_of(name), MARK, HEAD + [line(found)])
        told = said_in_readme(name)
        checks.that(all(abs(found[key] - told[key]) <= AS_SAID * told[key] + (key != "code") for key in told), f"{name}: as its README says",
                    [(key, told[key], found[key]) for key in told])
        if "--finer" not in sys.argv[1:]:
            continue
        fine = run_scene(name, checks.path(name + ".finer"), deck=finer_deck(name, checks.folder))
        words = "half the size"
        if fine["code"] == DONE:
            words += ": force of the deck " + ", ".join(
                f"{100 * (force(found, share) / force(fine, share) - 1):+.2f} % at {share:g}" for share in (0.25, 0.5, 0.75, 1.0))
        print(line(fine, words), flush=True)
    tried, refused, angle, jacobian = totals([checks.path(name) for name in names])
    print(f"\ntries at new meshes refused: {refused} of {tried} ({100 * refused / max(tried, 1):.1f} %); accepted meshes: smallest angle {angle:.1f} degrees, "
          f"scaled Jacobian {jacobian:.2f} (where the contour has no corner below {LEAST_ANGLE:g} degrees)")
    print("\n".join(["", *force_table([checks.path(name) for name in names])]))
    checks.end()


if __name__ == "__main__":
    main()
