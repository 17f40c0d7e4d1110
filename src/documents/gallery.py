#!/usr/bin/env python3
"""Pictures of the shipped decks, into their folders and READMEs: the scene at the start with its mesh, and a field at the end.

usage: gallery.py [--programs BIN] [--runs DIR] [NAME...]
NAME is a deck, NAME.lag in a folder of decks/ (default: all). Results that are in DIR/NAME are not made again (default DIR: out in the project).
The pictures are decks/FOLDER/picture_NAME.png, below 100 kB each; the README of the folder shows them between its marks.
"""
import argparse
import glob
import os
import re
import subprocess
import sys

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
sys.path.insert(0, os.path.join(ROOT, "src", "report"))
from lagamine_report.picture import Picture, in_few_colours, when  # noqa: E402
from lagamine_report.reader import Run  # noqa: E402
from lagamine_report.scene_view import SceneView, colour_bar, scale_for, value_range  # noqa: E402
from lagamine_report.style import figure, panel_size  # noqa: E402
from lagamine_report.words import field_title  # noqa: E402

MARK = "<!-- pictures -->"
FIELDS = ("plastic_strain", "martensite", "bainite", "temperature", "mises")       # the first that varies
CHOSEN = {"residual_stress": "stress_zz", "cooling_gps": "stress_zz", "tempering": "stress_yy", "quench_bar_trip": "stress_zz", "hot_cylinder": "stress_zz"}
# What is to be seen is in a corner: the share of the whole that is shown, about the largest value.
NEAR = {"punch": 0.16, "punch_die": 0.16, "hertz": 0.16, "plate_with_hole": 0.35}
FAR = 0.35          # a part smaller than this share of the way it goes has a window of its own at each end
MOST_BYTES = 100_000


def field_of(run, name):
    """The field that is shown, with its values at the end and their range."""
    step = run.steps[-1]
    names = run.names(step, "node")
    for field in (*([CHOSEN[name]] if name in CHOSEN else ()), *FIELDS):
        if field in names:
            values = run.nodal(step, field)
            span = value_range(values)
            if span and span[1] - span[0] > 1e-2 * max(abs(span[0]), abs(span[1])):
                return field, values, span
    return None, None, None      # the same everywhere


def near(box, place, share):
    """A window of this share of a box, about a place and within the box."""
    window = []
    for low, high, centre in ((box[0], box[1], place[0]), (box[2], box[3], place[1])):
        half = 0.5 * share * max(box[1] - box[0], box[3] - box[2])
        middle = min(max(centre, low + half), high - half)
        window += [middle - half, middle + half]
    return tuple(window)


def windows(view, steps):
    """The same window for both instants, or one each where the part would be small in it."""
    both, each = view.box(steps), [view.box([step]) for step in steps]

    def extent(box):
        return max(box[1] - box[0], box[3] - box[2])
    return each if max(map(extent, each)) < FAR * extent(both) else [both, both]


def draw(folder, name):
    """The picture of a run."""
    run = Run(folder)
    view = SceneView(run)
    first, last = run.steps[0], run.steps[-1]
    field, values, span = field_of(run, name)
    boxes = windows(view, [first, last])
    if name in NEAR:
        boxes = [near(boxes[0], run.coordinates(last)[values.argmax()], NEAR[name])] * 2
    width, height = (max(box[k + 1] - box[k] for box in boxes) for k in (0, 2))
    beside = width < 2.0 * height
    inches = panel_size(width, height, 3.4 if beside else 7.0, 3.6 if beside else 2.6)
    rows, columns = (1, 2) if beside else (2, 1)
    fig, axes = figure(rows, columns, (columns * (inches[0] + 0.3) + 0.9, rows * (inches[1] + 0.35)), grid=False)
    start, end = axes.flat
    for panel, step, box in zip((start, end), (first, last), boxes):
        view.frame(panel, box, bare=True)
        view.dies(panel, step, box)
    view.mesh(start, first.generation, run.coordinates(first))
    view.outline(start, first.generation, run.coordinates(first))
    start.set_title("start")
    if field:
        colour_bar(fig, view.field(end, last, values, scale_for(*span)), end)
    else:
        view.mesh(end, last.generation, run.coordinates(last))
        view.outline(end, last.generation, run.coordinates(last))
    end.set_title(field_title(field, run.axisymmetric) if field else "end")
    return Picture(name, when(run, last), fig)


def save(picture, path):
    """As PNG of few colours, as sharp as the size allows."""
    for dpi in (110, 90, 70, 55):
        data = in_few_colours(picture.image(dpi))
        if len(data) <= MOST_BYTES:
            break
    with open(path, "wb") as file:
        file.write(data)
    return len(data)


def show(folder):
    """The pictures of a folder, in its README below the title's paragraph."""
    path = os.path.join(folder, "README.md")
    with open(path, encoding="utf-8") as file:
        text = file.read()
    names = sorted(os.path.basename(one)[len("picture_"):-len(".png")] for one in glob.glob(os.path.join(folder, "picture_*.png")))
    shown = "\n".join([MARK, *(f"![{name}](picture_{name}.png)" for name in names), MARK])
    if MARK in text:
        text = re.sub(rf"{MARK}.*?{MARK}", shown, text, count=1, flags=re.S)
    else:
        title, rest = text.split("\n", 1)
        text = f"{title}\n{shown}\n\n{rest}"
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--programs", default=os.path.join(ROOT, "build", "bin"))
    parser.add_argument("--runs", default=os.path.join(ROOT, "out"))
    parser.add_argument("names", nargs="*")
    options = parser.parse_args()
    decks = {os.path.basename(path)[:-len(".lag")]: path for path in sorted(glob.glob(os.path.join(ROOT, "decks", "*", "*.lag")))}
    unknown = set(options.names) - set(decks)
    if unknown:
        raise SystemExit(f"no deck {', '.join(sorted(unknown))}; decks: {' '.join(decks)}")
    folders = set()
    for name in options.names or decks:
        out = os.path.join(options.runs, name)
        with open(decks[name], encoding="utf-8") as file:
            program = "lagacycle" if re.search(r"^(REMSH|BODY)\b", file.read(), re.M) else "lagamine"
        if not os.path.exists(os.path.join(out, "summary.json")):
            code = subprocess.run([os.path.join(options.programs, program), decks[name], "--out", out, "--quiet"], check=False).returncode
            if code not in (0, 3):      # a limit that is sought: decks/incline
                raise SystemExit(f"{name}: {program} ended with {code}")
        folder = os.path.dirname(decks[name])
        size = save(draw(out, name), os.path.join(folder, f"picture_{name}.png"))
        folders.add(folder)
        print(f"{name}: {size // 1000} kB")
    for folder in sorted(folders):
        show(folder)
    return 0


if __name__ == "__main__":
    sys.exit(main())
