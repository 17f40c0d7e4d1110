#!/usr/bin/env python3
"""Contact: uniform pressure under a flat die over unlike sides, balance, turned scenes, friction on a flat and on an incline.

usage: run_contact_patch.py [-v] [-k]

The penalty AKP is given, so that sides of unlike length have the same: pressure p = AKP d is then exactly uniform, and the penetration d
follows from the homogeneous solution. Two blocks (E = 1e6, nu = 0, 1 %, pressure 1e4) become one block under a rigid die, with the
penetration carried away by augmentation.
"""
import sys

sys.dont_write_bytecode = True
from patch_support import NO_CONVERGENCE, STRESS, Checks, Run, np, num  # noqa: E402
from run_patch import patch  # noqa: E402

YOUNG, AKP = 1.0e6, 1.0e7
WIDTH, HEIGHT = 1.5, 1.0
EXACT, CLOSE = 1.0e-10, 1.0e-6
NORMS = "NORMS FORCE 1.E-11 DISPL 1.E-10\n"
# Many iterations wanted: steps stay the longest, whatever round-off does to the count of iterations.
STEADY = "STRAT 0.25 1.E-4 0.25 20 3"
RULES = (2, 3, 4, -3, -5, -9, -17)


def pressed(state, kinem, nu, rule, npoint=4, drive=0.01, law=f"AKP {num(AKP)}"):
    """A graded block under a flat die, free to widen."""
    return (f"TITLE pressed\nSTATE {state}\nKINEM {kinem}\nBLOCK b PL8LS {npoint} m\n   {num(0, 0, WIDTH, 0, WIDTH, HEIGHT, 0, HEIGHT)}\n"
            f"   5 6. 3 0.4\nLAW m ELA\n   {num(YOUNG, nu)}\nLAW c COUL2D\n   {law} PHI 0.\n"
            f"DIE upper PILOT 0. {num(HEIGHT)}\n   SEGM 4. {num(HEIGHT)} -1. {num(HEIGHT)}\nCNT2D b 3 upper {rule} c\n"
            f"FIXED b 1 Y\nFIXED b 4 X\nLIC t\n   0. 0.   1. 1.\nMOVE upper Y t {num(-drive)}\nPROBE below REACT Y b 1\n"
            f"{NORMS}STRAT 0.5 1.E-4 0.5 5 3\nSTOP 1.\nEND\n")


def homogeneous(state, kinem, nu, drive):
    """Pressure of the block, p = AKP d, by bisection on d: the block's own shortening is drive - d."""
    low, high = 0.0, drive
    for _ in range(200):
        d = 0.5*(low + high)
        # Free to widen: in the plane with E/(1 - nu^2), all round with E. The side that carries p widens with the body.
        modulus, ratio, ways = (YOUNG/(1 - nu*nu), nu/(1 - nu), 1) if state == "PLSTN" else (YOUNG, nu, 2)
        if kinem == "SMALL":
            shortening = (drive - d)/HEIGHT
            p = modulus*shortening/(1 + ratio*shortening)**ways
        else:
            shortening = -np.log(1 - (drive - d)/HEIGHT)
            p = modulus*shortening*np.exp(shortening*(1 - ways*ratio))
        low, high = (d, high) if p > AKP*d else (low, d)
    return AKP*d


def spread(values, mean):
    """Largest distance from a value, over it."""
    return np.abs(values - mean).max()/abs(mean)


def balance(checks, run, die="upper", probe="below"):
    """What the part does to the die is what the supports do to the part."""
    force, support = run.history[f"force_y_{die}"], run.history[probe]
    checks.small(np.abs(force/support - 1).max(), EXACT, f"{run.name}: force on the die is the reaction of the other side")


def flat_dies(checks):
    """Uniform pressure, plane and axisymmetric, small and large strain, all rules."""
    for state in ("PLSTN", "AXISYM"):
        for kinem, nu, drive, npoint in (("SMALL", 0.0, 0.01, 4), ("SMALL", 0.3, 0.01, 9), ("LOG", 0.0, 0.2, 4), ("LOG", 0.3, 0.2, 4),
                                         ("LOG", 0.3, 0.2, 9)):
            for rule in RULES:
                run = Run(checks, f"flat-{state}-{kinem}-{nu}-{npoint}-{rule}", pressed(state, kinem, nu, rule, npoint, drive))
                if not run.ok:
                    continue
                exact = homogeneous(state, kinem, nu, drive)
                found = run.state("b.3/upper", "pressure")
                checks.small(spread(found, found.mean()), EXACT, f"{run.name}: pressure is uniform")
                checks.small(spread(found, exact), EXACT, f"{run.name}: pressure is that of the homogeneous block")
                stress = run.state("b", *STRESS)
                # Small strain knows the first geometry only: its stress is the force over the first width.
                carried = run.history["force_y_upper"][-1]/(WIDTH if state == "PLSTN" else np.pi*WIDTH**2)
                checks.small(np.abs(stress[:, 1] - stress[:, 1].mean()).max()/exact, EXACT, f"{run.name}: stress is uniform")
                if kinem == "SMALL":
                    checks.small(spread(stress[:, 1], -carried), EXACT, f"{run.name}: stress is the force over the first section")
                else:
                    checks.small(spread(stress[:, 1], -exact), EXACT, f"{run.name}: stress is the pressure")
                checks.small(np.abs(stress[:, [0, 2]]).max()/exact, EXACT, f"{run.name}: no other stress")
                balance(checks, run)
        for rule in RULES:
            run = Run(checks, f"two-blocks-{state}-{rule}",
                      pressed(state, "SMALL", 0.0, rule, law=f"AKP {num(AKP)} PENETR 1.E-9 AUGMENT 20"))
            if run.ok:
                found = run.state("b.3/upper", "pressure")
                checks.small(spread(found, 1.0e4), CLOSE, f"{run.name}: pressure 1e4")
                checks.small(spread(found, found.mean()), EXACT, f"{run.name}: pressure is uniform")
                balance(checks, run)


def distorted(checks):
    """Five distorted elements with moved middle nodes under the die; the pressed side has its middle off centre."""
    nodes, elements, _ = patch("curved")
    for kinem in ("SMALL", "LOG"):
        for rule in RULES:
            text = f"TITLE distorted\nSTATE PLSTN\nKINEM {kinem}\nNODES\n" + "".join(f"   {k + 1} {num(*x)}\n" for k, x in enumerate(nodes))
            text += "PL8LS p 4 m\n" + "".join(f"   {k + 1} " + " ".join(str(n + 1) for n in e) + "\n" for k, e in enumerate(elements))
            text += "SIDES below\n   2 1\nSIDES above\n   4 1\nSIDES left\n   5 1\n"
            text += (f"LAW m ELA\n   {num(YOUNG, 0.3)}\nLAW c COUL2D\n   AKP {num(1e8)} PHI 0.\nDIE upper\n   SEGM 1. 0.12 -1. 0.12\n"
                     f"CNT2D above upper {rule} c\nFIXED below Y\nFIXED left X\nLIC t\n   0. 0.   1. 1.\nMOVE upper Y t -0.002\n"
                     f"PROBE below REACT Y below\n{NORMS}STRAT 0.5 1.E-4 0.5 5 3\nSTOP 1.\nEND\n")
            run = Run(checks, f"distorted-{kinem}-{rule}", text)
            if run.ok:
                found = run.state("above/upper", "pressure")
                checks.small(spread(found, found.mean()), EXACT, f"{run.name}: pressure is uniform")
                stress = run.state("p", *STRESS)
                checks.small(spread(stress[:, 1], stress[:, 1].mean()), EXACT, f"{run.name}: stress is uniform")
                checks.small(np.abs(stress[:, [0, 2]]).max()/found.mean(), EXACT, f"{run.name}: no other stress")
                balance(checks, run)


def turned_deck(kinem, angle, shape, phi, rule):
    """A block held below, pressed by a die that also slides and, when curved, turns; all of it turned by an angle about the origin."""
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])

    def at(*places):
        return num(*(turn @ np.reshape(places, (-1, 2)).T).T.ravel())

    piece = {"flat": f"SEGM {at(4, HEIGHT, -3, HEIGHT)}",
             "parabola": f"PARAB {at(4, HEIGHT + 1.5, 0.7, HEIGHT, -2.6, HEIGHT + 1.5)}"}[shape]
    way = turn @ (0.01, -0.02)
    text = (f"TITLE turned\nSTATE PLSTN\nKINEM {kinem}\nBLOCK b PL8LS 4 m\n   {at(0, 0, WIDTH, 0, WIDTH, HEIGHT, 0, HEIGHT)}\n   5 3. 3 0.4\n"
            f"LAW m ELA\n   {num(YOUNG, 0.3)}\nLAW c COUL2D\n   AKP {num(AKP)} PHI {num(phi)}\nDIE upper PILOT {at(0.7, HEIGHT)}\n   {piece}\n"
            f"CNT2D b 3 upper {rule} c\nFIXED b 1 XY\nLIC t\n   0. 0.   1. 1.\nMOVE upper X t {num(way[0])}\nMOVE upper Y t {num(way[1])}\n")
    if shape == "parabola":
        text += "MOVE upper A t 0.01\n"
    return text + f"PROBE support_x REACT X b 1\nPROBE below REACT Y b 1\n{NORMS}{STEADY}\nSTOP 1.\nEND\n"


def turned_scenes(checks):
    """A scene turned by 30 degrees has the same pressures and friction, and its forces turn with it."""
    for kinem in ("SMALL", "LOG"):
        for shape in ("flat", "parabola"):
            for phi in (0.0, 0.2):
                for rule in RULES:
                    runs = [Run(checks, f"turned-{kinem}-{shape}-{phi}-{rule}-{degrees}",
                                turned_deck(kinem, np.radians(degrees), shape, phi, rule)) for degrees in (0, 30, -135)]
                    if not all(run.ok for run in runs):
                        continue
                    states = [run.state("b.3/upper", "pressure", "friction") for run in runs]
                    scale = states[0][:, 0].max()
                    history = runs[0].history
                    checks.that(scale > 0, f"{runs[0].name}: there is pressure", scale)
                    for run, state, degrees in zip(runs[1:], states[1:], (30, -135)):
                        checks.small(np.abs(state - states[0]).max()/scale, EXACT, f"{run.name}: pressure and friction as unturned")
                        c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
                        x, y, moment = (history[name][-1] for name in ("force_x_upper", "force_y_upper", "moment_upper"))
                        found = [run.history[name][-1] for name in ("force_x_upper", "force_y_upper", "moment_upper")]
                        error = np.abs(np.array(found) - (c*x - s*y, s*x + c*y, moment)).max()/np.hypot(x, y)
                        checks.small(error, EXACT, f"{run.name}: forces turn with the scene")
                    for run in runs:
                        total = np.hypot(run.history["force_x_upper"], run.history["force_y_upper"])
                        for force, support in (("force_x_upper", "support_x"), ("force_y_upper", "below")):
                            error = np.abs(run.history[force] - run.history[support]).max()/total.max()
                            checks.small(error, EXACT, f"{run.name}: {force} is the reaction of the other side")


PHI, LENGTH, LOW = 0.2, 2.0, 0.5


def sliding_deck(kinem, rule, ways, young=YOUNG, norms=NORMS):
    """A low block pressed on a floor by its upper side, which then slides there by the ways given, one in each unit of time."""
    pairs = "".join(f"   {k + 1}. {num(way)}\n" for k, way in enumerate([0.0] + ways))
    return (f"TITLE sliding\nSTATE PLSTN\nKINEM {kinem}\nBLOCK b PL8LS 4 m\n   {num(0, 0, LENGTH, 0, LENGTH, LOW, 0, LOW)}\n   8 1. 2 1.\n"
            f"LAW m ELA\n   {num(young, 0.0)}\nLAW c COUL2D\n   AKP {num(AKP)} AKTAU {num(AKP)} PHI {num(PHI)}\n"
            f"DIE floor\n   SEGM -3. 0. 6. 0.\nCNT2D b 1 floor {rule} c\nLIC press\n   0. 0.   1. -0.005\nLIC slide\n   0. 0.\n{pairs}"
            f"MOVE b 3 Y press\nMOVE b 3 X slide\nPROBE top_x REACT X b 3\nPROBE top_y REACT Y b 3\n"
            f"{norms}STRAT 0.1 1.E-5 0.1 5 3\nSTOP {len(ways) + 1}.\nEND\n")


def friction_on_a_flat(checks):
    """Stick below the cone, |force_x| = PHI |force_y| above it, the sign of the motion; work of friction."""
    for kinem in ("SMALL", "LOG"):
        for rule in RULES:
            run = Run(checks, f"stick-{kinem}-{rule}", sliding_deck(kinem, rule, [2e-4, -2e-4, 0.0]))
            if run.ok:
                history = run.history
                normal = np.abs(history["force_y_floor"])
                x = history["force_x_floor"]/normal.max()
                error = max(np.abs(history["force_x_floor"] - history["top_x"]).max(), np.abs(history["force_y_floor"] - history["top_y"]).max())
                checks.small(error/normal.max(), EXACT, f"{run.name}: force on the floor is the reaction of the top")
                turn = [np.argmin(np.abs(history["time"] - t)) for t in (2, 3, 4)]
                # A low block sticks everywhere: G s/h below the cone, and its ends too.
                checks.that(not history["points_slipping"].any(), f"{run.name}: no point slips", history["points_slipping"].max())
                checks.that(np.abs(x).max() < PHI, f"{run.name}: below the cone", np.abs(x).max())
                checks.that(x[turn[0]] > 0.01, f"{run.name}: the floor is dragged along", x[turn[0]])
                checks.small(abs(x[turn[0]] + x[turn[1]]), 1e-6 if kinem == "LOG" else EXACT, f"{run.name}: there and back the same")
                checks.small(abs(x[turn[2]]), 1e-6 if kinem == "LOG" else EXACT, f"{run.name}: nothing is left")
                checks.that(np.abs(history["friction_work"]).max() == 0, f"{run.name}: sticking takes no work",
                            np.abs(history["friction_work"]).max())
            # The traction follows the part's own side: a block much stiffer than the penalty keeps that straight, and has coarser
            # round-off in its forces. Those of the contact still obey its law to the last digit.
            run = Run(checks, f"slip-{kinem}-{rule}", sliding_deck(kinem, rule, [0.05, -0.05, 0.02], 1.0e11, "NORMS FORCE 1.E-7\n"))
            if not run.ok:
                continue
            history = run.history
            found = run.state("b.1/floor", "pressure", "friction")
            checks.small(spread(np.abs(found[:, 1])/found[:, 0], PHI), EXACT, f"{run.name}: friction is PHI times pressure at all points")
            x, y = history["force_x_floor"], history["force_y_floor"]
            checks.that((y[history["time"] > 0.5] < 0).all(), f"{run.name}: the floor is pressed downwards", y.max())
            checks.that((np.abs(x) <= PHI*np.abs(y)*(1 + 1e-10)).all(), f"{run.name}: never beyond the cone", (np.abs(x/y)).max())
            for time, sign in ((2, 1), (3, -1), (4, 1)):
                k = np.argmin(np.abs(history["time"] - time))
                checks.that(history["points_sticking"][k] == 0, f"{run.name}: all slip at {time}", history["points_sticking"][k])
                checks.small(abs(x[k]/y[k] + sign*PHI)/PHI, CLOSE, f"{run.name}: force_x = PHI force_y at {time}, against the motion")
                checks.small(max(abs(history["top_x"][k] - x[k]), abs(history["top_y"][k] - y[k]))/abs(y[k]), CLOSE,
                             f"{run.name}: force on the floor is the reaction of the top at {time}")
            work = np.diff(np.concatenate([[0.0], history["friction_work"]]))
            checks.that((work >= -1e-12*history["friction_work"].max()).all(), f"{run.name}: friction work never falls", work.min())
            steady = (history["time"] > 1.5) & (history["time"] < 2 + 1e-9)
            way = 0.05*history["step_length"]
            checks.small(np.abs(work[steady]/(np.abs(x)*way)[steady] - 1).max(), CLOSE, f"{run.name}: friction work is force times way")


def incline_deck(phi, rule, degrees=20.0, load=1.0e3):
    """A low block on an incline under a vertical load on its upper side. It begins a little inside the floor, so that it is held."""
    angle = np.radians(degrees)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])

    def at(*places):
        return num(*(turn @ np.reshape(places, (-1, 2)).T).T.ravel())

    return (f"TITLE incline\nSTATE PLSTN\nKINEM SMALL\nBLOCK b PL8LS 4 m\n   {at(0, 0, LENGTH, 0, LENGTH, LOW, 0, LOW)}\n   8 1. 2 1.\n"
            f"LAW m ELA\n   {num(YOUNG, 0.0)}\nLAW c COUL2D\n   AKP {num(AKP)} AKTAU {num(AKP)} PHI {num(phi)}\n"
            f"DIE floor\n   SEGM {at(-3, 1e-5, 6, 1e-5)}\nCNT2D b 1 floor {rule} c\nLIC t\n   0. 1.\n"
            f"TRACT b 3 Y {num(-load)} t\nNORMS FORCE 1.E-11\nSTRAT 0.5 0.05 0.5 5 3\nSTOP 1.\nEND\n")


def friction_on_an_incline(checks):
    """Below the cone the block stays, with friction N tan(angle); beyond it there is no equilibrium."""
    for rule in RULES:
        run = Run(checks, f"incline-stays-{rule}", incline_deck(0.6, rule))
        if run.ok:
            x, y = run.history["force_x_floor"][-1], run.history["force_y_floor"][-1]
            checks.small(abs(y/(-1.0e3*LENGTH) - 1), EXACT, f"{run.name}: the floor carries the load")
            checks.small(abs(x/y), EXACT, f"{run.name}: and nothing sideways")
        run = Run(checks, f"incline-slides-{rule}", incline_deck(0.3, rule), NO_CONVERGENCE)


def main():
    checks = Checks()
    flat_dies(checks)
    distorted(checks)
    turned_scenes(checks)
    friction_on_a_flat(checks)
    friction_on_an_incline(checks)
    checks.end()


if __name__ == "__main__":
    main()
