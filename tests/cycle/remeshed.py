"""What the tests of remeshed decks share: forces at places, jumps at remeshings, what the programs say of a mesh."""
import csv
import glob
import json
import os
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
sys.path.insert(0, os.path.join(os.path.dirname(HERE), "runs"))
from support import BIN  # noqa: E402


def cycle(deck, out, *options):
    """lagacycle on one thread: its exit code and what it said."""
    result = subprocess.run([os.path.join(os.path.abspath(BIN), "lagacycle"), deck, "--out", out, "--threads", "1", *options],
                            text=True, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False)
    return result.returncode, result.stdout + result.stderr


def tries(out):
    """Rows of cycle.csv."""
    with open(os.path.join(out, "cycle.csv"), newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def value_at(rows, name, along, wanted):
    """A column of the history where another one that ascends has a value, straight between steps."""
    k = next(k for k, u in enumerate(rows[along]) if u >= wanted - 1e-9)
    before, after = rows[along][k - 1], rows[along][k]
    return rows[name][k - 1] + (wanted - before) / (after - before) * (rows[name][k] - rows[name][k - 1])


def jump(rows, name, step):
    """Relative distance of a force after a step from the straight line before it."""
    time, force, k = rows["time"], rows[name], rows["step"].index(step)
    line = force[k] + (force[k] - force[k - 1]) / (time[k] - time[k - 1]) * (time[k + 1] - time[k])
    return force[k + 1] / line - 1


def facts(out, generation, kind):
    """What remdata (start) or the restart said of a mesh."""
    pattern = {"start": f"*.g{generation:02d}.start.h5.json", "restart": f"*.g{generation:02d}.restart.json"}[kind]
    with open(glob.glob(os.path.join(out, pattern))[0], encoding="utf-8") as file:
        return json.load(file)


def put_table(readme, mark, lines):
    """Lines between two marks of a README."""
    with open(readme, encoding="utf-8") as file:
        head, _, tail = file.read().split(mark)
    with open(readme, "w", encoding="utf-8") as file:
        file.write(head + mark + "\n" + "\n".join(lines) + "\n" + mark + tail)
