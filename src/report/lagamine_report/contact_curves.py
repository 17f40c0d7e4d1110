"""Curves of pressure and friction along the sides in contact."""
from typing import List, Optional

import numpy as np

from .contact import along_group, contact_groups, contact_points
from .picture import Picture, when
from .reader import Run
from .style import LINES, SOFT, figure
from .tractions import recovered_tractions

STICK, SLIP = 1, 2
BEYOND = 2.0      # points that alternate are cut off beyond so many times the largest value of the curves


def contact_picture(run: Run) -> Optional[Picture]:
    """Pressure and friction of each group at the last saved step, stick and slip distinguished."""
    step = run.steps[-1]
    groups = contact_groups(run, step)
    if not groups:
        return None
    columns = min(2, len(groups))
    rows = -(-len(groups) // columns)
    fig, axes = figure(rows, columns, (4.7 * columns + (2.4 if columns == 1 else 0), 3.1 * rows))
    for panel, group in zip(axes.flat, groups):
        names, state = contact_points(run, step, group)
        reach: List[float] = []
        length, order, ends = along_group(run, step, group)
        flat = state.reshape(-1, state.shape[2])[order]
        status = flat[:, names.index("contact_status")].round() if "contact_status" in names else np.zeros(len(flat))
        shown = recovered_tractions(run, step, group)
        for k, (name, colour) in enumerate((("pressure", LINES[0]), ("friction", LINES[1]))):
            if name not in names:
                continue
            values = flat[:, names.index(name)]
            curve = values if shown is None else shown[k][order]
            for first, last in zip(np.concatenate([[0], ends[:-1]]), ends):
                panel.plot(length[first:last], curve[first:last], color=colour, lw=1.4, label=name if first == 0 else None)
            reach.append(np.abs(curve).max(initial=0))
            few = 30 if len(length) < 150 else 8
            panel.scatter(length[status == STICK], values[status == STICK], s=few, color=colour, lw=0, zorder=3)
            panel.scatter(length[status == SLIP], values[status == SLIP], s=few, facecolor="white", edgecolor=colour, lw=1.1,
                          zorder=3)
        panel.axhline(0, color=SOFT, lw=0.7)
        low, high = panel.get_ylim()
        most = BEYOND * max(reach, default=0)
        if most > 0:
            panel.set_ylim(max(low, -most), min(high, most))
        closed = int((status > 0).sum())
        panel.set_title(f"{group.name}: {closed} of {len(flat)} points closed" if len(flat) else group.name)
        panel.set_xlabel("length along the sides")
        panel.set_ylabel("stress")
        panel.legend(loc="best")
    for panel in axes.flat[len(groups):]:
        panel.set_visible(False)
    caption = f"{when(run, step)}; curves: recovered from the stresses in the body, with the forces of the points; full points stick, hollow ones slip, the others are open"
    return Picture("contact", caption, fig, vector=True)
