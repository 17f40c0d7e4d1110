"""Folders of results that solver, remesher and lagacycle wrote, for tests of what reads them: small runs, each made once."""
import os
import shutil
import stat
import subprocess
import tempfile
import time

HERE = os.path.dirname(os.path.abspath(__file__))
SOURCE = os.environ.get("LAGAMINE_SOURCE") or os.path.dirname(os.path.dirname(HERE))
BIN = os.path.abspath(os.environ.get("LAGAMINE_BIN") or os.path.join(SOURCE, "build", "bin"))
DECK_NAME, TITLE = "decks/billet.lag", "Billet <10 x 30> & dies"
NO_CONVERGENCE = 3

# The dies are not in the order of their names; HDF5 lists them by name.
DECK = f"""TITLE  {TITLE}
STATE  $state
KINEM  LOG
BLOCK  billet  PL8LS 4 steel
   0. 0.   10. 0.   10. 15.   0. 15.
   4 1.0   6 1.0
LAW    steel  EPLA
   $young 0.3
   LINEAR 700. 300.
LAW    rough  COUL2D
   PENETR $penetr   PHI 0.3   AUGMENT $augment
DIE    zupper  PILOT 0. 15.
   SEGM  30. 15.   -1. 15.
DIE    a_wheel PILOT 16. 6.
   ARC   16. 3.   13. 6.   16. 9.   1.E-2
CNT2D  billet 2 3  zupper $points rough
CNT2D  billet 2    a_wheel $points rough
FIXED  billet 1  Y
FIXED  billet 4  X
LIC    press
   0. 0.     1. -$travel
LIC    push
   0. 0.     1. 0.5
MOVE   zupper Y press
MOVE   a_wheel X push
MOVE   a_wheel A push
PROBE  bulge NODE X 10. 0.
STRAT  $first  $least  $largest   4 3
SAVE   4
"""
NUMBERS = {"state": "AXISYM", "young": "200000.", "penetr": "1.E-3", "augment": "20", "points": "-3", "travel": "3.",
           "first": "0.01", "least": "1.E-5", "largest": "0.05"}
# Deep in its dies: soft, without augmentation, few points on a side.
SOFT = {"young": "25000.", "augment": "0", "points": "2", "travel": "2."}
REMSH = "REMSH\n   TIMES 0.1 0.2 0.3 0.4 0.5 0.6 0.7 0.8\n"
# A remesher that refuses its first five tries: the first stop goes on with the old mesh, the second goes back to an earlier state.
REFUSING = """#!/bin/sh
if [ "$1" != --about ] && [ "$(wc -l <'{count}')" -lt 5 ]; then
  echo x >>'{count}'
  echo 'an <angle> of 3' >&2
  exit 3
fi
exec '{remdata}' "$@"
"""


class Runs:
    """Makes each kind of run once, and hands out copies."""

    def __init__(self):
        self.folder = tempfile.mkdtemp(prefix="lagareport-runs-")

    def close(self):
        shutil.rmtree(self.folder, True)

    def copy(self, kind, target):
        """Results of a kind: "done", "stopped" (exit code 3), "soft" (deep in its dies), "cycle" (meshes, refused ones too)."""
        made = os.path.join(self.folder, kind)
        if not os.path.exists(made):
            {"done": self.done, "stopped": self.stopped, "soft": self.soft, "cycle": self.cycle}[kind](made)
        shutil.rmtree(target, True)
        return shutil.copytree(made, target)

    def done(self, out):
        self.call("lagamine", out, {}, 0)

    def stopped(self, out):
        self.call("lagamine", out, {"state": "PLSTN", "travel": "13.5", "first": "0.02", "least": "0.02", "largest": "0.02"},
                  NO_CONVERGENCE)

    def soft(self, out):
        self.call("lagamine", out, SOFT, 0)

    def cycle(self, out):
        count, script = os.path.join(self.folder, "refused"), os.path.join(self.folder, "refusing")
        with open(count, "w", encoding="utf-8"):
            pass
        with open(script, "w", encoding="utf-8") as file:
            file.write(REFUSING.format(count=count, remdata=os.path.join(BIN, "remdata")))
        os.chmod(script, stat.S_IRWXU)
        self.call("lagacycle", out, {}, 0, REMSH, dict(os.environ, REMDATA=script))

    def call(self, program, out, numbers, code, more="", environment=None):
        """Run a program to its end, which must be with this exit code."""
        run = subprocess.run(self.command(program, out, numbers, more), cwd=self.folder, env=environment, capture_output=True,
                             text=True)
        if run.returncode != code:
            raise AssertionError(f"{program}: exit code {run.returncode}, not {code}\n{run.stdout}{run.stderr}")

    def command(self, program, out, numbers, more=""):
        """Words of a call, its deck written."""
        deck = os.path.join(self.folder, DECK_NAME)
        os.makedirs(os.path.dirname(deck), exist_ok=True)
        text = DECK
        for name, value in {**NUMBERS, **numbers}.items():
            text = text.replace("$" + name, value)
        with open(deck, "w", encoding="utf-8") as file:
            file.write(text + more + "END\n")
        return [os.path.join(BIN, program), DECK_NAME, "--out", out, "--threads", "1"]

    def begin(self, out, rows):
        """A run that is under way and has written so many steps into its history."""
        numbers = {"first": "1.E-4", "largest": "1.E-4"}
        run = subprocess.Popen(self.command("lagamine", out, numbers), cwd=self.folder, stdout=subprocess.DEVNULL)
        deadline = time.monotonic() + 60
        while lines(os.path.join(out, "history.csv")) <= rows:
            if run.poll() is not None or time.monotonic() > deadline:
                raise AssertionError(f"the run has not come to step {rows}")
            time.sleep(0.01)
        return run


def lines(path):
    """Whole lines of a file; 0 where there is none."""
    if not os.path.exists(path):
        return 0
    with open(path, "rb") as file:
        return file.read().count(b"\n")
