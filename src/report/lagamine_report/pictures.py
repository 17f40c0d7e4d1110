"""Pictures of the part: mesh, fields, fields over time, meshes of the generations."""
from typing import List, Optional, Sequence, Tuple

import numpy as np

from .cells import GAP, TITLE, cells
from .errors import ReportError
from .picture import Picture, titled, when
from .reader import Run, Step
from .scene_view import SceneView, colour_bar, is_uniform, scale_for, value_range
from .style import INK, SOFT, figure
from .words import DIRECTIONS, brief, field_title

MAIN_FIELDS = ["mises", "plastic_strain", "temperature"]
HIDDEN_FIELDS = ["applied_force"]
TITLE_WIDTH = 2.7   # of a panel with the instant in its title [inch]
FLAT = 2.5      # width over height of drawings that want more width than others


def mesh_picture(view: SceneView) -> Picture:
    """The mesh as it began and as it ended, with the dies and the first outline."""
    run = view.run
    first, last = run.steps[0], run.steps[-1]
    box = view.box([first, last])
    beside = (box[1] - box[0]) < 2.2 * (box[3] - box[2])
    wide = view.panel(box, 4.6 if beside else 8.6, 4.8)
    rows, columns = (1, 2) if beside else (2, 1)
    fig, axes = figure(rows, columns, (columns * (max(wide[0], TITLE_WIDTH) + 0.6), rows * (wide[1] + 0.6)), grid=False)
    for panel, step, word in zip(axes.flat, (first, last), ("start", "end")):
        view.frame(panel, box)
        panel.set_anchor("W")       # its title beside that of the next one
        view.dies(panel, step, box)
        x = view.coordinates(step)
        view.mesh(panel, step.generation, x)
        view.outline(panel, step.generation, x)
        if word == "end":
            view.outline(panel, first.generation, view.coordinates(first), edgecolor=SOFT, linewidth=0.9, linestyle=(0, (4, 3)),
                         zorder=3.5)
        panel.set_title(f"{word}: {when(run, step)}")
    caption = (f"{len(first.generation.topology)} elements at the start, {len(last.generation.topology)} at the end; "
               "sides are drawn as the parabolas they are; dashed: the outline at the start")
    return Picture("mesh", caption, fig, vector=len(last.generation.topology) + len(first.generation.topology) < 500)


def generations_picture(view: SceneView) -> Optional[Picture]:
    """Every mesh as it was made, when there is more than one."""
    generations = [generation for generation in view.run.generations if generation.steps]
    if len(generations) < 2:
        return None
    if len(generations) > 12:
        places = np.unique(np.linspace(0, len(generations) - 1, 12).round().astype(int))
        generations = [generations[k] for k in places]
    fig, panels = _grid(view, [generation.steps[0] for generation in generations], 3.0, 3.0, 1.7)
    for panel, generation in zip(panels, generations):
        step = generation.steps[0]
        x = view.coordinates(step)
        view.mesh(panel, generation, x)
        view.outline(panel, generation, x)
        panel.set_title(f"mesh {generation.number}, time {brief(step.time, 3)}\n{len(generation.topology)} elements", fontsize=8.5)
    return Picture("meshes", "every mesh at its first saved instant", fig)


def fields_of(run: Run) -> List[str]:
    """Names of the fields at the last saved step, in the order of interest."""
    names = run.names(run.steps[-1], "node")
    main = [name for name in MAIN_FIELDS if name in names]
    last = [name for name in names if name.startswith("elastic_strain")]
    stress = [name for name in names if name.startswith("stress")]
    rest = [name for name in names if name not in main + stress + last + HIDDEN_FIELDS]
    return main + _in_order(stress) + rest + _in_order(last)


def _in_order(names: List[str]) -> List[str]:
    """Components as LAGAMINE orders them: xx, yy, xy, zz."""
    order = list(DIRECTIONS)
    return sorted(names, key=lambda name: (name[:-3], order.index(name[-2:]) if name[-2:] in order else 9))


def known_field(run: Run, name: str) -> str:
    """The name, when the last saved step has such a field."""
    names = run.names(run.steps[-1], "node")
    if name not in names:
        raise ReportError(f"--field {name}: no such field; there are: {', '.join(names)}")
    return name


def fields_picture(view: SceneView, names: Sequence[str], name: str = "fields", small: bool = False) -> Optional[Picture]:
    """Contours at the last saved step, a panel a field. A uniform field is stated in words."""
    run, step = view.run, view.run.steps[-1]
    shown: List[Tuple[str, np.ndarray]] = []
    uniform: List[str] = []
    for field in names:
        values = run.nodal(step, field)
        span = value_range(values)
        if span is None or is_uniform(*span):
            uniform.append(f"{field_title(field, run.axisymmetric)} = {'no number' if span is None else brief(span[0])}")
        else:
            shown.append((field, values))
    if not shown:
        return None
    box = view.box([run.steps[0], step] if not small else [step])
    width, height = box[1] - box[0], box[3] - box[2]
    columns = max(1, min(len(shown), 3 if small else 2, int((3.2 if small else 2.2) * 2.2 * height / width) or 1))
    rows = -(-len(shown) // columns)
    inches = view.panel(box, 9.2 / columns - 1.1, 2.9 if small else 4.6)
    fig, axes = figure(rows, columns, (columns * (inches[0] + 1.1), rows * (inches[1] + (0.75 if small else 0.55))), grid=False)
    if small:
        fig.get_layout_engine().set(h_pad=0.1)      # inch: titles under the ranges of the row above
    for panel, (field, values) in zip(axes.flat, shown):
        low, high = value_range(values)
        scale = scale_for(low, high)
        view.frame(panel, box, bare=small)
        view.dies(panel, step, box)
        if not small:
            first = run.steps[0]
            view.outline(panel, first.generation, view.coordinates(first), edgecolor=SOFT, linewidth=0.8, linestyle=(0, (4, 3)),
                         zorder=1.2)
        drawn = view.field(panel, step, values, scale, small)
        colour_bar(fig, drawn, panel)
        panel.set_title(titled(run, step, field), fontsize=9.5 if small else 10.5)
        between = {"s": f"{brief(low)} … {brief(high)}", "fontsize": 8.5, "color": SOFT}
        if small:       # without axes
            panel.text(0.5, -0.02, transform=panel.transAxes, ha="center", va="top", **between)
        else:
            panel.set_xlabel(between.pop("s"), **between)
    for panel in axes.flat[len(shown):]:
        panel.set_visible(False)
    caption = when(run, step) + (". The same everywhere: " + "; ".join(uniform) if uniform else "")
    return Picture(name, caption, fig)


def series_picture(view: SceneView, field: str, most: int = 8) -> Optional[Picture]:
    """One field over the saved steps, one scale for all."""
    run = view.run
    steps = [step for step in run.steps if field in run.names(step, "node")]
    if len(steps) < 2:
        return None
    times = np.array([step.time for step in steps])
    places = {int(np.abs(times - time).argmin()) for time in np.linspace(times[0], times[-1], most)}
    steps = [steps[k] for k in sorted(places)]
    values = [run.nodal(step, field) for step in steps]
    spans = [span for span in map(value_range, values) if span]
    if not spans:
        return None
    scale = scale_for(min(low for low, _ in spans), max(high for _, high in spans))
    fig, panels = _grid(view, steps, 2.05, 2.3, 1.2)
    drawn = None
    for panel, step, value in zip(panels, steps, values):
        drawn = view.field(panel, step, value, scale, small=True)
        panel.set_title(f"time {brief(step.time, 3)}", fontsize=9, fontweight="normal", color=INK)
    colour_bar(fig, drawn, panels[0].axes, titled(run, steps[-1], field), 0.8)
    return Picture("series" if field == "plastic_strain" else f"series_{field}",
                   f"{field_title(field, run.axisymmetric)} at saved steps, one scale for all", fig)


def _grid(view: SceneView, steps: Sequence[Step], widest: float, highest: float, title: float):
    """Small panels with one frame for all steps, dies drawn, not narrower than their titles [inches]; returns figure and cells."""
    box = view.box(steps, 0.1)
    if box[1] - box[0] > FLAT * (box[3] - box[2]):      # two in a row
        widest = 2 * widest
    elif len(steps) < 5:    # these few stand in one row
        widest = min(widest, 9.2 / len(steps) - 0.25)
    if len(steps) > 1:
        scale = min(widest / (box[1] - box[0]), highest / (box[3] - box[2]))
        box = (box[0], max(box[1], box[0] + min(title, widest) / scale), box[2], box[3])
    inches = view.panel(box, widest, highest)
    columns = min(len(steps), max(1, int(9.2 / (inches[0] + 0.2))))
    rows = -(-len(steps) // columns)
    columns = -(-len(steps) // rows)
    fig, axes = figure(1, 1, (columns * (inches[0] + GAP) + 0.9, rows * (inches[1] + TITLE)), grid=False)
    panels = cells(axes[0, 0], box, inches[0], rows, columns)[:len(steps)]
    for panel, step in zip(panels, steps):
        view.axis(panel, box)
        view.dies(panel, step, box)
    return fig, panels
