"""Which pictures a run gets, in the order of the page."""
from typing import List, Optional, Sequence

from .contact_curves import contact_picture
from .contact_map import pressure_picture
from .cooling import cooling_picture
from .curves import energy_picture, force_picture, heat_picture, probes_picture, seconds_picture, steps_picture
from .errors import ReportError
from .picture import Picture
from .pictures import MAIN_FIELDS, fields_of, fields_picture, generations_picture, known_field, mesh_picture, series_picture
from .reader import Run
from .rates import strain_rate_picture
from .remeshes import remesh_pictures
from .scene_view import SceneView
from .steel_diagram import run_diagrams


def make_pictures(run: Run, fields: Sequence[str] = (), mirror: bool = False) -> List[Picture]:
    """All pictures that the run has something to show for, in the order of the page."""
    curves = [force_picture(run), probes_picture(run), cooling_picture(run), steps_picture(run), energy_picture(run), heat_picture(run), seconds_picture(run)]
    return [picture for picture in [*shapes(run, fields, mirror), *curves] if picture is not None] + run_diagrams(run)


def shapes(run: Run, fields: Sequence[str], mirror: bool) -> List[Optional[Picture]]:
    """Pictures of saved instants."""
    if not run.steps:       # it has only just begun
        if fields:
            raise ReportError(f"--field {fields[0]}: no fields are saved yet")
        return []
    view = SceneView(run, mirror)
    names = fields_of(run)
    chosen = [known_field(run, name) for name in dict.fromkeys(fields)]
    chosen = chosen or [name for name in names if name in MAIN_FIELDS] or names[:2]
    over_time = chosen if fields else [name for name in ("plastic_strain", "temperature") if name in names] or chosen[:1]
    pictures = [mesh_picture(view), generations_picture(view), *remesh_pictures(view), fields_picture(view, chosen),
                fields_picture(view, [name for name in names if name not in chosen], "more", small=True)]
    series = [series_picture(view, name) for name in over_time]
    return pictures + series + [strain_rate_picture(view), pressure_picture(view), contact_picture(run)]
