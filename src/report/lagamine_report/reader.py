"""A run's folder: its texts at once, its fields when they are asked for."""
import glob
import os
import re
from dataclasses import dataclass, field
from typing import Dict, List, Optional, Tuple

import h5py
import numpy as np

from .cycle import read_cycle, refused_last
from .errors import ReportError
from .tables import read_calls, read_history, read_history_so_far, read_notes, read_summary, rows_up_to, with_entries
from .unfinished import stop_reason, unfinished_name, unfinished_summary

AXISYMMETRIC = 2


@dataclass
class Group:
    """Elements of one kind: name, LAGAMINE's element name, nodes from 0, points of a side (negative: Lobatto), what these are."""

    number: str
    name: str
    elem: str
    connectivity: np.ndarray
    npoint: int = 0
    rule: str = ""


@dataclass
class Step:
    """A saved instant, and where it is kept."""

    generation: "Generation"
    place: str
    number: int
    time: float


@dataclass
class Generation:
    """One mesh generation: NAME.gNN.h5. Coordinates (node, 2), topology (element, 8), pieces (piece, 3, 2)."""

    path: str
    number: int
    title: str
    plane_state: int
    coordinates: np.ndarray
    topology: np.ndarray
    groups: List[Group]
    dies: Dict[str, np.ndarray]
    die_order: Dict[str, int]
    steps: List[Step] = field(default_factory=list)


class Run:
    """Results in a folder. What is missing or damaged is refused by name (ReportError).

    A run writes its summary when it ends: without one it is under way or was interrupted, and has what it has written so far.
    """

    def __init__(self, folder: str) -> None:
        if not os.path.isdir(folder):
            raise ReportError(f"{folder}: no such {'deck' if folder.endswith('.lag') else 'folder'}")
        self.folder = folder
        self._names: Dict[Tuple[str, str], Tuple[str, ...]] = {}        # of groups in files, once they have been asked for
        summary, history = os.path.join(folder, "summary.json"), os.path.join(folder, "history.csv")
        self.ended = os.path.exists(summary)
        if self.ended:
            self.summary = read_summary(summary)
            self.name = os.path.splitext(os.path.basename(self.summary["deck"]))[0]
            self.history = read_history(history)
        else:
            name = unfinished_name(folder)
            if name is None:
                raise ReportError(f"{summary}: missing, and no listing: no results of a run here",
                                  advice="give the folder that `lagamine DECK --out DIR` writes to")
            self.name = name
            self.history = read_history_so_far(history)
        self.notes = read_notes(os.path.join(folder, self.name + ".log"))
        self.calls = read_calls(os.path.join(folder, self.name + ".log"))
        self.tries = read_cycle(folder, self.name)
        self.left_out = refused_last(self.tries)
        self.generations = [read_generation(path) for path in self._generation_files()]
        if self.left_out:
            self.history = rows_up_to(self.history, self.left_out.step)
        self.steps = [step for generation in self.generations for step in generation.steps]
        if not self.steps and self.ended:
            raise ReportError(f"{self.generations[0].path}: no saved steps{self._why_none()}")
        if not self.ended:
            self.summary = with_entries(unfinished_summary(folder, self.name, self.history, self._last_elements(),
                                                           max(len(self.generations) - 1, 0)))
        # an operation has dies of its own
        self.die_names = list(dict.fromkeys(name for generation in self.generations for name in self._order_dies(generation)))

    def _generation_files(self) -> List[str]:
        """NAME.g01.h5, NAME.g02.h5 ... without a gap. What was computed on a last mesh that was refused is no result, where there is another."""
        stem = os.path.join(self.folder, self.name)
        found = {}
        for path in glob.glob(glob.escape(stem) + ".g*.h5"):
            match = re.fullmatch(re.escape(stem) + r"\.g(\d+)\.h5", path)
            if match:
                found[int(match.group(1))] = path
        if not found:
            if not self.ended and not self.history:     # it has only just begun
                return []
            raise ReportError(f"{stem}.g01.h5: missing{self._why_none()}")
        if self.left_out and min(found) < self.left_out.generation:
            found = {number: path for number, path in found.items() if number < self.left_out.generation}
        else:
            self.left_out = None
        for number in range(min(found), max(found) + 1):
            if number not in found:
                raise ReportError(f"{stem}.g{number:02d}.h5: missing, though there is {os.path.basename(found[max(found)])}")
        return [found[number] for number in sorted(found)]

    def _why_none(self) -> str:
        """Why a run has left no fields, where it has said so."""
        reason = stop_reason(self.folder, self.name)
        return f"; the run stopped: {reason}" if reason else ""

    def _last_elements(self) -> int:
        """Elements of the latest mesh; 0 where there is none yet."""
        return len(self.generations[-1].topology) if self.generations else 0

    def _order_dies(self, generation: Generation) -> List[str]:
        """Dies in the order of the pilots: the deck's, which the columns of the history keep (HDF5 sorts names)."""
        names = list(generation.dies)
        order = generation.die_order
        if len(order) == len(names):
            return sorted(names, key=lambda name: order[name])
        columns = [column[len("force_x_"):] for column in self.history if column.startswith("force_x_")]
        return [name for name in columns if name in names] + [name for name in names if name not in columns]

    @property
    def axisymmetric(self) -> bool:
        return bool(self.generations) and self.generations[0].plane_state == AXISYMMETRIC

    @property
    def title(self) -> str:
        return self.summary.get("title") or (self.generations[0].title if self.generations else "") or self.name

    def read(self, step: Step, dataset: str) -> np.ndarray:
        """A dataset of a saved step."""
        return _in_file(step.generation.path, lambda file: _dataset(file, f"{step.place}/{dataset}"))

    def names(self, step: Step, group: str) -> Tuple[str, ...]:
        """Names of what a group of a saved step holds; empty when there is none."""
        place = step.generation.path, f"{step.place}/{group}"
        if place not in self._names:
            self._names[place] = _in_file(place[0], lambda file: tuple(file[place[1]]) if place[1] in file else ())
        return self._names[place]

    def coordinates(self, step: Step) -> np.ndarray:
        """Where the nodes are at a saved step (node, 2)."""
        x = self.read(step, "coordinates")
        if x.shape != step.generation.coordinates.shape or not np.isfinite(x).all():
            raise ReportError(f"{step.generation.path}: damaged: '{step.place}/coordinates' does not fit the mesh")
        return x

    def nodal(self, step: Step, name: str) -> np.ndarray:
        """A field at the nodes; of a vector, its length."""
        values = self.read(step, f"node/{name}")
        if len(values) != len(step.generation.coordinates):
            raise ReportError(f"{step.generation.path}: damaged: '{step.place}/node/{name}' has {len(values)} rows, "
                              f"the mesh {len(step.generation.coordinates)} nodes")
        return np.sqrt((values**2).sum(axis=1)) if values.ndim == 2 else values

    def unit(self, step: Step, name: str) -> str:
        """Unit of a field at the nodes, in words of the deck's units; empty where it has none."""
        unit = _in_file(step.generation.path, lambda file: _attribute(file[f"{step.place}/node/{name}"], "unit", ""))
        return "" if unit == "-" else unit

    def points(self, step: Step, group: Group) -> Optional[Tuple[List[str], np.ndarray]]:
        """Component names and state (element, point, component) of a group, None when it has none."""
        if "state" not in self.names(step, f"points/{group.number}"):
            return None
        state = self.read(step, f"points/{group.number}/state")
        names = [_text(name) for name in self.read(step, f"points/{group.number}/components")]
        if state.ndim != 3 or state.shape[2] != len(names) or state.shape[0] != len(group.connectivity):
            raise ReportError(f"{step.generation.path}: damaged: '{step.place}/points/{group.number}/state' "
                              "does not fit its components and elements")
        return names, state

    def largest_at_points(self, step: Step, name: str) -> Optional[float]:
        """Largest value of a field at the integration points of all bodies, None where none has it."""
        found = []
        for group in step.generation.groups:
            held = self.points(step, group) if group.connectivity.shape[1:] == (8,) else None
            if held is None:
                continue
            state = dict(zip(held[0], np.moveaxis(held[1], 2, 0)))
            if name == "mises" and "stress_xx" in state:
                xx, yy, xy, zz = (state[f"stress_{c}"] for c in ("xx", "yy", "xy", "zz"))
                state[name] = np.sqrt(0.5 * ((xx - yy)**2 + (yy - zz)**2 + (zz - xx)**2) + 3 * xy**2)
            if name in state:
                found.append(float(state[name].max()))
        return max(found) if found else None

    def pilots(self, step: Step) -> Dict[str, np.ndarray]:
        """Position (x, y, angle) of every die at a saved step."""
        names = self._order_dies(step.generation)
        if not names:
            return {}
        pilots = self.read(step, "pilots")
        if pilots.shape != (len(names), 3):
            raise ReportError(f"{step.generation.path}: damaged: '{step.place}/pilots' does not fit {len(names)} dies")
        return dict(zip(names, pilots))


def read_generation(path: str) -> Generation:
    """Mesh, groups, dies and the list of saved steps of one file."""
    return _in_file(path, lambda file: _generation(path, file))


def _in_file(path: str, action):
    """Do something with an open HDF5 file; its failures name the file."""
    try:
        with h5py.File(path, "r") as file:
            return action(file)
    except ReportError as error:
        raise ReportError(f"{path}: {error}", error.code) from error
    except (OSError, KeyError, RuntimeError, ValueError) as error:
        if not os.path.exists(path):
            raise ReportError(f"{path}: missing") from error
        raise ReportError(f"{path}: damaged or not of this system: {str(error).splitlines()[0].strip(chr(34))}") from error


def _dataset(file: h5py.File, place: str) -> np.ndarray:
    if place not in file:
        raise ReportError(f"damaged: '{place}' is missing")
    return file[place][()]


def _attribute(item, name: str, default=None):
    if name not in item.attrs:
        if default is None:
            raise ReportError(f"damaged: attribute '{name}' of '{item.name}' is missing")
        return default
    value = item.attrs[name]
    return _text(value) if isinstance(value, (bytes, str, h5py.Empty)) else value


def _text(value) -> str:
    """Text of an attribute or a word of a dataset."""
    if isinstance(value, h5py.Empty):
        return ""
    return value.decode("utf-8", "replace").rstrip("\0 ") if isinstance(value, bytes) else str(value)


def _generation(path: str, file: h5py.File) -> Generation:
    coordinates = _dataset(file, "mesh/coordinates")
    topology = _dataset(file, "mesh/topology").astype(int)
    if coordinates.ndim != 2 or coordinates.shape[1] != 2 or not np.isfinite(coordinates).all():
        raise ReportError("damaged: 'mesh/coordinates' are not two finite numbers a node")
    if topology.ndim != 2 or topology.shape[1] != 8 or not len(topology):
        raise ReportError("damaged: 'mesh/topology' holds no 8-node elements")
    groups = []
    for number in sorted(file.get("mesh/groups", {}), key=int):
        item = file[f"mesh/groups/{number}"]
        nodes = _dataset(file, f"mesh/groups/{number}/connectivity").astype(int)
        groups.append(Group(number, _attribute(item, "name"), _attribute(item, "elem"), nodes, int(_attribute(item, "npoint", 0)),
                            _attribute(item, "rule", "") or ""))
    for nodes in [topology] + [group.connectivity for group in groups]:
        if nodes.size and (nodes.min() < 0 or nodes.max() >= len(coordinates)):
            raise ReportError("damaged: an element has a node that does not exist")
    dies, order = {}, {}
    for name, item in file.get("dies", {}).items():
        dies[name] = item[()].reshape(-1, 3, 2)
        if "number" in item.attrs:
            order[name] = int(item.attrs["number"])
    generation = Generation(path, int(_attribute(file, "generation")), _attribute(file, "title", "") or "",
                            int(_attribute(file, "plane_state")), coordinates, topology, groups, dies, order)
    for name in sorted(file.get("steps", {})):
        item = file[f"steps/{name}"]
        generation.steps.append(Step(generation, f"steps/{name}", int(_attribute(item, "step")), float(_attribute(item, "time"))))
    return generation
