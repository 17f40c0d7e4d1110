#!/usr/bin/env python3
"""Decks without heat: the same bits, bytes and calls as in a solver that has no heat at all.

usage: run_without_heat.py [DECK...] [-v] [-k]     DECK: folder/name below decks (default: four)

The other solver (tests/members/plain) has the same sources, but for the lists of elements and laws: without PL8TM, FLUX, CONVE, RADIA,
HEATS, GOLDAK, COU2DC and DIETM, HEAT, HEATH, META, METAMEC and ARBTHMET. Compared are all files that hold results (history, fields,
checkpoints: byte by byte), and the counts of the summary: calls by effect, factorisations, unknowns, iterations, memory of the factors. Nothing in
the files is called by a name of heat. A deck with heat is refused by the other solver: it has none.
"""
import glob
import json
import os
import re
import subprocess
import sys

sys.dont_write_bytecode = True
TESTS = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, os.path.join(TESTS, "runs"))
from support import BIN, DONE, INPUT, LAGAMINE, LONGEST_RUN, SOURCE, Checks  # noqa: E402

OTHER = os.path.join(os.path.dirname(os.path.abspath(BIN)), "tests", "without_heat")
DECKS = ["upsetting_frictionless/upsetting_frictionless", "press_fit/press_fit", "hertz/hertz", "plastic_forming/squeeze"]
# What a clock or the machine says.
OF_THE_MACHINE = ("wall_s", "cpu_s", "peak_rss_mb", "seconds", "blas", "threads", "half_costs")


def run(program, deck, out):
    """Exit code of a run."""
    return subprocess.run([program, deck, "--out", out, "--quiet", "--threads", "1"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                          timeout=LONGEST_RUN).returncode


def counts(folder):
    """The summary without times."""
    with open(os.path.join(folder, "summary.json"), encoding="utf-8") as file:
        whole = json.load(file)

    def cut(part):
        if isinstance(part, dict):
            return {key: cut(value) for key, value in part.items() if key not in OF_THE_MACHINE}
        return [cut(one) for one in part] if isinstance(part, list) else part

    return cut(whole)


def results(folder):
    """Contents of the files that hold results, by their names."""
    found = {}
    for path in glob.glob(os.path.join(folder, "**", "*"), recursive=True):
        if os.path.isfile(path) and re.search(r"\.(csv|h5|xdmf)$", path):
            with open(path, "rb") as file:
                found[os.path.relpath(path, folder)] = file.read()
    return found


def main():
    checks = Checks()
    print(f"{'deck':28s} {'files':>6s} {'bytes':>10s} {'iterations':>10s} {'calls':>8s}")
    for name in [word for word in sys.argv[1:] if not word.startswith("-")] or DECKS:
        deck = os.path.join(SOURCE, "decks", name + ".lag")
        one, other = (checks.path(os.path.basename(name), kind) for kind in ("all", "plain"))
        codes = [run(program, deck, out) for program, out in ((LAGAMINE, one), (OTHER, other))]
        if not checks.that(codes[0] == codes[1] and codes[0] in (DONE, 4), f"{name}: runs", codes):
            continue
        whole, plain = results(one), results(other)
        checks.that(len(whole) > 3 and sorted(whole) == sorted(plain), f"{name}: the same files", (sorted(whole), sorted(plain)))
        checks.that(all(whole[key] == plain.get(key) for key in whole), f"{name}: the same bytes",
                    [key for key in whole if whole[key] != plain.get(key)])
        checks.that(counts(one) == counts(other), f"{name}: the same calls and counts")
        effects = counts(one)["effects"]
        checks.that(all(effects[key]["calls"] == 0 and not effects[key]["on"] for key in ("heat", "phases")), f"{name}: no call of heat", effects)
        # fields, members and datasets: the words of heat are in none of the names
        checks.that(not any(re.search(rb"heat_flow|heat_contact|temperature", text) for key, text in whole.items() if ".ckp" not in key),
                    f"{name}: no name of heat in results")
        print(f"{os.path.basename(name):28s} {len(whole):6d} {sum(map(len, whole.values())):10d} {counts(one)['iterations']:10d} "
              f"{sum(part['calls'] for part in effects.values()):8d}")
    checks.that(run(OTHER, os.path.join(SOURCE, "decks", "stefan", "stefan.lag"), checks.path("stefan")) == INPUT,
                "the other solver knows no heat")
    with open(checks.path("card.lag"), "w", encoding="utf-8") as file:
        file.write("TITLE card\nSTATE PLSTN\nKINEM SMALL\nBLOCK a PL8LS 4 m\n   0. 0.   1. 0.   1. 1.   0. 1.\n   1 1.   1 1.\n"
                   "LAW m ELA\n   1. 0.\nCONVE a 2 H 1. TS 20.\nHEATS a Q 1.\nSTRAT 1. 1. 1. 4 3\nSTOP 1.\nEND\n")
    checks.that(run(OTHER, checks.path("card.lag"), checks.path("card")) == INPUT, "cards of heat are refused by it")
    checks.end()


if __name__ == "__main__":
    main()
