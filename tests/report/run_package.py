#!/usr/bin/env python3
"""The page on the files of results against the files, both ways; the package `lagamine` against files and closed forms; its examples."""
import contextlib
import fnmatch
import glob
import importlib.util
import io
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import h5py
import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
SOURCE = os.path.abspath(os.environ.get("LAGAMINE_SOURCE") or os.path.dirname(os.path.dirname(HERE)))
BIN = os.path.abspath(os.environ.get("LAGAMINE_BIN") or os.path.join(SOURCE, "build", "bin"))
sys.path.insert(0, os.path.join(SOURCE, "src", "report"))
sys.dont_write_bytecode = True
import lagamine  # noqa: E402

PAGE = os.path.join(SOURCE, "decks", "RESULTS.md")


def rows(heading):
    """Rows of the table below a heading of the page."""
    with open(PAGE, encoding="utf-8") as file:
        part = file.read().split(f"## {heading}\n", 1)[1].split("\n## ", 1)[0]
    lines = [line for line in part.splitlines() if line.startswith("|")][2:]
    return [[cell.strip().strip("`") for cell in line.strip("|").split("|")] for line in lines]


class Package(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp(prefix="lagamine-package-")
        cls.addClassCleanup(shutil.rmtree, cls.folder, True)
        os.environ["OMP_NUM_THREADS"] = "1"
        shutil.copytree(os.path.join(SOURCE, "decks", "import_tooth"), os.path.join(cls.folder, "decks", "import_tooth"))
        cls.deck = os.path.join(cls.folder, "decks", "import_tooth", "import_tooth.lag")
        cls.out = os.path.join(cls.folder, "out", "tooth")
        os.mkdir(os.path.join(cls.folder, "out"))
        cls.run_ = lagamine.run(cls.deck, cls.out, programs=BIN)

    def tree(self, path):
        """All datasets and groups of a file, through its links."""
        held = {}
        with h5py.File(path, "r") as file:
            def walk(group, place):
                for name in group:
                    item = group[name]
                    where = f"{place}/{name}".strip("/")
                    held[where] = (item.shape, item.dtype, dict(item.attrs), item[()]) if isinstance(item, h5py.Dataset) \
                        else (None, None, dict(item.attrs), None)
                    if isinstance(item, h5py.Group):
                        walk(item, where)
            walk(file, "")
            held[""] = (None, None, dict(file.attrs), None)
        return held

    def test_every_dataset_of_the_page(self):
        """Each row finds datasets, of its shape and type; no dataset is left out."""
        paths = sorted(glob.glob(os.path.join(self.out, "*.g[0-9][0-9].h5")))
        self.assertGreaterEqual(len(paths), 2)
        table = rows("Datasets")
        self.assertGreater(len(table), 8)
        for path in paths:
            held = self.tree(path)
            datasets = {name: item for name, item in held.items() if item[0] is not None}
            sizes = {"node": len(held["mesh/coordinates"][3]), "element": len(held["mesh/topology"][3]), "die": len([n for n in datasets if n.startswith("dies/")])}
            seen = set()
            for pattern, shape, kind, _ in table:
                found = [name for name in datasets if fnmatch.fnmatch(name, pattern) and name.count("/") == pattern.count("/")]
                self.assertTrue(found, f"{path}: nothing is '{pattern}'")
                seen.update(found)
                for name in found:
                    words = shape.split()
                    if words[-1] == "...":
                        words = words[:-1] + [str(n) for n in datasets[name][0][1:]]
                    self.assertEqual(len(words), len(datasets[name][0]), name)
                    for word, n in zip(words, datasets[name][0]):
                        if word.isdigit() or word in sizes:
                            self.assertEqual(int(word) if word.isdigit() else sizes[word], n, name)
                    dtype = datasets[name][1]
                    self.assertTrue(dtype == np.dtype(kind) if kind != "text" else dtype.kind == "S", f"{name}: {dtype}")
            self.assertEqual(set(), set(datasets) - seen, "datasets that the page leaves out")
            for place, attribute, _ in rows("Attributes"):
                found = [name for name in held if fnmatch.fnmatch(name, place.strip("/")) and name.count("/") == place.strip("/").count("/")]
                self.assertTrue(found and all(attribute in held[name][2] for name in found), f"{place} {attribute}")
            self.assertEqual(("lagamine results", 1), (held[""][2]["format"].decode(), held[""][2]["format_version"]))
            self.check_units_and_points(held)

    def check_units_and_points(self, held):
        """Units of fields with the words of the manual; points where the elements' shape functions put them; dies where their pilots are."""
        last = max(name for name in held if re.fullmatch(r"steps/\d+", name))
        for field, unit in (("mises", "stress"), ("stress_xy", "stress"), ("plastic_strain", "-"), ("displacement", "length"), ("applied_force", "force")):
            self.assertEqual(unit, held[f"{last}/node/{field}"][2]["unit"].decode(), field)
        bodies = [name for name in held if re.fullmatch(rf"{last}/points/\d+/coordinates", name)]
        self.assertEqual(1, len(bodies))
        group = bodies[0].split("/")[3]
        names, units = (held[f"{last}/points/{group}/{what}"][3].tolist() for what in ("components", "units"))
        self.assertEqual({b"stress"}, {unit for name, unit in zip(names, units) if name.startswith(b"stress")})
        number = int(last.split("/")[1])
        k = next(k for k, step in enumerate(self.run_._run.steps) if step.number == number and step.generation.number == held[""][2]["generation"])
        np.testing.assert_allclose(held[bodies[0]][3], self.run_.points("tooth", k).x.reshape(-1, 2), rtol=1e-13, atol=1e-12)
        x = held[f"{last}/die_coordinates"][3]
        np.testing.assert_allclose(x[:, 0], [10, 4.5, -1])
        np.testing.assert_allclose(x[:, 1], held[f"{last}/pilots"][3][0, 1], rtol=1e-14)
        self.assertEqual([[0, 2, 1]], held["mesh/die_topology"][3].tolist())

    def test_meshio_reads_the_xdmf(self):
        """Bodies and dies over time, as the page says; the last mesh and its fields are those of the HDF5 files."""
        import meshio
        for ending, kind, fields in ((".xdmf", "quad8", {"mises", "plastic_strain", "displacement"}), (".dies.xdmf", "line3", set())):
            with meshio.xdmf.TimeSeriesReader(os.path.join(self.out, "import_tooth" + ending)) as reader:
                _, cells = reader.read_points_cells()
                self.assertEqual([kind], [block.type for block in cells])
                times = [reader.read_data(k) for k in range(reader.num_steps)]
            self.assertEqual(list(self.run_.times), [time for time, _, _ in times])
            self.assertLessEqual(fields, set(times[-1][1]))
            if fields:
                np.testing.assert_array_equal(times[-1][1]["mises"], self.run_.field("mises"))
            else:
                np.testing.assert_array_equal(times[-1][2]["die"][0], [1])

    @unittest.skipUnless(importlib.util.find_spec("pyvista"), "pyvista is not installed")
    def test_pyvista_reads_the_xdmf(self):
        """Bodies, dies and integration points at the last instant."""
        import pyvista
        for ending in (".xdmf", ".dies.xdmf", ".points.xdmf"):
            reader = pyvista.get_reader(os.path.join(self.out, "import_tooth" + ending))
            np.testing.assert_allclose(reader.time_values, sorted(set(self.run_.times)), rtol=1e-12)
            reader.set_active_time_value(reader.time_values[-1])
            grid = reader.read()
            if ending == ".points.xdmf":
                while isinstance(grid, pyvista.MultiBlock):
                    grid = grid[0]
                points = self.run_.points("tooth")
                np.testing.assert_allclose(grid.points[:, :2], points.x.reshape(-1, 2), rtol=1e-6)
                np.testing.assert_array_equal(grid["stress_yy"], points["stress_yy"].ravel())
            elif ending == ".xdmf":
                np.testing.assert_array_equal(grid["mises"], self.run_.field("mises"))
                self.assertEqual(self.run_.grid().n_cells, grid.n_cells)
            else:
                self.assertEqual(3, grid.n_points)

    def test_values_are_those_of_the_files(self):
        run = self.run_
        last = sorted(glob.glob(os.path.join(self.out, "*.g[0-9][0-9].h5")))[-1]
        with h5py.File(last, "r") as file:
            step = file["steps"][sorted(file["steps"])[-1]]
            np.testing.assert_array_equal(step["node/mises"][()], run.field("mises"))
            np.testing.assert_array_equal(step["coordinates"][()], run.coordinates())
            np.testing.assert_array_equal(step["element/error_stress"][()], run.element_field("error_stress"))
            self.assertEqual(step.attrs["time"], run.times[-1])
        self.assertEqual({1, 2}, set(run.meshes))
        self.assertEqual("force", run.units["force_y_tool"])
        self.assertEqual(["tool"], run.dies)
        np.testing.assert_allclose(run.die("tool")[:, 1], 44 - 0.8, rtol=1e-14)
        self.assertEqual(len(run.elements()), len(run.points("tooth").state))
        with self.assertRaisesRegex(lagamine.LagamineError, "no field 'misses'; there are: .*mises"):
            run.field("misses")
        for wrong in (lambda: run.field("mises", 999), lambda: run.points("gear"), lambda: run.points("tooth")["stres"], lambda: run.die("tol"),
                      lambda: lagamine.open(os.path.join(self.folder, "nowhere"))):
            with self.assertRaises(lagamine.LagamineError):
                wrong()

    def test_points_are_where_their_stress_is(self):
        """Lame's cylinder: stress_xx = A - B/r^2, zz = A + B/r^2 at the places of the points; inner pressure p at 4, none at 10."""
        with open(os.path.join(SOURCE, "decks", "thick_cylinder", "thick_cylinder.lag"), encoding="utf-8") as file:
            text = file.read()
        path = os.path.join(self.folder, "cylinder.lag")
        with open(path, "w", encoding="utf-8") as file:      # a pressure so small that the radius does not change
            file.write(text.replace("10. load", "1.E-6 load"))
        run = lagamine.run(path, os.path.join(self.folder, "cylinder"), programs=BIN, nx=40)
        points = run.points("ring")
        r = points.x[:, :, 0]
        a, b, p = 4.0, 10.0, 1e-6
        first, second = p * a**2 / (b**2 - a**2), p * a**2 * b**2 / (b**2 - a**2)
        np.testing.assert_allclose(points["stress_xx"], first - second / r**2, atol=1e-3 * p)
        np.testing.assert_allclose(points["stress_zz"], first + second / r**2, atol=1e-3 * p)
        self.assertGreater(np.ptp(points.x[0, :, 1]), 0.5)

    def test_examples(self):
        """The examples of the page, in its order."""
        with open(PAGE, encoding="utf-8") as file:
            examples = re.findall(r"```python\n(.*?)```", file.read(), re.S)
        self.assertEqual(5, len(examples))
        said = []
        here, old = os.getcwd(), os.environ["PATH"]
        os.chdir(self.folder)
        os.environ["PATH"] = BIN + os.pathsep + old
        try:
            for example in examples:
                with contextlib.redirect_stdout(io.StringIO()) as out:
                    exec(compile(example, "RESULTS.md", "exec"), {})       # noqa: S102  (what the page shows)
                said.append(out.getvalue())
        finally:
            os.chdir(here)
            os.environ["PATH"] = old
        force = self.run_.history["force_y_tool"][-1]
        self.assertTrue(said[0].startswith(f"{force:.0f} N at 0.80 mm, work "), said[0])
        work = float(said[0].split()[-3])
        self.assertAlmostEqual(1.0, work / self.run_.history["external_work"][-1], delta=0.03)      # trapezia over the steps
        self.assertIn("in element", said[1])
        self.assertEqual(2, len(said[3].split()))
        self.assertEqual(2, len(said[4].splitlines()))

    def test_refused_deck(self):
        path = os.path.join(self.folder, "bad.lag")
        with open(path, "w", encoding="ascii") as file:
            file.write("TITLE  Bad\nEND\n")
        with self.assertRaises(lagamine.LagamineError) as caught:
            lagamine.run(path, os.path.join(self.folder, "bad"), programs=BIN)
        self.assertEqual(2, caught.exception.code)
        self.assertIn("bad.lag", str(caught.exception))

    def test_installed_alone(self):
        """From the folder it is installed in, without the source tree."""
        home = os.path.join(os.path.dirname(BIN), "share", "lagamine")
        done = subprocess.run([sys.executable, "-c", f"import lagamine; print(lagamine.open({self.out!r}).title, lagamine.__file__)"],
                              capture_output=True, text=True, check=False, env=dict(os.environ, PYTHONPATH=home, PYTHONDONTWRITEBYTECODE="1"))
        self.assertEqual(0, done.returncode, done.stderr)
        self.assertIn(home, done.stdout)


if __name__ == "__main__":
    unittest.main(verbosity=2)
