"""The rate of the plastic strain on the shape: where the part flows at the end."""
from typing import Optional, Tuple

import numpy as np

from .picture import Picture, when
from .reader import Run, Step
from .scene_view import SceneView, colour_bar, scale_for, value_range
from .style import figure
from .words import brief

STRAIN = "plastic_strain"


def strain_rate(run: Run) -> Optional[Tuple[Step, Step, np.ndarray]]:
    """The last two saved instants on one mesh, and at its nodes, which go with the material, the mean rate between them [1/time]; none where
    there are no two, or nothing flows."""
    last = run.steps[-1]
    before = [step for step in run.steps if step.generation is last.generation and step.time < last.time]
    if not before or any(STRAIN not in run.names(step, "node") for step in (before[-1], last)):
        return None
    rate = (run.nodal(last, STRAIN) - run.nodal(before[-1], STRAIN)) / (last.time - before[-1].time)
    span = value_range(rate)
    return (before[-1], last, rate) if span and span[1] > 0 else None


def strain_rate_picture(view: SceneView) -> Optional[Picture]:
    """The rate over the last interval between saved instants."""
    run = view.run
    found = strain_rate(run)
    if found is None:
        return None
    before, last, rate = found
    low, high = value_range(rate)
    box = view.box([last])
    inches = view.panel(box, 7.4, 4.2)
    fig, axes = figure(1, 1, (inches[0] + 1.4, inches[1] + 0.5), grid=False)
    panel = axes[0, 0]
    view.frame(panel, box)
    view.dies(panel, last, box)
    colour_bar(fig, view.field(panel, last, rate, scale_for(low, high)), panel)
    panel.set_title("rate of the equivalent plastic strain [1/time]")
    caption = f"{when(run, last)}; mean since the instant saved before, time {brief(before.time)}; {brief(low)} … {brief(high)}"
    return Picture("strain_rate", caption, fig)
