#!/usr/bin/env python3
"""What the page reads from cooling curves: a plate that is cooled at given rates, in kelvin and minutes too."""
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
        picture.close()
        subprocess.run([os.path.join(BIN, "lagareport"), out, "--quiet"], check=True)
        with open(os.path.join(out, "report.html"), encoding="utf-8") as file:
            page = re.sub(r'src="data:[^"]*"', "", file.read())
        self.assertRegex(page, r'(?s)id="cooling".*<td>fast</td><td>7\.5</td><td>20</td><td>420</td>')
        self.assertRegex(page, r"<td>mild</td><td>–</td>")

    def test_kelvin_and_minutes(self):
        self.check(self.run_plate("kelvin", 273.15, 60.0))


if __name__ == "__main__":
    unittest.main(verbosity=2)
