#!/usr/bin/env python3
"""Meshes without zones in whole runs of remdata: its messages when Gmsh fails, and shapes of bodies by the free mesher and by Gmsh.

usage: run_gmsh.py [-v] [-k]

Failures are those of programs that stand in for remdata_gmsh (REMDATA_GMSH in the environment). Shapes of elements and areas are
found here from the nodes of the new checkpoints. The free mesher has Gmsh hidden; where the build found no Gmsh, its shapes are left out.
"""
import json
import os
import subprocess
import sys
import time

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "runs"))
from support import BIN, DONE, INPUT, NO_CONVERGENCE, Checks, run, said, with_h5py, write  # noqa: E402

with_h5py()
import h5py  # noqa: E402
import numpy as np  # noqa: E402
from run_zones import Mesh  # noqa: E402

REMESH = 4
HIDDEN = {"REMDATA_GMSH": "/no/such/program"}
REMDATA = os.path.join(os.path.abspath(BIN), "remdata")
GMSH = os.path.join(os.path.abspath(BIN), "remdata_gmsh")
HEAD = """TITLE  Bodies without zones
STATE  PLSTN
KINEM  LOG
LAW    metal EPLA
   70000. 0.33
   LINEAR 200. 200.
STRAT  0.1 1.E-6 0.1   4 3
"""
# An L with a round re-entrant corner and a round end: vertical tangents, seven corners.
BRACKET = HEAD + """BODY   bracket PL8LS 4 metal
   SEGM   0. 0.     12. 0.
   ARC    12. 0.    13.6 1.6   12. 3.2   1.E-3
   SEGM   12. 3.2   6. 3.2
   ARC    6. 3.2    6-sqrt(2) 5.2-sqrt(2)   4. 5.2   1.E-4
   SEGM   4. 5.2    4. 10.
   SEGM   4. 10.    0. 10.
   SEGM   0. 10.    0. 0.
FIXED  bracket 7 X
FIXED  bracket 1 Y
MOVE   bracket 6 Y down
LIC    down
   0. 0.   1. -0.02
REMSH
   SIZE 0.2 0.8
   TURN 20.
{more}END
"""
# Two discs that do not touch, one small.
DISCS = HEAD + """BODY   large PL8LS 4 metal
   ARC    3. 0.   0. 3.   -3. 0.   1.E-4
   ARC    -3. 0.   0. -3.   3. 0.   1.E-4
BODY   small PL8LS 9 metal
   ARC    6. 0.   5. 1.   4. 0.   1.E-4
   ARC    4. 0.   5. -1.   6. 0.   1.E-4
FIXED  large 1 XY
FIXED  small 1 XY
MOVE   small 2 Y down
LIC    down
   0. 0.   1. -0.02
REMSH
   SIZE 0.1 0.5
END
"""
# Sharp corners.
WEDGE = HEAD + """BODY   wedge PL8LS 4 metal
   SEGM   1.3 1.2   -1.5 2.2
   SEGM   -1.5 2.2   -0.6 -2.6
   SEGM   -0.6 -2.6   1.3 1.2
FIXED  wedge 1 XY
MOVE   wedge 2 Y down
LIC    down
   0. 0.   1. -0.02
REMSH
   SIZE 0.1 0.3
END
"""
# A disc as one block: its corners are flat, and zones can do no better.
ROUND_BLOCK = HEAD + """BLOCK  disc PL8LS 4 metal
   -1. -1.   1. -1.   1. 1.   -1. 1.
   4 1.   4 1.
   SIDE 1 ARC 0. 0.
   SIDE 2 ARC 0. 0.
   SIDE 3 ARC 0. 0.
   SIDE 4 ARC 0. 0.
FIXED  disc 1 XY
MOVE   disc 3 Y down
LIC    down
   0. 0.   1. -0.02
REMSH
   TIMES 0.5
   SIZE 0.2 0.4
{more}END
"""
TWO_BLOCKS = HEAD + """BLOCK  one PL8LS 4 metal
   0. 0.   2. 0.   2. 2.   0. 2.
   3 1.   3 1.
BLOCK  two PL8LS 4 metal
   2. 0.   4. 0.   4. 2.   2. 2.
   3 1.   3 1.
JOIN   one 2 two 4
FIXED  one 4 X
FIXED  one 1 Y
FIXED  two 1 Y
MOVE   two 2 X pull
LIC    pull
   0. 0.   1. 0.1
REMSH
   TIMES 0.5
{more}END
"""


def ring(nr=4, nt=24, inner=1.0, outer=3.0):
    """A ring of PL8LS cards in one group, its hole pulled open on a quarter of it."""
    label, nodes = {}, ["NODES"]
    for j in range(2 * nt):
        for i in range(2 * nr + 1):
            if i % 2 and j % 2:
                continue
            radius, angle = inner + (outer - inner) * i / (2 * nr), np.pi * j / nt
            label[i, j] = len(label) + 1
            nodes.append(f"   {label[i, j]}  {radius * np.cos(angle)!r} {radius * np.sin(angle)!r}".replace("np.float64", ""))
    elements, hole, rim = ["PL8LS  wheel 4 metal"], ["SIDES  hole"], ["SIDES  rim"]
    places = ((0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1))
    for j in range(nt):
        for i in range(nr):
            number = len(elements)
            elements.append(f"   {number}  " + " ".join(str(label[2 * i + a, (2 * j + b) % (2 * nt)]) for a, b in places))
            hole += [f"   {number} 4"] if i == 0 and j < nt // 4 else []
            rim += [f"   {number} 2"] if i == nr - 1 and nt // 2 <= j < 3 * nt // 4 else []
    return HEAD + "\n".join(nodes + elements + hole + rim) + """
FIXED  rim XY
MOVE   hole X push
LIC    push
   0. 0.   1. 0.1
REMSH
   TIMES 0.5
   SIZE 0.15 0.6
END
"""


def remdata(checkpoint, new, *options, **environment):
    """Run remdata; its result, and its facts."""
    if os.path.exists(new):
        os.remove(new)
    result = subprocess.run([REMDATA, checkpoint, "--out", new, "--quiet", *options], text=True, stdin=subprocess.DEVNULL,
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False, env={**os.environ, **environment})
    with open(new + ".json", encoding="utf-8") as file:
        return result, json.load(file)


def stop_of(checks, name, text):
    """The checkpoint of a deck where a new mesh is due."""
    deck, out = write(checks.path(name + ".lag"), text), checks.path(name)
    result = run([deck, "--out", out, "--threads", "1"])
    checks.that(result.returncode == REMESH, f"{name}: a mesh is due", said(result))
    return os.path.join(out, name + ".ckp.h5")


def stand_in(checks, name, script):
    """A program in place of remdata_gmsh."""
    path = write(checks.path(name + ".sh"), "#!/bin/sh\n" + script)
    os.chmod(path, 0o755)
    return path


def fails(checks, checkpoint, name, program, words, *options):
    """One clear line, the stage, code 3, and nothing left behind."""
    new = checks.path(name.replace(" ", "_"), "new.h5")
    os.makedirs(os.path.dirname(new), exist_ok=True)
    started = time.monotonic()
    result, facts = remdata(checkpoint, new, *options, REMDATA_GMSH=program)
    lines = result.stderr.splitlines()
    checks.that(result.returncode == NO_CONVERGENCE, f"{name}: code 3", said(result))
    checks.that(len(lines) == 2 and words in lines[0], f"{name}: reported in one line", result.stderr)
    checks.that(lines and "ZONE cards" in lines[-1], f"{name}: with advice", result.stderr)
    checks.that(facts["stage"] == "mesh" and not facts["accepted"] and words in facts["reason"], f"{name}: stage", facts)
    checks.that(os.listdir(os.path.dirname(new)) == ["new.h5.json"], f"{name}: nothing is left", os.listdir(os.path.dirname(new)))
    checks.that(time.monotonic() - started < 20, f"{name}: in time")


def failures(checks, checkpoint):
    """All ways in which a program can fail to make a mesh."""
    def one(name, script, words, *options):
        fails(checks, checkpoint, name, stand_in(checks, name.replace(" ", "_"), script), words, *options)

    fails(checks, checkpoint, "missing", checks.path("no_such_program"), "cannot be started")
    one("crash", "kill -SEGV $$\n", "Gmsh crashed, signal 11")
    one("hang", "exec sleep 1000\n", "Gmsh gave no mesh in 0.3 s", "--limit", "0.3")
    one("error", "echo; echo Self intersections in surface 1; exit 7\n", "exit code 7: Self intersections in surface 1")
    one("no file", "exit 0\n", "no mesh of the contour: there is no mesh")
    one("rubbish", "head -c 5000 /dev/urandom >$2\n", "no mesh of the contour: it has no nodes")
    one("empty", "printf '$Nodes\\n0\\n' >$2\n", "no mesh of the contour: it has no nodes")
    one("bad node", "printf '$Nodes\\n2\\n1 0 0 0\\n2 nan 0 0\\n' >$2\n", "row 2 of its nodes is invalid")
    one("cut short", "printf '$Nodes\\n1\\n1 0 0 0\\n$EndNodes\\n$Elements\\n2\\n1 15 2 0 1 1\\n' >$2\n",
        "row 2 of its elements is invalid")
    one("another contour", "printf '$Nodes\\n4\\n1 0 0 0\\n2 1 0 0\\n3 1 1 0\\n4 0 1 0\\n$EndNodes\\n$Elements\\n1\\n"
        "1 3 2 0 1 1 2 3 4\\n' >$2\n", "the points of the contour are missing")
    if os.path.exists(GMSH):
        one("without an element", f"{GMSH} $1 $2; sed -i '0,/^[0-9]* 3 2/{{/^[0-9]* 3 2/s/.*/1 15 2 0 1 1/}}' $2\n",
            "do not fill the contour")


def shape(checks, name, deck, area, contours, mesher, least):
    """A mesh of a body: good elements, the whole area (None: that of the old mesh), so many contours."""
    checkpoint = stop_of(checks, f"{name} {mesher}", deck)
    new = checks.path(f"{name} {mesher}.new.h5")
    result, facts = remdata(checkpoint, new, **({} if mesher == "gmsh" else HIDDEN))
    name = f"{name} by {mesher}"
    if not checks.that(result.returncode == DONE, f"{name}: done", said(result)):
        return
    checks.that(facts["mesh"]["mesher"] == mesher, f"{name}: made by it", facts)
    checks.that(facts["mesh"]["scaled_jacobian"] > least, f"{name}: shape", facts["mesh"])
    mesh = Mesh(new)
    with h5py.File(new, "r") as file:
        groups = [g for g in file["groups"] if 8 in file[f"groups/{g}/connectivity"].shape]
        mesh.elements = np.vstack([Mesh.rows(file[f"groups/{g}/connectivity"][()], 8) for g in groups]) - 1
    area = area or Mesh(checkpoint).volume(False)
    checks.that(mesh.jacobians().min() > 0.1, f"{name}: Jacobians", mesh.jacobians().min())
    checks.that(abs(mesh.volume(False) / area - 1) < 1e-3, f"{name}: area", (mesh.volume(False), area))
    sides = {}
    for e in mesh.elements:
        for i in range(4):
            sides.setdefault(e[4 + i], []).append((e[i], e[(i + 1) % 4]))
    after = dict(ends[0] for ends in sides.values() if len(ends) == 1)
    loops = 0
    while after:
        start, node = None, next(iter(after))
        while node in after:
            start, node = node, after.pop(node)
        loops += 1
    checks.that(loops == contours, f"{name}: contours", loops)
    checks.that(all(len(ends) <= 2 for ends in sides.values()), f"{name}: sides are those of two elements at most")


def bodies(checks):
    """Shapes that zones are not given for."""
    by_gmsh = "   MESHER GMSH\n"
    ring_by_gmsh = ring().replace("   TIMES 0.5\n", "   TIMES 0.5\n" + by_gmsh)
    cases = [("bracket", BRACKET.format(more=""), BRACKET.format(more=by_gmsh), 12 * 3.2 + 4 * 6.8 + 4 - np.pi + np.pi * 1.6**2 / 2, 1),
             ("discs", DISCS, DISCS.replace("END\n", by_gmsh + "END\n"), 10 * np.pi, 2),
             ("wedge", WEDGE, WEDGE.replace("END\n", by_gmsh + "END\n"), 6.27, 1),
             ("ring", ring(), ring_by_gmsh, None, 2),
             ("disc", ROUND_BLOCK.format(more=""), ROUND_BLOCK.format(more=by_gmsh), None, 1)]
    for name, deck, gmsh_deck, area, contours in cases:
        shape(checks, name, deck, area, contours, "free", 0.55)
        if os.path.exists(GMSH):
            shape(checks, name, gmsh_deck, area, contours, "gmsh", 0.35)
    result, _ = remdata(stop_of(checks, "flat", ROUND_BLOCK.format(more="   MESHER ZONES\n")), checks.path("flat.h5"))
    checks.that(result.returncode == NO_CONVERGENCE and "bad shape" in result.stderr, "a disc by zones alone: refused", said(result))

    # a limited number of elements, and a file that says what it cost
    result, facts = remdata(stop_of(checks, "few", BRACKET.format(more="   COUNT 60\n")), checks.path("few.h5"))
    checks.that(result.returncode == DONE and 40 < facts["new_elements"] <= 60, "at most 60 elements", said(result))
    checks.that(facts["mesh"]["coarser"] > 1.1, "at most 60 elements: reported", facts["mesh"])

    # zones alone, where there are none: what is wrong with zones
    result, facts = remdata(stop_of(checks, "alone", BRACKET.format(more="   MESHER ZONES\n")), checks.path("alone.h5"))
    checks.that(result.returncode == INPUT and facts["stage"] == "mesh", "zones alone: refused", said(result))
    checks.that("corners cannot be meshed without zones, expected four" in result.stderr, "zones alone: reported", result.stderr)
    # sides inside a body have no place on another mesh, whoever makes it
    for mesher in ("ZONES", "GMSH", "FREE"):
        name = f"inner sides, {mesher}"
        text = ring().replace("SIDES  rim", "SIDES  inner\n   5 2\nSIDES  rim").replace("FIXED  rim XY", "FIXED  rim XY\nFIXED  inner X")
        text = text.replace("   TIMES 0.5", f"   TIMES 0.5\n   MESHER {mesher}")
        result, _ = remdata(stop_of(checks, f"inner_{mesher}", text), checks.path("inner.h5"))
        checks.that(result.returncode == INPUT and "the sides inner lie inside a body" in result.stderr, name, said(result))
    # bodies that share sides are blocks, hence zones; without zones the sides between them are seams, which keep their nodes
    result, facts = remdata(stop_of(checks, "blocks", TWO_BLOCKS.format(more="")), checks.path("blocks.h5"))
    checks.that(result.returncode == DONE and facts["mesh"]["mesher"] == "zones", "joined blocks: by zones", said(result))
    for mesher in ("GMSH", "FREE") if os.path.exists(GMSH) else ("FREE",):
        result, facts = remdata(stop_of(checks, f"joined_{mesher}", TWO_BLOCKS.format(more=f"   MESHER {mesher}\n")),
                                checks.path("joined.h5"))
        checks.that(result.returncode == DONE and facts["mesh"]["mesher"] == mesher.lower(), f"joined blocks: by {mesher}", said(result))
        with h5py.File(checks.path("joined.h5"), "r") as file:
            x = Mesh.rows(file["mesh/coordinates"][()], 2) + Mesh.rows(file["fields/displacement/value"][()], 2)
            one, two = (set((Mesh.rows(file[f"groups/{k}/connectivity"][()], 8) - 1).ravel()) for k in (1, 2))
        shared = x[sorted(one & two)]
        checks.that(len(shared) >= 5 and np.ptp(shared[:, 0]) < 1e-9 and np.ptp(shared[:, 1]) > 1.9,
                    f"joined blocks: by {mesher}, with the nodes of the sides between them in common", shared)



def main():
    checks = Checks()
    checkpoint = stop_of(checks, "asked", BRACKET.format(more="   MESHER GMSH\n"))
    failures(checks, checkpoint)
    bodies(checks)
    checks.end()


if __name__ == "__main__":
    main()
