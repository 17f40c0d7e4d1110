"""The page of the steels of a .MET file: their diagrams, and what `lagamine --met` prints."""
import glob
import json
import os
import tempfile
from typing import List, Sequence, Tuple

from .deck_scene import ask_solver, solver_program
from .errors import EXIT_MACHINE, ReportError
from .markup import Sections, document, escape, figure, joined
from .picture import Picture
from .steel_diagram import diagram_picture, hardness_picture, has_diagrams


def read_steels(path: str, parameters: Sequence[str] = ()) -> Tuple[List[dict], str]:
    """The steels of a file as the solver writes them, and what it prints."""
    with tempfile.TemporaryDirectory(prefix="lagareport-") as folder:
        words = ask_solver(["--met", path, "--out", folder], parameters)
        steels = []
        try:
            for one in sorted(glob.glob(os.path.join(glob.escape(folder), "*.steel.json"))):
                with open(one, encoding="utf-8") as file:
                    steels.append(json.load(file))
        except (OSError, ValueError) as error:
            raise ReportError(f"{solver_program()}: wrote a steel that cannot be read ({error})", EXIT_MACHINE) from error
    if not steels:
        raise ReportError(f"{solver_program()}: wrote no steels: is it of the same version?", EXIT_MACHINE)
    return steels, words


def steel_pictures(steels: Sequence[dict]) -> List[Picture]:
    """Diagrams, and mixtures after coolings, of each steel that has them."""
    pictures = []
    for k, steel in enumerate(steels, 1):
        if has_diagrams(steel):
            pictures += [diagram_picture(steel, name=f"diagram_{k}"), hardness_picture(steel, f"mixtures_{k}")]
    return [picture for picture in pictures if picture is not None]


def steel_page(steels: Sequence[dict], words: str, pictures: Sequence[Picture], path: str, version: str) -> str:
    """The whole page as text."""
    body: Sections = [(picture.name, picture.heading, figure(picture, picture.heading)) for picture in pictures]
    body.append(("numbers", "Numbers", f"<pre>{escape(words)}</pre>"))
    title = ", ".join(steel["name"] for steel in steels)
    footer = f"lagareport {escape(version)}, from {escape(os.path.basename(path))}. Degrees Celsius, seconds, HV, MPa, MJ/m³."
    return document(title, f"<h1>{escape(title)}</h1>", joined(body), footer)
