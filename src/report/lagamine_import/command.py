"""`lagaimport FILE`: arguments -> rows of a deck and a picture -> exit code."""
import importlib
import math
import os
import sys
from typing import List, Sequence

from lagamine_report.errors import EXIT_DONE, EXIT_INPUT, EXIT_MACHINE, ReportError
from lagamine_report.program import Parser, Version, print_failure, refuse_to_replace, run_to_code, write

from .mistakes import Mistakes, Refused, count

EXIT_CODES = "Exit codes: 0 done, 2 the file or an option is refused, 5 the machine failed (a package is missing, output cannot be written)."
MODULES = ("numpy", "matplotlib", "meshio", "ezdxf")
FORMATS = {".msh": "mesh", ".inp": "mesh", ".med": "mesh", ".dxf": "contour", ".csv": "contour", ".txt": "contour"}
PACKAGES = {".msh": "meshio", ".med": "meshio", ".dxf": "ezdxf"}


def main(arguments: Sequence[str], version: str) -> int:
    """The exit code of the program."""
    return run_to_code(lambda: run_program(arguments, version))


def run_program(arguments: Sequence[str], version: str) -> int:
    """Read the arguments, import, write the rows and the picture."""
    options = _parser(version).parse_args(list(arguments))
    for stream in (sys.stdout, sys.stderr):
        stream.reconfigure(errors="replace")
    try:
        lines = import_file(options, version)
    except ReportError as error:
        return print_failure(error)
    if not options.quiet:
        print("\n".join(lines))
    return EXIT_DONE


def _parser(version: str) -> Parser:
    parser = Parser("lagaimport", description="A mesh (.msh of Gmsh, .inp of Abaqus and CalculiX, .med) or a contour (.dxf, .csv) as the cards "
                    "of a LAGAMINE deck, in a file for INCLU, with a picture.", epilog=EXIT_CODES)
    parser.add_argument("file", metavar="FILE", help="what is imported; its ending shows what it is")
    parser.add_argument("--out", metavar="FILE", help="the cards (default: FILE with the ending .inc)")
    parser.add_argument("--picture", metavar="FILE", help="the picture, SVG (default: beside the cards, with the ending .svg)")
    parser.add_argument("--body", metavar="NAME", action="append", default=[], help="a layer of a drawing, or a set of a mesh, that is a body; may be repeated")
    parser.add_argument("--die", metavar="LAYER", action="append", default=[], help="a layer of a drawing that is a die; may be repeated")
    parser.add_argument("--rename", metavar="OLD=NEW", action="append", default=[], help="a set or layer gets another name in the deck")
    parser.add_argument("--scale", type=float, default=1.0, metavar="F", help="coordinates times this (default 1)")
    parser.add_argument("--shift", type=float, nargs=2, default=(0.0, 0.0), metavar=("X", "Y"), help="then moved by this [length of the deck]")
    parser.add_argument("--npoint", type=int, choices=(4, 9), default=4, help="integration points of an element (default 4)")
    parser.add_argument("--mean", action="store_true", help="the option MEAN, with 9 points")
    parser.add_argument("--law", metavar="NAME", help="the law of all bodies (default: the name of the material, otherwise of the body)")
    mesh = parser.add_argument_group("meshes")
    mesh.add_argument("--sides", metavar="SET", action="append", default=[], help="a set that becomes sides (default: every one); may be repeated")
    mesh.add_argument("--without", metavar="SET", action="append", default=[], help="a set that is left out; may be repeated")
    mesh.add_argument("--plane", choices=("XY", "XZ", "YZ"), default="XY", help="the plane the mesh lies in (default XY)")
    mesh.add_argument("--apart", action="store_true", help="bodies that have nodes at the same places only touch")
    contour = parser.add_argument_group("contours")
    contour.add_argument("--part", type=float, nargs=2, metavar=("X", "Y"), help="a point of the part: it is on the left of the dies (default: where the bodies are)")
    contour.add_argument("--pilot", type=float, nargs=2, metavar=("X", "Y"), help="where the pilots of the dies stand")
    contour.add_argument("--tolerance", type=float, metavar="L", help="how far parabolas may be from arcs and splines [length of the deck]; asked for where there are any")
    contour.add_argument("--gap", type=float, metavar="L", help="ends no farther apart are one point [length of the deck] (default: 1e-6 of the size)")
    contour.add_argument("--smooth", action="store_true", help=".csv: parabolas along a smooth curve through the points, not segments")
    contour.add_argument("--corner", type=float, default=30.0, metavar="ANGLE", help=".csv: with --smooth, corners are where the way turns by more [degrees] (default 30)")
    parser.add_argument("--quiet", action="store_true", help="print nothing when all goes well")
    parser.add_argument("--version", action=Version, version=version, modules=MODULES)
    return parser


def import_file(options, version: str) -> List[str]:
    """Write the cards and the picture; lines for the user."""
    stem, ending = os.path.splitext(options.file)
    ending = ending.lower()
    if ending not in FORMATS:
        raise Refused(f"{options.file}: the ending '{ending}' is not known: expected one of {' '.join(FORMATS)}")
    if not os.path.isfile(options.file):
        raise Refused(f"{options.file}: no such file")
    _refuse_options(options, ending)
    package = PACKAGES.get(ending)
    if package:
        _require(package)
    target = options.out or stem + ".inc"
    picture = options.picture or os.path.splitext(target)[0] + ".svg"
    if os.path.abspath(options.file) in (os.path.abspath(target), os.path.abspath(picture)):
        raise Refused(f"{target}: is the file that is imported; give another name by --out")
    for path in (target, picture):
        refuse_to_replace(path)
    mistakes = Mistakes(options.file)
    cards, words, svg = (_mesh if FORMATS[ending] == "mesh" else _contour)(options, ending, mistakes)
    head = [f"! {os.path.basename(options.file)}, imported by lagaimport {version}; to be included in a deck: INCLU {os.path.basename(target)}"]
    write(target, ("\n".join(head + cards) + "\n").encode("ascii"))
    write(picture, svg)
    return [f"{options.file}: {words[0]}", *(f"  {line}" for line in words[1:]), f"  cards: {target}", f"  picture: {picture}"]


def _require(package: str) -> None:
    """A package, or one line that names it."""
    try:
        importlib.import_module(package)
    except ImportError as error:
        raise Refused(f"lagaimport: the Python package {package} is missing for {sys.executable} ({error}): install python3-{package}",
                      EXIT_MACHINE) from error


def _refuse_options(options, ending: str) -> None:
    """Numbers that make no sense, and options that belong to the other kind of file."""
    mesh = FORMATS[ending] == "mesh"
    strange = []
    given = {"--die": options.die, "--part": options.part, "--pilot": options.pilot, "--tolerance": options.tolerance, "--gap": options.gap} if mesh \
        else {"--sides": options.sides, "--without": options.without, "--apart": options.apart, "--plane": options.plane != "XY"}
    if ending not in (".csv", ".txt"):
        given["--smooth"] = options.smooth
    strange += [f"{name}: not for a file of the kind {ending}" for name, value in given.items() if value not in (None, False, [])]
    for name, value in (("--scale", options.scale), ("--tolerance", options.tolerance), ("--gap", options.gap), ("--corner", options.corner)):
        if value is not None and not (math.isfinite(value) and value > 0):
            strange.append(f"{name} {value:g}: expected a number above 0")
    for name, point in (("--shift", options.shift), ("--part", options.part), ("--pilot", options.pilot)):
        if point and not all(map(math.isfinite, point)):
            strange.append(f"{name}: expected two finite numbers")
    if options.mean and options.npoint != 9:
        strange.append("--mean: expected --npoint 9 with it")
    if strange:
        raise Refused("\n".join(f"lagaimport: {line}" for line in strange), EXIT_INPUT)


def _mesh(options, ending: str, mistakes: Mistakes):
    """Cards, words and picture of a mesh."""
    from .mesh_build import MeshWishes, build_mesh
    from .names import Names, read_renames
    from .rows import mesh_rows
    if ending == ".inp":
        from .inp_read import read_inp
        raw = read_inp(options.file, mistakes)
    else:
        from .meshio_read import read_by_meshio
        raw = read_by_meshio(options.file, "gmsh" if ending == ".msh" else "med", mistakes)
    stem = os.path.splitext(os.path.basename(options.file))[0]
    wishes = MeshWishes(stem, options.body, options.sides, options.without, options.plane, options.scale, tuple(options.shift), options.apart)
    mesh = build_mesh(raw, wishes, Names(read_renames(options.rename), mistakes), mistakes)
    from .sketch import mesh_sketch
    words = [f"{count(len(mesh.points), 'node')}, {count(sum(len(body.nodes) for body in mesh.bodies), 'element')}"]
    words += [f"PL8LS {body.name}: {count(len(body.nodes), 'element')}, {options.npoint} points, LAW {options.law or body.law}" for body in mesh.bodies]
    words += [f"SIDES {name}: {count(len(sides), 'side')}" for name, sides in mesh.sides.items()]
    return mesh_rows(mesh, options.npoint, options.mean, options.law), words + mesh.notes, mesh_sketch(mesh, os.path.basename(options.file))


def _contour(options, ending: str, mistakes: Mistakes):
    """Cards, words and picture of contours."""
    from .contours import ContourWishes, build_contours
    from .names import Names, read_renames
    from .rows import contour_rows
    notes: List[str] = []
    tolerance = options.tolerance / options.scale if options.tolerance else 1.0    # in the units of the file
    if ending == ".dxf":
        from .dxf_read import read_dxf
        drawing = read_dxf(options.file, tolerance, set(options.die) | set(options.body), mistakes)
        layers, present, notes = drawing.layers, drawing.present, drawing.notes
    else:
        from .csv_read import read_csv
        named = [*options.body, *options.die]
        if len(named) != 1:
            mistakes.add("points", "say what the contour is: expected one of --die NAME and --body NAME")
            mistakes.refuse()
        layers = {named[0]: read_csv(options.file, named[0], options.smooth, options.corner, tolerance, mistakes)}
        present = named
    if options.tolerance is None and any(piece.form != "SEGM" for pieces in layers.values() for piece in pieces):
        mistakes.add("--tolerance", "there are arcs or smooth curves: say how far parabolas may be from them by --tolerance L")
    wishes = ContourWishes(options.die, options.body, tuple(options.part) if options.part else None, options.gap, options.scale,
                           tuple(options.shift), notes)
    contours = build_contours(layers, present, wishes, Names(read_renames(options.rename), mistakes), mistakes)
    from .sketch import contour_sketch
    cards, words = [], [", ".join(f"{contour.card} {contour.name}" for contour in contours)]
    for contour in contours:
        cards += contour_rows(contour, options.npoint, options.mean, options.law, options.pilot, options.tolerance or 0.0)
        forms = {form: sum(piece.form == form for piece in contour.rows()) for form in ("SEGM", "ARC", "PARAB")}
        words.append(f"{contour.card} {contour.name}: " + ", ".join(f"{number} {form}" for form, number in forms.items() if number)
                     + (", closed" if contour.closed else "") + f"; the part is on the left: {contour.side_by}")
    return cards, words + wishes.notes, contour_sketch(contours, os.path.basename(options.file))
