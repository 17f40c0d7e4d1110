"""Gmsh's .msh and MED files, by meshio."""
import contextlib
import io
from typing import List

import numpy as np

from .mistakes import Mistakes, Refused
from .raw_mesh import Cells, RawMesh


def read_by_meshio(path: str, kind: str, mistakes: Mistakes) -> RawMesh:
    """The mesh of a .msh (4.1) or .med file. Elements have labels in the order of the file: meshio keeps none."""
    import meshio
    if kind == "gmsh":
        _refuse_old_format(path)
    try:
        with contextlib.redirect_stdout(io.StringIO()):       # its warnings
            mesh = meshio.read(path, file_format=kind)
    except (Exception, SystemExit) as error:   # meshio fails in many ways on files that are cut short
        words = " ".join(str(error).split()) or type(error).__name__
        raise Refused(f"{path}: not a mesh that can be read as {'Gmsh' if kind == 'gmsh' else 'MED'}: {words}") from error
    points = np.asarray(mesh.points, dtype=float)
    if points.shape[1] == 2:
        points = np.hstack([points, np.zeros((len(points), 1))])
    raw = RawMesh(points, np.arange(1, len(points) + 1))
    first = 1
    for k, block in enumerate(mesh.cells):
        nodes = np.asarray(block.data, dtype=int)
        where = _entity(mesh, k, block.type) if kind == "gmsh" else f"elements {block.type}"
        raw.cells.append(Cells(block.type, nodes, np.arange(first, first + len(nodes)), where))
        first += len(nodes)
        for sets, names in zip(raw.cells[-1].sets, _sets_gmsh(mesh, k, len(nodes)) if kind == "gmsh"
                               else _sets_med(mesh, k, len(nodes))):
            sets.update(names)
    if not raw.cells:
        mistakes.add("mesh", "there are no elements")
    return raw


def _refuse_old_format(path: str) -> None:
    """Only 4.1, which Gmsh writes by default since 4.2."""
    with open(path, "rb") as file:
        head = file.read(200).split(b"\n")
    if head[0].strip() != b"$MeshFormat" or len(head) < 2:
        raise Refused(f"{path}: not a mesh of Gmsh: expected it to begin with $MeshFormat")
    version = head[1].split()[0].decode("ascii", "replace") if head[1].split() else ""
    if version != "4.1":
        raise Refused(f"{path}:2: the format of Gmsh is '{version}': expected 4.1 (in Gmsh: Mesh.MshFileVersion = 4.1)")


def _entity(mesh, k: int, kind: str) -> str:
    """`surface 3`, as Gmsh numbers it."""
    tags = mesh.cell_data.get("gmsh:geometrical")
    word = {"line": "curve", "vertex": "point"}.get(kind.rstrip("0123456789"), "surface")
    if kind.startswith(("tetra", "hexahedron", "wedge", "pyramid")):
        word = "volume"
    return f"{word} {int(tags[k][0])}" if tags and len(tags[k]) else f"elements {kind}"


def _sets_gmsh(mesh, k: int, n: int) -> List[List[str]]:
    """Names of the physical groups of each element; groups without a name are called `physical_3`."""
    names: List[List[str]] = [[] for _ in range(n)]
    for name, held in mesh.cell_sets.items():
        if not name.startswith("gmsh:") and held[k] is not None:
            for e in np.asarray(held[k], dtype=int):
                names[e].append(name)
    tags = mesh.cell_data.get("gmsh:physical")
    if tags:
        for e, tag in enumerate(np.asarray(tags[k], dtype=int)):
            if tag > 0 and not names[e]:
                names[e].append(f"physical_{tag}")
    return names


def _sets_med(mesh, k: int, n: int) -> List[List[str]]:
    """Names of the groups of each element's family."""
    families = mesh.cell_data.get("cell_tags")
    if families is None:
        return [[] for _ in range(n)]
    groups = getattr(mesh, "cell_tags", {})
    return [list(groups.get(int(family), [])) for family in families[k]]
