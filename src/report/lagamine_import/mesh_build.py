"""From the mesh of a file to bodies of 8-node quadrilaterals and sets of sides, or to what is wrong with it."""
from dataclasses import dataclass, field
from typing import Dict, List, Sequence, Tuple

import numpy as np

from lagamine_report.geometry import CORNERS, SIDES

from .mistakes import Mistakes, at, count
from .names import Names
from .raw_mesh import LINES, QUADS, Cells, RawMesh

SAME_PLACE = 1e-6     # nodes nearer than this share of the shortest side are at the same place
FLAT = 1e-9           # the plane of a mesh holds its nodes to this share of its size
PLANES = {"XY": (0, 1, 2), "XZ": (0, 2, 1), "YZ": (1, 2, 0)}


@dataclass
class Body:
    """A card PL8LS: its name, its law, labels of elements, nodes (element, 8) from 0."""

    name: str
    law: str
    labels: np.ndarray
    nodes: np.ndarray


@dataclass
class Mesh:
    """Coordinates (node, 2), labels of nodes, bodies, sets of sides (label of element, side 1 to 4)."""

    points: np.ndarray
    labels: np.ndarray
    bodies: List[Body]
    sides: Dict[str, List[Tuple[int, int]]]
    notes: List[str] = field(default_factory=list)


@dataclass
class MeshWishes:
    """What the options say: sets that are bodies and those that are sides (none: found), sets left out, plane, scale, shift, bodies that touch stay apart."""

    name: str
    bodies: Sequence[str] = ()
    sides: Sequence[str] = ()
    without: Sequence[str] = ()
    plane: str = "XY"
    scale: float = 1.0
    shift: Tuple[float, float] = (0.0, 0.0)
    apart: bool = False


def build_mesh(raw: RawMesh, wishes: MeshWishes, names: Names, mistakes: Mistakes) -> Mesh:
    """The mesh for a deck; refused with all its mistakes at once."""
    builder = _Builder(raw, wishes, names, mistakes)
    return builder.build()


class _Builder:
    def __init__(self, raw: RawMesh, wishes: MeshWishes, names: Names, mistakes: Mistakes) -> None:
        self.raw, self.wishes, self.names, self.mistakes = raw, wishes, names, mistakes
        self.notes = list(raw.notes)
        self.middles: Dict[Tuple[int, int], int] = {}

    def build(self) -> Mesh:
        self._refuse_kinds()
        quads = [cells for cells in self.raw.cells if cells.kind in QUADS]
        if not quads and not self.mistakes.lines:
            self.mistakes.add("mesh", "there are no quadrilaterals: expected elements of 4 or 8 nodes in the plane")
        self.mistakes.refuse()
        self.points, self.labels = self._plane(quads), np.asarray(self.raw.labels)
        groups = self._bodies(quads)
        self.mistakes.refuse()
        nodes = np.concatenate([self._eight(cells) for cells in quads])
        labels = np.concatenate([cells.labels for cells in quads])
        nodes = self._counter_clockwise(nodes)
        self._refuse_folded(nodes, labels, groups)
        self._refuse_duplicates(nodes, groups)
        bodies = []
        for name in dict.fromkeys(groups):
            own = np.array([group == name for group in groups])
            shown = self.names.name(name, "body")
            bodies.append(Body(shown, self.raw.laws.get(name) or shown, labels[own], nodes[own]))
        sides = self._sides(nodes, labels)
        self.names.refuse_unknown()
        self.mistakes.refuse()
        return self._compact(bodies, sides)

    # ---- what is refused at once ----

    def _refuse_kinds(self) -> None:
        for cells in self.raw.cells:
            if cells.kind in QUADS or cells.kind in LINES or cells.kind.startswith("vertex"):
                continue
            sets = sorted({name for held in cells.sets for name in held})
            where = f"{cells.where}" + (f" '{sets[0]}'" if len(sets) == 1 and sets[0] not in cells.where else "")
            centre = self.raw.points[cells.nodes[0]].mean(axis=0)
            what = f"{count(len(cells.nodes), 'element')} of kind {cells.kind}, the first around {at(centre)}"
            if cells.kind.startswith("triangle"):
                self.mistakes.add(where, f"{what}: expected quadrilaterals only (in Gmsh: Recombine Surface)")
            elif cells.kind.startswith(("tetra", "hexahedron", "wedge", "pyramid", "C3D")):
                self.mistakes.add(where, f"{what}: a part in three dimensions; expected a section in the plane")
            else:
                self.mistakes.add(where, f"{what}: expected quadrilaterals of 4 or 8 nodes in the plane")
        for option, wanted in (("--body", self.wishes.bodies), ("--sides", self.wishes.sides), ("--without", self.wishes.without)):
            there = {name for cells in self.raw.cells for held in cells.sets for name in held} \
                | set(self.raw.sides) | set(self.raw.node_sets)
            for name in wanted:
                if name not in there:
                    self.mistakes.add(f"{option} {name}", "there is no such set"
                                      + (f"; there are: {', '.join(sorted(there))}" if there else ""))

    def _plane(self, quads: List[Cells]) -> np.ndarray:
        """Coordinates in the plane of the deck (node, 2)."""
        used = np.unique(np.concatenate([cells.nodes.ravel() for cells in quads]))
        held = self.raw.points[used]
        if not np.isfinite(held).all():
            self.mistakes.add("nodes", "a coordinate is not a finite number")
            self.mistakes.refuse()
        a, b, across = PLANES[self.wishes.plane]
        size = np.ptp(held, axis=0).max()
        off = np.abs(held[:, across] - held[0, across])
        if off.max() > FLAT * size:
            k = used[off.argmax()]
            self.mistakes.add(f"node {self.raw.labels[k]}", f"lies {off.max():.4g} off the plane {self.wishes.plane} of the others: expected a "
                              "section in one plane (--plane XY, XZ or YZ)")
        return self.raw.points[:, [a, b]] * self.wishes.scale + np.array(self.wishes.shift)

    def _bodies(self, quads: List[Cells]) -> List[str]:
        """The body of every element, by name."""
        chosen = set(self.wishes.bodies)
        result: List[str] = []
        for cells in quads:
            for e, held in enumerate(cells.sets):
                own = sorted(held & chosen if chosen else (held & self.raw.bodies if self.raw.bodies else held) - set(self.wishes.without))
                where = f"{cells.where}, element {cells.labels[e]}"
                if len(own) > 1:
                    self.mistakes.add(f"{cells.where}", f"elements belong to the sets '{own[0]}' and '{own[1]}': say which are bodies by --body NAME")
                elif chosen and not own:
                    self.mistakes.add(where, "belongs to none of the bodies of --body")
                elif not own and self.raw.laws:
                    self.mistakes.add(where, "has no *SOLID SECTION")
                result.append(own[0] if own else "")
        if any(result) and not all(result):
            self.mistakes.add("mesh", f"{count(result.count(''), 'element')} of {len(result)} belong to no set, the others to "
                              f"{', '.join(sorted(set(filter(None, result))))}: expected all in sets, or none")
        return [name or self.wishes.name for name in result]

    # ---- elements ----

    def _eight(self, cells: Cells) -> np.ndarray:
        """Nodes of 8-node elements; middle nodes of 4-node ones are made half-way."""
        nodes = cells.nodes[:, :QUADS[cells.kind]]
        if cells.kind == "quad9":
            self.notes.append(f"{cells.where}: the middle nodes of {count(len(nodes), 'element')} of 9 nodes are left out")
        if nodes.shape[1] == 8:
            return nodes
        self.notes.append(f"{cells.where}: {count(len(nodes), 'element')} of 4 nodes raised to 8, their sides straight")
        more: List[np.ndarray] = []
        first = len(self.points)
        result = np.empty((len(nodes), 8), dtype=int)
        result[:, :4] = nodes
        for e, corners in enumerate(nodes):
            for k in range(4):
                ends = tuple(sorted((int(corners[k]), int(corners[(k + 1) % 4]))))
                if ends not in self.middles:
                    self.middles[ends] = first + len(more)
                    more.append(0.5 * (self.points[ends[0]] + self.points[ends[1]]))
                result[e, 4 + k] = self.middles[ends]
        if more:
            self.points = np.vstack([self.points, more])
            top = int(self.labels.max())
            self.labels = np.concatenate([self.labels, np.arange(top + 1, top + 1 + len(more))])
        return result

    def _counter_clockwise(self, nodes: np.ndarray) -> np.ndarray:
        """Elements numbered clockwise are numbered the other way."""
        x = self.points[nodes[:, :4]]
        area = _cross(x[:, 2] - x[:, 0], x[:, 3] - x[:, 1])
        back = area < 0
        if back.any():
            nodes = nodes.copy()
            nodes[back] = nodes[back][:, [0, 3, 2, 1, 7, 6, 5, 4]]
            self.notes.append(f"{count(int(back.sum()), 'element')} were numbered clockwise: numbered the other way")
        return nodes

    def _refuse_folded(self, nodes: np.ndarray, labels: np.ndarray, groups: List[str]) -> None:
        """The Jacobian is above zero at corners and at 3 x 3 points."""
        gauss = np.array([-0.6**0.5, 0.0, 0.6**0.5])
        xi, eta = (grid.ravel() for grid in np.meshgrid(gauss, gauss))
        xi, eta = np.concatenate([xi, CORNERS[:, 0]]), np.concatenate([eta, CORNERS[:, 1]])
        dxi, deta = quad8_slopes(xi, eta)
        x = self.points[nodes]
        jacobian = _cross(np.einsum("pk,ekd->epd", dxi, x), np.einsum("pk,ekd->epd", deta, x)).min(axis=1)
        for e in np.flatnonzero(~(jacobian > 0)):
            self.mistakes.add(f"element {labels[e]} of '{groups[e]}' around {at(x[e].mean(axis=0))}",
                              f"it folds over: its Jacobian falls to {jacobian[e]:.3g}; expected it above zero")

    def _refuse_duplicates(self, nodes: np.ndarray, groups: List[str]) -> None:
        """No two nodes at the same place: of one body never, of two bodies only where they are said to stay apart."""
        used = np.unique(nodes)
        used = used[used < len(self.raw.points)]      # middle nodes made here are those of their corners
        owner = {}
        for row, group in zip(nodes, groups):
            for node in row:
                owner[int(node)] = group
        x = self.points[used]
        ends = self.points[nodes[:, [0, 1, 2, 3]]] - self.points[nodes[:, [1, 2, 3, 0]]]
        near = SAME_PLACE * np.hypot(ends[..., 0], ends[..., 1]).min()
        touching: Dict[Tuple[str, str], int] = {}
        for a, b in close_pairs(x, near):
            a, b = int(used[a]), int(used[b])
            bodies = tuple(sorted((owner[a], owner[b])))
            if bodies[0] != bodies[1]:
                touching[bodies] = touching.get(bodies, 0) + 1
            else:
                self.mistakes.add(f"nodes {self.labels[a]} and {self.labels[b]} of '{bodies[0]}'",
                                  f"are at the same place {at(self.points[a])}: expected one node (in Gmsh: Coherence Mesh)")
        for (a, b), number in touching.items():
            words = f"have {count(number, 'pair')} of nodes at the same places and are not joined"
            if self.wishes.apart:
                self.notes.append(f"'{a}' and '{b}' {words}")
            else:
                self.mistakes.add(f"bodies '{a}' and '{b}'", f"{words}: expected common nodes, or --apart where they only touch")

    # ---- sides ----

    def _sides(self, nodes: np.ndarray, labels: np.ndarray) -> Dict[str, List[Tuple[int, int]]]:
        """All named sets of sides, on the boundary of the elements."""
        owners: Dict[Tuple[int, int], List[Tuple[int, int]]] = {}
        for label, row in zip(labels, nodes):
            for k in range(4):
                owners.setdefault(tuple(sorted((int(row[k]), int(row[(k + 1) % 4])))), []).append((int(label), k + 1))
        result: Dict[str, List[Tuple[int, int]]] = {}
        for name, ends in self._named_lines().items():
            if not self._is_wanted(name):
                continue
            found, lost, inside = [], [], []
            for a, b in ends:
                own = owners.get(tuple(sorted((a, b))), [])
                (found if len(own) == 1 else inside if own else lost).append((a, b) if len(own) != 1 else own[0])
            for bad, words in ((lost, "are sides of no element"), (inside, "lie between elements, not on the boundary")):
                if bad:
                    a, b = bad[0]
                    self.mistakes.add(f"set '{name}'", f"{len(bad)} of {count(len(ends), 'line')} {words}, the first from "
                                      f"{at(self.points[a])} to {at(self.points[b])} (--without '{name}' leaves the set out)")
            if found:
                result[self.names.name(name, "set of sides")] = sorted(dict.fromkeys(found))
        for name, members in self.raw.node_sets.items():
            if not self._is_wanted(name):
                continue
            held = set(int(node) for node in members)
            found = [own[0] for ends, own in owners.items() if len(own) == 1 and held.issuperset(ends)]
            if found:
                result[self.names.name(name, "set of nodes")] = sorted(found)
            elif name in self.wishes.sides:
                self.mistakes.add(f"set of nodes '{name}'", "it has all nodes of no side of the boundary")
            else:
                self.notes.append(f"the set of nodes '{name}' ({count(len(held), 'node')}) has no side of an element: left out")
        return result

    def _is_wanted(self, name: str) -> bool:
        return name not in self.wishes.without and (not self.wishes.sides or name in self.wishes.sides)

    def _named_lines(self) -> Dict[str, List[Tuple[int, int]]]:
        """Ends of the sides of every set: lines of the mesh and surfaces."""
        lines: Dict[str, List[Tuple[int, int]]] = {name: list(ends) for name, ends in self.raw.sides.items()}
        for cells in self.raw.cells:
            if cells.kind not in LINES:
                continue
            for row, held in zip(cells.nodes, cells.sets):
                for name in held:
                    lines.setdefault(name, []).append((int(row[0]), int(row[1])))
        return lines

    def _compact(self, bodies: List[Body], sides) -> Mesh:
        """Only nodes that elements use."""
        used = np.unique(np.concatenate([body.nodes.ravel() for body in bodies]))
        place = np.full(len(self.points), -1)
        place[used] = np.arange(len(used))
        left = len(self.raw.points) - int((used < len(self.raw.points)).sum())
        if left:
            self.notes.append(f"{count(left, 'node')} of no element: left out")
        for body in bodies:
            body.nodes = place[body.nodes]
        return Mesh(self.points[used], self.labels[used], bodies, sides, self.notes)


def quad8_slopes(xi: np.ndarray, eta: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
    """Derivatives of the 8 shape functions (lagamine_report.geometry.quad8) by both parent coordinates (point, 8)."""
    a, b = CORNERS[:, 0], CORNERS[:, 1]
    xi, eta = np.asarray(xi, dtype=float)[:, None], np.asarray(eta, dtype=float)[:, None]
    dxi = 0.25 * a * (1 + b * eta) * (2 * a * xi + b * eta)
    deta = 0.25 * b * (1 + a * xi) * (2 * b * eta + a * xi)
    middle_xi = [-xi * (1 - eta), 0.5 * (1 - eta**2), -xi * (1 + eta), -0.5 * (1 - eta**2)]
    middle_eta = [-0.5 * (1 - xi**2), -eta * (1 + xi), 0.5 * (1 - xi**2), -eta * (1 - xi)]
    return np.hstack([dxi] + middle_xi), np.hstack([deta] + middle_eta)


def close_pairs(x: np.ndarray, near: float) -> List[Tuple[int, int]]:
    """Pairs of points (point, 2) nearer to each other than a distance, each once."""
    along = x @ np.array([0.8, 0.6])       # a direction in which few rows of nodes lie
    order = np.argsort(along, kind="stable")
    pairs = []
    for k, a in enumerate(order):
        for b in order[k + 1:]:
            if along[b] - along[a] > near:
                break
            if np.hypot(*(x[b] - x[a])) <= near:
                pairs.append((int(min(a, b)), int(max(a, b))))
    return sorted(pairs)


def boundary_curves(mesh: Mesh) -> np.ndarray:
    """Sides of the outline: nodes (side, 3)."""
    sides = np.concatenate([body.nodes for body in mesh.bodies])[:, SIDES].reshape(-1, 3)
    _, first, number = np.unique(sides[:, 1], return_index=True, return_counts=True)
    return sides[first[number == 1]]


def _cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
