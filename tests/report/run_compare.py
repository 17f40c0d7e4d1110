#!/usr/bin/env python3
"""lagareport on several runs, and the moving picture of one: what the runs hold is what is shown."""
import csv
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import numpy as np
from matplotlib.figure import Figure
from PIL import Image

HERE = os.path.dirname(os.path.abspath(__file__))
SOURCE = os.path.abspath(os.environ.get("LAGAMINE_SOURCE") or os.path.dirname(os.path.dirname(HERE)))
BIN = os.path.abspath(os.environ.get("LAGAMINE_BIN") or os.path.join(SOURCE, "build", "bin"))
sys.path.insert(0, os.path.join(SOURCE, "src", "report"))
sys.dont_write_bytecode = True
from lagamine_report import Run  # noqa: E402
from lagamine_report.compare import compare_pictures, forces_picture, labels_of  # noqa: E402
from lagamine_report.contact import contact_groups  # noqa: E402
from lagamine_report.contact_map import pressure_bars, pressure_picture  # noqa: E402
from lagamine_report.geometry import SIDES  # noqa: E402
from lagamine_report.parabolas import elements_patch, sides_patch  # noqa: E402
from lagamine_report.picture import MARGIN, Picture, rounded, svg_bytes  # noqa: E402
from lagamine_report.rates import strain_rate, strain_rate_picture  # noqa: E402
from lagamine_report.scene_view import SceneView, is_uniform, scale_for  # noqa: E402
from lagamine_report.tractions import recovered_tractions  # noqa: E402
from lagamine_report.words import brief  # noqa: E402


class Compare(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp(prefix="lagareport-test-")
        cls.addClassCleanup(shutil.rmtree, cls.folder, True)
        deck = os.path.join(SOURCE, "decks", "upsetting", "upsetting.lag")
        for name, parameters in (("coarse", ("nx=3", "ny=4")), ("fine", ("nx=4", "ny=6"))):
            subprocess.run([os.path.join(BIN, "lagamine"), deck, "--out", os.path.join(cls.folder, name), "--quiet",
                            *(word for p in parameters for word in ("-p", p))], check=True, env=dict(os.environ, OMP_NUM_THREADS="1"))

    def report(self, *arguments):
        return subprocess.run([os.path.join(BIN, "lagareport"), *arguments], capture_output=True, text=True, cwd=self.folder, check=False,
                              env=dict(os.environ, PYTHONDONTWRITEBYTECODE="1"))

    def force(self, name):
        """The largest force of the die, read from the table."""
        with open(os.path.join(self.folder, name, "history.csv"), encoding="utf-8") as file:
            return max((float(row["force_y_upper [force]"]) for row in csv.DictReader(file)), key=abs)

    def test_page(self):
        done = self.report("coarse", "fine", "--out", "two.html")
        self.assertEqual((0, ""), (done.returncode, done.stderr))
        with open(os.path.join(self.folder, "two.html"), encoding="utf-8") as file:
            page = re.sub(r'src="data:[^"]*"', "", file.read())
        one, two = self.force("coarse"), self.force("fine")
        for words in ("<code>-p nx</code></td><td>3</td><td>4</td>", "<code>-p ny</code></td><td>4</td><td>6</td>", "<td>done</td><td>done</td>",
                      f"<td>{brief(one, 6)}</td><td>{brief(two, 6)} ({100 * (two / one - 1):+.2f} %)</td>", 'id="profiles"', 'id="probes"'):
            self.assertTrue(words in page, words)
        self.assertNotRegex(page, r"https?://|@import|url\(|<script")

    def test_same_runs_differ_in_nothing(self):
        self.assertEqual(0, self.report("fine", "fine", "--out", "same.html").returncode)
        with open(os.path.join(self.folder, "same.html"), encoding="utf-8") as file:
            page = re.sub(r'src="data:[^"]*"', "", file.read())
        self.assertNotIn("that differ", page)
        self.assertNotIn(" %)", page)

    def test_curves_are_those_of_the_runs(self):
        runs = [Run(os.path.join(self.folder, name)) for name in ("coarse", "fine")]
        picture = forces_picture(runs, ["a", "b"])
        lines = [line for line in picture.figure.axes[0].lines if line.get_label() in ("a", "b")]
        self.assertEqual(["a", "b"], [line.get_label() for line in lines])
        for run, line in zip(runs, lines):
            np.testing.assert_array_equal(run.history["force_y_upper"].values, line.get_ydata())
            np.testing.assert_array_equal(run.history["displacement_y_upper"].values, line.get_xdata())
        self.assertEqual(["forces", "profiles", "probes"], [picture.name for picture in compare_pictures(runs, ["a", "b"])])

    def test_labels(self):
        self.assertEqual(["a", "b"], labels_of(["out/a", "out/b/"]))
        self.assertEqual(["x/a", "y/a"], labels_of(["x/a", "y/a"]))
        self.assertEqual(2, len(set(labels_of(["x/a", "x/a"]))))

    def test_animation(self):
        """Frames of one size, as many as instants were saved, that differ; both formats."""
        instants = len({step.time for step in Run(os.path.join(self.folder, "fine")).steps})
        self.assertGreater(instants, 1)
        for name in ("forming.gif", "forming.png"):
            done = self.report("fine", "--quiet", "--animation", name)
            self.assertEqual((0, ""), (done.returncode, done.stderr))
            with Image.open(os.path.join(self.folder, name)) as image:
                self.assertEqual(instants, image.n_frames)
                frames = []
                for k in range(image.n_frames):
                    image.seek(k)
                    frames.append(np.asarray(image.convert("RGB"), dtype=int))
            self.assertTrue(all(np.abs(a - b).max() > 50 for a, b in zip(frames[:-1], frames[1:])))
            self.assertLess(os.path.getsize(os.path.join(self.folder, name)), 1e6)
        for options, words in ((("--animation", "x.mp4"), "expected a name that ends with .gif or .png"),):
            done = self.report("fine", "--quiet", *options)
            self.assertEqual((2, 1), (done.returncode, len(done.stderr.splitlines())), done.stderr)
            self.assertIn(words, done.stderr)

    def test_refusals(self):
        for arguments, words in ((("fine", "nowhere"), "nowhere: no such folder"), (("nodeck.lag",), "nodeck.lag: no such deck"),
                                 (("fine", "coarse", "--field", "mises"), "--field: for a single run"),
                                 (("fine", "coarse", "-p", "a=1"), "-p: for a single run"), (("fine", "-p", "a=1"), "-p: for a deck")):
            done = self.report(*arguments)
            self.assertEqual((2, 1), (done.returncode, len(done.stderr.splitlines())), done.stderr)
            self.assertIn(words, done.stderr)

    def test_pressure_bars(self):
        """Bars stand on the points of contact, into the part, and have the pressures recovered there; their sum over the sides is the die's force."""
        run = Run(os.path.join(self.folder, "fine"))
        view = SceneView(run)
        force = 0.0
        for group in contact_groups(run, run.steps[-1]):
            feet, inward, values = pressure_bars(view, group)
            np.testing.assert_allclose(np.hypot(*inward.T), 1, rtol=1e-12)
            np.testing.assert_array_equal(recovered_tractions(run, run.steps[-1], group)[0], values)
            # three Lobatto points a side: Simpson's rule, per radian times 2 pi; friction adds nothing along y on a flat die
            ends = run.coordinates(run.steps[-1])[group.connectivity]
            slopes = np.stack([(4 * ends[:, 1] - 3 * ends[:, 0] - ends[:, 2]) / 2, (ends[:, 2] - ends[:, 0]) / 2,
                               (3 * ends[:, 2] + ends[:, 0] - 4 * ends[:, 1]) / 2], axis=1)
            length = np.hypot(slopes[..., 0], slopes[..., 1]) * np.array([1, 4, 1]) / 3
            force += 2 * np.pi * float((length * feet.reshape(-1, 3, 2)[..., 0] * values.reshape(-1, 3) * -inward.reshape(-1, 3, 2)[..., 1]).sum())
        self.assertAlmostEqual(1.0, force / run.history["force_y_upper"].values[-1], delta=0.1)
        pressed = max(values.max() for values in [pressure_bars(view, group)[2] for group in contact_groups(run, run.steps[-1])])
        picture = pressure_picture(view)
        self.assertTrue(f"largest {brief(float(pressed))}" in picture.caption)

    def test_strain_rate_of_a_uniform_compression(self):
        """Plates without friction at constant speed: the mean rate between two instants is ln(h1/h2)/(t2 - t1), but for the elastic strain."""
        deck = os.path.join(SOURCE, "decks", "upsetting_frictionless", "upsetting_frictionless.lag")
        out = os.path.join(self.folder, "uniform")
        subprocess.run([os.path.join(BIN, "lagamine"), deck, "--out", out, "--quiet"], check=True)
        run = Run(out)
        before, last, rate = strain_rate(run)
        heights = [np.ptp(run.coordinates(step)[:, 1]) for step in (before, last)]
        elastic = [run.nodal(step, "elastic_strain_yy").mean() for step in (before, last)]
        wanted = (np.log(heights[0] / heights[1]) + elastic[1] - elastic[0]) / (last.time - before.time)
        np.testing.assert_allclose(rate, wanted, rtol=2e-3)
        picture = strain_rate_picture(SceneView(run))
        self.assertIn(f"mean since the instant saved before, time {brief(before.time)}", picture.caption)

    def test_pictures_have_no_empty_margins(self):
        """Pixels up to the margin on every side, whatever the figure leaves free."""
        fig = Figure(figsize=(4, 2))
        axes = fig.subplots()
        axes.set_axis_off()
        fig.text(0.5, 0.5, "x")
        picture = Picture("x", "", fig)
        pixels = np.asarray(picture.image(100).convert("L"))
        dark = np.argwhere(pixels < 250)
        self.assertEqual([8, 8], dark.min(axis=0).tolist())
        self.assertEqual([n - 9 for n in pixels.shape], dark.max(axis=0).tolist())

    def test_drawings_have_no_empty_margins(self):
        """What is seen of a drawing is its box and the margin, here a square of an inch inside of a larger figure, on white."""
        fig = Figure(figsize=(4, 2))
        axes = fig.add_axes((0.25, 0.25, 0.25, 0.5))
        axes.set_axis_off()
        head = svg_bytes(fig).decode().split("<metadata")[0]
        seen = (1 - MARGIN)*72, (0.5 - MARGIN)*72, (1 + 2*MARGIN)*72, (1 + 2*MARGIN)*72
        found = [float(number) for number in re.search(r'viewBox="([^"]*)"', head).group(1).split()]
        np.testing.assert_allclose(found, seen, atol=0.006)
        self.assertEqual((4, 2), tuple(fig.get_size_inches()))

    def test_sides_are_parabolas(self):
        """The quadratic curve of a side meets its middle node halfway, and an element is closed."""
        x = np.array([[0, 0], [2, 0], [2, 1], [0, 1], [1, -0.2], [2.3, 0.4], [1, 1.1], [0.1, 0.5]])
        nodes = np.arange(8)[None, :]
        for patch, ends in ((sides_patch(x[SIDES]), x[SIDES]), (elements_patch(x, nodes), x[nodes[:, SIDES]][0])):
            points = patch.get_path().vertices.reshape(-1, 3, 2) if len(patch.get_path().vertices) == 12 else \
                np.stack([patch.get_path().vertices[k:k + 3] for k in range(0, 8, 2)])
            np.testing.assert_allclose(0.25*points[:, 0] + 0.5*points[:, 1] + 0.25*points[:, 2], ends[:, 1], rtol=0, atol=1e-14)
            np.testing.assert_array_equal(points[:, [0, 2]], ends[:, [0, 2]])

    def test_a_field_without_differences_is_told_in_words(self):
        """What differs in digits that nobody is shown is the same everywhere; levels of it can be read."""
        self.assertTrue(is_uniform(20.0, 20.000003) and is_uniform(0, 0) and not is_uniform(0, 1e-30) and not is_uniform(20.0, 20.01))
        for low, high in ((20.0, 20.000003), (0.0, 0.0), (-5e-7, -5e-7)):
            levels = scale_for(low, high).levels
            self.assertTrue(levels[0] <= low <= high <= levels[-1])
            self.assertLess(max(len(brief(level, 6)) for level in levels), 12)

    def test_rounded_drawings(self):
        """Coordinates of lines lose digits, factors of scale and places do not."""
        self.assertEqual(b'<path d="M 1.23 20.00 L 3 4.5"/><g transform="scale(0.015625)" x="1.23456">',
                         rounded(b'<path d="M 1.234567 20.001 L 3 4.5"/><g transform="scale(0.015625)" x="1.23456">'))


if __name__ == "__main__":
    unittest.main(verbosity=2)
