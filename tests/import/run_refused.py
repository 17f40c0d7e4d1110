#!/usr/bin/env python3
"""Broken files for lagaimport: one clear line each, which names the entity, and exit code 2."""
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
from importing import lagaimport  # noqa: E402

NODES = "*NODE\n1, 0, 0\n2, 1, 0\n3, 1, 1\n4, 0, 1\n5, 2, 0\n6, 2, 1\n"
QUADS = "*ELEMENT, TYPE=CAX4, ELSET=part\n1, 1, 2, 3, 4\n2, 2, 5, 6, 3\n"

# name, text of the .inp, options, words of the line
INP = [
    ("triangle", NODES + QUADS + "*ELEMENT, TYPE=CPE3, ELSET=wedge\n3, 1, 2, 3\n", (),
     "*ELEMENT, ELSET=wedge: 1 element of kind triangle, the first around (0.666667, 0.333333): expected quadrilaterals only"),
    ("brick", NODES + "*ELEMENT, TYPE=C3D8, ELSET=solid\n1, 1, 2, 3, 4, 5, 6, 1, 2\n", (), "ELSET=solid: 1 element of kind C3D8, the first around (0.875, 0.375): a part in three dimensions"),
    ("shell", NODES + "*ELEMENT, TYPE=S8R, ELSET=skin\n1, 1, 2, 3, 4, 1, 2, 3, 4\n", (), "ELSET=skin: 1 element of kind S8R"),
    ("same place", NODES + "7, 1, 1e-9\n8, 3, 0\n9, 3, 1\n" + QUADS + "3, 7, 8, 9, 6\n", (), "nodes 2 and 7 of 'part': are at the same place (1, 0)"),
    ("touching", NODES + "7, 1, 0\n8, 1, 1\n" + "*ELEMENT, TYPE=CAX4, ELSET=low\n1, 1, 2, 3, 4\n*ELEMENT, TYPE=CAX4, ELSET=high\n2, 7, 5, 6, 8\n", (),
     "bodies 'high' and 'low': have 2 pairs of nodes at the same places and are not joined"),
    ("no node", NODES + QUADS.replace("6, 3", "16, 3"), (), ":10: element 2: there is no node 16"),
    ("node twice", NODES + "3, 5, 5\n" + QUADS, (), ":8: *NODE: node 3 is given a second time"),
    ("element twice", NODES + QUADS + "2, 1, 2, 3, 4\n", (), "element 2 is given a second time"),
    ("too few nodes", NODES + QUADS + "*ELEMENT, TYPE=CAX8R, ELSET=part\n3, 1, 2, 3, 4\n", (), "element 3: CAX8R has 8 nodes, found 4"),
    ("letters", NODES.replace("1, 1\n4", "1, one\n4") + QUADS, (), ":4: *NODE: expected a label and two or three coordinates"),
    ("not a number", NODES.replace("6, 2, 1", "6, 2, nan") + QUADS, (), ":7: *NODE: expected a label and two or three coordinates"),
    ("out of the plane", NODES.replace("6, 2, 1", "6, 2, 1, 0.5") + QUADS, (), "node 6: lies 0.5 off the plane XY of the others"),
    ("folded", NODES + QUADS.replace("2, 5, 6, 3", "2, 5, 3, 6"), (), "element 2 of 'part' around (1.5, 0.5): it folds over"),
    ("no set", NODES + QUADS + "*SURFACE, NAME=s\nbottom, S1\n", (), "*SURFACE s: there is no set of elements 'bottom'"),
    ("side 5", NODES + QUADS + "*SURFACE, NAME=s\n1, S5\n", (), "*SURFACE s: expected an element or a set, and a side S1 to S4"),
    ("surface of triangles", NODES + "*ELEMENT, TYPE=CPE3, ELSET=part\n1, 1, 2, 3\n*SURFACE, NAME=s\n1, S1\n", (),
     "*ELEMENT, ELSET=part: 1 element of kind triangle, the first around"),
    ("inside", NODES + QUADS + "*SURFACE, NAME=s\n1, S2\n", (), "set 's': 1 of 1 line lie between elements, not on the boundary, the first from (1, 0) to (1, 1)"),
    ("generated", NODES + "*NGEN\n1, 2, 1\n" + QUADS, (), "*NGEN: nodes and elements that are generated or turned are not read"),
    ("name", NODES + QUADS.replace("=part", "=the part"), (), "body 'the part': its name is none of a deck"),
    ("name twice", NODES + QUADS + "*SURFACE, NAME=part\n1, S1\n", (), "the name 'part' is taken by the body 'part'"),
    ("section", NODES + QUADS + "*SOLID SECTION, ELSET=other, MATERIAL=m\n", (), "*SOLID SECTION, ELSET=other: there is no such set of elements"),
    ("no elements", NODES, (), "*ELEMENT: there are no elements"),
    ("include", "*INCLUDE, INPUT=nowhere.inp\n" + NODES + QUADS, (), ":1: nowhere.inp: cannot be read: No such file"),
    ("body", NODES + QUADS, ("--body", "prt"), "--body prt: there is no such set; there are: part"),
    ("rename", NODES + QUADS, ("--rename", "prt=billet"), "--rename prt=billet: nothing that is imported is called 'prt'"),
    ("cut short", NODES + QUADS + "3, 1, 2,\n*STEP\n", (), "element 3 is cut short by a keyword"),
]

ON = {"layer": "die"}


def broken_line(space):
    space.add_line((0, 0), (5, 0), dxfattribs=ON)
    space.add_line((5.01, 0), (9, 0), dxfattribs=ON)


def branch(space):
    for end in ((5, 0), (9, 4), (9, -4)):
        space.add_line((5, 0) if end != (5, 0) else (0, 0), end, dxfattribs=ON)


def twice(space):
    space.add_line((0, 0), (5, 0), dxfattribs=ON)
    space.add_line((5, 0), (0, 0), dxfattribs=ON)


def crossing(space):
    space.add_lwpolyline([(0, 0), (4, 4), (4, 0), (0, 4)], dxfattribs=ON)


def two_circles(space):
    space.add_circle((0, 0), 2, dxfattribs=ON)
    space.add_circle((0, 0), 1, dxfattribs=ON)


def two_circles_apart(space):
    space.add_circle((0, 0), 2, dxfattribs=ON)
    space.add_circle((5, 0), 1, dxfattribs=ON)


def three_circles(space):
    two_circles(space)
    space.add_circle((0, 0), 3, dxfattribs=ON)


def circles_that_cross(space):
    space.add_circle((0, 0), 2, dxfattribs=ON)
    space.add_circle((2, 0), 1, dxfattribs=ON)


def block(space):
    space.doc.blocks.new("pin").add_circle((0, 0), 1)
    space.add_blockref("pin", (1, 1), dxfattribs=ON)


def open_body(space):
    space.add_lwpolyline([(0, 0), (4, 0), (4, 3), (0, 3)], dxfattribs=ON)


def arc(space):
    space.add_arc((0, 0), 2, 0, 90, dxfattribs=ON)


def line(space):
    space.add_line((0, 0), (5, 0), dxfattribs=ON)


DIE = ("--die", "die", "--part", "1", "9", "--tolerance", "1e-3")
DXF = [
    ("gap", broken_line, DIE, "layer 'die': the contour is open between (5, 0) (LINE"),
    ("branch", branch, DIE, "layer 'die': 3 ends meet at (5, 0) (LINE"),
    ("twice", twice, DIE, "on layer 'die': lies on LINE"),
    ("crossing", crossing, DIE, "LWPOLYLINE 2F on layer 'die': crosses itself at (2, 2)"),
    ("two dies", two_circles, DIE, "layer 'die': 2 curves, with CIRCLE"),
    ("hole outside", two_circles_apart, ("--body", "die", "--tolerance", "1e-3"), "on layer 'die' lies beside the one with CIRCLE"),
    ("hole in a hole", three_circles, ("--body", "die", "--tolerance", "1e-3"), "on layer 'die' lies in the hole with CIRCLE"),
    ("hole across", circles_that_cross, ("--body", "die", "--tolerance", "1e-3"), "on layer 'die': crosses CIRCLE"),
    ("in space", lambda space: space.add_line((0, 0, 0), (5, 0, 1), dxfattribs=ON), DIE, "on layer 'die': leaves the plane (z from 0 to 1)"),
    ("face", lambda space: space.add_3dface([(0, 0, 0), (1, 0, 0), (1, 1, 1)], dxfattribs=ON), DIE, "3DFACE 2F on layer 'die': is in three dimensions"),
    ("block", block, DIE, "on layer 'die': is a block ('pin')"),
    ("open body", open_body, ("--body", "die"), "layer 'die': the contour is open between (0, 0) (LWPOLYLINE 2F on layer 'die') and (0, 3)"),
    ("no tolerance", arc, DIE[:5], "--tolerance: there are arcs or smooth curves"),
    ("no side", arc, ("--die", "die", "--tolerance", "0.1"), "layer 'die': on which side the part is cannot be found"),
    ("on the curve", line, ("--die", "die", "--part", "1", "0"), "layer 'die': the point (1, 0) of --part lies on the curve"),
    ("beyond", line, ("--die", "die", "--part", "9", "1"), "layer 'die': the point (9, 1) of --part lies beyond an end of the curve"),
    ("no layer", line, ("--die", "dei", "--part", "1", "1"), "layer 'dei': has no lines; there are: 'die'"),
    ("nothing said", line, (), "layers: say which is what by --die LAYER and --body LAYER; there are: 'die'"),
    ("no length", lambda space: (line(space), space.add_line((2, 2), (2, 2), dxfattribs=ON)), DIE, "on layer 'die': has no length"),
]

CSV = [
    ("word", "x,y\n0,0\n1,one\n", DIE, ":3: expected two coordinates, x and y, found '1,one'"),
    ("three", "0,0\n1,2,3\n4,4\n", DIE, ":2: expected two coordinates"),
    ("point twice", "0 0\n1 0\n1 0\n2 0\n", DIE, ":3: the point (1, 0) is that of line 2"),
    ("one point", "x y\n0 0\n", DIE, "points: expected two or more, found 1"),
    ("infinite", "0 0\n1 inf\n2 0\n", DIE, ":2: expected two coordinates"),
    ("unnamed", "0 0\n1 0\n", (), "points: say what the contour is: expected one of --die NAME and --body NAME"),
]


class Refused(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="lagaimport-test-")
        self.addCleanup(shutil.rmtree, self.folder, True)

    def path(self, name):
        return os.path.join(self.folder, name)

    def check(self, name, options, words, lines=1):
        """Exit code 2, so many lines, the first with these words; nothing is written."""
        before = set(os.listdir(self.folder))
        done = lagaimport(self.path(name), *options)
        self.assertEqual(2, done.returncode, done.stderr)
        found = done.stderr.splitlines()
        self.assertEqual(lines, len(found), done.stderr)
        self.assertIn(words, found[0])
        self.assertIn(name, found[0])
        self.assertEqual(before, set(os.listdir(self.folder)))

    def test_inp(self):
        for name, text, options, words in INP:
            with self.subTest(name):
                with open(self.path("part.inp"), "w", encoding="ascii") as file:
                    file.write(text)
                self.check("part.inp", options, words)

    def test_dxf(self):
        for name, draw, options, words in DXF:
            with self.subTest(name):
                document = ezdxf.new("R2010")
                draw(document.modelspace())
                document.saveas(self.path("part.dxf"))
                self.check("part.dxf", options, words)

    def test_csv(self):
        for name, text, options, words in CSV:
            with self.subTest(name):
                with open(self.path("part.csv"), "w", encoding="ascii") as file:
                    file.write(text)
                self.check("part.csv", options, words)

    def test_msh_and_med(self):
        x = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)], dtype=float)
        for kind, nodes, words in (("triangle", [[0, 1, 2]], "of kind triangle, the first around (0.666667, 0.333333): expected quadrilaterals only"),
                                   ("tetra", [[0, 1, 2, 5]], "a part in three dimensions"), ("line", [[0, 1]], "there are no quadrilaterals")):
            with self.subTest(kind):
                tags = [np.array([1])]
                dimension = {"line": 1, "triangle": 2, "tetra": 3}[kind]
                meshio.write(self.path("part.msh"), meshio.Mesh(
                    x, [(kind, np.array(nodes))], cell_data={"gmsh:physical": tags, "gmsh:geometrical": tags},
                    point_data={"gmsh:dim_tags": np.array([[dimension, 1]] * 8)}), file_format="gmsh")
                self.check("part.msh", (), words)
                meshio.write(self.path("part.med"), meshio.Mesh(x, [(kind, np.array(nodes))]), file_format="med")
                self.check("part.med", (), words)
        meshio.write(self.path("old.msh"), meshio.Mesh(x[:4], [("quad", np.array([[0, 1, 2, 3]]))]), file_format="gmsh22")
        self.check("old.msh", (), "the format of Gmsh is '2.2': expected 4.1")
        for name, text in (("empty.msh", ""), ("cut.msh", "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 4"), ("cut.med", "no HDF5"), ("cut.dxf", "0\nSECTION")):
            with self.subTest(name):
                with open(self.path(name), "w", encoding="ascii") as file:
                    file.write(text)
                self.check(name, DIE if name.endswith("dxf") else (), "not a ")

    def test_all_at_once(self):
        with open(self.path("part.inp"), "w", encoding="ascii") as file:
            file.write(NODES + "3, 5, 5\n4, x, 1\n" + QUADS + "2, 1, 2, 3, 4\n*NFILL\n")
        self.check("part.inp", (), ":8: *NODE: node 3", lines=4)
        document = ezdxf.new("R2010")
        for draw in (broken_line, block, crossing):
            draw(document.modelspace())
        document.saveas(self.path("part.dxf"))
        done = lagaimport(self.path("part.dxf"), *DIE)
        self.assertEqual(2, done.returncode)
        self.assertGreaterEqual(len(done.stderr.splitlines()), 2)

    def test_arguments(self):
        with open(self.path("part.csv"), "w", encoding="ascii") as file:
            file.write("0 0\n1 0\n")
        for name, options, words in (("part.stp", (), "the ending '.stp' is not known"), ("none.csv", (), "no such file"),
                                     ("part.csv", ("--out", self.path("part.csv"), *DIE), "is the file that is imported")):
            self.check(name, options, words)
        for options, words in ((("--scale", "0"), "--scale 0: expected a number above 0"), (("--apart",), "--apart: not for a file of the kind .csv"),
                               (("--mean",), "--mean: expected --npoint 9"), (("--shift", "nan", "0"), "--shift: expected two finite numbers"),
                               (("--rename", "a=1"), "--rename a=1: expected OLD=NEW")):
            done = lagaimport(self.path("part.csv"), *DIE, *options)
            self.assertEqual((2, 1), (done.returncode, len(done.stderr.splitlines())), done.stderr)
            self.assertIn(words, done.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
