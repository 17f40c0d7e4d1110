"""The forming as a moving picture in one file: saved instants with a field, dies and mesh, one scale for all."""
import io
import os
from typing import List

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from PIL import Image

from .errors import ReportError
from .picture import titled
from .reader import Run, Step
from .scene_view import SceneView, colour_bar, scale_for, value_range
from .style import figure
from .words import brief

MOST_FRAMES = 48
ENDINGS = {".gif": "GIF", ".png": "PNG"}      # a PNG with several frames is an APNG, which browsers play
SECONDS = 6.0       # of the whole; the last frame stands longer
LAST = 1.5          # seconds
DPI = 100


def animation(run: Run, field: str, path: str, mirror: bool = False) -> bytes:
    """The file's content; its ending shows the format."""
    kind = ENDINGS.get(os.path.splitext(path)[1].lower())
    if kind is None:
        raise ReportError(f"--animation {path}: expected a name that ends with .gif or .png")
    steps = _frames(run, field)
    if len(steps) < 2:
        raise ReportError(f"--animation: '{field}' is saved at fewer than two instants: expected more, by SAVE in the deck")
    view = SceneView(run, mirror)
    spans = [span for span in (value_range(run.nodal(step, field)) for step in steps) if span]
    scale = scale_for(min(low for low, _ in spans), max(high for _, high in spans))
    images = _drawn(view, steps, field, scale)
    palette = images[-1].quantize(255, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE)
    shown = [image.quantize(palette=palette, dither=Image.Dither.NONE) for image in images]
    each = max(40, int(1000 * SECONDS / len(shown)))
    buffer = io.BytesIO()
    options = {"disposal": 1} if kind == "GIF" else {}
    shown[0].save(buffer, format=kind, save_all=True, append_images=shown[1:], duration=[each] * (len(shown) - 1) + [int(1000 * LAST)], loop=0,
                  optimize=False, **options)
    return buffer.getvalue()


def _frames(run: Run, field: str) -> List[Step]:
    """Saved instants with the field, at about equal times; of those at one time the first."""
    steps = [step for step in run.steps if field in run.names(step, "node")]
    steps = [step for k, step in enumerate(steps) if k == 0 or step.time > steps[k - 1].time]
    if len(steps) <= MOST_FRAMES:
        return steps
    times = np.array([step.time for step in steps])
    return [steps[k] for k in sorted({int(np.abs(times - t).argmin()) for t in np.linspace(times[0], times[-1], MOST_FRAMES)})]


def _drawn(view: SceneView, steps: List[Step], field: str, scale) -> List[Image.Image]:
    """A picture an instant, all of one size: the layout of the first is kept."""
    box = view.box(steps, 0.1)
    inches = view.panel(box, 6.6, 5.6)
    fig, panels = figure(1, 1, (inches[0] + 1.5, inches[1] + 0.7), grid=False)
    axes = panels[0, 0]
    canvas = FigureCanvasAgg(fig)
    fig.set_dpi(DPI)
    images = []
    for step in steps:
        axes.clear()
        view.frame(axes, box)
        view.dies(axes, step, box)
        drawn = view.field(axes, step, view.run.nodal(step, field), scale)
        axes.set_title(f"time {brief(step.time, 3)}")
        if not images:
            colour_bar(fig, drawn, axes, titled(view.run, step, field))
            canvas.draw()
            fig.set_layout_engine("none")
        canvas.draw()
        images.append(Image.fromarray(np.asarray(canvas.buffer_rgba())[..., :3].copy()))
    return images
