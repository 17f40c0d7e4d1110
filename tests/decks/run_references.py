#!/usr/bin/env python3
"""The decks against their references: decks/*/reference.csv, each row a number that a run must give.

usage: run_references.py [NAME...] [--all] [--write] [--selftest]
  NAME         only the folders decks/NAME
  --all        also the rows marked long: minutes instead of seconds
  --write      all rows, and the table of each decks/*/README.md anew, between its two lines <!-- table -->
  --selftest   only show that what is wrong fails; every run begins with this
LAGAMINE_BIN is the folder of `lagamine` (default: build/bin of this project). Each pair (deck, options) is run once, in a
folder of its own. Ends with 0 only if every row holds and there was one.

Columns of reference.csv, in any order:
  deck           NAME.lag beside the file, without .lag
  options        options of `lagamine`, or nothing
  exit_code      what the run must end with, for each of its rows
  at             `end` (the last row of history.csv), `max` or `min` (the row where the quantity is largest or least), or
                 `expression=expression`: where the left side, linear between the steps, first has the value of the right side;
                 `expression=expression to expression`: the change of the quantity between two such places
  quantity       expression of columns of history.csv (named without their unit), also linear between the steps;
                 or `summary:a.b`, the number b of a in summary.json, at the end
  expected       expression of numbers
  tolerance_pct  largest deviation from it in percent, where kind is `value`
  kind           `value` (also if empty), `below`: found < expected, `above`: found > expected; this column may be missing
  long           `yes`: only with --all; this column may be missing
  source         where the number comes from
Expressions know + - * / **, brackets, pi, sqrt log exp sin cos tan, and largest(f, a, b): the largest value of f, an
expression of t with a single maximum, for t from a to b; in `expected` also the functions of closed_forms.py. What cannot
be computed, NaN among it, fails.
"""
import argparse
import ast
import csv
import glob
import io
import json
import math
import operator
import os
import shlex
import subprocess
import sys
import tempfile
import time
from collections import namedtuple

import closed_forms

HERE = os.path.dirname(os.path.abspath(__file__))
SOURCE = os.path.abspath(os.environ.get("LAGAMINE_SOURCE") or os.path.dirname(os.path.dirname(HERE)))
BIN = os.path.abspath(os.environ.get("LAGAMINE_BIN") or os.path.join(SOURCE, "build", "bin"))
REQUIRED = ("deck", "options", "exit_code", "at", "quantity", "expected", "tolerance_pct", "source")
OPTIONAL = ("kind", "long")
MARK = "<!-- table -->"
RUN_TIMEOUT = 1000              # seconds, below the 1200 that ctest gives the whole test
LONG_TIMEOUT = 7200
FRACTION_SLACK = 1e-12           # by how much fractions of phases may leave [0, 1], or their sum 1, in any step of any run: round-off
                                 # (the solver has a limit of its own; this one does not come from what is tested)
END_SLACK = 1e-9                # share by which the last step may miss the place asked for: rounding

OPERATORS = {ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv,
             ast.Pow: operator.pow, ast.USub: operator.neg, ast.UAdd: operator.pos}
FUNCTIONS = {name: getattr(math, name) for name in ("sqrt", "log", "exp", "sin", "cos", "tan")}
FORMS = {name: getattr(closed_forms, name) for name in closed_forms.FORMS}
CONSTANTS = {"pi": math.pi}
EXTREMES = {"max": max, "min": min}

# What a run left: its exit code (None: stopped by us), table by column, summary, first line of its errors, seconds.
Run = namedtuple("Run", "exit_code history summary message seconds")
# What became of a row; `why` is empty where it holds.
Verdict = namedtuple("Verdict", "folder row found expected deviation why")


class Unmet(Exception):
    """A row that cannot be judged, and why."""


def largest(function, low, high):
    """Largest value of a function that rises, then falls: thirds are cut off until nothing is left."""
    while True:
        left, right = (2*low + high)/3, (low + 2*high)/3
        if not low < left < right < high:
            return function(left)
        if function(left) < function(right):
            low = left
        else:
            high = right


def evaluate(text, names):
    """Value of an expression. No names but those given, `pi`, and no calls but those of FUNCTIONS and `largest`."""
    def value(node, names=names):
        if isinstance(node, ast.Constant) and type(node.value) in (int, float):
            return float(node.value)
        if isinstance(node, ast.BinOp) and type(node.op) in OPERATORS:
            return OPERATORS[type(node.op)](value(node.left, names), value(node.right, names))
        if isinstance(node, ast.UnaryOp) and type(node.op) in OPERATORS:
            return OPERATORS[type(node.op)](value(node.operand, names))
        if isinstance(node, ast.Name):
            if node.id in names:
                return names[node.id]
            if node.id in CONSTANTS:
                return CONSTANTS[node.id]
            raise Unmet(f"no column '{node.id}'" if names else f"'{node.id}' is no number")
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in FORMS and not names:
            if any(word.arg is None for word in node.keywords):
                raise Unmet(f"cannot read '{text}'")
            return FORMS[node.func.id](*(value(one, names) for one in node.args),
                                       **{word.arg: value(word.value, names) for word in node.keywords})
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and not node.keywords:
            if node.func.id in FUNCTIONS and len(node.args) == 1:
                return FUNCTIONS[node.func.id](value(node.args[0], names))
            if node.func.id == "largest" and len(node.args) == 3:
                return largest(lambda t: value(node.args[0], dict(names, t=t)), value(node.args[1], names),
                               value(node.args[2], names))
        raise Unmet(f"cannot read '{text}'")

    try:
        result = value(ast.parse(text.strip(), mode="eval").body)
    except SyntaxError:
        raise Unmet(f"cannot read '{text}'") from None
    except TypeError as error:
        raise Unmet(str(error)) from None
    except (ArithmeticError, ValueError):
        return math.nan
    return result if isinstance(result, float) else math.nan     # a root of a negative number is complex


def place(at, rows):
    """Where `at` lies in the table: the row before it, the row after it, the share of the way."""
    if at == "end":
        return rows[-1], rows[-1], 0.0
    left, equals, right = at.partition("=")
    if not equals:
        raise Unmet(f"at is `end`, `max`, `min` or `expression=expression`, not '{at}'")
    wanted = evaluate(right, {})
    along = [evaluate(left, row) for row in rows]
    for k in range(len(rows) - 1):
        low, high = along[k], along[k + 1]
        if min(low, high) <= wanted <= max(low, high):
            return rows[k], rows[k + 1], (wanted - low)/(high - low) if high != low else 0.0
    if abs(along[-1] - wanted) <= END_SLACK*abs(wanted):
        return rows[-1], rows[-1], 0.0
    raise Unmet(f"{at} is not reached: {along[0]:.6g} to {along[-1]:.6g}")


def measure(row, run):
    """The number that a row asks for."""
    if row["quantity"].startswith("summary:"):
        value = run.summary
        if row["at"] != "end":
            raise Unmet("summary.json is of the end")
        for key in row["quantity"][len("summary:"):].split("."):
            if not isinstance(value, dict) or key not in value:
                raise Unmet(f"no '{key}' in summary.json")
            value = value[key]
        if type(value) not in (int, float):
            raise Unmet(f"{row['quantity']} is no number")
        return float(value)
    if not run.history:
        raise Unmet("no rows in history.csv")
    if row["at"] in EXTREMES:
        values = [evaluate(row["quantity"], line) for line in run.history]
        return EXTREMES[row["at"]](values) if all(map(math.isfinite, values)) else math.nan
    begin, to, end = row["at"].partition(" to ")
    if not to:
        return value_at(begin, row["quantity"], run.history)
    left, _, _ = begin.partition("=")
    return value_at(f"{left}={end}", row["quantity"], run.history) - value_at(begin, row["quantity"], run.history)


def value_at(at, quantity, rows):
    """A quantity at a place, linear between the steps."""
    before, after, share = place(at, rows)
    first, second = evaluate(quantity, before), evaluate(quantity, after)
    return first + share*(second - first)


def judge(folder, row, run):
    """Hold a row against its run."""
    found = expected = deviation = math.nan
    why = ""
    try:
        if run.exit_code is None:
            raise Unmet(run.message)
        if run.exit_code != int(row["exit_code"]):
            raise Unmet(f"exit code {run.exit_code}, wanted {row['exit_code']}: {run.message}")
        expected = evaluate(row["expected"], {})
        found = measure(row, run)
        if not math.isfinite(found) or not math.isfinite(expected):
            raise Unmet("not a finite number")
        kind = row["kind"] or "value"
        if kind == "below":
            why = "" if found < expected else "not below"
        elif kind == "above":
            why = "" if found > expected else "not above"
        elif kind != "value":
            raise Unmet(f"kind '{kind}': value, below or above")
        elif expected == 0:
            raise Unmet("0 is expected: no deviation in percent")
        else:
            tolerance = float(row["tolerance_pct"] or "nan")
            if not tolerance > 0:
                raise Unmet("kind `value` wants a tolerance above 0")
            deviation = 100*(found - expected)/abs(expected)
            why = "" if abs(deviation) <= tolerance else "deviates"
    except Unmet as error:
        why = str(error)
    except ValueError as error:
        why = f"a word for a number: {error}"
    return Verdict(folder, row, found, expected, deviation, why)


def read_references(path):
    """The rows of a reference.csv."""
    with open(path, newline="") as file:
        reader = csv.DictReader(file, skipinitialspace=True)
        columns = reader.fieldnames or []
        wrong = sorted(set(REQUIRED).difference(columns)) + sorted(set(columns).difference(REQUIRED + OPTIONAL))
        if wrong:
            raise Unmet(f"columns missing or unknown: {' '.join(wrong)}")
        rows = []
        for row in reader:
            if None in row or None in row.values():
                raise Unmet(f"line {reader.line_num}: {len(columns)} fields wanted")
            rows.append({key: row.get(key, "").strip() for key in REQUIRED + OPTIONAL})
    if not rows:
        raise Unmet("no rows")
    return rows


def read_history(path):
    """Rows of history.csv, each a dictionary of its columns."""
    with open(path, newline="") as file:
        lines = list(csv.reader(file))
    names = [name.split(" [")[0] for name in lines[0]] if lines else []
    for number, line in enumerate(lines, 1):
        if len(line) != len(names):
            raise ValueError(f"history.csv, line {number}: {len(line)} fields under {len(names)} names")
    return [dict(zip(names, map(float, line))) for line in lines[1:]]


def run_deck(program, deck, options, seconds):
    """Run a deck in a folder of its own and read what it left."""
    with tempfile.TemporaryDirectory(prefix="lagamine-") as folder:
        out = os.path.join(folder, "out")
        begin = time.monotonic()
        try:
            done = subprocess.run([program, deck, *shlex.split(options), "--quiet", "--out", out], cwd=folder, text=True,
                                  timeout=seconds, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        except subprocess.TimeoutExpired:
            return Run(None, [], {}, f"stopped after {seconds} s", seconds)
        took = time.monotonic() - begin
        message = done.stderr.strip().partition("\n")[0]
        try:
            history = read_history(os.path.join(out, "history.csv"))
            with open(os.path.join(out, "summary.json")) as file:
                summary = json.load(file)
        except (OSError, ValueError) as error:
            return Run(done.returncode, [], {}, message or str(error), took)
        return Run(done.returncode, history, summary, message, took)


def check_decks(decks, program, names, with_long, report):
    """Run and judge: verdicts of all rows, and what is wrong with the files themselves."""
    verdicts, faults = [], []
    folders = [os.path.join(decks, name) for name in names] or sorted(
        map(os.path.dirname, glob.glob(os.path.join(decks, "*", "reference.csv"))))
    for folder in folders:
        name = os.path.basename(folder)
        runs = {}
        try:
            rows = read_references(os.path.join(folder, "reference.csv"))
        except (OSError, Unmet) as error:
            faults.append(f"decks/{name}/reference.csv: {error}")
            continue
        for row in rows:
            if row["long"] not in ("", "yes"):
                faults.append(f"decks/{name}/reference.csv: long is `yes` or empty, not '{row['long']}'")
            if row["long"] and not with_long:
                continue
            key = (row["deck"], row["options"])
            deck = os.path.join(folder, row["deck"] + ".lag")
            if key not in runs and not os.path.isfile(deck):
                runs[key] = Run(None, [], {}, f"no deck decks/{name}/{row['deck']}.lag", 0.0)
            elif key not in runs:
                runs[key] = run_deck(program, deck, row["options"], LONG_TIMEOUT if row["long"] else RUN_TIMEOUT)
                report(f"{runs[key].seconds:8.2f} s  {' '.join(key)}")
                off = fractions_off(runs[key])
                if off is None and runs[key].summary and has_steel(deck):
                    faults.append(f"{' '.join(key)}: summary.json says nothing of the fractions of phases")
                if off is not None:
                    report(f"{'':11}fractions of phases within {off:.2g} of [0, 1] and of their sum 1, in every step")
                    if not off <= FRACTION_SLACK:
                        faults.append(f"{' '.join(key)}: fractions of phases miss [0, 1] or their sum 1 by {off:.3g}")
            verdicts.append(judge(name, row, runs[key]))
    if not verdicts and not faults:
        faults.append("nothing to compare: no reference.csv, or no row in it that is not long")
    return verdicts, faults


def fractions_off(run):
    """By how much fractions have left [0, 1] or their sum 1 in the worst step; None where there are no phases."""
    return run.summary.get("checks", {}).get("phase_fractions")


def has_steel(deck):
    """A law of the deck has phases."""
    with open(deck, encoding="utf-8") as text:
        return any(line.split()[:1] == ["STEEL"] for line in text)


def cells(verdict):
    """What a table shows of a verdict."""
    row = verdict.row
    sign = {"below": "< ", "above": "> "}.get(row["kind"], "")
    def number(value, form):
        return format(value, form) if math.isfinite(value) else "-"
    return [row["deck"], row["options"] or "-", row["quantity"], row["at"], number(verdict.found, ".6g"),
            sign + number(verdict.expected, ".7g"), number(verdict.deviation, "+.3f"), row["tolerance_pct"] or "-",
            "NO: " + verdict.why if verdict.why else "yes"]


HEADS = ["deck", "options", "quantity", "at", "found", "expected", "deviation %", "tolerance %", "ok"]


def print_table(verdicts):
    lines = [HEADS] + [cells(verdict) for verdict in verdicts]
    widths = [max(len(line[k]) for line in lines) for k in range(len(HEADS))]
    widths[-1] = 0
    for line in lines:
        print("  ".join(cell.ljust(width) for cell, width in zip(line, widths)))


def write_readme(folder, verdicts):
    """Put the table of these verdicts between the two marks of the folder's README.md; what is wrong, or nothing."""
    path = os.path.join(folder, "README.md")
    try:
        with open(path, encoding="utf-8") as file:
            parts = file.read().split(MARK + "\n")
    except OSError as error:
        return str(error)
    if len(parts) != 3:
        return f"{path}: wants two lines {MARK}"
    table = ["| " + " | ".join(HEADS + ["source"]) + " |", "|---"*(len(HEADS) + 1) + "|"]
    for verdict in verdicts:
        shown = cells(verdict)
        for k in (0, 1, 2, 3):
            shown[k] = f"`{shown[k]}`" if shown[k] != "-" else ""
        table.append("| " + " | ".join(cell if cell != "-" else "" for cell in shown + [verdict.row["source"]]) + " |")
    with open(path, "w", encoding="utf-8") as file:
        file.write(parts[0] + MARK + "\n" + "\n".join(table) + "\n" + MARK + "\n" + parts[2])
    return None


# A program that leaves three steps of a line y = 10 x + 10, a NaN and a table without rows, as its option says.
FAKE_PROGRAM = """#!{python}
import json, os, sys
out = sys.argv[sys.argv.index("--out") + 1]
os.makedirs(out)
with open(os.path.join(out, "history.csv"), "w") as file:
    file.write("x [length],y [force],void [-]\\n")
    if "empty" not in sys.argv:
        file.write("1.,20.,0.\\n2.,30.,NaN\\n3.,40.,NaN\\n")
with open(os.path.join(out, "summary.json"), "w") as file:
    json.dump({{"checks": {{"worst": 0.5, "phase_fractions": 2e-12 if "sums" in sys.argv else 2e-16}}, "status": "done"}}, file)
sys.exit(3 if "fails" in sys.argv else 0)
"""

FAKE_ROW = dict(deck="fake", options="", exit_code="0", at="end", quantity="y", expected="40", tolerance_pct="1", kind="",
                long="", source="made up")

# What is changed in a row that holds, and what must then be said; empty: it still holds.
FAKE_CASES = [
    (dict(), ""),
    (dict(at="x=1.5", expected="25"), ""),
    (dict(at="2*x/3=4/3", expected="5*6"), ""),
    (dict(at="x=3.0000000001"), ""),
    (dict(at="x=1.5 to 5/2", expected="10"), ""),
    (dict(expected="40*ring_pressure(0, 0.1)"), ""),
    (dict(expected="40*ring_pressure(0, 0.1, height=3)"), ""),
    (dict(quantity="y/(2*pi*x)+sqrt(log(1))", expected="40/(6*pi)"), ""),
    (dict(at="max"), ""),
    (dict(at="max", quantity="-y", expected="-20"), ""),
    (dict(at="min", expected="20"), ""),
    (dict(expected="40*exp(0)*(cos(pi)**2 + sin(pi))/tan(pi/4)"), ""),
    (dict(expected="largest(40-(t-1)**2, -1, 7)", tolerance_pct="1e-9"), ""),
    (dict(expected="largest(10*t, 0, 4)", tolerance_pct="1e-9"), ""),
    (dict(kind="below", expected="40.001", tolerance_pct=""), ""),
    (dict(kind="above", expected="39.999", tolerance_pct=""), ""),
    (dict(quantity="summary:checks.worst", expected="0.5"), ""),
    (dict(exit_code="3", options="fails"), ""),
    (dict(expected="39.59"), "deviates"),
    (dict(expected="40.41"), "deviates"),
    (dict(expected="0"), "0 is expected"),
    (dict(expected="-40"), "deviates"),
    (dict(expected="nan"), "no number"),
    (dict(expected="y"), "'y' is no number"),
    (dict(at="min"), "deviates"),
    (dict(at="max", quantity="void"), "finite"),
    (dict(at="max", quantity="z"), "no column 'z'"),
    (dict(expected="largest(40, 0)"), "cannot read"),
    (dict(expected="largest(log(t), -2, -1)"), "finite"),
    (dict(expected="largest(x, 0, 1)"), "'x'"),
    (dict(expected="t"), "'t' is no number"),
    (dict(expected="1/0"), "finite"),
    (dict(expected="4e"), "cannot read"),
    (dict(tolerance_pct=""), "tolerance"),
    (dict(tolerance_pct="nan"), "tolerance"),
    (dict(tolerance_pct="some"), "a word for a number"),
    (dict(kind="below"), "not below"),
    (dict(kind="above"), "not above"),
    (dict(kind="about"), "kind"),
    (dict(quantity="z"), "no column 'z'"),
    (dict(quantity="void"), "finite"),
    (dict(quantity="void", at="x=1.5"), "finite"),
    (dict(quantity="void", kind="below", expected="1"), "finite"),
    (dict(quantity="1e308*y*y", kind="above", expected="1"), "finite"),
    (dict(quantity="sqrt(-y)"), "finite"),
    (dict(quantity="(-y)**0.5"), "finite"),
    (dict(quantity="y/(x-3)"), "finite"),
    (dict(quantity="__import__('os').getpid()"), "cannot read"),
    (dict(quantity="y.real"), "cannot read"),
    (dict(quantity=""), "cannot read"),
    (dict(at="x=0.5"), "not reached"),
    (dict(at="x=3.01"), "not reached"),
    (dict(at="void=1"), "not reached"),
    (dict(at="z=1"), "no column 'z'"),
    (dict(at="start"), "at is"),
    (dict(at="x=1.5 to 2.5"), "deviates"),
    (dict(at="x=1.5 to 3.5"), "not reached"),
    (dict(at="end to 2"), "no column 'end'"),
    (dict(expected="40*ring_pressure(0.5, 0.1)"), "deviates"),
    (dict(expected="ring_pressure()"), "missing"),
    (dict(expected="ring_pressure(0, 0.1, depth=1)"), "depth"),
    (dict(expected="ring_pressure(0, 0.1, **{})"), "cannot read"),
    (dict(expected="wrong()"), "cannot read"),
    (dict(quantity="ring_pressure(x, 0.1)"), "cannot read"),
    (dict(quantity="summary:checks.best"), "no 'best'"),
    (dict(quantity="summary:status"), "is no number"),
    (dict(quantity="summary:checks.worst", at="x=1.5"), "of the end"),
    (dict(options="fails"), "exit code 3, wanted 0"),
    (dict(exit_code="3"), "exit code 0, wanted 3"),
    (dict(exit_code=""), "a word for a number"),
    (dict(options="empty"), "no rows"),
    (dict(deck="absent"), "no deck"),
]

# Whole files that are wrong, and what must then be said.
FAKE_FILES = [
    ("", "columns missing"),
    (",".join(FAKE_ROW) + "\n", "no rows"),
    (",".join(key for key in FAKE_ROW if key != "at") + "\n", "missing or unknown: at"),
    (",".join(FAKE_ROW) + ",more\n", "unknown: more"),
    (",".join(FAKE_ROW) + "\nfake,,0\n", "fields wanted"),
    (",".join(FAKE_ROW) + "\n" + ",".join(FAKE_ROW.values()) + ",1\n", "fields wanted"),
    (",".join(FAKE_ROW) + "\n" + ",".join(dict(FAKE_ROW, long="no").values()) + "\n", "long is"),
    (",".join(FAKE_ROW) + "\n" + ",".join(dict(FAKE_ROW, options="sums").values()) + "\n", "miss [0, 1]"),
    (",".join(FAKE_ROW) + "\n" + ",".join(dict(FAKE_ROW, long="yes").values()) + "\n", "nothing to compare"),
]


def selftest():
    """What this script lets pass that it must not, and the other way round."""
    wrong = []
    with tempfile.TemporaryDirectory(prefix="lagamine-") as top:
        program = os.path.join(top, "lagamine")
        with open(program, "w") as file:
            file.write(FAKE_PROGRAM.format(python=sys.executable))
        os.chmod(program, 0o755)
        folder = os.path.join(top, "fake")
        os.mkdir(folder)
        open(os.path.join(folder, "fake.lag"), "w").close()

        def check(text):
            with open(os.path.join(folder, "reference.csv"), "w", newline="") as file:
                file.write(text)
            return check_decks(top, program, [], False, lambda line: None)

        text = io.StringIO()
        csv.writer(text).writerows([FAKE_ROW, *(dict(FAKE_ROW, **changes).values() for changes, _ in FAKE_CASES)])
        verdicts, faults = check(text.getvalue())
        wrong += faults
        if len(verdicts) != len(FAKE_CASES):
            wrong.append(f"{len(verdicts)} verdicts on {len(FAKE_CASES)} rows")
        for (changes, say), verdict in zip(FAKE_CASES, verdicts):
            if bool(say) != bool(verdict.why) or say not in verdict.why:
                wrong.append(f"{changes}: wanted '{say}', got '{verdict.why}'")
        for text, say in FAKE_FILES:
            _, faults = check(text)
            if not any(say in fault for fault in faults):
                wrong.append(f"{text!r}: wanted '{say}', got {faults}")
        os.unlink(os.path.join(folder, "reference.csv"))
        if not check_decks(top, program, [], False, print)[1] or not check_decks(top, program, ["none"], False, print)[1]:
            wrong.append("no references at all, or a folder that is not there, passes")
    wrong += closed_forms.wrong()
    for line in wrong:
        print("selftest:", line)
    print(f"selftest: {len(FAKE_CASES) + len(FAKE_FILES) + 1} cases and the closed forms, {len(wrong)} wrong")
    return not wrong


def main():
    parser = argparse.ArgumentParser(description="The decks against their references, decks/*/reference.csv.")
    parser.add_argument("names", metavar="NAME", nargs="*", help="only the folders decks/NAME")
    parser.add_argument("--all", action="store_true", help="also the rows marked long")
    parser.add_argument("--write", action="store_true", help="all rows, and the tables of decks/*/README.md anew")
    parser.add_argument("--selftest", action="store_true", help="only show that what is wrong fails")
    options = parser.parse_args()
    if not selftest():
        return 1
    if options.selftest:
        return 0
    program = os.path.join(BIN, "lagamine")
    if not os.access(program, os.X_OK):
        print(f"{program}: not there; build first, or set LAGAMINE_BIN", file=sys.stderr)
        return 2
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    decks = os.path.join(SOURCE, "decks")
    begin = time.monotonic()
    verdicts, faults = check_decks(decks, program, options.names, options.all or options.write,
                                   lambda line: print(line, flush=True))
    print_table(verdicts)
    if options.write:
        for name in sorted({verdict.folder for verdict in verdicts}):
            fault = write_readme(os.path.join(decks, name), [verdict for verdict in verdicts if verdict.folder == name])
            faults += [fault] if fault else []
    for fault in faults:
        print(fault)
    failed = sum(1 for verdict in verdicts if verdict.why) + len(faults)
    print(f"{len(verdicts) + len(faults) - failed} passed, {failed} failed in {time.monotonic() - begin:.1f} s")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
