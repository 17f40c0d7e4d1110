#!/usr/bin/env python3
"""lagareport on decks: the scene that --check writes is what the deck says, and the picture shows it."""
import glob
import os
import re
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
sys.argv[0] = os.path.join(BIN, "lagareport")       # the solver is looked for beside it
from lagamine_report.deck_picture import DeckView, deck_picture, thinned  # noqa: E402
from lagamine_report.deck_scene import read_scene  # noqa: E402
from lagamine_report.geometry import hatching  # noqa: E402

DECKS = os.path.join(SOURCE, "decks")


def deck(name):
    """The path of a shipped deck."""
    return glob.glob(os.path.join(DECKS, "*", name + ".lag"))[0]


class DeckPicture(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="lagareport-test-")
        self.addCleanup(shutil.rmtree, self.folder, True)

    def report(self, *arguments):
        return subprocess.run([os.path.join(BIN, "lagareport"), *map(str, arguments)], capture_output=True, text=True, cwd=self.folder, check=False,
                              env=dict(os.environ, PYTHONDONTWRITEBYTECODE="1"))

    def test_page_and_drawing(self):
        done = self.report(deck("upsetting"), "-p", "nx=4", "-p", "ny=3")
        self.assertEqual((0, ""), (done.returncode, done.stderr))
        with open(os.path.join(self.folder, "upsetting.html"), encoding="utf-8") as file:
            page = file.read()
        for words in ("not run", "motion of upper", "FIXED billet.1 Y", "12 elements", "<td>\u22129</td>", "press"):
            self.assertTrue(words in page, words)
        self.assertNotRegex(re.sub(r'src="data:[^"]*"', "", page), r"https?://|@import|url\(")
        with open(os.path.join(self.folder, "upsetting.svg"), "rb") as file:
            first = file.read()
        self.assertGreater(first.count(b"<path"), 60)
        self.assertEqual(["upsetting.html", "upsetting.svg"], sorted(os.listdir(self.folder)))
        self.report(deck("upsetting"), "-p", "nx=4", "-p", "ny=3", "--out", "again.html")
        with open(os.path.join(self.folder, "again.svg"), "rb") as file:
            self.assertEqual(first, file.read(), "the same deck, another picture")

    def test_scene(self):
        """What --check writes, against the deck's own numbers."""
        scene = read_scene(deck("upsetting"), ["nx=4", "ny=3"])
        self.assertEqual((True, 12, 51), (scene.axisymmetric, len(scene.bodies()[0]["nodes"]), len(scene.x)))
        (name, deformable, pilot, pieces), = scene.dies
        self.assertEqual(("upper", False), (name, deformable))
        np.testing.assert_array_equal(pieces[0], [(30, 15), (14.5, 15), (-1, 15)])
        np.testing.assert_array_equal(pilot, [0, 15, 0])
        motion = scene.driven(scene.held["die_motions"][0])
        self.assertEqual((2, -9.0, 1.0, "press"), (motion.component, motion.value, motion.time, motion.multiplier))
        np.testing.assert_array_equal(scene.x[scene.sides["billet.1"]][:, :, 1], 0)
        self.assertEqual({1, 2}, {item["component"] for item in scene.held["fixations"]})

    def test_multiplier_that_comes_back(self):
        scene = read_scene(deck("upsetting"))
        item = {"component": 1, "amplitude": -2.0, "multiplier": 1}
        scene.held["multipliers"] = [{"name": "m", "time": [-1.0, 0.25, 9.0], "value": [7.0, 3.0, -1.0]}]
        driven = scene.driven(item)      # at time 0: between (-1, 7) and (0.25, 3)
        self.assertEqual((0.0, -2 * (7 - 4 / 1.25)), (driven.time, driven.value))
        self.assertEqual(0.0, scene.driven({"component": 1, "amplitude": 5.0, "multiplier": 0}).value)

    def test_contours_and_zones(self):
        scene = read_scene(deck("forging_zones"))
        np.testing.assert_array_equal(scene.place("billet.2")[0][[0, 2]], [(22, 0), (22, 11.6)])
        self.assertEqual(2, len(scene.place("billet.2+3")))
        self.assertEqual(0, len(scene.place("billet")))
        places = scene.zone_places()
        names = [point["name"] for point in scene.held["zone_points"]]
        np.testing.assert_allclose(places[names.index("foot") + 1], (11, 11.6), atol=1e-12)
        np.testing.assert_allclose(places[names.index("base") + 1], (11, 0), atol=1e-12)

    def test_all_decks_are_drawn(self):
        """Every deck's scene is read; those with something of their own are drawn: dies on both sides, forces, heat, pairs, contours."""
        drawn = ("draw", "forging_zones", "import_ring", "press_fit", "cook", "radiation", "elliptic_membrane", "hot_cylinder", "incline")
        every = sorted(glob.glob(os.path.join(DECKS, "*", "*.lag")))
        self.assertGreater(len(every), 30)
        for path in every:
            name = os.path.basename(path)[:-4]
            with self.subTest(name):
                scene = read_scene(path)
                self.assertTrue(scene.bodies())
                if name in drawn:
                    picture = deck_picture(scene)
                    words = " ".join(text.get_text() for axes in picture.figure.axes for text in axes.texts)
                    for die in scene.dies:
                        self.assertIn(die[0], words)
                    for item in scene.held["die_motions"]:
                        if scene.driven(item).value != 0:
                            self.assertRegex(words, "[XYA] ")

    def test_what_check_has_left(self):
        """`--check --out DIR`, then `lagareport DIR`: the picture of the deck itself, without the words of --check."""
        subprocess.run([os.path.join(BIN, "lagamine"), deck("upsetting"), "--check", "--out", self.folder], stdout=subprocess.DEVNULL, check=True)
        for place in (".", "upsetting.scene.json"):
            done = self.report(place, "--quiet")
            self.assertEqual((0, "", ""), (done.returncode, done.stdout, done.stderr))
        with open(os.path.join(self.folder, "upsetting.svg"), "rb") as file:
            self.assertEqual(deck_picture(read_scene(deck("upsetting"))).svg(), file.read())
        with open(os.path.join(self.folder, "upsetting.html"), encoding="utf-8") as file:
            page = file.read()
        self.assertIn("motion of upper", page)
        self.assertNotIn("What the solver reads", page)
        shutil.copy(os.path.join(self.folder, "upsetting.scene.json"), os.path.join(self.folder, "other.scene.json"))
        with open(os.path.join(self.folder, "broken.scene.json"), "w", encoding="utf-8") as file:
            file.write("[1]")
        for arguments, words in ((("other.scene.json", "-p", "nx=3"), "-p: for a deck"), (("other.scene.json", "--mirror"), "--mirror: for the results of a run"),
                                 ((".",), "holds 3 scenes"), (("broken.scene.json",), "holds no scene that can be read")):
            done = self.report(*arguments)
            self.assertEqual((2, "", 1), (done.returncode, done.stdout, len(done.stderr.splitlines())), done.stderr)
            self.assertIn(words, done.stderr)

    def test_hatching_is_on_the_right(self):
        """A die above the part is walked to the left: its body, and the strokes, are above."""
        strokes = hatching(np.array([(10.0, 5.0), (0.0, 5.0)]), 1.0, 0.5)
        self.assertEqual(10, len(strokes))
        np.testing.assert_allclose(strokes[:, 0, 1], 5)
        self.assertTrue((strokes[:, 1, 1] > 5.3).all())
        np.testing.assert_allclose(np.hypot(*(strokes[:, 1] - strokes[:, 0]).T), 0.5)

    def test_supports_are_drawn_at_their_nodes(self):
        view = DeckView(read_scene(deck("upsetting"), ["nx=4", "ny=3"]))
        view.fixations()
        marks = {line.get_marker(): line.get_xydata() for line in view.axes.lines if line.get_marker() in "^>s"}
        self.assertEqual({"^", ">", "s"}, set(marks))
        np.testing.assert_allclose(marks["s"], [(0, 0)], atol=1e-12)        # the corner, held by both
        self.assertLess(np.abs(marks["^"][:, 1]).max(), 0.03 * 15)
        self.assertLess(np.abs(marks[">"][:, 0]).max(), 0.03 * 15)
        self.assertEqual([0, 4, 9], thinned(range(10), 3))

    def test_refusals(self):
        path = os.path.join(self.folder, "bad.lag")
        with open(path, "w", encoding="ascii") as file:
            file.write("TITLE  Bad\nSTATE  PLSTN\nKINEN  LOG\nEND\n")
        done = self.report(path)
        self.assertEqual(2, done.returncode)
        self.assertIn("bad.lag:3:1: KINEN", done.stderr)
        self.assertNotIn("Traceback", done.stderr)
        self.assertEqual(["bad.lag"], os.listdir(self.folder))
        for options, words in ((("--field", "mises"), "--field: for the results of a run"), (("--mirror",), "--mirror: for the results")):
            done = self.report(deck("upsetting"), *options)
            self.assertEqual((2, 1), (done.returncode, len(done.stderr.splitlines())))
            self.assertIn(words, done.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
