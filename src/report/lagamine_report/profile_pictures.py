"""Pictures of profiles: a panel a value, a curve a line."""
from typing import List, Sequence

import numpy as np

from .picture import Picture, when
from .profiles import Profile
from .reader import Run, Step
from .style import LINES, SOFT, figure
from .words import field_title


def lines_picture(run: Run, step: Step, profiles: Sequence[Profile]) -> Picture:
    """Values over the length of the lines and sides asked for."""
    names: List[str] = list(dict.fromkeys(name for profile in profiles for name in profile.shown))
    columns = min(3, len(names))
    rows = -(-len(names) // columns)
    fig, axes = figure(rows, columns, (3.3 * columns + (1.6 if columns == 1 else 0), 2.5 * rows + 0.3))
    shown: List[str] = []
    for panel, name in zip(axes.flat, names):
        curves = [(profile, colour) for profile, colour in zip(profiles, LINES * len(profiles)) if name in profile.shown]
        for profile, colour in curves:
            panel.plot(*_with_gaps(profile, name), color=colour, label=profile.title)
        panel.axhline(0, color=SOFT, lw=0.5)
        panel.set_title(field_title(name, run.axisymmetric))
        panel.set_xlabel("length")
        titles = [profile.title for profile, _ in curves]
        if len(profiles) > 1 and titles != shown:       # the panels after it have the same curves
            panel.legend(loc="best", fontsize=7.5)
            shown = titles
    for panel in axes.flat[len(names):]:
        panel.set_visible(False)
    title = "" if len(profiles) > 1 else profiles[0].title + "; "
    return Picture("profiles", f"{title}{when(run, step)}", fig, vector=True)


def _with_gaps(profile: Profile, name: str):
    """Lengths and values, interrupted at the breaks."""
    return tuple(np.insert(values, profile.breaks, np.nan) for values in (profile.length, profile.values[name]))
