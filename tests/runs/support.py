"""What the tests of whole runs share: programs, decks, runs, comparison of results, and the count of what holds.

Scripts here run with any Python 3.8 or later. Contents of HDF5 files are compared with h5py; where the interpreter lacks it, a
script starts itself again with LAGAMINE_PYTHON, and without that the files are compared by `h5diff`.
"""
import csv
import glob
import hashlib
import importlib.util
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time

HERE = os.path.dirname(os.path.abspath(__file__))
SOURCE = os.environ.get("LAGAMINE_SOURCE") or os.path.dirname(os.path.dirname(HERE))
BIN = os.environ.get("LAGAMINE_BIN") or os.path.join(SOURCE, "build", "bin")
LAGAMINE = os.path.join(os.path.abspath(BIN), "lagamine")
UPSETTING = os.path.join(SOURCE, "decks", "upsetting", "upsetting.lag")
DONE, INPUT, NO_CONVERGENCE, MACHINE, SIGNAL = 0, 2, 3, 5, 128
LONGEST_RUN = 300  # seconds


def with_h5py():
    """Start the script again with LAGAMINE_PYTHON if this interpreter has no h5py and that one may have."""
    other = os.environ.get("LAGAMINE_PYTHON")
    if importlib.util.find_spec("h5py") or not other or os.environ.get("LAGAMINE_PYTHON_TRIED"):
        return
    os.environ["LAGAMINE_PYTHON_TRIED"] = "1"
    os.execv(other, [other] + sys.argv)


class Checks:
    """Counts what holds and prints what does not; `-v` prints all."""

    def __init__(self):
        self.passed = self.failed = 0
        self.verbose = "-v" in sys.argv[1:]
        self.folder = tempfile.mkdtemp(prefix="lagamine-runs-")

    def that(self, holds, what, detail=""):
        """One check; `detail` is printed when it fails."""
        self.passed += bool(holds)
        self.failed += not holds
        if not holds:
            print(f"FAILED {what}" + (f": {detail}" if str(detail) else ""), flush=True)
        elif self.verbose:
            print(f"ok     {what}", flush=True)
        return bool(holds)

    def path(self, *names):
        """A path in the test's own folder."""
        return os.path.join(self.folder, *names)

    def end(self):
        """Print the count, remove the folder (kept with -k), end with 0 or 1."""
        if "-k" in sys.argv[1:]:
            print(f"kept {self.folder}")
        else:
            shutil.rmtree(self.folder, ignore_errors=True)
        print(f"{self.passed} passed, {self.failed} failed")
        sys.exit(1 if self.failed or not self.passed else 0)


def deck_text(path=UPSETTING):
    """Text of a deck."""
    with open(path, encoding="utf-8") as deck:
        return deck.read()


def write(path, text):
    """Write a text file; its path."""
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    return path


def add_cards(text, cards):
    """Cards before END."""
    head, end = text.rsplit("\nEND", 1)
    return head + "\n" + cards.strip("\n") + "\nEND" + end


def mesh(nx, ny):
    """Options that give a deck another mesh."""
    return ["-p", f"nx={nx}", "-p", f"ny={ny}"]


def start(arguments, cwd=None, **more):
    """Start lagamine and do not wait."""
    return subprocess.Popen([LAGAMINE] + arguments, cwd=cwd, text=True, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE, **more)


def run(arguments, cwd=None, **more):
    """Run lagamine to its end: returncode, stdout, stderr."""
    return subprocess.run([LAGAMINE] + arguments, cwd=cwd, text=True, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, timeout=LONGEST_RUN, check=False, **more)


def said(result):
    """What a run said, for messages."""
    return f"exit code {result.returncode}, said: {result.stderr.strip() or result.stdout.strip()[:400]}"


def rows_so_far(folder):
    """Whole rows of history.csv without its header, while a run may be writing it."""
    try:
        with open(os.path.join(folder, "history.csv"), "rb") as file:
            return max(file.read().count(b"\n") - 1, 0)
    except OSError:
        return 0


def stop_after(process, folder, rows, number, wait=0.0):
    """Send a signal once the history has so many rows, plus `wait` seconds; exit code and what was said."""
    limit = time.monotonic() + LONGEST_RUN
    while process.poll() is None and rows_so_far(folder) < rows and time.monotonic() < limit:
        time.sleep(0.0005)
    time.sleep(wait)
    if process.poll() is None:
        process.send_signal(number)
    stdout, stderr = process.communicate(timeout=LONGEST_RUN)
    return process.returncode, stdout, stderr


def read_bytes(path):
    """Bytes of a file, empty when it is not there."""
    try:
        with open(path, "rb") as file:
            return file.read()
    except OSError:
        return b""


def history(folder):
    """Columns of history.csv by name without unit."""
    with open(os.path.join(folder, "history.csv"), newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    names = [title.split(" [")[0] for title in rows[0]]
    return {name: [float(row[k]) for row in rows[1:]] for k, name in enumerate(names)}


def summary(folder, name="summary.json"):
    """summary.json, or that of an operation."""
    with open(os.path.join(folder, name), encoding="utf-8") as file:
        return json.load(file)


def h5_differences(first, second, leave_out=()):
    """Names of objects and attributes in which two HDF5 files differ, bit by bit; those whose name begins with a word of
    `leave_out` are passed over."""
    if importlib.util.find_spec("h5py"):
        one, two = h5_contents(first), h5_contents(second)
        names = sorted(name for name in set(one) | set(two) if one.get(name) != two.get(name))
        return [name for name in names if not name.startswith(tuple(leave_out) or "\0")]
    excluded = [word for name in leave_out if "@" not in name for word in ("--exclude-path", "/" + name)]
    command = ["h5diff", "--follow-symlinks"] + excluded + [first, second]
    result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    ours = [line for line in result.stdout.splitlines() if line.strip() and "difference" not in line
            and not any(name.startswith("@") and name[1:] in line for name in leave_out)]
    return ours if result.returncode else []


def h5_contents(path):
    """Every dataset (type, shape, digest of its bytes) and attribute of an HDF5 file by name; attributes are `object@name`."""
    import h5py  # pylint: disable=import-outside-toplevel
    import numpy  # pylint: disable=import-outside-toplevel

    def fingerprint(value):
        array = numpy.asarray(value)
        body = repr(array.tolist()).encode() if array.dtype == object else array.tobytes()
        return str(array.dtype), array.shape, hashlib.sha256(body).hexdigest()

    contents = {}

    def visit(name, thing):
        for key in thing.attrs:
            contents[f"{name}@{key}"] = fingerprint(thing.attrs[key])
        if isinstance(thing, h5py.Dataset):
            contents[name] = fingerprint(thing[()])
            return
        if name:
            contents[name] = "group"
        for key in thing:
            visit(f"{name}/{key}" if name else key, thing[key])   # links to saved instants are followed

    with h5py.File(path, "r") as file:
        visit("", file)
    return contents


def result_differences(first, second, previous=True):
    """What differs between two folders of results that should be of one and the same run: names of files, and what in them; the checkpoint before
    the last among them, but where a run was resumed from that one: the last one is kept in its place then."""
    wrong = []
    names = {os.path.relpath(path, folder) for folder in (first, second)
             for path in glob.glob(os.path.join(folder, "**"), recursive=True) if os.path.isfile(path)}
    for name in sorted(names):
        one, two = os.path.join(first, name), os.path.join(second, name)
        if name.endswith((".log", ".cost") if previous else (".log", ".cost", ".1.h5")) or (name.startswith("summary.") and name.endswith(".json")):
            continue
        if not (os.path.isfile(one) and os.path.isfile(two)):
            wrong.append(f"{name} is not in both folders")
        elif name.endswith(".h5"):
            if read_bytes(one) == read_bytes(two):      # the instants that it links to are files of the folder, compared as well
                continue
            # Deck's path as it was called is not part of the state.
            inside = h5_differences(one, two, leave_out=("deck/path",))
            if inside:
                wrong.append(f"{name}: {', '.join(inside[:4])}" + (f" and {len(inside) - 4} more" if len(inside) > 4 else ""))
        elif read_bytes(one) != read_bytes(two):
            wrong.append(f"{name}: {first_difference(read_bytes(one), read_bytes(two))}")
    return wrong


def first_difference(one, two):
    """The first line in which two texts differ."""
    lines = one.decode(errors="replace").splitlines(), two.decode(errors="replace").splitlines()
    for number, (a, b) in enumerate(zip(*lines), 1):
        if a != b:
            cells = [(x, y) for x, y in zip(re.split("[, ]", a), re.split("[, ]", b)) if x != y]
            return f"line {number}: {cells[:2]}"
    return f"{len(lines[0])} lines and {len(lines[1])}"
