"""Pictures of remeshing: the old mesh when it was replaced, and the new one."""
from typing import List, Optional, Tuple

import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.colors import LogNorm

from .cells import GAP, TITLE, cells
from .cycle import Try, new_meshes
from .geometry import element_curves, element_sizes
from .picture import Picture
from .reader import Run, Step
from .scene_view import ABOVE, SceneView
from .style import POSITIVE, figure
from .words import brief

LAST_SHOWN = 3
ERROR = "error_stress"
DECADES = 3     # below the largest error; what is smaller has the last colour


def shown_remeshes(run: Run) -> List[Try]:
    """New meshes that get a picture: the first and the last ones."""
    made = [row for row in new_meshes(run.tries) if instants(run, row)]
    return made if len(made) <= LAST_SHOWN + 1 else made[:1] + made[-LAST_SHOWN:]


def instants(run: Run, row: Try) -> Optional[Tuple[Step, Step]]:
    """Where old and new mesh were saved at the step of the remesh; None when one of them was not."""
    steps = {step.generation.number: step for step in run.steps
             if step.number == row.step and step.generation.number in (row.generation - 1, row.generation)}
    return (steps[row.generation - 1], steps[row.generation]) if len(steps) == 2 else None


def remesh_pictures(view: SceneView) -> List[Picture]:
    return [remesh_picture(view, row) for row in shown_remeshes(view.run)]


def remesh_picture(view: SceneView, row: Try) -> Picture:
    """Old and new mesh, by the size of their elements and, where it is saved, by the error of each."""
    run, steps = view.run, instants(view.run, row)
    box = view.box(steps, 0.05)
    curves = [element_curves(view.coordinates(step), step.generation.topology) for step in steps]
    shades = [("size of elements [length]", [element_sizes(curve) for curve in curves])]
    errors = [element_field(run, step, ERROR) for step in steps]
    if all(error is not None and error.max() > 0 for error in errors):
        largest = max(error.max() for error in errors)
        shades.append(("error of the stress [%]", [100 * np.maximum(error, largest * 10.0**-DECADES) for error in errors]))
    beside = (box[1] - box[0]) < 2.2 * (box[3] - box[2])
    inches = view.panel(box, 3.9 if beside else 7.8, 3.6)
    rows, columns = (1, 2) if beside else (2, 1)
    fig, axes = figure(len(shades), 1, (columns * (inches[0] + GAP) + 1.2, len(shades) * rows * (inches[1] + TITLE)), grid=False)
    for shared, (title, values) in zip(axes.flat, shades):
        panels = cells(shared, box, inches[0], rows, columns)
        both = np.concatenate(values)
        low, high = max(both.min(), both.max() * 10.0**-6), both.max()
        norm = LogNorm(low, max(high, low * (1 + 1e-6)))
        for panel, step, curve, value, word in zip(panels, steps, curves, values, ("old", "new")):
            view.axis(panel, box)
            view.dies(panel, step, box)
            drawn = shade(panel, view, curve, value, norm)
            view.outline(panel, step.generation, view.coordinates(step), linewidth=0.8)
            panel.set_title(f"{word} mesh: {len(value)} elements", fontsize=9)
        bar = fig.colorbar(drawn, ax=shared, shrink=0.86, aspect=18, pad=0.02)
        ticks = np.geomspace(low, high, 5) if high > low * (1 + 1e-6) else [low]
        bar.ax.set_title("", y=ABOVE)
        bar.ax.xaxis.set_visible(False)
        bar.minorticks_off()
        bar.set_ticks(ticks, labels=[brief(float(tick), 3) for tick in ticks])
        bar.outline.set_visible(False)
        bar.ax.tick_params(labelsize=8, length=0)
        bar.set_label(title, fontsize=8.5)
    caption = f"mesh {row.generation - 1} as it gave way and mesh {row.generation} in equilibrium: step {row.step}, " \
              f"time {brief(row.numbers['stop_time'])}. Size: square root of the area"
    if len(shades) > 1:
        caption += f"; error: a density over that of the whole, colours of {DECADES} decades"
    return Picture(f"remesh_g{row.generation:02d}", caption, fig)


def shade(axes, view: SceneView, curves: np.ndarray, values: np.ndarray, norm: LogNorm) -> PolyCollection:
    """Every element in the colour of its value; returns what a colour bar wants."""
    for sign in (1, -1) if view.mirror else (1,):
        drawn = PolyCollection(curves * np.array([sign, 1]), array=values, cmap=POSITIVE, norm=norm, edgecolors="white",
                               linewidths=0.3, zorder=1.5)
        axes.add_collection(drawn, autolim=False)
    return drawn


def element_field(run: Run, step: Step, name: str) -> Optional[np.ndarray]:
    """A field of the elements, None where it was not saved, does not fit or is not finite."""
    if name not in run.names(step, "element"):
        return None
    values = run.read(step, f"element/{name}")
    return values if values.shape == (len(step.generation.topology),) and np.isfinite(values).all() else None
