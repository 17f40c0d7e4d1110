#!/usr/bin/env python3
"""The tutorial, decks/TUTORIAL.md, word by word: its files are written, its commands run, and what they print is held against the page.

usage: run_tutorial.py [--write]       --write puts what the commands print into the page
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
PAGE = os.path.join(SOURCE, "decks", "TUTORIAL.md")
BLOCK = re.compile(r"^```(\w+)(?: (\S+))?\n(.*?)^```$", re.M | re.S)
NUMBER = re.compile(r"(?<![\w.])[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?(?!\w)")
CLOSE = 1e-3        # numbers of a run on another processor


def same(found, wanted):
    """The same words, and numbers that are close."""
    a, b = ([float(word) for word in NUMBER.findall(text)] for text in (found, wanted))
    return NUMBER.sub("#", found) == NUMBER.sub("#", wanted) and all(abs(x - y) <= CLOSE*max(abs(x), abs(y)) for x, y in zip(a, b))


def main():
    with open(PAGE, encoding="utf-8") as file:
        text = file.read()
    folder = tempfile.mkdtemp(prefix="lagamine-tutorial-")
    python = os.path.join(folder, ".bin")
    os.mkdir(python)
    os.symlink(os.environ.get("LAGAMINE_PYTHON") or sys.executable, os.path.join(python, "python3"))
    env = dict(os.environ, PATH=os.pathsep.join((BIN, python, os.environ["PATH"])), OMP_NUM_THREADS="1")
    said, failed, ran, shown = "", 0, 0, 0
    pieces, last = [], 0
    try:
        for block in BLOCK.finditer(text):
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
                    print(f"FAILED: the page has\n{body}the commands print\n{said}")
                    failed += "--write" not in sys.argv
        force = re.search(r"^out: ([\d.]+) kN", said, re.M)
        if "--write" in sys.argv:
            with open(PAGE, "w", encoding="utf-8") as file:
                file.write("".join(pieces) + text[last:])
        elif f"**The force is {float(force.group(1)):.0f} kN**" not in text:
            print("FAILED: the text has another force than the output above it")
            failed += 1
        for made in ("press.svg", "press.html", "out/report.html", "compare.html"):
            if not os.path.isfile(os.path.join(folder, made)):
                print(f"FAILED: no {made}")
                failed += 1
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    print(f"{ran} commands, {shown} outputs, {failed} failed")
    return 1 if failed or ran < 4 or shown < 4 else 0


if __name__ == "__main__":
    sys.exit(main())
