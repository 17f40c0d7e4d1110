#!/usr/bin/env python3
"""Profiles along lines and sides, of lagareport and of the package: against closed forms and against the forces of the history."""
import csv
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
SOURCE = os.path.abspath(os.environ.get("LAGAMINE_SOURCE") or os.path.dirname(os.path.dirname(HERE)))
BIN = os.path.abspath(os.environ.get("LAGAMINE_BIN") or os.path.join(SOURCE, "build", "bin"))
sys.path.insert(0, os.path.join(SOURCE, "src", "report"))
sys.dont_write_bytecode = True
import lagamine  # noqa: E402
from lagamine_report.contact import contact_points  # noqa: E402
from lagamine_report.geometry import quad8, side_points  # noqa: E402
from lagamine_report.profiles import _quad8_slopes, find_places  # noqa: E402
from lagamine_report.reader import Run  # noqa: E402
from lagamine_report.tractions import recovered_tractions, side_weights  # noqa: E402

# A block pressed by a flat die, friction along its side; a second body beside it, 1 apart.
BLOCKS = """TITLE  Two blocks
STATE  PLSTN
KINEM  LOG
BLOCK  a PL8LS 4 m
   0. 0.   4. 0.   4. 2.   0. 2.
   8 1.   4 1.
BLOCK  b PL8LS 4 m
   5. 0.   7. 0.   7. 2.   5. 2.
   4 1.   4 1.
LAW    m ELA
   1000. 0.3
LAW    c COUL2D
   PENETR 1.E-3   PHI 0.2
DIE    flat PILOT 0. 2.
   SEGM   9. 2.   -1. 2.
CNT2D  a 3 flat -3 c
FIXED  a 1 X
FIXED  a 1 Y
FIXED  b 1 X
FIXED  b 1 Y
LIC    press
   0. 0.   1. -0.05
MOVE   flat Y press
STRAT  0.25 1.E-4 0.25   5 3
SAVE   1
END
"""


class Profiles(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp(prefix="lagareport-profiles-")
        cls.addClassCleanup(shutil.rmtree, cls.folder, True)
        os.environ["OMP_NUM_THREADS"] = "1"
        path = os.path.join(cls.folder, "blocks.lag")
        with open(path, "w", encoding="ascii") as file:
            file.write(BLOCKS)
        cls.run_ = lagamine.run(path, os.path.join(cls.folder, "blocks"), programs=BIN)

    def report(self, *arguments):
        return subprocess.run([os.path.join(BIN, "lagareport"), *arguments], capture_output=True, text=True, cwd=self.folder, check=False,
                              env=dict(os.environ, PYTHONDONTWRITEBYTECODE="1"))

    def table(self, name):
        with open(os.path.join(self.folder, "blocks", name), newline="", encoding="utf-8") as file:
            rows = list(csv.reader(file))
        return dict(zip(rows[0], np.array(rows[1:], dtype=float).T))

    def test_places_in_bent_elements(self):
        """Points made from parent coordinates are found where they were made."""
        rng = np.random.default_rng(4)
        square = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1], [0, -1], [1, 0], [0, 1], [-1, 0]], dtype=float)
        nodes = square + 0.15 * rng.uniform(-1, 1, square.shape)
        parent = rng.uniform(-1, 1, (50, 2))
        points = quad8(parent[:, 0], parent[:, 1]) @ nodes
        element, found = find_places(nodes, np.arange(8)[None], points)
        self.assertTrue((element == 0).all())
        np.testing.assert_allclose(found, parent, atol=1e-9)
        self.assertTrue((find_places(nodes, np.arange(8)[None], points + 5)[0] < 0).all())
        step = 1e-6
        for j, change in enumerate(np.eye(2) * step):
            ahead, behind = (quad8(*(parent + sign * change).T) for sign in (1, -1))
            np.testing.assert_allclose(_quad8_slopes(parent)[:, :, j], (ahead - behind) / (2 * step), atol=1e-9)

    def test_stress_of_a_cylinder(self):
        """Lame's solution on a skew line through a quarter of the section's height."""
        with open(os.path.join(SOURCE, "decks", "thick_cylinder", "thick_cylinder.lag"), encoding="utf-8") as file:
            text = file.read()
        path = os.path.join(self.folder, "cylinder.lag")
        with open(path, "w", encoding="utf-8") as file:      # a pressure so small that the radius does not change
            file.write(text.replace("10. load", "1.E-6 load"))
        run = lagamine.run(path, os.path.join(self.folder, "cylinder"), programs=BIN, nx=40)
        height = run.coordinates()[:, 1].max()
        held = run.line(3, 0.1 * height, 11, 0.9 * height, "stress_zz", places=401)
        self.assertGreaterEqual(held["x"].min(), 4 - 1e-9)
        self.assertLessEqual(held["x"].max(), 10 + 1e-6)
        self.assertAlmostEqual(6 / 8, len(held["x"]) / 401, delta=0.01)
        np.testing.assert_allclose(held["length"], np.hypot(held["x"] - 3, held["y"] - 0.1 * height), atol=1e-12)
        p, a, b = 1e-6, 4.0, 10.0
        exact = p * a**2 / (b**2 - a**2) * (1 + b**2 / held["x"]**2)
        inside = (held["x"] > 4.2) & (held["x"] < 9.8)      # at the ends nodal means are those of one element
        np.testing.assert_allclose(held["stress_zz"][inside], exact[inside], rtol=4e-3)

    def test_pressure_along_a_side_makes_the_force(self):
        """Consistent forces of Lobatto's rule (1/6, 4/6, 1/6 of each side): their sums are those of the history."""
        held = self.run_.side("a.3/flat")
        pressure, friction = (held[name].reshape(-1, 3) for name in ("pressure", "friction"))
        side = held["length"].reshape(-1, 3)
        weights = (side[:, 2] - side[:, 0])[:, None] * np.array([1, 4, 1]) / 6
        self.assertAlmostEqual(1.0, (weights * pressure).sum() / self.run_.history["force_y_flat"][-1], delta=1e-4)
        self.assertAlmostEqual(abs((weights * friction).sum()), abs(self.run_.history["force_x_flat"][-1]), delta=1e-4 * pressure.max())
        self.assertTrue((np.diff(held["length"]) >= 0).all())
        np.testing.assert_allclose(held["y"] - held["penetration"], 1.95, atol=1e-9)

    def test_recovered_tractions(self):
        """The force of the points, and no alternation: beside the corner, where the points alternate, and in Hertz' contact."""
        held = self.run_.side("a.3/flat")
        side = held["length"].reshape(-1, 3)
        weights = ((side[:, 2] - side[:, 0])[:, None] * np.array([1, 4, 1]) / 6).ravel()
        for name in ("pressure", "friction"):
            self.assertAlmostEqual((weights * held[name]).sum(), (weights * held[name + "_recovered"]).sum(),
                                   delta=2e-3 * (weights * held["pressure"]).sum())
        deck = os.path.join(SOURCE, "decks", "hertz", "hertz.lag")
        run = lagamine.run(deck, os.path.join(self.folder, "hertz"), programs=BIN)
        name = next(group for group in run.groups() if group.endswith("/ball"))
        held = run.side(name)
        force = abs(run.history["force_y_ball"][-1])
        r, shown, points = held["x"], held["pressure_recovered"], held["pressure"]
        # sphere: p0 (1 - r2/a2)^(1/2), force = 2/3 pi a2 p0; the mesh is coarse, so the points themselves are off
        p0 = points[r < 0.1].max()
        a = np.sqrt(1.5 * force / (np.pi * p0))
        inside = r < 0.85 * a
        self.assertGreater(inside.sum(), 5)
        exact = p0 * np.sqrt(1 - (r[inside] / a)**2)
        self.assertLess(np.abs(shown[inside] - exact).max(), 1.1 * np.abs(points[inside] - exact).max())
        self.assertTrue((np.diff(shown[np.argsort(r)][:inside.sum()]) < 0.02 * p0).all())

    def test_weights_of_a_side(self):
        for npoint, found in ((2, 2), (3, 3), (4, 4), (-3, 3), (-5, 5), (-9, 9), (-17, 17), (-33, 33), (-65, 65)):
            weights, xi = side_weights(npoint, found), side_points(npoint, found)
            self.assertAlmostEqual(2.0, weights.sum(), places=13)
            self.assertAlmostEqual(2 / 3, (weights * xi**2).sum(), places=13)

    def test_sides_with_a_control_point(self):
        """Values at the points of a cylinder's sides make the force by Simpson's rule; those of the control points in the middle do not."""
        path = os.path.join(self.folder, "bezier.lag")
        with open(path, "w", encoding="ascii") as file:
            file.write(BLOCKS.replace("PLSTN", "AXISYM").replace("-3 c", "BEZIER c"))
        made = lagamine.run(path, os.path.join(self.folder, "bezier"), programs=BIN)
        run = Run(os.path.join(self.folder, "bezier"))
        group = next(one for one in run.steps[-1].generation.groups if one.name == "a.3/flat")
        self.assertEqual("control point", group.rule)
        nodes = run.coordinates(run.steps[-1])[group.connectivity]
        slopes = np.stack([[-1.5, 2, -0.5], [-0.5, 0, 0.5], [0.5, -2, 1.5]])
        per_xi = np.hypot(*np.moveaxis(np.einsum("pk,skd->spd", slopes, nodes), 2, 0)) * nodes[..., 0]
        pressure = made.points("a.3/flat")["pressure"]
        force = made.history["force_y_flat"][-1]
        areas = 2 * np.pi * per_xi * side_weights(-3, 3)
        names, state = contact_points(run, run.steps[-1], group)
        shown = state[:, :, names.index("pressure")]
        np.testing.assert_array_equal(shown[:, 1], (pressure[:, 0] + 2 * pressure[:, 1] + pressure[:, 2]) / 4)
        self.assertAlmostEqual(1.0, (areas * shown).sum() / force, delta=1e-5)
        self.assertGreater(abs((areas * pressure).sum() / force - 1), 1e-3)
        recovered = recovered_tractions(run, run.steps[-1], group)[0].reshape(-1, 3)
        self.assertAlmostEqual(1.0, (areas * recovered).sum() / force, delta=1e-5)

    def test_tables_and_page(self):
        done = self.report("blocks", "--line", "0", "1", "8", "1", "--line", "1", "0", "1", "3", "--side", "a.3/flat", "--time", "0.5")
        self.assertEqual((0, ""), (done.returncode, done.stderr))
        for name in ("line_1.csv", "line_2.csv", "side_a.3_flat.csv"):
            self.assertIn(name, done.stdout)
        k = self.run_.instant(0.5)
        line, side = self.table("line_1.csv"), self.table("side_a.3_flat.csv")
        fields = [name for name in line if name not in ("length", "x", "y")]
        same = self.run_.line(0, 1, 8, 1, *fields, k=k)
        for name, values in line.items():
            np.testing.assert_array_equal(values, same[name])
        self.assertEqual(list(side), list(self.run_.side("a.3/flat", k)))
        # two bodies: nothing between them
        self.assertFalse(((line["x"] > 4.1) & (line["x"] < 4.95)).any())
        self.assertTrue((line["x"] > 5).any())
        with open(os.path.join(self.folder, "blocks", "report.html"), encoding="utf-8") as file:
            self.assertIn('id="profiles"', file.read())

    def test_refused(self):
        for words, message in ((("--line", "9", "9", "10", "10"), "meets no body"), (("--line", "1", "1", "1", "1"), "has no length"),
                               (("--side", "a"), "no contact 'a' at time 1; there are: a.3/flat"), (("--time", "1"), "--time: for --line and --side"),
                               (("--line", "0", "0", "1", "1", "--field", "heat"), "no such field"), (("--line", "0", "0", "1"), "expected 4")):
            done = self.report("blocks", *words)
            self.assertEqual(2, done.returncode, words)
            self.assertIn(message, done.stderr)
            self.assertNotIn("Traceback", done.stderr)

    def test_contact_of_an_operation_before(self):
        """A contact that the last operation has no more: the message says when it was there last."""
        head, tail = BLOCKS.split("DIE    flat")
        die, law = "DIE    flat" + tail[:tail.index("FIXED")], tail[tail.index("FIXED"):tail.index("LIC")]
        motion, march = tail[tail.index("LIC"):tail.index("STRAT")], tail[tail.index("STRAT"):tail.index("END")]
        path = os.path.join(self.folder, "released.lag")
        with open(path, "w", encoding="ascii") as file:
            contact = head[head.index("LAW    c"):]
            file.write(head[:head.index("LAW    c")] + law + march + "OPERA  press\n" + contact + die + motion + "OPERA  free\nSTOP   0.5\nEND\n")
        lagamine.run(path, os.path.join(self.folder, "released"), programs=BIN)
        done = self.report("released", "--side", "a.3/flat")
        self.assertEqual(2, done.returncode, done.stderr)
        self.assertIn("no contact 'a.3/flat' at time 1.5; there are: none; the last saved instant with it is at time 1 (--time)", done.stderr)
        done = self.report("released", "--side", "a.3/flat", "--time", "1")
        self.assertEqual((0, ""), (done.returncode, done.stderr))


if __name__ == "__main__":
    unittest.main(verbosity=2)
