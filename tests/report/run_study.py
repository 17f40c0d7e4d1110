#!/usr/bin/env python3
"""lagastudy: errors, orders and costs of made-up and of real ladders; runs that are there, that fail, that a scheduler makes; refusals."""
import csv
import glob
import json
import math
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
SOURCE = os.path.abspath(os.environ.get("LAGAMINE_SOURCE") or os.path.dirname(os.path.dirname(HERE)))
BIN = os.path.abspath(os.environ.get("LAGAMINE_BIN") or os.path.join(SOURCE, "build", "bin"))
sys.path.insert(0, os.path.join(SOURCE, "src", "report"))
sys.dont_write_bytecode = True
from lagamine_study.errors_of_ladder import judge  # noqa: E402

# A bar in plane strain that cools from 100 to 0 by exchange: backward Euler, first order in the step; limit load above load 1.
BAR = """TITLE  Lumped plate
PARAM  step 1.
PARAM  n 1
STATE  PLSTN
KINEM  SMALL
BLOCK  plate PL8TM 4 copper BILINEAR
   0. 0.   1. 0.   1. 1.   0. 1.
   $n 1.   1 1.
INCLU  copper.inc
START  T 100.
CONVE  plate 1 2 3 4 H 0.25 TS 0.
STRAT  $step 1.E-6 $step   5 3
STOP   4.
PROBE  t NODE T 0. 0.
END
"""
COPPER = "LAW    copper HEAT\n   1.E6 1.\n"
PULL = """TITLE  Pulled beyond its limit
PARAM  load 1.
STATE  PLSTN
KINEM  SMALL
BLOCK  bar PL8LS 4 metal
   0. 0.   1. 0.   1. 1.   0. 1.
   1 1.   1 1.
LAW    metal EPLA
   1000. 0.3
   LINEAR 1. 0.
FIXED  bar 1 Y
FIXED  bar 4 X
PRES2D bar 3 2 -$load ramp
LIC    ramp
   0. 0.   1. 1.
STRAT  0.1 1.E-2 0.1   5 3
END
"""


class Study(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp(prefix="lagastudy-test-")
        cls.addClassCleanup(shutil.rmtree, cls.folder, True)
        for name, text in (("bar.lag", BAR), ("copper.inc", COPPER), ("pull.lag", PULL)):
            with open(os.path.join(cls.folder, name), "w", encoding="ascii") as file:
                file.write(text)

    def study(self, *words):
        return subprocess.run([os.path.join(BIN, "lagastudy"), *words], capture_output=True, text=True, cwd=self.folder, check=False,
                              env=dict(os.environ, PYTHONDONTWRITEBYTECODE="1"))

    def table(self, out):
        with open(os.path.join(self.folder, out, "study.csv"), newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def test_made_up_ladders(self):
        """value = 3 + .5 h^p, seconds = 1/h^2: the limit, the order, and 2^(2/p) for half the error."""
        for p in (1.0, 2.0, 3.5):
            h = [1 / 2**k for k in range(4)]
            verdict = judge([3 + 0.5 * a**p for a in h], [2.0] * 3, [1 / a**2 for a in h], None)
            self.assertAlmostEqual(3.0, verdict.truth, places=10)
            self.assertIn("Richardson", verdict.source)
            for order in verdict.orders:
                self.assertAlmostEqual(p, order, places=6)
            self.assertAlmostEqual(2**(2 / p), verdict.half_costs, places=6)
        # to and fro: nothing to extrapolate; the finest run is no error of its own
        verdict = judge([1.0, 1.2, 1.1], [2.0, 2.0], [1.0, 2.0, 4.0], None)
        self.assertEqual("the finest run", verdict.source)
        self.assertTrue(math.isnan(verdict.errors[-1]))
        verdict = judge([1.0, 1.2, float("nan")], [2.0, 2.0], [1.0, 2.0, 4.0], None)
        self.assertEqual(1.2, verdict.truth)
        self.assertTrue(math.isnan(verdict.errors[1]), "the finest that reached its end is no error of its own")
        verdict = judge([2.0, 2.0, 2.0], [2.0, 2.0], [1.0, 2.0, 4.0], 2.0)
        self.assertTrue(math.isnan(verdict.half_costs) and all(map(math.isnan, verdict.orders)))
        verdict = judge([0.5, 0.25], [2.0], [1.0, 2.0], 0.0)
        self.assertEqual(([0.5, 0.25], 1.0), (verdict.errors, verdict.percent), "errors of what is 0 are no percents")

    def test_ladder_of_steps(self):
        """Backward Euler of an exponential: (1 + h)^-(4/h), truth e^-4, order 1; made once."""
        exact = 100 * math.exp(-4)
        words = ("bar.lag", "--ladder", "step=0.5,0.25,0.125,0.0625", "--ladder", "n=1,2", "--quantity", "t", "--quantity", "t@2", "--quantity", "t@max",
                 "--exact", f"t={exact!r}", "--out", "steps", "-p", "step=0.25")
        done = self.study(*words)
        self.assertEqual((0, ""), (done.returncode, done.stderr), done.stderr)
        rows = [row for row in self.table("steps") if row["ladder"] == "step" and row["quantity"] == "t"]
        for row, h in zip(rows, (0.5, 0.25, 0.125, 0.0625)):
            self.assertAlmostEqual(100 * (1 + h)**(-4 / h), float(row["value"]), places=6)
            self.assertAlmostEqual(abs(float(row["value"]) / exact - 1), float(row["relative_error"]), places=12)
            self.assertGreater(float(row["wall_s"]), 0)
            self.assertGreater(float(row["processor_s"]), 0)
        self.assertAlmostEqual(1.0, float(rows[-1]["order"]), delta=0.1)
        halfway = [row for row in self.table("steps") if row["ladder"] == "step" and row["quantity"] == "t@2"]
        self.assertIn("Richardson", halfway[0]["truth_from"])
        self.assertAlmostEqual(100 * math.exp(-2), float(halfway[0]["truth"]), delta=0.2)
        for name in ("study.md", "work_precision.svg"):
            self.assertTrue(os.path.getsize(os.path.join(self.folder, "steps", name)) > 0)
        summaries = sorted(glob.glob(os.path.join(self.folder, "steps", "*", "summary.json")))
        self.assertEqual(6, len(summaries))
        # a run's seconds are at least those that its program counts itself
        first = rows[0]
        with open(os.path.join(self.folder, "steps", "step0.5", "summary.json"), encoding="utf-8") as file:
            self.assertGreaterEqual(float(first["processor_s"]), json.load(file)["cpu_s"] - 0.05)
        before = [os.stat(path).st_mtime_ns for path in summaries]
        os.remove(summaries[0])       # one that was interrupted is made again, the others are not
        self.assertEqual(0, self.study(*words).returncode)
        after = [os.stat(path).st_mtime_ns for path in summaries]
        self.assertEqual([False] + 5 * [True], [a == b for a, b in zip(before, after)])
        with open(os.path.join(self.folder, "copper.inc"), "a", encoding="ascii") as file:
            file.write("! a file that the deck includes has changed\n")
        self.assertEqual(0, self.study(*words).returncode)
        self.assertFalse(any(os.stat(path).st_mtime_ns == old for path, old in zip(summaries, after)))

    def begin(self, *words):
        return subprocess.Popen([os.path.join(BIN, "lagastudy"), *words], cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                env=dict(os.environ, PYTHONDONTWRITEBYTECODE="1"))

    def wait_for(self, path):
        end = time.monotonic() + 60
        while not os.path.exists(os.path.join(self.folder, path)) and time.monotonic() < end:
            time.sleep(0.01)
        self.assertTrue(os.path.exists(os.path.join(self.folder, path)), path)

    def test_study_that_is_stopped(self):
        """TERM ends the run at work too, begins no other one, and the same command goes on; after KILL the run that is left keeps its folder."""
        ladder = ("bar.lag", "--ladder", "step=0.00005,0.000025,0.0000125", "--quantity", "t")
        for number in (signal.SIGTERM, signal.SIGINT):
            out = f"stopped{int(number)}"
            study = self.begin(*ladder, "--out", out)
            self.wait_for(os.path.join(out, "step0.00005", "lagamine.lock"))
            study.send_signal(number)
            self.assertEqual(128 + number, study.wait(timeout=60))
            self.assertEqual(["step0.00005"], sorted(os.listdir(os.path.join(self.folder, out))))
            self.assertEqual(128 + signal.SIGTERM, self.code_of(os.path.join(out, "step0.00005")))
        study = self.begin(*ladder, "--out", "killed")
        self.wait_for(os.path.join("killed", "step0.00005", "lagamine.lock"))
        study.kill()
        study.wait(timeout=60)
        done = self.study(*ladder, "--out", "killed")
        self.assertEqual(5, done.returncode, done.stderr)
        self.assertIn("step0.00005: a program is at work there", done.stderr)
        with open(os.path.join(self.folder, "killed", "step0.00005", "lagamine.lock"), encoding="utf-8") as file:
            left = int(re.search(r"\d+", file.read())[0])
        os.kill(left, signal.SIGTERM)

    def code_of(self, folder):
        with open(os.path.join(self.folder, folder, "summary.json"), encoding="utf-8") as file:
            return json.load(file)["exit_code"]

    def test_run_that_fails(self):
        done = self.study("pull.lag", "--ladder", "load=0.5,1.,2.", "--quantity", "plastic_work", "--out", "pull")
        self.assertEqual(3, done.returncode, done.stderr)
        self.assertIn("load=2. did not reach its end: ", done.stdout)
        self.assertEqual(["0", "0", "3"], [row["exit_code"] for row in self.table("pull")])
        self.assertEqual("nan", self.table("pull")[2]["value"])

    def test_scheduler(self):
        words = ("bar.lag", "--ladder", "step=0.5,0.25", "--quantity", "t", "--out", "array")
        done = self.study(*words, "--slurm", "array.sh")
        self.assertEqual((0, "2 runs: sbatch array.sh\n"), (done.returncode, done.stdout), done.stderr)
        for task in ("1", "2"):
            subprocess.run(["sh", os.path.join(self.folder, "array.sh")], check=True, env=dict(os.environ, SLURM_ARRAY_TASK_ID=task))
        made = [os.stat(path).st_mtime_ns for path in sorted(glob.glob(os.path.join(self.folder, "array", "*", "summary.json")))]
        self.assertEqual(2, len(made))
        again = self.study(*words, "--slurm", "again.sh")
        self.assertEqual((0, False), (again.returncode, os.path.exists(os.path.join(self.folder, "again.sh"))), again.stderr)
        self.assertIn("all runs are there", again.stdout)
        self.assertEqual(0, self.study(*words, "--jobs", "2").returncode)
        self.assertEqual(made, [os.stat(path).st_mtime_ns for path in sorted(glob.glob(os.path.join(self.folder, "array", "*", "summary.json")))])

    def test_refused(self):
        deck = ("bar.lag", "--out", "refused")
        for words, message in (((*deck, "--ladder", "step=1.", "--quantity", "t"), "expected two values or more"),
                               ((*deck, "--ladder", "step", "--quantity", "t"), "expected NAME=VALUE,VALUE"),
                               ((*deck, "--ladder", "step=1.,.5 n=1,2,4", "--quantity", "t"), "as many values of each parameter"),
                               ((*deck, "--ladder", "step=1.,1.", "--quantity", "t"), "two runs are the same"),
                               ((*deck, "--ladder", "step=1.,.5", "--quantity", "t@half"), "expected max, min, end or a time"),
                               ((*deck, "--ladder", "step=1.,.5", "--quantity", "t", "--exact", "u=1"), "of no --quantity"),
                               ((*deck, "--ladder", "step=1.,.5", "--quantity", "t", "--exact", "t=one"), "expected t=NUMBER"),
                               ((*deck, "--ladder", "step=1.,.5", "--quantity", "u"), "no such column; there are: time"),
                               ((*deck, "--ladder", "step=1.,.5", "--quantity", "t@1.3"), "no step of a run has to end at this time, the nearest at 1"),
                               ((*deck, "--ladder", "step=1.,.5", "--quantity", "t@9"), "no step of a run has to end at this time, the nearest at 4"),
                               ((*deck, "--ladder", "step=.25,.5,1.", "--quantity", "t"), "from the coarsest to the finest, found 16 steps with step=.25 and 4 with step=1."),
                               ((*deck, "--ladder", "n=4,2", "--quantity", "t"), "from the coarsest to the finest, found"),
                               ((*deck, "--ladder", "stop=1.,.5", "--quantity", "t"), "stop"),
                               ((*deck, "--ladder", "step=1.,.5", "--quantity", "t", "--jobs", "0"), "--jobs: expected 1 or more"),
                               (("nowhere.lag", "--ladder", "step=1.,.5", "--quantity", "t"), "nowhere.lag: cannot be read")):
            done = self.study(*words)
            self.assertEqual(2, done.returncode, (words, done.stderr))
            self.assertIn(message, done.stderr)
            self.assertNotIn("Traceback", done.stderr)
        # by the deck before any run, where steps may have any length and where they are equal; what the deck does not say, after the first run
        with open(os.path.join(self.folder, "grow.lag"), "w", encoding="ascii") as file:
            file.write(BAR.replace("STRAT  $step 1.E-6 $step", "SAVE TIMES 1.7\nSTRAT  $step 1.E-6 2*$step"))
        for deck_of, at, made in (("grow.lag", "t@2", None), ("bar.lag", "t@1.3", None), ("bar.lag", "u", ["step1."])):
            done = self.study(deck_of, "--ladder", "step=1.,.5", "--quantity", at, "--out", "early")
            self.assertEqual(2, done.returncode, done.stderr)
            folder = os.path.join(self.folder, "early")
            self.assertEqual(made, os.listdir(folder) if os.path.isdir(folder) else None, (deck_of, at))
        done = self.study("grow.lag", "--ladder", "step=1.,.5", "--quantity", "t@1.7", "--quantity", "t@4", "--out", "hit")
        self.assertEqual((0, ""), (done.returncode, done.stderr))
        os.makedirs(os.path.join(self.folder, "mine", "step1."))
        done = self.study("bar.lag", "--out", "mine", "--ladder", "step=1.,.5", "--quantity", "t")
        self.assertEqual(2, done.returncode)
        self.assertIn("no run of a study", done.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
