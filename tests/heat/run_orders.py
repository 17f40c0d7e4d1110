#!/usr/bin/env python3
"""Orders of convergence of conduction, in a table: in space by mesh and option, in time by scheme; and the balance of flows.

usage: run_orders.py [-v] [-k]

Prints a row for each problem: errors of meshes or steps that are each half of the one before, orders between them, and for steady
problems what is missing between the heat that comes in and that goes out, over the flow.
- `wall`: conductivity k (1 + b T), sides at T1 and T2: T + b T^2/2 is linear (Kirchhoff). On rectangles and on trapezoids that do not
  become parallelograms as they get smaller, of four and of eight temperatures. A wall of constant conductivity is exact to round-off
  on both.
- `source`: a wall with a source, its sides at T: a parabola, which 8-node elements have on rectangles to round-off, and on trapezoids with
  an order less (D.N. Arnold, D. Boffi, R.S. Falk, Math. Comp. 71 (2002) 909-922).
- `tube`, `sphere`: T = A + B ln r, A + B/r between two radii, the sphere as half a shell in an axisymmetric scene.
- time: a cosine that decays between insulated sides, exp(-k (pi/L)^2 t/rho c).
"""
import math
import os
import sys

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [HERE, os.path.join(os.path.dirname(HERE), "patch")]
from patch_support import Checks, Run, np, num  # noqa: E402
from run_heat import mean_error, temperatures  # noqa: E402

HEAD = "TITLE orders\nSTATE {0}\nKINEM SMALL\n"
STEADY = "START T 100.\nLIC on\n   0. 1.\nSTRAT 1.E12 1. 1.E12 9 3\nSTOP 1.E12\nNORMS FORCE 1.E-13 DISPL 1.E-13\nEND\n"
KINDS = (("", 3), ("BILINEAR", 2))
ROWS = []


def row(checks, what, errors, least, balance=None):
    """A row of the table, and its checks."""
    orders = np.log2(np.array(errors[:-1])/np.array(errors[1:]))
    ROWS.append(f"| {what} | {' '.join(f'{e:.2e}' for e in errors)} | {' '.join(f'{o:.2f}' for o in orders)} | {least} | "
                + ("" if balance is None else f"{balance:.1e}") + " |")
    checks.that(least - 0.15 <= orders[-1] <= least + 0.6, f"{what}: order {least}", f"{orders.round(2)}, errors {errors}")


def balance_of(run, inner):
    """Sum of the flows in over that of their sizes; and what comes in at the nodes `inner` says."""
    x, _ = temperatures(run)
    with run.open() as file:
        last = sorted(file["steps"])[-1]
        flow = file[f"steps/{last}/node/heat_flow"][()].reshape(-1)
    return abs(np.sum(flow))/np.sum(np.abs(flow)), np.sum(flow[inner(x)])


def written_out(n, shift):
    """Nodes and elements of n x n quadrilaterals of the unit square; corners inside go up and down by `shift` of an element, by turns along both
    lines, so that sides across are not parallel."""
    def place(i, j):
        """Corner i, j; doubles are counted."""
        y = j/(2*n)
        if 0 < j < 2*n and j % 2 == 0:
            y += (1 if (i//2 + j//2) % 2 else -1)*shift/n
        return np.array([i/(2*n), y])

    def node(i, j):
        """A corner, or the middle of the side between two."""
        if i % 2 == 0 and j % 2 == 0:
            return place(i, j)
        if i % 2:
            return 0.5*(place(i - 1, j) + place(i + 1, j))
        return 0.5*(place(i, j - 1) + place(i, j + 1))
    label, nodes = {}, []
    for j in range(2*n + 1):
        for i in range(2*n + 1):
            if i % 2 and j % 2:
                continue
            label[i, j] = len(label) + 1
            nodes.append(f"   {label[i, j]} {num(*node(i, j))}")
    around = ((0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1))
    elements = [f"   {1 + i + n*j} " + " ".join(str(label[2*i + a, 2*j + b]) for a, b in around) for j in range(n) for i in range(n)]
    low = [f"   {1 + i} 1" for i in range(n)]
    high = [f"   {1 + i + n*(n - 1)} 3" for i in range(n)]
    return nodes, elements, low, high


def wall(checks):
    """Linear, and by temperature."""
    b, hot, cold = 0.02, 300.0, 100.0

    def exact(_, y):
        theta = (hot + 0.5*b*hot**2)*(1 - y) + (cold + 0.5*b*cold**2)*y
        return (np.sqrt(1 + 2*b*theta) - 1)/b
    for shape, shift in (("rectangles", 0.0), ("trapezoids", 0.25)):
        for kind, order in KINDS:
            for law in ("constant", "by temperature") if kind or not shift else ("constant",):
                errors, worst = [], 0.0
                for n in (4,) if law == "constant" else (8, 16, 32) if shift else (4, 8, 16):
                    nodes, elements, low, high = written_out(n, shift)
                    numbers = "   2. 1.E-3\n"
                    if law != "constant":
                        numbers = f"   TEMP 0.\n   2. 1.E-3\n   TEMP 1000.\n   {num(2*(1 + b*1000))} 1.E-3\n"
                    run = Run(checks, f"wall-{shape}-{kind}{n}{law[:2]}", HEAD.format("PLSTN") + "NODES\n" + "\n".join(nodes)
                              + f"\nPL8TM w 9 m {kind}\n" + "\n".join(elements) + "\nSIDES low\n" + "\n".join(low) + "\nSIDES high\n"
                              + "\n".join(high) + "\nLAW m HEAT\n" + numbers + f"IMPOS low T on {hot}\nIMPOS high T on {cold}\n" + STEADY)
                    if not run.ok:
                        return
                    missing, through = balance_of(run, lambda x: x[:, 1] < 1e-9)
                    worst = max(worst, missing)
                    if law == "constant":
                        x, found = temperatures(run)
                        checks.small(np.max(np.abs(found - (hot + (cold - hot)*x[:, 1]))), 1e-10*hot, f"{run.name}: exact")
                        checks.small(abs(through/(2*(hot - cold)) - 1), 1e-10, f"{run.name}: flow")
                    errors.append(mean_error(run, exact))
                checks.small(worst, 1e-10, f"wall of {shape} {kind}: balance of flows")
                if law != "constant":
                    row(checks, f"wall, {shape}, {kind or 'SERENDIP'}", errors, order, worst)


def source(checks):
    """T = 100 + Q y (1 - y)/(2 k)."""
    for shape, shift, counts in (("rectangles", 0.0, (4,)), ("trapezoids", 0.25, (8, 16, 32))):
        errors = []
        for n in counts:
            nodes, elements, low, high = written_out(n, shift)
            run = Run(checks, f"source-{shape}-{n}", HEAD.format("PLSTN") + "NODES\n" + "\n".join(nodes) + "\nPL8TM w 9 m\n"
                      + "\n".join(elements) + "\nSIDES low\n" + "\n".join(low) + "\nSIDES high\n" + "\n".join(high)
                      + "\nLAW m HEAT\n   2. 1.E-3\nHEATS w Q 1600.\nIMPOS low T on 100.\nIMPOS high T on 100.\n" + STEADY)
            if not run.ok:
                return
            errors.append(mean_error(run, lambda _, y: 100 + 400*y*(1 - y)))
        if shift:
            row(checks, f"source, {shape}, SERENDIP", errors, 2)
        else:
            checks.small(errors[0], 1e-10*200, f"source, {shape}: exact")


def rounds(checks):
    """A tube as a strip, and half of a spherical shell."""
    a, b, hot, cold, k = 1.0, 4.0, 300.0, 100.0, 2.0
    shapes = {
        "tube": (lambda x, _: hot + (cold - hot)*np.log(x/a)/np.log(b/a), 2*math.pi*k*(hot - cold)/math.log(b/a), num(a, 0, b, 0, b, 1, a, 1), "",
                 lambda x: np.abs(x[:, 0] - a) < 1e-9),
        "sphere": (lambda x, y: cold + (hot - cold)*(1/np.hypot(x, y) - 1/b)/(1/a - 1/b), 2*math.pi*k*(hot - cold)/(1/a - 1/b),
                   num(a, 0, b, 0, 0, b, 0, a), "   SIDE 2 ARC 0. 0.\n   SIDE 4 ARC 0. 0.\n", lambda x: np.hypot(x[:, 0], x[:, 1]) < a + 1e-6)}
    for name, (exact, flow, corners, arcs, inner) in shapes.items():
        for kind, order in KINDS:
            errors, through, worst = [], [], 0.0
            for n in (4, 8, 16):
                run = Run(checks, f"{name}-{kind}{n}", HEAD.format("AXISYM") + f"BLOCK p PL8TM 9 m {kind}\n   {corners}\n"
                          f"   {n} {2**(1 - 1/n)} {n if arcs else 1} 1.\n{arcs}LAW m HEAT\n   {k} 1.E-3\nIMPOS p 4 T on {hot}\nIMPOS p 2 T on {cold}\n"
                          + STEADY)
                if not run.ok:
                    return
                missing, came = balance_of(run, inner)
                worst = max(worst, missing)
                errors.append(mean_error(run, exact))
                # results of axisymmetric scenes are of a radian
                through.append(abs(2*math.pi*came/flow - 1))
            row(checks, f"{name}, {kind or 'SERENDIP'}", errors, order, worst)
            checks.small(worst, 1e-10, f"{name} {kind}: balance of flows")
            checks.small(through[-1], 2e-2 if kind else 1e-4, f"{name} {kind}: heat flow {flow:.6g}, errors {through}")


def time(checks):
    """A cosine in a wall, by equal steps."""
    length, rate, end = 0.4, 10*(math.pi/0.4)**2, 2e-3
    for scheme, order in (("1.", 1), ("1. MEAN", 1), ("0.5", 2), ("0.5 MEAN", 2), ("TRBDF2", 2)):
        errors = []
        for steps in (8, 16, 32, 64):
            step = end/steps
            # a first step of TR-BDF2 is one of implicit Euler, made so short that it does not count
            first = step/256 if scheme == "TRBDF2" else step
            run = Run(checks, f"time-{scheme.replace(' ', '')}-{steps}", HEAD.format("PLSTN")
                      + f"BLOCK w PL8TM 9 m\n   {num(0, 0, length, 0, length, 0.1, 0, 0.1)}\n   24 1. 1 1.\nLAW m HEAT\n   20. 2.\n"
                      f"START T 300+80*cos(pi*x/{length})\nTHETA {scheme}\nSTRAT {first!r} {first/4!r} {step!r} 99 1 0.5 1.E6\nSTOP {end}\n"
                      "NORMS FORCE 1.E-12 DISPL 1.E-12\nPROBE a NODE T 0. 0.\nEND\n")
            if not run.ok:
                return
            errors.append(abs(run.history["a"][-1] - 300 - 80*math.exp(-rate*end)))
        row(checks, f"time, THETA {scheme}", errors, order)


def main():
    """All of it, and the table."""
    checks = Checks()
    wall(checks)
    source(checks)
    rounds(checks)
    time(checks)
    print("| problem | errors | orders | expected | flows missing |\n|---|---|---|---|---|\n" + "\n".join(ROWS))
    checks.end()


if __name__ == "__main__":
    main()
