#!/usr/bin/env python3
"""Bodies of unlike steel, joined and remeshed: what is between them stays the curve that it has become.

usage: run_two_materials.py [-v] [-k]

Two discs on top of each other, whose sides fold onto the dies so that zones are divided, and a core in a shell, upset to 50 %, three steels that meet in a point (the zones given by cards), and a
hard inclusion. By zones and by the free mesher. Volumes of the materials and the way of new nodes from the old interface, parabolas through three nodes, are found
here from the nodes of the checkpoints; forces are compared with those of a mesh twice as fine that is never remeshed. With straight
sides between the zones the discs lost and won 6 % of their volumes at the first remesh, the core 7 %.
"""
import os
import sys

sys.dont_write_bytecode = True
from remeshed import cycle, facts, tries, value_at, within_limits  # noqa: E402
from support import DONE, NO_CONVERGENCE, Checks, history, run, said, with_h5py, write  # noqa: E402

with_h5py()
import h5py  # noqa: E402
import numpy as np  # noqa: E402

LARGEST_CHANGE, ON_INTERFACE, LARGEST_DEVIATION, LARGEST_MEAN_DEVIATION, LEAST_TILT = 1e-3, 1e-9, 0.02, 0.015, 0.1
SIZE = 10.0
STEELS = {"mild": 300.0, "tough": 600.0, "third": 450.0}
SIDES = ((0, 4, 1), (1, 5, 2), (2, 6, 3), (3, 7, 0))
REMESH = "REMSH\n   TIMES 0.4 0.7 0.9\n   SIZE 0.6 2.0\n"


def deck(title, state, blocks, places, die, travel, steels, remesh):
    """A deck of blocks (name, law, corners, divisions) between two dies."""
    lines = [f"TITLE  {title}", f"STATE  {state}", "KINEM  LOG", "PARAM  n 8"]
    for name, law, corners, along, up in blocks:
        lines += [f"BLOCK  {name} PL8LS 4 {law}", "   " + "   ".join(f"{x} {y}" for x, y in corners), f"   {along} 1.   {up} 1."]
    lines += places
    for law in steels:
        lines += [f"LAW    {law} EPLA", "   200000. 0.3", f"   LINEAR {STEELS[law]} 300."]
    lines += ["LAW    rough COUL2D", f"   PENETR 1.E-3   PHI {die}   AUGMENT 10",
              f"DIE    upper PILOT 0. {SIZE}", f"   SEGM   30. {SIZE}   -30. {SIZE}",
              "DIE    lower PILOT 0. 0.", "   SEGM   -30. 0.   30. 0.",
              "MOVE   upper Y press", "LIC    press", f"   0. 0.   1. {-travel}", "STRAT  0.01 1.E-5 0.04   5 3"]
    return "\n".join(lines) + "\n" + remesh + "END\n"


def box(x, y, width, height):
    """Corners of a block."""
    return [(x, y), (x + width, y), (x + width, y + height), (x, y + height)]


def discs(remesh):
    return deck("Two discs of unlike steel", "AXISYM",
                [("soft", "mild", box(0.0, 0.0, 10.0, 5.0), "$n", "$n/2"), ("hard", "tough", box(0.0, 5.0, 10.0, 5.0), "$n", "$n/2")],
                ["JOIN   soft 3 hard 1", "CNT2D  hard 2 3 upper -3 rough", "CNT2D  soft 1 2 lower -3 rough",
                 "FIXED  hard 4 X", "FIXED  soft 4 X"], 0.3, 5.0, ["mild", "tough"], remesh)


def core_and_shell(remesh):
    return deck("A core in a softer shell", "AXISYM",
                [("core", "tough", box(0.0, 0.0, 5.0, 10.0), "$n/2", "$n"), ("shell", "mild", box(5.0, 0.0, 5.0, 10.0), "$n/2", "$n")],
                ["JOIN   core 2 shell 4", "CNT2D  core 3 upper -3 rough", "CNT2D  shell 2 3 upper -3 rough",
                 "CNT2D  core 1 lower -3 rough", "CNT2D  shell 1 2 lower -3 rough", "FIXED  core 4 X"],
                0.15, 5.0, ["mild", "tough"], remesh)


THREE_BY_CARDS = """ZPNT   a CORNER 0. 0. MATTER
ZPNT   b CORNER 10. 0. MATTER
ZPNT   c CORNER 10. 10. MATTER
ZPNT   d CORNER 0. 10. MATTER
ZPNT   l MATTER 0. 5.
ZPNT   r ON Y 3.5 RIGHT                                  ! goes to where the interface ends
ZPNT   f MATTER 5. 0.
ZPNT   g MATTER 4.8 10.
ZPNT   j AT 5. 4.                                        ! goes to where the three meet
ZONE   one c1
   a f j l
ZONE   two c2
   f b r j
ZONE   three a
   l j g d
ZONE   four b
   j r c g
"""


def three_steels(remesh):
    return deck("Three steels meet in a point", "PLSTN",
                [("c1", "third", box(0.0, 0.0, 5.0, 5.0), "$n/2", "$n/2"), ("c2", "third", box(5.0, 0.0, 5.0, 5.0), "$n/2", "$n/2"),
                 ("a", "mild", box(0.0, 5.0, 5.0, 5.0), "$n/2", "$n/2"), ("b", "tough", box(5.0, 5.0, 5.0, 5.0), "$n/2", "$n/2")],
                ["JOIN   c1 2 c2 4", "JOIN   c1 3 a 1", "JOIN   c2 3 b 1", "JOIN   a 2 b 4", "CNT2D  a 3 upper -3 rough",
                 "CNT2D  b 2 3 upper -3 rough", "CNT2D  c1 1 lower -3 rough", "CNT2D  c2 1 2 lower -3 rough",
                 "FIXED  c1 4 X", "FIXED  a 4 X"], 0.1, 4.0, ["mild", "tough", "third"], remesh)


def inclusion(remesh):
    ring = [((0.0, 0.0), (10.0, 0.0), (7.0, 3.5), (3.0, 3.5)), ((10.0, 0.0), (10.0, 10.0), (7.0, 6.5), (7.0, 3.5)),
            ((10.0, 10.0), (0.0, 10.0), (3.0, 6.5), (7.0, 6.5)), ((0.0, 10.0), (0.0, 0.0), (3.0, 3.5), (3.0, 6.5))]
    blocks = [("in", "tough", box(3.0, 3.5, 4.0, 3.0), "$n/2", "$n/2")]
    blocks += [(name, "mild", corners, "$n/2", "$n/2") for name, corners in zip("senw", ring)]
    joints = [f"JOIN   {name} 3 in {k}" for k, name in enumerate("senw", 1)]
    joints += [f"JOIN   {one} 2 {other} 4" for one, other in ("se", "en", "nw", "ws")]
    return deck("A hard inclusion", "PLSTN", blocks, joints + ["CNT2D  n 1 upper -3 rough", "CNT2D  s 1 lower -3 rough", "FIXED  w 1 X"],
                0.1, 2.5, ["mild", "tough"], remesh)


class Mesh:
    """Nodes now and the elements of each material of a checkpoint; materials are groups of bodies."""

    def __init__(self, path, materials, axisymmetric):
        with h5py.File(path, "r") as file:
            def rows(name, width):
                array = file[name][()]
                return array if array.shape[1] == width else array.T

            self.x = rows("mesh/coordinates", 2) + rows("fields/displacement/value", 2)
            groups = [rows(f"groups/{k}/connectivity", 8) - 1 for k in range(1, 1 + sum(len(m) for m in materials))]
            self.sets = {one.attrs["name"].decode(): one["nodes"][()].reshape(-1, 3) - 1 for one in file["mesh/sides"].values()}
        self.elements = [np.concatenate([groups[k] for k in m]) for m in materials]
        self.axisymmetric = axisymmetric
        owner, self.interface, alone = {}, [], {}
        for m, elements in enumerate(self.elements):
            for element in elements:
                for a, b, c in SIDES:
                    middle = element[b]
                    if middle in owner and owner[middle] != m:
                        self.interface.append((element[a], middle, element[c]))
                    if middle in owner:
                        alone.pop(middle)
                    else:
                        owner[middle], alone[middle] = m, (element[a], element[c])
        self.contour = {node for ends in alone.values() for node in ends}

    def volumes(self):
        """Area of each material, or volume over one radian, by 3 x 3 Gauss points: exact."""
        totals = np.zeros(len(self.elements))
        for r, a in zip(*np.polynomial.legendre.leggauss(3)):
            for s, b in zip(*np.polynomial.legendre.leggauss(3)):
                by_r = (shapes(r + 0.5, s) - shapes(r - 0.5, s))   # differences are exact for quadratics
                by_s = (shapes(r, s + 0.5) - shapes(r, s - 0.5))
                for m, elements in enumerate(self.elements):
                    points = self.x[elements]
                    along, up = np.einsum("k,ekc->ec", by_r, points), np.einsum("k,ekc->ec", by_s, points)
                    radius = points[:, :, 0] @ shapes(r, s) if self.axisymmetric else 1.0
                    totals[m] += a * b * np.sum((along[:, 0] * up[:, 1] - along[:, 1] * up[:, 0]) * radius)
        return totals

    def way_from(self, old):
        """Farthest that nodes of the interface are from the old one: beside its ends on the contour, and elsewhere."""
        beside = elsewhere = 0.0
        middles = old.x[[side[1] for side in old.interface]]
        for node in {node for side in self.interface for node in side}:
            close = np.argsort(np.linalg.norm(middles - self.x[node], axis=1))[:4]
            way, nearest = min((distance(self.x[node], old.x[list(old.interface[k])]), k) for k in close)
            if old.contour & set(old.interface[nearest]):
                beside = max(beside, way)
            else:
                elsewhere = max(elsewhere, way)
        return beside, elsewhere

    def is_set(self, name):
        """The sides of a set are those of the interface, one after another."""
        sides = self.sets[name]
        return {side[1] for side in sides} == {side[1] for side in self.interface} and all(sides[1:, 0] == sides[:-1, 2])

    def tilt(self):
        """Largest sine of the angle between a side of the interface and the axis it lay along at the start."""
        chords = np.abs([self.x[c] - self.x[a] for a, _, c in self.interface])
        return max(chords.min(axis=1) / np.linalg.norm(chords, axis=1))


def shapes(r, s):
    """Shape functions of the 8-node element."""
    corners = [((1 + r * a) * (1 + s * b) * (r * a + s * b - 1)) / 4 for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    return np.array(corners + [(1 - r * r) * (1 - s) / 2, (1 + r) * (1 - s * s) / 2, (1 - r * r) * (1 + s) / 2, (1 - r) * (1 - s * s) / 2])


def distance(point, p):
    """From a point to a parabola: Newton's method from the nearest of 41 places."""
    def at(t):
        return p[0] * t * (t - 1) / 2 + p[1] * (1 - t * t) + p[2] * t * (t + 1) / 2

    xi = min(np.linspace(-1, 1, 41), key=lambda t: np.linalg.norm(at(t) - point))
    second = p[0] - 2 * p[1] + p[2]
    for _ in range(20):
        first = p[0] * (xi - 0.5) - 2 * xi * p[1] + p[2] * (xi + 0.5)
        xi = min(max(xi - (at(xi) - point) @ first / (first @ first + (at(xi) - point) @ second), -1.0), 1.0)
    return np.linalg.norm(at(xi) - point)


def follow(checks, name, text, materials, axisymmetric, remeshings, sets=()):
    """A cycle, its meshes looked at; folder of the results."""
    out = checks.path(name)
    result = cycle(write(checks.path(name + ".lag"), text), out)
    checks.that(result.returncode == DONE, f"{name}: the cycle ends by itself", said(result))
    made = tries(out)
    checks.that(len(made) == remeshings and all(t["accepted"] == "y" for t in made),
                f"{name}: {remeshings} new meshes, each taken at the first try", [t["reason"] for t in made])
    within_limits(checks, out)
    for g in range(2, 2 + remeshings):
        old = Mesh(os.path.join(out, f"{name}.g{g - 1:02d}.end.h5"), materials, axisymmetric)
        new = Mesh(os.path.join(out, f"{name}.g{g:02d}.start.h5"), materials, axisymmetric)
        said_of = facts(out, g, "start")
        change = new.volumes() / old.volumes() - 1
        checks.that(np.all(np.abs(change) < LARGEST_CHANGE), f"{name}, mesh {g}: each material keeps its volume", change)
        reported = [m["volume_after"] / m["volume_before"] - 1 for m in said_of["materials"]]
        checks.that(len(reported) == len(change) and np.allclose(reported, change, rtol=0, atol=1e-12),
                    f"{name}, mesh {g}: remdata states the same", (reported, change))
        beside, elsewhere = new.way_from(old)
        checks.that(elsewhere < ON_INTERFACE * SIZE, f"{name}, mesh {g}: nodes lie on the old interface", elsewhere)
        checks.that(beside < said_of["contour"]["largest_move"] + ON_INTERFACE * SIZE,
                    f"{name}, mesh {g}: beside the contour they go with it", beside)
        for one in sets:
            checks.that(new.is_set(one), f"{name}, mesh {g}: set {one} is what is between the bodies", new.sets[one])
        print(f"{name:8} mesh {g}: volumes {' '.join(f'{100 * c:+.4f} %' for c in change)}, off the interface {elsewhere:.1e},"
              f" beside the contour {beside:.1e}, tilt {old.tilt():.2f}")
    checks.that(old.tilt() > LEAST_TILT, f"{name}: the interface is no longer straight", old.tilt())
    return out


def twice_as_fine(checks, name, text):
    """A run with a finer mesh that is never remeshed; folder of the results."""
    plain = checks.path(name + "_plain")
    result = run([write(checks.path(name + "_plain.lag"), text), "--out", plain, "--threads", "1", "-p", "n=16"])
    checks.that(result.returncode == DONE, f"{name}: twice as fine without remeshing", said(result))
    return plain


def compare_forces(checks, name, out, plain, travel):
    """Forces of a cycle with those of a finer mesh: on both sides of new meshes, and their means over tenths of the way. Near the end
    sides fold onto the die, by which the force of either mesh jumps within one step, of the finer by 6 %, at places of its own."""
    here, there = history(out), history(plain)
    for rows in (here, there):
        rows["travel"] = [-u for u in rows["displacement_y_upper"]]
    for share in (0.2, 0.39, 0.41, 0.5, 0.69, 0.71, 0.8, 0.89, 0.91):
        one, other = (value_at(rows, "force_y_upper", "travel", share * travel) for rows in (here, there))
        checks.that(abs(one / other - 1) < LARGEST_DEVIATION, f"{name}: force at {share:.0%} of the way", f"{one / other - 1:+.2%}")
    for tenth in range(1, 10):
        one, other = (sum(value_at(rows, "force_y_upper", "travel", (tenth + k/20) / 10 * travel) for k in range(21)) for rows in (here, there))
        checks.that(abs(one / other - 1) < LARGEST_MEAN_DEVIATION, f"{name}: mean force from {tenth/10:.0%} of the way on",
                    f"{one / other - 1:+.2%}")


def refusals(checks):
    """Zones that do not keep the bodies apart, told in words."""
    cases = {
        "zones": (discs(REMESH + "ZPNT   a CORNER 0. 0. MATTER\nZPNT   b CORNER 10. 0. MATTER\nZPNT   c CORNER 10. 10. MATTER\n"
                        "ZPNT   d CORNER 0. 10. MATTER\nZPNT   l MATTER 0. 5.\nZPNT   r MATTER 10. 5.\nZPNT   m AT 5. 3.\n"
                        "ZPNT   s MATTER 5. 0.\nZPNT   u MATTER 5. 10.\nZONE   one soft\n   a s m l\nZONE   two soft\n   s b r m\n"
                        "ZONE   three hard\n   l m u d\nZONE   four soft\n   m r c u\n"), "the bodies soft and hard near x = ", "lies on no interface"),
    }
    for name, (text, *words) in cases.items():
        out = checks.path("refused_" + name)
        result = cycle(write(checks.path(name + ".lag"), text), out, "--tries", "0")
        reported = result.stdout + result.stderr
        checks.that(result.returncode == NO_CONVERGENCE and all(word in reported for word in words), f"{name}: refused in words", reported)


def main():
    checks = Checks()
    pair = [[0], [1]]
    for name, make, sets in (("discs", discs, ("soft.3", "hard.1")), ("core", core_and_shell, ("core.2", "shell.4"))):
        plain = twice_as_fine(checks, name, make(""))
        for mesher in ("ZONES", "FREE"):
            out = follow(checks, f"{name}_{mesher.lower()}", make(REMESH + f"   MESHER {mesher}\n"), pair, True, 3, sets)
            compare_forces(checks, f"{name} {mesher}", out, plain, 5.0)
    follow(checks, "three", three_steels(REMESH + THREE_BY_CARDS), [[0, 1], [2], [3]], False, 3)
    follow(checks, "in", inclusion(REMESH.replace("0.6 2.0", "0.4 2.0")), [[0], [1, 2, 3, 4]], False, 3)
    refusals(checks)
    checks.end()


if __name__ == "__main__":
    main()
