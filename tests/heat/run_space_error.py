#!/usr/bin/env python3
"""Estimated errors of temperatures in space beside true ones, in a table: quenches of plates and a square, freezing, bodies that touch, a tube,
a body that is laid beside another and taken away. In a second table errors of phases and of hardness that come of them, of quenched steels.

usage: run_space_error.py [-v] [-k]

True errors are differences to a mesh so many times finer in each direction, at the nodes of the coarse one and at all instants saved, of the
tube those to the exact T = A + B ln r. `largest` over time and space, `end` over space, `mean` the largest in time of the mean square. Phases and
hardness are those of the points at the end, the phase is the one that errs most in the mean square of the volume.
Estimates are those of `heat_space` in summary.json. Both runs have short steps, so that errors in time are small beside them.
"""
import json
import os
import sys

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [HERE, os.path.join(os.path.dirname(HERE), "patch")]
from patch_support import SOURCE, Checks, Run, np  # noqa: E402

TIMES = "THETA TRBDF2 TOL {tol}\nSTRAT {first} 1.E-9 {longest} 20 9 0.25 1.5\nSTOP {stop}\nSAVE {save}\nEND\n"
PLATE = """TITLE a plate is quenched
STATE PLSTN
KINEM SMALL
BLOCK plate PL8TM 4 metal {option}
  0. 0. 1. 0. 1. 0.2 0. 0.2
  {n} 1. 1 1.
LAW metal HEAT
  1. 1.
START T 1000.
CONVE plate 2 H {h} TS 0.
"""
SQUARE = """TITLE the corner of a bar is quenched, as water boils
STATE {state}
KINEM SMALL
BLOCK plate PL8TM 4 metal BILINEAR
  0. 0. 1. 0. 1. 1. 0. 1.
  {n} 1. {n} 1.
LAW metal HEAT
  1. 1.
START T 850.
CONVE plate 2 3 H 20. TS 20.
  0. 1. 200. 1. 450. 0.5 550. 0.3 900. 0.2
RADIA plate 1 EPS 1. SIGMA 1.E-9 ZERO 273.15 TS 20.
"""
STEFAN = """TITLE a melt freezes
STATE PLSTN
KINEM SMALL
BLOCK half PL8TM 4 alu BILINEAR
  0. 0. 0.1 0. 0.1 0.005 0. 0.005
  {n} 1. 1 1.
LAW alu HEATH
  TEMP 0.
  210. 0.
  TEMP 659.9
  210. 659.9*3.E6
  TEMP 660.1
  95. 659.9*3.E6+1.08E9
  TEMP 800.
  95. 659.9*3.E6+1.08E9+139.9*2.5759E6
START T 740.
IMPOS half 4 T on 580.
LIC on
  0. 1.
"""
TOUCH = """TITLE hot steel on copper
STATE PLSTN
KINEM SMALL
BLOCK steel PL8TM 4 hot BILINEAR
  0. 0. 2. 0. 2. 20. 0. 20.
  1 1. {n} 1.
BLOCK copper PL8TM 4 cold BILINEAR
  0. -60. 2. -60. 2. 0. 0. 0.
  1 1. {n} 1.
LAW hot HEAT
  28. 4.9
LAW cold HEAT
  390. 3.4
START T 1100. steel
START T 20. copper
DIE face SIDES copper 3
COU2DC steel 1 face H {h}
"""
TUBE = """TITLE a tube, steady in the end
STATE AXISYM
KINEM SMALL
BLOCK tube PL8TM 4 metal BILINEAR
  1. 0. 5. 0. 5. 1. 1. 1.
  {n} 1. 1 1.
LAW metal HEAT
  1. 1.
START T 0.
IMPOS tube 4 T on 100.
IMPOS tube 2 T on 0.
LIC on
  0. 1.
"""
LAID = """TITLE hot metal is laid beside cold metal, cools with it and is taken away
STATE PLSTN
KINEM SMALL
BLOCK cold PL8TM 4 metal BILINEAR
  0. 0. 1. 0. 1. 0.1 0. 0.1
  {n} 1. 1 1.
BLOCK hot PL8TM 4 metal BILINEAR
  1. 0. 2. 0. 2. 0.1 1. 0.1
  {n} 1. 1 1.
JOIN cold 2 hot 4
LAW metal HEAT
  1. 1.
START T 100. cold
START T 1100. hot
THETA TRBDF2 TOL 0.2
STRAT 1.E-5 1.E-9 0.1 20 9 0.25 1.5
SAVE 2
"""
SPOT = """TITLE a hot spot that nothing cools
STATE PLSTN
KINEM SMALL
BLOCK bar PL8TM 4 metal BILINEAR
   0. 0. 20. 0. 20. 2. 0. 2.
   {n} 1. 1 1.
LAW metal HEAT
   TEMP 20.
   40. 3.6
   TEMP 1500.
   30. {capacity}
START T 20+1400*exp(-x*x/9)
"""
STEEL = """TITLE a plate or a bar of steel is quenched
STATE {state}
KINEM SMALL
BLOCK plate PL8TM 4 steel BILINEAR
  0. 0. {half} 0. {half} 1. 0. 1.
  {n} 1. 1 1.
LAW steel META
  STEEL {folder}/jominy.met {grade}
  ENERGY 1.
START T 850.
CONVE plate 2 H {h} TS 20.
NORMS FORCE 1.E-9 DISPL 1.E-8
"""
OPERATIONS = (("before", "cold", 0.05), ("laid", "all", 0.1), ("later", "all", 0.1), ("parted", "cold", 0.1))
QUICK = {"tol": 0.2, "first": 1e-5, "longest": 0.1, "stop": 0.5, "save": 2}
CASES = [(f"plate, Biot {h}, {n} elements", PLATE, {"n": n, "h": h, "option": "BILINEAR"}, 8, QUICK) for h in (1, 10, 100, 1000) for n in (4, 8)]
CASES += [(f"hot spot, its capacity {what}, 6 elements", SPOT, {"n": 6, "capacity": capacity}, 8, {"tol": 0.5, "first": 1e-2, "longest": 2., "stop": 40., "save": 2})
          for what, capacity in (("constant", 3.6), ("by temperature", 6.))]
CASES += [("corner in boiling water, 4 x 4", SQUARE, {"n": 4, "state": "PLSTN"}, 4, {**QUICK, "tol": 1., "stop": 0.3, "save": 3}),
          ("the same of a cylinder", SQUARE, {"n": 4, "state": "AXISYM"}, 4, {**QUICK, "tol": 1., "stop": 0.3, "save": 3}),
          ("freezing, 10 elements", STEFAN, {"n": 10}, 8, {"tol": 1., "first": 0.01, "longest": 0.05, "stop": 6, "save": 3}),
          ("steel on copper, 10 elements", TOUCH, {"n": 10, "h": 20.}, 8, {"tol": 1., "first": 1e-4, "longest": 0.05, "stop": 1, "save": 2}),
          ("the same, without resistance", TOUCH, {"n": 10, "h": "1.E6"}, 8, {"tol": 1., "first": 1e-4, "longest": 0.05, "stop": 1, "save": 2})]
# Steel, half of the thickness or radius mm, exchange kW/m2/K, plate or bar, elements.
STEELS = [("aisi4140", 40., 5., state, n) for state in ("PLSTN", "AXISYM") for n in (4, 8)]
STEELS += [("aisi5140", 20., 20., "AXISYM", 4), ("aisi8620", 20., 2., "AXISYM", 4), ("aisi1045", 10., 5., "AXISYM", 4)]
# At the nose of the diagram the heat of transformation decides what forms: estimates are too small.
STEELS += [("aisi1045", 10., 5., "PLSTN", n) for n in (4, 8)]


def run_of(checks, name, text, numbers, times):
    """The run, and its estimates."""
    run = Run(checks, name, text.format(**numbers) + TIMES.format(**times))
    with open(os.path.join(run.out, "summary.json"), encoding="utf-8") as file:
        return run, json.load(file)


def instants(run):
    """Places of the nodes, times, temperatures (time, node)."""
    with run.open() as file:
        steps = sorted(file["steps"])
        return (file["mesh/coordinates"][()][:, :2], np.array([file[f"steps/{k}"].attrs["time"] for k in steps]),
                np.array([file[f"steps/{k}/node/temperature"][()].reshape(-1) for k in steps]))


def true_errors(coarse, fine):
    """Largest of all, at the end, and in the mean square, of a coarse run against a fine one whose nodes hold its own."""
    x, times, found = instants(coarse)
    y, at, values = instants(fine)
    # bodies that touch have nodes at the same places, in the same order
    shared = [(x[:, None, :], y[None, :, :])]
    near = np.abs(shared[0][0] - shared[0][1]).max(axis=2) < 1e-9*np.abs(x).max()
    rank = [near[:k, :].any(axis=0) & near[k] for k in range(len(x))]
    place = [int(np.flatnonzero(near[k])[-1 if rank[k].any() else 0]) for k in range(len(x))]
    truth = np.array([np.interp(times, at, values[:, k]) for k in place]).T
    errors = (truth - found)[1:]
    return np.abs(errors).max(), np.abs(errors[-1]).max(), np.sqrt((errors**2).mean(axis=1)).max()


def compare(checks, what, told, true, least, most):
    """A row of the table, and its checks."""
    print(f"| {what} | " + " | ".join(f"{t:.3g} | {e:.3g} | {e/t:.2f}" for t, e in zip(true, told)) + " |")
    for name, t, e in zip(("largest", "end", "mean"), true, told):
        checks.that(least*t <= e <= most*t, f"{what}: {name}", f"true {t:.3g}, estimated {e:.3g}")


def laid(checks):
    """Bodies come and go: errors go on with what stays, what comes has none but for what the joint draws out over an element, what is not there has none."""
    text = LAID + "".join(f"OPERA {name}\n" + ("ASLEEP hot\n" if there == "cold" else "") + f"CONVE cold 4 H 10. TS 0.\nSTOP {stop}\n"
                          for name, there, stop in OPERATIONS) + "END\n"
    runs = [Run(checks, f"laid{n}", text.format(n=n)) for n in (4, 32)]
    if not all(run.ok for run in runs):
        return
    last = None
    for k, (name, there, _) in enumerate(OPERATIONS, 1):
        with runs[0].open(k) as coarse, runs[1].open(k) as fine:
            x, y = (file["mesh/coordinates"][()][:, :2] for file in (coarse, fine))
            first, end = (coarse[f"steps/{sorted(coarse['steps'])[i]}/node"] for i in (0, -1))
            truth = fine[f"steps/{sorted(fine['steps'])[-1]}/node/temperature"][()].ravel()
            is_there = x[:, 0] < (1 + 1e-9 if there == "cold" else 3)
            place = [int(np.flatnonzero(np.abs(y - at).max(axis=1) < 1e-9)[0]) for at in x]
            true = np.abs(truth[place] - end["temperature"][()].ravel())[is_there].max()
            told = end["error_temperature"][()].ravel()
            began = first["error_temperature"][()].ravel() if k > 1 else 0*told
        print(f"| end of `{name}`: | | | | {true:.3g} | {np.abs(told).max():.3g} | {np.abs(told).max()/true:.2f} | | | |")
        checks.that(true/3 <= np.abs(told).max() <= 3*true, f"{name}: end", f"true {true:.3g}, estimated {np.abs(told).max():.3g}")
        checks.that(not np.any(told[~is_there]), f"{name}: what is not there has no error", told[~is_there])
        if k > 1:
            # at the middles of the sides that end on the joint: 4/3 of half of what its temperature is from that of the body
            beside = (name == "laid") & (np.abs(np.abs(x[:, 0] - 1) - 0.125) < 1e-9)
            apart = np.sign(x[:, 0] - 1)*4/3*0.5*500
            checks.that(np.array_equal(began[~beside], np.where(is_there, last, 0)[~beside]), f"{name}: it begins with the errors of what stays", began)
            checks.that(np.all(np.abs((began - last*(x[:, 0] < 1) - apart)[beside]) < 5), f"{name}: and with what is drawn out", began[beside])
        last = told


def phases_of(run):
    """Places of the points, and components of their states at the end by name."""
    with run.open() as file:
        points = file[f"steps/{sorted(file['steps'])[-1]}/points/1"]
        names = [name.decode() for name in points["components"][()]]
        return points["coordinates"][()].reshape(-1, 2)[:, 0], dict(zip(names, points["state"][()].reshape(-1, len(names)).T))


def steels(checks):
    """Errors of phases and hardness; they go on from one operation to the next."""
    print("\n| case | phase | largest: true | estimated | mean: true | estimated | ratio | HV, largest: true | estimated | mean: true | estimated | ratio |")
    print("|---|---|---|---|---|---|---|---|---|---|---|---|")
    phases = ("austenite", "ferrite", "pearlite", "bainite", "martensite", "tempered")
    times = {"tol": 0.1, "first": 1e-4, "longest": 10., "stop": 1000., "save": 1000}
    for k, (grade, half, h, state, n) in enumerate(STEELS):
        numbers = {"grade": grade, "half": half, "h": h, "state": state, "folder": os.path.join(SOURCE, "decks", "jominy")}
        coarse, summary = run_of(checks, f"steel{k}", STEEL, {**numbers, "n": n}, times)
        fine, _ = run_of(checks, f"finer{k}", STEEL, {**numbers, "n": 8*n}, times)
        x, found = phases_of(coarse)
        y, truth = phases_of(fine)
        told = summary["accuracy"]["heat_space"]
        order = np.argsort(y)
        weight = x if state == "AXISYM" else np.ones_like(x)
        true = {}
        for name in (*phases, "hardness"):
            error = np.interp(x, y[order], truth[name][order]) - found[name]
            true[name] = np.abs(error).max(), np.sqrt((weight*error**2).sum()/weight.sum())
        phase = max(phases, key=lambda name: true[name][1])
        what = f"{grade}, {'bar' if state == 'AXISYM' else 'plate'} {2*half:g} mm, {h:g} kW/m²/K, {n} elements"
        rows = [(true[phase], (told["fraction"], told["fraction_mean"])), (true["hardness"], (told["hardness"], told["hardness_mean"]))]
        print(f"| {what} | {phase} | " + " | ".join(f"{t[0]:.2g} | {e[0]:.2g} | {t[1]:.2g} | {e[1]:.2g} | {e[1]/t[1]:.2f}" for t, e in rows) + " |")
        for name, (t, e) in zip((phase, "hardness"), rows):
            checks.that(t[1]/3 <= e[1] <= 3*t[1], f"{what}: {name}, mean", f"true {t[1]:.3g}, estimated {e[1]:.3g}")
            checks.that(t[0]/3 <= e[0] <= 3*t[0], f"{what}: {name}, largest", f"true {t[0]:.3g}, estimated {e[0]:.3g}")
        if k:
            continue
        with coarse.open() as file:
            nodal = np.abs(file[f"steps/{sorted(file['steps'])[-1]}/node/error_hardness"][()]).max()
        checks.that(0.5*told["hardness"] < nodal <= told["hardness"], "saved at the nodes", f"{nodal} of {told['hardness']}")
        text = STEEL.format(**numbers, n=n) + TIMES.format(**{**times, "longest": 1.})
        parts = [text, text.replace("STOP", "OPERA one\nSTOP 30.\nOPERA two\nSTOP")]
        means = []
        for j, part in enumerate(parts):
            run = Run(checks, f"operations{j}", part)
            with open(os.path.join(run.out, "summary.json"), encoding="utf-8") as file:
                means.append(json.load(file)["accuracy"]["heat_space"]["fraction_mean"])
        checks.that(abs(means[1]/means[0] - 1) < 0.01, "in two operations the same", means)
        # before 700 degC are passed there is no hardness, nor an error of it
        _, hot = run_of(checks, "hot", STEEL, {**numbers, "n": 8}, {**times, "stop": 20.})
        error = hot["accuracy"]["heat_space"].get("hardness", 0.)
        checks.that(error < 50, "a part that is hot in places has no error of hardness there", error)
    heated(checks)


def heated(checks):
    """A plate of martensite that is only heated: temperatures without their error stay within those of the run, so nothing forms by cold."""
    text = STEEL.format(grade="aisi4140", half=10., h=1000., state="PLSTN", n=4, folder=os.path.join(SOURCE, "decks", "jominy"))
    text = text.replace("START T 850.", "START T 20.\nSTART PHASES AUSTENITE 0.2 MARTENSITE 0.8").replace("TS 20.", "TS 700.")
    run = Run(checks, "heated", text + TIMES.format(tol=0.5, first=1e-4, longest=1., stop=0.5, save=1000))
    with open(os.path.join(run.out, "summary.json"), encoding="utf-8") as file:
        told = json.load(file)["accuracy"]["heat_space"]
    checks.that(told["largest"] > 50 and told.get("fraction", 0.) < 1e-3, "a plate that is heated: phases do not err", told)


def main():
    """All cases; what is not estimated; what is warned of."""
    checks = Checks()
    print("| case | largest: true | estimated | ratio | end: true | estimated | ratio | mean: true | estimated | ratio |")
    print("|---|---|---|---|---|---|---|---|---|---|")
    for k, (what, text, numbers, times_finer, times) in enumerate(CASES):
        coarse, summary = run_of(checks, f"coarse{k}", text, numbers, times)
        fine, _ = run_of(checks, f"fine{k}", text, {**numbers, "n": times_finer*numbers["n"]}, times)
        told = summary["accuracy"]["heat_space"]
        compare(checks, what, [told[name] for name in ("largest", "end", "mean_largest")], true_errors(coarse, fine), 1/3, 3)
    times = {"tol": 0.1, "first": 1e-4, "longest": 50., "stop": 500., "save": 100}
    run, summary = run_of(checks, "tube", TUBE, {"n": 6}, times)
    x, _, found = instants(run)
    true = np.abs(found[-1] - 100*(1 - np.log(x[:, 0])/np.log(5.))).max()
    compare(checks, "tube, steady, 6 elements", [summary["accuracy"]["heat_space"]["end"]]*3, [true]*3, 0.5, 2)
    said = [" ".join(w["text"] for w in run_of(checks, f"plate{n}", PLATE, {"n": n, "h": 10, "option": "BILINEAR"}, QUICK)[1]["warnings"])
            for n in (2, 32)]
    checks.that("the mesh is coarse for its temperatures" in said[0], "a coarse mesh is warned of", said[0])
    checks.that(not said[1], "a fine one is not", said[1])
    _, summary = run_of(checks, "eight", PLATE, {"n": 4, "h": 10, "option": ""}, QUICK)
    checks.that("heat_space" not in summary["accuracy"], "temperatures of 8 nodes have no estimate", summary["accuracy"])
    with open(os.path.join(checks.folder, "eight", "eight.log"), encoding="utf-8") as file:
        checks.that("heat: not estimated (temperatures of 8 nodes)" in file.read(), "and the listing says so", "")
    laid(checks)
    steels(checks)
    checks.end()


if __name__ == "__main__":
    main()
