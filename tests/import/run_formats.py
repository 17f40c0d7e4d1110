#!/usr/bin/env python3
"""lagaimport on files that Gmsh, meshio and ezdxf wrote: what comes out is what went in, and the solver reads it."""
import math
import os
import shutil
import sys
import tempfile
import unittest

import ezdxf
import meshio
import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
sys.dont_write_bytecode = True
from importing import (area_left, check_deck, lagaimport, mesh_of, piece_curve, pieces_of, run,  # noqa: E402
                       side_points)

from lagamine_import.smooth import cubic_through, distance  # noqa: E402

HEAD = ["TITLE  Imported", "STATE  PLSTN", "KINEM  LOG", "INCLU  part.inc"]
LAW = ["LAW    steel ELA", "   200000. 0.3"]
TAIL = ["STRAT  1. 0.1 1.   4 3", "STOP   1.", "END"]
GEO = """Point(1) = {0, 0, 0}; Point(2) = {4, 0, 0}; Point(3) = {4, 3, 0}; Point(4) = {0, 3, 0}; Point(5) = {2, -2, 0};
Circle(1) = {1, 5, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1}; Recombine Surface{1};
Physical Curve("foot") = {1}; Physical Curve("top") = {3}; Physical Surface("block") = {1};
Mesh.ElementOrder = 2; Mesh.SecondOrderIncomplete = 1; Mesh.MshFileVersion = 4.1;
Mesh.CharacteristicLengthMax = 0.8; Mesh.SubdivisionAlgorithm = 1;
"""
TRANSFINITE = """Point(1) = {0, 0, 0}; Point(2) = {4, 0, 0}; Point(3) = {3, 3, 0}; Point(4) = {1, 3, 0}; Point(5) = {2, -2, 0};
Circle(1) = {1, 5, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1}; Transfinite Curve{1, 3} = 6; Transfinite Curve{2, 4} = 4;
Transfinite Surface{1}; Recombine Surface{1};
Physical Curve("foot") = {1}; Physical Curve("top") = {3}; Physical Surface("block") = {1};
Mesh.ElementOrder = 2; Mesh.MshFileVersion = 4.1;
"""


class Formats(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="lagaimport-test-")
        self.addCleanup(shutil.rmtree, self.folder, True)
        self.out = os.path.join(self.folder, "part.inc")

    def path(self, name):
        return os.path.join(self.folder, name)

    def imported(self, name, *options):
        """Import a file to part.inc; what was printed."""
        done = lagaimport(self.path(name), "--out", self.out, *options)
        self.assertEqual(0, done.returncode, done.stderr)
        self.assertEqual("", done.stderr)
        with open(self.path("part.svg"), encoding="utf-8") as file:
            self.assertGreater(file.read().count("<path"), 5)
        return done.stdout

    def read_by_solver(self, *more):
        done = check_deck(self.folder, [*HEAD, *LAW, *more, *TAIL])
        self.assertEqual(0, done.returncode, done.stderr)
        return done.stdout

    def mesh_area(self):
        """Area by the outlines of the elements, parabolas by Simpson's rule: exact."""
        nodes, bodies, _ = mesh_of(self.out)
        area = 0.0
        for body in bodies.values():
            for row in body.values():
                x = np.array([nodes[label] for label in row])
                for a, m, b in ((0, 4, 1), (1, 5, 2), (2, 6, 3), (3, 7, 0)):
                    p, q, r = x[a], x[m], x[b]
                    # cross of position and derivative at the ends and the middle of the parent interval
                    slopes = (4 * q - 3 * p - r, r - p, 3 * r + p - 4 * q)
                    area += 0.5 * sum(w * (y[0] * d[1] - y[1] * d[0]) for w, y, d in zip((1, 4, 1), (p, q, r), slopes)) / 6
        return area

    # ---- meshes ----

    def square(self, kind):
        """Two bodies of three elements each, a set of lines below, one right of the second; meshio's mesh and what is expected."""
        x = [(i / 2, j / 2) for j in range(3) for i in range(13)]
        keep = [k for k, (a, b) in enumerate(x) if kind == "quad8" and not (a % 1 and b % 1) or kind == "quad" and not (a % 1 or b % 1)]
        place = {x[k]: n for n, k in enumerate(keep)}
        points = np.array([(x[k][0], x[k][1] + 0.1 * x[k][0]**2, 0.0) for k in keep])
        cells = []
        for i in range(6):
            corners = [(i, 0), (i + 1, 0), (i + 1, 1), (i, 1)]
            middles = [(i + .5, 0), (i + 1, .5), (i + .5, 1), (i, .5)] if kind == "quad8" else []
            cells.append([place[(float(a), float(b))] for a, b in corners + middles])
        lines = [[row[0], row[1], *([row[4]] if kind == "quad8" else [])] for row in cells]
        right = [[cells[5][1], cells[5][2], *([cells[5][5]] if kind == "quad8" else [])]]
        return points, np.array(cells), np.array(lines), np.array(right)

    def check_square(self, kind, points, cells):
        nodes, bodies, sides = mesh_of(self.out)
        self.assertEqual({"first", "second"}, set(bodies))
        found = [row for name in ("first", "second") for row in bodies[name].values()]
        self.assertEqual([3, 3], [len(bodies[name]) for name in ("first", "second")])
        width = cells.shape[1]
        for row, want in zip(found, cells):
            np.testing.assert_array_equal([nodes[label] for label in row[:width]], points[want, :2])
            if kind == "quad":
                x = np.array([nodes[label] for label in row])
                np.testing.assert_allclose(x[4:], 0.5 * (x[[0, 1, 2, 3]] + x[[1, 2, 3, 0]]), atol=1e-15)
        self.assertEqual(6, len(sides["below"]))
        for side in side_points(nodes, bodies, sides["below"]):
            self.assertAlmostEqual(0.0, abs(side[[0, 2], 1] - 0.1 * side[[0, 2], 0]**2).max(), places=14)
        (side,) = side_points(nodes, bodies, sides["right"])
        np.testing.assert_array_equal(side[:, 0], 6.0)
        self.read_by_solver("FIXED  below XY", "FIXED  right X")

    def test_meshio_gmsh(self):
        for kind, binary in (("quad8", False), ("quad8", True), ("quad", True)):
            points, cells, lines, right = self.square(kind)
            line = "line3" if kind == "quad8" else "line"
            tags = [np.full(3, 1), np.full(3, 2), np.full(6, 3), np.full(1, 4)]
            mesh = meshio.Mesh(points, [(kind, cells[:3]), (kind, cells[3:]), (line, lines), (line, right)],
                               cell_data={"gmsh:physical": tags, "gmsh:geometrical": tags},
                               field_data={"first": np.array([1, 2]), "second": np.array([2, 2]), "below": np.array([3, 1]),
                                           "right": np.array([4, 1])},
                               point_data={"gmsh:dim_tags": np.array([[2, 1], [2, 2], [1, 3], [1, 4]] + [[2, 1]] * (len(points) - 4))})
            meshio.write(self.path("square.msh"), mesh, file_format="gmsh", binary=binary)
            self.imported("square.msh", "--law", "steel")
            self.check_square(kind, points, cells)

    def test_meshio_med(self):
        for kind in ("quad8", "quad"):
            points, cells, lines, right = self.square(kind)
            line = "line3" if kind == "quad8" else "line"
            # a MED file has one block a kind
            mesh = meshio.Mesh(points[:, :2], [(kind, cells), (line, np.vstack([lines, right]))],
                               cell_data={"cell_tags": [np.array([-1] * 3 + [-2] * 3), np.array([-3] * 6 + [-4])]})
            mesh.point_tags, mesh.cell_tags = {}, {-1: ["first"], -2: ["second"], -3: ["below"], -4: ["right"]}
            meshio.write(self.path("square.med"), mesh, file_format="med")
            self.imported("square.med", "--law", "steel")
            self.check_square(kind, points, cells)

    def test_meshio_abaqus(self):
        """meshio knows neither CAX nor sections nor surfaces: those are written by hand around its nodes and elements."""
        points, cells, _, _ = self.square("quad8")
        meshio.write(self.path("plain.inp"), meshio.Mesh(points, [("quad8", cells)]), file_format="abaqus")
        with open(self.path("plain.inp"), encoding="ascii") as file:
            plain = file.read()
        self.assertRegex(plain, r"(?i)\*element, *type=\w+8")
        for name in ("CAX8R", "CAX8", "CPE8R", "CPE8", "CPS8R", "CPS8"):
            with open(self.path("square.inp"), "w", encoding="ascii") as file:
                file.write("*INCLUDE, INPUT=body.inp\n*ELSET, ELSET=first\n1, 2, 3\n*Elset, elset=second, generate\n4, 6, 1\n"
                           "*ELSET, ELSET=ALL\nFirst, second\n*SURFACE, NAME=below\nALL, S1\n*SURFACE, TYPE=ELEMENT, NAME=right\n6, S2\n"
                           "*SOLID SECTION, ELSET=FIRST, MATERIAL=steel\n*SOLID SECTION, ELSET=second, MATERIAL=steel\n"
                           "*STEP\n*STATIC\n*NODE\nthis is not read\n")
            with open(self.path("body.inp"), "w", encoding="ascii") as file:
                lines = plain.splitlines()
                start = next(k for k, line in enumerate(lines) if line.upper().startswith("*NODE"))
                file.write("\n".join(f"*ELEMENT, TYPE={name}" if line.upper().startswith("*ELEMENT") else line for line in lines[start:]))
            self.imported("square.inp")
            self.check_square("quad8", points, cells)

    def test_inp_node_sets_and_four_nodes(self):
        points, cells, _, _ = self.square("quad")
        for name in ("CAX4", "CPE4"):
            with open(self.path("square.inp"), "w", encoding="ascii") as file:
                file.write("*NODE, NSET=Nall\n" + "".join(f"{k + 10}, {x}, {y}\n" for k, (x, y, _) in enumerate(points.tolist())))
                for body, rows in (("first", range(3)), ("second", range(3, 6))):
                    file.write(f"*ELEMENT, TYPE={name}, ELSET={body}\n"
                               + "".join(f"{e + 1}, " + ", ".join(str(n + 10) for n in cells[e]) + "\n" for e in rows))
                below = [k + 10 for k, (x, y, _) in enumerate(points) if abs(y - 0.1 * x * x) < 1e-9]
                right = [k + 10 for k, (x, _, _) in enumerate(points) if x == 6]
                file.write("*NSET, NSET=below\n" + ", ".join(map(str, below)) + ",\n*NSET, NSET=right\n" + ", ".join(map(str, right))
                           + f"\n*NSET, NSET=corner\n{right[0]}\n")
            said = self.imported("square.inp", "--law", "steel", "--without", "Nall")
            self.assertIn("raised to 8", said)
            self.assertIn("'corner' (1 node) has no side", said)
            self.check_square("quad", points, cells)

    def test_clockwise_and_nine_nodes(self):
        """Elements numbered clockwise are turned, with their surfaces; the middle of nine nodes is left out."""
        with open(self.path("one.inp"), "w", encoding="ascii") as file:
            file.write("*NODE\n1, 0, 0\n2, 0, 2\n3, 3, 2\n4, 3, 0\n*ELEMENT, TYPE=CPS4, ELSET=e\n1, 1, 2, 3, 4\n*SURFACE, NAME=right\n1, S3\n")
        self.assertIn("numbered clockwise", self.imported("one.inp"))
        nodes, bodies, sides = mesh_of(self.out)
        (side,) = side_points(nodes, bodies, sides["right"])
        np.testing.assert_array_equal(side[:, 0], 3.0)
        self.assertAlmostEqual(6.0, self.mesh_area(), places=14)
        x = np.array([(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (1, 0, 0), (2, 1, 0), (1, 2, 0), (0, 1, 0), (1, 1, 0)], dtype=float)
        meshio.write(self.path("nine.msh"), meshio.Mesh(x, [("quad9", np.arange(9)[None])], point_data={"gmsh:dim_tags": np.array([[2, 1]] * 9)},
                                                        cell_data={"gmsh:physical": [np.array([1])], "gmsh:geometrical": [np.array([1])]}),
                     file_format="gmsh")
        self.assertIn("of 9 nodes", self.imported("nine.msh"))
        self.assertEqual(8, len(mesh_of(self.out)[0]))

    @unittest.skipUnless(shutil.which("gmsh"), "gmsh is not installed")
    def test_gmsh(self):
        """What Gmsh itself wrote: text, binary, .inp; unstructured and transfinite, with 8 and with 9 nodes."""
        segment = 8 * math.pi / 4 - 4         # between the arc of radius sqrt(8) over 90 degrees and its chord
        with open(self.path("part.geo"), "w", encoding="ascii") as file:
            file.write(TRANSFINITE)
        for options in (("-bin",), ()):
            done = run("gmsh", "-2", "part.geo", "-o", "part.msh", *options, folder=self.folder)
            self.assertEqual(0, done.returncode, done.stdout)
            self.imported("part.msh", "--law", "steel")
            nodes, bodies, sides = mesh_of(self.out)
            self.assertEqual((15, 5, 5), (len(bodies["block"]), len(sides["foot"]), len(sides["top"])))
            for side in side_points(nodes, bodies, sides["foot"]):      # middle nodes too lie on the arc
                np.testing.assert_allclose(np.hypot(side[:, 0] - 2, side[:, 1] + 2), math.sqrt(8), rtol=1e-9)
            # parabolas through three points of the arc of 18 degrees each: the area between falls with the fourth power
            self.assertAlmostEqual(9 - segment, self.mesh_area(), delta=2e-3)
            self.read_by_solver("FIXED  foot XY", "FIXED  top X")
        with open(self.path("part.geo"), "w", encoding="ascii") as file:
            file.write(GEO)
        done = run("gmsh", "-2", "part.geo", "-o", "free.inp", folder=self.folder)
        self.assertEqual(0, done.returncode, done.stdout)
        self.imported("free.inp", "--body", "block", "--sides", "foot", "--sides", "top", "--law", "steel")
        self.assertAlmostEqual(12 - segment, self.mesh_area(), delta=2e-3)
        self.read_by_solver("FIXED  foot XY", "FIXED  top X")

    def test_scale_plane_apart(self):
        with open(self.path("two.inp"), "w", encoding="ascii") as file:
            file.write("*NODE\n" + "".join(f"{k}, {x}, 7, {z}\n" for k, (x, z) in enumerate(
                [(0, 0), (1, 0), (1, 1), (0, 1), (0, 1), (1, 1), (1, 2), (0, 2)], 1))
                       + "*ELEMENT, TYPE=CAX4, ELSET=low\n1, 1, 2, 3, 4\n*ELEMENT, TYPE=CAX4, ELSET=high\n2, 5, 6, 7, 8\n")
        self.imported("two.inp", "--plane", "XZ", "--scale", "25.4", "--shift", "10", "-5", "--apart")
        nodes = mesh_of(self.out)[0]
        self.assertEqual((10 + 25.4, 25.4 - 5), nodes[3])
        self.assertEqual(nodes[3], nodes[6])

    # ---- drawings ----

    def draw(self, make, name="part.dxf"):
        document = ezdxf.new("R2010")
        make(document.modelspace())
        document.saveas(self.path(name))
        return document

    def test_contour_of_all_entities(self):
        """A closed contour of a line, an arc, an ellipse, polylines with bulges, in any order and direction; area in closed form."""
        def make(space):
            on = {"layer": "part"}
            space.add_line((10, 0), (0, 0), dxfattribs=on)                                  # against the way
            space.add_lwpolyline([(10, 4, 1), (10, 0)], format="xyb", dxfattribs=on)        # half a circle of radius 2, inwards
            space.add_arc((8, 4), 2, 0, 90, dxfattribs=on)
            space.add_polyline2d([(8, 6), (6, 6), (4, 6)], dxfattribs=on)
            space.add_ellipse((4, 3), major_axis=(0, 3), ratio=2 / 3, start_param=0, end_param=math.pi, dxfattribs=on)
            space.add_line((4, 0.0), (0, 0.0), dxfattribs={"layer": "other"})
        document = ezdxf.new("R2010")
        make(document.modelspace())
        # close it: the ellipse ends at (4, 0); the bottom line is cut there
        for entity in list(document.modelspace().query("LINE")):
            if entity.dxf.layer == "part":
                entity.dxf.end = (4, 0)
        document.saveas(self.path("part.dxf"))
        for tolerance in (1e-2, 1e-4):
            self.imported("part.dxf", "--body", "part", "--tolerance", str(tolerance), "--law", "steel")
            pieces = pieces_of(self.out, "part")
            bulge = area_left(pieces) - (6 * 6 - 4 * (1 - math.pi / 4) - 0.0 + math.pi * 2 * 3 / 2)
            # the half circle lies inside or outside of the line x = 10
            self.assertAlmostEqual(2 * math.pi, abs(bulge), delta=20 * tolerance)
            self.read_by_solver("FIXED  part 1 XY", "REMSH", "   SIZE 0.2 1.")

    def test_body_with_holes(self):
        """A plate with a round hole and a triangular one, drawn in any order and direction: the area in closed form, read by the solver."""
        document = ezdxf.new("R2010")
        on = {"layer": "plate"}
        space = document.modelspace()
        space.add_circle((3, 3), 1, dxfattribs=on)
        space.add_lwpolyline([(0, 0), (0, 6), (10, 6), (10, 0)], close=True, dxfattribs=on)     # clockwise
        space.add_lwpolyline([(6, 2), (8, 2), (7, 4)], close=True, dxfattribs=on)
        document.saveas(self.path("part.dxf"))
        self.imported("part.dxf", "--body", "plate", "--tolerance", "1e-4", "--law", "steel")
        self.assertAlmostEqual(60 - math.pi - 2, area_left(pieces_of(self.out, "plate")), delta=1e-3)
        self.read_by_solver("FIXED  plate 1 XY", "REMSH", "   SIZE 0.2 1.")

    def test_spline_within_tolerance(self):
        """A cubic with an inflection, and a rational one that is a circle; the distance is measured on the entity, by ezdxf's flattening."""
        def make(space):
            wave = space.add_spline(degree=3, dxfattribs={"layer": "wave"})
            wave.control_points = [(0, 0, 0), (4, 9, 0), (6, -9, 0), (10, 0, 0), (14, 8, 0), (18, 0, 0)]
            wave.knots = [0, 0, 0, 0, 1, 2.5, 4, 4, 4, 4]
            round_ = space.add_rational_spline([(1, 0, 0), (1, 1, 0), (0, 1, 0)], [1, math.sqrt(0.5), 1], degree=2, dxfattribs={"layer": "round"})
            round_.knots = [0, 0, 0, 1, 1, 1]
        document = self.draw(make)
        before = {}
        for tolerance in (1e-1, 1e-2, 1e-3, 1e-4):
            self.imported("part.dxf", "--die", "wave", "--die", "round", "--part", "9", "50", "--tolerance", str(tolerance))
            for entity in document.modelspace():
                layer = entity.dxf.layer
                pieces = pieces_of(self.out, layer)
                truth = np.array([tuple(p)[:2] for p in entity.flattening(1e-6, segments=64)])
                curve = np.vstack([piece_curve(*piece) for piece in pieces])
                self.assertLessEqual(distance(truth[::7], curve), 1.02 * tolerance)
                self.assertLessEqual(distance(curve[::17], truth), 1.1 * tolerance)
                self.assertGreaterEqual(len(pieces), before.get(layer, 1))
                before[layer] = len(pieces)
                for (_, one), (_, two) in zip(pieces[:-1], pieces[1:]):
                    np.testing.assert_array_equal(one[-1], two[0])
        self.assertLess(before["round"], 12)

    def test_seen_from_behind(self):
        """Entities whose extrusion is -z: x is mirrored."""
        def make(space):
            on = {"layer": "die", "extrusion": (0, 0, -1)}
            space.add_lwpolyline([(0, 0, 0), (-4, 0, -1), (-8, 0, 0)], format="xyb", dxfattribs=on)
            space.add_arc((-10, 0), 2, 0, 90, dxfattribs=on)
        self.draw(make)
        self.imported("part.dxf", "--die", "die", "--part", "2", "50", "--tolerance", "1e-3")
        ends = np.vstack([x for _, x in pieces_of(self.out, "die")])
        self.assertEqual((0.0, 10.0), (ends[:, 0].min(), ends[:, 0].max()))

    def test_side_of_the_part(self):
        """A die below, one above, a closed one beside the body; also by a point."""
        def make(space):
            space.add_lwpolyline([(0, 0), (4, 0), (4, 2), (0, 2)], close=True, dxfattribs={"layer": "part"})
            space.add_line((-1, 2.5), (9, 2.5), dxfattribs={"layer": "above"})
            space.add_line((9, 0), (-1, 0), dxfattribs={"layer": "below"})
            space.add_circle((8, 1.2), 1, dxfattribs={"layer": "pin"})
        self.draw(make)
        names = ("--die", "above", "--die", "below", "--die", "pin", "--tolerance", "1e-3")
        for options in (("--body", "part"), ("--part", "2", "1")):
            self.imported("part.dxf", *names, *options, "--law", "steel")
            above, below = pieces_of(self.out, "above")[0][1], pieces_of(self.out, "below")[0][1]
            self.assertLess(above[1, 0], above[0, 0])
            self.assertGreater(below[1, 0], below[0, 0])
            self.assertAlmostEqual(-math.pi, area_left(pieces_of(self.out, "pin")), delta=0.01)
        self.imported("part.dxf", "--die", "pin", "--part", "8", "1", "--tolerance", "1e-3")        # inside the circle
        self.assertAlmostEqual(math.pi, area_left(pieces_of(self.out, "pin")), delta=0.01)

    def test_points(self):
        """Points of a table: segments, and smooth with a corner kept."""
        t = np.linspace(0, math.pi, 13)
        rows = ["x;y"] + [f"{-math.cos(s)};{math.sin(s)}" for s in t] + ["3;0"]
        with open(self.path("round.csv"), "w", encoding="utf-8") as file:
            file.write("\n".join(rows))
        self.imported("round.csv", "--die", "arch", "--part", "0", "9")
        pieces = pieces_of(self.out, "arch")
        self.assertEqual(13, len(pieces))
        self.assertLess(pieces[0][1][0, 0], pieces[0][1][1, 0])           # the part is above: on the left as it is
        self.imported("round.csv", "--die", "arch", "--part", "0", "0.5")
        self.assertEqual(3.0, pieces_of(self.out, "arch")[0][1][0, 0])      # below: turned
        said = self.imported("round.csv", "--die", "arch", "--part", "0", "9", "--smooth", "--tolerance", "1e-3")
        self.assertIn("1 SEGM", said)
        curve = np.vstack([piece_curve(*piece) for piece in pieces_of(self.out, "arch") if piece[0] == "PARAB"])
        x = np.array([(-math.cos(s), math.sin(s)) for s in t])
        self.assertLess(distance(x, curve), 1.0e-3)
        self.assertLess(np.abs(np.hypot(*curve.T) - 1).max(), 5e-3)

    def test_cubic_through_points(self):
        """The spline goes through its points, its slope is its derivative, its second derivative is continuous and 0 at the ends."""
        x = np.array([(0, 0), (1, 2), (3, 1), (4, 4), (7, 3)], dtype=float)
        curve, slope, t = cubic_through(x)
        np.testing.assert_allclose(curve(t), x, atol=1e-13)
        s = np.linspace(t[0] + 1e-3, t[-1] - 1e-3, 57)
        np.testing.assert_allclose(slope(s), (curve(s + 1e-6) - curve(s - 1e-6)) / 2e-6, atol=1e-8)
        for k in (1, 2, 3):
            left, right = ((slope(np.array([t[k] + h])) - slope(np.array([t[k] + h - 1e-5]))) / 1e-5 for h in (0.0, 1e-5))
            np.testing.assert_allclose(left, right, atol=1e-3)
        np.testing.assert_allclose(slope(t[:1] + 1e-5) - slope(t[:1]), 0, atol=1e-8)

    def test_missing_package(self):
        """Without meshio or ezdxf: one line, exit code 5."""
        blocked = self.path("blocked")
        for package in ("meshio", "ezdxf"):
            os.makedirs(os.path.join(blocked, package))
            with open(os.path.join(blocked, package, "__init__.py"), "w", encoding="ascii") as file:
                file.write("raise ImportError('not here')\n")
        for name in ("a.msh", "a.med", "a.dxf"):
            with open(self.path(name), "w", encoding="ascii"):
                pass
            done = lagaimport(self.path(name), PYTHONPATH=blocked)
            self.assertEqual(5, done.returncode)
            self.assertEqual(1, len(done.stderr.splitlines()), done.stderr)
            self.assertRegex(done.stderr, r"install python3-(meshio|ezdxf)")


if __name__ == "__main__":
    unittest.main(verbosity=2)
