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


def stationary(a, b, d):
    """Places between -1 and 1 where the distance of each point from a parabola is stationary, nan for those that are none: (n, 3), of
    a straight line (n, 1). `d` is the middle of the parabola less the points, (n, 2)."""
    cubic = numpy.stack([numpy.full(len(d), 2 * a @ a), numpy.full(len(d), 3 * a @ b), b @ b + 2 * d @ a, d @ b], axis=1)
    if not a.any():
        xi = -cubic[:, 3:] / cubic[:, 2:3] + 0j
    else:
        companion = numpy.zeros((len(d), 3, 3))
        companion[:, 0] = -cubic[:, 1:] / cubic[:, :1]
        companion[:, 1, 0] = companion[:, 2, 1] = 1
        xi = numpy.linalg.eigvals(companion)
    return numpy.where((abs(xi.imag) < 1e-9) & (abs(xi.real) < 1), xi.real, numpy.nan)


def depths(pieces, points):
    """Depth of points (n, 2) below the nearest point of a curve, negative outside; nan when that is beyond an open end."""
    a = 0.5 * (pieces[:, 0] + pieces[:, 2]) - pieces[:, 1]
    b = 0.5 * (pieces[:, 2] - pieces[:, 0])
    c = pieces[:, 1]
    best, found = numpy.full(len(points), numpy.inf), numpy.full(len(points), numpy.nan)
    for k in range(len(pieces)):
        for xi in stationary(a[k], b[k], c[k] - points).T[:, :, None]:
            way = points - (c[k] + b[k] * xi + a[k] * xi * xi)
            distance = numpy.hypot(way[:, 0], way[:, 1])
            nearer = distance < best        # false for nan
            found = numpy.where(nearer, -numpy.sign(cross(b[k] + 2 * a[k] * xi, way)) * distance, found)
            best = numpy.where(nearer, distance, best)
    closed = numpy.allclose(pieces[0, 0], pieces[-1, 2], rtol=0, atol=1e-12)
    for k in range(len(pieces) + 1):
        way = points - (pieces[k, 0] if k < len(pieces) else pieces[-1, 2])
        distance = numpy.hypot(way[:, 0], way[:, 1])
        nearer = distance < best - 1e-12
        best = numpy.where(nearer, distance, best)
        if k in (0, len(pieces)) and not closed:
            found = numpy.where(nearer, numpy.nan, found)
            continue
        before, after = b[k - 1] + 2 * a[k - 1], b[k % len(pieces)] - 2 * a[k % len(pieces)]
        found = numpy.where(nearer, distance * numpy.sign(cross(before, after)), found)
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
                connectivity, coordinates = group["connectivity"][()], place["coordinates"][()]
                points = numpy.concatenate([shape(xi).T @ ((coordinates[nodes] - pilot[:2]) @ turn) for nodes in connectivity])
                found = depths(pieces, points)
                side = numpy.repeat([numpy.hypot(*(first[nodes[2]] - first[nodes[0]])) for nodes in connectivity], number)
                share = max(0.0, *(found / side)[~numpy.isnan(found)])
                found = numpy.where(found > 0, found, 0.0)      # nan too
                k = int(found.argmax())
                worst = float(found[k])
                where = (connectivity[k // number].tolist(), round(float(xi[k % number]), 3)) if worst > 0 else None
                rows.append({"step": int(step), "time": float(place.attrs["time"]), "group": name, "depth": worst, "share": share,
                             "where": where, "least_pressure": float(pressures.min()), "most_pressure": float(pressures.max())})
    return rows
