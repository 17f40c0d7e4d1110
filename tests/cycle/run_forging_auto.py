#!/usr/bin/env python3
"""A flange with a hub forged by lagacycle from a contour without zones: every mesh is made by the free mesher; and by Gmsh, where it is.

usage: run_forging_auto.py [-v] [-k] [--write]     --write puts the tables into decks/forging_auto/README.md

Compared with decks/forging_rib on 48 x 24 elements that are never remeshed (forging.py). Gmsh is hidden from the free mesher. Where Gmsh is
asked for and was not found, or is hidden, the cycle ends with one clear line.
"""
import os
import subprocess
import sys

sys.dont_write_bytecode = True
from remeshed import ROOT, cycle, put_table, tries
from support import BIN, DONE, NO_CONVERGENCE, Checks, history, said, write
import forging
import h5py
import numpy as np

DECK = os.path.join(ROOT, "decks", "forging_auto", "forging_auto.lag")
README = os.path.join(os.path.dirname(DECK), "README.md")
GMSH = os.path.join(os.path.abspath(BIN), "remdata_gmsh")


def with_gmsh(checks):
    """The deck with Gmsh in place of the free mesher."""
    with open(DECK, encoding="utf-8") as file:
        text = file.read()
    checks.that(text.count("MESHER FREE") == 1, "the deck names its mesher")
    return write(checks.path("forging_auto.lag"), text.replace("MESHER FREE", "MESHER GMSH"))


def refused(checks, deck, name):
    """No Gmsh, no mesh: reported with its stage, and with advice."""
    out = checks.path(name)
    result = cycle(deck, out)
    reported = said(result) + result.stdout
    checks.that(result.returncode == NO_CONVERGENCE, f"{name}: the cycle ends", reported)
    checks.that("cannot be started" in reported, f"{name}: reported", reported)
    rows = tries(out)
    checks.that(rows and all(row["stage"] == "mesh" and row["accepted"] == "n" for row in rows), f"{name}: stage mesh", rows)


def same_again(checks, out):
    """The same checkpoint gives the same mesh, to the last bit."""
    again = checks.path("again.h5")
    name = os.path.join(out, "forging_auto.g0{}.h5")
    result = subprocess.run([os.path.join(BIN, "remdata"), name.format("2.end"), "--out", again, "--quiet"], check=False, text=True,
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    checks.that(result.returncode == DONE, "a mesh made again: done", said(result))
    with h5py.File(name.format("3.start"), "r") as one, h5py.File(again, "r") as two:
        for place in ("mesh/coordinates", "groups/1/connectivity"):
            checks.that(np.array_equal(one[place][()], two[place][()]), f"a mesh made again: {place} is the same")


def forged(checks, deck, mesher):
    """The whole stroke; the tables."""
    out = checks.path(mesher)
    result = cycle(deck, out)
    checks.that(result.returncode == DONE, f"{mesher}: the cycle ends by itself", result.stdout + result.stderr)
    rows = history(out)
    lines = forging.new_meshes(checks, out, rows, mesher)
    forging.closed(checks, out, rows)
    lines += forging.compared(checks, forging.results(out), forging.read_reference())
    print("\n".join(lines))
    same_again(checks, out)
    return lines


def main():
    checks = Checks()
    there = os.environ.get("REMDATA_GMSH")
    os.environ["REMDATA_GMSH"] = os.path.join(BIN, "no_such_program")
    lines = forged(checks, DECK, "free")
    if "--write" in sys.argv:
        put_table(README, forging.MARK, lines)
    deck = with_gmsh(checks)
    refused(checks, deck, "Gmsh is hidden")
    del os.environ["REMDATA_GMSH"]
    if there:
        os.environ["REMDATA_GMSH"] = there
    if os.path.exists(GMSH):
        forged(checks, deck, "gmsh")
    else:
        refused(checks, deck, "Gmsh was not found")
    checks.end()


if __name__ == "__main__":
    main()
