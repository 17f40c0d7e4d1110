"""Shapes: sides of 8-node elements as parabolas, elements cut into triangles, dies and their bodies."""
from typing import Dict, List, Tuple

import numpy as np

# Ends and middle of the four sides, walking counter-clockwise; parent coordinates of the corners.
SIDES = np.array([[0, 4, 1], [1, 5, 2], [2, 6, 3], [3, 7, 0]])
CORNERS = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
GAUSS = {1: [0.0], 2: [-3**-0.5, 3**-0.5], 3: [-0.6**0.5, 0.0, 0.6**0.5],
         4: [-0.8611363115940526, -0.3399810435848563, 0.3399810435848563, 0.8611363115940526]}
LOBATTO_3 = [-1.0, 0.0, 1.0]


def quad8(xi: np.ndarray, eta: np.ndarray) -> np.ndarray:
    """Serendipity shape functions (point, 8), nodes as in the solver: corners, then middles of the sides."""
    a, b = CORNERS[:, 0], CORNERS[:, 1]
    xi, eta = np.asarray(xi)[:, None], np.asarray(eta)[:, None]
    corner = 0.25 * (1 + a * xi) * (1 + b * eta) * (a * xi + b * eta - 1)
    middle = [0.5 * (1 - xi**2) * (1 - eta), 0.5 * (1 - eta**2) * (1 + xi),
              0.5 * (1 - xi**2) * (1 + eta), 0.5 * (1 - eta**2) * (1 - xi)]
    return np.hstack([corner] + middle)


def line3(xi) -> np.ndarray:
    """Shape functions of a 3-node side (point, 3): end, middle, end."""
    xi = np.asarray(xi, dtype=float)
    return np.stack([0.5 * xi * (xi - 1), 1 - xi**2, 0.5 * xi * (xi + 1)], axis=-1)


def side_points(npoint: int, found: int) -> np.ndarray:
    """Parent coordinates of the integration points of a side; `npoint` as in the deck, 0 when the file does not give it."""
    return np.array(LOBATTO_3 if npoint == -3 else GAUSS.get(found, np.linspace(-1, 1, found)))


def areas(x: np.ndarray, topology: np.ndarray) -> np.ndarray:
    """Areas of elements (element, 8) of nodes x (node, 2), by polygons."""
    loop = x[topology[:, [0, 4, 1, 5, 2, 6, 3, 7]]]
    after = np.roll(loop, -1, axis=1)
    return 0.5 * np.abs((loop[..., 0] * after[..., 1] - loop[..., 1] * after[..., 0]).sum(axis=1))


def element_thickness(x: np.ndarray, topology: np.ndarray) -> float:
    """The shorter way across elements, in the median."""
    ways = [np.hypot(*(x[topology[:, one]] - x[topology[:, other]]).T) for one, other in ((4, 6), (5, 7))]
    return float(np.median(np.minimum(*ways)))


def part_thickness(x: np.ndarray, topology: np.ndarray, outline: np.ndarray) -> float:
    """Twice the area over the length of the outline (side, 3): of a strip its thickness, of a square half its side."""
    return 2 * areas(x, topology).sum() / max(np.hypot(*(x[outline[:, 2]] - x[outline[:, 0]]).T).sum(), 1e-300)


class Triangles:
    """Elements cut into small triangles on which the 8-node shape functions are followed; half as many along a side where the picture is small."""

    def __init__(self, topology: np.ndarray, nodes: int, small: bool = False) -> None:
        n = (6 if len(topology) < 800 else 4 if len(topology) < 4000 else 2) // (2 if small else 1)
        i, j = np.meshgrid(np.arange(n + 1), np.arange(n + 1), indexing="xy")
        i, j = i.ravel(), j.ravel()
        self.topology = topology
        self.phi = quad8(2 * i / n - 1, 2 * j / n - 1)
        keys = self._keys(topology, nodes, n, i, j)
        _, self.first, weld = np.unique(keys.ravel(), return_index=True, return_inverse=True)
        self.points = weld.reshape(keys.shape)
        corner = (j * (n + 1) + i)[(i < n) & (j < n)]
        right, up, both = corner + 1, corner + n + 1, corner + n + 2
        local = np.concatenate([np.stack([corner, right, both], 1), np.stack([corner, both, up], 1)])
        self.cells = self.points[:, local].reshape(-1, 3)

    @staticmethod
    def _keys(topology: np.ndarray, nodes: int, n: int, i: np.ndarray, j: np.ndarray) -> np.ndarray:
        """Numbers equal for the same point of neighbours: by node, by middle node and position on the side, or its own."""
        count = len(i)
        keys = nodes * (n + 2) + np.arange(len(topology) * count).reshape(len(topology), count)
        on_side = [(j == 0, i), (i == n, j), (j == n, n - i), (i == 0, n - j)]
        for (a, m, b), (mask, along) in zip(SIDES, on_side):
            places = np.flatnonzero(mask & (along > 0) & (along < n))
            forward = (topology[:, a] < topology[:, b])[:, None]
            place = np.where(forward, along[places], n - along[places])
            keys[:, places] = nodes + topology[:, m][:, None] * n + place
        for k, (x, y) in enumerate(CORNERS):
            place = np.flatnonzero((i == (x + 1) * n // 2) & (j == (y + 1) * n // 2))[0]
            keys[:, place] = topology[:, k]
        return keys

    def at(self, nodal: np.ndarray) -> np.ndarray:
        """Nodal values carried to the points of the triangles; of one or two columns."""
        return self._welded(np.einsum("pk,ek...->ep...", self.phi, nodal[self.topology]))

    def bounded(self, nodal: np.ndarray) -> np.ndarray:
        """The same of one column, within the range of the nodes of each element: a parabola goes beyond it between them."""
        of_nodes = nodal[self.topology]
        return self._welded(np.clip(of_nodes @ self.phi.T, of_nodes.min(axis=1)[:, None], of_nodes.max(axis=1)[:, None]))

    def _welded(self, values: np.ndarray) -> np.ndarray:
        """Values (element, point, ...) at the points of all elements, each once."""
        return values.reshape((-1,) + values.shape[2:])[self.first]


def side_curves(x: np.ndarray, sides: np.ndarray, n: int = 8) -> np.ndarray:
    """Points along parabolas through three nodes (side, point, 2)."""
    return np.einsum("pk,skd->spd", line3(np.linspace(-1, 1, n + 1)), x[sides])


def element_curves(x: np.ndarray, topology: np.ndarray) -> np.ndarray:
    """Points around every element (element, point, 2), counter-clockwise, not closed."""
    return np.concatenate([side_curves(x, topology[:, side])[:, :-1] for side in SIDES], axis=1)


def element_sizes(curves: np.ndarray) -> np.ndarray:
    """Square roots of the areas inside closed polygons of points (element, point, 2)."""
    following = np.roll(curves, -1, axis=1)
    twice = (curves[..., 0] * following[..., 1] - curves[..., 1] * following[..., 0]).sum(axis=1)
    return np.sqrt(0.5 * np.abs(twice))


def all_sides(topology: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
    """Sides of all elements, each once, and those of the outline (they belong to one element)."""
    sides = topology[:, SIDES].reshape(-1, 3)
    _, first, count = np.unique(sides[:, 1], return_index=True, return_counts=True)
    return sides[first], sides[first[count == 1]]


def curves_of_sides(sides: np.ndarray) -> List[List[int]]:
    """Sides joined end to end: lists of their numbers, one list per connected curve."""
    start: Dict[int, int] = {int(side[0]): k for k, side in enumerate(sides)}
    ends = {int(side[2]) for side in sides}
    left = dict.fromkeys(range(len(sides)))
    result = []
    heads = [k for k in left if int(sides[k][0]) not in ends] + list(left)
    for head in heads:
        connected, k = [], head
        while k is not None and k in left:
            del left[k]
            connected.append(k)
            k = start.get(int(sides[k][2]))
        if connected:
            result.append(connected)
    return result


def die_curve(pieces: np.ndarray, pilot: np.ndarray, n: int = 16) -> np.ndarray:
    """The curve of parabolas of a die at the position of its pilot (point, 2)."""
    local = np.einsum("pk,skd->spd", line3(np.linspace(-1, 1, n + 1)), pieces).reshape(-1, 2)
    c, s = np.cos(pilot[2]), np.sin(pilot[2])
    curve = local @ np.array([[c, s], [-s, c]]) + pilot[:2]
    keep = np.ones(len(curve), dtype=bool)
    keep[1:] = np.abs(np.diff(curve, axis=0)).sum(axis=1) > 0
    return curve[keep]


def die_body(curve: np.ndarray, thickness: float) -> np.ndarray:
    """Outline of a band of the die's body, which is on the right of the curve."""
    tangent = np.diff(curve, axis=0)
    tangent /= np.hypot(*tangent.T)[:, None]
    normal = np.stack([tangent[:, 1], -tangent[:, 0]], axis=1)
    before, after = np.vstack([normal[:1], normal]), np.vstack([normal, normal[-1:]])
    if np.allclose(curve[0], curve[-1]):
        before[0], after[-1] = normal[-1], normal[0]
    mean = before + after
    share = np.maximum((mean**2).sum(axis=1) / 2, 0.35)     # 1 + cos of the turn: a mitre, not too long a one
    return np.vstack([curve, (curve + thickness * mean / share[:, None])[::-1]])


def hatching(curve: np.ndarray, spacing: float, length: float) -> np.ndarray:
    """Strokes at 45 degrees on the right of a curve, where a die's body is (stroke, 2, 2)."""
    chord = np.diff(curve, axis=0)
    along = np.concatenate([[0], np.cumsum(np.hypot(*chord.T))])
    count = max(int(along[-1] / spacing), 2)
    places = (np.arange(count) + 0.5) * along[-1] / count
    k = np.clip(np.searchsorted(along, places, side="right") - 1, 0, len(chord) - 1)
    tangent = chord[k] / np.hypot(*chord[k].T)[:, None]
    foot = curve[k] + (places - along[k])[:, None] * tangent
    stroke = np.stack([tangent[:, 1] - tangent[:, 0], -tangent[:, 0] - tangent[:, 1]], axis=1) / 2**0.5
    return np.stack([foot, foot + length * stroke], axis=1)
