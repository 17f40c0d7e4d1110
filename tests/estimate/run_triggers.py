#!/usr/bin/env python3
"""Cards ESTIM and REMSH in whole runs: what they cost where nobody asks, at which step each limit stops a run, and that it can go on.

usage: run_triggers.py [-v] [-k]

The step at which a run must stop is found from the fields of a run without the card, by formulas written here: shapes of elements from
their nodes, depths of sides from the curve of the die (tests/runs/die_depth.py).
"""
import os
import shutil
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "runs"))
from support import (DONE, UPSETTING, Checks, add_cards, deck_text, h5_differences, history, mesh, read_bytes, run, said,  # noqa: E402
                     summary, with_h5py, write)

with_h5py()
import h5py  # noqa: E402
import numpy as np  # noqa: E402

from die_depth import depths, shape  # noqa: E402
from run_contact_cases import HEAD, PRESSED, S_DIE, WEDGE  # noqa: E402

REMESH = 4
SMALL = mesh(6, 9)


def go(checks, name, text, options=(), code=DONE, more=()):
    """Run a deck of this name; its folder."""
    deck = write(checks.path(name, "case.lag"), text)
    result = run([deck, "--out", checks.path(name), "--threads", "1", "--quiet"] + list(options) + list(more))
    checks.that(result.returncode == code, f"{name}: exit code {code}", said(result))
    return checks.path(name)


def resume(checks, folder, options=(), code=DONE):
    deck = os.path.join(folder, "case.lag")
    return go_on(checks, deck, folder, options, code)


def go_on(checks, deck, folder, options, code):
    result = run([deck, "--out", folder, "--threads", "1", "--quiet", "--resume", os.path.join(folder, "case.ckp.h5")] + list(options))
    checks.that(result.returncode in ((code,) if isinstance(code, int) else code), f"{os.path.basename(folder)}: resumed", said(result))
    return result.returncode


def words(dataset):
    return [word.decode() if isinstance(word, bytes) else word for word in dataset[()]]


def triggers(checks, folder):
    """Triggers of a stopped run, name -> (value, limit), reported alike in listing, summary and checkpoint."""
    name = os.path.basename(folder)
    reported = summary(folder)
    found = {row["name"]: (row["value"], row["limit"]) for row in reported["remesh"]}
    checks.that(reported["exit_code"] == REMESH and reported["stop_reason"].startswith("a new mesh is due"), f"{name}: summary", reported["stop_reason"])
    with open(os.path.join(folder, "case.log"), encoding="utf-8") as listing:
        lines = [line.split()[1] for line in listing if line.startswith("remesh: ")]
    checks.that(lines[-len(found):] == list(found), f"{name}: a line each in the listing", lines)
    with h5py.File(os.path.join(folder, "case.ckp.h5"), "r") as file:
        estimate = file["estimate"]
        rows = [trigger.attrs for trigger in estimate.get("triggers", {}).values()]
        stored = {row["name"].decode(): (row["value"], row["limit"]) for row in rows}
        checks.that(len(rows) == estimate["triggers"].attrs["count"], f"{name}: the number of triggers", len(rows))
        checks.that(estimate.attrs["last_stop"] == reported["steps"] == file["progress"].attrs["step"], f"{name}: the step of the checkpoint")
        solids = sum(len(group["connectivity"]) for group in file["groups"].values() if group.attrs["role"] == 1)
        checks.that(len(estimate["stress_of"]) == len(estimate["strain_of"]) == len(estimate["strain_sums"]) == solids,
                    f"{name}: errors of elements in the checkpoint")
    checks.that(stored == found, f"{name}: the checkpoint states the same", (stored, found))
    return found


def costs_nothing(checks):
    """Without the cards: no column, no call, no dataset. With ESTIM: the same motion to the last bit."""
    text = deck_text(UPSETTING)
    plain, with_card = go(checks, "plain", text, SMALL), go(checks, "estim", add_cards(text, "ESTIM"), SMALL)
    one, two = history(plain), history(with_card)
    checks.that(set(two) - set(one) == {"error_stress", "error_strain"}, "ESTIM adds two columns", set(two) - set(one))
    checks.that(all(one[name] == two[name] for name in one), "ESTIM changes no other column")
    with h5py.File(os.path.join(plain, "case.ckp.h5"), "r") as first, h5py.File(os.path.join(with_card, "case.ckp.h5"), "r") as second:
        names = [], []
        first.visit(names[0].append)
        second.visit(names[1].append)
        more = sorted(set(names[1]) - set(names[0]))
        other = [n for n in names[0] if isinstance(first[n], h5py.Dataset) and first[n].shape != second[n].shape]
        checks.that(not more and sorted(other) == ["estimate/strain_of", "estimate/strain_sums", "estimate/stress_of"],
                    "ESTIM fills its own datasets and no others", (more, other))
    same = h5_differences(os.path.join(plain, "case.g01.h5"), os.path.join(with_card, "case.g01.h5"))
    checks.that(all("element" in name for name in same), "ESTIM changes no field", same[:4])
    reported = summary(plain)
    for effect in ("error estimates", "remeshing"):
        checks.that(reported["effects"][effect]["calls"] == 0 and not reported["effects"][effect]["on"], f"{effect}: never called", reported["effects"][effect])
    checks.that("error" not in reported and "remesh" not in reported, "no estimate in the summary without the card")
    reported = summary(with_card)
    checks.that(reported["effects"]["error estimates"]["calls"] == reported["steps"] and not reported["effects"]["remeshing"]["on"], "ESTIM: once a step")
    checks.that(reported["error"] == {"stress_pct": 100*two["error_stress"][-1], "strain_pct": 100*two["error_strain"][-1]}, "errors in the summary", reported["error"])
    return two


def stress_error(checks, whole):
    """The step whose error is the first above the limit; going on, the same motion as without a stop; the next stop LEAST steps later."""
    text = deck_text(UPSETTING)
    errors = np.array(whole["error_stress"])
    limit = 0.5*(np.sort(errors)[len(errors)//2] + np.sort(errors)[len(errors)//2 + 1])
    step = int(np.argmax(errors > limit)) + 1
    folder = go(checks, "error", add_cards(text, f"REMSH\n   ERROR {limit!r}\n   LEAST 7"), SMALL, REMESH)
    found = triggers(checks, folder)
    reported = summary(folder)
    # the first seven steps are those of a new mesh
    wanted = next(k for k in range(7, len(errors) + 1) if errors[k - 1] > limit)
    checks.that(reported["steps"] == wanted >= step, "ERROR: stops at the step that passes the limit", (reported["steps"], wanted))
    checks.that(found == {"stress_error": (errors[wanted - 1], limit)}, "ERROR: value and limit", found)
    stops, code = [reported["steps"]], REMESH
    while code == REMESH and len(stops) < 100:
        code = resume(checks, folder, SMALL, (DONE, REMESH))
        stops.append(summary(folder)["steps"])
    checks.that(code == DONE, "ERROR: goes on to the end", code)
    expected, last = [], 0
    # what is left after a step takes more than two of its length: those are made on the mesh that is there
    for k in range(1, len(errors) - 3):
        if k - last >= 7 and errors[k - 1] > limit:
            expected.append(k)
            last = k
    checks.that(stops[:-1] == expected and len(expected) >= 2, "ERROR: stops again after LEAST steps, no sooner", (stops, expected))
    checks.that(read_bytes(os.path.join(folder, "history.csv")) == read_bytes(os.path.join(checks.path("estim"), "history.csv")),
                "ERROR: stopped and resumed, the same history as in one go")


def shapes(nodes, elements):
    """Least angle, largest aspect, least scaled Jacobian at corners, farthest middle node of straight formulas."""
    x = nodes[elements]
    corner, after, before = x[:, :4], x[:, 4:], x[:, [7, 4, 5, 6]]
    a = 4*after - 3*corner - x[:, [1, 2, 3, 0]]        # tangents of the parabolas at their first and last ends
    b = 4*before - 3*corner - x[:, [3, 0, 1, 2]]
    sine = a[..., 0]*b[..., 1] - a[..., 1]*b[..., 0]
    angle = np.degrees(np.arctan2(sine, (a*b).sum(-1))) % 360
    medians = np.stack([np.hypot(*(x[:, 6] - x[:, 4]).T), np.hypot(*(x[:, 5] - x[:, 7]).T)])
    chord = x[:, [1, 2, 3, 0]] - corner
    place = ((x[:, 4:] - corner)*chord).sum(-1)/(chord**2).sum(-1)
    return angle.min(1), angle.max(1), (medians.max(0)/medians.min(0)), abs(2*place - 1).max(1)


def bad_shapes(checks):
    """ANGLE, ASPECT, MIDDLE and BAD against the nodes of every step."""
    text = deck_text(UPSETTING).replace("SAVE   20", "SAVE   1")
    with h5py.File(os.path.join(go(checks, "every-step", text, SMALL), "case.g01.h5"), "r") as file:
        steps = sorted(file["steps"])
        values = np.array([shapes(file["steps"][s]["coordinates"][()][:, :2], file["mesh/topology"][()]) for s in steps])[1:]
    cases = {"ANGLE 35. 175.": (("least_angle", lambda v: v[:, 0].min(1), 35.0, -1),),
             "ANGLE 0. 140.": (("largest_angle", lambda v: v[:, 1].max(1), 140.0, 1),),
             "ASPECT 2.5": (("aspect_ratio", lambda v: v[:, 2].max(1), 2.5, 1),),
             "MIDDLE 0.1": (("middle_share", lambda v: v[:, 3].max(1), 0.1, 1),)}
    for number, (row, wanted) in enumerate(cases.items()):
        folder = go(checks, f"shape-{number}", add_cards(text, f"REMSH\n   {row}"), SMALL, REMESH)
        found, steps = triggers(checks, folder), summary(folder)["steps"]
        for name, value, limit, sign in wanted:
            worst = value(values)
            step = int(np.argmax(sign*(worst - limit) > 0)) + 1
            checks.that(steps == step > 1, f"{row}: stops at the step that passes the limit", (steps, step))
            checks.that(list(found) == [name] and abs(found[name][0] - worst[step - 1]) < 1e-9*abs(limit) and found[name][1] == limit,
                        f"{row}: value and limit", (found, worst[step - 1]))
    share = (values[:, 2] > 2.0).mean(1)
    step = int(np.argmax(share > 0.1)) + 1
    folder = go(checks, "bad", add_cards(text, "REMSH\n   ASPECT 2.\n   BAD 0.1"), SMALL, REMESH)
    found = triggers(checks, folder)
    checks.that(summary(folder)["steps"] == step > int(np.argmax(share > 0)) + 1, "BAD: waits for its share of bad elements", step)
    checks.that(list(found) == ["aspect_ratio", "bad_share"] and abs(found["bad_share"][0] - share[step - 1]) < 1e-12, "BAD: the share", found)


def misfits(checks, name, text, limit, wanted):
    """CONTACT: largest depth of a side beyond that of its points, and of a die's corner in it, over the allowed penetration. A control
    point is no point of the side."""
    folder = go(checks, name, text)
    between, corner = [], []
    with h5py.File(os.path.join(folder, "case.g01.h5"), "r") as file:
        first = file["mesh/coordinates"][()]
        pieces = file["dies/tool"][()]
        g = next(g for g, group in file["mesh/groups"].items() if group["connectivity"].shape[1] == 3)
        for step in sorted(file["steps"])[1:]:
            place = file["steps"][step]
            names = words(place[f"points/{g}/components"])
            state = place[f"points/{g}/state"][()]
            deep, poke = [0.0], [0.0]
            for nodes, points in zip(file["mesh/groups"][g]["connectivity"][()], state):
                x = place["coordinates"][()][nodes][:, :2] - place["pilots"][0][:2]
                side = np.hypot(*(first[nodes[2]] - first[nodes[0]])[:2])
                if "BEZIER" in text:
                    points = points[::2]
                known = {part: max([0.0] + [p[names.index(part + "penetration")] for p in points if round(p[names.index(part + status)]) > 0])
                         for part, status in (("", "contact_status"), ("corner_", "contact_status"))}
                found = depths(pieces, shape(np.linspace(-1, 1, 65)).T @ x)
                deep.append((np.nanmax([*found, -1.0]) - max(known.values()))/(1e-3*side))
                poke.append(known["corner_"]/(1e-3*side))
            between.append(max(deep))
            corner.append(max(poke))
    found_at = {"contact_between": np.array(between), "contact_corner": np.array(corner)}
    step = min(int(np.argmax(v > limit)) + 1 for v in found_at.values() if (v > limit).any())
    stopped = go(checks, name + "-stop", add_cards(text, f"REMSH\n   CONTACT {limit}"), code=REMESH)
    found = triggers(checks, stopped)
    checks.that(summary(stopped)["steps"] == step > 1, f"{name}: stops at the step that passes the limit", (summary(stopped)["steps"], step))
    checks.that(wanted in found, f"{name}: {wanted}", found)
    for key, (value, _) in found.items():
        checks.that(abs(value - found_at[key][step - 1]) < 1e-6*value, f"{name}: value of {key}", (value, found_at[key][step - 1]))


def times_and_strokes(checks):
    """TIMES are hit; a stroke stops at the step that reaches it; neither waits for LEAST, and none fires twice."""
    text = deck_text(UPSETTING)
    folder = go(checks, "times", add_cards(text, "REMSH\n   TIMES 0.013 0.5003\n   LEAST 1000"), SMALL, REMESH)
    for time in (0.013, 0.5003):
        checks.that(triggers(checks, folder) == {"time": (history(folder)["time"][-1], time)} and abs(history(folder)["time"][-1] - time) < 1e-12,
                    f"TIMES: stops at {time}", history(folder)["time"][-1])
        code = resume(checks, folder, SMALL, (DONE, REMESH))
    checks.that(code == DONE, "TIMES: then to the end")
    folder = go(checks, "strokes", add_cards(text, "REMSH\n   STROKE upper Y -1. -2.5\n   STROKE upper Y -2.\n   LEAST 1000"), SMALL, REMESH)
    for stroke in (-1.0, -2.0, -2.5):
        way = history(folder)["displacement_y_upper"]
        checks.that(triggers(checks, folder) == {"stroke": (way[-1], stroke)} and way[-1] <= stroke < way[-2], f"STROKE: stops at {stroke}", way[-2:])
        code = resume(checks, folder, SMALL, (DONE, REMESH))
    checks.that(code == DONE, "STROKE: then to the end")


def distress(checks):
    """A motion that is suddenly 1000 times faster: cut after cut. The state before it is what a new mesh is made from."""
    text = deck_text(UPSETTING).replace("   0. 0.     1. -$travel", "   0. 0.   0.5 -0.01   0.501 -$travel")
    text = add_cards(text, "NORMS STRAIN 0.05").replace("1.E-5  0.05", "1.E-7  0.05")
    folder = go(checks, "distress", add_cards(text, "REMSH\n   DISTRESS 3"), SMALL, REMESH)
    found, reported = triggers(checks, folder), summary(folder)
    checks.that(found == {"distress": (3.0, 3.0)} and reported["cutbacks"] == 3, "DISTRESS: three cutbacks in a row", (found, reported["cutbacks"]))
    checks.that(abs(reported["time"] - 0.5) < 1e-12, "DISTRESS: the state before", reported["time"])
    code, stops = resume(checks, folder, SMALL, (DONE, REMESH)), 1
    checks.that(code == DONE or summary(folder)["steps"] > reported["steps"], "DISTRESS: does not fire again before a step is made", code)
    while code == REMESH and stops < 20:
        code, stops = resume(checks, folder, SMALL, (DONE, REMESH)), stops + 1
    checks.that(code == DONE, "DISTRESS: goes on to the end", code)
    # at the least step a run without the row gives up; with it, it asks for a mesh, whatever the number of cutbacks
    text = text.replace("1.E-7  0.05", "0.009  0.05")
    go(checks, "given-up", text, SMALL, 3)
    folder = go(checks, "last-step", add_cards(text, "REMSH\n   DISTRESS 50"), SMALL, REMESH)
    checks.that(triggers(checks, folder)["distress"][1] == 50.0, "DISTRESS: a step that can be cut back no more")
    checks.that("at the least step (limit 50)" in summary(folder)["stop_reason"], "DISTRESS: says so", summary(folder)["stop_reason"])
    resume(checks, folder, SMALL, 3)
    # so it does by other limits alone
    folder = go(checks, "other-limits", add_cards(text, "REMSH\n   STROKE upper Y -5."), SMALL, REMESH)
    reason = summary(folder)["stop_reason"]
    checks.that("at the least step" in reason and "limit" not in reason, "a step that can be cut back no more, without DISTRESS", reason)
    resume(checks, folder, SMALL, 3)


def older_checkpoint(checks):
    """From the checkpoint before the last one: errors and sums go on as if there had been no stop."""
    text = add_cards(deck_text(UPSETTING).replace("SAVE   20", "SAVE   7"), "ESTIM")
    folder = go(checks, "whole", text, SMALL)
    again = checks.path("again")
    shutil.copytree(folder, again)
    result = run([os.path.join(again, "case.lag"), "--out", again, "--threads", "1", "--quiet", "--resume", os.path.join(again, "case.ckp.1.h5")] + SMALL)
    checks.that(result.returncode == DONE, "older checkpoint: resumed", said(result))
    checks.that(read_bytes(os.path.join(folder, "history.csv")) == read_bytes(os.path.join(again, "history.csv")), "older checkpoint: the same history")
    for name in ("case.g01.h5", "case.ckp.h5"):
        wrong = h5_differences(os.path.join(folder, name), os.path.join(again, name), leave_out=("deck/path",))
        checks.that(not wrong, f"older checkpoint: the same {name}", wrong[:4])
    # another number of threads, the same bits
    more = go(checks, "threads", text, SMALL, more=["--threads", "2"])
    checks.that(read_bytes(os.path.join(folder, "history.csv")) == read_bytes(os.path.join(more, "history.csv")), "two threads: the same history")


def main():
    checks = Checks()
    whole = costs_nothing(checks)
    stress_error(checks, whole)
    bad_shapes(checks)
    misfits(checks, "s-die", HEAD.format(title="s", phi=0.1, points=2) + S_DIE + PRESSED.format(width=12, travel=1.0), 20.0, "contact_between")
    misfits(checks, "s-bezier", HEAD.format(title="s", phi=0.1, points="BEZIER") + S_DIE + PRESSED.format(width=12, travel=1.0), 22.0, "contact_between")
    misfits(checks, "wedge", HEAD.format(title="w", phi=0.1, points=-3) + WEDGE + PRESSED.format(width=8, travel=0.6), 0.9, "contact_corner")
    times_and_strokes(checks)
    distress(checks)
    older_checkpoint(checks)
    checks.end()


if __name__ == "__main__":
    main()
