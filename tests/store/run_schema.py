#!/usr/bin/env python3
"""`remdata --schema` is the page of what checkpoints hold: every entry of real files stands in it, as it is, and none is missing.

usage: run_schema.py [-v] [-k]

Checkpoints of a billet with contact and error estimates, of a wall that heat passes, and of a rib that REMDATA meshed: names, types,
first extents, units and what a remesh does with each, against the lines of `--schema`; and each line that has no condition on
what a deck says is met in one of the files. `remdata --about` prints counts that are those of the file.
"""
import os
import re
import subprocess
import sys

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(os.path.dirname(HERE), "runs"))
from support import BIN, DONE, SOURCE, Checks, with_h5py  # noqa: E402

# A line of the page; what a group is that owns elements.
BODY = 1
LINE = re.compile(r"^(?P<path>\S+)\s+(?P<type>long text|text|integer|real)\s+(?P<extents>\([^)]*\))?\s*(?:\[(?P<unit>[^\]]*)\])?\s*"
                  r"(?P<carried>kept|recomputed|of the mesh|not carried|nodal|by variable)")
# What the head of the page states.
HEAD = ("schema", "schema_version")
DECKS = {"upsetting": ("upsetting", ["-p", "nx=3", "-p", "ny=4", "-p", "travel=1"]), "heat_wall": ("heat_wall", []),
         "forging_rib": ("forging_rib", ["-p", "travel=0.5"])}


def call(*command):
    """Standard output of a program that must end with 0."""
    result = subprocess.run(command, capture_output=True, text=True, timeout=300, check=False)
    return result.returncode, result.stdout + result.stderr


def read_schema(checks):
    """Pattern of a path -> what its line says."""
    code, said = call(os.path.join(BIN, "remdata"), "--schema")
    checks.that(code == DONE, "remdata --schema ends with 0", said)
    lines = [line for line in said.splitlines()[4:] if line and not line.startswith("#")]
    found = {}
    for line in lines:
        match = LINE.match(line)
        if checks.that(match is not None, f"schema has the columns its head names: {line.strip()}"):
            found[re.compile(re.sub(r"<[^>]*>", "[^/]+", match["path"]))] = match
    checks.that(len(found) > 150, "schema has its lines", len(found))
    return found


def entries(file):
    """Paths and values of all attributes and datasets of a file; attributes that describe a dataset are left out."""
    import h5py
    found = dict()

    def take(name, item):
        if isinstance(item, h5py.Dataset):
            found[name] = item
        else:
            found.update({f"{name}/{key}".lstrip("/"): value for key, value in item.attrs.items()})
    take("", file)
    file.visititems(take)
    return found


def type_of(value):
    """Word of the schema for what is stored."""
    kind = getattr(value, "dtype", None)
    if kind is None or kind.kind in "OSU":
        return "text"
    return "integer" if kind.kind in "iu" else "real"


def check_entry(checks, name, value, line):
    """A datum against its line."""
    checks.that(type_of(value) == line["type"].split()[-1], f"{name} is {line['type']}", type_of(value))
    extents = [part.strip() for part in (line["extents"] or "()").strip("()").split(",") if part.strip()]
    shape = list(getattr(value, "shape", ()))[::-1]
    if line["type"] != "long text":
        checks.that(len(shape) == len(extents) and all(not said.isdigit() or int(said) == n for said, n in zip(extents, shape)),
                    f"{name} has the extents {line['extents']}", shape)
    attributes = getattr(value, "attrs", {})
    unit = attributes.get("unit")
    if unit is not None and "its " not in (line["unit"] or "its "):
        unit = unit.decode() if isinstance(unit, bytes) else unit
        checks.that(unit == line["unit"], f"{name} has the unit {line['unit']}", unit)


def main():
    with_h5py()
    import h5py
    checks = Checks()
    schema = read_schema(checks)
    met = set()
    for folder, (deck, words) in DECKS.items():
        out = checks.path(folder)
        code, said = call(os.path.join(BIN, "lagamine"), os.path.join(SOURCE, "decks", folder, deck + ".lag"), "--out", out,
                          "--threads", "1", "--quiet", *words)
        if not checks.that(code == DONE, f"{deck} runs", said):
            continue
        checkpoint = os.path.join(out, deck + ".ckp.h5")
        with h5py.File(checkpoint) as file:
            for name, value in entries(file).items():
                if name in HEAD:
                    continue
                lines = [pattern for pattern in schema if pattern.fullmatch(name)]
                if checks.that(len(lines) == 1, f"{deck}: {name} has one line of the schema", [p.pattern for p in lines]):
                    met.add(lines[0])
                    check_entry(checks, f"{deck}: {name}", value, schema[lines[0]])
            code, said = call(os.path.join(BIN, "remdata"), "--about", checkpoint)
            elements = sum(group["connectivity"].shape[0] for group in file["groups"].values() if group.attrs["role"] == BODY)
            step, time = file["progress"].attrs["step"], file["progress"].attrs["time"]
        facts = dict(row.split(None, 1) for row in said.splitlines())
        checks.that(code == DONE and int(facts["elements"]) == elements and int(facts["step"]) == step and float(facts["time"]) == time,
                    f"{deck}: --about states {elements} elements, step {step} and the time {time}", said)
    checks.that(len(met) > len(schema)/2, "most lines of the schema are met in these files", f"{len(met)} of {len(schema)}")
    checks.end()


if __name__ == "__main__":
    main()
