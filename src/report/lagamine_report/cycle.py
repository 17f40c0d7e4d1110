"""The tries of a cycle: cycle.csv, and what the remesher and the restart report on every new mesh."""
import csv
import math
import os
from dataclasses import dataclass, field
from typing import Any, Dict, List, Optional

from .errors import ReportError
from .tables import number, read_object, read_text

WHOLE = ("generation", "try", "step")
NUMBERS = ("stop_time", "old_elements", "new_elements", "error_before", "error_after", "first_residual", "iterations",
           "force_change", "energy_change", "depth_change", "least_step_ratio", "first_step_force_change", "remdata", "restart")
# Columns that older tables do not have.
LATER = ("laps", "lap_depth", "removed_volume")
TEXTS = ("trigger", "action", "accepted", "stage", "reason")
KEEPS_OLD = "old mesh"
AGREED = "agreed force"
LIMIT = "_limit"
# What the restart balances: name in NAME.gNN.restart.json, without `_before` and `_after`, and in words.
BALANCES = {"volume": "volume", "elastic_energy": "elastic energy", "plastic_work": "plastic work that points keep"}


@dataclass
class Change:
    """A quantity on the old mesh and on the new one: its whole, and its largest value where that is given."""

    name: str
    before: float
    after: float
    largest_before: float = math.nan
    largest_after: float = math.nan
    balance: bool = False

    @property
    def percent(self) -> float:
        return 100 * (self.after - self.before) / abs(self.before) if self.before else math.nan


@dataclass
class Try:
    """A row of cycle.csv. `numbers` are NaN where the cell is empty."""

    generation: int
    number: int
    step: int
    numbers: Dict[str, float]
    texts: Dict[str, str]
    changes: List[Change] = field(default_factory=list)
    # What was found against what is allowed, as shares: of files that are there.
    limits: Dict[str, float] = field(default_factory=dict)
    # Volume as the mesh began, and that of its matter as the scene began (what cuts removed is no part of it); NaN where not given.
    volume: float = math.nan
    initial_volume: float = math.nan

    @property
    def refused(self) -> bool:
        return self.texts["accepted"] != "y"

    @property
    def keeps_old(self) -> bool:
        """Was it decided that the old mesh goes on?"""
        return self.texts["action"] == KEEPS_OLD


def read_cycle(folder: str, name: str) -> List[Try]:
    """All tries in the order of the table; none where the run is no cycle's."""
    path = os.path.join(folder, "cycle.csv")
    if not os.path.exists(path):
        return []
    rows = list(csv.reader(read_text(path).splitlines()))
    titles = [title.partition(" [")[0].strip() for title in rows[0]] if rows else []
    for title in WHOLE + NUMBERS + TEXTS:
        if title not in titles:
            raise ReportError(f"{path}: damaged: no column '{title}'")
    tries = []
    for line, row in enumerate(rows[1:], start=2):
        if len(row) != len(titles):
            raise ReportError(f"{path}:{line}: damaged: {len(row)} cells, {len(titles)} expected")
        cells = dict(zip(titles, row))
        try:
            whole = [int(cells[title]) for title in WHOLE]
            numbers = {title: float(cells.get(title) or "nan") for title in NUMBERS + LATER}
        except ValueError as error:
            raise ReportError(f"{path}:{line}: damaged: {error}") from error
        tries.append(Try(*whole, numbers, {title: cells[title] for title in TEXTS}))
    for row in new_meshes(tries):
        stem = os.path.join(folder, f"{name}.g{row.generation:02d}")
        restart, steps = optional_object(f"{stem}.restart.json"), optional_object(f"{stem}.probation.json")
        row.limits = {key[:-len(LIMIT)]: number(value) for key, value in {**restart, **steps}.items() if key.endswith(LIMIT)}
        row.volume, row.initial_volume = number(restart.get("volume_before")), number(restart.get("initial_volume"))
        row.changes = read_changes(stem, restart)
    return tries


def new_meshes(tries: List[Try]) -> List[Try]:
    """The accepted try of every new mesh."""
    return list({row.generation: row for row in tries if not row.refused and not row.keeps_old}.values())


def refused_last(tries: List[Try]) -> Optional[Try]:
    """The last try, where its mesh was refused and nothing went on from there."""
    return tries[-1] if tries and tries[-1].refused and not tries[-1].keeps_old else None


def optional_object(path: str) -> Dict[str, Any]:
    """The object in a JSON file; empty where there is no such file."""
    return read_object(path) if os.path.exists(path) else {}


def read_changes(stem: str, restart: Dict[str, Any]) -> List[Change]:
    """What changed from mesh to mesh: balances of the restart, then the fields that were carried; of files that are there."""
    changes = [Change(words, number(restart.get(f"{name}_before")), number(restart.get(f"{name}_after")), balance=True)
               for name, words in BALANCES.items() if f"{name}_before" in restart]
    path = f"{stem}.start.h5.json"
    if not os.path.exists(path):
        return changes
    rows: Any = read_object(path).get("transfer", [])
    if not isinstance(rows, list) or not all(isinstance(row, dict) and isinstance(row.get("name"), str) for row in rows):
        raise ReportError(f"{path}: damaged: 'transfer' is not a list of named rows")
    return changes + [Change(row["name"], *(number(row.get(key)) for key in ("before", "after", "largest_before", "largest_after")))
                      for row in rows]
