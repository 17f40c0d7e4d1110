#!/usr/bin/env python3
"""The examples of the deck manual, decks/README.md, are read by `lagamine --check`.

usage: run_manual.py [-v]
A block fenced with ```lag is a whole deck when it has an END card. Otherwise it is put into the manual's skeleton, the block
fenced with ```lag skeleton, in place of its line `! your cards here`; a card of the example that may be given only once takes
the place of the skeleton's. A block fenced with ```lag file NAME is a file for the examples after it; one fenced with ```lag point
is a whole deck for `lagamine --point`.
A card with a heading (### `KEYWORD`) must be used in the first example after it.
LAGAMINE_BIN is the folder of `lagamine` (default: build/bin of this project).
"""
import os
import re
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.join(HERE, "..", "..")
BIN = os.environ.get("LAGAMINE_BIN") or os.path.join(ROOT, "build", "bin")
MARK = "! your cards here"
ONCE = {"TITLE", "STATE", "KINEM", "STRAT", "NORMS", "SOLVR", "STOP", "CKPT"}


def read_examples(path):
    """Examples in order: line in the manual, heading above, kind (the words after ```), lines."""
    examples = []
    heading = ""
    inside = None
    for number, raw in enumerate(open(path), 1):
        line = raw.rstrip("\n")
        if inside is None and line.startswith("#"):
            heading = line.strip("# `")
        elif inside is None and line.startswith("```"):
            inside = {"at": number, "heading": heading, "kind": line[3:].split(), "lines": []}
        elif inside is not None and line.startswith("```"):
            examples.append(inside)
            inside = None
        elif inside is not None:
            inside["lines"].append(line)
    return [example for example in examples if example["kind"][:1] == ["lag"]]


def keywords(lines):
    return [line.split()[0] for line in lines if line[:1] not in ("", " ", "!")]


def whole_deck(example, skeleton):
    """The lines of a deck with the example in it."""
    if "END" in keywords(example["lines"]):
        return example["lines"]
    replaced = ONCE.intersection(keywords(example["lines"]))
    deck = []
    dropping = False
    for line in skeleton:
        if line[:1] not in ("", " "):
            dropping = line.split()[0] in replaced
        if line.startswith(MARK):
            deck += example["lines"]
        elif not dropping:
            deck.append(line)
    return deck


def main():
    manual = os.path.join(ROOT, "decks", "README.md")
    examples = read_examples(manual)
    skeletons = [example["lines"] for example in examples if example["kind"] == ["lag", "skeleton"]]
    if len(skeletons) != 1:
        sys.exit(f"{manual}: {len(skeletons)} skeletons, wanted one")
    passed = failed = 0
    with tempfile.TemporaryDirectory() as folder:
        for example in examples:
            if example["kind"][1:2] == ["file"]:
                with open(os.path.join(folder, example["kind"][2]), "w") as file:
                    file.write("\n".join(example["lines"]) + "\n")
                continue
            deck = whole_deck(example, skeletons[0])
            with open(os.path.join(folder, "deck.lag"), "w") as file:
                file.write("\n".join(deck) + "\n")
            point = ["--point"] if example["kind"][1:2] == ["point"] else []
            run = subprocess.run([os.path.join(BIN, "lagamine"), "deck.lag", "--check"] + point, cwd=folder, text=True, timeout=60,
                                 stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
            passed += run.returncode == 0
            failed += run.returncode != 0
            if run.returncode != 0:
                print(f"FAILED decks/README.md:{example['at']} ({example['heading']}): exit code {run.returncode}\n{run.stdout}")
                print("\n".join(f"{number:4} {line}" for number, line in enumerate(deck, 1)))
            elif "-v" in sys.argv[1:]:
                print(f"--- decks/README.md:{example['at']} ({example['heading']})\n{run.stdout}", end="")
    for number, line in enumerate(open(manual), 1):
        heading = re.match(r"### `([A-Z0-9]+)`", line)
        if not heading:
            continue
        after = [example for example in examples if example["at"] > number and example["kind"][1:2] != ["file"]][:1]
        good = bool(after) and heading.group(1) in keywords(after[0]["lines"])
        passed += good
        failed += not good
        if not good:
            print(f"FAILED decks/README.md:{number}: the example after this heading has no {heading.group(1)} card")
    print(f"{passed} passed, {failed} failed")
    return 1 if failed or not passed else 0


if __name__ == "__main__":
    sys.exit(main())
