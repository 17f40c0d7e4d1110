#!/usr/bin/env python3
"""Estimated errors of the shape that fronts of temperature and phases leave beside true ones, in a table: strips, a plate, a ring, an angle and
a bar with a slot, cooled unlike on their sides.

usage: run_shape_error.py [-v] [-k] [--all]

True errors are differences to a mesh 4 times finer or more: of the displacements at the nodes of the coarse mesh, without what moves, turns and
grows the body evenly, or of the curvature of the section. With --all the whole table of the manual, of finer meshes (some minutes).
"""
import glob
import json
import os
import subprocess
import sys

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [HERE, os.path.join(os.path.dirname(HERE), "patch")]
from patch_support import LAGAMINE, LONGEST_RUN, SOURCE, Checks, Run, np  # noqa: E402
import h5py  # noqa: E402

FORGED = os.path.join(SOURCE, "decks", "forge_quench_temper", "forged.met")
STEEL = (f"'{FORGED}' '4140'", 850, 400)
#: Austenite alone: no phase forms.
AUSTENITE = ("'austenite.met' 'a'", 1050, 1000)
AUSTENITE_FILE = """STEEL 'a'
SOURCE 'round numbers'
EXPAND TOTAL 20
PHASE AUSTENITE
   LAMBDA POLY 16.8 0.0119
   RHOC   POLY 3.5220595 0.002360495 -1.95465e-06
   E      TABLE 20 200000  800 130000
   NU     0.3
   ALPHA  22e-6
   SY     TABLE 20 140  300 100  800 40
   ET     500
END
"""
#: Told at least this share of the truth, of a mesh that shows the shape.
LEAST = 0.4
#: What is to be warned of, and errors from which on the ratio is judged.
WARNED, JUDGED = 0.1, 0.05


def deck(blocks, joins, cooling, supports, state, steel, points=4):
    """A body of blocks, hot at the start, cooled at sides."""
    name, start, stop = steel
    text = f"TITLE a front leaves a shape\nSTATE {state}\n"
    if state == "GPLSTN":
        text += "SECTN E FREE\nSECTN KX FREE\nSECTN KY FREE\n"
    text += "KINEM SMALL\n" + "".join(f"BLOCK {block} PL8LS {points} s\n{rows}" for block, rows in blocks) + joins
    text += f"LAW s ARBTHMET\n   STEEL {name}\n   STRESS 1.\n"
    text += "".join(f"ADDEL {block} PL8TM t{block} BILINEAR\nLAW t{block} META\n   STEEL {name}\n   ENERGY 1.\nSTART T {start}. {block}\n"
                    for block, _ in blocks)
    text += "".join(f"CONVE {side} H {h} TS 20.\n" for side, h in cooling)
    return text + supports + f"THETA TRBDF2 TOL 2.\nSTRAT 0.01 1.E-6 10. 14 9 0.25 2.\nSTOP {stop}.\nEND\n"


def box(x, y, right, top, nx, ny):
    """Rows of a block."""
    return f"   {x} {y} {right} {y} {right} {top} {x} {top}\n   {nx} 1. {ny} 1.\n"


def strip(n, steel, length, h_top, h_bottom, points=4):
    """Free to bend about one axis, one element wide."""
    text = deck([("p", box(0, 0, length/n, length, 1, n))], "", [("p 3", h_top), ("p 1", h_bottom)], "FIXED p 4 X\nFIXED POINT 0. 0. Y\n", "GPLSTN",
                steel, points)
    return text.replace("SECTN KX FREE", "SECTN KX HELD")


def plate(n, steel, h_top, h_others):
    """40 x 8, plane strain."""
    return deck([("p", box(0, 0, 40, 8, 5*n, n))], "", [("p 3", h_top), ("p 1", h_others), ("p 2", h_others), ("p 4", h_others)],
                "FIXED POINT 0. 0. XY\nFIXED POINT 40. 0. Y\n", "PLSTN", steel)


def ring(n, steel, h_inside, h_others):
    """10 x 10, from a radius of 20, cooled inside and at one end."""
    return deck([("p", box(20, 0, 30, 10, n, n))], "", [("p 4", h_inside), ("p 3", h_inside), ("p 2", h_others), ("p 1", h_others)],
                "FIXED POINT 20. 0. Y\n", "AXISYM", steel)


def angle(n, steel, h_outside, h_inside):
    """A long angle of two legs, 8 thick, 32 and 24 long."""
    return deck([("a", box(0, 0, 8, 8, n, n)), ("b", box(8, 0, 32, 8, 3*n, n)), ("c", box(0, 8, 8, 24, n, 2*n))], "JOIN a 2 b 4\nJOIN a 3 c 1\n",
                [(side, h_outside) for side in ("a 1", "b 1", "a 4", "c 4", "b 2", "c 3")] + [("b 3", h_inside), ("c 2", h_inside)],
                "FIXED POINT 0. 0. XY\nFIXED POINT 32. 0. Y\n", "GPLSTN", steel)


def slot(n, steel, h_outside, h_inside):
    """A long bar 24 x 24 with a slot 8 x 8 in one side."""
    there = [(i, j) for i in range(3) for j in range(3) if (i, j) != (1, 2)]
    joins = "".join(f"JOIN b{i}{j} 2 b{i + 1}{j} 4\n" for i, j in there if (i + 1, j) in there)
    joins += "".join(f"JOIN b{i}{j} 3 b{i}{j + 1} 1\n" for i, j in there if (i, j + 1) in there)
    cooling = [(side, h_outside) for k in range(3) for side in (f"b{k}0 1", f"b0{k} 4", f"b2{k} 2")]
    cooling += [("b02 3", h_outside), ("b22 3", h_outside)] + [(side, h_inside) for side in ("b02 2", "b22 4", "b11 3")]
    return deck([(f"b{i}{j}", box(8*i, 8*j, 8*i + 8, 8*j + 8, n, n)) for i, j in there], joins, cooling,
                "FIXED POINT 0. 0. XY\nFIXED POINT 24. 0. Y\n", "GPLSTN", steel)


#: What it is, the scene, its numbers, elements across of the mesh that is taken as true and of the others; whether they are of the short table.
CASES = [
    ("strip 20, water above", strip, (STEEL, 20, 20, 5), 64, (4, 8, 16), (8,)),
    ("the same, 9 points", strip, (STEEL, 20, 20, 5, 9), 64, (4, 8, 16), ()),
    ("strip 20, oil above", strip, (STEEL, 20, 4, 1), 64, (4, 8, 16), ()),
    ("strip 20, water, austenite", strip, (AUSTENITE, 20, 20, 5), 64, (4, 8, 16), (8,)),
    ("strip 10, water, austenite", strip, (AUSTENITE, 10, 10, 1), 64, (4, 8, 16), ()),
    ("strip 40, water, austenite", strip, (AUSTENITE, 40, 5, 0.5), 64, (4, 8, 16), ()),
    ("plate 40 x 8, water above", plate, (STEEL, 10, 1), 16, (2, 4, 8), ()),
    ("plate 40 x 8, water, austenite", plate, (AUSTENITE, 10, 1), 16, (2, 4, 8), (2,)),
    ("ring, water inside", ring, (STEEL, 15, 1), 16, (2, 4, 8), (2,)),
    ("angle, water outside", angle, (STEEL, 10, 2), 8, (2, 4), ()),
    ("angle, water outside, austenite", angle, (AUSTENITE, 10, 2), 8, (2, 4), ()),
    ("bar with a slot, water, austenite", slot, (AUSTENITE, 10, 10), 8, (2, 4), ()),
]


def run_of(checks, name, text):
    """The run, its summary."""
    folder = os.path.join(checks.folder, name)
    os.makedirs(folder, exist_ok=True)
    with open(os.path.join(checks.folder, "austenite.met"), "w", encoding="utf-8") as file:
        file.write(AUSTENITE_FILE)
    run = Run(checks, name, text.replace("austenite.met", os.path.join(checks.folder, "austenite.met")))
    checks.that(run.ok, f"{name}: done", "")
    with open(os.path.join(run.out, "summary.json"), encoding="utf-8") as file:
        return run, json.load(file)


def state(run, name):
    """Places and displacements of the nodes at the end, and the section."""
    with h5py.File(os.path.join(run.out, f"{name}.ckp.h5")) as file:
        return file["mesh/coordinates"][:], file["fields/displacement/value"][:], file["fields/section/value"][0]


def rest(x, u, has_axis):
    """Largest displacement but for what moves, turns and grows all evenly."""
    place, way = x.copy(), u.copy()
    for c in (1,) if has_axis else (0, 1):
        place[:, c] -= place[:, c].mean()
        way[:, c] -= way[:, c].mean()
    square = (place**2).sum()
    growth = (place*way).sum()/square
    turn = 0. if has_axis else (place[:, 0]*way[:, 1] - place[:, 1]*way[:, 0]).sum()/square
    way = way - growth*place - turn*np.column_stack([-place[:, 1], place[:, 0]])
    return np.sqrt((way**2).sum(1).max())


def true_errors(coarse, fine, scene):
    """Of the curvature of a strip, of the displacements of other bodies; and what they are errors of."""
    if scene is strip:
        return abs(coarse[2][2] - fine[2][2]), abs(fine[2][2])
    places = {tuple(np.round(x, 6)): k for k, x in enumerate(fine[0])}
    both = [(k, places[tuple(np.round(x, 6))]) for k, x in enumerate(coarse[0]) if tuple(np.round(x, 6)) in places]
    own, other = (np.array(column) for column in zip(*both))
    return rest(coarse[0][own], coarse[1][own] - fine[1][other], scene is ring), rest(fine[0], fine[1], scene is ring)


def compare(checks, case, whole):
    """The rows of a case; checks of what is told and warned of."""
    what, scene, numbers, finest, meshes, short = case
    meshes = meshes if whole else short
    if not meshes:
        return
    name = "finest"
    run, _ = run_of(checks, name, scene(finest if whole else finest//2, *numbers))
    fine = state(run, name)
    for n in meshes:
        name = f"mesh{n}"
        run, summary = run_of(checks, name, scene(n, *numbers))
        true, of = true_errors(state(run, name), fine, scene)
        told = summary["accuracy"]["shape"]
        shown = told.get("known", True)
        key = "curvature" if scene is strip else "displacement"
        says = f"{100*told[key]/told['of_' + key]:.1f} %" if shown else "not shown"
        ratio = f"{told[key]/true:.2f}" if shown else ""
        print(f"| {what}, {n} elements | {100*told['share_in_element']:.0f} % | {100*true/of:.1f} % | {says} | {ratio} |", flush=True)
        warned = any("coarse for the shape" in line["text"] for line in summary["warnings"])
        if true > WARNED*of:
            checks.that(warned, f"{what}, {n} elements: warned of", told)
        if shown and true > JUDGED*of:
            checks.that(told[key] > LEAST*true, f"{what}, {n} elements: not told to be fine", (told, true))


def on_new_mesh(checks):
    """A ring that is quenched, and then gets a new mesh as it rests: what fronts have left is told still."""
    text = ring(4, AUSTENITE, 15, 1).replace("KINEM SMALL", "KINEM LOG").replace("STOP 1000.", "STOP 200.")
    held, moved = "FIXED POINT 20. 0. Y\n", text.index("CONVE")
    text = text[:moved] + held + "OPERA quench\n" + text[moved:].replace(held, "")
    text = text.replace("END\n", "OPERA rest\nCONVE p 2 H 1. TS 20.\nTHETA TRBDF2 TOL 2.\nSTRAT 1. 1.E-6 10. 14 9 0.25 2.\nSTOP 230.\nREMSH\n   TIMES 215.\nEND\n")
    path = os.path.join(checks.folder, "chain.lag")
    with open(path, "w", encoding="utf-8") as file:
        file.write(text.replace("'austenite.met'", f"'{os.path.join(checks.folder, 'austenite.met')}'"))
    out = os.path.join(checks.folder, "chain")
    done = subprocess.run([os.path.join(os.path.dirname(LAGAMINE), "lagacycle"), path, "--out", out], text=True, check=False, capture_output=True, timeout=LONGEST_RUN)
    if not checks.that(done.returncode == 0, "quench and rest: done", done.stderr[-400:]):
        return
    with open(os.path.join(out, "summary.json"), encoding="utf-8") as file:
        summary = json.load(file)["accuracy"]
    with open(glob.glob(os.path.join(out, "summary.*.json"))[0], encoding="utf-8") as file:
        before = json.load(file)["accuracy"]["shape"]
    checks.that(summary["cycle"]["meshes"] > 1, "quench and rest: a new mesh", summary["cycle"])
    now = summary.get("shape", {"displacement": 0., "of_displacement": 0.})
    checks.that(0.7 < now["displacement"]/before["displacement"] < 1.4, "quench and rest: told as before the new mesh", (before, now))
    checks.that(abs(now["of_displacement"]/before["of_displacement"] - 1) < 0.1, "quench and rest: of the same shape", (before, now))


def main():
    """The table; a body that cools evenly, and one that does not flow."""
    checks = Checks()
    whole = "--all" in sys.argv
    print("| case | of a front in an element | error of the shape: true | told | ratio |\n|---|---|---|---|---|")
    for case in CASES:
        compare(checks, case, whole)
    _, summary = run_of(checks, "slow", strip(8, STEEL, 10, 0.2, 0.02))
    checks.that(not any("coarse for the shape" in line["text"] for line in summary["warnings"]), "slow cooling is not warned of", summary["warnings"])
    _, summary = run_of(checks, "even", strip(8, AUSTENITE, 10, 10, 10))
    told = summary["accuracy"].get("shape", {"curvature": 0.})
    checks.that(told["curvature"] == 0., "alike on both sides: no curvature", told)
    _, summary = run_of(checks, "elastic", strip(4, AUSTENITE, 10, 0.02, 0.01))
    checks.that("shape" not in summary["accuracy"], "what does not flow leaves no shape", summary["accuracy"])
    on_new_mesh(checks)
    checks.end()


if __name__ == "__main__":
    main()
