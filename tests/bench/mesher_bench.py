#!/usr/bin/env python3
"""Quality of meshes without zones: twenty outlines, by the free mesher and, where it is there, by Gmsh.

usage: mesher_bench.py [--draw DIR] [NAME...]

Printed are elements, smallest angle [degrees], smallest scaled Jacobian, attempts and seconds of each, and the sharpest corner of the
outline; `--draw` writes a picture of each mesh of the free mesher, NAME.png, beside Gmsh's. Ends with 1 where the free mesher makes more
elements, a smaller angle or scaled Jacobian than Gmsh, beyond a hundredth, or one below 20 degrees or .25 at no such corner.
"""
import math
import os
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
BIN = os.path.abspath(os.environ.get("LAGAMINE_BIN") or os.path.join(ROOT, "build", "bin"))
PROGRAM = os.path.join(os.path.dirname(BIN), "tests", "mesher_bench")
GMSH = os.environ.get("REMDATA_GMSH") or os.path.join(BIN, "remdata_gmsh")


def line(*points, close=True):
    """Straight pieces through points."""
    ends = list(zip(points, points[1:] + (points[:1] if close else ())))
    return [(a, ((a[0] + b[0]) / 2, (a[1] + b[1]) / 2), b) for a, b in ends]


def arc(x, y, r, begin, end, pieces):
    """A circle's arc from one angle to another [degrees]."""
    def at(angle):
        return x + r * math.cos(math.radians(angle)), y + r * math.sin(math.radians(angle))
    step = (end - begin) / pieces
    return [(at(begin + k * step), at(begin + (k + .5) * step), at(begin + (k + 1) * step)) for k in range(pieces)]


def joined(*pieces):
    """Pieces end to end, with straight ones in between where they do not meet."""
    out = []
    for part in pieces:
        if out and math.dist(out[-1][2], part[0][0]) > 1e-9:
            out += line(out[-1][2], part[0][0], close=False)
        out += part
    if math.dist(out[-1][2], out[0][0]) > 1e-9:
        out += line(out[-1][2], out[0][0], close=False)
    return out


def wave(f, n, lower):
    """The region between y = lower and y = f(x), x from 0 to n parts of 1."""
    top = [((k + 1, f(k + 1)), (k + .5, f(k + .5)), (k, f(k))) for k in reversed(range(n))]
    return joined(line((0., lower), (float(n), lower), close=False), top)


def gear(teeth, root, tip):
    """A sector with teeth: involute-like flanks as parabolas, fillets at the roots."""
    pieces = []
    pitch = 60. / teeth
    for k in range(teeth):
        a = 60. - k * pitch
        def at(r, angle):
            return r * math.cos(math.radians(angle)), r * math.sin(math.radians(angle))
        pieces += [(at(root, a), at(root, a - .1 * pitch), at(root, a - .2 * pitch)),
                   (at(root, a - .2 * pitch), at((root + tip) / 2, a - .29 * pitch), at(tip, a - .36 * pitch)),
                   (at(tip, a - .36 * pitch), at(tip, a - .5 * pitch), at(tip, a - .64 * pitch)),
                   (at(tip, a - .64 * pitch), at((root + tip) / 2, a - .71 * pitch), at(root, a - .8 * pitch)),
                   (at(root, a - .8 * pitch), at(root, a - .9 * pitch), at(root, a - pitch))]
    return [tuple(reversed(p)) for p in reversed(pieces)]


def outlines():
    """Name: contours, smallest and largest size, places with sizes, corner that is sharper itself [degrees]."""
    square = line((0., 0.), (10., 0.), (10., 10.), (0., 10.))
    disc = arc(0, 0, 5, 0, 360, 12)
    hole = list
    def circle_hole(x, y, r, n=8):
        return arc(x, y, r, 0, -360, n)
    profile_h = line((0., 0.), (12., 0.), (12., 3.), (7.5, 3.), (7.5, 9.), (12., 9.), (12., 12.), (0., 12.), (0., 9.), (4.5, 9.),
                     (4.5, 3.), (0., 3.))
    rib = joined(line((0., 0.), (20., 0.), (20., 2.), (7., 2.), close=False), arc(7, 4, 2, 270, 180, 3),
                 line((5., 4.), (4., 14.), close=False), arc(2.5, 14, 1.5, 0, 90, 3), line((2.5, 15.5), (0., 15.5), close=False))
    flash = joined(line((0., 0.), (14., 0.), (14.5, .45), (24., .45), (24., .95), (14.5, .95), close=False),
                   line((13., 3.), (12., 7.), (0., 8.), close=False))
    billet = wave(lambda x: 8 + .8 * math.sin(.7 * x) + .3 * math.cos(2.1 * x), 12, 0.)
    worn = joined(line((0., 0.), (9., 0.), close=False), [((9., 0.), (11.2, 1.0), (11.8, 3.)), ((11.8, 3.), (12.1, 4.5), (11.6, 6.)),
                  ((11.6, 6.), (10.6, 8.), (8.6, 8.6))], line((8.6, 8.6), (0., 8.6), close=False))
    return {
        "rectangle": ([line((0., 0.), (17., 0.), (17., 6.), (0., 6.))], .1, .8, [], 90),
        "square": ([square], .1, .61, [], 90),
        "disc": ([disc], .1, .6, [], 180),
        "half disc": ([joined(arc(0, 0, 5, 0, 180, 6))], .1, .5, [], 90),
        "annulus": ([disc, circle_hole(0, 0, 2)], .1, .5, [], 180),
        "L": ([line((0., 0.), (9., 0.), (9., 4.), (4., 4.), (4., 10.), (0., 10.))], .1, .7, [], 90),
        "H section": ([profile_h], .1, .6, [], 90),
        "T rounded": ([joined(line((0., 0.), (4., 0.), (4., 6.), close=False), arc(5, 6, 1, 180, 90, 3),
                              line((5., 7.), (9., 7.), (9., 10.), (0., 10.), close=False))], .1, .5, [], 90),
        "gear sector": ([joined(gear(5, 18., 22.), line((9., 15.588457268), (7., 12.124355653), (14., 0.), (18., 0.), close=False)[:2],
                                line((14., 0.), (18., 0.), close=False))], .1, .8, [], 60),
        "tooth": ([joined(line((-4., 0.), (4., 0.), (4., 3.), close=False), arc(4, 4, 1, 270, 190, 2),
                          line((3.0151922469877917, 3.826351822333070), (1.2, 9.), (-1.2, 9.), (-3.0151922469877917, 3.826351822333070),
                               close=False), arc(-4, 4, 1, 350, 270, 2))], .1, .5, [], 90),
        "rib": ([rib], .1, .7, [], 80),
        "thin flash": ([flash], .1, .8, [], 80),
        "plate with holes": ([square, circle_hole(3, 3.4, 1.1), circle_hole(7.2, 6.1, 1.6), circle_hole(2.6, 8, .7)], .1, .5, [], 90),
        "disc, hole off centre": ([disc, circle_hole(2.4, .6, 1.7)], .1, .5, [], 180),
        "wedge 30": ([line((0., 0.), (10., 0.), (10., 5.7735026919))], .1, .5, [], 30),
        "triangle": ([line((0., 0.), (8., 0.), (4., 6.9282032303))], .1, .55, [], 60),
        "graded 1:20": ([square], .04, .8, [(0., 0., .04, .2), (7., 6., .06, .3)], 90),
        "wavy billet": ([billet], .15, .7, [], 80),
        "worn billet": ([worn], .1, .55, [], 80),
        "star": ([line(*[((4 if k % 2 else 8) * math.cos(math.pi * k / 6), (4 if k % 2 else 8) * math.sin(math.pi * k / 6))
                         for k in range(12)])], .1, .6, [], 60),
        "large": ([line((0., 0.), (100., 0.), (100., 40.), (60., 40.), (60., 70.), (0., 70.)), circle_hole(30, 35, 12, 16)], .1, .32,
                  [], 90),
    }


def write_outline(path, contours, smallest, largest, places):
    with open(path, "w", encoding="utf-8") as file:
        print(smallest, largest, 15., len(contours), len(places), file=file)
        for pieces in contours:
            print(len(pieces), file=file)
            for piece in pieces:
                print(*[repr(c) for point in piece for c in point], file=file)
        for place in places:
            print(*place, file=file)


def mesh(outline, who, out):
    result = subprocess.run([PROGRAM, outline, who, out], text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False,
                            env={**os.environ, "REMDATA_GMSH": GMSH})
    words = result.stdout.split()
    if result.returncode != 0:
        return None, result.stdout.strip()
    return dict(zip(("elements", "angle", "jacobian", "attempts", "seconds"), map(float, words))), None


def draw(path, name, files):
    """The meshes side by side."""
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    from matplotlib.collections import PolyCollection
    import numpy as np
    figure, axes = pyplot.subplots(1, len(files), figsize=(9 * len(files), 9), squeeze=False)
    for axis, (who, file) in zip(axes[0], files.items()):
        with open(file, encoding="utf-8") as text:
            n, m = map(int, text.readline().split())
            values = text.read().split()
        x = np.array(values[:2 * n], float).reshape(n, 2)
        quads = np.array(values[2 * n:], int).reshape(m, 8)[:, [0, 4, 1, 5, 2, 6, 3, 7]] - 1
        corners = x[quads[:, ::2]]
        u, v = np.roll(corners, -1, 1) - corners, np.roll(corners, 1, 1) - corners
        angle = np.degrees(np.arctan2(u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0], (u * v).sum(-1))) % 360
        worst = np.minimum(angle.min(1), 180 - angle.max(1))
        axis.add_collection(PolyCollection(x[quads], array=worst, cmap="RdYlGn", clim=(20, 90), edgecolors="k", linewidths=.4))
        axis.set_aspect("equal")
        axis.autoscale()
        axis.set_title(f"{name}: {who}, {m} elements")
    figure.tight_layout()
    figure.savefig(path, dpi=70)
    pyplot.close(figure)


def main():
    words = sys.argv[1:]
    pictures = None
    if "--draw" in words:
        k = words.index("--draw")
        pictures = words[k + 1]
        del words[k:k + 2]
        os.makedirs(pictures, exist_ok=True)
    meshers = ["free"] + (["gmsh"] if os.path.exists(GMSH) else [])
    print(f"{'outline':22}" + "".join(f"|{who:>6}: elements  angle  jacob.  tries  seconds " for who in meshers))
    bad = []
    for name, (contours, smallest, largest, places, corner) in outlines().items():
        if words and name not in words:
            continue
        with tempfile.TemporaryDirectory() as folder:
            outline = os.path.join(folder, "outline.txt")
            write_outline(outline, contours, smallest, largest, places)
            found, files, row = {}, {}, f"{name:22}"
            for who in meshers:
                file = os.path.join(folder, who + ".mesh")
                values, why = mesh(outline, who, file)
                found[who] = values
                if values is None:
                    row += f"| {why}"
                    continue
                files[who] = file
                row += "|{elements:16.0f} {angle:6.1f} {jacobian:7.3f} {attempts:6.0f} {seconds:8.2f} ".format(**values)
            print(row, flush=True)
            if pictures and files:
                draw(os.path.join(pictures, name.replace(" ", "_").replace(":", "_") + ".png"), name, files)
        own, other = found["free"], found.get("gmsh")
        if own is None or own["angle"] < min(20, .9 * corner) or own["jacobian"] < min(.25, .9 * math.sin(math.radians(corner))):
            bad.append(f"{name}: bad shape")
        elif other and (own["elements"] > 1.01 * other["elements"] or own["angle"] < .99 * other["angle"]
                        or own["jacobian"] < .99 * other["jacobian"]):
            bad.append(f"{name}: Gmsh is better")
    print("\n".join(bad))
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
