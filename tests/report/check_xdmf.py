#!/usr/bin/env python3
"""Hold every .xdmf of a folder of results against the HDF5 files it points into.

usage: check_xdmf.py DIR...
Every array must exist and have the shape and type that the XDMF file says; topologies must point to nodes that exist;
times must grow; every saved step must be in it. Exit code 0 when all of it holds, 1 with one line per fault.
"""
import glob
import os
import re
import sys
import xml.etree.ElementTree as ElementTree

import h5py
import numpy as np

COMPONENTS = {"Scalar": 1, "Vector": 3, "Tensor6": 6, "Tensor": 9}
NODES = {"Quadrilateral_8": 8, "Quadrilateral": 4, "Edge_3": 3}
TYPES = {("Float", "8"): np.dtype("<f8"), ("Int", "4"): np.dtype("<i4")}


class Checker:
    """Faults found in one XDMF file."""

    def __init__(self, path):
        self.path = path
        self.faults = []
        self.files = {}
        self.saved = {}
        self.last = None, None, None    # file, place and values of the array read last: its components are asked for one by one

    def fault(self, text):
        self.faults.append(f"{self.path}: {text}")

    def file(self, name):
        """The HDF5 file of this name beside the XDMF file; None, reported once, when it cannot be opened."""
        if name not in self.files:
            try:
                self.files[name] = h5py.File(os.path.join(os.path.dirname(self.path), name), "r")
            except OSError as error:
                self.files[name] = None
                self.fault(f"{name}: {str(error).splitlines()[0]}")
        return self.files[name]

    def array(self, parent, where, shape):
        """The array of a DataItem, None when something about it is wrong."""
        item = parent.find("DataItem")
        if item is not None and item.get("ItemType") == "HyperSlab":
            return self.component(item, where, shape)
        if item is None or item.get("Format") != "HDF":
            self.fault(f"{where}: no DataItem of format HDF")
            return None
        name, _, place = (item.text or "").strip().partition(":")
        file = self.file(name)
        if file is None:
            return None
        if place not in file:
            self.fault(f"{where}: {name} has no {place}")
            return None
        said = tuple(int(word) for word in item.get("Dimensions", "").split())
        data = file[place]
        if said != data.shape:
            self.fault(f"{where}: {name}:{place} has the shape {data.shape}, the XDMF file says {said}")
            return None
        if shape is not None and said != shape:
            self.fault(f"{where}: {name}:{place} has the shape {said}, {shape} is wanted here")
            return None
        kind = TYPES.get((item.get("NumberType"), item.get("Precision")))
        if kind is None or data.dtype != kind:
            self.fault(f"{where}: {name}:{place} is {data.dtype}, the XDMF file says "
                       f"{item.get('NumberType')} of {item.get('Precision')} bytes")
            return None
        if self.last[:2] != (name, place):
            self.last = name, place, data[()]
        return self.last

    def component(self, item, where, shape):
        """A component of an array of three extents; None when something about it is wrong."""
        said = tuple(int(word) for word in item.get("Dimensions", "").split())
        (place, stride, count), whole = np.array(item.findall("DataItem")[0].text.split(), int).reshape(3, 3), item.findall("DataItem")[1]
        extents = tuple(int(word) for word in whole.get("Dimensions").split())
        holder = ElementTree.Element("Attribute")
        holder.append(whole)
        found = self.array(holder, where, extents)
        if found is None:
            return None
        if list(stride) != [1, 1, 1] or tuple(count) != said or said != (*extents[:2], 1) or not 0 <= place[2] < extents[2] or any(place[:2]):
            self.fault(f"{where}: the hyperslab {place} {stride} {count} does not fit {extents}")
            return None
        values = found[2][:, :, place[2]].ravel()
        if shape is not None and values.shape != shape:
            self.fault(f"{where}: {values.shape} values, {shape} are wanted here")
            return None
        return found[0], found[1], values

    def instant(self, grid, number, last_time):
        """One instant, of one grid or of several together; returns its time."""
        where = f"grid {number}"
        time = float(grid.find("Time").get("Value"))
        if not time >= last_time:
            self.fault(f"{where}: time {time} after {last_time}")
        parts = grid.findall("Grid") if grid.get("CollectionType") == "Spatial" else [grid]
        if not parts:
            self.fault(f"{where}: no grids in it")
        for part in parts:
            self.grid(part, f"{where}, {part.get('Name')}" if part is not grid else where, time)
        return time

    def grid(self, grid, where, time):
        """One grid of an instant."""
        topology, geometry = grid.find("Topology"), grid.find("Geometry")
        width = {"XY": 2, "XYZ": 3}.get(geometry.get("GeometryType"))
        found = self.array(geometry, f"{where}, geometry", None)
        nodes = None
        if found:
            name, place, x = found
            nodes = len(x)
            instant = re.fullmatch(r"(.*)/(\d+)\.h5", name)     # NAME.gNN/NNNNNN.h5 of NAME.gNN.h5
            mesh, step = (instant[1] + ".h5", f"steps/{instant[2]}") if instant else (name, os.path.dirname(place).strip("/"))
            self.saved.setdefault(mesh, set()).add(step)
            if x.shape != (nodes, width):
                self.fault(f"{where}: coordinates of shape {x.shape} are not {geometry.get('GeometryType')}")
            if not np.isfinite(x).all():
                self.fault(f"{where}: coordinates are not finite")
            stored = self.files[name].attrs.get("time")
            if stored is not None and stored != time:
                self.fault(f"{where}: time {time}, {name} says {stored}")
        elements = int(topology.get("NumberOfElements"))
        if topology.get("TopologyType") == "Polyvertex":
            if elements != nodes:
                self.fault(f"{where}: {elements} points, coordinates of {nodes}")
            found = None
        else:
            found = self.array(topology, f"{where}, topology", (elements, NODES.get(topology.get("TopologyType"))))
        if found and nodes is not None and found[2].size and not 0 <= found[2].min() <= found[2].max() < nodes:
            self.fault(f"{where}: topology points to nodes {found[2].min()} to {found[2].max()} of {nodes}")
        names = set()
        for field in grid.findall("Attribute"):
            label = f"{where}, {field.get('Name')}"
            if field.get("Name") in names:
                self.fault(f"{label}: given twice")
            names.add(field.get("Name"))
            n = {"Node": nodes, "Cell": elements}.get(field.get("Center"))
            components = COMPONENTS.get(field.get("AttributeType"))
            if components is None or field.get("Center") not in ("Node", "Cell"):
                self.fault(f"{label}: {field.get('AttributeType')} at {field.get('Center')} is not known")
            elif n is not None:
                self.array(field, label, (n,) if components == 1 else (n, components))

    def check(self):
        """All grids, and all steps that were saved."""
        try:
            grids = ElementTree.parse(self.path).getroot().findall("./Domain/Grid/Grid")
            if not grids:
                self.fault("no grids")
            time = -np.inf
            for number, grid in enumerate(grids, start=1):
                time = self.instant(grid, number, time)
        except (ElementTree.ParseError, OSError, AttributeError, TypeError, ValueError) as error:
            self.fault(f"damaged: {error}")
            grids = []
        stem = re.sub(r"(\.dies|\.points)?\.xdmf$", "", self.path)
        for path in sorted(glob.glob(glob.escape(stem) + ".g[0-9][0-9].h5")):
            file = self.file(os.path.basename(path))
            for step in file.get("steps", {}) if file else ():
                if f"steps/{step}" not in self.saved.get(os.path.basename(path), ()):
                    self.fault(f"step {step} of {os.path.basename(path)} is not in it")
        for file in self.files.values():
            if file:
                file.close()
        return len(grids)


def check_folder(folder):
    """Faults of all XDMF files of a folder, a list of texts, and how many grids were looked at."""
    faults, grids = [], 0
    paths = sorted(glob.glob(os.path.join(glob.escape(folder), "*.xdmf")))
    if not paths:
        faults.append(f"{folder}: no XDMF file")
    for path in paths:
        checker = Checker(path)
        grids += checker.check()
        faults += checker.faults
    return faults, grids


def main(folders):
    if not folders or folders[0].startswith("-"):
        print(__doc__, file=sys.stderr)
        return 0 if folders and folders[0] in ("-h", "--help") else 2
    code = 0
    for folder in folders:
        faults, grids = check_folder(folder)
        for fault in faults:
            print(fault)
        print(f"{folder}: {grids} grids, {len(faults)} faults")
        code = code or (1 if faults else 0)
    return code


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
