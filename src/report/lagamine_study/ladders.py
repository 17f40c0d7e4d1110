"""What is asked of a study: ladders of parameters, quantities and what they should be."""
import os
import re
from dataclasses import dataclass, field
from typing import Dict, List, Optional, Sequence

from lagamine_report.errors import ReportError

NAME = r"[A-Za-z][A-Za-z0-9_]*"
PLACES = ("end", "max", "min")
SAME_TIME = 1e-9     # of the end of the run, or of the time itself: two times that differ by no more are one
HIT_ADVICE = "steps hit the times of every LIC and of SAVE TIMES, and @max, @min and the end are always there"


@dataclass
class Rung:
    """Parameters of one run, as `-p` takes them."""

    parameters: Dict[str, str]
    folder: str

    @property
    def title(self) -> str:
        return " ".join(f"{name}={value}" for name, value in self.parameters.items())


@dataclass
class Ladder:
    """Runs from the coarsest to the finest; `ratio` between neighbours is read from the first parameter."""

    name: str
    rungs: List[Rung]

    def ratios(self) -> List[Optional[float]]:
        """How many times finer each rung is than the one before, where the first parameter is a number."""
        first = next(iter(self.rungs[0].parameters))
        try:
            values = [float(rung.parameters[first]) for rung in self.rungs]
        except ValueError:
            return [None] * (len(self.rungs) - 1)
        steps = [abs(b / a) if a else 0.0 for a, b in zip(values, values[1:])]
        return [max(step, 1 / step) if step > 0 and step != 1 else None for step in steps]


@dataclass
class Quantity:
    """A column of the history: at the end, its largest or smallest value, or at a time; and what it should be, where that is known."""

    text: str
    column: str
    place: str = "end"
    time: float = 0.0
    exact: Optional[float] = field(default=None)

    def of(self, history) -> float:
        """The value in a history (columns by name); the end is that of the last operation that has the column."""
        if self.column not in history:
            raise ReportError(f"--quantity {self.text}: no such column; there are: {', '.join(history)}")
        values, known = history[self.column].values, history[self.column].known
        if not len(known):
            return float("nan")
        if self.place in ("max", "min"):
            return float(getattr(known, self.place)())
        if self.place == "end":
            return float(known[-1])
        time = history["time"].values
        k = int(abs(time - self.time).argmin())
        self.refuse_beside(time, time[-1], "no step of a run ends at this time, the nearest at")
        return float(values[k])

    def refuse_beside(self, times: Sequence[float], end: float, why: str) -> None:
        """The time is none of these."""
        nearest = min(times, key=lambda time: abs(time - self.time))
        if abs(nearest - self.time) > SAME_TIME * max(abs(self.time), abs(end)):
            raise ReportError(f"--quantity {self.text}: {why} {nearest:.9g} of {end:.9g}", advice=HIT_ADVICE)

    def refuse_before(self, scene) -> None:
        """A time that steps of this scene (what `lagamine --check` writes) do not hit, whatever their lengths are."""
        if self.place != "time":
            return
        end, steps = scene["end_time"], scene["strategy"]
        times = [0.0, end, *steps.get("save_times", ()), *steps.get("remesh_times", ())]
        for multiplier in scene["multipliers"]:
            times += multiplier["time"]
        if steps["first_step"] == steps["largest_step"]:
            # steps as long as the first one
            times.append(round(self.time / steps["first_step"]) * steps["first_step"])
        self.refuse_beside([time for time in times if 0 <= time <= end], end, "no step of a run has to end at this time, the nearest at")


def read_ladder(text: str, out: str) -> Ladder:
    """`NAME=V1,V2,... [NAME=V1,V2,...]`: parameters that change together, from the coarsest run to the finest."""
    columns: Dict[str, List[str]] = {}
    for word in text.split():
        if not re.fullmatch(rf"{NAME}=[^=]+", word):
            raise ReportError(f"--ladder '{text}': expected NAME=VALUE,VALUE,..., found '{word}'")
        name, _, values = word.partition("=")
        if name in columns:
            raise ReportError(f"--ladder '{text}': {name} is there twice")
        columns[name] = values.split(",")
        if "" in columns[name]:
            raise ReportError(f"--ladder '{text}': {name} has an empty value")
    lengths = {name: len(values) for name, values in columns.items()}
    if not columns or max(lengths.values()) < 2:
        raise ReportError(f"--ladder '{text}': expected two values or more of a parameter")
    if len(set(lengths.values())) > 1:
        raise ReportError(f"--ladder '{text}': as many values of each parameter, found {', '.join(f'{n} of {name}' for name, n in lengths.items())}")
    rungs = []
    for values in zip(*columns.values()):
        chosen = dict(zip(columns, values))
        folder = "_".join(re.sub(r"[^A-Za-z0-9.+-]", "~", f"{name}{value}") for name, value in chosen.items())
        rungs.append(Rung(chosen, os.path.join(out, folder)))
    if len({rung.folder for rung in rungs}) < len(rungs):
        raise ReportError(f"--ladder '{text}': two runs are the same")
    return Ladder(" ".join(columns), rungs)


def read_quantity(text: str, exact: Sequence[str]) -> Quantity:
    """`COLUMN`, `COLUMN@max`, `COLUMN@min` or `COLUMN@TIME`; `COLUMN=VALUE` of --exact says what it should be."""
    column, at, place = text.partition("@")
    quantity = Quantity(text, column)
    if at and place not in PLACES:
        quantity.place = "time"
        quantity.time = _number(place, f"--quantity {text}: expected max, min, end or a time behind @")
    elif at:
        quantity.place = place
    for word in exact:
        name, _, value = word.rpartition("=")
        if name == text:
            quantity.exact = _number(value, f"--exact {word}: expected {name}=NUMBER")
    return quantity


def _number(text: str, message: str) -> float:
    try:
        return float(text)
    except ValueError as error:
        raise ReportError(message) from error
