"""Input files of Abaqus and CalculiX: nodes, elements, sets, surfaces, sections. What belongs to steps is left to the deck."""
import os
import re
from typing import Dict, List, Optional, Tuple

import numpy as np

from .mistakes import Mistakes
from .raw_mesh import QUADS, Cells, RawMesh

# Elements of the plane: the number of their nodes. Letters behind (R, M, H, T ...) change integration or fields, not the shape.
PLANE = re.compile(r"(CAX|CPE|CPS|DCAX|DC2D)(3|4|6|8)([A-Z]*)\Z")
TRUSSES = {"T2D2": 2, "T3D2": 2, "B21": 2, "B31": 2, "T2D3": 3, "T3D3": 3, "B22": 3, "B32": 3, "B32R": 3}
KINDS = {3: "triangle", 6: "triangle6", 4: "quad", 8: "quad8"}
GENERATORS = {"NGEN", "NFILL", "NCOPY", "ELGEN", "ELCOPY", "SYSTEM", "NMAP", "TRANSFORM"}
# What stands around the mesh, or is of no use for it.
SILENT = {"HEADING", "NODE", "ELEMENT", "ELSET", "NSET", "SURFACE", "SOLIDSECTION", "INCLUDE", "PART", "ENDPART", "ASSEMBLY",
          "ENDASSEMBLY", "INSTANCE", "ENDINSTANCE", "PREPRINT", "RESTART"}
DEEPEST = 10      # of files that include others


class InpReader:
    """Reads one file and those it includes."""

    def __init__(self, path: str, mistakes: Mistakes) -> None:
        self.path = path
        self.mistakes = mistakes
        self.nodes: Dict[int, Tuple[float, float, float]] = {}
        self.elements: Dict[int, Tuple[str, Tuple[int, ...], str, str]] = {}     # kind, nodes, set, place
        self.elsets: Dict[str, List[int]] = {}
        self.nsets: Dict[str, List[int]] = {}
        self.surfaces: Dict[str, List[Tuple[str, str, str]]] = {}                # elements or set, side, place
        self.sections: Dict[str, str] = {}
        self.spelling: Dict[str, str] = {}
        self.left_out: Dict[str, int] = {}
        self.instances = 0
        self.keyword = ""
        self.options: Dict[str, str] = {}
        self.pending: List[str] = []
        self.ended = False

    def read(self) -> RawMesh:
        """The mesh; mistakes are collected."""
        self._file(self.path, 0)
        if not self.nodes and not self.mistakes.lines:
            self.mistakes.add("*NODE", "there are no nodes")
        if not self.elements and not self.mistakes.lines:
            self.mistakes.add("*ELEMENT", "there are no elements")
        self.mistakes.refuse()
        return self._raw()

    # ---- lines ----

    def _file(self, path: str, depth: int, where: str = "") -> None:
        try:
            with open(path, encoding="utf-8", errors="replace") as file:
                lines = file.read().splitlines()
        except OSError as error:
            self.mistakes.add(where or path, f"{os.path.basename(path)}: cannot be read: {error.strerror}")
            return
        name = "" if depth == 0 else os.path.basename(path) + ":"
        for number, line in enumerate(lines, 1):
            place = f"{name}{number}"
            if self.ended:
                return
            if line.lstrip().startswith("**") or not line.strip():
                continue
            if line.lstrip().startswith("*"):
                self._keyword(line.strip(), place)
                if self.keyword == "INCLUDE" and not self.ended:
                    if depth >= DEEPEST or "INPUT" not in self.options:
                        self.mistakes.add(place, "*INCLUDE: expected INPUT=FILE, of files that do not include each other")
                    else:
                        self._file(os.path.join(os.path.dirname(path), self.options["INPUT"].strip('"')), depth + 1, place)
            else:
                self._data(line.strip(), place)

    def _keyword(self, line: str, place: str) -> None:
        self._finish_element(place)
        words = [word.strip() for word in line[1:].split(",")]
        self.keyword = re.sub(r"\s+", "", words[0]).upper()
        self.options = {}
        for word in words[1:]:
            key, _, value = word.partition("=")
            self.options[key.strip().upper()] = value.strip()
        if self.keyword == "STEP":
            self.ended = True
        elif self.keyword in GENERATORS:
            self.mistakes.add(place, f"*{words[0]}: nodes and elements that are generated or turned are not read: expected them written out")
        elif self.keyword == "INSTANCE":
            self.instances += 1
            if self.instances > 1:
                self.mistakes.add(place, "*INSTANCE: a second one: expected a single part, written where it stands")
        elif self.keyword == "ELEMENT" and not self.options.get("TYPE"):
            self.mistakes.add(place, "*ELEMENT: expected TYPE=...")
        elif self.keyword == "SOLIDSECTION":
            if "ELSET" in self.options:
                self.sections[self._key(self.options["ELSET"])] = self.options.get("MATERIAL", "")
        elif self.keyword == "SURFACE":
            if self.options.get("TYPE", "ELEMENT").upper() != "ELEMENT":
                self.mistakes.add(place, f"*SURFACE, TYPE={self.options['TYPE']}: expected TYPE=ELEMENT")
            elif "NAME" in self.options:
                self.surfaces.setdefault(self._key(self.options["NAME"]), [])
            else:
                self.mistakes.add(place, "*SURFACE: expected NAME=...")
        elif self.keyword not in SILENT:
            self.left_out[self.keyword] = self.left_out.get(self.keyword, 0) + 1

    def _key(self, name: str) -> str:
        """Names are the same in capital and small letters; the first spelling is kept."""
        name = name.strip().strip('"')
        return self.spelling.setdefault(name.upper(), name)

    def _data(self, line: str, place: str) -> None:
        words = [word.strip() for word in line.rstrip(",").split(",")]
        if self.keyword == "NODE":
            self._node(words, place)
        elif self.keyword == "ELEMENT" and self.options.get("TYPE"):
            self._element(words, line.endswith(","), place)
        elif self.keyword in ("ELSET", "NSET"):
            self._set(words, place)
        elif self.keyword == "SURFACE" and self.options.get("TYPE", "ELEMENT").upper() == "ELEMENT" and "NAME" in self.options:
            if len(words) < 2 or not re.match(r"S[1-4]\Z", words[1].upper()):
                self.mistakes.add(place, f"*SURFACE {self.options['NAME']}: expected an element or a set, and a side S1 to S4")
            else:
                self.surfaces[self._key(self.options["NAME"])].append((words[0], words[1].upper(), place))
        elif self.keyword == "INSTANCE" and any(_number(word) for word in words):
            self.mistakes.add(place, "*INSTANCE: moved or turned: expected a single part, written where it stands")

    # ---- contents ----

    def _node(self, words: List[str], place: str) -> None:
        label, values = _whole(words[0]), [_number(word) for word in words[1:4]]
        if label is None or label < 1 or len(values) < 2 or None in values:
            self.mistakes.add(place, "*NODE: expected a label and two or three coordinates")
            return
        if label in self.nodes:
            self.mistakes.add(place, f"*NODE: node {label} is given a second time")
            return
        self.nodes[label] = (values[0], values[1], values[2] if len(values) > 2 else 0.0)
        if self.options.get("NSET"):
            self.nsets.setdefault(self._key(self.options["NSET"]), []).append(label)

    def _element(self, words: List[str], goes_on: bool, place: str) -> None:
        self.pending += words
        if goes_on:
            return
        words, self.pending = self.pending, []
        numbers = [_whole(word) for word in words]
        name = self.options["TYPE"].upper()
        if None in numbers or min(numbers) < 1:
            self.mistakes.add(place, f"*ELEMENT {name}: expected a label and labels of nodes")
            return
        plane, size = PLANE.match(name), TRUSSES.get(name)
        kind = KINDS[int(plane.group(2))] if plane else {2: "line", 3: "line3"}.get(size, name)
        wanted = int(plane.group(2)) if plane else size
        if wanted and len(numbers) != wanted + 1:
            self.mistakes.add(place, f"element {numbers[0]}: {name} has {wanted} nodes, found {len(numbers) - 1}")
            return
        if kind == "line3":          # here the middle node is the second, in meshio's order the last
            numbers = [numbers[0], numbers[1], numbers[3], numbers[2]]
        if numbers[0] in self.elements:
            self.mistakes.add(place, f"element {numbers[0]} is given a second time")
            return
        group = self._key(self.options["ELSET"]) if self.options.get("ELSET") else ""
        self.elements[numbers[0]] = (kind, tuple(numbers[1:]), group, place)
        if group:
            self.elsets.setdefault(group, []).append(numbers[0])

    def _finish_element(self, place: str) -> None:
        if self.pending:
            self.mistakes.add(place, f"element {self.pending[0]} is cut short by a keyword")
            self.pending = []

    def _set(self, words: List[str], place: str) -> None:
        sets = self.elsets if self.keyword == "ELSET" else self.nsets
        name = self.options.get(self.keyword)
        if not name:
            self.mistakes.add(place, f"*{self.keyword}: expected {self.keyword}=NAME")
            return
        members = sets.setdefault(self._key(name), [])
        if "GENERATE" in self.options:
            numbers = [_whole(word) for word in words]
            if None in numbers or len(numbers) not in (2, 3) or (len(numbers) == 3 and numbers[2] < 1):
                self.mistakes.add(place, f"*{self.keyword} {name}: GENERATE wants first, last and step")
            else:
                members += range(numbers[0], numbers[1] + 1, *numbers[2:])
            return
        for word in words:
            number = _whole(word)
            if number is not None:
                members.append(number)
            elif word and self._key(word) in sets and self._key(word) != self._key(name):
                members += sets[self._key(word)]
            elif word:
                self.mistakes.add(place, f"*{self.keyword} {name}: '{word}' is neither a label nor a set given before")

    # ---- the whole ----

    def _raw(self) -> RawMesh:
        labels = sorted(self.nodes)
        index = {label: k for k, label in enumerate(labels)}
        raw = RawMesh(np.array([self.nodes[label] for label in labels]), np.array(labels))
        by_kind: Dict[Tuple[str, str], List[int]] = {}
        for label, (kind, nodes, group, place) in self.elements.items():
            absent = [node for node in nodes if node not in index]
            if absent:
                self.mistakes.add(place, f"element {label}: there is no node {absent[0]}")
                continue
            by_kind.setdefault((kind, group), []).append(label)
        sets: Dict[int, set] = {label: set() for label in self.elements}
        for name in self.sections:
            if name not in self.elsets:
                self.mistakes.add(f"*SOLID SECTION, ELSET={name}", "there is no such set of elements")
        for name, members in self.elsets.items():
            for label in members:
                if label not in self.elements:
                    self.mistakes.add(f"*ELSET {name}", f"there is no element {label}")
                else:
                    sets[label].add(name)
        for (kind, group), members in by_kind.items():
            where = f"*ELEMENT, ELSET={group}" if group else "*ELEMENT"
            cells = Cells(kind, np.array([[index[node] for node in self.elements[label][1]] for label in members]),
                          np.array(members), where, [sets[label] for label in members])
            raw.cells.append(cells)
        raw.bodies = set(self.sections) or {group for kind, _, group, _ in self.elements.values() if group and kind in QUADS}
        raw.laws = {name: law for name, law in self.sections.items() if law}
        self._surfaces(raw, index)
        for name, members in self.nsets.items():
            absent = [label for label in members if label not in index]
            if absent:
                self.mistakes.add(f"*NSET {name}", f"there is no node {absent[0]}")
            else:
                raw.node_sets[name] = np.array([index[label] for label in members], dtype=int)
        if self.left_out:
            raw.notes.append("left to the deck: " + ", ".join(f"*{word}" for word in self.left_out))
        return raw

    def _surfaces(self, raw: RawMesh, index: Dict[int, int]) -> None:
        for name, rows in self.surfaces.items():
            ends = raw.sides.setdefault(name, [])
            for word, side, place in rows:
                label = _whole(word)
                members = [label] if label is not None else self.elsets.get(self._key(word))
                if members is None:
                    self.mistakes.add(place, f"*SURFACE {name}: there is no set of elements '{word}'")
                    continue
                for label in members:
                    kind, nodes = self.elements.get(label, ("", ()))[:2]
                    if kind and not kind.startswith(("quad", "line")):
                        break      # such elements are refused as a whole
                    if not kind.startswith("quad"):
                        self.mistakes.add(place, f"*SURFACE {name}: {f'element {label} has no sides' if kind else f'there is no element {label}'}")
                        break
                    k = int(side[1])
                    ends.append((index.get(nodes[k - 1], -1), index.get(nodes[k % 4], -1)))


def _whole(word: str) -> Optional[int]:
    return int(word) if re.match(r"[+-]?\d+\Z", word) else None


def _number(word: str) -> Optional[float]:
    try:
        value = float(word.upper().replace("D", "E")) if word else 0.0
    except ValueError:
        return None
    return value if np.isfinite(value) else None


def read_inp(path: str, mistakes: Mistakes) -> RawMesh:
    """The mesh of an input file."""
    raw = InpReader(path, mistakes).read()
    mistakes.refuse()
    return raw
