"""A deck before any run: the scene that `lagamine DECK --check --out DIR` writes."""
import json
import os
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from typing import Dict, List, Optional, Sequence, Tuple

import numpy as np

from .errors import EXIT_INPUT, EXIT_MACHINE, ReportError

VERSION = 1
ENDING = ".scene.json"
COMPONENTS = {1: "X", 2: "Y", 3: "A"}
DISPLACEMENT = 1         # place of the field among those of a scene


@dataclass
class Driven:
    """What moves or loads something: component 1, 2 or 3, the value that goes farthest from 0, when it has it."""

    component: int
    value: float
    time: float
    multiplier: str


class Scene:
    """A scene as numpy arrays; numbers of nodes and dies from 0."""

    def __init__(self, held: dict, words: str) -> None:
        if held.get("format") != "lagamine scene" or held.get("version") != VERSION:
            raise ReportError(f"the scene is of format '{held.get('format')}' {held.get('version')}: expected 'lagamine scene' {VERSION}", EXIT_MACHINE)
        self.held = held
        self.words = words       # what --check prints
        self.title: str = held["title"]
        self.axisymmetric = held["plane_state"] == "AXISYM"
        self.x = np.array(held["coordinates"], dtype=float).reshape(-1, 2)
        self.sides = {item["name"]: np.array(item["nodes"], dtype=int).reshape(-1, 3) - 1 for item in held["side_sets"]}
        self.groups: List[dict] = held["groups"]
        for group in self.groups:
            if "nodes" in group:
                group["nodes"] = np.array(group["nodes"], dtype=int) - 1
        self.dies = [(item["name"], item["deformable"], np.array(item["pilot"]), np.array(item["pieces"]).reshape(-1, 3, 2)) for item in held["dies"]]
        self.contours = {self.groups[item["group"] - 1]["name"]: (np.array(item["pieces"]).reshape(-1, 3, 2), np.array(item["rows"]), np.array(item["loops"]))
                         for item in held["contours"]}

    def bodies(self) -> List[dict]:
        """Groups that are bodies."""
        return [group for group in self.groups if group["role"] == "body"]

    def driven(self, item: dict) -> Driven:
        """Amplitude times multiplier, where it is farthest from 0 within the time of the scene."""
        if item.get("multiplier", 0) == 0:
            return Driven(item.get("component", 0), 0.0, 0.0, "")
        multiplier = self.held["multipliers"][item["multiplier"] - 1]
        times = np.unique(np.clip(np.append(multiplier["time"], self.held["end_time"]), 0, self.held["end_time"]))
        values = item["amplitude"] * np.interp(times, multiplier["time"], multiplier["value"])
        k = int(np.abs(values).argmax())
        return Driven(item.get("component", 0), float(values[k]), float(times[k]), multiplier["name"])

    def place(self, label: str) -> np.ndarray:
        """Points of a place `billet.2+3` of a body that has only a contour (side, 3, 2)."""
        name, _, numbers = label.partition(".")
        if name not in self.contours or not numbers:
            return np.zeros((0, 3, 2))
        pieces, rows, _ = self.contours[name]
        return pieces[np.isin(rows, [int(word) for word in numbers.split("+") if word.isdigit()])]

    def zone_places(self) -> Dict[int, np.ndarray]:
        """Where the points of zones are at the start, by number; those that cross a line on the outline."""
        outline = self.outline()
        result = {}
        for k, point in enumerate(self.held["zone_points"], 1):
            if point["form"] != "CROSSING":
                result[k] = np.array(point["x"])
                continue
            axis, value = point["axis"] - 1, point["x"][0]
            a, b = outline[:, 0], outline[:, -1]
            cut = (a[:, axis] - value) * (b[:, axis] - value) <= 0
            if cut.any():
                span = b[cut, axis] - a[cut, axis]
                share = np.where(span == 0, 0.0, (value - a[cut, axis]) / np.where(span == 0, 1.0, span))
                places = a[cut] + share[:, None] * (b[cut] - a[cut])
                result[k] = places[int((point["pick"] * places[:, 1 - axis]).argmax())]
        return result

    def outline(self) -> np.ndarray:
        """Chords of the outline (chord, 2, 2), of meshes and of contours."""
        from .geometry import all_sides, line3
        curves = [np.einsum("pk,skd->spd", line3(np.linspace(-1, 1, 9)), pieces) for pieces, _, _ in self.contours.values()]
        nodes = [group["nodes"] for group in self.bodies() if len(group["nodes"])]
        if nodes:
            sides = all_sides(np.concatenate(nodes))[1]
            curves.append(np.einsum("pk,skd->spd", line3(np.linspace(-1, 1, 9)), self.x[sides]))
        return np.concatenate([np.stack([c[:, :-1], c[:, 1:]], axis=2).reshape(-1, 2, 2) for c in curves])


def solver_program() -> str:
    """The solver beside this program, otherwise the one of the path."""
    program = os.path.join(os.path.dirname(os.path.realpath(sys.argv[0])), "lagamine")
    return program if os.path.exists(program) else "lagamine"


def ask_solver(arguments: Sequence[str], parameters: Sequence[str]) -> str:
    """What the solver prints; what it refuses is refused in its words."""
    program = solver_program()
    options = [word for parameter in parameters for word in ("-p", parameter)]
    try:
        done = subprocess.run([program, *arguments, *options], stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False, errors="replace")
    except OSError as error:
        raise ReportError(f"{program}: cannot be started: {error.strerror}", EXIT_MACHINE) from error
    if done.returncode != 0:
        raise ReportError(done.stderr.strip() or f"{program} ended with {done.returncode}", done.returncode if done.returncode > 0 else EXIT_MACHINE)
    return done.stdout


def read_scene(deck: str, parameters: Sequence[str] = ()) -> Scene:
    """The scene of a deck, by the solver beside this program; a deck that it refuses is refused in its words."""
    with tempfile.TemporaryDirectory(prefix="lagareport-") as folder:
        words = ask_solver([deck, "--check", "--out", folder], parameters)
        return read_scene_file(os.path.join(folder, deck_name(deck) + ENDING), words)


def read_scene_file(path: str, words: str = "") -> Scene:
    """The scene in a file of the solver, with the words of its --check where they are known."""
    try:
        with open(path, encoding="utf-8") as file:
            return Scene(json.load(file), words)
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        raise ReportError(f"{path}: holds no scene that can be read ({error}): is {solver_program()} of the same version?",
                          EXIT_MACHINE if words else EXIT_INPUT) from error


def checked_scene(place: str) -> Optional[str]:
    """The scene that `--check --out DIR` has left: the file itself, or the only one of a folder without results; None where there is none."""
    if os.path.isfile(place):
        return place if place.endswith(ENDING) else None
    names = os.listdir(place) if os.path.isdir(place) else []
    scenes = sorted(name for name in names if name.endswith(ENDING))
    if not scenes or any(name == "summary.json" or name.endswith((".log", ".h5")) for name in names):
        return None
    if len(scenes) > 1:
        raise ReportError(f"{place}: holds {len(scenes)} scenes: give one of them, {', '.join(scenes)}")
    return os.path.join(place, scenes[0])


def deck_name(deck: str) -> str:
    """Name of a file without folders and ending, as the solver calls its files."""
    return os.path.splitext(os.path.basename(deck))[0]


def side_label(name: str, bodies: Sequence[str]) -> Tuple[str, bool]:
    """What is written beside a set of sides: the number of a block's side, or the name of a set."""
    body, dot, number = name.rpartition(".")
    return (number, True) if dot and body in bodies and number.isdigit() else (name, False)
