"""Curves of the history: forces, probes, steps, energies, seconds."""
from typing import Dict, List, Optional

import numpy as np
from matplotlib.ticker import MaxNLocator

from .picture import Picture
from .reader import Run
from .style import LINES, SOFT, WARN, figure, plain_numbers
from .tables import Column, number

FIXED_COLUMNS = ["time", "step", "step_length", "iterations", "cutbacks", "strain_increment", "external_work", "elastic_energy",
                 "plastic_work", "friction_work", "volume_drift", "max_penetration", "points_sticking", "points_slipping"]
HEAT_COLUMNS = ["heat_stored", "heat_in", "heat_released", "heat_imbalance"]
THROUGH = "heat_through_"
DIE_COLUMNS = ["force_x_", "force_y_", "moment_", "displacement_x_", "displacement_y_", "rotation_", "temperature_", "heat_flow_"]


def moved(values: np.ndarray) -> float:
    """How far a quantity went."""
    finite = values[np.isfinite(values)]
    return float(np.ptp(finite)) if finite.size else 0.0


def die_abscissa(history: Dict[str, Column], die: str) -> Column:
    """What a die's force is drawn over: its larger motion, the time when it does not move."""
    motions = [history[f"displacement_{c}_{die}"] for c in "xy" if f"displacement_{c}_{die}" in history]
    motions.sort(key=lambda column: -moved(column.values))
    if motions and moved(motions[0].values) > 0:
        return motions[0]
    return history["time"]


def force_picture(run: Run) -> Optional[Picture]:
    """Force of each die over its stroke; its moment too, when it turns."""
    history = run.history
    dies = [die for die in run.die_names if f"force_y_{die}" in history]
    if not dies or not len(history["time"].values):
        return None
    turning = {die for die in dies if moved(history[f"rotation_{die}"].values) > 0} if dies else set()
    panels = [(die, "force") for die in dies] + [(die, "moment") for die in dies if die in turning]
    columns = min(2, len(panels))
    rows = -(-len(panels) // columns)
    fig, axes = figure(rows, columns, (4.7 * columns + (1.6 if columns == 1 else 0), 3.1 * rows))
    for panel, (die, kind) in zip(axes.flat, panels):
        if kind == "force":
            abscissa = die_abscissa(history, die)
            for c, colour in (("y", LINES[0]), ("x", LINES[1])):
                column = history[f"force_{c}_{die}"]
                panel.plot(abscissa.values, column.values, color=colour, label=column.name)
            panel.set_xlabel(abscissa.title)
            panel.set_ylabel("force of the part on the die")
            if abscissa.values[-1] < abscissa.values[0]:
                panel.invert_xaxis()
        else:
            panel.plot(history[f"rotation_{die}"].values, history[f"moment_{die}"].values, color=LINES[2], label=f"moment_{die}")
            panel.set_xlabel(history[f"rotation_{die}"].title)
            panel.set_ylabel("moment about the pilot")
        panel.axhline(0, color=SOFT, lw=0.7)
        panel.set_title(f"{die}: {kind}")
        panel.legend()
    for panel in axes.flat[len(panels):]:
        panel.set_visible(False)
    words = "over the full circumference" if run.axisymmetric else "per unit of thickness"
    return Picture("force", f"forces {words}, as the part exerts them on the die", fig, vector=True)


def probe_columns(run: Run) -> List[Column]:
    """Columns of the deck's PROBE cards: those that are not of the system."""
    of_dies = {prefix + die for prefix in DIE_COLUMNS for die in run.die_names}
    return [column for name, column in run.history.items()
            if name not in FIXED_COLUMNS + HEAT_COLUMNS and name not in of_dies and not is_boundary(name)]


def is_boundary(name: str) -> bool:
    """A column of heat through a boundary: names of probes have no stroke."""
    return name.startswith(THROUGH) and "/" in name


def probes_picture(run: Run) -> Optional[Picture]:
    """What the probes read, over time."""
    probes = probe_columns(run)
    if not probes or not len(run.history["time"].values):
        return None
    columns = min(3, len(probes))
    rows = -(-len(probes) // columns)
    fig, axes = figure(rows, columns, (3.3 * columns + (1.2 if columns == 1 else 0), 2.4 * rows))
    for panel, probe, colour in zip(axes.flat, probes, LINES * len(probes)):
        panel.plot(run.history["time"].values, probe.values, color=colour)
        panel.set_title(probe.title)
        panel.set_xlabel("time")
        panel.xaxis.set_major_locator(MaxNLocator(5))
        panel.yaxis.set_major_locator(MaxNLocator(6))
    for panel in axes.flat[len(probes):]:
        panel.set_visible(False)
    return Picture("probes", "what the deck's PROBE cards ask for", fig, vector=True)


def steps_picture(run: Run) -> Optional[Picture]:
    """Length, iterations and cutbacks of the steps."""
    history = run.history
    if not {"step", "step_length", "iterations", "cutbacks"} <= set(history) or not len(history["step"].values):
        return None
    step = history["step"].values
    fig, axes = figure(3, 1, (9.2, 5.0), sharex=True, gridspec_kw={"height_ratios": [1.3, 1.1, 0.8]})
    length, iterations, cutbacks = axes[:, 0]
    length.step(step, history["step_length"].values, where="mid", color=LINES[0])
    positive = history["step_length"].values[history["step_length"].values > 0]
    if positive.size and positive.max() > 20 * positive.min():
        length.set_yscale("log")
        plain_numbers(length.yaxis)
    length.set_title("length of the step")
    iterations.stairs(history["iterations"].values, np.append(step - 0.5, step[-1] + 0.5), fill=True, color="#9db8d1")
    iterations.set_title("iterations")
    cutbacks.step(step, history["cutbacks"].values, where="mid", color=WARN)
    cutbacks.set_title("cutbacks so far")
    cutbacks.set_ylim(0, max(1, 1.05 * history["cutbacks"].values.max()))
    cutbacks.set_xlabel("step")
    for panel in (iterations, cutbacks):
        panel.yaxis.set_major_locator(MaxNLocator(4, integer=True))
    cutbacks.xaxis.set_major_locator(MaxNLocator(12, integer=True))
    return Picture("steps", "how the march in time went", fig, vector=True)


def energy_picture(run: Run) -> Optional[Picture]:
    """External work against elastic energy, plastic work and work of friction; none where nothing moves.

    What is neither stored nor dissipated is shown where work from outside is all that comes in.
    """
    history = run.history
    names = ["elastic_energy", "plastic_work", "friction_work"]
    if not set(names + ["external_work"]) <= set(history) or not len(history["time"].values):
        return None
    time, work = history["time"].values, history["external_work"].values
    parts = [history[name].values for name in names]
    if not any(np.any(values) for values in (work, *parts)):
        return None
    books = run.summary.get("energy", {})
    by_work = not any(books.get(name) for name in ("work_of_heat", "overlap", "damping"))
    fig, axes = figure(1, 2, (9.2, 3.3), gridspec_kw={"width_ratios": [1.5, 1]}) if by_work else figure(1, 1, (5.6, 3.3))
    energy = axes[0][0]
    energy.stackplot(time, *parts, labels=["elastic", "plastic", "friction"], colors=["#a9c4de", "#efc9a6", "#b9d8c0"], lw=0)
    energy.plot(time, work, color="black", lw=1.3, dashes=(5, 3), label="work from outside")
    energy.set_title("energy")
    energy.set_xlabel("time")
    energy.legend(loc="upper left")
    caption = "work from outside against elastic energy, plastic and friction work"
    if not by_work:
        return Picture("energy", caption, fig, vector=True)
    rest = axes[0][1]
    share = np.divide(work - sum(parts), np.abs(work), out=np.full(len(work), np.nan), where=np.abs(work) > 0)
    rest.plot(time, 100 * share, color=LINES[0])
    rest.axhspan(-2, 2, color="#e4efe6", zorder=0)
    rest.axhline(0, color=SOFT, lw=0.7)
    reach = np.nanpercentile(np.abs(100 * share), 90) if np.isfinite(share).any() else 0
    rest.set_ylim(-max(4, 1.3 * reach), max(4, 1.3 * reach))
    rest.set_title("neither stored nor dissipated [% of the work]")
    rest.set_xlabel("time")
    return Picture("energy", caption + "; shaded: within 2 %", fig, vector=True)


def heat_picture(run: Run) -> Optional[Picture]:
    """The books of heat, and temperatures of dies that have one and the heat that goes into them, heat through every boundary."""
    history = run.history
    if not set(HEAT_COLUMNS) <= set(history) or not len(history["time"].values):
        return None
    time = history["time"].values
    flows = [history[f"heat_flow_{die}"] for die in run.die_names if f"heat_flow_{die}" in history]
    warm = [history[f"temperature_{die}"] for die in run.die_names if f"temperature_{die}" in history]
    panels = [("heat since the start [energy]", [history[name] for name in HEAT_COLUMNS[:3]])]
    through = [column for name, column in history.items() if is_boundary(name)]
    panels += [(title, held) for title, held in (("heat through boundaries [power]", through), ("heat into the dies [power]", flows),
                                                 ("temperature of the dies", warm)) if held]
    fig, axes = figure(1, len(panels), (3.6 * len(panels) + (1.6 if len(panels) == 1 else 0), 3.1))
    for panel, (title, held) in zip(axes.flat, panels):
        for column, colour in zip(held, LINES * len(held)):
            panel.plot(time, column.values, color=colour, label=column.name.replace(THROUGH, ""))
        panel.set_title(title)
        panel.set_xlabel("time")
        panel.legend()
    worst = float(np.nanmax(np.abs(history["heat_imbalance"].values)))
    return Picture("heat", f"what the bodies took up, what came in through their sides, what was released in them; missing at most {worst:.1e} of it", fig,
                   vector=True)


def seconds_picture(run: Run) -> Optional[Picture]:
    """Where the time went: effects and tasks."""
    seconds = {name: number(value) for name, value in run.summary["seconds"].items()}
    seconds = {name: value for name, value in seconds.items() if value > 0}
    if not seconds:
        return None
    names = sorted(seconds, key=lambda name: seconds[name])
    fig, panels = figure(1, 1, (9.2, 0.55 + 0.3 * len(names)))
    axes = panels[0, 0]
    effects = run.summary["effects"]
    colours = [LINES[0] if name in effects else "#9fb0bf" for name in names]
    axes.barh(names, [seconds[name] for name in names], color=colours, height=0.66)
    wall = number(run.summary.get("wall_s"))
    for k, name in enumerate(names):
        share = f"  {seconds[name]:.3g} s" + (f", {100 * seconds[name] / wall:.0f} %" if wall > 0 else "")
        axes.text(seconds[name], k, share, va="center", fontsize=8.5, color=SOFT)
    axes.set_xlim(0, 1.18 * max(seconds.values()))
    axes.grid(False, axis="y")
    axes.tick_params(axis="y", length=0, labelsize=9.5, labelcolor="#22303c")
    axes.set_xlabel("seconds on the wall (blue: effects of the scene; grey: tasks of the solver)")
    return Picture("seconds", "where the time went; an entry may lie inside another", fig, vector=True)
