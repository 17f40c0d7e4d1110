"""How deep the sides of a part are in a die: every side sampled densely, against the exact curve of parabolas.

Independent of the solver's search: every place of every piece where the distance is stationary (roots of a cubic), and every
vertex, is tried. The nearest shows whether the point is inside the die's body, which is at the right of the curve.
"""
import h5py
import numpy


def shape(xi):
    """Shape functions of three points at places xi."""
    return numpy.array([0.5 * xi * (xi - 1), 1 - xi * xi, 0.5 * xi * (xi + 1)])


def cross(a, b):
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def depth(pieces, point):
    """Depth of a point below the nearest point of a curve, negative outside; nan when that is beyond an open end."""
    a = 0.5 * (pieces[:, 0] + pieces[:, 2]) - pieces[:, 1]
    b = 0.5 * (pieces[:, 2] - pieces[:, 0])
    c = pieces[:, 1]
    best, found = numpy.inf, numpy.nan
    for k in range(len(pieces)):
        d = c[k] - point
        roots = numpy.roots([2 * a[k] @ a[k], 3 * a[k] @ b[k], b[k] @ b[k] + 2 * d @ a[k], d @ b[k]])
        for xi in [x.real for x in roots if abs(x.imag) < 1e-9 and abs(x.real) < 1]:
            way = point - (c[k] + b[k] * xi + a[k] * xi * xi)
            distance = numpy.hypot(*way)
            if distance < best:
                best, found = distance, -numpy.sign(cross(b[k] + 2 * a[k] * xi, way)) * distance
    closed = numpy.allclose(pieces[0, 0], pieces[-1, 2], rtol=0, atol=1e-12)
    for k in range(len(pieces) + 1):
        vertex = pieces[k, 0] if k < len(pieces) else pieces[-1, 2]
        distance = numpy.hypot(*(point - vertex))
        if distance >= best - 1e-12:
            continue
        best = distance
        if k in (0, len(pieces)) and not closed:
            found = numpy.nan
            continue
        before, after = b[k - 1] + 2 * a[k - 1], b[k % len(pieces)] - 2 * a[k % len(pieces)]
        found = distance * numpy.sign(cross(before, after))
    return found


def sampled(path, number=65):
    """Of every saved step and contact group: step, name, deepest sample over the side's first chord, depth, least pressure."""
    rows = []
    with h5py.File(path, "r") as file:
        first = file["mesh/coordinates"][()]
        dies = {file["dies"][name].attrs["number"]: (name, file["dies"][name][()]) for name in file["dies"]}
        xi = numpy.linspace(-1, 1, number)
        for step in sorted(file["steps"]):
            place = file["steps"][step]
            for g, group in sorted(file["mesh/groups"].items()):
                elem = group.attrs["elem"]
                if (elem.decode() if isinstance(elem, bytes) else elem) != "CNT2D":
                    continue
                name = group.attrs["name"]
                name = name.decode() if isinstance(name, bytes) else name
                number_of_die = next(k for k, (die, _) in dies.items() if name.endswith("/" + die))
                pieces, pilot = dies[number_of_die][1], place["pilots"][number_of_die - 1]
                names = [word.decode() if isinstance(word, bytes) else word for word in place[f"points/{g}/components"][()]]
                state = place[f"points/{g}/state"][()]
                pressures = state[:, :, [k for k, word in enumerate(names) if word in ("pressure", "corner_pressure")]]
                turn = numpy.array([[numpy.cos(pilot[2]), -numpy.sin(pilot[2])], [numpy.sin(pilot[2]), numpy.cos(pilot[2])]])
                worst = share = 0.0
                where = None
                for nodes in group["connectivity"][()]:
                    x = (place["coordinates"][()][nodes] - pilot[:2]) @ turn
                    side = numpy.hypot(*(first[nodes[2]] - first[nodes[0]]))
                    for value, point in zip(xi, shape(xi).T @ x):
                        d = depth(pieces, point)
                        if d > worst:
                            worst, where = d, (nodes.tolist(), round(float(value), 3))
                        share = max(share, d / side) if d == d else share
                rows.append({"step": int(step), "time": float(place.attrs["time"]), "group": name, "depth": worst, "share": share,
                             "where": where, "least_pressure": float(pressures.min()), "most_pressure": float(pressures.max())})
    return rows
