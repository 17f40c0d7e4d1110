"""Two or more runs on one page: how they ended, parameters that differ, forces, probes, profiles."""
import math
import os
from typing import Dict, List, Optional, Sequence, Tuple

import numpy as np
from matplotlib.collections import LineCollection

from .curves import die_abscissa, probe_columns
from .geometry import all_sides, side_curves
from .markup import Sections, document, escape, figure as shown, joined, table
from .picture import Picture
from .reader import Run
from .style import LINES, SOFT, figure, panel_size
from .tables import Column, number
from .words import brief

FACTS = (("status", "ended"), ("time", "time reached"), ("steps", "steps"), ("iterations", "iterations"), ("cutbacks", "cutbacks"),
         ("remeshings", "remeshings"), ("elements", "elements"), ("dofs", "equations"), ("wall_s", "seconds on the wall"), ("threads", "threads"),
         ("peak_rss_mb", "memory at its peak [MB]"))
MOST_PANELS = 12


def labels_of(folders: Sequence[str]) -> List[str]:
    """The shortest ends of the paths that tell the folders apart."""
    parts = [os.path.abspath(folder).split(os.sep) for folder in folders]
    for n in range(1, max(map(len, parts)) + 1):
        names = ["/".join(part[-n:]) for part in parts]
        if len(set(names)) == len(names):
            return names
    return [f"{name} ({k})" for k, name in enumerate(names, 1)]


def compare_page(runs: Sequence[Run], labels: Sequence[str], pictures: Sequence[Picture], version: str) -> str:
    """The whole page as text."""
    body: Sections = [("facts", "How they ended", _facts(runs, labels))]
    differing = _parameters(runs, labels)
    if differing:
        body.append(("parameters", "Decks and parameters that differ", differing))
    headings = {"forces": "Forces on the dies", "profiles": "Profiles at the end", "probes": "Probes"}
    body += [(picture.name, headings[picture.name], shown(picture, headings[picture.name])) for picture in pictures]
    links = "".join(f'<a href="#{anchor}">{escape(heading)}</a>' for anchor, heading, _ in body)
    header = f"<h1>{escape(' · '.join(labels))}</h1>\n<p class=\"reason\"><span>{len(runs)} runs compared</span></p>\n<nav>{links}</nav>"
    return document("Runs compared", header, joined(body), f"lagareport {escape(version)}. Lengths, forces and stresses are in the units of the decks.")


def compare_pictures(runs: Sequence[Run], labels: Sequence[str]) -> List[Picture]:
    """What two or more of the runs have to show."""
    return [picture for picture in (forces_picture(runs, labels), profiles_picture(runs, labels), probes_picture(runs, labels)) if picture is not None]


def _look(k: int) -> Dict[str, object]:
    """Colour and dashes of a run; the first is drawn full."""
    return {"color": LINES[k % len(LINES)], "dashes": ((), (6, 2), (2, 1.5), (6, 2, 1.5, 2))[k % 4]}


def forces_picture(runs: Sequence[Run], labels: Sequence[str]) -> Optional[Picture]:
    """The larger component of the force of every die that two runs have, over its motion."""
    curves: Dict[str, List[Tuple[int, Column, Column]]] = {}
    for k, run in enumerate(runs):
        for die in run.die_names:
            columns = [run.history[name] for name in (f"force_y_{die}", f"force_x_{die}") if name in run.history]
            columns = [column for column in columns if len(column.known)]
            if columns:
                curves.setdefault(die, []).append((k, die_abscissa(run.history, die), max(columns, key=lambda c: abs(c.largest))))
    return _panels("forces", "the larger component, over the larger motion of the die", curves, labels)


def probes_picture(runs: Sequence[Run], labels: Sequence[str]) -> Optional[Picture]:
    """Probes of the same name, over time."""
    curves: Dict[str, List[Tuple[int, Column, Column]]] = {}
    for k, run in enumerate(runs):
        for column in probe_columns(run):
            if len(column.values):
                curves.setdefault(column.name, []).append((k, run.history["time"], column))
    return _panels("probes", "PROBE cards of the same name, over time", curves, labels)


def _panels(name: str, caption: str, curves: Dict[str, List[Tuple[int, Column, Column]]], labels: Sequence[str]) -> Optional[Picture]:
    """A panel a quantity that two runs have."""
    common = {title: held for title, held in curves.items() if len(held) > 1}
    if not common:
        return None
    left_out = len(common) - MOST_PANELS
    common = dict(list(common.items())[:MOST_PANELS])
    columns = min(2, len(common))
    rows = -(-len(common) // columns)
    fig, axes = figure(rows, columns, (4.7 * columns + (1.6 if columns == 1 else 0), 3.1 * rows))
    for panel, (title, held) in zip(axes.flat, common.items()):
        for k, x, y in held:
            panel.plot(x.values, y.values, label=labels[k], **_look(k))
        if name == "forces":
            panel.axhline(0, color=SOFT, lw=0.7)
        panel.set_title(f"{title}: force" if name == "forces" else title)
        panel.set_xlabel(held[0][1].title)
        panel.set_ylabel(held[0][2].title)
        if held[0][1].values[-1] < held[0][1].values[0]:
            panel.invert_xaxis()
        panel.legend()
    for panel in axes.flat[len(common):]:
        panel.set_visible(False)
    more = f"; {left_out} more are not drawn" if left_out > 0 else ""
    return Picture(name, caption + more, fig, vector=True)


def profiles_picture(runs: Sequence[Run], labels: Sequence[str]) -> Optional[Picture]:
    """Outlines of the parts as last saved, one over the other."""
    outlines = []
    for k, run in enumerate(runs):
        if run.steps:
            step = run.steps[-1]
            outlines.append((k, side_curves(run.coordinates(step), all_sides(step.generation.topology)[1]), step))
    if len(outlines) < 2:
        return None
    every = np.concatenate([curves.reshape(-1, 2) for _, curves, _ in outlines])
    low, high = every.min(axis=0), every.max(axis=0)
    more = 0.06 * (high - low).max()
    inches = panel_size(*(high - low + 2 * more), 8.6, 6.0)
    fig, axes = figure(1, 1, (inches[0] + 0.7, inches[1] + 0.5), grid=False)
    panel = axes[0, 0]
    panel.set_aspect("equal")
    panel.set_xlim(low[0] - more, high[0] + more)
    panel.set_ylim(low[1] - more, high[1] + more)
    for k, curves, step in outlines:
        look = _look(k)
        dashes = (0, look["dashes"]) if look["dashes"] else "-"
        panel.add_collection(LineCollection(curves, colors=look["color"], linestyles=[dashes], linewidths=1.5, label=f"{labels[k]}, time {brief(step.time)}"))
    panel.legend(loc="best")
    return Picture("profiles", "outlines as last saved", fig, vector=sum(len(curves) for _, curves, _ in outlines) < 3000)


def _facts(runs: Sequence[Run], labels: Sequence[str]) -> str:
    """A column a run; of numbers also what they are of the first run's."""
    rows = []
    for key, words in FACTS:
        cells = [run.summary.get(key) for run in runs]
        if any(cell is not None for cell in cells):
            rows.append(("", (escape(words), *(_cell(cell, cells[0]) for cell in cells))))
    for die in dict.fromkeys(die for run in runs for die in run.die_names):
        found = []
        for run in runs:
            columns = [run.history[name] for name in (f"force_y_{die}", f"force_x_{die}") if name in run.history]
            values = [column.largest for column in columns if len(column.known)]
            found.append(max(values, key=abs) if values else None)
        rows.append(("", (escape(f"largest force on {die}"), *(_cell(cell, found[0]) for cell in found))))
    for field in ("plastic_strain", "mises"):
        found = [run.largest_at_points(run.steps[-1], field) if run.steps else None for run in runs]
        if any(value is not None for value in found):
            rows.append(("", (escape(f"largest {field} at points, as last saved"), *(_cell(cell, found[0]) for cell in found))))
    return table(("", *labels), rows)


def _cell(value, first) -> str:
    """A value, and its deviation from the first run's in percent."""
    if value is None:
        return "–"
    if isinstance(value, str):
        return escape(value)
    value, first = number(value), number(first) if first is not None and not isinstance(first, str) else math.nan
    off = f" ({100 * (value / first - 1):+.2f} %)" if math.isfinite(first) and first != 0 and value != first else ""
    return escape(brief(value, 6) + off)


def _parameters(runs: Sequence[Run], labels: Sequence[str]) -> str:
    """Decks, and parameters given on the command line, where they are not the same in all runs; empty where they are."""
    rows = []
    for words, key in (("deck", "deck"), ("SHA-256 of the deck with its files", "deck_sha256"), ("version", "version"), ("linear solver", "linear_solver")):
        cells = [str(run.summary.get(key) or "–") for run in runs]
        if len(set(cells)) > 1:
            rows.append(("", (escape(words), *(escape(cell if key != "deck_sha256" else cell[:12]) for cell in cells))))
    held = [{**run.summary.get("parameters", {})} for run in runs]
    for name in dict.fromkeys(name for parameters in held for name in parameters):
        cells = [str(parameters.get(name, "the deck's")) for parameters in held]
        if len(set(cells)) > 1:
            rows.append(("", (f"<code>-p {escape(name)}</code>", *map(escape, cells))))
    return table(("", *labels), rows) if rows else ""
