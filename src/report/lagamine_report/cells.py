"""Many small drawings in axes that they share: axes of their own would cost more than what is drawn in them."""
from typing import List, Tuple

from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle
from matplotlib.transforms import Affine2D

from .style import INK

Box = Tuple[float, float, float, float]
TITLE = 0.42        # room for two lines above a cell [inch]
ABOVE = 0.04        # between a cell and its title [inch]
GAP = 0.25          # beside a cell [inch]


class Cell:
    """A part of axes with coordinates of its own; SceneView draws in it as in axes."""

    def __init__(self, axes: Axes, box: Box, shift: Tuple[float, float], above: float) -> None:
        self.axes, self.title_at = axes, (box[0], box[3] + above)
        self.transform = Affine2D().translate(*shift) + axes.transData
        self.frame = Rectangle((box[0], box[2]), box[1] - box[0], box[3] - box[2], transform=self.transform)

    def add_artist(self, artist):
        artist.set_transform(self.transform)
        artist.set_in_layout(False)
        self.axes.add_artist(artist)
        artist.set_clip_path(self.frame)        # the axes have set theirs
        return artist

    def add_collection(self, collection, autolim: bool = False):
        assert not autolim, "the limits of the axes are those of the cells"
        return self.add_artist(collection)

    def plot(self, x, y, **look):
        return [self.add_artist(Line2D(x, y, **look))]

    def tricontourf(self, mesh, values, **look):
        return self.axes.tricontourf(mesh, values, transform=self.transform, **look)

    def set_title(self, words: str, **look) -> None:
        self.axes.text(*self.title_at, words, transform=self.transform, va="bottom", **{"color": INK, "fontweight": "bold", **look})


def cells(axes: Axes, box: Box, inches: float, rows: int, columns: int) -> List[Cell]:
    """Cells of one box in rows and columns, `inches` wide each, with room for titles; the axes get their limits and no axis."""
    unit = (box[1] - box[0]) / inches
    wide, high = box[1] - box[0] + GAP * unit, box[3] - box[2] + TITLE * unit
    axes.set_axis_off()
    axes.set_aspect("equal")
    axes.set_xlim(box[0], box[0] + columns * wide - GAP * unit)
    axes.set_ylim(box[3] + TITLE * unit - rows * high, box[3] + TITLE * unit)
    return [Cell(axes, box, (column * wide, -row * high), ABOVE * unit) for row in range(rows) for column in range(columns)]
