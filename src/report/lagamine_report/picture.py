"""A finished picture, as the page and --png want it."""
import base64
import io
import re
from dataclasses import dataclass

from matplotlib import pyplot
from matplotlib.figure import Figure
from PIL import Image

from .reader import Run, Step
from .words import brief


PAGE_DPI = 130      # of pictures of pixels in the page


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


def in_few_colours(png: bytes) -> bytes:
    """The same picture with a table of 256 colours."""
    buffer = io.BytesIO()
    with Image.open(io.BytesIO(png)) as image:
        image.convert("RGB").quantize(256, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE).save(buffer, format="png", optimize=True)
    return buffer.getvalue()


@dataclass
class Picture:
    """A figure with its file name for --png, its heading and caption; `vector` ones go into the page as SVG."""

    name: str
    caption: str
    figure: Figure
    vector: bool = False
    heading: str = ""

    def png(self, dpi: int = 150) -> bytes:
        buffer = io.BytesIO()
        self.figure.savefig(buffer, format="png", dpi=dpi, bbox_inches="tight", pad_inches=0.08, metadata={"Software": None})
        return buffer.getvalue()

    def data_uri(self) -> str:
        """The picture as it stands in the page; of pixels in 256 colours, a third of the size."""
        if not self.vector:
            return "data:image/png;base64," + base64.b64encode(in_few_colours(self.png(PAGE_DPI))).decode()
        return "data:image/svg+xml;base64," + base64.b64encode(self.svg()).decode()

    def svg(self) -> bytes:
        """The picture as a file of its own."""
        buffer = io.BytesIO()
        self.figure.savefig(buffer, format="svg", bbox_inches="tight", pad_inches=0.08, metadata={"Date": None})
        return rounded(numbered_clips(buffer.getvalue()))

    def close(self) -> None:
        pyplot.close(self.figure)


def when(run: Run, step: Step) -> str:
    """`time 0.5, step 12`, with the generation where there are several."""
    generation = f", mesh {step.generation.number}" if len(run.generations) > 1 else ""
    return f"time {brief(step.time)}, step {step.number}{generation}"
