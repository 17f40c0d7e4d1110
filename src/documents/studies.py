#!/usr/bin/env python3
"""Studies of the shipped decks: what accuracy costs in time, by `lagastudy`, into the READMEs of their folders.

usage: studies.py [--programs BIN] [--runs DIR] [--short] [NAME...]
NAME is a study (default: all). Runs that are in DIR/NAME are not made again (default DIR: out/studies in the project), so that it can be
interrupted. Tables stand in decks/FOLDER/README.md between two lines <!-- study -->, the picture is decks/FOLDER/study_NAME.svg.
--short makes the coarsest runs of each ladder only, in DIR, of all that take seconds, and writes nothing into decks: a test that they run.
"""
import argparse
import os
import re
import subprocess
import sys
from dataclasses import dataclass
from typing import List, Sequence, Tuple

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
MARK = "<!-- study -->"
HEADING = "## What accuracy costs in time"
SHORTEST = 2      # runs of a ladder with --short


@dataclass
class Study:
    """A deck, its ladders, from coarse to fine, and what is looked at."""

    deck: str
    ladders: Sequence[str]
    quantities: Sequence[str]
    parameters: Sequence[str] = ()
    exact: Sequence[str] = ()
    short: Sequence[str] = ()       # parameters that make a run of --short short
    changes: Sequence[Tuple[str, str]] = ()      # lines of the deck, by their beginnings, that are others
    seconds: bool = True            # short enough for --short without names

    @property
    def name(self) -> str:
        return os.path.basename(self.deck)


STUDIES: List[Study] = [
    Study("thick_cylinder/thick_cylinder_plastic", ["nx=5,10,20,40"], ["u_outer", "u_inner"]),
    Study("hertz/hertz", ["n=2,4,8"], ["force_y_ball", "peak_pressure"]),
    Study("finite_cylinder/finite_cylinder", ["n=2,4,8", "step=1.6,0.8,0.4,0.2"], ["centre", "corner"], parameters=["theta=0.5", "step=0.1", "n=6"],
          exact=["centre=468.586", "corner=178.841"], short=["step=1"]),
    Study("upsetting/upsetting", ["nx=6,12,24,48 ny=9,18,36,72"], ["force_y_upper", "external_work"], short=["travel=0.5"]),
    Study("necking/necking", ["nx=4,8,16 ny=12,24,48", "dt=0.02,0.01,0.005,0.0025,0.00125"], ["force", "neck"], parameters=["dt=0.01"], short=["pull=0.5"]),
    Study("quench_16mnd5/quench_16mnd5", ["nr=5,10,20 nz=3,6,12", "step=2,1,0.5,0.25"], ["side", "core"],
          parameters=["nr=10", "nz=6", "step=0.5", "finish=100"], short=["finish=4"]),
    Study("residual_stress/residual_stress", ["nr=8,16,32", "step=0.8,0.4,0.2,0.1"], ["side", "core_h"], parameters=["nr=16", "step=0.35"],
          short=["step=2"]),
        # sizes are to decide, not the number of elements
    Study("forging_rib/forging_rib_remesh", ["nx=8,11,16,23 ny=4,6,8,12 smallest=1.,0.7,0.5,0.35 largest=2.8,2.,1.4,1."], ["external_work", "rim"], seconds=False,
          changes=[("   COUNT", "   COUNT 6000")]),
    # the limits are those of REMSH alone
    Study("can/can", ["size=1.4,1,0.7,0.5"], ["force_y_punch", "external_work"], seconds=False, changes=[
        ("PARAM  travel", "PARAM  travel 6\nPARAM  size 1"),
        ("REMSH", "REMSH\n   ANGLE 15. 165.\n   MIDDLE 0.4\n   SCALED 0.2\n   ASPECT 10.\n   CONTACT 50.\n   DISTRESS 4\n   LEAST 5\n"
         "   SIZE 0.2*$size $size\n   COUNT 4000")]),
]


def deck_of(study: Study, runs: str) -> str:
    """The deck, or one beside the runs with other lines."""
    deck = os.path.join(ROOT, "decks", study.deck + ".lag")
    if not study.changes:
        return deck
    with open(deck, encoding="utf-8") as file:
        text = file.read()
    for old, new in study.changes:
        text, number = re.subn(rf"(?m)^{old}\b.*$", lambda _, new=new: new, text)
        if number != 1:
            sys.exit(f"studies.py: {study.name}: the deck has {number} lines '{old}'")
    with open(os.path.join(runs, study.name + ".lag"), "w", encoding="utf-8") as file:
        file.write(text)
    return file.name


def fixed(study: Study, short: bool) -> List[str]:
    """Parameters of all runs; those that a ladder changes count more there."""
    given = {word.partition("=")[0]: word for word in (*study.parameters, *(study.short if short else ()))}
    return list(given.values())


def shorten(ladder: str) -> str:
    """The coarsest runs of a ladder."""
    return " ".join(f"{name}={','.join(values.split(',')[:SHORTEST])}" for name, _, values in (word.partition("=") for word in ladder.split()))


def make(study: Study, programs: str, runs: str, short: bool) -> str:
    """Run lagastudy; the folder of its tables."""
    out = os.path.join(runs, study.name)
    words = [os.path.join(programs, "lagastudy"), deck_of(study, runs), "--out", out, "--quiet"]
    for ladder in study.ladders:
        words += ["--ladder", shorten(ladder) if short else ladder]
    for quantity in study.quantities:
        words += ["--quantity", quantity]
    for exact in study.exact if not short else ():
        words += ["--exact", exact]
    for parameter in fixed(study, short):
        words += ["-p", parameter]
    done = subprocess.run(words, check=False, env=dict(os.environ, LAGAMINE_BIN=programs))
    if done.returncode:
        sys.exit(f"studies.py: {study.name}: lagastudy ended with {done.returncode}")
    return out


def put(study: Study, out: str) -> None:
    """Tables and picture into the folder of the deck."""
    folder = os.path.join(ROOT, "decks", os.path.dirname(study.deck))
    with open(os.path.join(out, "study.md"), encoding="utf-8") as file:
        tables = re.sub(r"(?m)^#", "##", file.read().partition("\n")[2]).strip()
    picture = f"study_{study.name}.svg"
    with open(os.path.join(out, "work_precision.svg"), "rb") as source, open(os.path.join(folder, picture), "wb") as target:
        target.write(source.read())
    command = f"`python3 src/documents/studies.py {study.name}`"
    text = f"{MARK}\n{HEADING}\nMade by {command}; seconds are those of the processor, one thread.\n\n![Error over seconds]({picture})\n\n{tables}\n{MARK}\n"
    readme = os.path.join(folder, "README.md")
    with open(readme, encoding="utf-8") as file:
        old = file.read()
    if old.count(MARK) == 2:
        first, last = old.index(MARK), old.rindex(MARK) + len(MARK) + 1
        new = old[:first] + text + old[last:]
    else:
        new = old.rstrip("\n") + "\n\n" + text
    with open(readme, "w", encoding="utf-8") as file:
        file.write(new)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--programs", default=os.path.join(ROOT, "build", "bin"))
    parser.add_argument("--runs", default=os.path.join(ROOT, "out", "studies"))
    parser.add_argument("--short", action="store_true")
    parser.add_argument("names", nargs="*", metavar="NAME")
    options = parser.parse_args()
    unknown = set(options.names) - {study.name for study in STUDIES}
    if unknown:
        sys.exit(f"studies.py: no study {', '.join(sorted(unknown))}; there are: {', '.join(study.name for study in STUDIES)}")
    os.makedirs(options.runs, exist_ok=True)
    for study in STUDIES:
        if study.name not in options.names and (options.names or (options.short and not study.seconds)):
            continue
        out = make(study, os.path.abspath(options.programs), os.path.abspath(options.runs), options.short)
        if not options.short:
            put(study, out)
        print(f"{study.name}: {out}", flush=True)


if __name__ == "__main__":
    main()
