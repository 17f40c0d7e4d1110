#!/usr/bin/env python3
"""The first steps of every shipped deck, by the programs as they are built: with all checks of compiler and sanitizers in .ci/run.

usage: run_first_steps_of_decks.py [NAME...] [-v] [-k]     NAME: part of the name of a deck

A deck is run as it is, but for its end: a few of its first steps. Those of several operations, or that go on from the results of another
deck, are left to other tests.
"""
import glob
import os
import re
import shutil
import subprocess
import sys

sys.dont_write_bytecode = True
from support import BIN, DONE, LONGEST_RUN, SOURCE, Checks, deck_text, said, write  # noqa: E402

LAST = 2.5  # first steps of the deck


def ends_early(text):
    """The deck with an end after some of its first steps, and without what it asks for at later times."""
    end = f"{LAST}*({re.search(r'^STRAT +([^ ]+)', text, re.MULTILINE)[1]})"
    text = re.sub(r"^(SAVE +TIMES|   TIMES) .*\n", "", text, flags=re.MULTILINE)
    if re.search("^STOP ", text, re.MULTILINE):
        return re.sub(r"^STOP +(\S+)", f"STOP   min(\\1,{end})", text, flags=re.MULTILINE)
    return re.sub(r"^END\b", f"STOP   {end}\nEND", text, flags=re.MULTILINE)


def main():
    checks = Checks()
    # decks name files beside them
    decks = shutil.copytree(os.path.join(SOURCE, "decks"), checks.path("decks"), ignore=shutil.ignore_patterns("*.png", "*.svg", "*.md"))
    wanted = [word for word in sys.argv[1:] if not word.startswith("-")]
    number = 0
    for path in sorted(glob.glob(os.path.join(decks, "**", "*.lag"), recursive=True)):
        name, text = os.path.basename(path)[:-len(".lag")], deck_text(path)
        if wanted and not any(word in name for word in wanted):
            continue
        if re.search(r"^(OPERA|ACCURACY)\b|\.h5\b", text, re.MULTILINE) or not re.search("^STRAT ", text, re.MULTILINE):
            continue
        program = "lagacycle" if re.search(r"^REMSH\b", text, re.MULTILINE) else "lagamine"
        result = subprocess.run([os.path.join(BIN, program), write(path, ends_early(text)), "--out", checks.path(name), "--quiet"],
                                text=True, capture_output=True, stdin=subprocess.DEVNULL, timeout=LONGEST_RUN, check=False)
        checks.that(result.returncode == DONE, f"{name}: first steps", said(result))
        number += 1
    checks.that(number > 0 if wanted else number > 55, "decks are found", number)
    checks.end()


if __name__ == "__main__":
    main()
