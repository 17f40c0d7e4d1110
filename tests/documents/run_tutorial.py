#!/usr/bin/env python3
"""The tutorial, decks/TUTORIAL.md, word by word, and the recipes that show numbers, decks/RECIPES.md: their files are written, their commands run,
and what they print is held against the pages.

usage: run_tutorial.py [--write]       --write puts what the commands print into the pages
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
SOURCE = os.path.abspath(os.environ.get("LAGAMINE_SOURCE") or os.path.dirname(os.path.dirname(HERE)))
BIN = os.path.abspath(os.environ.get("LAGAMINE_BIN") or os.path.join(SOURCE, "build", "bin"))
TUTORIAL, RECIPES = (os.path.join(SOURCE, "decks", name) for name in ("TUTORIAL.md", "RECIPES.md"))
BLOCK = re.compile(r"^```(\w+)(?: (\S+))?\n(.*?)^```$", re.M | re.S)
NUMBER = re.compile(r"(?<![\w.])[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?(?!\w)")
CLOSE = 1e-3        # numbers of a run on another processor


def same(found, wanted):
    """The same words, and numbers that are close."""
    a, b = ([float(word) for word in NUMBER.findall(text)] for text in (found, wanted))
    return NUMBER.sub("#", found) == NUMBER.sub("#", wanted) and all(abs(x - y) <= CLOSE*max(abs(x), abs(y)) for x, y in zip(a, b))


def blocks_of(path, text):
    """Blocks of a page; of recipes the scripts, and the commands whose output is shown."""
    found = list(BLOCK.finditer(text))
    if path == TUTORIAL:
        return found
    shown = [k for k, block in enumerate(found) if block.group(1) == "text"]
    return [block for k, block in enumerate(found) if block.group(2) or k in shown or k + 1 in shown]


def run_page(path, folder, env, write):
    """Files written, commands run, outputs compared; how many, how many failed, and what the last command printed."""
    with open(path, encoding="utf-8") as file:
        text = file.read()
    said, failed, ran, shown = "", 0, 0, 0
    pieces, last = [], 0
    for block in blocks_of(path, text):
        kind, name, body = block.groups()
        if name:
            with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
                file.write(body)
        elif kind == "sh":
            done = subprocess.run(["bash", "-e", "-o", "pipefail", "-c", body], cwd=folder, env=env, text=True, capture_output=True, check=False)
            said, ran = done.stdout, ran + 1
            if done.returncode != 0:
                print(f"FAILED: {body.strip()}: ended with {done.returncode}: {done.stderr}")
                failed += 1
        elif kind == "text":
            shown += 1
            pieces += [text[last:block.start(3)], said]
            last = block.end(3)
            if not same(said, body):
                print(f"FAILED: {path} has\n{body}the commands print\n{said}")
                failed += not write
    if write:
        with open(path, "w", encoding="utf-8") as file:
            file.write("".join(pieces) + text[last:])
    print(f"{os.path.basename(path)}: {ran} commands, {shown} outputs, {failed} failed")
    return said, text, failed + (ran < 4 or shown < 4)


def main():
    write = "--write" in sys.argv
    folder = tempfile.mkdtemp(prefix="lagamine-tutorial-")
    python = os.path.join(folder, ".bin")
    os.mkdir(python)
    os.symlink(os.environ.get("LAGAMINE_PYTHON") or sys.executable, os.path.join(python, "python3"))
    env = dict(os.environ, PATH=os.pathsep.join((BIN, python, os.environ["PATH"])), OMP_NUM_THREADS="1")
    try:
        said, text, failed = run_page(TUTORIAL, folder, env, write)
        force = re.search(r"^out: ([\d.]+) kN", said, re.M)
        if not write and f"**The force is {float(force.group(1)):.0f} kN**" not in text:
            print("FAILED: the text has another force than the output above it")
            failed += 1
        for made in ("press.svg", "press.html", "out/report.html", "compare.html"):
            if not os.path.isfile(os.path.join(folder, made)):
                print(f"FAILED: no {made}")
                failed += 1
        os.symlink(os.path.join(SOURCE, "decks"), os.path.join(folder, "decks"))
        failed += run_page(RECIPES, folder, env, write)[2]
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
