#!/usr/bin/env python3
"""Nodal fields of saved instants against the state of the points in the same file: two materials, a joined body of one of them, and
a punch that folds: every value within the range of the points around its node, material by material, and what it should be. Phases of a
further formulation on a body are among them."""
import os
import subprocess
import sys
import tempfile

import h5py
import numpy as np

SOURCE = os.environ.get("LAGAMINE_SOURCE") or os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
BIN = os.environ.get("LAGAMINE_BIN") or os.path.join(SOURCE, "build", "bin")
ROUND_OFF = 1e-12

DECK = """TITLE  Soft, hard and soft under a punch
STATE  PLSTN
KINEM  LOG
BLOCK  low   PL8LS 4 soft
   0. 0.   10. 0.   10. 5.   0. 5.
   4 1.   3 1.
BLOCK  high  PL8LS 9 hard
   0. 5.   10. 5.   10. 10.   0. 10.
   4 1.   3 1.
BLOCK  side  PL8LS 4 soft
   10. 0.   14. 0.   14. 5.   10. 5.
   2 1.   3 1.
JOIN   low 3 high 1
JOIN   low 2 side 4
LAW    soft  EPLA
   70000. 0.33
   LINEAR 100. 50.
LAW    hard  ELA
   200000. 0.3
LAW    rough COUL2D
   PENETR 1.E-3   PHI 0.3
DIE    punch PILOT 0. 10.
   SEGM   20. 10.   -1. 10.
CNT2D  high 3 punch -3 rough
FIXED  low 1 XY
FIXED  side 1 XY
MOVE   punch Y press
LIC    press
   0. 0.   1. -1.5
STRAT  0.1  1.E-4  0.2   4 3
END
"""
QUENCH = """TITLE  Phases of a further formulation
STATE  AXISYM
KINEM  SMALL
BLOCK  bar PL8LS 4 cold
   0. 0.   0.02 0.   0.02 0.01   0. 0.01
   5 1.   2 1.
ADDEL  bar PL8TM hot BILINEAR
LAW    cold ELA
   2.E11 0.3
LAW    hot META
   STEEL '{steel}' '16MND5'
   ENERGY 1.E6
START  T 900.
CONVE  bar 2 H 5000. TS 20.
FIXED  bar 1 Y
STRAT  0.1 1.E-6 0.5   5 3
STOP   12.
SAVE   1000
END
"""
MATERIALS = {"low": "soft", "high": "hard", "side": "soft"}
CORNERS = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])


def fit_matrix(npoint):
    """Values at the eight nodes of an element from those at its points: least squares of a bilinear field, weighed by the rule."""
    x, w = np.polynomial.legendre.leggauss(round(npoint**0.5))
    xi, eta = np.tile(x, len(x)), np.repeat(x, len(x))
    weight = np.sqrt(np.tile(w, len(x)) * np.repeat(w, len(x)))

    def shapes(a, b):
        return np.stack([np.ones_like(a), a, b, a * b], axis=1)

    corner = shapes(*CORNERS.T.astype(float)) @ np.linalg.pinv(shapes(xi, eta) * weight[:, None]) * weight
    return np.vstack([corner, 0.5 * (corner + np.roll(corner, -1, axis=0))])


def mises(state):
    xx, yy, xy, zz = (state[f"stress_{c}"] for c in ("xx", "yy", "xy", "zz"))
    return np.sqrt(0.5 * ((xx - yy)**2 + (yy - zz)**2 + (zz - xx)**2) + 3 * xy**2)


def expected(bodies, field, nodes):
    """(value, least, largest, value without a limit) at the nodes; NaN where there is no such field."""
    total, free, elements = np.zeros(nodes), np.zeros(nodes), np.zeros(nodes)
    least, largest = np.full(nodes, np.inf), np.full(nodes, -np.inf)
    for material in sorted({material for material, _, _ in bodies}):
        own, count = np.zeros(nodes), np.zeros(nodes)
        low, high = np.full(nodes, np.inf), np.full(nodes, -np.inf)
        for name, topology, state in bodies:
            if name != material or field not in state:
                continue
            values = state[field]
            np.add.at(own, topology, values @ fit_matrix(values.shape[1]).T)
            np.add.at(count, topology, 1)
            np.minimum.at(low, topology, values.min(axis=1)[:, None])
            np.maximum.at(high, topology, values.max(axis=1)[:, None])
        there = count > 0
        total[there] += count[there] * np.clip(own[there] / count[there], low[there], high[there])
        free += own
        elements += count
        least, largest = np.minimum(least, low), np.maximum(largest, high)
    with np.errstate(invalid="ignore"):
        return total / elements, least, largest, free / elements


def check(folder, name, text, materials):
    """Faults of the last instant of a run; its fields, values that had to be limited, and nodes by field."""
    faults, beyond = [], 0
    deck, out = os.path.join(folder, name + ".lag"), os.path.join(folder, name)
    with open(deck, "w", encoding="utf-8") as file:
        file.write(text)
    subprocess.run([os.path.join(BIN, "lagamine"), deck, "--out", out, "--quiet"], check=True)
    with h5py.File(os.path.join(out, name + ".g01.h5"), "r") as file:
        nodes = len(file["mesh/coordinates"])
        step = file["steps"][max(file["steps"])]
        bodies = []
        for number, group in file["mesh/groups"].items():
            if group["connectivity"].shape[1] != 8 or "state" not in step[f"points/{number}"]:
                continue
            components = [component.decode().strip() for component in step[f"points/{number}/components"][()]]
            state = dict(zip(components, np.moveaxis(step[f"points/{number}/state"][()], 2, 0)))
            if "stress_xx" in state:
                state["mises"] = mises(state)
            body = group.attrs["name"].decode()
            bodies.append((materials.get(body, body), group["connectivity"][()], state))
        components = {component for _, _, state in bodies for component in state}
        values = {field: step[f"node/{field}"][()] for field in step["node"]}
    fields = [field for field in values if field in components]
    if components - set(fields):
        faults.append(f"components that no field shows: {components - set(fields)}")
    for field in fields:
        found = values[field]
        value, least, largest, free = expected(bodies, field, nodes)
        scale = np.nanmax(np.abs(value))
        there = np.isfinite(value)
        if not (np.abs(found - value)[there] <= ROUND_OFF * scale).all():
            faults.append(f"{field}: off by {np.abs(found - value)[there].max()} of {scale}")
        if not ((found >= least - ROUND_OFF * scale) & (found <= largest + ROUND_OFF * scale))[there].all():
            faults.append(f"{field}: leaves the range of the points around the node")
        if (found[~there] != 0).any():
            faults.append(f"{field}: not 0 where there is no such field")
        beyond += int(((free < least) | (free > largest))[there].sum())
    return faults, fields, beyond, values


def main():
    with tempfile.TemporaryDirectory(prefix="lagamine-nodal-") as folder:
        faults, fields, beyond, values = check(folder, "punch", DECK, MATERIALS)
        strain = values["plastic_strain"]
        if strain.min() < 0 or {"mises", "plastic_strain", "stress_xx"} - set(fields) or beyond < 50:
            faults.append(f"the run shows little: {fields}, least plastic strain {strain.min()}, {beyond} values to be limited")
        steel = os.path.join(os.path.abspath(SOURCE), "decks", "steels", "16mnd5.met")
        more, phases, _, values = check(folder, "quench", QUENCH.format(steel=steel), {})
        if {"mises", "austenite", "bainite", "hardness"} - set(phases) or not 0 < values["bainite"].max() <= 1:
            more.append(f"phases are missing: {phases}")
    faults += more
    print("\n".join(faults) or f"{len(fields)} and {len(phases)} fields, {beyond} values limited")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
