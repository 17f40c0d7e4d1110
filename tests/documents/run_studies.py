#!/usr/bin/env python3
"""The studies of the decks (src/documents/studies.py): the short ones run, their tables have every run, and they leave the decks alone."""
import csv
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
SOURCE = os.path.abspath(os.environ.get("LAGAMINE_SOURCE") or os.path.dirname(os.path.dirname(HERE)))
BIN = os.path.abspath(os.environ.get("LAGAMINE_BIN") or os.path.join(SOURCE, "build", "bin"))
PYTHON = os.environ.get("LAGAMINE_PYTHON") or sys.executable
RUNS = {"thick_cylinder_plastic": 4, "hertz": 4, "finite_cylinder": 8, "upsetting": 4, "necking": 8, "quench_16mnd5": 8, "residual_stress": 8}


class Studies(unittest.TestCase):
    def test_short(self):
        folder = tempfile.mkdtemp(prefix="lagamine-studies-")
        self.addCleanup(shutil.rmtree, folder, True)
        before = self.files()
        done = subprocess.run([PYTHON, os.path.join(SOURCE, "src", "documents", "studies.py"), "--short", "--programs", BIN, "--runs", folder],
                              check=False, capture_output=True, text=True)
        self.assertEqual(0, done.returncode, done.stderr)
        self.assertEqual(set(RUNS), {line.partition(":")[0] for line in done.stdout.splitlines()})
        for name, number in RUNS.items():
            with open(os.path.join(folder, name, "study.csv"), newline="", encoding="utf-8") as file:
                rows = list(csv.DictReader(file))
            self.assertEqual(number, len(rows), name)
            self.assertEqual({"0"}, {row["exit_code"] for row in rows}, name)
            for row in rows:
                self.assertEqual(float(row["value"]), float(row["value"]), name)
        self.assertEqual(before, self.files())

    def test_unknown(self):
        done = subprocess.run([PYTHON, os.path.join(SOURCE, "src", "documents", "studies.py"), "herz"], check=False, capture_output=True, text=True)
        self.assertNotEqual(0, done.returncode)
        self.assertIn("no study herz; there are: thick_cylinder_plastic, hertz", done.stderr)

    @staticmethod
    def files():
        """Files of decks and when they were changed."""
        return {os.path.join(place, name): os.stat(os.path.join(place, name)).st_mtime_ns
                for place, _, names in os.walk(os.path.join(SOURCE, "decks")) for name in names}


if __name__ == "__main__":
    unittest.main(verbosity=2)
