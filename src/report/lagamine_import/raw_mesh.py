"""A mesh as a file holds it, before it is judged."""
from dataclasses import dataclass, field
from typing import Dict, List, Set, Tuple

import numpy as np

LINES = {"line": 2, "line3": 3}
QUADS = {"quad": 4, "quad8": 8, "quad9": 8}      # nodes that are used: the middle of a quad9 is left out


@dataclass
class Cells:
    """Elements of one kind and place: kind as meshio names it, nodes (element, node) from 0, labels (element)."""

    kind: str
    nodes: np.ndarray
    labels: np.ndarray
    where: str                 # as messages name it: surface 3, *ELEMENT of line 12
    sets: List[Set[str]] = field(default_factory=list)      # names of the sets of each element

    def __post_init__(self) -> None:
        if not self.sets:
            self.sets = [set() for _ in self.nodes]


@dataclass
class RawMesh:
    """Points (node, 3) and the labels of nodes, elements, sides by the nodes at their ends, sets of nodes; the sets that are bodies
    (none: all that have quadrilaterals) and the laws of bodies."""

    points: np.ndarray
    labels: np.ndarray
    cells: List[Cells] = field(default_factory=list)
    sides: Dict[str, List[Tuple[int, int]]] = field(default_factory=dict)
    node_sets: Dict[str, np.ndarray] = field(default_factory=dict)
    bodies: Set[str] = field(default_factory=set)
    laws: Dict[str, str] = field(default_factory=dict)
    notes: List[str] = field(default_factory=list)
