"""One look for all pictures: colours, fonts, sizes."""
import math
from typing import Tuple

import matplotlib
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator

INK, SOFT, FAINT = "#22303c", "#6b7a88", "#d5dce2"
BODIES = ["#dbe6f0", "#efe4d4", "#dfeadb", "#eadfec"]
DIE_FILL, DIE_LINE = "#c3c9cf", "#4a5560"
LINES = ["#1f5f99", "#c8562c", "#3b8a5a", "#8a5aa8", "#b08a1e", "#4f9aa8", "#a8415b", "#6b7a88"]
GOOD, WARN = "#2e7d4f", "#b3541e"
POSITIVE, SIGNED = "viridis", "RdBu_r"
POINTS = 72              # of an inch, the unit of lines and drawings
LINE_SHARE = 0.1         # of what lines stand around: they are no wider, so that a thin part, or small elements, show their colours
DIE_SHARE = 0.3          # the same of the lines of dies, beside the part
SHORTEST_AXIS = 6.0      # of logarithms: the largest number on it over the smallest
MANY_DECADES = 2.5       # on an axis: no numbers between the powers of ten

matplotlib.rcParams.update({
    "font.family": "sans-serif", "font.sans-serif": ["DejaVu Sans"], "font.size": 9.5,
    "axes.titlesize": 10.5, "axes.titleweight": "bold", "axes.titlelocation": "left", "axes.titlecolor": INK,
    "axes.labelsize": 9.5, "axes.labelcolor": INK, "axes.edgecolor": SOFT, "axes.linewidth": 0.8, "axes.axisbelow": True,
    "axes.spines.top": False, "axes.spines.right": False, "axes.formatter.useoffset": False,
    "axes.formatter.limits": (-4, 5), "axes.unicode_minus": True,
    "grid.color": FAINT, "grid.linewidth": 0.7, "xtick.color": SOFT, "ytick.color": SOFT,
    "xtick.labelsize": 8.5, "ytick.labelsize": 8.5, "text.color": INK, "legend.frameon": False, "legend.fontsize": 8.5,
    "lines.linewidth": 1.7, "lines.solid_capstyle": "round", "figure.facecolor": "white", "savefig.facecolor": "white",
    "axes.prop_cycle": matplotlib.cycler(color=LINES), "svg.hashsalt": "lagareport", "svg.fonttype": "path",
})


def figure(rows: int, columns: int, size: Tuple[float, float], grid: bool = True, **options):
    """A figure with axes (rows, columns) that leaves no holes; `grid`: with lines at the ticks."""
    fig = Figure(figsize=size, layout="constrained")
    with matplotlib.rc_context({"axes.grid": grid}):        # asked for later, every tick is made twice
        axes = fig.subplots(rows, columns, squeeze=False, **options)
    for panel in axes.flat:
        for axis in (panel.xaxis, panel.yaxis):
            axis.remove_overlapping_locs = False    # minor ticks, which there are none of, compared with the others at every layout
    return fig, axes


def panel_size(width: float, height: float, widest: float, highest: float) -> Tuple[float, float]:
    """Inches for a drawing of this width and height, inside a box of inches."""
    scale = min(widest / max(width, 1e-300), highest / max(height, 1e-300))
    return max(width * scale, 1.2), max(height * scale, 0.8)


def plain_numbers(axis) -> None:
    """Logarithms with numbers as people write them; an axis that spans little is made longer, so that two of them stand there at least."""
    low, high = axis.get_data_interval()
    if not (0 < low <= high < math.inf):
        return
    grow = max(1.1, (high / low)**0.06, math.sqrt(SHORTEST_AXIS * low / high))
    axis.axes.set(**{f"{axis.axis_name}lim": (low / grow, high * grow)})
    decades = math.log10(high / low) + 2 * math.log10(grow)
    axis.set_major_locator(LogLocator(subs=(1, 2, 5) if decades < MANY_DECADES else (1,)))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_locator(NullLocator())
