#!/usr/bin/env python3
"""What remdata and lagacycle do with a checkpoint that is not whole, not ours, or of another schema: refused by name.

usage: run_checkpoints.py [-v] [-k]       -v prints every check, -k keeps the results
"""
import os
import shutil
import subprocess
import sys

sys.dont_write_bytecode = True
from remeshed import cycle  # noqa: E402
from sealed import alter  # noqa: E402
from support import BIN, DONE, INPUT, UPSETTING, Checks, add_cards, deck_text, run, said, with_h5py, write  # noqa: E402

REMESH = 4


def call(program, *arguments):
    return subprocess.run([os.path.join(os.path.abspath(BIN), program), *arguments], text=True, stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=100, check=False)


def change(action):
    """Damage by h5py."""
    def damage(path):
        import h5py  # pylint: disable=import-outside-toplevel
        with h5py.File(path, "r+") as file:
            action(file)
    return damage


def cut(share):
    def damage(path):
        os.truncate(path, int(share * os.path.getsize(path)))
    return damage


def text(path):
    with open(path, "w", encoding="utf-8") as file:
        file.write("rubbish\n")


def other_schema(file):
    file.attrs["schema_version"] = file.attrs["schema_version"] + 1


def not_a_number(file):
    file["fields/displacement/value"][0, 0] = float("nan")


def other_number(file):
    file["mesh/coordinates"][0, 0] += 1e-9


def sealed_not_a_number(checks, deck, out):
    """A number that is none in a checkpoint whose hash is right: refused by its place; the cycle goes on from the one before."""
    folder, new = checks.path("sealed"), checks.path("new.h5")
    shutil.copytree(out, folder)
    bad = os.path.join(folder, "case.ckp.h5")
    alter(bad, not_a_number)
    phrase = "dataset 'fields/displacement/value' holds a number that is not finite"
    for result in (call("remdata", bad, "--out", new), run([deck, "--out", checks.path("no"), "--resume", bad, "--threads", "1"])):
        checks.that(result.returncode == INPUT and bad in result.stderr and phrase in result.stderr, "sealed: refused by name",
                    said(result))
    checks.that(not os.path.exists(new), "sealed: nothing is written")
    result = cycle(deck, folder)
    checks.that(result.returncode == DONE and phrase in result.stdout and "going on from the one before" in result.stdout,
                "sealed: the cycle goes on from the one before", said(result))


def main():
    with_h5py()
    checks = Checks()
    deck = write(checks.path("case.lag"), add_cards(deck_text(UPSETTING), "CKPT 2\nREMSH\n   TIMES 0.1")
                 .replace("nx 12", "nx 3").replace("ny 18", "ny 4").replace("travel 9", "travel 2"))
    out = checks.path("out")
    result = run([deck, "--out", out, "--threads", "1"])
    checks.that(result.returncode == REMESH, "stops for a new mesh", said(result))
    good, bad, new = os.path.join(out, "case.ckp.h5"), checks.path("bad.ckp.h5"), checks.path("new.h5")
    result = call("remdata", "--about", good)
    facts = dict(line.split(" ", 1) for line in result.stdout.splitlines())
    checks.that(result.returncode == DONE and facts["generation"] == "1" and facts["elements"] == "12"
                and facts["due"].startswith("time 0.1"), "--about states what is in it", facts)
    for option, value, wanted in (("--transfer", "1,2", "the number of a method"), ("--transfer", "-1", "the number of a method"),
                                  ("--finer", "1/2", "a number above 0"), ("--finer", "1,5", "a number above 0"), ("--finer", "0", "a number above 0"),
                                  ("--limit", "5 s", "seconds above 0"), ("--mesher", "hand", "zones, free or gmsh")):
        result = call("remdata", good, "--out", new, option, value)
        checks.that(result.returncode == INPUT and result.stderr.startswith(f"{option}: expected {wanted}") and f"'{value}'" in result.stderr
                    and not os.path.exists(new), f"remdata {option} {value}: refused", said(result))
    damages = {"a text": (text, "not a file of this program"), "cut to nothing": (cut(0), "not a file of this program"), "cut to 10 %": (cut(0.1), "cut short"),
               "cut to 97 %": (cut(0.97), "cut short"), "another schema": (lambda path: alter(path, other_schema), "schema"),
               "no schema": (lambda path: alter(path, lambda file: file.attrs.__delitem__("schema")), "not a checkpoint"),
               "a number that is none": (change(not_a_number), "hash"), "a number altered": (change(other_number), "hash"),
               "a dataset gone": (change(lambda file: file.__delitem__("groups/1/state")), "hash"),
               "no such file": (os.remove, "no such file")}
    for what, (damage, phrase) in damages.items():
        shutil.copy(good, bad)
        damage(bad)
        for arguments in (("--about", bad), (bad, "--out", new)):
            result = call("remdata", *arguments)
            lines = result.stderr.splitlines()
            checks.that(result.returncode == INPUT and lines and bad in lines[0] and phrase in lines[0] and len(lines) <= 2,
                        f"{what}: remdata {arguments[0]} refuses it by name", said(result))
        checks.that(not os.path.exists(new), f"{what}: nothing is written")
        # the cycle goes on from the one before; without one it stops
        folder = checks.path("folder")
        shutil.rmtree(folder, ignore_errors=True)
        shutil.copytree(out, folder)
        place = os.path.join(folder, "case.ckp.h5")
        damage(place)
        result = call("lagacycle", deck, "--out", folder, "--threads", "1")
        checks.that(result.returncode == DONE and ("one before" in result.stdout or what == "no such file"),
                    f"{what}: lagacycle goes on from the one before", said(result))
        shutil.rmtree(folder)
        shutil.copytree(out, folder)
        damage(place)
        os.remove(os.path.join(folder, "case.ckp.1.h5"))
        if what != "no such file":      # nothing there is a beginning
            result = call("lagacycle", deck, "--out", folder, "--threads", "1")
            checks.that(result.returncode == INPUT and place in result.stderr and "--fresh" in result.stderr,
                        f"{what}: without one before, refused by name", said(result))
    sealed_not_a_number(checks, deck, out)
    checks.end()


if __name__ == "__main__":
    main()
