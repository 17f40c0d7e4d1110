"""Contact pressure on the shape: bars that stand on the sides, as long as the pressure there."""
from typing import List, Optional, Tuple

import numpy as np
from matplotlib.collections import LineCollection

from .contact import contact_groups, contact_points
from .geometry import line3, side_points
from .picture import Picture, when
from .reader import Group
from .scene_view import SceneView, colour_bar, scale_for
from .style import POSITIVE, figure
from .tractions import recovered_tractions
from .words import brief

LONGEST = 0.12      # the longest bar, of the size of the picture


def pressure_bars(view: SceneView, group: Group) -> Tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Feet of the bars at the points of a contact (n, 2), their directions into the part (n, 2), pressures as shown (n)."""
    run, step = view.run, view.run.steps[-1]
    names, state = contact_points(run, step, group)
    xi = side_points(group.npoint, state.shape[1])
    ends = view.coordinates(step)[group.connectivity]
    feet = np.einsum("pk,skd->spd", line3(xi), ends)
    slopes = np.stack([xi - 0.5, -2 * xi, xi + 0.5], axis=1)        # of line3
    tangent = np.einsum("pk,skd->spd", slopes, ends)
    inward = np.stack([-tangent[..., 1], tangent[..., 0]], axis=2) / np.hypot(tangent[..., 0], tangent[..., 1])[..., None]
    shown = recovered_tractions(run, step, group)
    pressure = state[:, :, names.index("pressure")].ravel() if shown is None else shown[0]
    return feet.reshape(-1, 2), inward.reshape(-1, 2), pressure


def pressure_picture(view: SceneView) -> Optional[Picture]:
    """The pressures of all contacts at the last saved step; none where nothing presses."""
    run, step = view.run, view.run.steps[-1]
    held: List[Tuple[np.ndarray, np.ndarray, np.ndarray]] = [pressure_bars(view, group) for group in contact_groups(run, step)]
    if not held or not max(values.max() for _, _, values in held) > 0:
        return None
    feet, inward, values = (np.concatenate(parts) for parts in zip(*held))
    box = view.box([step])
    inches = view.panel(box, 7.4, 5.0)
    fig, axes = figure(1, 1, (inches[0] + 1.4, inches[1] + 0.5), grid=False)
    panel = axes[0, 0]
    view.frame(panel, box)
    view.dies(panel, step, box)
    view.mesh(panel, step.generation, view.coordinates(step), edgecolor="#b9c6d2")
    view.outline(panel, step.generation, view.coordinates(step))
    pressed = values > 0
    length = LONGEST * max(box[1] - box[0], box[3] - box[2]) * values[pressed] / values.max()
    bars = np.stack([feet[pressed], feet[pressed] + length[:, None] * inward[pressed]], axis=1)
    scale = scale_for(0.0, float(values.max()))
    drawn = None
    for sign in (1, -1) if view.mirror else (1,):
        drawn = LineCollection(bars * np.array([sign, 1]), array=values[pressed], cmap=POSITIVE, linewidths=2.0, zorder=5, capstyle="butt")
        drawn.set_clim(scale.levels[0], scale.levels[-1])
        drawn.levels = scale.levels
        panel.add_collection(drawn, autolim=False)
    colour_bar(fig, drawn, panel, "contact pressure [stress]")
    return Picture("pressure", f"{when(run, step)}; largest {brief(float(values.max()))}; recovered from the stresses in the body; bars stand on the points of contact, towards the inside of the part", fig)
