#!/usr/bin/env python3
"""A flange with a hub forged by lagacycle from a contour without zones: every mesh is made by Gmsh, where it is there.

usage: run_forging_auto.py [-v] [-k] [--write]     --write puts the tables into decks/forging_auto/README.md

Compared with decks/forging_rib on 48 x 24 elements that are never remeshed (forging.py). Where the build found no Gmsh, and where
it is hidden, the cycle ends with one clear line.
"""
import os
import subprocess
import sys

sys.dont_write_bytecode = True
from remeshed import ROOT, cycle, put_table, tries
from support import BIN, DONE, NO_CONVERGENCE, Checks, history, said
import forging
import h5py
import numpy as np

DECK = os.path.join(ROOT, "decks", "forging_auto", "forging_auto.lag")
README = os.path.join(os.path.dirname(DECK), "README.md")
GMSH = os.path.join(os.path.abspath(BIN), "remdata_gmsh")


def refused(checks, name):
    """No Gmsh, no mesh: reported with its stage, and with advice."""
    out = checks.path(name)
    result = cycle(DECK, out)
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


def main():
    checks = Checks()
    if os.path.exists(GMSH):
        out = checks.path("auto")
        result = cycle(DECK, out)
        checks.that(result.returncode == DONE, "the cycle ends by itself", result.stdout + result.stderr)
        rows = history(out)
        lines = forging.new_meshes(checks, out, rows, "gmsh")
        forging.closed(checks, out, rows)
        lines += forging.compared(checks, forging.results(out), forging.read_reference())
        print("\n".join(lines))
        if "--write" in sys.argv:
            put_table(README, forging.MARK, lines)
        same_again(checks, out)
        os.environ["REMDATA_GMSH"] = os.path.join(BIN, "no_such_program")
        refused(checks, "Gmsh is hidden")
    else:
        refused(checks, "Gmsh was not found")
    checks.end()


if __name__ == "__main__":
    main()
