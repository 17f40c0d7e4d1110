"""A finished picture, as the page and --png want it."""
import base64
import io
import re
from dataclasses import dataclass

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure
from PIL import Image, ImageChops

from .reader import Run, Step
from .style import POINTS
from .words import brief, field_title


PAGE_DPI = 130      # of pictures of pixels in the page
MARGIN = 0.08       # around a picture [inch]
ROOM = 1.5          # for what is wider than its panel [inch]


def numbered_clips(svg: bytes) -> bytes:
    """The same drawing with its clip paths numbered in order: matplotlib names them after addresses in memory."""
    names: dict[bytes, bytes] = {}
    for name in re.findall(rb'<clipPath id="([^"]+)"', svg):
        names.setdefault(name, b"clip%d" % len(names))
    for name, number in names.items():
        svg = svg.replace(b'"' + name + b'"', b'"' + number + b'"').replace(b"#" + name + b")", b"#" + number + b")")
    return svg


def rounded(svg: bytes) -> bytes:
    """The same drawing with the coordinates of its lines to a hundredth of a point; factors of scale stay as they are."""
    return re.sub(rb' d="[^"]*"', lambda path: re.sub(rb"(\d+\.\d\d)\d+", rb"\1", path.group()), svg)


def svg_bytes(figure: Figure) -> bytes:
    """A figure as a drawing without its empty margins, on white. Layout, box and drawing are asked for once each: savefig draws all of it twice."""
    engine, patch = figure.get_layout_engine(), figure.patch
    if engine is not None:
        engine.execute(figure)
        figure.set_layout_engine("none")
    box = figure.get_tightbbox(FigureCanvasAgg(figure).get_renderer()).padded(MARGIN)
    width, height = figure.get_size_inches()
    patch.set_bounds(box.x0 / width, box.y0 / height, box.width / width, box.height / height)
    buffer = io.BytesIO()
    FigureCanvasSVG(figure).print_svg(buffer, metadata={"Date": None})
    patch.set_bounds(0, 0, 1, 1)
    figure.set_layout_engine(engine)
    size = f'{box.width * POINTS:.2f}', f'{box.height * POINTS:.2f}'
    seen = f'width="{size[0]}pt" height="{size[1]}pt" viewBox="{box.x0 * POINTS:.2f} {(height - box.y1) * POINTS:.2f} {size[0]} {size[1]}"'
    whole = re.sub(rb'width="[^"]*" height="[^"]*" viewBox="[^"]*"', seen.encode(), buffer.getvalue(), count=1)
    return rounded(numbered_clips(whole))


def png_bytes(image: Image.Image, **options) -> bytes:
    """A picture of pixels as a file."""
    buffer = io.BytesIO()
    image.save(buffer, format="png", **options)
    return buffer.getvalue()


def in_few_colours(image: Image.Image) -> bytes:
    """The same picture as a file with a table of 256 colours. White stays white: the table's means are rounded down."""
    few = image.quantize(256, method=Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE)
    few.putpalette([255 if level == 254 else level for level in few.getpalette()])
    return png_bytes(few)


@dataclass
class Picture:
    """A figure with its file name for --png, its heading and caption; `vector` ones go into the page as SVG."""

    name: str
    caption: str
    figure: Figure
    vector: bool = False
    heading: str = ""
    drawn: str = ""     # as it stands in the page, once that has been made
    vector_file: bytes = b""    # as SVG, once that has been made: laid out a second time it would differ in its last digits

    def image(self, dpi: int) -> Image.Image:
        """The picture in pixels without its empty margins. The figure is drawn once, with room around it for titles that are wider than their
        panel; savefig's tight box would ask for it twice."""
        width, height = self.figure.get_size_inches()
        engine = self.figure.get_layout_engine()
        if engine is not None:
            whole = width + 2 * ROOM, height + 2 * ROOM
            self.figure.set_size_inches(whole)
            engine.set(rect=(ROOM / whole[0], ROOM / whole[1], width / whole[0], height / whole[1]))
        self.figure.set_dpi(dpi)
        canvas = FigureCanvasAgg(self.figure)
        canvas.draw()
        if engine is not None:
            self.figure.set_size_inches(width, height)
            engine.set(rect=(0, 0, 1, 1))
        drawn = Image.fromarray(np.asarray(canvas.buffer_rgba())[..., :3].copy())
        box = ImageChops.invert(drawn).getbbox() or (0, 0, *drawn.size)
        margin = round(MARGIN * dpi)
        cut = Image.new("RGB", (box[2] - box[0] + 2 * margin, box[3] - box[1] + 2 * margin), "white")
        cut.paste(drawn.crop(box), (margin, margin))
        return cut

    def png(self, dpi: int = 150) -> bytes:
        return png_bytes(self.image(dpi), dpi=(dpi, dpi))

    def data_uri(self) -> str:
        """The picture as it stands in the page; of pixels in 256 colours, a third of the size."""
        if not self.drawn:
            kind, data = ("svg+xml", self.svg()) if self.vector else ("png", in_few_colours(self.image(PAGE_DPI)))
            self.drawn = f"data:image/{kind};base64," + base64.b64encode(data).decode()
        return self.drawn

    def svg(self) -> bytes:
        """The picture as a file of its own."""
        if not self.vector_file:
            self.vector_file = svg_bytes(self.figure)
        return self.vector_file


def titled(run: Run, step: Step, field: str) -> str:
    """A field with its unit, as the history writes it: `von Mises stress [stress]`."""
    unit = run.unit(step, field)
    return field_title(field, run.axisymmetric) + (f" [{unit}]" if unit else "")


def when(run: Run, step: Step) -> str:
    """`time 0.5, step 12`, with the generation where there are several."""
    generation = f", mesh {step.generation.number}" if len(run.generations) > 1 else ""
    return f"time {brief(step.time)}, step {step.number}{generation}"
