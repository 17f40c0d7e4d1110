#!/usr/bin/env python3
"""Locking, and the mean dilatation that ends it: 9 points with and without MEAN, 2 x 2 points beside them.

usage: run_locking.py [-v] [-k]

- patches: constant states are met with MEAN as without, large strain and plasticity among them.
- orders: those of run_order.py hold with MEAN.
- `tube`, `ring`: Lame's cylinder at nu = 0.49999: u(a) = 0.0714283 for a = 4, b = 10, p = 10, E = 1000 (C. Felippa).
- `cook`: Cook's membrane at nu = 0.4999, u_y(48, 60) = 7.767 (NGSolve, order 5, 64 x 64); at nu = 0.499999 hardly another answer,
  stress among it, where 9 points alone make it as large as the bulk modulus will have it.
- `limit`: thick cylinder a = 100, b = 200 mm, perfectly plastic, bore driven: p = 2/sqrt(3) sy ln(b/a).
- `footing`: a smooth strip of half width 1 on soil 5 x 5: p = 5.1416 c (Prandtl); elements of a grid that has no more than h beside the
  strip's edge overestimate it: less so with MEAN, in order h.
"""
import sys

sys.dont_write_bytecode = True
from patch_support import STRESS, Checks, Run, np, num  # noqa: E402
import run_order  # noqa: E402
import run_patch  # noqa: E402

KINDS = {"4": "PL8LS 4 m", "9": "PL8LS 9 m", "9 MEAN": "PL8LS 9 m MEAN"}
RAMP = "LIC t\n   0. 0.   1. 1.\n"


def patches(checks):
    """Constant states in plane strain, axisymmetric and generalised plane strain."""
    mesh = run_patch.patch("curved", 0.1)
    fields = {"SMALL": [[2e-3, 0.0], [0.0, -3e-3]], "LOG": [[0.3, 0.0], [0.0, -0.35]]}
    for kinem, gradient in fields.items():
        for law in ("ELA", "EPLA"):
            for state, more, hoop in (("PLSTN", "", 0.0), ("AXISYM", "", gradient[0][0]),
                                      ("GPLSTN", f"SECTN E MOVE t {gradient[0][0]}\nSECTN KX HELD\nSECTN KY HELD\n", gradient[0][0])):
                loads, field = run_patch.driven(mesh, gradient)
                text = run_patch.deck(state, kinem, law, 9, mesh, loads + more).replace("PL8LS p 9 m\n", "PL8LS p 9 m MEAN\n")
                run = Run(checks, f"patch-{state}-{kinem}-{law}", text)
                if run.ok:
                    run_patch.compare(checks, run, field, run_patch.exact_stress(kinem, law, gradient, hoop, run.history["time"]))


def orders(checks):
    """run_order.py's studies with MEAN."""
    def mean(make):
        return lambda n, npoint: make(n, npoint).replace("PL8LS p 9 m\n", "PL8LS p 9 m MEAN\n").replace("BLOCK p PL8LS 9 m\n",
                                                                                                  "BLOCK p PL8LS 9 m MEAN\n")
    for name, make, exact in (("waves", run_order.waves_deck, run_order.waves), ("ring", run_order.ring_deck, run_order.ring),
                              ("tube", run_order.tube_deck, run_order.tube)):
        checks.that("MEAN" in mean(make)(2, 9), f"{name}: the deck asks for MEAN")
        run_order.study(checks, name + " MEAN", mean(make), exact, 9, axisym=name == "tube")


def values(checks, name, make, sizes, *arguments):
    """What `make(kind, n, ...)` decks answer in the probe u: kind -> list over the sizes, and the runs."""
    answers = {kind: [Run(checks, f"{name}-{kind.replace(' ', '')}-{n}", make(card, n, *arguments)) for n in sizes]
               for kind, card in KINDS.items()}
    if not all(run.ok for runs in answers.values() for run in runs):
        return None, None
    found = {kind: np.array([run.history["u"][-1] for run in runs]) for kind, runs in answers.items()}
    return found, answers


def show(name, sizes, found, exact):
    """One line for each kind."""
    for kind, row in found.items():
        print(f"{name:12s} {kind:7s}" + "".join(f"  n={n}: {value/exact - 1:+.2e}" for n, value in zip(sizes, row)))


def cylinder(card, n, nu, state):
    """Lame's cylinder as a tube or a quarter of a ring."""
    if state == "AXISYM":
        body = f"BLOCK p {card}\n   4. 0. 10. 0. 10. 3. 4. 3.\n   {n} 1. 2 1.\nFIXED p 1 3 Y\n"
    else:
        body = (f"BLOCK p {card}\n   4. 0. 10. 0. 0. 10. 0. 4.\n   {n} 1. {n} 1.\n   SIDE 2 ARC 0. 0.\n   SIDE 4 ARC 0. 0.\n"
                "FIXED p 1 Y\nFIXED p 3 X\n")
    return (f"TITLE cylinder\nSTATE {state}\nKINEM SMALL\n{body}LAW m ELA\n   {num(1000, nu)}\nPRES2D p 4 3 10. t\n{RAMP}"
            "PROBE u NODE UX 4. 0.\nSTRAT 1. 1. 1. 4 3\nEND\n")


def cylinders(checks):
    """Nearly incompressible."""
    sizes = (2, 5, 10)
    for state, name in (("AXISYM", "tube"), ("PLSTN", "ring")):
        found, _ = values(checks, name, cylinder, sizes, 0.49999, state)
        if not found:
            continue
        exact = 0.0714283
        show(name, sizes, found, exact)
        checks.that(found["9"][1] < 0.5*exact, f"{name}: 9 points lock on 5 elements", found["9"])
        checks.small(abs(found["9 MEAN"][1]/exact - 1), 1e-3, f"{name}: MEAN does not, on 5 elements")
        checks.small(abs(found["9 MEAN"][2]/exact - 1), 1e-5, f"{name}: MEAN on 10 elements")


def cook(card, n, nu):
    """Cook's membrane."""
    return (f"TITLE cook\nSTATE PLSTN\nKINEM SMALL\nBLOCK p {card}\n   0. 0.   48. 44.   48. 60.   0. 44.\n   {n} 1. {n} 1.\n"
            f"LAW m ELA\n   {num(250, nu)}\nFIXED p 4 XY\nTRACT p 2 Y 100/16 t\n{RAMP}PROBE u NODE UY 48. 60.\nSTRAT 1. 1. 1. 4 3\nEND\n")


def membranes(checks):
    """Bending and shear at two steps towards incompressibility."""
    sizes = (4, 16)
    ends = []
    for nu in (0.4999, 0.499999):
        found, runs = values(checks, f"cook-{nu}", cook, sizes, nu)
        if not found:
            return
        show(f"cook {nu}", sizes, found, 7.767)
        checks.that(found["9"][0] < found["4"][0] < found["9 MEAN"][0] < 7.767, f"cook {nu}: MEAN is nearest on 4 x 4", found)
        checks.small(abs(found["9 MEAN"][0]/7.767 - 1), 0.06, f"cook {nu}: MEAN on 4 x 4")
        checks.small(abs(found["9 MEAN"][1]/7.767 - 1), 0.01, f"cook {nu}: MEAN on 16 x 16")
        ends.append({kind: (found[kind][1], np.abs(runs[kind][1].state("p", *STRESS)).max()) for kind in found})
    for k, what in enumerate(("displacement", "largest stress")):
        change = {kind: abs(ends[1][kind][k]/ends[0][kind][k] - 1) for kind in KINDS}
        print(f"cook: change of {what} from nu 0.4999 to 0.499999 on 16 x 16: " + ", ".join(f"{kind} {v:.1e}" for kind, v in change.items()))
        checks.small(change["9 MEAN"], 0.01, f"cook: with MEAN the {what} is that of an incompressible body")
    checks.that(ends[1]["9"][1] > 10*ends[1]["9 MEAN"][1], "cook: without it the stress is not", ends[1])


def plastic_cylinder(card, n):
    """A thick cylinder driven past its limit load; `u` is the pressure over the limit."""
    exact = 2/np.sqrt(3)*240*np.log(2)*2*np.pi*100*100
    return (f"TITLE limit\nSTATE AXISYM\nKINEM SMALL\nBLOCK p {card}\n   100. 0. 200. 0. 200. 100. 100. 100.\n   {n} 1. {n} 1.\n"
            f"LAW m EPLA\n   210000. 0.3\n   LINEAR 240. 0.\nFIXED p 1 3 Y\nMOVE p 4 X t 2.\n{RAMP}PROBE u REACT X p 4\n"
            "STRAT 0.1 0.01 0.1 4 3\nEND\n"), exact


def footing(card, n):
    """A smooth strip pressed into soil, n elements below its half."""
    return (f"TITLE footing\nSTATE PLSTN\nKINEM SMALL\nBLOCK p {card}\n   0. 0. 1. 0. 1. 5. 0. 5.\n   {n} 1. {5*n} 1.\n"
            f"BLOCK q {card}\n   1. 0. 5. 0. 5. 5. 1. 5.\n   {4*n} 1. {5*n} 1.\nJOIN p 2 q 4\nLAW m EPLA\n   1.E5 0.3\n"
            f"   LINEAR {num(np.sqrt(3))} 0.\nFIXED p 1 XY\nFIXED q 1 XY\nFIXED p 4 X\nFIXED q 2 X\nMOVE p 3 Y t -0.005\n{RAMP}"
            "PROBE u REACT Y p 3\nSTRAT 0.02 0.001 0.02 4 3\nEND\n")


def limits(checks):
    """Perfectly plastic limit loads."""
    exact = plastic_cylinder("", 1)[1]
    found, _ = values(checks, "limit", lambda card, n: plastic_cylinder(card, n)[0], (1, 2, 4))
    if found:
        show("limit", (1, 2, 4), found, exact)
        checks.that(found["9"][0]/exact > 1.05, "limit: 9 points overestimate the load on one element", found["9"]/exact)
        checks.small(abs(found["9 MEAN"][0]/exact - 1), 5e-3, "limit: MEAN on one element")
        checks.small(abs(found["9 MEAN"][2]/exact - 1), 5e-5, "limit: MEAN on four elements")
    found, runs = values(checks, "footing", footing, (1, 2, 4))
    if found:
        over = {kind: row/-(2 + np.pi) - 1 for kind, row in found.items()}
        show("footing", (1, 2, 4), found, -(2 + np.pi))
        checks.that(all(over["9 MEAN"] < 0.5*over["9"]), "footing: MEAN overestimates less than half as much as 9 points", over)
        checks.small(over["9 MEAN"][2], 0.05, "footing: MEAN with 4 elements below the half strip")
        checks.that(over["9 MEAN"][2] < 0.6*over["9 MEAN"][1] < 0.36*over["9 MEAN"][0], "footing: it falls with the element's size", over)
        force = runs["9 MEAN"][2].history["u"]
        checks.small(abs(force[-1]/force[-10] - 1), 1e-3, "footing: the load has come to rest")


def main():
    checks = Checks()
    patches(checks)
    orders(checks)
    cylinders(checks)
    membranes(checks)
    limits(checks)
    checks.end()


if __name__ == "__main__":
    main()
