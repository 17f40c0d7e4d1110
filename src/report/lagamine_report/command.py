"""`lagareport DIR`, `lagareport DIR DIR ...`, `lagareport DECK`, `lagareport FILE.met`: arguments -> page -> exit code."""
import gc
import os
import sys
from typing import TYPE_CHECKING, Dict, Optional, Sequence

from .deck_scene import ENDING, Scene, checked_scene, deck_name, read_scene, read_scene_file
from .errors import EXIT_DONE, EXIT_MACHINE, ReportError
from .program import Parser, Version, print_failure, refuse_to_replace, run_to_code, write
from .reader import Run
from .short import print_short

if TYPE_CHECKING:
    from .profiles import Profile
    from .reader import Step

EXIT_CODES = "Exit codes: 0 done, 2 no results or a damaged file, 5 the page cannot be written."
MODULES = ("numpy", "h5py", "matplotlib")
COLLECT_AFTER = 200_000     # new objects: figures have many that live as long as the page is made


def main(arguments: Sequence[str], version: str) -> int:
    """The exit code of the program."""
    return run_to_code(lambda: run_program(arguments, version))


def run_program(arguments: Sequence[str], version: str) -> int:
    """Read the arguments, make the page, print the short result."""
    gc.set_threshold(COLLECT_AFTER)
    parser = Parser("lagareport", description="The results of a run as one self-contained HTML page with pictures.",
                    epilog=EXIT_CODES)
    parser.add_argument("folders", metavar="DIR", nargs="+", help="folder of the results: what `lagamine DECK --out DIR` wrote; two or more "
                        "are compared; or a deck, or the folder with its scene, which is drawn before any run; or a .met file, whose steels are drawn")
    parser.add_argument("--out", metavar="FILE", help="the page (default: DIR/report.html; of several runs compare.html, of a deck NAME.html and "
                        "NAME.svg, of a .met file NAME.html, in the present folder)")
    parser.add_argument("-p", metavar="NAME=VALUE", dest="parameters", action="append", default=[], help="of a deck: set a parameter of it")
    parser.add_argument("--field", metavar="NAME", action="append", default=[],
                        help="show this field large and over time, instead of the usual ones; may be repeated")
    parser.add_argument("--line", metavar=("X1", "Y1", "X2", "Y2"), nargs=4, type=float, action="append", default=[],
                        help="fields (those of --field, otherwise all but elastic strains) along this line through the bodies: a table, line_N.csv beside the page, and a picture; may be repeated")
    parser.add_argument("--side", metavar="CONTACT", action="append", default=[],
                        help="pressure and friction along the sides of this contact (`b.3/die`): side_CONTACT.csv, and a picture; may be repeated")
    parser.add_argument("--time", metavar="T", type=float, help="of --line and --side: the saved instant nearest to this time (default: the last)")
    parser.add_argument("--png", metavar="DIR", help="write the pictures as PNG files into this folder too")
    parser.add_argument("--animation", metavar="FILE", help="the forming as a moving picture too, .gif or .png: the first field of --field, "
                        "otherwise the equivalent plastic strain, or what there is")
    parser.add_argument("--mirror", action="store_true", help="axisymmetric scenes: show both halves of the section")
    parser.add_argument("--quiet", action="store_true", help="print nothing when all goes well")
    parser.add_argument("--version", action=Version, version=version, modules=MODULES)
    options = parser.parse_args(list(arguments))
    for stream in (sys.stdout, sys.stderr):
        stream.reconfigure(errors="replace")     # a title may hold letters that the terminal has not
    try:
        options.folder = options.folders[0]
        if len(options.folders) > 1:
            return compare_runs(options, version)
        if os.path.isfile(options.folder) and options.folder.lower().endswith(".met"):
            return draw_steels(options, version)
        checked = checked_scene(options.folder)
        if checked:
            return draw_deck(options, version, read_scene_file(checked), checked[:-len(ENDING)])
        if os.path.isfile(options.folder):
            return draw_deck(options, version)
        if options.parameters:
            raise ReportError("-p: for a deck; the results of a run have their parameters")
        target = options.out or os.path.join(options.folder, "report.html")
        refuse_to_replace(target)
        run = Run(options.folder)
        # Only now: matplotlib takes its time, and what is refused is refused at once.
        from .album import make_pictures
        from .page import page
        from .side_by_side import draw_side_by_side
        profiles = take_profiles(run, options)
        pictures = make_pictures(run, options.field, options.mirror) + picture_of(run, options, profiles)
        draw_side_by_side(pictures)
        write(target, page(run, pictures, version).encode("utf-8"))
        tables = write_profiles(os.path.dirname(target), profiles)
        if options.png:
            write_pngs(options.png, pictures)
        if options.animation:
            animate(run, options)
    except ReportError as error:
        return print_failure(error)
    if not options.quiet:
        print_short(run)
        print("\n".join([f"  page: {target}"] + [f"  table: {path}" for path in tables]))
    return EXIT_DONE


def take_profiles(run: Run, options) -> Dict[str, "Profile"]:
    """Profiles of --line and --side by the names of their tables."""
    if options.time is not None and not (options.line or options.side):
        raise ReportError("--time: for --line and --side")
    if not (options.line or options.side):
        return {}
    from .pictures import fields_of, known_field
    from .profiles import along_line, along_sides
    if not run.steps:
        raise ReportError(f"--{'line' if options.line else 'side'}: no fields are saved yet")
    step = instant_of(run, options)
    fields = [known_field(run, name) for name in dict.fromkeys(options.field)]
    fields = fields or [name for name in fields_of(run) if not name.startswith("elastic_strain")]
    taken = {f"line_{k}.csv": along_line(run, step, line, fields) for k, line in enumerate(options.line, 1)}
    for name in dict.fromkeys(options.side):
        taken[f"side_{name.replace('/', '_')}.csv"] = along_sides(run, step, name)
    return taken


def instant_of(run: Run, options) -> "Step":
    """The saved instant of --time."""
    return run.steps[-1] if options.time is None else min(run.steps, key=lambda step: abs(step.time - options.time))


def picture_of(run: Run, options, profiles: Dict[str, "Profile"]) -> list:
    """The picture of the profiles, where there are any."""
    from .profile_pictures import lines_picture
    return [lines_picture(run, instant_of(run, options), list(profiles.values()))] if profiles else []


def write_profiles(folder: str, profiles: Dict[str, "Profile"]) -> Sequence[str]:
    """Tables beside the page."""
    paths = [os.path.join(folder, name) for name in profiles]
    for path in paths:
        refuse_to_replace(path)
    for path, profile in zip(paths, profiles.values()):
        write(path, profile.csv())
    return paths


def animate(run: Run, options) -> None:
    """The moving picture of --animation."""
    from .animation import animation
    from .pictures import MAIN_FIELDS, fields_of, known_field
    refuse_to_replace(options.animation)
    if not run.steps:
        raise ReportError("--animation: no fields are saved yet")
    names = fields_of(run)
    usual = [name for name in ("plastic_strain", "temperature", *MAIN_FIELDS, *names) if name in names]
    field = known_field(run, options.field[0]) if options.field else usual[0]
    write(options.animation, animation(run, field, options.animation, options.mirror))


def compare_runs(options, version: str) -> int:
    """The page of several runs."""
    for name, value in (("--field", options.field), ("--mirror", options.mirror), ("--animation", options.animation), ("--line", options.line), ("--side", options.side), ("-p", options.parameters)):
        if value:
            raise ReportError(f"{name}: for a single run or deck; several runs are compared")
    target = options.out or "compare.html"
    refuse_to_replace(target)
    runs = [Run(folder) for folder in options.folders]
    from .compare import compare_page, compare_pictures, labels_of
    labels = labels_of(options.folders)
    pictures = compare_pictures(runs, labels)
    write(target, compare_page(runs, labels, pictures, version).encode("utf-8"))
    if options.png:
        write_pngs(options.png, pictures)
    if not options.quiet:
        print(f"{len(runs)} runs: {', '.join(labels)}\n  page: {target}")
    return EXIT_DONE


def refuse_of_runs(options, why: str) -> None:
    """Options that only the results of a run have an answer to."""
    for name, value in (("--field", options.field), ("--mirror", options.mirror), ("--animation", options.animation), ("--line", options.line), ("--side", options.side)):
        if value:
            raise ReportError(f"{name}: for the results of a run; {why}")


def draw_steels(options, version: str) -> int:
    """The page of the steels of a .met file."""
    refuse_of_runs(options, "a .met file has none")
    target = options.out or deck_name(options.folder) + ".html"
    refuse_to_replace(target)
    from .steel_page import read_steels, steel_page, steel_pictures
    steels, words = read_steels(options.folder, options.parameters)
    pictures = steel_pictures(steels)
    write(target, steel_page(steels, words, pictures, options.folder, version).encode("utf-8"))
    if options.png:
        write_pngs(options.png, pictures)
    if not options.quiet:
        print(f"steels: {', '.join(steel['name'] for steel in steels)}\n  page: {target}")
    return EXIT_DONE


def draw_deck(options, version: str, checked: Optional[Scene] = None, beside: str = "") -> int:
    """The page and the picture of a deck before any run, or of the scene `checked` that --check has left: then they are put beside it."""
    refuse_of_runs(options, "a deck has none yet")
    if checked and options.parameters:
        raise ReportError("-p: for a deck; what --check has left has its parameters")
    target = options.out or (beside or deck_name(options.folder)) + ".html"
    drawing = os.path.splitext(target)[0] + ".svg"
    for path in (target, drawing):
        refuse_to_replace(path)
    scene = checked or read_scene(options.folder, options.parameters)
    from .deck_page import deck_page
    from .deck_picture import deck_picture
    picture = deck_picture(scene)
    write(target, deck_page(scene, picture, options.folder, version).encode("utf-8"))
    write(drawing, picture.svg())
    if options.png:
        write_pngs(options.png, [picture])
    if not options.quiet:
        print(f"{scene.title}\n  page: {target}\n  picture: {drawing}")
    return EXIT_DONE


def write_pngs(folder: str, pictures: Sequence) -> None:
    """mesh.png, fields.png, force.png ... into a folder."""
    try:
        os.makedirs(folder, exist_ok=True)
    except OSError as error:
        raise ReportError(f"{folder}: cannot be made: {error.strerror}", EXIT_MACHINE) from error
    for picture in pictures:
        write(os.path.join(folder, picture.name + ".png"), picture.png())
