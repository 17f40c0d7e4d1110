"""What the hard cases share: decks of one block, runs on a number of threads, a case with its bound."""
import csv
import dataclasses
import json
import os
import subprocess
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), os.pardir, "patch"))
from patch_support import Checks, LAGAMINE, Run, SOURCE, np  # noqa: E402,F401

LONG = True  # cases that the short form leaves out
PLASTIC = "LAW m EPLA\n 200000. 0.3\n LINEAR 300. 500.\nLAW k COUL2D\n PENETR 1.E-3 PHI 0.2\n"


@dataclasses.dataclass
class Case:
    """A hard case: its name, what runs it and answers how far it is off, how far it may be, whether only the long form has it."""
    name: str
    run: object
    bound: float
    long: bool = False


class Hard(Checks):
    """Checks that count steps, iterations and seconds of the runs of a case."""

    def __init__(self):
        super().__init__()
        self.steps = self.iterations = self.cuts = 0

    def run(self, name, text, code=0, threads=1):
        """A deck that must end with this code."""
        run = Run(self, name, text, code, threads)
        if not run.ok:
            raise RuntimeError(f"{name}: {run.code} {run.said[-300:]}")
        summary = report(run)
        self.steps += summary["steps"]
        self.iterations += summary["iterations"]
        return run


    def point(self, name, text):
        """Columns of a path of one point, by name without unit."""
        path, out = os.path.join(self.folder, name + ".point"), os.path.join(self.folder, name)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        done = subprocess.run([LAGAMINE, "--point", path, "--out", out, "--quiet"], text=True, check=False, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        if done.returncode:
            raise RuntimeError(f"{name}: {done.returncode} {done.stderr[-300:]}")
        with open(os.path.join(out, name + ".point.csv"), newline="", encoding="utf-8") as file:
            rows = list(csv.reader(file))
        self.steps += len(rows) - 1
        return {title.split(" [")[0]: np.array([float(row[k]) for row in rows[1:]]) for k, title in enumerate(rows[0])}


def report(run):
    """summary.json of a run."""
    with open(os.path.join(run.out, "summary.json"), encoding="utf-8") as file:
        return json.load(file)


def block(corners, divisions, more="", points=4):
    """A block b of the law m."""
    return f"BLOCK b PL8LS {points} m\n {corners}\n {divisions}\n{more}"


def deck(plane, kinematics, bodies, laws, loads, strat):
    """A whole deck."""
    return f"TITLE hard case\nSTATE {plane}\nKINEM {kinematics}\n{bodies}{laws}{loads}{strat}\nEND\n"
