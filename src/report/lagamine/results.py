"""A run's results as numpy arrays. Files and layout: decks/RESULTS.md."""
from dataclasses import dataclass
from typing import Dict, List, Optional

import numpy as np

from lagamine_report import profiles
from lagamine_report.errors import ReportError
from lagamine_report.geometry import GAUSS, die_curve, quad8
from lagamine_report.reader import Run, Step


@dataclass
class Points:
    """Integration points of a body or a contact: `names` of the components, `state` (element, point, component); `x` (element, point, 2) of
    bodies, none for contacts."""

    names: List[str]
    state: np.ndarray
    x: Optional[np.ndarray]

    def __getitem__(self, name: str) -> np.ndarray:
        """A component (element, point)."""
        if name not in self.names:
            raise ReportError(f"no component '{name}'; there are: {', '.join(self.names)}")
        return self.state[:, :, self.names.index(name)]


class Results:
    """What a run has written into its folder; instants are numbered from 0, -1 is the last."""

    def __init__(self, folder: str) -> None:
        self._run = Run(folder)
        self.summary = self._run.summary
        self.title = self._run.title
        self.dies = list(self._run.die_names)

    @property
    def history(self) -> Dict[str, np.ndarray]:
        """Columns of history.csv by name (without unit), a value an accepted step."""
        return {name: column.values for name, column in self._run.history.items()}

    @property
    def units(self) -> Dict[str, str]:
        """Units of the columns of the history."""
        return {name: column.unit for name, column in self._run.history.items()}

    def history_frame(self):
        """The history as a pandas frame; pandas must be there."""
        import pandas
        return pandas.DataFrame(self.history)

    @property
    def times(self) -> np.ndarray:
        """Times of the saved instants."""
        return np.array([step.time for step in self._run.steps])

    @property
    def meshes(self) -> np.ndarray:
        """Number of the mesh at each saved instant."""
        return np.array([step.generation.number for step in self._run.steps])

    def instant(self, time: float) -> int:
        """The number of the saved instant nearest to a time."""
        return int(np.abs(self.times - time).argmin())

    def field_names(self, k: int = -1) -> List[str]:
        """Fields at the nodes at an instant."""
        return list(self._run.names(self._step(k), "node"))

    def field(self, name: str, k: int = -1) -> np.ndarray:
        """A field at the nodes: (node,), of a vector (node, 3)."""
        step = self._step(k)
        if name not in self._run.names(step, "node"):
            raise ReportError(f"no field '{name}'; there are: {', '.join(self.field_names(k))}")
        return self._run.read(step, f"node/{name}")

    def element_field(self, name: str, k: int = -1) -> np.ndarray:
        """A value an element (element,): the errors, where the deck asks for them."""
        step = self._step(k)
        if name not in self._run.names(step, "element"):
            raise ReportError(f"no field '{name}' of elements; there are: {', '.join(self._run.names(step, 'element')) or 'none'}")
        return self._run.read(step, f"element/{name}")

    def coordinates(self, k: int = -1) -> np.ndarray:
        """Where the nodes are (node, 2)."""
        return self._run.coordinates(self._step(k))

    def elements(self, k: int = -1) -> np.ndarray:
        """Nodes of the elements from 0 (element, 8): corners counter-clockwise, then middles."""
        return self._step(k).generation.topology

    def groups(self, k: int = -1) -> List[str]:
        """Names of bodies and contacts."""
        return [group.name for group in self._step(k).generation.groups]

    def points(self, group: str, k: int = -1) -> Points:
        """The state at the integration points of a body or a contact."""
        step = self._step(k)
        held = {one.name: one for one in step.generation.groups}
        if group not in held:
            raise ReportError(f"no group '{group}'; there are: {', '.join(held)}")
        found = self._run.points(step, held[group])
        if found is None:
            raise ReportError(f"the group '{group}' has no state at points")
        nodes, x = held[group].connectivity, None
        side = {4: 2, 9: 3}.get(found[1].shape[1])
        if nodes.shape[1] == 8 and side:
            # along xi first, as the solver counts them
            eta, xi = (grid.ravel() for grid in np.meshgrid(GAUSS[side], GAUSS[side], indexing="ij"))
            x = np.einsum("pk,ekd->epd", quad8(xi, eta), self._run.coordinates(step)[nodes])
        return Points(found[0], found[1], x)

    def line(self, x1: float, y1: float, x2: float, y2: float, *fields: str, k: int = -1, places: int = profiles.PLACES) -> Dict[str, np.ndarray]:
        """Fields at the nodes along a straight line through the shape at an instant: `length`, `x`, `y` of the places within the bodies, and
        each field."""
        step = self._step(k)
        for name in fields:
            if name not in self._run.names(step, "node"):
                raise ReportError(f"no field '{name}'; there are: {', '.join(self.field_names(k))}")
        return _columns(profiles.along_line(self._run, step, (x1, y1, x2, y2), fields, places))

    def side(self, contact: str, k: int = -1) -> Dict[str, np.ndarray]:
        """What the points of a contact hold, along its sides at an instant: `length`, `x`, `y`, `pressure`, `friction`, ..."""
        return _columns(profiles.along_sides(self._run, self._step(k), contact))

    def die(self, name: str, k: int = -1) -> np.ndarray:
        """Points along a die where it stands (point, 2); its part is on the left."""
        step = self._step(k)
        if name not in step.generation.dies:
            raise ReportError(f"no die '{name}'; there are: {', '.join(self.dies)}")
        return die_curve(step.generation.dies[name], self._run.pilots(step)[name])

    def grid(self, k: int = -1):
        """The mesh with its fields as a pyvista grid of quadratic quadrilaterals; pyvista must be there."""
        import pyvista
        nodes, x = self.elements(k), self.coordinates(k)
        cells = np.hstack([np.full((len(nodes), 1), 8), nodes]).ravel()
        grid = pyvista.UnstructuredGrid(cells, np.full(len(nodes), 23), np.hstack([x, np.zeros((len(x), 1))]))
        for name in self.field_names(k):
            grid.point_data[name] = self.field(name, k)
        return grid

    def _step(self, k: int) -> Step:
        steps = self._run.steps
        if not -len(steps) <= k < len(steps):
            raise ReportError(f"no saved instant {k}: there are {len(steps)}")
        return steps[k]


def _columns(profile: profiles.Profile) -> Dict[str, np.ndarray]:
    return {"length": profile.length, "x": profile.x[:, 0], "y": profile.x[:, 1], **profile.values}


def open_run(folder: str) -> Results:
    """The results in a folder; what is missing or damaged is refused by name (LagamineError)."""
    return Results(folder)
