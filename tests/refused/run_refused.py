#!/usr/bin/env python3
"""Decks that must be refused: each case of cases.txt damages base.lag, each of steel_cases.txt steel.met, and says where the error
must be and what it must say.

usage: run_refused.py [-v] [--cards]        -v prints what the program said for each case, --cards how many errors are looked for on each card
LAGAMINE_BIN is the folder of `lagamine` (default: build/bin of this project). Works in a folder of its own.

cases.txt, blanks count, `|` ends the first word:
    case|name of the case
    old|a line of the deck                 (cut, and replaced by the `new` lines that follow it)
    new|a line
    end|a line put before END
    say|a line of the damaged deck|phrase|field
`say` wants an error at this line which has the phrase; with a field, at the column of that field. An empty line stands for
the deck as a whole. Exactly as many errors as `say` lines must come, unless the case has a line `more|`. A case
without `say` must be accepted.
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
BIN = os.environ.get("LAGAMINE_BIN") or os.path.join(HERE, "..", "..", "build", "bin")
REFUSED = 2


def read_cases(path):
    """Cases in order: name, edits (cut line or None, new lines), expectations (line, phrase, field), whether more may come."""
    cases = []
    for number, raw in enumerate(open(path), 1):
        line = raw.rstrip("\n")
        if not line.strip() or line.startswith("#"):
            continue
        word, _, rest = line.partition("|")
        if word == "case":
            cases.append({"name": rest, "edits": [], "says": [], "more": False})
        elif word == "old":
            cases[-1]["edits"].append([rest, []])
        elif word == "new":
            cases[-1]["edits"][-1][1].append(rest)
        elif word == "end":
            cases[-1]["edits"].append([None, [rest]])
        elif word == "say":
            cases[-1]["says"].append((rest.split("|") + ["", ""])[:3])
        elif word == "more":
            cases[-1]["more"] = True
        else:
            sys.exit(f"{path}:{number}: unknown word '{word}'")
    return cases


def damage(base, edits):
    """Lines of the base deck with the edits made; each old line must be there once."""
    lines = list(base)
    for old, new in edits:
        if old is None:
            at = lines.index("END")
            lines[at:at] = new
            continue
        if lines.count(old) != 1:
            raise ValueError(f"the deck has {lines.count(old)} lines '{old}'")
        at = lines.index(old)
        lines[at:at + 1] = new
    return lines


def place(lines, text, field):
    """`deck.lag:line:column:` of the field on the line."""
    if text == "":
        return "deck.lag: "
    if lines.count(text) != 1:
        raise ValueError(f"the damaged deck has {lines.count(text)} lines '{text}'")
    where = f"deck.lag:{lines.index(text) + 1}:"
    if field:
        found = re.search(r"(?<!\S)" + re.escape(field) + r"(?!\S)", text)
        if not found:
            raise ValueError(f"no field '{field}' in '{text}'")
        where += f"{found.start() + 1}:"
    return where


def judge(case, base, options, folder, verbose):
    """What is wrong with the answer, or None."""
    lines = damage(base, case["edits"])
    with open(os.path.join(folder, "deck.lag"), "w") as deck:
        deck.write("\n".join(lines) + "\n")
    run = subprocess.run([os.path.join(BIN, "lagamine"), *options, "deck.lag", "--check"], cwd=folder, text=True, timeout=60,
                         stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    if verbose:
        print(f"--- {case['name']}\n{run.stdout}", end="")
    if not case["says"]:
        return None if run.returncode == 0 else f"exit code {run.returncode}, wanted 0:\n{run.stdout}"
    if run.returncode != REFUSED:
        return f"exit code {run.returncode}, wanted {REFUSED}:\n{run.stdout}"
    reported = [line for line in run.stdout.splitlines() if line.startswith("deck.lag:")]
    for text, phrase, field in case["says"]:
        where = place(lines, text, field)
        if not any(line.startswith(where) and phrase in line for line in reported):
            return f"wanted '{where}' with '{phrase}', got:\n{run.stdout}"
    if len(reported) != len(case["says"]) and not case["more"]:
        return f"wanted {len(case['says'])} errors, got {len(reported)}:\n{run.stdout}"
    return None


def all_cases():
    """Each case with the lines it damages and the options by which lagamine reads them."""
    for base, cases, options in (("base.lag", "cases.txt", []), ("steel.met", "steel_cases.txt", ["--met"])):
        lines = open(os.path.join(HERE, base)).read().splitlines()
        for case in read_cases(os.path.join(HERE, cases)):
            yield case, lines, options


def by_card():
    """Errors that are looked for in decks, by the card of their line."""
    cards = {}
    base = open(os.path.join(HERE, "base.lag")).read().splitlines()
    for case in read_cases(os.path.join(HERE, "cases.txt")):
        lines = damage(base, case["edits"])
        for text, _, _ in case["says"]:
            at = lines.index(text) if text else -1
            while at > 0 and lines[at].startswith(" "):
                at -= 1
            card = lines[at].split()[0] if at >= 0 else "(deck)"
            # cards of laws by their type
            card += " " + lines[at].split()[2] if card == "LAW" and len(lines[at].split()) > 2 else ""
            cards[card] = cards.get(card, 0) + 1
    return dict(sorted(cards.items()))


def main():
    verbose = "-v" in sys.argv[1:]
    passed = failed = 0
    with tempfile.TemporaryDirectory() as folder:
        for steel in ("steel.met", "whole.met", "isig.met"):
            shutil.copy(os.path.join(HERE, steel), folder)
        for case, base, options in all_cases():
            try:
                wrong = judge(case, base, options, folder, verbose)
            except ValueError as error:
                wrong = str(error)
            passed += wrong is None
            failed += wrong is not None
            if wrong is not None:
                print(f"FAILED {case['name']}: {wrong}")
    if "--cards" in sys.argv[1:]:
        print("\n".join(f"{count:5d} {card}" for card, count in by_card().items()))
    print(f"{passed} passed, {failed} failed")
    return 1 if failed or not passed else 0


if __name__ == "__main__":
    sys.exit(main())
