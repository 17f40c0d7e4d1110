#!/usr/bin/env python3
"""Check the layout of Fortran files with fprettify, or apply it.

usage: layout.py --check|--apply FILE-or-FOLDER...
Settings: .fprettify.rc above each file. Two things are arranged here:
- fprettify does not know the bodies of `module procedure` and submodules of submodules, and would pull them to the left;
- it pushes long tables to the right margin, where they no longer read as tables: a continued line keeps the indentation
  its author gave it, as long as that is deeper than the statement's.
"""
import contextlib
import difflib
import io
import multiprocessing
import os
import re
import sys

import fprettify

CONTINUED = re.compile(r"&\s*(!.*)?$")
FLAGS = re.IGNORECASE
fprettify.SUBR_RE = re.compile(fprettify.SUBR_RE.pattern + r"|^\s*MODULE\s+PROCEDURE\s+\w+\s*;?\s*$", FLAGS)
fprettify.ENDSUBR_RE = re.compile(fprettify.ENDSUBR_RE.pattern + r"|^\s*END\s*PROCEDURE(\s+\w+)?\s*;?\s*$", FLAGS)
fprettify.SMOD_RE = re.compile(r"^\s*SUBMODULE\s*\(\s*\w+(\s*:\s*\w+)?\s*\)\s*\w+\s*;?\s*$", FLAGS)


def formatted(path):
    """The text of the file as it should be."""
    out = io.StringIO()
    with contextlib.redirect_stdout(out):
        fprettify.run(["fprettify", "--stdout", "--silent", path])
    return out.getvalue()


def keep_continuations(old, new):
    """`new` with the indentation that continued lines have in `old`."""
    before, after = old.splitlines(True), new.splitlines(True)
    if len(before) != len(after):
        return new
    start = None        # indentation of the statement that goes on
    for i, line in enumerate(after):
        text = line.lstrip()
        if not text or text.startswith("!"):
            continue
        if start is None:
            start = len(line) - len(text)
        else:
            indent = len(before[i]) - len(before[i].lstrip())
            if indent > start:
                after[i] = " " * indent + text
        if not CONTINUED.search(text):
            start = None
    return "".join(after)


def texts(path):
    """The text of the file, and the text as it should be."""
    with open(path, encoding="utf-8") as source:
        old = source.read()
    return old, keep_continuations(old, formatted(path))


def fortran_files(places):
    for place in places:
        if os.path.isfile(place):
            yield place
        for folder, folders, files in os.walk(place):
            folders.sort()
            yield from (os.path.join(folder, file) for file in sorted(files) if file.endswith(".f90"))


def main(arguments):
    if len(arguments) < 2 or arguments[0] not in ("--check", "--apply"):
        print(__doc__, file=sys.stderr)
        return 2
    files = [os.path.abspath(file) for file in fortran_files(arguments[1:])]
    changed = 0
    with multiprocessing.Pool() as pool:
        pairs = pool.map(texts, files, chunksize=8)
    for path, (old, new) in zip(files, pairs):
        if new == old:
            continue
        changed += 1
        name = os.path.relpath(path)
        if arguments[0] == "--apply":
            with open(path, "w", encoding="utf-8") as out:
                out.write(new)
            print(f"layout: {name}")
        else:
            sys.stdout.writelines(difflib.unified_diff(old.splitlines(True), new.splitlines(True), name, "as it should be", n=1))
    print(f"layout: {len(files)} files, {changed} {'changed' if arguments[0] == '--apply' else 'to change'}")
    return 1 if not files or changed and arguments[0] == "--check" else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
