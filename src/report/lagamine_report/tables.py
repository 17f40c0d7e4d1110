"""The files of a run that are text: summary.json, history.csv and the listing."""
import csv
import json
import math
import os
import re
from dataclasses import dataclass
from typing import Any, Dict, List, Optional

import numpy as np

from .errors import ReportError

# The line of the listing with which a call of the solver ends.
REAL = r"([0-9.]+(?:[eE][-+]?[0-9]+)?)"
CALL = re.compile(rf"  [0-9]+ equations, .* {REAL} s on the wall, .* {REAL} MB")
# Lines with which the table begins that a call ends with where more is to come, and the part that goes on from it.
STOPPED, RESUMED, NEW_MESH_DUE = "stopped: ", "resumed from ", "a new mesh is due"
OF_OPERATION = re.compile("WARNING: operation [^ :]+: ")
# Objects of a summary that the page looks into.
ENTRIES = ("effects", "seconds", "checks", "energy", "advice")


@dataclass
class Column:
    """A column of the history: `name [unit]` and its numbers, one per accepted step."""

    name: str
    unit: str
    values: np.ndarray

    @property
    def title(self) -> str:
        """Name and unit as an axis shows them."""
        return f"{self.name} [{self.unit}]" if self.unit else self.name

    @property
    def known(self) -> np.ndarray:
        """The numbers of steps that have one: not those of operations without this die or probe."""
        return self.values[~np.isnan(self.values)]

    @property
    def largest(self) -> float:
        """The number of the largest size; NaN where there is none."""
        return float(self.known[np.abs(self.known).argmax()]) if len(self.known) else math.nan


def read_text(path: str) -> str:
    """Text of a file. What is not UTF-8 (a title in an old deck) is read as Latin-1."""
    try:
        with open(path, "rb") as file:
            raw = file.read()
    except OSError as error:
        raise ReportError(f"{path}: {missing_or(error)}") from error
    try:
        return raw.decode("utf-8")
    except UnicodeDecodeError:
        return raw.decode("latin-1")


def missing_or(error: OSError) -> str:
    """Why a file could not be read, in words."""
    return "missing" if isinstance(error, FileNotFoundError) else f"cannot be read: {error.strerror or error}"


def read_object(path: str) -> Dict[str, Any]:
    """The object in a JSON file."""
    try:
        found = json.loads(read_text(path))
    except ValueError as error:
        raise ReportError(f"{path}: damaged: not JSON: {error}") from error
    if not isinstance(found, dict):
        raise ReportError(f"{path}: damaged: an object was expected")
    return found


def read_summary(path: str) -> Dict[str, Any]:
    """The object in summary.json, with the entries that the page cannot do without."""
    summary = read_object(path)
    for name in ("deck", "status"):
        if not isinstance(summary.get(name), str):
            raise ReportError(f"{path}: damaged: '{name}' is missing or not a text")
    for name, entry in with_entries(summary).items():
        if name in ENTRIES and not isinstance(entry, dict):
            raise ReportError(f"{path}: damaged: '{name}' is not an object")
    for name, effect in summary["effects"].items():
        if not isinstance(effect, dict):
            raise ReportError(f"{path}: damaged: effect '{name}' is not an object")
    return summary


def with_entries(summary: Dict[str, Any]) -> Dict[str, Any]:
    """The same, with an empty object for every one that is not there."""
    for name in ENTRIES:
        summary.setdefault(name, {})
    return summary


def warnings_of(summary: Dict[str, Any], checks: bool = True) -> List[str]:
    """What speaks against a result: the warnings in its summary, those of an operation before the last one with its name. Without
    `checks`, those that are no check of the end."""
    found = []
    given = summary.get("warnings")
    for told in given if isinstance(given, list) else []:
        if not isinstance(told, dict) or not isinstance(told.get("text"), str):
            continue
        earlier = isinstance(told.get("operation"), str) and told["operation"] != summary.get("operation")
        if not checks and told.get("check") in summary["advice"]:
            continue
        found.append(f"operation {told['operation']}: {told['text']}" if earlier else told["text"])
    return found


def read_history(path: str) -> Dict[str, Column]:
    """Columns of history.csv by name, in the order of the file."""
    return columns_of(path, read_text(path))


def read_history_so_far(path: str) -> Dict[str, Column]:
    """The same of a run that has not ended: a row that is half written is left out; empty where no row can be."""
    text = read_text(path) if os.path.exists(path) else ""
    text = text[:text.rfind("\n") + 1]
    return columns_of(path, text) if text else {}


def columns_of(path: str, text: str) -> Dict[str, Column]:
    """Columns of the text of a history."""
    rows = list(csv.reader(text.splitlines()))
    if not rows or not rows[0] or not rows[0][0].startswith("time"):
        raise ReportError(f"{path}: damaged: no header that begins with 'time'")
    numbers = np.empty((len(rows) - 1, len(rows[0])))
    for line, row in enumerate(rows[1:], start=2):
        if len(row) != len(rows[0]):
            raise ReportError(f"{path}:{line}: damaged: {len(row)} cells, {len(rows[0])} expected")
        try:
            numbers[line - 2] = [float(cell) for cell in row]
        except ValueError as error:
            raise ReportError(f"{path}:{line}: damaged: {error}") from error
    columns: Dict[str, Column] = {}
    for k, title in enumerate(rows[0]):
        name, _, unit = title.partition(" [")
        columns[name.strip()] = Column(name.strip(), unit.rstrip("] "), numbers[:, k])
    return columns


def rows_up_to(history: Dict[str, Column], step: int) -> Dict[str, Column]:
    """The rows of a history up to a step."""
    if "step" not in history:
        return history
    kept = history["step"].values <= step
    return {name: Column(column.name, column.unit, column.values[kept]) for name, column in history.items()}


def read_notes(path: str) -> Dict[str, List[str]]:
    """From the listing: the steps that were cut, and its warnings, each once: it has those of the deck before and after the steps.

    What the table warned of that a part ended with is judged anew by that of the part which went on from it; of a part that ended as
    a new mesh was due it stays. The end of the last operation repeats what those before were warned of, with their names.
    """
    notes: Dict[str, List[str]] = {"cutbacks": [], "warnings": []}
    closing: Optional[List[str]] = None     # warnings of a closing table that may be superseded
    for line in read_text(path).splitlines():
        if line.startswith("cutback:"):
            notes["cutbacks"].append(line[8:].strip())
        elif line.startswith(STOPPED):
            closing = [] if NEW_MESH_DUE not in line else None
        elif line.startswith(RESUMED):
            closing = None
        elif "WARNING" in line or line.lower().startswith("warning:"):
            (notes["warnings"] if closing is None else closing).append(line.strip())
    told = list(dict.fromkeys(notes["warnings"] + (closing or [])))
    repeated = {OF_OPERATION.sub("WARNING: ", line) for line in told if OF_OPERATION.match(line)}
    notes["warnings"] = [line for line in told if line not in repeated]
    return notes


@dataclass
class Calls:
    """Calls of the solver that ended and said so in the listing: how many, their seconds on the wall, the largest memory in MB."""

    number: int = 0
    wall: float = 0.0
    memory: float = 0.0


def read_calls(path: str) -> Calls:
    """From the listing, to which every call adds; one that was killed adds nothing."""
    calls = Calls()
    for line in read_text(path).splitlines():
        match = CALL.fullmatch(line)
        if match:
            calls = Calls(calls.number + 1, calls.wall + float(match.group(1)), max(calls.memory, float(match.group(2))))
    return calls


def number(value: Any) -> float:
    """A JSON number; NaN for any other value (the solver writes NaN and infinity as null)."""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return math.nan
    return float(value)
