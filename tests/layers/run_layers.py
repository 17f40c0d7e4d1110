#!/usr/bin/env python3
"""Check the layers of the sources: who may `use` whom, one module a file, no cycles, no type name
twice, files of a readable length, nothing strange at the top.

usage: run_layers.py [ROOT] | --selftest
ROOT is the project's folder (default: LAGAMINE_SOURCE, else two folders up). Reads src/**/*.f90 and remdata/**/*.f90.
"""
import collections
import fnmatch
import os
import re
import sys
import tempfile

# Floors from top to bottom. Names are folders of src/; `main` is src/main.f90. A folder may use itself and what is below.
FLOORS = ["main", "analysis", "report", "solve", "estimate", "cards", "elem", "kinematics", "law", "store", "model", "deck",
          "linear", "geometry", "phases", "base"]

# Arrows that point downward and are forbidden all the same, with the reason that is printed.
FORBIDDEN = {
    ("law", "store"): "a law knows no file",
    ("law", "deck"): "a law knows no deck",
    ("model", "deck"): "the model knows no deck",
    ("store", "deck"): "files of results know no deck",
    ("kinematics", "store"): "kinematics knows no file",
    ("kinematics", "deck"): "kinematics knows no deck",
}

# Where a folder may reach another one only through these modules.
ONLY_THROUGH = {
    ("elem", "law"): {"contact_penalties", "heat_sources", "law_api"},
    ("kinematics", "law"): {"law_api"},
    ("cards", "linear"): {"linear_api", "linear_registry"},
    ("solve", "linear"): {"linear_solver", "matrix_pattern"},
}

# remdata/ stands on src/ but not on these; nothing in src/ stands on remdata/.
NOT_FOR_REMDATA = {
    "main": "remdata has a main of its own",
    "analysis": "REMDATA runs no analysis",
    "solve": "REMDATA solves nothing",
    "elem": "REMDATA knows no element",
    "kinematics": "REMDATA knows no law",
    "law": "REMDATA knows no law",
    "linear": "REMDATA solves nothing",
}

# Rooms of remdata from top to bottom: a room may use itself and what is below. The driver stands in remdata/ itself.
ROOMS = ["remdata", *(f"remdata/{room}" for room in ("transfer", "free_mesh", "quads", "plan", "mesh", "sizes", "contour",
                                                     "contact", "old_mesh", "curves"))]

# What a cycle does next is decided beside these rooms: the driver asks, and only these floors are used.
CYCLE, CYCLE_ON = "remdata/cycle", ("store", "model", "base")

# What stands in remdata/ itself: the driver and what it reads and reports.
DRIVER = {"main", "remesh_scene", "remesh_cuts", "mesh_choice", "remesh_options", "remesh_facts", "remesh_report", "checkpoint_summary",
          "solver_blas"}

# Modules that come from the compiler or a library.
EXTERNAL = {"iso_fortran_env", "iso_c_binding", "ieee_arithmetic", "ieee_exceptions", "ieee_features", "omp_lib", "hdf5"}

# Modules that CMake makes of others, of another precision: they stand where those stand.
MADE_OF_OTHERS = "_single"

LONGEST_FILE = 800

# Names of types that are still defined more than once, and how often: each must get a name of its own, and leave this list.
TYPES_TWICE = {"parameter_t": 2, "side_t": 2}

# What stands at the top of the tree, beside files with a dot and what .gitignore names.
TOP = {"CMakeLists.txt", "LICENSE", "README.md", "decks", "remdata", "src", "tests"}

MODULE = re.compile(r"\s*module\s+(?!procedure\b|subroutine\b|function\b)(\w+)\s*(?:!.*)?$", re.I)
SUBMODULE = re.compile(r"\s*submodule\s*\(\s*(\w+)\s*(?::\s*(\w+)\s*)?\)\s*(\w+)\s*(?:!.*)?$", re.I)
PROGRAM = re.compile(r"\s*program\s+(\w+)\s*(?:!.*)?$", re.I)
USE = re.compile(r"\s*use\b\s*(?:,\s*(?:non_)?intrinsic\s*)?(?:::)?\s*(\w+)\s*(?:,|!|&|$)", re.I)
TYPE = re.compile(r"\s*type\s*(?:,[^:]*::\s*|::\s*|\s)\s*(\w+)\s*(?:!.*)?$", re.I)
BLOCK_START = re.compile(r"\s*(?:type\s*(?:,[^:]*)?(?:::\s*|\s)\s*\w+|(?:abstract\s+)?interface\b.*)\s*(?:!.*)?$", re.I)
BLOCK_END = re.compile(r"\s*end\s*(?:type|interface)\b", re.I)
WORDS = {word: re.compile(rf"\s*{word}\s*(?:!.*)?$", re.I) for word in ("implicit none", "private", "contains")}

Unit = collections.namedtuple("Unit", "kind name file line folder uses parent")


class Tree:
    """The modules of a source tree, and what is wrong with it."""

    def __init__(self, root, types_twice):
        self.root = root
        self.types_twice = types_twice
        self.units = {}
        self.types = collections.defaultdict(list)
        self.errors = []
        self.checks = 0
        self.arrows = collections.Counter()
        for top in ("src", "remdata"):
            for folder, folders, files in os.walk(os.path.join(root, top)):
                folders.sort()
                for file in sorted(files):
                    if file.endswith(".f90"):
                        self.read(os.path.relpath(os.path.join(folder, file), root).replace(os.sep, "/"))

    def check(self, good, file, line, text):
        """Count a check; an error names file and line."""
        self.checks += 1
        if not good:
            self.errors.append(f"{file}:{line}: {text}")
        return good

    def read(self, file):
        """One file: its unit, its `use` statements, and the rules that concern it alone."""
        with open(os.path.join(self.root, file), encoding="utf-8") as source:
            lines = source.read().splitlines()
        self.check(len(lines) <= LONGEST_FILE, file, len(lines), f"longer than {LONGEST_FILE} lines")
        found, uses, seen, depth, specification = [], [], set(), 0, True
        for number, line in enumerate(lines, 1):
            for kind, pattern in (("module", MODULE), ("submodule", SUBMODULE), ("program", PROGRAM)):
                start = pattern.match(line)
                if start:
                    parent = (start.group(2) or start.group(1)).lower() if kind == "submodule" else None
                    found.append((kind, start.group(start.lastindex).lower(), number, parent))
            new_type = TYPE.match(line)
            if new_type:
                self.types[new_type.group(1).lower()].append((file, number))
            use = USE.match(line)
            if use:
                uses.append((use.group(1).lower().removesuffix(MADE_OF_OTHERS), number))
            # A `private` inside a type is not the module's.
            depth += bool(BLOCK_START.match(line)) - bool(BLOCK_END.match(line))
            for word, pattern in WORDS.items():
                if depth == 0 and specification and pattern.match(line):
                    seen.add(word)
                    specification = word != "contains"
        self.check(len(found) == 1, file, found[1][2] if len(found) > 1 else 1,
                   f"{len(found)} modules, submodules or programs in one file; there must be one")
        if not found:
            return
        kind, name, line, parent = found[0]
        parts = file.split("/")
        stem = parts[-1][:-len(".f90")]
        if parts[0] == "remdata":
            folder = "remdata" if len(parts) == 2 else f"remdata/{parts[1]}"
            self.check(len(parts) > 2 or stem in DRIVER, file, line, "only the driver stands in remdata/ itself, not in a room")
        else:
            folder = parts[1] if len(parts) > 2 else "main"
        if kind == "program":
            self.check(parts[1:] == ["main.f90"], file, line, "a program stands in main.f90 and nowhere else")
        else:
            self.check(name == stem, file, line, f"{kind} {name} in {stem}.f90: the names must be the same")
            self.check(parts != ["src", parts[-1]], file, line, "modules stand in a folder of src/, not beside main.f90")
        if folder not in (*ROOMS, CYCLE, *FLOORS):
            self.check(False, file, line, f"folder {'/'.join(parts[:2])} is not in the table of floors (tests/layers)")
        # A submodule stands in its module's scope and inherits both.
        if kind != "submodule":
            self.check("implicit none" in seen, file, line, f"{kind} {name} has no `implicit none`")
        if kind == "module":
            self.check("private" in seen, file, line, f"module {name} has no `private`")
        key = (kind, name)
        known = self.units.get(key)
        if self.check(not known, file, line, f"{kind} {name} is also in {known.file if known else ''}"):
            self.units[key] = Unit(kind, name, file, line, folder, uses, parent)

    def check_arrows(self):
        """Every `use`, and every submodule's tie to its module."""
        for unit in self.units.values():
            for name, line in unit.uses + ([(unit.parent, unit.line)] if unit.parent else []):
                target = self.units.get(("module", name))
                if target:
                    self.arrows[unit.folder, target.folder] += 1
                    why = why_not(unit.folder, target)
                    self.check(not why, unit.file, line, f"{unit.folder} may not use {name} of {target.folder}: {why}")
                else:
                    self.check(name in EXTERNAL or (unit.parent == name and ("submodule", name) in self.units), unit.file, line,
                               f"module {name} is neither in the tree nor in the list of external ones (tests/layers)")

    def check_cycles(self):
        """Depth first; a way back to an open module is a cycle. Nothing can use a submodule, so modules suffice."""
        state = {}

        def visit(name, path):
            state[name] = "open"
            unit = self.units["module", name]
            for used, line in unit.uses:
                if ("module", used) not in self.units:
                    continue
                if state.get(used) == "open":
                    ring = [*path[path.index(used):], used]
                    self.check(False, unit.file, line, "cycle of modules: " + " -> ".join(ring))
                elif used not in state:
                    visit(used, [*path, used])
            state[name] = "done"

        sys.setrecursionlimit(10000)
        for kind, name in self.units:
            if kind == "module" and name not in state:
                visit(name, [name])
        self.checks += 1

    def check_types(self):
        """One type, one name: what several places define under the same name is read as the same thing."""
        for name in sorted({*self.types, *self.types_twice}):
            places, known = self.types.get(name, []), self.types_twice.get(name, 1)
            file, line = places[known] if len(places) > known else ("tests/layers", 1)
            others = ", ".join(other for other, _ in places if other != file)
            self.check(len(places) <= known, file, line, f"type {name} is also defined in {others}")
            self.check(len(places) >= known, file, line,
                       f"type {name} is defined {len(places)} times and no longer {known}: TYPES_TWICE must say so")

    def check_top(self):
        """Runs and tests leave nothing of theirs beside the sources."""
        ignored = []
        if os.path.exists(os.path.join(self.root, ".gitignore")):
            with open(os.path.join(self.root, ".gitignore"), encoding="utf-8") as file:
                ignored = [line.strip().rstrip("/") for line in file if line.strip()]
        for name in sorted(os.listdir(self.root)):
            if name.startswith(".") or any(fnmatch.fnmatch(name, pattern) for pattern in ignored):
                continue
            self.check(name in TOP, name, 1, "stands at the top of the tree, where only " + ", ".join(sorted(TOP)) + " do")

    def run(self):
        self.check_top()
        self.check_arrows()
        self.check_cycles()
        self.check_types()
        return self.errors


def why_not(folder, target):
    """Why a folder may not use this module; empty where it may."""
    if folder == target.folder:
        return ""
    if folder == CYCLE:
        return "" if target.folder in CYCLE_ON else "a cycle is decided by what files state"
    if target.folder == CYCLE:
        return "" if folder == "remdata" else "only the driver of remdata asks what a cycle does next"
    if folder in ROOMS and target.folder in ROOMS:
        return f"{target.folder} is above {folder}" if ROOMS.index(folder) > ROOMS.index(target.folder) else ""
    if target.folder in ROOMS:
        return "nothing in src stands on remdata"
    if folder in ROOMS:
        return NOT_FOR_REMDATA.get(target.folder, "")
    if folder not in FLOORS or target.folder not in FLOORS:
        return "a folder without a floor"
    if FLOORS.index(folder) > FLOORS.index(target.folder):
        return f"{target.folder} is above {folder}"
    doors = ONLY_THROUGH.get((folder, target.folder))
    if doors and target.name not in doors:
        return "only through " + ", ".join(sorted(doors))
    return FORBIDDEN.get((folder, target.folder), "")


def report(tree):
    """The table of arrows, then what is wrong."""
    order = [*ROOMS, CYCLE, *FLOORS]
    for start in sorted({a for a, _ in tree.arrows}, key=lambda f: order.index(f) if f in order else len(order)):
        ends = sorted((b for a, b in tree.arrows if a == start), key=lambda f: order.index(f) if f in order else len(order))
        print(f"{start:>17} -> " + ", ".join(f"{end} {tree.arrows[start, end]}" for end in ends))
    for error in tree.errors:
        print(error)


def module(name, *uses, more="  private\n"):
    """A small module for the trees of the self test."""
    return f"module {name}\n" + "".join(f"  use {used}\n" for used in uses) + f"  implicit none\n{more}end module {name}\n"


KNOWN = "  private\n  type, extends(base_t), public :: known_t   ! defined twice, and known to be\n  end type known_t\n"

# Name, files, and the one error wanted (None: nothing is wrong).
GOOD = {"src/main.f90": "program lagamine\n  use run\n  implicit none\nend program lagamine\n",
        "src/analysis/run.f90": module("run", "cells", "kinds"),
        "src/elem/cells.f90": module("cells", "law_api, only: law_t", ":: large"),
        "src/elem/cells_list.f90": "submodule(cells) cells_list\n  use kinds\nend submodule cells_list\n",
        "src/elem/cells_part.f90": "submodule (cells:cells_list) cells_part\nend submodule cells_part\n",
        "src/kinematics/large.f90": module("large", "law_api", "kinds"),
        "src/law/law_api.f90": module("law_api", "kinds", ", intrinsic :: iso_fortran_env, only: real64"),
        "src/law/law_epla.f90": module("law_epla", "law_api"),
        "src/store/files.f90": module("files", "hdf5", "kinds"),
        "src/deck/cards_read.f90": module("cards_read", "kinds"),
        "src/model/mesh.f90": module("mesh", "kinds", more=KNOWN),
        "src/linear/linear_mumps.f90": module("linear_mumps", "kinds"),
        "src/base/kinds.f90": module("kinds", more=KNOWN),
        "remdata/main.f90": "program remdata\n  use zones\n  implicit none\nend program remdata\n",
        "remdata/remesh_scene.f90": module("remesh_scene", "zones"),
        "remdata/mesh/zones.f90": module("zones", "mesh", "files", "chains"),
        "remdata/curves/chains.f90": module("chains")}
CASES = [
    ("good tree", {}, None),
    ("upward arrow", {"src/base/bad.f90": module("bad", "kinds", "mesh")},
     "src/base/bad.f90:3: base may not use mesh of model: model is above base"),
    ("law on files", {"src/law/bad.f90": module("bad", "files")}, "src/law/bad.f90:2: law may not use files of store"),
    ("law on a deck", {"src/law/bad.f90": module("bad", "cards_read")}, "law may not use cards_read of deck"),
    ("law on an element", {"src/law/bad.f90": module("bad", "cells")}, "law may not use cells of elem: elem is above law"),
    ("law on kinematics", {"src/law/bad.f90": module("bad", "large")}, "law may not use large of kinematics"),
    ("element on a law", {"src/elem/bad.f90": module("bad", "law_epla")},
     "elem may not use law_epla of law: only through contact_penalties, heat_sources, law_api"),
    ("kinematics on a law", {"src/kinematics/bad.f90": module("bad", "law_epla")}, "only through law_api"),
    ("solve on a linear solver", {"src/solve/bad.f90": module("bad", "linear_mumps")},
     "solve may not use linear_mumps of linear: only through linear_solver, matrix_pattern"),
    ("geometry on the model", {"src/geometry/bad.f90": module("bad", "mesh")}, "model is above geometry"),
    ("linear solver on the model", {"src/linear/bad.f90": module("bad", "mesh")}, "model is above linear"),
    ("remdata on a linear solver", {"remdata/mesh/bad.f90": module("bad", "linear_mumps")}, "REMDATA solves nothing"),
    ("kinematics on files", {"src/kinematics/bad.f90": module("bad", "files")}, "kinematics knows no file"),
    ("model on a deck", {"src/model/bad.f90": module("bad", "cards_read")}, "the model knows no deck"),
    ("model on files", {"src/model/bad.f90": module("bad", "files")}, "store is above model"),
    ("files on a deck", {"src/store/bad.f90": module("bad", "cards_read")}, "files of results know no deck"),
    ("remdata on a law", {"remdata/mesh/bad.f90": module("bad", "law_api")},
     "remdata/mesh/bad.f90:2: remdata/mesh may not use law_api of law"),
    ("remdata on analysis", {"remdata/curves/bad.f90": module("bad", "run")}, "REMDATA runs no analysis"),
    ("room on a higher room", {"remdata/curves/bad.f90": module("bad", "zones")},
     "remdata/curves/bad.f90:2: remdata/curves may not use zones of remdata/mesh: remdata/mesh is above remdata/curves"),
    ("room on the driver", {"remdata/mesh/bad.f90": module("bad", "remesh_scene")}, "remdata is above remdata/mesh"),
    ("beside the driver", {"remdata/bad.f90": module("bad")}, "only the driver stands in remdata/ itself"),
    ("unknown room", {"remdata/attic/bad.f90": module("bad")}, "folder remdata/attic is not in the table"),
    ("cycle on a room", {"remdata/cycle/bad.f90": module("bad", "zones")}, "a cycle is decided by what files state"),
    ("cycle on a deck", {"remdata/cycle/bad.f90": module("bad", "cards_read")}, "a cycle is decided by what files state"),
    ("room on the cycle", {"remdata/cycle/steps.f90": module("steps", "files"), "remdata/mesh/bad.f90": module("bad", "steps")},
     "remdata/mesh/bad.f90:2: remdata/mesh may not use steps of remdata/cycle: only the driver of remdata asks"),
    ("src on the cycle", {"remdata/cycle/steps.f90": module("steps"), "src/analysis/bad.f90": module("bad", "steps")},
     "only the driver of remdata asks"),
    ("src on remdata", {"src/analysis/bad.f90": module("bad", "zones")}, "nothing in src stands on remdata"),
    ("submodule's arrow", {"src/base/bad.f90": "submodule(kinds) bad\n  use mesh\nend submodule bad\n"},
     "src/base/bad.f90:2: base may not use mesh"),
    ("submodule elsewhere", {"src/base/bad.f90": "submodule(mesh) bad\nend submodule bad\n"},
     "src/base/bad.f90:1: base may not use mesh"),
    ("arrow by interface",
     {"src/base/bad.f90": module("bad", more="  private\n  interface\n  subroutine a()\n  USE mesh\n  end\n  end interface\n")},
     "src/base/bad.f90:6: base may not use mesh"),
    ("cycle", {"src/model/a.f90": module("a", "b"), "src/model/b.f90": module("b", "c"), "src/model/c.f90": module("c", "a")},
     "src/model/c.f90:2: cycle of modules: a -> b -> c -> a"),
    ("cycle of one", {"src/model/a.f90": module("a", "a")}, "cycle of modules: a -> a"),
    ("module and file names", {"src/base/bad.f90": module("worse")}, "src/base/bad.f90:1: module worse in bad.f90"),
    ("submodule and file names", {"src/base/bad.f90": "submodule(kinds) worse\nend submodule worse\n"},
     "submodule worse in bad.f90"),
    ("two modules", {"src/base/bad.f90": module("bad") + module("worse")}, "src/base/bad.f90:5: 2 modules"),
    ("no module", {"src/base/bad.f90": "subroutine bad()\nend subroutine bad\n"}, "src/base/bad.f90:1: 0 modules"),
    ("module twice", {"src/model/kinds.f90": module("kinds")}, "module kinds is also in src/base/kinds.f90"),
    ("program elsewhere", {"src/base/bad.f90": "program bad\n  implicit none\nend program bad\n"},
     "a program stands in main.f90"),
    ("module beside main", {"src/bad.f90": module("bad")}, "modules stand in a folder of src/"),
    ("folder without floor", {"src/utils/bad.f90": module("bad")}, "folder src/utils is not in the table"),
    ("unknown module", {"src/base/bad.f90": module("bad", "mpi")}, "src/base/bad.f90:2: module mpi is neither"),
    ("no private", {"src/base/bad.f90": module("bad", more="")}, "module bad has no `private`"),
    ("private of a type only", {"src/base/bad.f90": module("bad", more="  type, public :: t\n    private\n  end type t\n")},
     "module bad has no `private`"),
    ("private after a type", {"src/base/bad.f90": module("bad", more="  type t\n    integer :: i\n  end type\n  private ! all\n")},
     None),
    ("no implicit none",
     {"src/base/bad.f90": "module bad\n  private\ncontains\n  subroutine a()\n  implicit none\n  end\nend module bad\n"},
     "module bad has no `implicit none`"),
    ("type twice", {"src/base/a.f90": module("a", more="  private\n  type, public :: t ! one\n  end type t\n"),
                    "src/model/b.f90": module("b", more="  private\n  type T\n  end type T\n  type(t) :: u\n")},
     "src/model/b.f90:4: type t is also defined in src/base/a.f90"),
    ("type three times, known twice", {"src/store/c.f90": module("c", more=KNOWN)},
     "src/store/c.f90:4: type known_t is also defined in src/base/kinds.f90, src/model/mesh.f90"),
    ("type no longer twice", {"src/model/mesh.f90": module("mesh", "kinds")},
     "type known_t is defined 1 times and no longer 2"),
    ("results at the top", {"upsetting/history.csv": "", ".gitignore": "build/\nout/\n", "out/a": ""},
     "upsetting:1: stands at the top of the tree"),
    ("long file", {"src/base/bad.f90": module("bad") + "\n" * 800}, "src/base/bad.f90:804: longer than 800 lines"),
]


def selftest():
    """Each case is a good tree with a few more files; exactly the wanted error must come out."""
    failed = 0
    for name, files, wanted in CASES:
        with tempfile.TemporaryDirectory() as root:
            for path, text in {**GOOD, **files}.items():
                os.makedirs(os.path.join(root, os.path.dirname(path)), exist_ok=True)
                with open(os.path.join(root, path), "w", encoding="utf-8") as out:
                    out.write(text)
            errors = Tree(root, {"known_t": 2}).run()
        good = not errors if wanted is None else len(errors) == 1 and wanted in errors[0]
        if not good:
            failed += 1
            print(f"FAILED: {name}: wanted {wanted}, got {errors}")
    print(f"{len(CASES) - failed} passed, {failed} failed")
    return 1 if failed else 0


def main(arguments):
    if arguments == ["--selftest"]:
        return selftest()
    if len(arguments) > 1 or arguments and arguments[0].startswith("-"):
        print(__doc__, file=sys.stderr)
        return 2
    above = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
    tree = Tree(arguments[0] if arguments else os.environ.get("LAGAMINE_SOURCE") or above, TYPES_TWICE)
    tree.run()
    report(tree)
    print(f"{len(tree.units)} units: {tree.checks - len(tree.errors)} passed, {len(tree.errors)} failed")
    return 1 if tree.errors or not tree.units else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
