#!/usr/bin/env python3
"""An effect that is off: the bits of a deck that never named it, no dataset, no byte of state; heat alone keeps no mechanics.

usage: run_effects.py [-v] [-k]
"""
import os
import re
import sys

sys.dont_write_bytecode = True
from support import DONE, SOURCE, UPSETTING, Checks, add_cards, deck_text, history, run, said, summary, with_h5py, write  # noqa: E402

with_h5py()
import h5py  # noqa: E402

SHORT = ["-p", "nx=4", "-p", "ny=6", "-p", "travel=2"]
# Words in names of datasets and columns, by effect.
WORDS = {"displacement": ("displacement", "stress", "strain", "velocity"), "heat": ("temperature", "heat"), "phases": ("martensite", "austenite", "bainite"),
         "contact": ("pressure", "penetration", "contact_status"), "error estimates": ("error_stress", "error_strain")}
# What a checkpoint keeps of an effect. Heat of a body keeps no state at its points.
STATE = {"displacement": ("fields/displacement/", "groups/1/state"), "contact": ("fields/pilot/", "dies/"), "heat": ("fields/temperature/",),
         "plasticity": ("path/error",), "error estimates": ("estimate/",)}
# Cards that name an effect and leave it off, or load with nothing.
NOTHING = {
    "ESTIM, which only looks": "ESTIM",
    "REMSH with limits that are not reached": "REMSH\n   ANGLE 0. 179.9\n   MIDDLE 0.499\n   DISTRESS 1000",
    "a probe": "PROBE work MAX mises billet",
    "a solver that is the default": "SOLVR MIXED",
    "bounds that are the default": "NORMS PATH 0.04 RATE 0.008",
    "fields and checkpoints at every step": "CKPT 1",
    "one operation": None,
}


def sizes(path):
    """Bytes of every dataset of a file by its name, with the components it has."""
    found = {}

    def visit(name, thing):
        if isinstance(thing, h5py.Dataset):
            found[name] = thing.size*thing.dtype.itemsize

    with h5py.File(path, "r") as file:
        file.visititems(visit)
    return found


def state_bytes(kept, words):
    """Bytes of the datasets whose names begin so."""
    return sum(n for name, n in kept.items() if name.startswith(words))


def components(path):
    """Names of the state of all points."""
    names = set()
    with h5py.File(path, "r") as file:
        def visit(_name, thing):
            if isinstance(thing, h5py.Dataset) and _name.endswith("components"):
                names.update(word.decode() if isinstance(word, bytes) else str(word) for word in thing[()].ravel())
        file.visititems(visit)
    return names


def same_bits(checks):
    """The columns that both runs have are the same numbers."""
    plain = deck_text(UPSETTING)
    folder = checks.path("plain")
    deck = write(checks.path("plain.lag"), plain)
    result = run([deck, "--out", folder, "--quiet"] + SHORT)
    if not checks.that(result.returncode == DONE, "the deck runs", said(result)):
        return
    without = history(folder)
    for k, (what, cards) in enumerate(NOTHING.items()):
        if cards is None:
            text = re.sub(r"(?m)^LAW    steel", "OPERA press\nLAW    steel", plain)
        else:
            text = add_cards(plain, cards)
        folder = checks.path(f"with{k}")
        result = run([write(checks.path(f"with{k}.lag"), text), "--out", folder, "--quiet"] + SHORT)
        if not checks.that(result.returncode == DONE, f"{what}: the deck runs", said(result)):
            continue
        found = history(folder)
        differ = [name for name in without if found.get(name) != without[name]]
        checks.that(not differ, f"{what}: the same bits", differ)


def asleep(checks):
    """Heat that has nothing to do changes no bit of the motion."""
    plain = deck_text(UPSETTING)
    warm = add_cards(plain, "ADDEL  billet PL8TM metal\nLAW    metal HEAT\n   50. 3.6\nSTART  T 20.")
    columns = []
    for name, text in (("cold", plain), ("warm", warm)):
        result = run([write(checks.path(f"{name}.lag"), text), "--out", checks.path(name), "--quiet"] + SHORT)
        if not checks.that(result.returncode == DONE, f"{name}: the deck runs", said(result)):
            return
        columns.append(history(checks.path(name)))
    # iterations are those of all fields
    kept = sizes(checks.path("warm", "warm.ckp.h5"))
    checks.that(all(state_bytes(kept, STATE[effect]) > 0 for effect in ("displacement", "contact", "heat", "plasticity")),
                "warm: bytes of state of all that is on", kept)
    differ = [name for name in columns[0] if name != "iterations" and columns[0][name] != columns[1][name]]
    checks.that(not differ, "heat with no flow: the same bits of the motion", differ)


def nothing_is_kept(checks):
    """Files and checkpoint of decks with one effect: datasets and state of no other, and of heat alone no byte of mechanics."""
    for deck, on, options in (("thick_cylinder/thick_cylinder", ("displacement",), []), ("heat_wall/heat_wall", ("heat",), ["-p", "step=0.8"])):
        name = os.path.basename(deck)
        folder = checks.path(name)
        result = run([os.path.join(SOURCE, "decks", deck + ".lag"), "--out", folder, "--quiet"] + options)
        if not checks.that(result.returncode == DONE, f"{name}: the deck runs", said(result)):
            continue
        effects = summary(folder)["effects"]
        checks.that(all(row["calls"] == 0 and row["wall_s"] == 0 for row in effects.values() if not row["on"]),
                    f"{name}: what is off was never called", effects)
        files = [os.path.join(folder, f"{name}.g01.h5")] + [os.path.join(folder, f"{name}.g01", f) for f in os.listdir(os.path.join(folder, f"{name}.g01"))]
        off = [word for effect, words in WORDS.items() if effect not in on for word in words]
        for path in files:
            names = list(sizes(path)) + sorted(components(path))
            bad = [dataset for dataset in names if any(word in dataset for word in off)]
            checks.that(not bad, f"{name}: no dataset of what is off in {os.path.basename(path)}", bad)
        kept = sizes(os.path.join(folder, f"{name}.ckp.h5"))
        own, others = state_bytes(kept, STATE[on[0]]), [state_bytes(kept, words) for effect, words in STATE.items() if effect not in on]
        checks.that(own > 0 and not any(others), f"{name}: bytes of state of what is on, none of what is off", (own, others))
        nodes = len(h5py.File(files[0], "r")["mesh/coordinates"])
        print(f"{name}: {nodes} nodes, {summary(folder)['dofs']} equations, checkpoint {sum(kept.values())} bytes in {len(kept)} datasets")
        if on == ("heat",):
            checks.that(summary(folder)["dofs"] < nodes, "heat alone: at most one unknown a node")


def main():
    checks = Checks()
    same_bits(checks)
    asleep(checks)
    nothing_is_kept(checks)
    checks.end()


if __name__ == "__main__":
    main()
