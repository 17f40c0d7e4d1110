#!/usr/bin/env python3
"""lagareport on runs of the solver and of cycles, whole, damaged and interrupted: pages, pictures, refusals; XDMF against HDF5."""
import base64
import csv
import glob
import html.parser
import io
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import types
import unittest

import h5py
import matplotlib.image
import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
sys.dont_write_bytecode = True
from check_xdmf import check_folder  # noqa: E402
from real_runs import BIN, SOFT, SOURCE, Runs  # noqa: E402

sys.path.insert(0, os.path.join(SOURCE, "src", "report"))
from lagamine_report import Run, short_lines  # noqa: E402
from lagamine_report.cycle import Try  # noqa: E402
from lagamine_report.picture import titled  # noqa: E402
from lagamine_report.short import volume_by_meshes  # noqa: E402
from lagamine_report.geometry import Triangles, element_curves, element_sizes  # noqa: E402
from lagamine_report.tables import read_notes  # noqa: E402
from lagamine_report.words import brief  # noqa: E402

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


def read_json(folder, name):
    """A JSON file of a run."""
    with open(os.path.join(folder, name), encoding="utf-8") as file:
        return json.load(file)


def warnings(folder):
    """Warnings of the short result."""
    return [line for line in short_lines(Run(folder)) if "WARNING" in line]


class Page(html.parser.HTMLParser):
    """What a page points to, and whether its tags close."""

    VOID = {"meta", "input", "img", "br", "link", "hr"}

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
    @classmethod
    def setUpClass(cls):
        cls.runs = Runs()
        cls.addClassCleanup(cls.runs.close)

    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="lagareport-test-")
        self.addCleanup(shutil.rmtree, self.folder, True)

    def made(self, kind="done"):
        """A copy of the results of a run."""
        return self.runs.copy(kind, os.path.join(self.folder, "run"))

    def change_summary(self, folder, part, name, value):
        """Change one value of a summary."""
        path = os.path.join(folder, "summary.json")
        with open(path, encoding="utf-8") as file:
            summary = json.load(file)
        self.assertIn(name, summary[part])
        summary[part][name] = value
        with open(path, "w", encoding="utf-8") as file:
            json.dump(summary, file)

    def damage(self, path, change):
        """Change the text of a file."""
        with open(path, encoding="utf-8") as file:
            old = file.read()
        self.assertNotEqual(old, change(old))
        with open(path, "w", encoding="utf-8") as file:
            file.write(change(old))

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
        folder, again = self.made(), os.path.join(self.folder, "again.html")
        result = report(folder)
        self.assertEqual(0, result.returncode, result.stderr)
        self.assertIn("done: end of the scene", result.stdout)
        text = self.good_page(os.path.join(folder, "report.html"), 9)
        for words in ("Billet &lt;10 x 30&gt; &amp; dies", "lagamine decks/billet.lag --out", "no card asks for it",
                      read_json(folder, "summary.json")["deck_sha256"]):
            self.assertIn(words, text)
        self.assertNotIn('class="alerts"', text)
        self.assertNotIn("WARNING", result.stdout)
        self.check_largest_values(folder, text)
        os.remove(os.path.join(folder, "report.html"))
        self.assertEqual(0, report(folder, "--out", again, "--quiet").returncode)
        with open(again, encoding="utf-8") as file:
            self.assertTrue(text == file.read(), "the same results, another page")
        self.assertFalse(os.path.exists(os.path.join(folder, "report.html")))

    def check_largest_values(self, folder, text):
        """Tiles show what integration points have; no nodal value of a picture goes beyond them."""
        run = Run(folder)
        for field in ("plastic_strain", "mises"):
            with h5py.File(os.path.join(folder, "billet.g01.h5"), "r") as file:
                step = file["steps"][max(file["steps"])]
                names = [name.decode().strip() for name in step["points/1/components"][()]]
                state = dict(zip(names, np.moveaxis(step["points/1/state"][()], 2, 0)))
                nodes = step[f"node/{field}"][()]
            xx, yy, xy, zz = (state["stress_" + c] for c in ("xx", "yy", "xy", "zz"))
            values = state.get(field, np.sqrt(xx**2 + yy**2 + zz**2 - xx * yy - yy * zz - zz * xx + 3 * xy**2))
            self.assertIn(f"<b>{brief(values.max())}</b><span>largest {field} at points", text)
            self.assertLessEqual(nodes.max(), values.max() * (1 + 1e-14))
            self.assertGreaterEqual(nodes.min(), values.min() * (1 - 1e-14))
            last = run.steps[-1].generation
            drawn = Triangles(last.topology, len(last.coordinates)).bounded(nodes)
            self.assertEqual((nodes.min(), nodes.max()), (drawn.min(), drawn.max()))

    def test_stop(self):
        folder = self.made("stopped")
        result = report(folder)
        self.assertEqual(0, result.returncode, result.stderr)
        text = self.good_page(os.path.join(folder, "report.html"), 8)
        with open(os.path.join(folder, "billet.log"), encoding="utf-8") as file:
            cutback = next(line for line in file if line.startswith("cutback:"))[len("cutback:"):].strip()
        for words in ("did not reach its end", "exit code 3", cutback.replace(">", "&gt;")):
            self.assertIn(words, text)

    def test_penetration(self):
        """What the solver finds too deep is a warning of the page, with the solver's advice; what is not is none."""
        folder = self.made("soft")
        given = read_json(folder, "summary.json")
        checks, advice = given["checks"], given["advice"]
        self.assertGreater(checks["max_penetration_over_allowed"], 1.5)
        self.assertGreater(checks["max_penetration_sampled_over_allowed"], checks["max_penetration_over_allowed"])
        self.assertEqual({"max_penetration_over_allowed", "max_penetration_sampled_over_allowed"}, set(advice))
        with open(os.path.join(folder, "billet.log"), encoding="utf-8") as file:
            listing = file.read()
        result = report(folder)
        text = self.good_page(os.path.join(folder, "report.html"), 9)
        self.assertEqual(2, result.stdout.count("WARNING"), result.stdout)
        self.assertEqual(2, text.count('<tr class="bad">'))
        self.assertEqual(2, text.count("<p><b>depth over allowed"))
        for name, words in advice.items():
            self.assertRegex(listing, "WARNING: .*: " + re.escape(words))
            self.assertRegex(result.stdout, r"WARNING: depth over allowed .*: " + re.escape(words))
            self.assertIn(f"<td>{words}</td>", text)
            depth = checks[name[:-len("_over_allowed")]]
            self.assertIn(f"<td>{brief(checks[name], 3)} (depth {brief(depth, 3)})</td><td>1</td>", text)
        for name in advice:     # what is just not too deep is no warning
            self.change_summary(folder, "checks", name, 1.0)
        self.assertEqual([], warnings(folder))
        for name in advice:     # and the checks look at each by itself
            self.change_summary(folder, "checks", name, 1.01)
            self.assertEqual(1, len(warnings(folder)), name)
            self.change_summary(folder, "checks", name, 1.0)

    def test_penetration_advice_helps(self):
        """With AUGMENT no point is too deep, with -3 points sides are less deep; PENETR changes depth and allowed alike."""
        points, sides = "max_penetration_over_allowed", "max_penetration_sampled_over_allowed"
        first, out = read_json(self.made("soft"), "summary.json")["checks"], os.path.join(self.folder, "again")
        self.runs.call("lagamine", out, {**SOFT, "augment": "20"}, 0)
        again = read_json(out, "summary.json")
        self.assertLessEqual(again["checks"][points], 1 + 1e-6)
        self.assertNotIn(points, again["advice"])
        self.runs.call("lagamine", out, {**SOFT, "points": "-3"}, 0)
        self.assertLess(read_json(out, "summary.json")["checks"][sides], first[sides])
        self.runs.call("lagamine", out, {**SOFT, "penetr": "1.E-4"}, 0)
        again = read_json(out, "summary.json")["checks"]
        self.assertAlmostEqual(first["max_penetration"], 10 * again["max_penetration"], delta=0.2 * first["max_penetration"])
        self.assertAlmostEqual(first[points], again[points], delta=0.2 * first[points])

    def test_failed_checks(self):
        """A page of a real run with one value changed warns of this one, and of no other."""
        for name, value, words in (("energy_imbalance", 0.5, "energy imbalance"), ("energy_imbalance", None, "not a number"),
                                   ("volume_drift_unloaded", 0.02, "volume drift"), ("least_dissipation", -1.0, "friction work"),
                                   ("worst_linear_residual", 1e-8, "linear residual"),
                                   ("spurious_mode", 0.95, "unseen by the points")):
            folder = self.made()
            self.change_summary(folder, "checks", name, value)
            reported = warnings(folder)
            self.assertEqual(1, len(reported), name)
            self.assertIn(words, reported[0])

    def test_round_off_of_work(self):
        """What is dissipated at a point may fall by round-off, also where no work comes in, as in a quench."""
        folder = self.made()
        self.change_summary(folder, "energy", "external_work", 0.0)
        self.change_summary(folder, "checks", "least_dissipation", -1e-14)
        self.assertEqual([], warnings(folder))

    def test_under_way_and_interrupted(self):
        """A run that is under way has a page; so has one that was killed in the middle of a row, and one that has just begun."""
        folder = self.made()
        run = self.runs.begin(folder, 30)
        try:
            os.kill(run.pid, signal.SIGSTOP)
            self.assertFalse(os.path.exists(os.path.join(folder, "summary.json")), "the summary of the run before is still there")
            result = report(folder)
            self.assertEqual(0, result.returncode, result.stderr)
            self.assertIn("under way", result.stdout)
            text = self.good_page(os.path.join(folder, "report.html"), 7)
            for words in ("The run is under way", "time reached<", "Forces on the dies", "Steps and iterations", "--resume"):
                self.assertIn(words, text)
            self.assertNotIn("not a number", text)
        finally:
            run.kill()
            run.wait()
        path = os.path.join(folder, "history.csv")
        with open(path, "a", encoding="utf-8") as file:
            file.write("0.5,12,0.0")
        result = report(folder)
        self.assertEqual(0, result.returncode, result.stderr)
        with open(path, encoding="utf-8") as file:
            rows = list(csv.reader(file))[1:-1]
        iterations = sum(int(row[3]) for row in rows)
        self.assertIn(f"time {brief(float(rows[-1][0]))}, {rows[-1][1]} steps, {iterations} iterations", result.stdout)
        text = self.good_page(os.path.join(folder, "report.html"), 7)
        self.assertIn("The run has been interrupted", text)
        self.assertNotIn("The run is under way", text)
        for gone in ("history.csv", "billet.g01.h5", "billet.ckp.h5", "billet.xdmf"):       # as a run is before its first step
            if os.path.exists(os.path.join(folder, gone)):
                os.remove(os.path.join(folder, gone))
        self.assertEqual(0, report(folder).returncode)
        self.assertIn("interrupted", self.good_page(os.path.join(folder, "report.html"), 0))
        self.refused(folder, "--field", "mises", names="mises")

    def test_cycle(self):
        """Every try a row; pictures of the first and the last three new meshes; what each has kept of the old one."""
        folder = self.made("cycle")
        png = os.path.join(self.folder, "new", "png")
        result = report(folder, "--png", png)
        self.assertEqual(0, result.returncode, result.stderr)
        text = self.good_page(os.path.join(folder, "report.html"), 16)
        with open(os.path.join(folder, "cycle.csv"), encoding="utf-8") as file:
            rows = [{title.split(" ")[0]: cell for title, cell in row.items()} for row in csv.DictReader(file)]
        made = [row for row in rows if row["accepted"] == "y" and row["action"] != "old mesh"]
        refused = [row for row in rows if row["accepted"] == "n"]
        self.assertGreater(len(made), 6)
        self.assertGreater(len(refused), 1)
        later = [row for row in made if row["try"] != "1"]
        self.assertTrue(later)
        shown = [int(row["generation"]) for row in made[:1] + made[-3:]]
        for words in (f"New meshes: {len(made)}; tries refused: {len(refused)}.", "<b>refused</b> (as the deck says; stage mesh): an &lt;angle&gt; of 3",
                      f"try {later[0]['try']}: {later[0]['action']}", f"Pictures of 4 of {len(made)} new meshes", "every mesh", f"billet.g{shown[-1]:02d}.h5"):
            self.assertIn(words, text)
        for row in made:
            self.assertIn(f"<td>{row['old_elements']} → {row['new_elements']}</td>", text)
            self.assertIn(f"<td>{brief(float(row['error_before']), 3)} → {brief(float(row['error_after']), 3)}</td>", text)
            found = (row["first_residual"], row["iterations"], row["force_change"], row["energy_change"], row["depth_change"])
            self.assertIn("".join(f"<td>{brief(float(value), 3)}</td>" for value in found), text)
        self.check_kept(folder, made, text)
        self.check_narrow_screen(text)
        self.assertEqual(5, text.count('<tr class="bad"><td>2</td>'))
        self.assertEqual(1, text.count("<b>the old mesh goes on</b>"))
        found = {name[:-4] for name in os.listdir(png)}
        self.assertEqual({f"remesh_g{g:02d}" for g in shown},
                         {name for name in found if name.startswith("remesh_")})
        self.assertLessEqual({"mesh", "meshes", "fields", "more", "series", "force", "contact", "probes", "steps", "energy",
                              "seconds"}, found)
        for path in glob.glob(os.path.join(png, "*.png")):
            with open(path, "rb") as file:
                self.assertGreater(drawn_share(file.read()), BLANK, path)

    def test_last_mesh_refused(self):
        """What was computed on a last mesh that was refused is shown nowhere."""
        folder = self.made("cycle")
        path = os.path.join(folder, "cycle.csv")
        with open(path, encoding="utf-8") as file:
            rows = list(csv.reader(file))
        titles = [title.split(" ")[0] for title in rows[0]]
        last = dict(zip(titles, rows[-1]))
        self.assertEqual("y", last["accepted"])
        rows[-1][titles.index("accepted")] = "n"
        before = Run(folder)
        with open(path, "w", encoding="utf-8", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows(rows)
        run = Run(folder)
        self.assertEqual(len(before.generations) - 1, len(run.generations))
        self.assertEqual(int(last["step"]), run.history["step"].values[-1])
        self.assertLess(run.steps[-1].number, before.steps[-1].number)
        result = report(folder)
        self.assertEqual(0, result.returncode, result.stderr)
        with open(os.path.join(folder, "report.html"), encoding="utf-8") as file:
            self.assertIn(f"Mesh {last['generation']} was refused: pictures", file.read())

    def check_narrow_screen(self, text):
        """A page as wide as the screen: the viewport is given, nothing is wider than a phone but what scrolls in its own box."""
        self.assertIn('<meta name="viewport" content="width=device-width, initial-scale=1">', text)
        style = text[text.index("<style>"):text.index("</style>")]
        self.assertRegex(style, r"nav \{[^}]*flex-wrap: wrap")
        self.assertRegex(style, r"figure img \{[^}]*max-width: 100%")
        scrolled = {"figure input:checked + img", ".many"}
        boxes = dict(re.findall(r"(?m)^ *([^{}@\n]+?) \{([^{}]*)\}", style))
        for box in (".wide", "figure label"):
            self.assertIn("overflow-x: auto", boxes[box])
        for rule, body in boxes.items():
            for width in re.findall(r"(?<!max-)\b(?:min-)?width: (\d+)px", body):
                self.assertTrue(int(width) <= 340 or rule in scrolled, f"{rule}: {width} px")
        body = text[text.index("<body>"):]
        self.assertEqual(body.count("<table"), len(re.findall(r'<div class="wide"><table', body)))
        self.assertEqual(body.count("<img"), len(re.findall(r'<label><input type="checkbox"><img', body)))
        self.assertNotRegex(re.sub(r'src="data:[^"]*"', "", body), r"\bstyle=|\bwidth=")

    def check_kept(self, folder, made, text):
        """What new meshes kept, the limits over the table, seconds and memory of all calls, the volume that meshes changed."""
        with open(os.path.join(folder, "history.csv"), encoding="utf-8") as file:
            drift = {int(row["step [-]"]): float(row["volume_drift [-]"]) for row in csv.DictReader(file)}
        first, by_meshes = read_json(folder, "summary.json")["initial_volume"], 0.0
        for row in made:
            stem = f"billet.g{int(row['generation']):02d}"
            restart = read_json(folder, stem + ".restart.json")
            change = 100 * (restart["volume_after"] / restart["volume_before"] - 1)
            self.assertIn(f"Kept: volume {'+' if change > 0 else ''}{brief(change, 3)} %", text)
            by_meshes += restart["volume_before"] / first - 1 - drift[int(row["step"])]
            fields = {field["name"]: field for field in read_json(folder, stem + ".start.h5.json")["transfer"]}
            strain = [brief(fields["plastic_strain"][key], 6) for key in ("before", "after")]
            self.assertIn(f"<td>equivalent plastic strain</td><td>{strain[0]}</td><td>{strain[1]}</td>", text)
        self.assertIn(f"<td>volume drift by new meshes, in all</td><td>{brief(100 * by_meshes, 3)} %</td><td>0.1 %</td>", text)
        limits = {**restart, **read_json(folder, stem + ".probation.json")}
        shown = [brief(factor * limits[name + "_limit"], 3) for name, factor in
                 (("first_residual", 1), ("iterations", 1), ("force_change", 100), ("energy_change", 100), ("depth_change", 1))]
        self.assertIn("<td>limits (REMSH ACCEPT)</td><td></td><td></td>" + "".join(f"<td>≤ {limit}</td>" for limit in shown)
                      + f"<td>≥ {brief(limits['least_step_ratio_limit'], 3)}</td>", text)
        with open(os.path.join(folder, "billet.log"), encoding="utf-8") as file:
            calls = re.findall(r"(?m)^  \d+ equations, .* (\S+) s on the wall, .* (\S+) MB$", file.read())
        seconds, memory = sum(float(call[0]) for call in calls), max(float(call[1]) for call in calls)
        self.assertGreater(len(calls), 8)
        for tile in (f"<b>{brief(seconds, 3)} s</b><span>on the wall in {len(calls)} calls of lagamine, 1 threads",
                     f"<b>{brief(sum(float(row['remdata']) for row in made), 3)} s</b><span>on the wall in {len(made)} calls of",
                     f"<b>{brief(memory, 3)} MB</b>"):
            self.assertIn(tile, text)

    def test_damaged_cycle(self):
        for name, damage in (("cycle.csv", lambda s: ""), ("cycle.csv", lambda s: s[:-9]),
                             ("cycle.csv", lambda s: re.sub(r",\d+\.\d+,", ",little,", s, count=1)),
                             ("cycle.csv", lambda s: s.replace("trigger", "reason", 1)),
                             ("billet.g02.restart.json", lambda s: s[:20]), ("billet.g02.probation.json", lambda s: "[]"),
                             ("billet.g02.start.h5.json", lambda s: "[]"),
                             ("billet.g02.start.h5.json", lambda s: s.replace('"name"', '"same"'))):
            folder = self.made("cycle")
            self.damage(os.path.join(folder, name), damage)
            self.refused(folder, names=name)

    def test_sizes_of_elements(self):
        """The area inside the sides as they are curved: here 1 + 2/3 0.2, less what chords of eight parts leave out."""
        x = np.array([[0, 0], [1, 0], [1, 1], [0, 1], [.5, -.2], [1, .5], [.5, 1], [0, .5]])
        area = float(element_sizes(element_curves(x, np.arange(8)[None, :]))[0])**2
        self.assertAlmostEqual(1 + 2 / 3 * .2 * (1 - 1 / 64), area, places=12)

    def test_units_of_fields(self):
        """Pictures name the unit of a field; a strain has none."""
        run = Run(self.made())
        for name, words in (("mises", "von Mises stress [stress]"), ("displacement", "size of the displacement [length]"),
                            ("plastic_strain", "equivalent plastic strain")):
            self.assertEqual(words, titled(run, run.steps[-1], name))

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
            folder = self.made("cycle")
            os.remove(os.path.join(folder, name))
            if name == "billet.g01.h5":      # results may begin with a later mesh, but not when there is none
                for path in glob.glob(os.path.join(folder, "billet.g0[2-9].h5")):
                    os.remove(path)
            self.refused(folder, names=name)
            self.assertFalse(os.path.exists(os.path.join(folder, "report.html")))

    def test_damaged_texts(self):
        for name, damage in (("summary.json", lambda s: s[:200]), ("summary.json", lambda s: "[]"),
                             ("history.csv", lambda s: s[:-30]),
                             ("history.csv", lambda s: re.sub(r"(?m)^([^,\n]*),12,", r"\1,twelve,", s)),
                             ("history.csv", lambda s: "")):
            folder = self.made()
            self.damage(os.path.join(folder, name), damage)
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
            step = file["steps"][max(file["steps"])]         # a link into another file
            del step["node/mises"]
            step.create_dataset("node/mises", data=np.zeros(3))

        def no_pilots(file):
            del file["steps"][max(file["steps"])]["pilots"]

        def not_finite(file):
            file["steps"][max(file["steps"])]["coordinates"][0, 0] = np.nan

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

    def test_warnings_once(self):
        """The listing has the warnings of a deck before and after the steps, the page has each once."""
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "deck.log")
            with open(path, "w", encoding="utf-8") as listing:
                listing.write("WARNING: a\nstep 1\ncutback: b\ncutback: b\n  WARNING: a\n  WARNING: c\n")
            self.assertEqual({"cutbacks": ["b", "b"], "warnings": ["WARNING: a", "WARNING: c"]}, read_notes(path))

    def test_warnings_of_parts(self):
        """A part that went on has its warnings judged anew at the end; those of a mesh that was replaced stay."""
        ends = {"stopped by signal 15 at step 3": ["WARNING: a", "WARNING: e"],
                "a new mesh is due at step 3: ": ["WARNING: a", "WARNING: d", "WARNING: e"]}
        for reason, expected in ends.items():
            with tempfile.TemporaryDirectory() as folder:
                path = os.path.join(folder, "deck.log")
                with open(path, "w", encoding="utf-8") as listing:
                    listing.write(f"WARNING: a\nstopped: {reason}\n  WARNING: a\n  WARNING: d\n\nresumed from deck.ckp.h5 after step 3\n"
                                  "WARNING: a\ndone: end of the scene\n  WARNING: e\n")
                self.assertEqual(expected, read_notes(path)["warnings"])

    def test_volume_of_a_cut(self):
        """What a cut removes is no drift by new meshes, of those before it neither: 1000 of volume, of which 100 are cut off."""
        rows = [Try(2, 1, 10, {"removed_volume": 0}, {"accepted": "y", "action": ""}, volume=1000.2, initial_volume=1000),
                Try(3, 1, 20, {"removed_volume": 100}, {"accepted": "y", "action": ""}, volume=899, initial_volume=900),
                Try(4, 1, 30, {"removed_volume": 0}, {"accepted": "y", "action": ""}, volume=900.9, initial_volume=900)]
        drift = {"step": np.array([10, 20, 30]), "volume_drift": np.array([1.0e-4, -2.0e-3, 5.0e-4])}
        run = types.SimpleNamespace(tries=rows, summary={"initial_volume": 900}, history={name: types.SimpleNamespace(values=values) for name, values in drift.items()})
        self.assertAlmostEqual(1.0e-4 + 5.0e-4, volume_by_meshes(run), delta=1.0e-12)

    def test_order_of_dies(self):
        """Pilots are in the deck's order, HDF5 lists dies by name: the history's columns state which is which."""
        run = Run(self.made())
        pilots = run.pilots(run.steps[-1])
        self.assertEqual(["zupper", "a_wheel"], run.die_names)
        self.assertAlmostEqual(16.5, pilots["a_wheel"][0])
        self.assertAlmostEqual(12.0, pilots["zupper"][1])
        self.assertIn("Billet <10 x 30> & dies", short_lines(run)[0])

    def test_quadratic_sides(self):
        """Triangles follow the shape functions: the area of a curved element, and neighbours that share points."""
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
        folder = self.made("cycle")
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

    def test_xdmf(self):
        for kind in ("done", "stopped", "soft"):
            self.assertEqual([], check_folder(self.made(kind))[0], kind)


if __name__ == "__main__":
    unittest.main(verbosity=2)
