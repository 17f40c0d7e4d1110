#!/usr/bin/env python3
"""Estimated errors of the stress beside true ones: what the closing table of a run says, against the finest run of the same deck.

usage: effectivity_table.py [--runs DIR] [SCENE...]     some minutes

Space: the stress of a run, within each element the polynomial through its points, against the stress at the points of a run with more
elements, steps and penetration the same. Time: against the same mesh with much shorter steps, at the points, for steps of several lengths. Both in the norm of elastic
energy over that of the stress, at the end; where meshes are made as the part changes (can) at the same places. Runs are those of
`--fineness` (elements along a line, steps, penetration, over the deck's); those in DIR (default: out/effectivity) are not made again. Ends with 1
where an effectivity is beyond its limits: 0.8 to 1.25 from the second mesh on against exact stresses, a factor 2 against finest runs.
"""
import argparse
import json
import os
import subprocess
import sys

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
BIN = os.path.abspath(os.environ.get("LAGAMINE_BIN") or os.path.join(ROOT, "build", "bin"))
sys.path[:0] = [HERE, os.path.join(ROOT, "tests", "patch"), os.path.join(ROOT, "src", "report")]
import numpy as np  # noqa: E402
from lagamine.results import open_run  # noqa: E402
from patch_support import quad8  # noqa: E402
from run_accuracy import lame  # noqa: E402
from run_effectivity import density, lagrange  # noqa: E402

STRESS = ("stress_xx", "stress_yy", "stress_xy", "stress_zz")
NEAREST = 9             # elements among which a place is looked for, by their middles
OUTSIDE = 1.2           # in the element's own coordinates: a place farther out is none of the body
FACTOR, EXACT = (0.5, 2.0), (0.8, 1.25)
SCENES = {
    # deck, body, E, nu, parameters, meshes, finest mesh and its steps, the truth in space; in time steps, of each mesh, and their truth
    "lame": ("thick_cylinder/thick_cylinder", "ring", 1000.0, 0.3, [], (1, 2, 4), None, ()),
    "billet to 25 %": ("upsetting/upsetting", "billet", 200000.0, 0.3, ["nx=6", "ny=9", "travel=3.75"], (1, 2), (4, 1),
                       ((1, 1, 1/32), (1, 0.5, 1/32), (1, 0.25, 1/32), (2, 1, 1/32))),
    "billet to 60 %": ("upsetting/upsetting", "billet", 200000.0, 0.3, ["nx=6", "ny=9"], (1, 2), (4, 1), ((1, 1, 1/32), (1, 0.5, 1/32), (1, 0.25, 1/32), (2, 1, 1/32))),
    "necking": ("necking/necking", "bar", 206900.0, 0.29, ["nx=4", "ny=12", "dt=0.02"], (), None, ((1, 1, 1/32), (1, 0.5, 1/32), (1, 0.25, 1/32))),
    "ring": ("ring/ring", "ring", 200000.0, 0.3, [], (), None, ((1, 1, 1/16), (1, 0.5, 1/16), (1, 0.25, 1/16))),
    "forging rib": ("forging_rib/forging_rib", "billet", 70000.0, 0.33, [], (), None, ((1, 1, 0.125),)),
    "quench": ("quench_bar_trip/quench_bar_trip", "bar", 200000.0, 0.3, [], (1, 2), (4, 1), ((1, 1, 0.125),)),
    "can": ("can/can", "billet", 70000.0, 0.33, [], (0.75, 1), (2, 1), ()),
}


def made(scene, runs, mesh, steps):
    """The results of a run, made where they are not there."""
    deck, _, _, _, parameters, _, _, _ = SCENES[scene]
    out = os.path.join(runs, scene.replace(" ", "_").replace("%", "pct"), f"{mesh:g}_{steps:g}")
    path = os.path.join(ROOT, "decks", deck + ".lag")
    with open(path, encoding="utf-8") as file:
        program = "lagacycle" if "\nREMSH" in file.read() else "lagamine"
    if not os.path.isfile(os.path.join(out, "summary.json")):
        subprocess.run([os.path.join(BIN, program), path, "--out", out, "--fineness", f"{mesh},{steps},1", "--threads", "1", "--quiet",
                        *(word for item in parameters for word in ("-p", item))], check=True, stdin=subprocess.DEVNULL)
    with open(os.path.join(out, "summary.json"), encoding="utf-8") as file:
        told = json.load(file)
    assert told["exit_code"] == 0, (out, told["stop_reason"])
    return open_run(out), told["accuracy"]


def state(run, body):
    """Places (element, point, 2) and stresses (element, point, 4) of a body at the end, and volumes of the points."""
    points = run.points(body)
    stress = np.stack([points[name] for name in STRESS], axis=-1)
    x = run.coordinates()[nodes_of(run, body)]
    side = int(round(stress.shape[1]**0.5))
    place, weight = np.polynomial.legendre.leggauss(side)
    volumes = np.empty(stress.shape[:2])
    for k, (eta, xi) in enumerate((a, b) for a in range(side) for b in range(side)):
        _, d = quad8(place[xi], place[eta])
        j = np.einsum("dk,ekc->edc", d, x)
        volumes[:, k] = np.abs(np.linalg.det(j))*weight[xi]*weight[eta]
    return points.x, stress, volumes


def nodes_of(run, body):
    step = run._step(-1)
    return {group.name: group for group in step.generation.groups}[body].connectivity


def within(run, body, places):
    """Stresses of a run at places (n, 2): the polynomial through the points of the element there; and which places it has."""
    _, stress, _ = state(run, body)
    corners = run.coordinates()[nodes_of(run, body)]
    middles = corners[:, :4].mean(axis=1)
    side = int(round(stress.shape[1]**0.5))
    found, best = np.zeros((len(places), 4)), np.full(len(places), np.inf)
    order = np.argsort(((places[:, None] - middles[None])**2).sum(axis=-1), axis=1)[:, :NEAREST]
    for candidate in order.T:
        x = corners[candidate]
        own = np.zeros_like(places)
        for _ in range(12):
            phi, d = shapes(own)
            gap = places - np.einsum("nk,nkc->nc", phi, x)
            j = np.einsum("ndk,nkc->ndc", d, x)
            own = np.clip(own + np.einsum("nc,ncd->nd", gap, np.linalg.inv(j)), -3, 3)
        far = np.abs(own).max(axis=1)
        better = far < best - 1e-9
        along, across = lagrange(side, own[:, 0]), lagrange(side, own[:, 1])
        value = np.einsum("na,nb,nabc->nc", across, along, stress[candidate].reshape(-1, side, side, 4))
        found[better], best[better] = value[better], far[better]
    return found, best < OUTSIDE


def shapes(own):
    """Functions (n, 8) and derivatives (n, 2, 8) at places of each element's own."""
    corner = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
    middle = np.array([(0, -1), (1, 0), (0, 1), (-1, 0)])
    xi, eta = own[:, :1], own[:, 1:]
    a, b = corner.T
    phi, d = np.empty((len(own), 8)), np.empty((len(own), 2, 8))
    phi[:, :4] = (1 + a*xi)*(1 + b*eta)*(a*xi + b*eta - 1)/4
    d[:, 0, :4] = a*(1 + b*eta)*(2*a*xi + b*eta)/4
    d[:, 1, :4] = b*(1 + a*xi)*(2*b*eta + a*xi)/4
    for k, (p, q) in enumerate(middle, 4):
        if p == 0:
            phi[:, k] = (1 - own[:, 0]**2)*(1 + q*own[:, 1])/2
            d[:, 0, k], d[:, 1, k] = -own[:, 0]*(1 + q*own[:, 1]), q*(1 - own[:, 0]**2)/2
        else:
            phi[:, k] = (1 + p*own[:, 0])*(1 - own[:, 1]**2)/2
            d[:, 0, k], d[:, 1, k] = p*(1 - own[:, 1]**2)/2, -own[:, 1]*(1 + p*own[:, 0])
    return phi, d


def norm(stress, volumes, young, nu):
    return float(np.sqrt((volumes*density(stress, young/(2*(1 + nu)), young/(3*(1 - 2*nu)))).sum()))


def rows_of(scene, runs):
    """Kind, run, elements, true error, estimate, limits."""
    _, body, young, nu, _, meshes, fine, lengths = SCENES[scene]
    if fine:
        truth = made(scene, runs, *fine)[0]
        places, stress, volumes = state(truth, body)
        # round the axis
        volumes, places, stress = (volumes*places[..., 0]).ravel(), places.reshape(-1, 2), stress.reshape(-1, 4)
    for k, mesh in enumerate(meshes):
        run, told = made(scene, runs, mesh, 1)
        if not fine:
            # small strains: the exact stress is that of the places before they moved
            places, volumes = refined(run.coordinates()[nodes_of(run, body)])
            stress = lame(refined(run.coordinates(0)[nodes_of(run, body)])[0][:, 0])[1]
            volumes = volumes*places[:, 0]
        own, there = within(run, body, places)
        true = norm((own - stress)[there], volumes[there], young, nu)/norm(stress[there], volumes[there], young, nu)
        yield ("space", f"elements along a line x {mesh:g}", len(nodes_of(run, body)), true, told["space"]["stress_pct"]/100,
               FACTOR if fine else EXACT if k else None)
    for each, steps, short in lengths:
        run, told = made(scene, runs, each, steps)
        true, elements = error_of_steps(scene, run, made(scene, runs, each, short)[0])
        guess = told.get("path", {}).get("stress_pct")
        yield ("time", f"elements along a line x {each:g}, steps x {steps:g}", elements, true, guess/100 if guess is not None else float("nan"), FACTOR)


def error_of_steps(scene, run, better):
    """The difference of the stress to that of a run with shorter steps on the same mesh, over the latter; elements."""
    _, body, young, nu, _, _, _, _ = SCENES[scene]
    _, own, _ = state(run, body)
    x, stress, volumes = state(better, body)
    volumes = volumes*x[..., 0]
    return norm(own - stress, volumes, young, nu)/norm(stress, volumes, young, nu), len(own)


def refined(x):
    """Places and volumes of 5 x 5 points in each element, of nodes at x (element, 8, 2)."""
    place, weight = np.polynomial.legendre.leggauss(5)
    places, volumes = [], []
    for a in range(5):
        for b in range(5):
            phi, d = quad8(place[a], place[b])
            places.append(np.einsum("k,ekc->ec", phi, x))
            volumes.append(np.abs(np.linalg.det(np.einsum("dk,ekc->edc", d, x)))*weight[a]*weight[b])
    return np.concatenate(places), np.concatenate(volumes)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", default=os.path.join(ROOT, "out", "effectivity"))
    parser.add_argument("scenes", nargs="*", metavar="SCENE")
    options = parser.parse_args()
    missed = []
    print("| scene | part | run | elements | true error % | estimated % | effectivity |\n|---|---|---|---|---|---|---|")
    for scene in SCENES:
        if options.scenes and scene not in options.scenes:
            continue
        for part, what, elements, true, guess, limits in rows_of(scene, options.runs):
            print(f"| {scene} | {part} | {what} | {elements} | {100*true:.3g} | {100*guess:.3g} | {guess/true:.2f} |", flush=True)
            if limits and not limits[0] <= guess/true <= limits[1]:
                missed.append(f"{scene}, {part}, {what}: {guess/true:.2f}")
    if missed:
        sys.exit("beyond its limits: " + "; ".join(missed))


if __name__ == "__main__":
    main()
