"""Pressure and friction along the sides in contact."""
from typing import List, Optional, Tuple

import numpy as np

from .geometry import curves_of_sides, side_curves, side_points
from .picture import Picture, when
from .reader import Group, Run, Step
from .style import LINES, SOFT, figure

STICK, SLIP = 1, 2


def contact_groups(run: Run, step: Step) -> List[Group]:
    """Groups whose points hold a pressure."""
    found = []
    for group in step.generation.groups:
        if group.connectivity.ndim != 2 or group.connectivity.shape[1] != 3 or not len(group.connectivity):
            continue
        points = run.points(step, group)
        if points and "pressure" in points[0]:
            found.append(group)
    return found


def along_group(run: Run, step: Step, group: Group) -> Tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Arc length along the sides [point], numbers of their points in (side, point) order, ends of the curves."""
    x = run.coordinates(step)
    names, state = run.points(step, group)
    xi = side_points(group.npoint, state.shape[1])
    length, order, ends = [], [], []
    start = 0.0
    for connected in curves_of_sides(group.connectivity):
        for k in connected:
            curve = side_curves(x, group.connectivity[k:k + 1], 24)[0]
            so_far = np.concatenate([[0], np.cumsum(np.hypot(*np.diff(curve, axis=0).T))])
            length.extend(start + np.interp(xi, np.linspace(-1, 1, 25), so_far))
            order.extend(k * state.shape[1] + np.arange(state.shape[1]))
            start += so_far[-1]
        ends.append(len(order))
    return np.array(length), np.array(order), np.array(ends)


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
        names, state = run.points(step, group)
        length, order, ends = along_group(run, step, group)
        flat = state.reshape(-1, state.shape[2])[order]
        status = flat[:, names.index("contact_status")].round() if "contact_status" in names else np.zeros(len(flat))
        for name, colour in (("pressure", LINES[0]), ("friction", LINES[1])):
            if name not in names:
                continue
            values = flat[:, names.index(name)]
            for first, last in zip(np.concatenate([[0], ends[:-1]]), ends):
                panel.plot(length[first:last], values[first:last], color=colour, lw=1.1, alpha=0.75,
                           label=name if first == 0 else None)
            few = 30 if len(length) < 150 else 8
            panel.scatter(length[status == STICK], values[status == STICK], s=few, color=colour, lw=0, zorder=3)
            panel.scatter(length[status == SLIP], values[status == SLIP], s=few, facecolor="white", edgecolor=colour, lw=1.1,
                          zorder=3)
        panel.axhline(0, color=SOFT, lw=0.7)
        closed = int((status > 0).sum())
        panel.set_title(f"{group.name}: {closed} of {len(flat)} points closed" if len(flat) else group.name)
        panel.set_xlabel("length along the sides")
        panel.set_ylabel("stress")
        panel.legend(loc="best")
    for panel in axes.flat[len(groups):]:
        panel.set_visible(False)
    caption = f"{when(run, step)}; full points stick, hollow ones slip, the others are open"
    return Picture("contact", caption, fig, vector=True)
