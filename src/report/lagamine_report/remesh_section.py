"""The page's section on remeshing: a row for every try, then old mesh, new mesh and what was kept."""
from typing import Dict, List, Sequence, Tuple

import numpy as np

from .cycle import AGREED, BALANCES, Change, Try, new_meshes
from .markup import Sections, escape, figure, table
from .picture import Picture
from .reader import Run
from .remeshes import LAST_SHOWN, shown_remeshes
from .words import brief, field_title

NONE = "–"
# Columns that are held to a limit: name in cycle.csv, in words, and what a share is shown in.
LIMITED = (("first_residual", "first residual", 1), ("iterations", "iterations", 1), ("force_change", "change of force [%]", 100),
           ("energy_change", "of energy [%]", 100), ("depth_change", "of depth", 1), ("least_step_ratio", "least step", 1))
HEAD = ("mesh", "step", "time", "height", "why", "elements", "error of stress [%]", *(words for _, words, _ in LIMITED),
        "force at first step [%]", "seconds")


def remesh_section(run: Run, pictures: Sequence[Picture]) -> Sections:
    """Nothing where the run is no cycle's."""
    if not run.tries:
        return []
    made = new_meshes(run.tries)
    refused = sum(row.refused and not row.keeps_old for row in run.tries)
    parts = [f"<p>New meshes: {len(made)}; tries refused: {refused}. Height: of all bodies along y.</p>",
             table(HEAD, [*limits(made), *((look(row), cells(run, row)) for row in run.tries)])]
    if run.left_out:
        parts.insert(1, f"<p><b>Mesh {run.left_out.generation} was refused: pictures, curves and tables of the results end with the mesh "
                        f"before it, step {run.left_out.step}.</b></p>")
    shown = shown_remeshes(run)
    if len(shown) < len(made):
        parts.append(f"<p>Pictures of {len(shown)} of {len(made)} new meshes: "
                     f"the first and the last {LAST_SHOWN} of those saved.</p>")
    by_name: Dict[str, Picture] = {picture.name: picture for picture in pictures}
    for row in made:
        parts.append(f"<h3>Mesh {row.generation}, time {escape(shown_number(row.numbers['stop_time']))}</h3>")
        picture = by_name.get(f"remesh_g{row.generation:02d}")
        if picture:
            parts.append(figure(picture, "Old and new mesh"))
        if row.changes:
            parts.append(kept(run, row.changes))
    return [("remeshes", "Meshes", "\n".join(parts))]


def look(row: Try) -> str:
    return "off" if row.keeps_old else "bad" if row.refused else ""


def shown_number(value: float, digits: int = 4) -> str:
    return NONE if np.isnan(value) else brief(value, digits)


def cells(run: Run, row: Try) -> List[str]:
    """A try as a row of the table."""
    n = row.numbers
    why = escape(row.texts["trigger"])
    if row.keeps_old:
        why += "<br><b>the old mesh goes on</b>"
    elif row.refused:
        words = {key: escape(text) for key, text in row.texts.items()}
        why += f"<br><b>refused</b> ({words['action']}; stage {words['stage']}): {words['reason']}"
    elif row.texts["action"] == AGREED:
        why += f"<br><b>warning</b>: {escape(row.texts['reason'])}"
    elif row.number > 1:
        why += f"<br>try {row.number}: {escape(row.texts['action'])}"
    if n["laps"] > 0:
        why += f"<br>{shown_number(n['laps'])} lap{'s' if n['laps'] > 1 else ''}, up to {shown_number(n['lap_depth'], 3)} deep"
    if n["removed_volume"] > 0:
        why += f"<br>volume {shown_number(n['removed_volume'], 6)} removed"
    seconds = np.nansum([n["remdata"], n["restart"]])
    return [str(row.generation), str(row.step), shown_number(n["stop_time"]), shown_number(height(run, row)), why,
            f"{shown_number(n['old_elements'], 9)} → {shown_number(n['new_elements'], 9)}",
            f"{shown_number(n['error_before'], 3)} → {shown_number(n['error_after'], 3)}",
            *(shown_number(n[name], 3) for name, _, _ in LIMITED), signed(n["first_step_force_change"]), shown_number(seconds, 3)]


def limits(made: Sequence[Try]) -> List[Tuple[str, List[str]]]:
    """A row of what is allowed, which is the deck's and the same for all meshes; none where the files do not give it."""
    allowed: Dict[str, float] = {}
    for row in made:
        allowed.update(row.limits)
    if not allowed:
        return []
    shown = [f"{'≥' if name == 'least_step_ratio' else '≤'} {shown_number(factor * allowed[name], 3)}" if name in allowed else NONE
             for name, _, factor in LIMITED]
    return [("off", ["", "", "", "", "limits (REMSH ACCEPT)", "", "", *shown, "", ""])]


def height(run: Run, row: Try) -> float:
    """Extent of all bodies along y when the old mesh was replaced; NaN where it was not saved."""
    for step in run.steps:
        if step.number == row.step and step.generation.number == row.generation - 1:
            return float(np.ptp(run.coordinates(step)[:, 1]))
    return np.nan


def kept(run: Run, changes: Sequence[Change]) -> str:
    """What the new mesh has kept of the old one, folded under its balances."""
    rows = [("", (escape(change.name if change.balance else field_title(change.name, run.axisymmetric)),
                  shown_number(change.before, 6), shown_number(change.after, 6), signed(change.percent),
                  shown_number(change.largest_before), shown_number(change.largest_after))) for change in changes]
    balances = ", ".join(f"{escape(change.name)} {signed(change.percent)} %" for change in changes if change.balance)
    summary = f"Kept: {balances}" if balances else "Kept"
    note = (f"<p>{escape(', '.join(BALANCES.values()))}: before and after the restart; "
            "fields: integrals over the old and the new mesh.</p>")
    head = ("", "old mesh", "new mesh", "change [%]", "largest, old", "largest, new")
    return f"<details><summary>{summary}</summary>{note}\n{table(head, rows)}</details>"


def signed(value: float) -> str:
    """A change with its sign."""
    return ("+" if value > 0 else "") + shown_number(value, 3)
