"""Diagrams of a steel: what forms at one temperature and while it cools, with cooling curves of a part on them."""
from typing import List, Optional, Sequence, Tuple

import numpy as np

from .cooling import Cooling, coolings
from .picture import Picture
from .reader import Run
from .style import INK, LINES, SOFT, figure

ROOM = 20.0            # degC, where diagrams end
USUAL_START = 800.0    # degC, from where times count where neither Ae3 nor Ac3 is known
SHORTEST = 0.1         # s
PHASE_COLOURS = {"FERRITE": LINES[0], "PEARLITE": LINES[2], "BAINITE": LINES[4], "MARTENSITE": LINES[1], "TEMPERED": LINES[7], "AUSTENITE": SOFT}
MOST_CURVES = 8        # of a part in one diagram


def start_of_times(steel: dict) -> Tuple[float, str]:
    """The temperature from which times of cooling count, and its name."""
    known = steel["temperatures"]
    for name in ("Ae3", "Ac3"):
        if name in known:
            return float(known[name]), name
    return USUAL_START, f"{USUAL_START:g} °C"


def since(curve: Cooling, start: float) -> Tuple[np.ndarray, np.ndarray]:
    """Times after the last fall through a temperature before the curve is coldest, and temperatures; empty where it never falls through."""
    coldest = int(curve.temperature.argmin())
    falls = np.flatnonzero((curve.temperature[:coldest] >= start) & (curve.temperature[1:coldest + 1] < start))
    if not len(falls):
        return np.zeros(0), np.zeros(0)
    k = int(falls[-1])
    share = (curve.temperature[k] - start) / (curve.temperature[k] - curve.temperature[k + 1])
    passed = curve.time[k] + share * (curve.time[k + 1] - curve.time[k])
    return curve.time[k + 1:] - passed, curve.temperature[k + 1:]


def has_diagrams(steel: dict) -> bool:
    """There is something to draw."""
    return bool(steel.get("isothermal") or _forms_while_it_cools(steel))


def _forms_while_it_cools(steel: dict) -> bool:
    """Something forms at one of the rates at least."""
    held = steel.get("coolings")
    return bool(held) and any(value is not None for curve in (held["end"], *(phase.get("start", []) for phase in held["phases"])) for value in curve)


def diagram_picture(steel: dict, curves: Sequence[Cooling] = (), name: str = "diagram") -> Picture:
    """The isothermal diagram and that of continuous cooling, those that the steel has."""
    panels = [draw for draw, shown in ((_isothermal, steel.get("isothermal")), (_cooling, _forms_while_it_cools(steel))) if shown]
    fig, axes = figure(1, len(panels), (4.6 * len(panels) + 0.6, 4.4))
    start, word = start_of_times(steel)
    drawn = [(curve.name, *since(curve, start)) for curve in curves]
    drawn = [one for one in drawn if len(one[1])][:MOST_CURVES]
    for panel, draw in zip(axes.flat, panels):
        draw(panel, steel)
        _lines(panel, steel)
        for k, (label, time, temperature) in enumerate(drawn):
            panel.plot(time, temperature, color=INK, lw=0.9, dashes=[(None, None), (4, 2), (1, 1.5), (5, 1.5, 1, 1.5)][k % 4], label=label, zorder=3)
        panel.set_xscale("log")
        low, high = panel.get_xlim()
        panel.set_xlim(max(low, SHORTEST), min(high, 1e7))
        panel.set_ylim(ROOM, max([start, *steel["temperatures"].values()]) + 40)
        panel.set_xlabel("time [s]")
        panel.set_ylabel("temperature [°C]")
        panel.legend(fontsize=7.5, loc="best")
    part = f"; black: probes of the part, time from {word}" if drawn else ""
    return Picture(name, f"{steel['name']}: 1, 50, 99 % of what can form at one temperature; while it cools at constant rates, 1 % of each phase and 99 % of all{part}",
                   fig, vector=True, heading=f"Steel {steel['name']}")


def hardness_picture(steel: dict, name: str = "mixtures") -> Optional[Picture]:
    """Mixtures and hardness at the end of coolings at constant rates."""
    held = steel.get("coolings")
    if not held:
        return None
    fig, axes = figure(1, 1, (7.2, 3.8))
    panel = axes[0, 0]
    for phase in held["phases"]:
        panel.plot(held["rate"], phase["share"], color=PHASE_COLOURS[phase["phase"]], label=phase["phase"].lower())
    panel.set_xscale("log")
    panel.set_xlabel("cooling rate [K/s]")
    panel.set_ylabel("fraction at 20 °C")
    panel.legend(loc="center left")
    if "hardness" in held:
        right = panel.twinx()
        right.plot(held["rate"], held["hardness"], color=INK, dashes=(4, 2))
        right.set_ylabel("hardness [HV], dashed")
        right.spines["right"].set_visible(True)
    return Picture(name, f"{steel['name']}: what is there after cooling at constant rates", fig, vector=True, heading=f"Steel {steel['name']}, coolings")


def run_diagrams(run: Run) -> List[Picture]:
    """A diagram for each steel of a run, with the cooling curves of its probes."""
    steels: dict = {}
    for steel in run.summary.get("steels") or []:
        if has_diagrams(steel):
            steels.setdefault(steel["name"], steel)
    curves = coolings(run)
    return [diagram_picture(steel, curves, f"diagram_{k}") for k, steel in enumerate(steels.values(), 1)]


def _isothermal(panel, steel: dict) -> None:
    panel.set_title("at one temperature")
    for held in steel["isothermal"]:
        colour = PHASE_COLOURS[held["phase"]]
        for key, dashes in (("start", (None, None)), ("half", (1, 1.5)), ("end", (4, 2))):
            panel.plot(np.array(held[key], dtype=float), held["temperature"], color=colour, dashes=dashes,
                       label=held["phase"].lower() if key == "start" else None)


def _cooling(panel, steel: dict) -> None:
    panel.set_title("while it cools")
    held = steel["coolings"]
    start, _ = start_of_times(steel)

    def curve(temperatures: Sequence[Optional[float]], **style) -> None:
        temperature = np.array(temperatures, dtype=float)     # null: not a number, a gap
        temperature[temperature >= start] = np.nan
        panel.plot((start - temperature) / np.array(held["rate"]), temperature, **style)
    for phase in held["phases"]:
        if any(value is not None for value in phase.get("start", [])):
            curve(phase["start"], color=PHASE_COLOURS[phase["phase"]], label=phase["phase"].lower(), marker=".", ms=3)
    curve(held["end"], color=SOFT, dashes=(4, 2), label="99 %")


def _lines(panel, steel: dict) -> None:
    """Temperatures of the steel as lines with their names."""
    for name in ("Ae1", "Ae3", "Bs", "Ms"):
        if name in steel["temperatures"]:
            value = steel["temperatures"][name]
            panel.axhline(value, color=SOFT, lw=0.6, dashes=(6, 4), zorder=0)
            panel.text(0.005, value, name, transform=panel.get_yaxis_transform(), fontsize=7.5, color=SOFT, va="bottom")
