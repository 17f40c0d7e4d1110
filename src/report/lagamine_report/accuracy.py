"""What accuracy a run has had, by its own estimates, and what half of each error would cost."""
from typing import Dict, List, Tuple

from .markup import Sections, escape, table
from .reader import Run
from .tables import number
from .words import brief

# Of `accuracy` in summary.json: entry, where, numbers with their words.
ROWS: List[Tuple[str, str, Dict[str, str]]] = [
    ("space", "in space", {"stress_pct": "stress {} %", "strain_pct": "strain {} %"}),
    ("heat_space", "in space, of heat", {"end": "{} [temperature] at the end", "largest": "at most {}", "mean_largest": "{} in the mean square",
                                             "fraction": "a phase by these temperatures {} at most", "fraction_mean": "{} in the mean square", "hardness": "hardness {} HV at most"}),
    ("shape", "in space, of the shape that fronts leave", {"displacement": "up to {}", "of_displacement": "of {} [length]", "curvature": "curvature of the section {}",
                                                           "of_curvature": "of {} [1/length]"}),
    ("path", "in time, by the path within steps", {"motion_pct": "motion {} % in sum", "stress_pct": "stress {} % at the end"}),
    ("heat", "in time, of heat", {"end": "{} [temperature] at the end", "largest": "at most {}", "stress_pct": "stress {} %", "work_not_heat": "{} behind the work (SOLVE)"}),
    ("contact", "at contact", {"depth": "depth {} [length]", "over_allowed": "{} of the allowed"}),
]
# Words for the stress where `stress_known` is false.
HIDDEN = "stress hidden by its error: no estimate above 100 %"
UNKNOWN = {"space": HIDDEN, "path": "stress at least {} % (at this motion)", "heat": HIDDEN}
HOW = {"space": "twice the elements", "shape": "twice the elements", "heat_space": "twice the elements", "path": "shorter steps", "heat": "shorter steps"}


def accuracy_section(run: Run) -> Sections:
    """The table; nothing of runs that have not ended or have no estimate."""
    given = run.summary.get("accuracy")
    if not isinstance(given, dict) or not given:
        return []
    rows = []
    for name, where, words in ROWS:
        entry = given.get(name)
        if not isinstance(entry, dict):
            continue
        if entry.get("stress_known") is False and name in UNKNOWN:
            words = {**words, "stress_pct": UNKNOWN[name]}
        found = ", ".join(text.format(brief(number(entry[key]), 3)) for key, text in words.items() if key in entry)
        if name == "shape" and entry.get("known") is False:
            found = f"not known: an element holds {brief(number(entry.get('share_in_element')), 2)} of a front"
        if entry.get("stress_without_heat") is True:
            found += " (without that of temperatures)"
        if entry.get("contact_places_known") is False:
            found += " (without that of where contact stands: dies, or the section, are free)"
        cost = f"about {brief(number(entry['half_costs']), 2)} times the time ({HOW[name]})" if "half_costs" in entry else "\N{EN DASH}"
        rows.append(("", (escape(where), escape(found), escape(cost))))
    asked = given.get("asked")
    if isinstance(asked, dict):
        rows.append(("", _asked(asked)))
    return [("accuracy", "Accuracy", table(("", "estimated error", "half of it costs"), rows))]


def _asked(entry: Dict) -> Tuple[str, str, str]:
    """The row of a deck with ACCURACY."""
    reached, expected = entry.get("reached"), entry.get("expected")
    reached, expected = (part if isinstance(part, dict) else {} for part in (reached, expected))
    found = (f"asked {brief(number(entry.get('error_pct')), 3)} %, reached {brief(number(reached.get('error_pct')), 3)} % of {reached.get('quantity', '?')}, "
             f"expected {brief(number(expected.get('error_pct')), 3)} %; spent {brief(number(entry.get('spent_s')), 3)} s of processor, "
             f"expected {brief(number(entry.get('expected_s')), 3)} s")
    cost = f"about {brief(number(entry['half_costs']), 2)} times the time (measured by pilots)" if "half_costs" in entry else "\N{EN DASH}"
    return escape("ACCURACY"), escape(found), escape(cost)
