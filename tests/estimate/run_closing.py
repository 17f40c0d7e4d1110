#!/usr/bin/env python3
"""The table a run ends with: its estimates are those that cards ask for step by step, its forecast that of the run's own seconds."""
import csv
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
import effectivity_table  # noqa: E402

SOURCE = os.path.abspath(os.environ.get("LAGAMINE_SOURCE") or os.path.dirname(os.path.dirname(HERE)))
BIN = os.path.abspath(os.environ.get("LAGAMINE_BIN") or os.path.join(SOURCE, "build", "bin"))
EXPONENTS = {"factorisation": 1.5, "contact": 0.5}
NORMS = "NORMS  PATH 0.04 RATE 0.008\n"


TUBE = """TITLE  A tube that flows, then lets go
STATE  AXISYM
KINEM  LOG
BLOCK  part PL8LS 4 m
   40. 0.   100. 0.   100. 8.   40. 8.
   4 2.   2 1.
LAW    m EPLA
   200000. 0.3
   SWIFT 500. 0.005 0.15
FIXED  part 1 3 Y
PRES2D part 4 2 230. load
LIC    load
   0. 0.   1. 1.   1.3 0.
STRAT  0.1 1.E-4 0.1   5 3
END
"""
REST = """TITLE  A beam that is bent, then at rest
STATE  PLSTS 5.
KINEM  LOG
BLOCK  part PL8LS 4 m
   0. 0.   60. 0.   60. 6.   0. 6.
   8 1.   2 1.
LAW    m EPLA
   200000. 0.3
   LINEAR 300. 2000.
FIXED  part 4 XY
TRACT  part 2 Y -14. q
LIC    q
   0. 0.   1. 1.   1.0001 1.
STRAT  0.1 1.E-4 0.1   5 3
END
"""
COOLED = """TITLE  A ring that has cooled
STATE  AXISYM
KINEM  SMALL
BLOCK  ring PL8LS 4 m
   20. 0.   30. 0.   30. 6.   20. 6.
   6 1.   2 1.
LAW    m ELATH
   200000. 0.3 1.2E-5
ADDEL  ring PL8TM h BILINEAR
LAW    h HEAT
   30. 4.5
START  T 520.
FIXED  ring 1 Y
CONVE  ring 2 H 0.5 TS 20.
STRAT  0.5 1.E-6 50. 6 3
STOP   1000.
END
"""

SQUEEZED = """TITLE  A block squeezed, no heat is lost
STATE  PLSTN
KINEM  SMALL
BLOCK  part PL8LS 4 m
   0. 0.   10. 0.   10. 10.   0. 10.
   2 1.   2 1.
LAW    m EPLA
   200000. 0.3
   LINEAR 300. 500.
ADDEL  part PL8TM warm
LAW    warm HEAT
   50. 3.6
   QUINNEY 0.9
START  T 20.
FIXED  part 1 Y
FIXED  part 4 X
MOVE   part 3 Y down -0.8
LIC    down
   0. 0.   1. 1.
STRAT  0.05 1.E-4 0.1   5 3
PROBE  t MEAN T part
PROBE  p MAX plastic_strain part
END
"""
STRIP = """TITLE  A strip bent over a nose, two elements thick, and let go
STATE  PLSTN
KINEM  LOG
BLOCK  part PL8LS 9 m
   0. 0.   40. 0.   40. 2.   0. 2.
   20 1.   2 1.
LAW    m EPLA
   200000. 0.3
   LINEAR 300. 800.
LAW    oil COUL2D
   PENETR 5.E-3  PHI 0.05
DIE    nose PILOT 0. 2.
   ARC    10. 12.   7.0711 4.9289   0. 2.   1.E-3
   ARC    0. 2.   -7.0711 4.9289   -10. 12.   1.E-3
DIE    support PILOT 30. -5.
   ARC    25. -5.   30. 0.   35. -5.   1.E-3
CNT2D  part 3 nose oil
CNT2D  part 1 support oil
FIXED  part 4 X
MOVE   nose Y press
LIC    press
   0. 0.   1. -6.   1.5 0.
STRAT  0.05 1.E-5 0.1   4 3
END
"""
UP = """TITLE  A tube near its limit
STATE  AXISYM
KINEM  LOG
BLOCK  part PL8LS 4 m
   10. 0.   25. 0.   25. 5.   10. 5.
   4 1.   2 1.
LAW    m EPLA
   200000. 0.3
   LINEAR 300. 500.
FIXED  part 1 3 Y
PRES2D part 4 3 300. p
LIC    p
   0. 0.   1. 1.
STRAT  0.05 1.E-4 0.05   4 3
END
"""
NECKS = """TITLE  A strip that necks in steps far too long
STATE  PLSTN
KINEM  LOG
BLOCK  part PL8LS 4 m
   0. 0.   4.8 0.   5. 15.   0. 15.
   3 1.   8 1.
LAW    m EPLA
   200000. 0.3
   SWIFT 500. 0.005 0.15
FIXED  part 1 Y
FIXED  part 4 X
LIC    pull
   0. 0.   1. 1.
MOVE   part 3 Y pull 5.
NORMS  PATH 0.9 RATE 0.9
STRAT  0.25 1.E-6 0.25   40 3
END
"""


class Closing(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp(prefix="lagamine-closing-")
        cls.addClassCleanup(shutil.rmtree, cls.folder, True)

    def run_deck(self, deck, *options, card=""):
        """Summary, listing and history of a shipped deck, with a card more; the folder."""
        name = os.path.basename(deck) + ("_card" if card else "") + "_".join(options).replace("=", "")
        out = os.path.join(self.folder, "out", name)
        folder = os.path.join(self.folder, os.path.dirname(deck))
        shutil.copytree(os.path.join(SOURCE, "decks", os.path.dirname(deck)), folder, dirs_exist_ok=True)
        own = os.path.join(folder, os.path.basename(deck) + ".lag")
        with open(os.path.join(SOURCE, "decks", deck + ".lag"), encoding="utf-8") as file:
            text = file.read()
        with open(own, "w", encoding="utf-8") as file:
            file.write(re.sub(r"^END", card + "END", text, flags=re.M))
        subprocess.run([os.path.join(BIN, "lagamine"), own, "--out", out, "--quiet", *(word for one in options for word in ("-p", one))], check=True,
                       env=dict(os.environ, OMP_NUM_THREADS="1"))
        with open(os.path.join(out, "summary.json"), encoding="utf-8") as file:
            summary = json.load(file)
        with open(os.path.join(out, os.path.basename(deck) + ".log"), encoding="utf-8") as file:
            listing = file.read()
        with open(os.path.join(out, "history.csv"), encoding="utf-8") as file:
            return summary, listing, file.read(), out

    def test_space_as_with_estim(self):
        """The last instant alone has the error of the stress that ESTIM finds step by step; nothing else changes."""
        for deck in ("cook/cook", "press_fit/press_fit"):
            plain, listing, history, _ = self.run_deck(deck)
            asked, _, longer, _ = self.run_deck(deck, card="ESTIM\n")
            self.assertEqual(asked["error"]["stress_pct"], plain["accuracy"]["space"]["stress_pct"])
            self.assertGreater(plain["accuracy"]["space"]["stress_pct"], 0.1)
            self.assertEqual(asked["error"]["strain_pct"], asked["accuracy"]["space"]["strain_pct"])
            self.assertNotIn("strain_pct", plain["accuracy"]["space"])
            self.assertNotIn("error", plain)
            self.assertNotIn("error_stress", history)
            self.assertIn("error_stress", longer)
            self.assertEqual(0, plain["effects"]["error estimates"]["calls"])
            self.assertIn("in space    stress ", listing)

    def test_forecast_of_its_own_seconds(self):
        summary = self.run_deck("press_fit/press_fit")[0]
        seconds = summary["seconds"]
        cost = sum(s * 2**EXPONENTS.get(name, 1.0) for name, s in seconds.items()) / sum(seconds.values())
        self.assertAlmostEqual(cost, summary["accuracy"]["space"]["half_costs"], places=9)
        depth = summary["accuracy"]["contact"]
        self.assertEqual(max(summary["checks"]["max_penetration"], summary["checks"]["max_penetration_sampled"]), depth["depth"])
        self.assertEqual(max(summary["checks"]["max_penetration_over_allowed"], summary["checks"]["max_penetration_sampled_over_allowed"]),
                         depth["over_allowed"])

    def test_a_quarter_of_the_error_with_four_times_the_elements(self):
        """Smooth stress: the elliptic membrane, whose meshes are graded so that it falls a little faster."""
        coarse, fine = (self.run_deck("elliptic_membrane/elliptic_membrane", f"n={4*k}", f"k={k}")[0] for k in (2, 4))
        share = fine["accuracy"]["space"]["stress_pct"] / coarse["accuracy"]["space"]["stress_pct"]
        self.assertEqual(4, fine["elements"] / coarse["elements"])
        self.assertTrue(0.16 < share < 0.26, share)

    def test_heat(self):
        """The sum of the steps' errors by implicit Euler, about halved with the step; nothing is known between the ends of a step."""
        summary, listing, _, _ = self.run_deck("heat_wall/heat_wall", "step=0.8", "theta=0.5")
        self.assertEqual({}, summary["accuracy"])
        self.assertIn("heat: not estimated (THETA)", listing)
        long, short = (self.run_deck("heat_wall/heat_wall", f"step={step}")[0]["accuracy"]["heat"] for step in (0.04, 0.02))
        self.assertTrue(0.5 < short["sum"]/long["sum"] < 0.6, (short, long))   # the first corner of the wave falls more slowly
        self.assertAlmostEqual(2.0, long["half_costs"], places=12)
        summary, listing, _, out = self.run_deck("radiation/radiation_cooling")
        heat = summary["accuracy"]["heat"]
        self.assertEqual(summary["checks"]["error_in_time_sum"], heat["sum"])
        self.assertEqual(summary["checks"]["error_in_time_end"], heat["end"])
        self.assertEqual(summary["checks"]["error_in_time_largest"], heat["largest"])
        self.assertTrue(0 < heat["end"] <= heat["largest"] <= heat["sum"], heat)
        self.assertIn("[temperature] at the end, at most ", listing)
        self.assertGreater(heat["sum"], 0)
        self.assertAlmostEqual(2**0.5, heat["half_costs"], places=12)
        self.assertNotIn("space", summary["accuracy"])
        page = os.path.join(out, "report.html")
        subprocess.run([os.path.join(BIN, "lagareport"), out, "--quiet"], check=True)
        with open(page, encoding="utf-8") as file:
            self.assertIn("<td>about 1.4 times the time (shorter steps)</td>", file.read())

    def test_path(self):
        summary, listing, _, _ = self.run_deck("thick_cylinder/thick_cylinder_plastic", card=NORMS)
        self.assertEqual(100 * summary["checks"]["path_error_motion"], summary["accuracy"]["path"]["motion_pct"])
        self.assertEqual(100 * summary["checks"]["path_error_stress"], summary["accuracy"]["path"]["stress_at_motion_pct"])
        self.assertGreaterEqual(summary["accuracy"]["path"]["stress_pct"], summary["accuracy"]["path"]["stress_at_motion_pct"])
        self.assertIn("path: motion ", listing)

    def test_stress_of_the_path_with_the_motion(self):
        """The billet pressed to a quarter, the necking bar and the forged rib: within a factor 2 of the difference to steps of an eighth."""
        for scene in ("billet to 25 %", "necking", "forging rib"):
            run, told = effectivity_table.made(scene, self.folder, 1, 1)
            true, _ = effectivity_table.error_of_steps(scene, run, effectivity_table.made(scene, self.folder, 1, 0.125)[0])
            self.assertTrue(0.5 < told["path"]["stress_pct"]/(100*true) < 2, (scene, told["path"], true))

    def what_is_told(self, name, text):
        """`accuracy` of the summary, and the row of the table in the listing and on the page of its report that begin so."""
        path = os.path.join(self.folder, name + ".lag")
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        out = os.path.join(self.folder, "told", name)
        subprocess.run([os.path.join(BIN, "lagamine"), path, "--out", out, "--quiet"], check=True, env=dict(os.environ, OMP_NUM_THREADS="1"))
        subprocess.run([os.path.join(BIN, "lagareport"), out, "--quiet"], check=True)
        found = []
        for end in ("summary.json", name + ".log", "report.html"):
            with open(os.path.join(out, end), encoding="utf-8") as file:
                found.append(file.read())
        return json.loads(found[0])["accuracy"], found[1], found[2]

    def test_stress_that_its_error_hides(self):
        """Residual stress on two elements: 261 % by recovery, 74 % by a mesh of four times the elements along a line: no number is told."""
        told, listing, page = self.what_is_told("strip", STRIP)
        self.assertGreater(told["space"]["stress_pct"], 100)
        self.assertIs(told["space"]["stress_known"], False)
        for text in (listing, page):
            self.assertIn("stress hidden by its error: no estimate above 100 %", text)

    def test_stress_of_heat_that_its_error_hides(self):
        """A ring that has cooled in long steps: its stress goes with what is left of the temperatures, and so does that of their error: no number."""
        told, listing, page = self.what_is_told("cooled", COOLED)
        self.assertGreater(told["heat"]["stress_pct"], 100)
        self.assertIs(told["heat"]["stress_known"], False)
        for text in (listing, page):
            self.assertIn("stress hidden by its error: no estimate above 100 %", text)
        self.assertIn("at the end, at most 23.2; stress hidden", listing)

    def test_stress_of_what_is_added_to_a_body_of_heat(self):
        """A beam that is a body with heat added to it, or a body of heat with mechanics added: the same errors."""
        heat = "LAW    warm HEAT\n   50. 3.6\n"
        beam = REST.replace("FIXED ", heat + "ADDEL  part PL8TM warm\nFIXED ", 1)
        added = REST.replace("PL8LS 4 m", "PL8TM 4 warm").replace("FIXED ", heat + "ADDEL  part PL8LS m\nFIXED ", 1)
        (one, _, _), (other, _, _) = self.what_is_told("beam", beam), self.what_is_told("added", added)
        for place, name in (("space", "stress_pct"), ("path", "stress_pct"), ("path", "motion_pct")):
            self.assertGreater(one[place][name], 0)
            self.assertAlmostEqual(other[place][name]/one[place][name], 1, delta=1e-6, msg=name)

    def test_temperatures_behind_the_work(self):
        """A block squeezed without loss of heat: what SOLVE ONCE leaves for the next step is told, and is what is missing."""
        told, listing, page = self.what_is_told("squeezed", SQUEEZED)
        with open(os.path.join(self.folder, "told", "squeezed", "history.csv"), encoding="utf-8") as file:
            row = list(csv.reader(file))[-1]
        p = float(row[-1])
        missing = 20 + 0.9*(300*p + 250*p*p)/3.6 - float(row[-2])
        self.assertGreater(missing, 0.3)
        self.assertAlmostEqual(told["heat"]["work_not_heat"]/missing, 1, delta=0.01)
        for text in (listing, page):
            self.assertIn(" behind the work (SOLVE)", text)
        told, listing, _ = self.what_is_told("squeezed", SQUEEZED.replace("STRAT ", "SOLVE  CONVERGE\nSTRAT "))
        self.assertNotIn("work_not_heat", told["heat"])
        self.assertNotIn("behind the work", listing)

    def test_stress_without_that_of_temperatures(self):
        """A scheme whose errors in time are not estimated: the stress is told without them, and that it is."""
        heat = "LAW    warm HEAT\n   50. 3.6\n"
        beam = REST.replace("FIXED ", heat + "ADDEL  part PL8TM warm\nFIXED ", 1)
        for scheme in ("", "THETA  0.5\n"):
            told, listing, page = self.what_is_told("scheme", beam.replace("STRAT ", scheme + "STRAT "))
            self.assertEqual(bool(scheme), "stress_without_heat" in told["path"])
            for text in (listing, page):
                self.assertEqual(bool(scheme), "(without that of temperatures)" in text)

    def test_stress_of_the_path_in_part(self):
        """A strip that necks in steps of a quarter: the error was as large as the stress, and what is left is told as a part."""
        told, listing, page = self.what_is_told("necks", NECKS)
        self.assertIs(told["path"]["stress_known"], False)
        self.assertRegex(listing, r"stress at least \S+ % \(at this motion\)")
        self.assertRegex(page, r"stress at least \S+ % \(at this motion\)")
        self.assertNotIn("stress_known", told["space"])

    def stress_of_steps(self, name, text, steps):
        """What the table says of the stress by the path within steps [%], and the difference to steps of a thirty-second of the deck's."""
        effectivity_table.SCENES[name] = (os.path.join(self.folder, name), "part", 200000.0, 0.3, [], (), None, ())
        with open(os.path.join(self.folder, name + ".lag"), "w", encoding="utf-8") as file:
            file.write(text)
        run, told = effectivity_table.made(name, self.folder, 1, steps)
        true, _ = effectivity_table.error_of_steps(name, run, effectivity_table.made(name, self.folder, 1, 1/32)[0])
        return told["path"]["stress_pct"], 100*true

    def test_stress_of_the_path_before_a_corner(self):
        """A tube that flows under pressure, then lets go: its residual stress has the error of the way there, though no step since has one."""
        told, true = self.stress_of_steps("let go", TUBE, 0.25)
        self.assertTrue(0.5 < told/true < 2, (told, true))

    def test_stress_of_the_path_near_a_limit(self):
        """A tube under a pressure near its limit: 8e-6 % was told of .33 %."""
        told, true = self.stress_of_steps("up", UP, 1)
        self.assertTrue(0.5 < told/true < 2, (told, true))

    def test_stress_of_the_path_at_rest(self):
        """A beam at rest on its yield surface for a ten-thousandth of the time: the errors of its motion were carried on by a matrix that is not
        that of the answer, to 900 000 %."""
        told, true = self.stress_of_steps("rest", REST, 1)
        self.assertTrue(0.5 < told/true < 3, (told, true))


if __name__ == "__main__":
    unittest.main(verbosity=2)
