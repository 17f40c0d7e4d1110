#!/usr/bin/env python3
"""What the program says without a run (--check, --law, --help, --version), and that an effect which is off costs nothing.

usage: run_check.py [-v] [-k]       -v prints every check, -k keeps the results
"""
import glob
import os
import re
import sys

sys.dont_write_bytecode = True
from support import DONE, LAGAMINE, SOURCE, UPSETTING, Checks, mesh, run, said, summary, write  # noqa: E402

EFFECTS = ("displacement", "large strain", "plasticity", "contact", "friction", "pressure", "body force", "heat", "phases",
           "temperature", "error estimates", "remeshing", "load factor")
OPTIONS = ("--out", "--check", "--resume", "-p", "--threads", "--progress", "--quiet", "--law", "--point", "--help", "--version")

# One effect each, and nothing else.
LEAN = """TITLE  Two elastic elements
STATE  PLSTN
KINEM  SMALL
BLOCK  bar PL8LS 4 steel
   0. 0.   2. 0.   2. 1.   0. 1.
   2 1.   1 1.
LAW    steel ELA
   1000. 0.3
FIXED  bar 4 XY
MOVE   bar 2 X pull
LIC    pull
   0. 0.   1. 0.01
STRAT  0.5 0.1 0.5   5 3
END
"""


def effects_reported(text):
    """Effects of --check: name -> on or off."""
    return {name: state for name, state in re.findall(r"(?m)^effect +(\S.*?) +(on|off) ", text)}


def check_decks(checks):
    """Every deck of the project is accepted, shows its effects and unknowns, and leaves nothing."""
    decks = sorted(glob.glob(os.path.join(SOURCE, "decks", "*", "*.lag")))
    checks.that(len(decks) > 0, "there are decks")
    empty = checks.path("empty")
    os.makedirs(empty)
    for deck in decks:
        name = os.path.relpath(deck, SOURCE)
        result = run([deck, "--check"], cwd=empty)
        checks.that(result.returncode == DONE and result.stderr == "", f"{name}: accepted", said(result))
        reported = effects_reported(result.stdout)
        checks.that(tuple(reported) == EFFECTS, f"{name}: every effect is reported, on or off", list(reported))
        whys = re.findall(r"(?m)^effect +\S.*? +on +(.*)$", result.stdout)
        checks.that(whys and all(re.search(r" at \S+:\d+", why) for why in whys), f"{name}: the card that wants an effect is reported", whys[:2])
        checks.that(os.listdir(empty) == [], f"{name}: runs nothing", os.listdir(empty))
        with open(deck, encoding="utf-8") as file:
            text = file.read()
        for included in re.findall(r"(?m)^INCLU +(\S+)", text):
            with open(os.path.join(os.path.dirname(deck), included), encoding="utf-8") as file:
                text += file.read()
        meshed = not re.search(r"(?m)^BODY ", text)
        if not meshed:  # the remesher makes the first mesh: nothing to count yet
            checks.that(not re.search(r"Unknowns:|(?m:^Expected:)", result.stdout), f"{name}: no count without a mesh", result.stdout[-300:])
            continue
        unknowns = re.search(r"Unknowns: (\d+), of them (\d+) free; matrix (un)?symmetric, (\d+) nonzeros", result.stdout)
        checks.that(unknowns and int(unknowns.group(2)) <= int(unknowns.group(1)), f"{name}: unknowns", result.stdout[-300:])
        checks.that(re.search(r"(?m)^Expected: .* s per iteration", result.stdout) and "memory" in result.stdout, f"{name}: cost", result.stdout[-300:])


def places_of_probes(checks):
    """Where a probe reads is told, and how far that is from where it was to."""
    deck = write(checks.path("places.lag"), LEAN.replace("END\n", "PROBE on NODE UX 1. 0.\nPROBE beside NODE UX 1.2 0.\nPROBE inside POINT stress_xx 1.5 0.5\nEND\n"))
    text = run([deck, "--check"]).stdout
    found = dict(re.findall(r"(?m)^probe +(\S+) +\[\S+\] (.*)$", text))
    checks.that(found.get("on") == "node at 1 0", "a probe of a node: its place", found)
    checks.that(found.get("beside") == "node at 1 0, 0.2 from the place asked for", "a probe beside a node: how far", found)
    at = re.match(r"point at (\S+) (\S+), 0.408 from", found.get("inside", ""))
    checks.that(at and abs(abs(float(at.group(1)) - 1.5) - 0.288675) < 1e-5, "a probe of the stress: its integration point", found)


def laws(checks):
    """Every law of the manual has a card that names its parameters."""
    with open(os.path.join(SOURCE, "decks", "README.md"), encoding="utf-8") as manual:
        names = re.findall(r"(?m)^\| `([\w-]+)` \| (?:solids|contact) \|", manual.read())
    checks.that(len(names) >= 4, "the manual lists laws", names)
    for name in names:
        result = run(["--law", name])
        checks.that(result.returncode == DONE and result.stderr == "", f"--law {name}: done", said(result))
        checks.that(name in (result.stdout.splitlines() or [""])[0], f"--law {name}: its name first", result.stdout[:100])
        checks.that(len(result.stdout.splitlines()) >= 4, f"--law {name}: a card", result.stdout)
        lower = run(["--law", name.lower()])
        checks.that(lower.returncode == 2 and name in lower.stderr, f"--law {name.lower()}: refused, with the name meant", said(lower))


def list_of_laws(checks):
    """--law alone: every law of the manual in a line with its number and what its card says it is."""
    result = run(["--law"])
    checks.that(result.returncode == DONE and result.stderr == "", "--law: done", said(result))
    with open(os.path.join(SOURCE, "decks", "README.md"), encoding="utf-8") as manual:
        names = re.findall(r"(?m)^\| `([\w-]+)` \| (solids|contact|heat) \|", manual.read())
    rows = [line.split(None, 3) for line in result.stdout.splitlines()]
    checks.that(sorted((row[0], row[2]) for row in rows) == sorted(names), "--law: the laws of the manual, no more", result.stdout)
    for row in rows:
        title = run(["--law", row[0]]).stdout.splitlines()[0]
        checks.that(title == f"{row[0]} ({row[1]}): {row[3].partition(') ')[2].strip()}", f"--law: {row[0]} as on its card", (row, title))


def help_and_version(checks):
    """--help names every option and exit code; --version is the project's."""
    text = run(["--help"])
    checks.that(text.returncode == DONE and text.stderr == "", "--help: done", said(text))
    missing = [option for option in OPTIONS if option not in text.stdout]
    checks.that(not missing, "--help: every option", missing)
    missing = [code for code in ("0 done", "2 ", "3 ", "4 ", "5 ", "6 ", "128+n") if code not in text.stdout]
    checks.that(not missing, "--help: every exit code", missing)
    checks.that(max(map(len, text.stdout.splitlines())) <= 110, "--help: fits a terminal")
    with open(os.path.join(SOURCE, "CMakeLists.txt"), encoding="utf-8") as file:
        version = re.search(r"VERSION (\d+\.\d+\.\d+)", file.read()).group(1)
    result = run(["--version"])
    checks.that(result.returncode == DONE and result.stdout.startswith(f"lagamine {version}\n"), "--version: that of CMakeLists.txt",
                said(result))
    checks.that(os.path.exists(LAGAMINE), "the program is where LAGAMINE_BIN says")


def off_is_off(checks):
    """summary.json: an effect that is off was never called; --check and the run agree on what is on."""
    cases = {"lean": (write(checks.path("lean.lag"), LEAN), [], {"displacement"}),
             "upsetting": (UPSETTING, mesh(3, 4) + ["-p", "travel=1"], {"displacement", "large strain", "plasticity", "contact", "friction"})}
    for name, (deck, options, on) in cases.items():
        reported = effects_reported(run([deck, "--check"] + options).stdout)
        result = run([deck, "--out", checks.path(name), "--quiet", "--threads", "1"] + options)
        if not checks.that(result.returncode == DONE, f"{name}: done", said(result)):
            continue
        effects = summary(checks.path(name))["effects"]
        checks.that({effect for effect, row in effects.items() if row["on"]} == on, f"{name}: on are {', '.join(sorted(on))}",
                    [effect for effect, row in effects.items() if row["on"]])
        checks.that({effect: row["on"] for effect, row in effects.items()} == {effect: state == "on" for effect, state in reported.items()},
                    f"{name}: --check said the same", reported)
        for effect, row in effects.items():
            if not row["on"]:
                checks.that(row["calls"] == 0 and row["wall_s"] == 0 and row["adds"] == "nothing" and row["why"],
                            f"{name}: {effect} is off and costs nothing", row)
        checks.that(effects["displacement"]["calls"] > 0, f"{name}: displacement was called")


def main():
    checks = Checks()
    check_decks(checks)
    places_of_probes(checks)
    laws(checks)
    list_of_laws(checks)
    help_and_version(checks)
    off_is_off(checks)
    checks.end()


if __name__ == "__main__":
    main()
