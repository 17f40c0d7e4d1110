#!/usr/bin/env python3
"""Contact between deformable bodies: uniform pressure through like and unlike meshes, action and reaction, turned scenes, friction.

usage: run_contact_pair.py [-v] [-k]

Two blocks, one on the other, E = 1e6, nu = 0, under a pressure of 1e4: stresses are uniform, exactly where the sides of both blocks are
the same. On unlike sides the forces of the points of one are shared among the nodes of the other by its shape functions, which is
exact for the sum but not for each node: with nine points on a side the pressure stays within 1 % whichever block faces the other.
"""
import sys

sys.dont_write_bytecode = True
from patch_support import STRESS, Checks, Run, np, num  # noqa: E402

YOUNG, PRESSURE, OVERLAP = 1.0e6, 1.0e4, 1.0e-6
EXACT, CLOSE = 1.0e-10, 1.0e-6
NORMS = "NORMS FORCE 1.E-11 DISPL 1.E-10\n"


def block(name, corners, nx, ny, degrees):
    """A block with its corners turned about the origin."""
    angle = np.radians(degrees)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    return f"BLOCK {name} PL8LS 4 m\n   {num(*(turn @ np.reshape(corners, (-1, 2)).T).T.ravel())}\n   {nx} 1. {ny} 1.\n"


def stacked(state, kinem, low, top, rule, law="PHI 0. PENETR 1.E-2", degrees=0.0, ledge=0.0):
    """Two blocks under pressure from above, the upper one facing the lower. They begin with a slight overlap, so that both are held.
    They cannot widen; where the lower one has ledges on both sides, they can, and friction holds them."""
    hold = "" if ledge else "".join(f"FIXED {body} {side} X\n" for body in ("low", "top") for side in (2, 4))
    y = 1 - OVERLAP
    return (f"TITLE stacked\nSTATE {state}\nKINEM {kinem}\n" + block("low", (-ledge, 0, 2 + ledge, 0, 2 + ledge, 1, -ledge, 1), low, 2, degrees)
            + block("top", (0, y, 2, y, 2, 2, 0, 2), top, 3, degrees)
            + f"LAW m ELA\n   {num(YOUNG, 0)}\nLAW c COUL2D\n   {law}\nDIE lower SIDES low 3\nCNT2D top 1 lower {rule} c\n"
            f"LIC t\n   0. 0.   1. 1.\nFIXED low 1 XY\n{hold}PRES2D top 3 3 {num(PRESSURE)} t\nPROBE below_x REACT X low 1{' 2 4' if hold else ''}\nPROBE below_y REACT Y low 1\n"
            f"{NORMS}STRAT 0.5 1.E-4 0.5 20 3\nSTOP 1.\nEND\n")


def action_and_reaction(checks, run, name="lower", axes="xy"):
    """What the upper body does to the die is what the supports of the lower one do to it; both bodies bear it."""
    force = np.hypot(run.history[f"force_x_{name}"], run.history[f"force_y_{name}"]).max()
    for axis in axes:
        error = np.abs(run.history[f"force_{axis}_{name}"] + run.history[f"below_{axis}"]).max()/force
        checks.small(error, EXACT, f"{run.name}: force_{axis} on one body is the reaction of its support")


def like_meshes(checks):
    """The same sides above and below: exact."""
    for state in ("PLSTN", "AXISYM"):
        for kinem in ("SMALL", "LOG"):
            for rule in (2, 3, 4, -3, -9):
                run = Run(checks, f"like-{state}-{kinem}-{rule}", stacked(state, kinem, 4, 4, rule))
                if not run.ok:
                    continue
                pressure = run.state("top.1/lower", "pressure")
                checks.small(np.abs(pressure/PRESSURE - 1).max(), CLOSE, f"{run.name}: pressure is uniform")
                for body in ("low", "top"):
                    error = np.abs(run.state(body, *STRESS) + (0, PRESSURE, 0, 0)).max()/PRESSURE
                    checks.small(error, CLOSE, f"{run.name}: stress of {body} is uniform")
                action_and_reaction(checks, run, axes="xy" if state == "PLSTN" else "y")


def unlike_meshes(checks):
    """Sides that meet anywhere."""
    for low, top in ((3, 5), (4, 7), (2, 5), (3, 10), (5, 3), (7, 4)):
        for state in ("PLSTN", "AXISYM"):
            run = Run(checks, f"unlike-{low}-{top}-{state}", stacked(state, "LOG", low, top, -9))
            if not run.ok:
                continue
            pressure = run.state("top.1/lower", "pressure")
            checks.small(np.abs(pressure/PRESSURE - 1).max(), 1e-2, f"{run.name}: pressure is uniform to 1 %")
            action_and_reaction(checks, run, axes="xy" if state == "PLSTN" else "y")


def turned(checks):
    """The scene turned as a whole: the lower block held as before, the same pressures."""
    straight, run = (Run(checks, name, stacked("PLSTN", "LOG", 5, 4, -3, law="PHI 0.3", degrees=degrees, ledge=0.5))
                     for name, degrees in (("straight", 0.0), ("turned", 40.0)))
    if straight.ok and run.ok:
        one, two = (r.state("top.1/lower", "pressure", "friction") for r in (straight, run))
        checks.small(np.abs(one - two).max()/PRESSURE, CLOSE, "turned: the same pressures and friction")
        action_and_reaction(checks, run)


def sliding(checks):
    """A block dragged over another by more than a side of it: friction is PHI times the pressure, there and back."""
    phi, way = 0.2, 0.7
    text = ("TITLE sliding\nSTATE PLSTN\nKINEM LOG\n" + block("low", (0, 0, 4, 0, 4, 0.5, 0, 0.5), 8, 1, 0)
            + block("top", (1, 0.5, 2, 0.5, 2, 0.8, 1, 0.8), 3, 1, 0)
            + f"LAW m ELA\n   {num(YOUNG, 0)}\nLAW c COUL2D\n   PHI {phi} PENETR 1.E-3\nDIE lower SIDES low 3\nCNT2D top 1 lower -3 c\n"
            f"LIC press\n   0. 0.   1. -2.E-3\nLIC drag\n   0. 0.   1. 0.   2. {way}   3. 0.\nFIXED low 1 XY\nMOVE top 3 Y press\nMOVE top 3 X drag\n"
            f"PROBE below_x REACT X low 1\nPROBE below_y REACT Y low 1\nPROBE top_x REACT X top 3\n"
            f"{NORMS}STRAT 0.1 1.E-5 0.1 8 3\nSTOP 3.\nEND\n")
    run = Run(checks, "sliding", text)
    if not run.ok:
        return
    history = run.history
    action_and_reaction(checks, run)
    x, y = history["force_x_lower"], history["force_y_lower"]
    checks.small(np.abs(x - history["top_x"]).max()/np.abs(y).max(), EXACT, "sliding: what drags one body the other bears")
    for time, sign in ((2, 1), (3, -1)):
        k = np.argmin(np.abs(history["time"] - time))
        checks.that(history["points_sticking"][k] == 0, f"sliding: all slip at {time}", history["points_sticking"][k])
        checks.small(abs(x[k]/abs(y[k]) - sign*phi)/phi, 1e-2, f"sliding: PHI times the force pressed with at {time}")
    checks.that((np.diff(history["friction_work"]) >= -1e-12*history["friction_work"].max()).all(), "sliding: friction work never falls")


def main():
    checks = Checks()
    like_meshes(checks)
    unlike_meshes(checks)
    turned(checks)
    sliding(checks)
    checks.end()


if __name__ == "__main__":
    main()
