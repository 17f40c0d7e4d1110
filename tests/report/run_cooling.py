#!/usr/bin/env python3
"""What the page reads from cooling curves: a plate that is cooled at given rates, in kelvin and minutes too. Diagrams of steels, with those curves on
them and without a run."""
import json
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
SOURCE = os.path.abspath(os.environ.get("LAGAMINE_SOURCE") or os.path.dirname(os.path.dirname(HERE)))
BIN = os.path.abspath(os.environ.get("LAGAMINE_BIN") or os.path.join(SOURCE, "build", "bin"))
sys.path.insert(0, os.path.join(SOURCE, "src", "report"))
sys.dont_write_bytecode = True
from lagamine_report import Run  # noqa: E402
from lagamine_report.cooling import cooling_picture, coolings  # noqa: E402
from lagamine_report.steel_diagram import run_diagrams  # noqa: E402

# Side 4 falls by 20 K/s to 100 degC, rises to 900 and falls by 40 K/s to 420; side 2 stays above 500.
PLATE = """TITLE  Plate
STATE  PLSTN
KINEM  SMALL
BLOCK  p PL8TM 4 steel BILINEAR
   0. 0.   0.1 0.   0.1 0.01   0. 0.01
   4 1.   1 1.
LAW    steel META
   STEEL '{steel}' '16MND5'
   ENERGY 1.E6   CONDUCT {conduct}   TIME {minute}   ZERO -{zero}
START  T {hot}
IMPOS  p 4 T fall
IMPOS  p 2 T mild
LIC    fall
   0. {hot}   {t1} {cold}   {t2} {hot}   {t3} {end}
LIC    mild
   0. {hot}   {t3} {warm}
STRAT  {step} 1.E-6 {step}   5 3
STOP   {t3}
SAVE   1000
PROBE  fast NODE T 0. 0.
PROBE  mild NODE T 0.1 0.
END
"""


class Cooling(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp(prefix="lagareport-cooling-")
        cls.addClassCleanup(shutil.rmtree, cls.folder, True)

    def run_plate(self, name, zero, minute):
        """A run with temperatures of the deck `zero` above degC, `minute` seconds a unit of its time."""
        times = {key: value / minute for key, value in {"t1": 40.0, "t2": 50.0, "t3": 62.0, "step": 0.5}.items()}
        values = {key: value + zero for key, value in {"hot": 900.0, "cold": 100.0, "end": 420.0, "warm": 600.0}.items()}
        path = os.path.join(self.folder, name + ".lag")
        with open(path, "w", encoding="utf-8") as file:
            file.write(PLATE.format(steel=os.path.join(SOURCE, "decks", "steels", "16mnd5.met"), zero=zero, minute=minute,
                                    conduct=1.0 * minute, **times, **values))
        out = os.path.join(self.folder, name)
        subprocess.run([os.path.join(BIN, "lagamine"), path, "--out", out, "--quiet"], check=True, env=dict(os.environ, OMP_NUM_THREADS="1"))
        return out

    def check(self, out):
        fast, mild = coolings(Run(out))
        self.assertEqual(["fast", "mild"], [fast.name, mild.name])
        # the last fall through 500 and the one through 800 before it; the rate at the first fall through 700
        self.assertAlmostEqual(300 / 40, fast.t85, places=6)
        self.assertAlmostEqual(20.0, fast.rate, places=6)
        self.assertTrue(mild.t85 != mild.t85)
        self.assertAlmostEqual(300 / 62, mild.rate, places=6)
        self.assertAlmostEqual(900.0, fast.temperature.max(), places=6)
        self.assertAlmostEqual(62.0, fast.time[-1], places=6)

    def test_degrees_and_seconds(self):
        out = self.run_plate("celsius", 0.0, 1.0)
        self.check(out)
        picture = cooling_picture(Run(out))
        self.assertEqual({"fast", "mild"}, {line.get_label() for line in picture.figure.axes[0].lines if not line.get_label().startswith("_")})
        self.check_diagram(Run(out))
        subprocess.run([os.path.join(BIN, "lagareport"), out, "--quiet"], check=True)
        with open(os.path.join(out, "report.html"), encoding="utf-8") as file:
            page = re.sub(r'src="data:[^"]*"', "", file.read())
        self.assertRegex(page, r'(?s)id="cooling".*<td>fast</td><td>7\.5</td><td>20</td><td>420</td>')
        self.assertRegex(page, r"<td>mild</td><td>–</td>")

        self.assertRegex(page, r'(?s)id="steels".*<img alt="Steel 16MND5')

    def check_diagram(self, run):
        """One steel, cooling only; the fall of 20 K/s on it counts from Ac3 = 846 degC."""
        picture, = run_diagrams(run)
        panel, = picture.figure.axes
        curve, = [line for line in panel.lines if line.get_label() == "fast"]
        time, temperature = curve.get_data()
        falling = time < 36
        self.assertGreater(falling.sum(), 50)
        for t, value in zip(time[falling], temperature[falling]):
            self.assertAlmostEqual(846 - 20 * t, value, places=6)
        # martensite begins at Ms while it cools fast: 1 % is there 0.4 K below
        begin, = [line for line in panel.lines if line.get_label() == "martensite"]
        time, temperature = begin.get_data()
        self.assertAlmostEqual(415 + math.log(0.99) / 0.0249, temperature[-1], delta=1.0)      # linear within 2 K
        self.assertAlmostEqual((846 - temperature[-1]) / 1000, time[-1], places=9)

    def test_kelvin_and_minutes(self):
        self.check(self.run_plate("kelvin", 273.15, 60.0))

    def test_steels_without_a_run(self):
        steel = os.path.join(SOURCE, "decks", "steels", "4140.met")
        page, pngs = os.path.join(self.folder, "4140.html"), os.path.join(self.folder, "pngs")
        done = subprocess.run([os.path.join(BIN, "lagareport"), steel, "--out", page, "--png", pngs], check=True, capture_output=True, text=True)
        self.assertIn("steels: 4140", done.stdout)
        with open(page, encoding="utf-8") as file:
            text = re.sub(r'src="data:[^"]*"', "", file.read())
        for part in ("<h2>Steel 4140</h2>", "<h2>Steel 4140, coolings</h2>", "bainite: seconds to 1, 50, 99 %"):
            self.assertIn(part, text)
        self.assertEqual(["diagram_1.png", "mixtures_1.png"], sorted(os.listdir(pngs)))
        broken = os.path.join(self.folder, "broken.met")
        with open(steel, encoding="utf-8") as file, open(broken, "w", encoding="utf-8") as out:
            out.write(file.read().replace("LI     7.5", "LI     heavy"))
        for options, phrase in (([broken], "broken.met:6:8: LI: expected G, the ASTM number of the grain"), ([steel, "--field", "mises"], "--field: for the results of a run")):
            done = subprocess.run([os.path.join(BIN, "lagareport"), *options], capture_output=True, text=True, check=False, cwd=self.folder)
            self.assertEqual(2, done.returncode, done.stderr)
            self.assertIn(phrase, done.stderr)

    def test_tables_of_a_steel(self):
        """--met: what is drawn is what is tabulated, and what is known of the numbers."""
        out = os.path.join(self.folder, "met")
        for name in ("steels/4140.met", "tempering/tempered.met"):
            subprocess.run([os.path.join(BIN, "lagamine"), "--met", os.path.join(SOURCE, "decks", *name.split("/")), "--out", os.path.join(out, name[:5]), "--quiet"],
                           check=True)
        with open(os.path.join(out, "steel", "4140.steel.json"), encoding="utf-8") as file:
            held = json.load(file)
        bainite, = [one for one in held["isothermal"] if one["phase"] == "BAINITE"]
        with open(os.path.join(out, "steel", "4140.ttt.bainite.csv"), encoding="utf-8") as file:
            rows = [[float(value) for value in line.split(",")] for line in file.read().splitlines()[1:]]
        self.assertEqual(rows, [list(row) for row in zip(bainite["temperature"], bainite["start"], bainite["half"], bainite["end"])])
        # S(.99)/S(.01) of Li 1998, at any temperature
        for start, end in zip(bainite["start"], bainite["end"]):
            self.assertAlmostEqual(1.947424 / 0.104340, end / start, places=3)
        for k, rate in enumerate(held["coolings"]["rate"]):
            shares = sum(phase["share"][k] for phase in held["coolings"]["phases"])
            self.assertAlmostEqual(1, shares, places=12, msg=f"{rate} K/s")
        with open(os.path.join(out, "tempe", "4140.temper.csv"), encoding="utf-8") as file:
            rows = [[float(value) for value in line.split(",")] for line in file.read().splitlines()[1:]]
        tempered = {(row[0], row[1]): row[2:] for row in rows}
        for temperature, hours in ((200, 1), (600, 2)):
            share, parameter, hardness = tempered[temperature, 3600 * hours]
            kelvin = temperature + 273.15
            self.assertAlmostEqual(kelvin * (20 + math.log10(hours)) / 1000, parameter, places=9)
            self.assertAlmostEqual(1 - math.exp(-(3600 * hours * 1e9 * math.exp(-1.2e5 / (8.314462618 * kelvin)))**0.5), share, places=9)
        self.assertAlmostEqual(322 - 53 * (parameter - 17.591) / 1.127, hardness, places=6)


if __name__ == "__main__":
    unittest.main(verbosity=2)
