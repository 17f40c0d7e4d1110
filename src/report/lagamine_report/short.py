"""The result of a run, with its checks, in a few lines."""
import math
import os
import shlex
import sys
from dataclasses import dataclass
from typing import Dict, List, Optional, TextIO, Union

from .cycle import new_meshes
from .reader import Run
from .tables import number, warnings_of
from .words import brief

# Above these the page warns: shares of the work, of the volume and of what all remeshings change of it, what a sound linear
# solution leaves, the share of an element's strain that its points do not see, and what the books of heat lack of the heat that passed.
ENERGY_IMBALANCE, VOLUME_DRIFT, VOLUME_BY_MESHES, LINEAR_RESIDUAL, SPURIOUS_MODE = 0.01, 0.01, 0.001, 1e-10, 0.9
PATH_ERROR = 0.02
SPRING_SHARE, DAMPED_SHARE = 1e-3, 0.01
HEAT_IMBALANCE = 1e-6
# Depths in summary.json, the share of the allowed beside them, what that may be where it is not 1, and how far above it is reported as too
# large, as in the listing.
PENETRATIONS = {"max_penetration": "at points of contact", "max_penetration_sampled": "between points of contact too"}
OVER_ALLOWED, BOUND, RATIO_SLACK = "_over_allowed", "_bound", 1e-6
# Signs of the page that not every terminal has.
PLAIN = {0x2212: "-", 0x202F: None, 0x221E: "infinite", 0x2013: "-"}


@dataclass
class Check:
    """A check: what was found, what is allowed, whether it holds (None: there is no limit), what to do about it."""

    name: str
    found: str
    allowed: str
    good: Optional[bool]
    advice: str = ""

    @property
    def warning(self) -> str:
        """The message when it does not hold."""
        return f"{self.name} {self.found}, allowed {self.allowed}" + (f": {self.advice}" if self.advice else "")


def percent(value: float) -> str:
    return f"{brief(100 * value, 3)} %" if math.isfinite(value) else brief(value)


def checks(run: Run) -> List[Check]:
    """The checks in summary.json, compared with what is allowed."""
    given = run.summary["checks"]
    values = {name: number(value) for name, value in given.items()}
    result = []

    def within(name: str, title: str, limit: float, shown, advice: str) -> None:
        if name in given:
            good = abs(values[name]) <= limit
            result.append(Check(title, shown(values[name]), shown(limit), good, "" if good else advice))

    result += penetration_checks(run, values)
    within("energy_imbalance", "energy imbalance", ENERGY_IMBALANCE, percent, "take smaller steps (STRAT) and compare")
    within("damped_share", "work of damping", DAMPED_SHARE, percent, "compare with smaller steps (STRAT)")
    for name, title, norm in (("path_error_motion", "error of the motion by the path within steps, in sum", "PATH"),
                              ("path_error_stress", "error of the stress by the path within steps", "RATE")):
        within(name, title, PATH_ERROR, percent, f"take smaller steps ({norm} of NORMS, STRAT) and compare")
    within("spring_share", "weak springs, of the largest force", SPRING_SHARE, percent, "take weaker springs (SPRNG) and compare")
    within("heat_imbalance", "heat imbalance", HEAT_IMBALANCE, percent, "solve steps more exactly (NORMS)")
    if "volume_drift_unloaded" in given:
        within("volume_drift_unloaded", "volume drift, without elastic strain", VOLUME_DRIFT, percent,
               "look for distorted elements, and for plastic laws that keep no volume")
        result.append(Check("volume drift, with elastic strain", percent(values.get("volume_drift", math.nan)), "–", None))
    else:
        within("volume_drift", "volume drift", VOLUME_DRIFT, percent, "look for large elastic volume changes or distorted elements")
    by_meshes = volume_by_meshes(run)
    if math.isfinite(by_meshes):
        good = abs(by_meshes) <= VOLUME_BY_MESHES
        result.append(Check("volume drift by new meshes, in all", percent(by_meshes), percent(VOLUME_BY_MESHES), good,
                            "" if good else "take smaller elements where the contour is round (REMSH SIZE, TURN)"))
    within("worst_linear_residual", "worst linear residual", LINEAR_RESIDUAL, lambda value: brief(value, 2),
           "the equations are badly scaled or nearly singular: look at the supports")
    within("spurious_mode", "strain unseen by the points of an element", SPURIOUS_MODE, percent,
           "compare with PL8LS of 9 points and MEAN, or of 4 points, and with a finer mesh")
    within("phase_fractions", "fractions of phases, off [0, 1] or their sum 1", values.get("phase_fractions_allowed", math.inf),
           lambda value: brief(value, 2), "report it with the deck")
    if "least_dissipation" in given:
        # of a point, per area or volume; round-off of the sums there is allowed
        good = values["least_dissipation"] >= values.get("least_dissipation_allowed", 0.0)
        result.append(Check("least plastic or friction work of a step", brief(values["least_dissipation"], 3), "not negative", good,
                            "" if good else "flow or friction gave energy back: report it with the deck"))
    known = {*PENETRATIONS, *(name + end for name in PENETRATIONS for end in (OVER_ALLOWED, BOUND)), "energy_imbalance", "heat_imbalance", "volume_drift",
             "damped_share", "path_error_motion", "path_error_stress", "spring_share", "volume_drift_unloaded", "worst_linear_residual",
             "least_dissipation", "least_dissipation_allowed", "spurious_mode",
             "phase_fractions", "phase_fractions_allowed"}
    for name in given:
        if name not in known:
            result.append(Check(name.replace("_", " "), brief(values[name], 4), "–", None))
    return result


def penetration_checks(run: Run, values: Dict[str, float]) -> List[Check]:
    """Depths in the dies, at points of contact and between them too, over what the contact laws allow (PENETR)."""
    result = []
    worst = 1.0
    for name, title in PENETRATIONS.items():
        depth, ratio = values.get(name, math.nan), values.get(name + OVER_ALLOWED, math.nan)
        if math.isnan(depth) or not run.summary["effects"].get("contact", {}).get("on", True):
            continue
        if not ratio > 0:       # no contact law says what it allows, or nothing was touched
            result.append(Check(f"depth {title}", brief(depth, 3), "–", None))
            continue
        bound = values.get(name + BOUND, 1.0)
        good = ratio <= bound + RATIO_SLACK
        advice = str(run.summary["advice"].get(name + OVER_ALLOWED, "as at the points" if ratio <= worst + RATIO_SLACK else ""))
        worst = max(worst, ratio)
        result.append(Check(f"depth over allowed {title}", f"{brief(ratio, 3)} (depth {brief(depth, 3)})", brief(bound, 3), good,
                            "" if good else advice))
    return result


def volume_by_meshes(run: Run) -> float:
    """Sum over the remeshings of what each changed the volume by, as a share of the first volume of the matter that is there; NaN where
    it is not given. A mesh that is cut is left out: what it leaves was pressed together otherwise than all."""
    steps, drift = run.history.get("step"), run.history.get("volume_drift")
    total, given = 0.0, False
    for row in new_meshes(run.tries):
        if steps is None or drift is None or math.isnan(row.volume) or math.isnan(row.initial_volume) or row.numbers["removed_volume"] > 0:
            continue
        at = drift.values[steps.values == row.step]
        if len(at) == 1:
            total, given = total + row.volume / row.initial_volume - (1 + float(at[0])), True
    return total if given else math.nan


def command(run: Run) -> str:
    """The command that makes these results again, or goes on with them."""
    if not run.ended:
        checkpoint = os.path.join(run.folder, run.name + ".ckp.h5")
        if run.tries or not os.path.exists(checkpoint):
            return f"{'lagacycle' if run.tries else 'lagamine'} DECK --out {shlex.quote(run.folder)}"
        return f"lagamine DECK --out {shlex.quote(run.folder)} --resume {shlex.quote(checkpoint)}"
    given = run.summary.get("command")
    if isinstance(given, str) and given:
        return given
    words = ["lagamine", run.summary["deck"], "--out", run.folder.rstrip("/") or "/"]
    if isinstance(run.summary.get("parameters"), dict):
        for name, value in run.summary["parameters"].items():
            words += ["-p", f"{name}={value}"]
    return shlex.join(words)


def headline(run: Run) -> str:
    """`done: end of the scene`."""
    reason = run.summary.get("stop_reason") or ""
    return run.summary["status"] + (f": {reason}" if reason else "")


def short_lines(run: Run) -> List[str]:
    """The result in a few lines for a terminal; numbers in plain letters."""
    s = run.summary
    wall = run.calls.wall if run.calls.number > 1 else number(s.get("wall_s"))
    end = f" of {brief(number(s['end_time']))}" if "end_time" in s else ""
    lines = [run.title, headline(run),
             f"  time {brief(number(s.get('time')))}{end}, {s.get('steps', '?')} steps, "
             f"{s.get('iterations', '?')} iterations, {s.get('cutbacks', '?')} cutbacks, {s.get('remeshings', 0)} remeshings"]
    if run.ended:
        lines.append(f"  {s.get('elements', '?')} elements, {s.get('dofs', '?')} equations, {brief(wall, 3)} s")
    for die in run.die_names:
        for axis in "yx":
            force = run.history.get(f"force_{axis}_{die}")
            if force is not None and abs(force.largest) > 0:
                lines.append(f"  {force.name}: last {brief(force.known[-1])}, largest {brief(force.largest)}")
                break
    for check in checks(run):
        if check.good is False:
            lines.append(f"  WARNING: {check.warning}")
    lines += [f"  WARNING: {text}" for text in warnings_of(s, checks=False)]
    return [line.translate(PLAIN) for line in lines]


def print_short(run: Union[Run, str], file: Optional[TextIO] = None) -> None:
    """Print the short result of a run, or of the folder it is in."""
    if isinstance(run, str):
        run = Run(run)
    for line in short_lines(run):
        print(line, file=file or sys.stdout)
