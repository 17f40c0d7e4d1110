#!/usr/bin/env python3
"""lagareport on made-up results and, where the solver is built, on a real run: pages, pictures, refusals; XDMF against HDF5."""
import base64
import glob
import html.parser
import io
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import h5py
import matplotlib.image
import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
SOURCE = os.environ.get("LAGAMINE_SOURCE") or os.path.dirname(os.path.dirname(HERE))
BIN = os.environ.get("LAGAMINE_BIN") or os.path.join(SOURCE, "build", "bin")
sys.path.insert(0, HERE)
sys.dont_write_bytecode = True
from check_xdmf import check_folder  # noqa: E402
from synthetic import make_run  # noqa: E402

DECK = """TITLE  Tiny billet
STATE  AXISYM
KINEM  LOG
BLOCK  billet  PL8LS 4 steel
   0. 0.   10. 0.   10. 15.   0. 15.
   3 1.0   4 1.0
LAW    steel  EPLA
   200000. 0.3
   LINEAR 700. 300.
LAW    rough  COUL2D
   PENETR 1.E-3   PHI 0.3
DIE    upper  PILOT 0. 15.
   SEGM  30. 15.   -1. 15.
CNT2D  billet 2 3  upper 2 rough
FIXED  billet 1  Y
FIXED  billet 4  X
LIC    press
   0. 0.     1. -2.
MOVE   upper Y press
PROBE  bulge NODE X 10. 0.
STRAT  0.05  1.E-5  0.1   4 3
SAVE   2
END
"""
BLANK = 0.004   # a picture has at least this share of its pixels drawn upon


def report(*arguments):
    """Run lagareport: the program that was built, or the package where there is none."""
    program = os.path.join(BIN, "lagareport")
    command, environment = [program], dict(os.environ, PYTHONDONTWRITEBYTECODE="1")
    if not os.path.exists(program):
        command = [sys.executable, "-m", "lagamine_report"]
        environment["PYTHONPATH"] = os.path.join(SOURCE, "src", "report")
    return subprocess.run(command + [str(word) for word in arguments], capture_output=True, text=True, env=environment)


def drawn_share(data):
    """Share of the pixels of a PNG that are not white."""
    pixels = matplotlib.image.imread(io.BytesIO(data), format="png")
    return float((pixels[:, :, :3] < 0.98).any(axis=2).mean())


class Page(html.parser.HTMLParser):
    """What a page points to, and whether its tags close."""

    VOID = {"meta", "img", "br", "link", "input", "hr"}

    def __init__(self, text):
        super().__init__()
        self.sources, self.links, self.alts, self.ids, self.open, self.faults = [], [], [], [], [], []
        self.feed(text)
        self.faults += [f"<{tag}> is not closed" for tag in self.open]

    def handle_starttag(self, tag, attrs):
        attributes = dict(attrs)
        if "src" in attributes:
            self.sources.append(attributes["src"])
        if "href" in attributes:
            self.links.append(attributes["href"])
        if "id" in attributes:
            self.ids.append(attributes["id"])
        if tag == "img":
            self.alts.append(attributes.get("alt"))
        if tag in ("script", "link", "iframe", "object"):
            self.faults.append(f"<{tag}>")
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        if self.open and self.open[-1] == tag:
            self.open.pop()
        else:
            self.faults.append(f"</{tag}> closes {self.open[-1:]}")


class ReportTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="lagareport-test-")
        self.addCleanup(shutil.rmtree, self.folder, True)

    def made(self, **options):
        return make_run(os.path.join(self.folder, "run"), **options)

    def good_page(self, path, pictures):
        """The page at `path` is whole and asks nothing of the network; returns its text."""
        with open(path, encoding="utf-8") as file:
            text = file.read()
        page = Page(text)
        self.assertEqual([], page.faults)
        self.assertGreaterEqual(len(page.sources), pictures)
        self.assertEqual(len(page.ids), len(set(page.ids)))
        for link in page.links:
            self.assertIn(link[1:] if link.startswith("#") else None, page.ids)
        self.assertTrue(all(page.alts))
        self.assertNotRegex(re.sub(r'src="data:[^"]*"', "", text), r"https?://|@import|url\(")
        for source in page.sources:
            head, _, body = source.partition(",")
            data = base64.b64decode(body, validate=True)
            if head == "data:image/png;base64":
                self.assertGreater(drawn_share(data), BLANK)
            else:
                self.assertEqual("data:image/svg+xml;base64", head)
                self.assertGreater(data.count(b"<path"), 15)
                self.assertNotRegex(data, rb'(xlink:)?href="(?!#|data:)')
        return text

    def refused(self, *arguments, code=2, names=""):
        result = report(*arguments)
        self.assertEqual(code, result.returncode, result.stderr)
        self.assertIn(names, result.stderr.splitlines()[0])
        self.assertNotIn("Traceback", result.stderr)
        self.assertLessEqual(len(result.stderr.splitlines()), 2)

    def test_page_of_one_generation(self):
        folder = self.made()
        result = report(folder)
        self.assertEqual(0, result.returncode, result.stderr)
        self.assertIn("done: end of the scene", result.stdout)
        self.assertNotIn("WARNING", result.stdout)
        text = self.good_page(os.path.join(folder, "report.html"), 9)
        for words in ("Billet &lt;10 x 30&gt; &amp; dies", "lagamine decks/billet.lag --out", "0f" * 32, "no card asks for it",
                      "15 iterations (element 3 of billet)"):
            self.assertIn(words, text)
        self.assertNotIn('class="alerts"', text)

    def test_same_page_twice(self):
        folder = self.made()
        pages = []
        for name in ("a.html", "b.html"):
            self.assertEqual(0, report(folder, "--out", os.path.join(self.folder, name), "--quiet").returncode)
            with open(os.path.join(self.folder, name), "rb") as file:
                pages.append(file.read())
        self.assertEqual(pages[0], pages[1])
        self.assertFalse(os.path.exists(os.path.join(folder, "report.html")))

    def test_generations_stop_warnings_and_pngs(self):
        folder = self.made(generations=3, stop=3, bad_checks=True, plane_state=1)
        png = os.path.join(self.folder, "new", "png")
        result = report(folder, "--png", png)
        self.assertEqual(0, result.returncode, result.stderr)
        self.assertEqual(4, result.stdout.count("WARNING"))
        text = self.good_page(os.path.join(folder, "report.html"), 10)
        for words in ("did not reach its end", "billet.g03.h5", "every mesh", 'class="bad"', "exit code 3", "not a number"):
            self.assertIn(words, text)
        found = {os.path.basename(path)[:-4] for path in glob.glob(os.path.join(png, "*.png"))}
        self.assertLessEqual({"mesh", "meshes", "fields", "more", "series", "force", "contact", "probes", "steps", "energy",
                              "seconds"}, found)
        for path in glob.glob(os.path.join(png, "*.png")):
            with open(path, "rb") as file:
                self.assertGreater(drawn_share(file.read()), BLANK, path)

    def test_cycle(self):
        """Every try a row; pictures of the first and the last six new meshes; what each has kept of the old one."""
        folder = self.made(generations=9, cycle=True)
        png = os.path.join(self.folder, "png")
        result = report(folder, "--png", png)
        self.assertEqual(0, result.returncode, result.stderr)
        text = self.good_page(os.path.join(folder, "report.html"), 16)
        for words in ("New meshes: 8; tries refused: 1.", "<b>refused</b> (as the deck says; stage mesh): an &lt;angle&gt; of 3",
                      "try 2: finer", "20 → 7.25", "<td>48 → 80</td>", "Pictures of 7 of 8 new meshes",
                      "Kept: volume +0.5 %, elastic energy −12.5 %, plastic work of the run – %",
                      "<td>equivalent plastic strain</td><td>200</td><td>201</td><td>+0.5</td><td>2</td><td>1.875</td>"):
            self.assertIn(words, text)
        # limits over their columns, and what was found under them
        self.assertIn("<td>limits (REMSH ACCEPT)</td><td></td><td></td><td>≤ 0.5</td><td>≤ 40</td><td>≤ 12.5</td><td>≤ 25</td>"
                      "<td>≤ 2</td><td>≥ 0.0625</td>", text)
        self.assertIn("<td>0.0625</td><td>4</td><td>0.5</td><td>0.375</td><td>0.75</td><td>0.125</td>", text)
        # all calls of the solver, and the remesher's, count
        for tile in ("<b>3.85 s</b><span>on the wall in 3 calls of lagamine, 2 threads", "<b>0.95 s</b><span>on the wall in 8 calls of",
                     "<b>60.5 MB</b>"):
            self.assertIn(tile, text)
        # every mesh begins with the first volume, 400; the drift before it is -1e-4 times the time
        by_meshes = 100 * sum(1e-4 * (g * 24 // 9) / 24 for g in range(1, 9))
        self.assertIn(f"<td>volume drift by new meshes, in all</td><td>{by_meshes:.3g} %</td><td>0.1 %</td>", text)
        self.assertIn("<td>volume drift, without elastic strain</td><td>0.0025 %</td><td>1 %</td>", text)
        self.assertEqual(1, text.count('<tr class="bad"><td>2</td>'))
        self.assertEqual(1, text.count("<b>the old mesh goes on</b>"))
        drawn = sorted(name for name in os.listdir(png) if name.startswith("remesh_"))
        self.assertEqual([f"remesh_g{g:02d}.png" for g in (2, 4, 5, 6, 7, 8, 9)], drawn)
        self.assertEqual(0, report(folder, "--out", os.path.join(self.folder, "again.html"), "--quiet").returncode)
        with open(os.path.join(self.folder, "again.html"), encoding="utf-8") as file:
            self.assertTrue(text == file.read(), "the same results, another page")

    def test_damaged_cycle(self):
        for name, damage in (("cycle.csv", lambda s: ""), ("cycle.csv", lambda s: s[:-9]),
                             ("cycle.csv", lambda s: s.replace("0.0625", "little")),
                             ("cycle.csv", lambda s: s.replace("trigger", "reason", 1)),
                             ("billet.g02.restart.json", lambda s: s[:20]), ("billet.g02.probation.json", lambda s: "[]"), ("billet.g02.start.h5.json", lambda s: "[]"),
                             ("billet.g02.start.h5.json", lambda s: s.replace('"name"', '"same"'))):
            folder = self.made(generations=2, cycle=True)
            path = os.path.join(folder, name)
            with open(path, encoding="utf-8") as file:
                old = file.read()
            self.assertNotEqual(old, damage(old))
            with open(path, "w", encoding="utf-8") as file:
                file.write(damage(old))
            self.refused(folder, names=name)

    def test_sizes_of_elements(self):
        """The area inside the sides as they are curved: here 1 + 2/3 0.2, less what chords of eight parts leave out."""
        sys.path.insert(0, os.path.join(SOURCE, "src", "report"))
        from lagamine_report.geometry import element_curves, element_sizes
        x = np.array([[0, 0], [1, 0], [1, 1], [0, 1], [.5, -.2], [1, .5], [.5, 1], [0, .5]])
        area = float(element_sizes(element_curves(x, np.arange(8)[None, :]))[0])**2
        self.assertAlmostEqual(1 + 2 / 3 * .2 * (1 - 1 / 64), area, places=12)

    def test_field_and_mirror(self):
        folder = self.made()
        png = os.path.join(self.folder, "png")
        self.assertEqual(0, report(folder, "--field", "stress_yy", "--mirror", "--png", png).returncode)
        self.assertIn("series_stress_yy.png", os.listdir(png))
        self.refused(folder, "--field", "stres_yy", names="stres_yy")

    def test_help_version_and_mistakes(self):
        for option in ("--help", "--version"):
            result = report(option)
            self.assertEqual(0, result.returncode)
            self.assertIn("lagareport", result.stdout)
        self.refused(names="DIR")
        self.refused(self.folder, "--nonsense", names="--nonsense")

    def test_missing_files(self):
        self.refused(os.path.join(self.folder, "nowhere"), names="nowhere")
        self.refused(self.folder, names="summary.json")
        for name in ("history.csv", "billet.log", "billet.g01.h5", "billet.g02.h5"):
            folder = self.made(generations=3)
            os.remove(os.path.join(folder, name))
            if name == "billet.g01.h5":      # results may begin with a later mesh, but not when there is none
                os.remove(os.path.join(folder, "billet.g02.h5"))
                os.remove(os.path.join(folder, "billet.g03.h5"))
            self.refused(folder, names=name)
            self.assertFalse(os.path.exists(os.path.join(folder, "report.html")))

    def test_damaged_texts(self):
        for name, damage in (("summary.json", lambda s: s[:200]), ("summary.json", lambda s: "[]"),
                             ("history.csv", lambda s: s[:-30]),
                             ("history.csv", lambda s: s.replace("0.5,12,", "0.5,twelve,")), ("history.csv", lambda s: "")):
            folder = self.made()
            path = os.path.join(folder, name)
            with open(path, encoding="utf-8") as file:
                old = file.read()
            self.assertNotEqual(old, damage(old))
            with open(path, "w", encoding="utf-8") as file:
                file.write(damage(old))
            self.refused(folder, names=name)

    def test_damaged_fields(self):
        def cut(path):
            os.truncate(path, os.path.getsize(path) // 2)

        def change(action):
            def damage(path):
                with h5py.File(path, "r+") as file:
                    action(file)
            return damage

        def wrong_node(file):
            file["mesh/topology"][0, 0] = 100000

        def wrong_shape(file):
            step = file["steps/000024"]                      # a link into another file
            del step["node/mises"]
            step.create_dataset("node/mises", data=np.zeros(3))

        def no_pilots(file):
            del file["steps/000024/pilots"]

        def not_finite(file):
            file["steps/000024/coordinates"][0, 0] = np.nan

        def no_steps(file):
            del file["steps"]

        for damage in (cut, lambda path: os.truncate(path, 0), change(lambda file: file.__delitem__("mesh/topology")),
                       change(wrong_node), change(wrong_shape), change(no_pilots), change(not_finite), change(no_steps)):
            folder = self.made()
            damage(os.path.join(folder, "billet.g01.h5"))
            self.refused(folder, names="billet.g01.h5")

    def test_write_failure(self):
        folder = self.made()
        self.refused(folder, "--out", os.path.join(self.folder, "no", "such", "page.html"), code=5, names="page.html")
        block = os.path.join(self.folder, "file")
        with open(block, "w", encoding="utf-8"):
            pass
        self.refused(folder, "--png", os.path.join(block, "png"), code=5, names="png")

    def test_order_of_dies(self):
        """Pilots are in the deck's order, HDF5 lists dies by name: the history's columns tell which is which."""
        sys.path.insert(0, os.path.join(SOURCE, "src", "report"))
        from lagamine_report import Run, short_lines
        run = Run(self.made())
        pilots = run.pilots(run.steps[-1])
        self.assertEqual(["zupper", "a_wheel"], run.die_names)
        self.assertAlmostEqual(18.0, pilots["a_wheel"][0])
        self.assertIn("Billet <10 x 30> & dies", short_lines(run)[0])

    def test_quadratic_sides(self):
        """Triangles follow the shape functions: the area of a curved element, and neighbours that share points."""
        sys.path.insert(0, os.path.join(SOURCE, "src", "report"))
        from lagamine_report.geometry import Triangles
        x = np.array([[0, 0], [1, 0], [1, 1], [0, 1], [.5, -.2], [1, .5], [.5, 1], [0, .5],
                      [2, 0], [2, 1], [1.5, 0], [2, .5], [1.5, 1]])
        topology = np.array([[0, 1, 2, 3, 4, 5, 6, 7], [1, 8, 9, 2, 10, 11, 12, 5]])
        triangles = Triangles(topology, len(x))
        at = triangles.at(x)
        self.assertEqual(2 * 49 - 7, len(at))
        a, b, c = (at[triangles.cells[:, k]] for k in range(3))
        areas = 0.5 * ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])
        self.assertGreater(areas.min(), 0)
        self.assertAlmostEqual(2 + 2 / 3 * .2 * (1 - 1 / 36), areas.sum(), places=12)

    def test_xdmf_check_finds_faults(self):
        folder = self.made(generations=2)
        self.assertEqual([], check_folder(folder)[0])
        path = os.path.join(folder, "billet.xdmf")
        with open(path, encoding="utf-8") as file:
            good = file.read()
        for old, new, word in (("node/mises", "node/misses", "misses"), ('Precision="8"', 'Precision="4"', "float64"),
                               ('Dimensions="', 'Dimensions="1', "shape"), ("billet.g02.h5", "other.h5", "other.h5"),
                               ('<Time Value="1.0"', '<Time Value="0.1"', "time"), ("</Xdmf>", "", "damaged")):
            self.assertIn(old, good)
            with open(path, "w", encoding="utf-8") as file:
                file.write(good.replace(old, new))
            self.assertIn(word, "\n".join(check_folder(folder)[0]), new)

    @unittest.skipUnless(os.path.exists(os.path.join(BIN, "lagamine")), "the solver is not built")
    def test_real_run(self):
        deck, out = os.path.join(self.folder, "tiny.lag"), os.path.join(self.folder, "out")
        with open(deck, "w", encoding="utf-8") as file:
            file.write(DECK)
        run = subprocess.run([os.path.join(BIN, "lagamine"), deck, "--out", out, "--quiet"], capture_output=True, text=True)
        self.assertEqual(0, run.returncode, run.stderr)
        faults, grids = check_folder(out)
        self.assertEqual([], faults)
        self.assertGreater(grids, 2)
        result = report(out)
        self.assertEqual(0, result.returncode, result.stderr)
        self.assertIn("Tiny billet", self.good_page(os.path.join(out, "report.html"), 9))

    @unittest.skipUnless(os.path.exists(os.path.join(BIN, "lagacycle")), "the solver and the remesher are not built")
    def test_real_cycle(self):
        deck, out = os.path.join(self.folder, "tiny.lag"), os.path.join(self.folder, "out")
        with open(deck, "w", encoding="utf-8") as file:
            file.write(DECK.replace("3 1.0   4 1.0", "6 1.0   9 1.0").replace("END", "REMSH\n   TIMES 0.4 0.7\nEND"))
        run = subprocess.run([os.path.join(BIN, "lagacycle"), deck, "--out", out, "--threads", "1"], capture_output=True, text=True)
        self.assertEqual(0, run.returncode, run.stderr)
        self.assertEqual([], check_folder(out)[0])
        png = os.path.join(self.folder, "png")
        result = report(out, "--png", png)
        self.assertEqual(0, result.returncode, result.stderr)
        text = self.good_page(os.path.join(out, "report.html"), 11)
        self.assertIn("New meshes: 2; tries refused: 0.", text)
        self.assertIn("error: a density", text)
        self.assertEqual(2, text.count("<summary>Kept: volume"))
        self.assertLessEqual({"remesh_g02.png", "remesh_g03.png"}, set(os.listdir(png)))


if __name__ == "__main__":
    unittest.main(verbosity=2)
