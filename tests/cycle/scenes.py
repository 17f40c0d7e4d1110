"""Scenes of decks with REMSH alone: which they are, how they are run, and the table of what came of it."""
import glob
import json
import os
import re
import time

from force_changes import changes_at_ordinary_steps, changes_at_remeshes, described
from remeshed import ROOT, cycle, facts, tries
from support import DONE, history, run, said, summary, write

STEP = (0.01, 0.05)                                                        # of the largest step [time]
# Each with its die and the parameters that may be drawn, (least, largest).
SCENES = {
    "can": ("punch", {"punch": (5.0, 8.0), "edge": (0.4, 2.5), "height": (8.0, 16.0), "mu": (0.0, 0.2), "harden": (5.0, 400.0), "step": STEP}),
    "can_sharp": ("punch", {"punch": (5.0, 8.0), "height": (8.0, 16.0), "mu": (0.0, 0.2), "harden": (5.0, 400.0), "step": STEP}),
    "extrusion_long": ("punch", {"angle": (20.0, 55.0), "exit": (4.0, 7.0), "mu": (0.0, 0.12), "harden": (5.0, 300.0), "step": STEP}),
    "h_section": ("upper", {"fillet": (0.8, 3.0), "height": (6.0, 8.0), "flash": (0.6, 1.5), "draft": (0.05, 0.25), "mu": (0.02, 0.35),
                            "harden": (5.0, 400.0), "step": STEP}),
    "ring_70": ("upper", {"inner": (4.0, 9.0), "height": (2.5, 6.0), "mu": (0.03, 0.4), "harden": (5.0, 400.0), "step": STEP}),
    "side_pressing": ("upper", {"radius": (5.0, 20.0), "mu": (0.0, 0.4), "harden": (5.0, 500.0), "step": STEP}),
    "indentation": ("punch", {"half": (2.5, 6.0), "edge": (0.3, 2.0), "height": (10.0, 22.0), "mu": (0.0, 0.35), "harden": (5.0, 400.0),
                              "step": STEP}),
    "piercing": ("punch", {"punch": (3.0, 5.0), "slope": (10.0, 50.0), "edge": (0.3, 1.5), "height": (11.0, 16.0), "mu": (0.02, 0.3),
                           "harden": (5.0, 400.0), "step": STEP}),
    "two_strokes": ("first", {"edge": (0.5, 2.5), "height": (7.0, 14.0), "pitch": (8.0, 12.0), "mu": (0.0, 0.3), "harden": (5.0, 400.0),
                              "step": (0.02, 0.1)}),
    "teeth": ("toothed", {"round": (0.3, 0.8), "draft": (10.0, 35.0), "deep": (1.6, 2.2), "mu": (0.0, 0.3), "harden": (5.0, 400.0), "step": STEP}),
    "springback": ("wiper", {"round": (3.0, 9.0), "thick": (0.5, 1.5), "mu": (0.0, 0.15), "harden": (100.0, 3000.0), "step": STEP}),
    "heading": ("punch", {"free": (15.0, 28.0), "edge": (0.2, 2.0), "mu": (0.02, 0.4), "harden": (5.0, 500.0), "step": STEP}),
    "deformable_punch": ("", {"half": (3.0, 7.0), "edge": (0.5, 2.5), "height": (8.0, 16.0), "mu": (0.0, 0.3), "harden": (5.0, 400.0), "step": STEP}),
    "bimetal": ("upper", {"height": (6.0, 14.0), "core": (3.0, 8.0), "soft": (50.0, 280.0), "hard": (250.0, 600.0), "mu": (0.02, 0.4), "step": STEP}),
}

HEAD = ["| scene | code | meshes | tries refused | steps | smallest step / mean | volume drift % | seconds | |", "|---|---|---|---|---|---|---|---|---|"]


FORCE_HEAD = ["| change of the force | number | mean % | median % | below 0 % | mean size % | 95 % below % |", "|---|---|---|---|---|---|---|"]

# Lines around the table in the README of a scene.
MARK = "<!-- scene -->"
# Limits of every new mesh, and the angle of contour corners below which they do not hold [degrees].
LEAST_ANGLE, LEAST_JACOBIAN = 20.0, 0.25


def deck_of(name):
    return os.path.join(ROOT, "decks", name, name + ".lag")


def asks_by_remsh_alone(path):
    """The deck gives REMSH without a row, and no zones."""
    with open(path, encoding="utf-8") as file:
        text = file.read()
    return bool(re.search(r"^REMSH[ \t]*(!.*)?\n(?=[A-Z])", text, re.MULTILINE)) and not re.search(r"^(ZONE|ZPNT)", text, re.MULTILINE)


def run_scene(name, out, parameters=None, deck=None):
    """One scene by lagacycle: what came of it."""
    words = [word for key, value in (parameters or {}).items() for word in ("-p", f"{key}={value!r}")]
    begun, processor = time.monotonic(), spent()
    result = cycle(deck or deck_of(name), out, "--fresh", "--quiet", *words)
    found = {"name": name, "code": result.returncode, "seconds": time.monotonic() - begun, "said": said(result).strip(), "out": out}
    found["processor"] = spent() - processor
    rows = tries(out)
    found["meshes"] = sum(row["accepted"] == "y" and row["action"] != "old mesh" for row in rows)
    found["refused"] = sum(row["accepted"] == "n" for row in rows)
    found.update(steps=0, drift=float("nan"), smallest=float("nan"))
    if os.path.exists(os.path.join(out, "history.csv")):
        found["history"] = history(out)
        times = found["history"]["time"]
        lengths = [b - a for a, b in zip([0.0] + times, times) if b > a]
        found["steps"] = len(lengths)
        # the shortest step of the run but for the shortest 2 in a hundred
        if lengths:
            found["smallest"] = sorted(lengths)[len(lengths) // 50] / (sum(lengths) / len(lengths))
    if glob.glob(os.path.join(out, "summary.json")):
        found["drift"] = 100 * drift_of(summary(out))
    return found


def spent():
    """Seconds of processor of all programs that this one called and that have ended."""
    told = os.times()
    return told.children_user + told.children_system


def drift_of(told):
    """Change of the volume without elastic strain, a share."""
    match = re.search(r'"volume_drift_unloaded": ([-+.eE0-9]+)', json.dumps(told))
    return float(match.group(1)) if match else float("nan")


def checked(name):
    """What --check says of a scene."""
    return run(["--check", deck_of(name)]).stdout


def finer_deck(name, folder):
    """The scene with elements of half the size, where dies bend, at their corners and elsewhere, and the limits that REMSH alone has, as --check prints sizes and numbers."""
    text = checked(name)
    sizes = re.search(r"elements of ([-+.eE0-9]+) to ([-+.eE0-9]+), at most (\d+)(?:, from ([-+.eE0-9]+) where dies bend)?"
                      r"(?:, from ([-+.eE0-9]+) at sharp corners of dies)?", text)
    rows = (f"REMSH\n   ANGLE 15. 165.\n   MIDDLE 0.4\n   SCALED 0.2\n   ASPECT 10.\n   CONTACT 50.\n   NARROW\n   CORNER\n   DISTRESS 4\n   LEAST 5\n   ERROR 0.05 0.4\n"
            f"   SIZE {min(float(size) for size in (sizes[1], sizes[4], sizes[5]) if size) / 2} {float(sizes[2]) / 2}\n   COUNT {4 * int(sizes[3])}\n")
    with open(deck_of(name), encoding="utf-8") as file:
        return write(os.path.join(folder, name + ".lag"), re.sub(r"^REMSH.*\n", rows, file.read(), flags=re.MULTILINE))


def readme_of(name):
    return os.path.join(ROOT, "decks", name, "README.md")


def said_in_readme(name):
    """What the README of a scene says of it: code, meshes, tries refused, steps."""
    with open(readme_of(name), encoding="utf-8") as file:
        row = file.read().split(MARK)[1].strip().splitlines()[-1]
    return dict(zip(("code", "meshes", "refused", "steps"), map(int, row.split("|")[2:6])))


def line(found, words=""):
    return (f"| {found['name']} | {found['code']} | {found['meshes']} | {found['refused']} | {found['steps']} | {found['smallest']:.3g} | "
            f"{found['drift']:+.4f} | {found['processor']:.0f} | {words or (found['said'].splitlines() or [''])[0][:160] * (found['code'] != DONE)} |")


def badly_shaped(found):
    """Accepted meshes of a run with a small angle or scaled Jacobian where the contour has no sharp corner: (mesh, angle, Jacobian)."""
    bad = []
    for row in tries(found["out"]):
        if row["accepted"] != "y" or row["action"] == "old mesh":
            continue
        mesh = facts(found["out"], int(row["generation [-]"]), "start")["mesh"]
        if mesh["sharpest_corner"] > LEAST_ANGLE and not (mesh["least_angle"] >= LEAST_ANGLE and mesh["scaled_jacobian"] >= LEAST_JACOBIAN):
            bad.append((row["generation [-]"], mesh["least_angle"], mesh["scaled_jacobian"]))
    return bad


def totals(outs):
    """Tries at new meshes and those refused of all runs; the least angle and scaled Jacobian of accepted meshes without a sharp contour corner."""
    tried = refused = 0
    angle, jacobian = 90.0, 1.0
    for out in outs:
        for row in tries(out):
            if row["action"] == "old mesh":
                continue
            tried += 1
            if row["accepted"] == "n":
                refused += 1
                continue
            mesh = facts(out, int(row["generation [-]"]), "start")["mesh"]
            if mesh["sharpest_corner"] > LEAST_ANGLE:
                angle, jacobian = min(angle, mesh["least_angle"]), min(jacobian, mesh["scaled_jacobian"])
    return tried, refused, angle, jacobian


def force_table(outs):
    """Changes of the largest die force at the first full steps on new meshes, and at ordinary steps, over all runs."""
    at_remeshes, ordinary = [], []
    for out in outs:
        if os.path.exists(os.path.join(out, "history.csv")):
            at_remeshes += changes_at_remeshes(out).values()
            ordinary += changes_at_ordinary_steps(out)
    rows = (("first full steps on new meshes", at_remeshes), ("ordinary steps", ordinary))
    return FORCE_HEAD + ["| " + " | ".join([words] + described(values)) + " |" for words, values in rows]
