"""Cooling curves of steels with phases: temperature over the logarithm of time, and what a heat treater reads from them."""
from dataclasses import dataclass
from typing import List, Optional

import numpy as np

from .picture import Picture
from .reader import Run
from .style import LINES, SOFT, figure
from .tables import Column, number
from .words import brief

HOT, COLD, RATE_AT = 800.0, 500.0, 700.0      # degC: t8/5, and where the rate of cooling is read


@dataclass
class Cooling:
    """A temperature probe: times [s] and temperatures [degC]; seconds from 800 to 500 degC and rate at 700 degC [K/s], not a number where the
    curve does not pass there."""

    name: str
    time: np.ndarray
    temperature: np.ndarray
    t85: float
    rate: float


def coolings(run: Run) -> List[Cooling]:
    """The temperature probes of a scene with phases."""
    steels = run.summary.get("steels") or []
    if not steels:
        return []
    zero, seconds = number(steels[0].get("added_for_degC", 0)), number(steels[0].get("seconds", 1))
    time = run.history["time"].values * seconds
    return [_read(column, time, column.values + zero) for column in run.history.values() if column.unit == "temperature"]


def _read(column: Column, time: np.ndarray, temperature: np.ndarray) -> Cooling:
    last = _passed(time, temperature, COLD)
    first = _passed(time, temperature, HOT, before=last)
    return Cooling(column.name, time, temperature, last - first, _rate(time, temperature, RATE_AT))


def _passed(time: np.ndarray, temperature: np.ndarray, level: float, before: float = np.inf) -> float:
    """When the temperature falls through a level for the last time before another instant; straight between steps."""
    falls = np.flatnonzero((temperature[:-1] >= level) & (temperature[1:] < level))
    when = [float(np.interp(level, temperature[[k + 1, k]], time[[k + 1, k]])) for k in falls]
    when = [instant for instant in when if instant <= before]
    return when[-1] if when and not np.isnan(before) else float("nan")


def _rate(time: np.ndarray, temperature: np.ndarray, level: float) -> float:
    """Rate of cooling where the temperature first falls through a level: the slope of the parabola through the step and the one before."""
    falls = np.flatnonzero((temperature[:-1] >= level) & (temperature[1:] < level))
    if not len(falls):
        return float("nan")
    k = max(int(falls[0]) - 1, 0)
    places = np.arange(k, min(k + 3, len(time)))
    parabola = np.polynomial.Polynomial.fit(time[places], temperature[places], len(places) - 1)
    return -float(parabola.deriv()(_passed(time[:falls[0] + 2], temperature[:falls[0] + 2], level)))


def cooling_table(run: Run) -> List[List[str]]:
    """Rows: probe, seconds from 800 to 500 degC, rate at 700 degC, last temperature."""
    def words(value: float) -> str:
        return "–" if np.isnan(value) else brief(value)
    return [[one.name, words(one.t85), words(one.rate), words(float(one.temperature[-1]))] for one in coolings(run)]


def cooling_picture(run: Run) -> Optional[Picture]:
    """Temperatures of the probes over the logarithm of time."""
    held = coolings(run)
    if not held or not (held[0].time > 0).any():
        return None
    fig, axes = figure(1, 1, (7.6, 4.2))
    panel = axes[0, 0]
    for one, colour in zip(held, LINES * len(held)):
        later = one.time > 0
        panel.plot(one.time[later], one.temperature[later], color=colour, label=one.name)
    for level in (HOT, COLD):
        panel.axhline(level, color=SOFT, lw=0.7, dashes=(4, 3))
    panel.set_xscale("log")
    panel.set_xlabel("time [s]")
    panel.set_ylabel("temperature [°C]")
    panel.legend()
    return Picture("cooling", "temperatures of the probes; dashed: 800 and 500 °C", fig, vector=True)
