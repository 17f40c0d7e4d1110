"""Results of LAGAMINE in Python: runs, histories, fields and integration points as numpy arrays; decks run with parameters.

    import lagamine
    run = lagamine.open("out/billet")
    run.history["force_y_upper"]                  # numpy array, a value an accepted step
    run.times                                     # of the saved instants
    x = run.coordinates(-1)                       # (node, 2) at the last of them
    strain = run.field("plastic_strain", -1)      # (node,)
    p = run.points("billet", -1)                  # integration points: p.x (element, point, 2), p["stress_yy"] (element, point)

    fine = lagamine.run("billet.lag", "out/fine", nx=24, ny=36)
"""
from lagamine_report.errors import ReportError as LagamineError

from .results import Points, Results, open_run as open  # noqa: A004  (lagamine.open)
from .running import run

__all__ = ["LagamineError", "Points", "Results", "open", "run"]
