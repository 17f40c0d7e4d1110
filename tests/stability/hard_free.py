"""Hard cases of parts that no support holds: dies alone carry them, and touch them one after the other."""
import math

from hard_support import PLASTIC, Case, deck, np

# Width, height, elements along each, friction, slope of the upper and of the lower die, gaps above and below, travel, step.
BILLETS = ((11.722, 5.082, 8, 0.05, -0.041, 0.0, 0.402, 0.05, 1.381, 0.1), (6.892, 8.363, 6, 0.1, -0.006, -0.009, 0.22, 0.176, 1.367, 0.1),
           (8.8895, 7.3276, 8, 0.2, -0.0435, 0.0, 0.3934, 0.1933, 1.7737, 0.05),
           (8.1759, 10.6468, 6, 0.2, -0.039, 0.0205, 0.3317, 0.1893, 2.4142, 0.1))


def turned(angle, *points):
    """Coordinates of points turned about the origin, as a deck has them."""
    c, s = math.cos(angle), math.sin(angle)
    return " ".join(f"{c*x - s*y!r} {s*x + c*y!r}" for x, y in points)


def moves(angle, travel):
    """Cards of an upper die that goes down along the turned axis."""
    return f"LIC x\n 0. 0. 1. {travel*math.sin(angle)!r}\nLIC y\n 0. 0. 1. {-travel*math.cos(angle)!r}\nMOVE up X x\nMOVE up Y y\n"


def last_force(run):
    """Size of the force of the upper die at the end."""
    return float(np.hypot(run.history["force_x_up"][-1], run.history["force_y_up"][-1]))


def free_billets(checks):
    """A billet between dies that lean and do not touch it yet, as drawn and turned by .6: it is pushed down, tips, lands and is upset."""
    worst = 0.0
    for k, (wide, high, n, friction, up, low, above, below, travel, step) in enumerate(BILLETS):
        forces = []
        for angle in (0.0, 0.6):
            corners = turned(angle, (-wide/2, 0), (wide/2, 0), (wide/2, high), (-wide/2, high))
            upper = turned(angle, *((x, high + above + up*x) for x in (4*wide, -4*wide)))
            lower = turned(angle, *((x, low*x - below) for x in (-4*wide, 4*wide)))
            forces.append(last_force(checks.run(f"free-billet-{k}-{angle}", deck(
                "PLSTN", "LOG", f"BLOCK b PL8LS 4 m\n {corners}\n {n} 1. {n} 1.\n", PLASTIC.replace("0.2", str(friction)),
                f"DIE up PILOT {turned(angle, (0, high + 1))}\n SEGM {upper}\nDIE low\n SEGM {lower}\nCNT2D b 1 2 3 4 up k\nCNT2D b 1 2 3 4 low k\n"
                + moves(angle, travel), f"STRAT {step/travel!r} 1.E-6 {step/travel!r} 6 3"))))
        worst = max(worst, abs(forces[1] - forces[0])/max(forces))
    return worst


def strip(angle, size, divisions, roller, gap, penalty, travel, step):
    """A strip (length, thickness) between three rollers (radius, span of the lower two) that an upper one pushes down, turned."""
    (long, thick), (radius, span) = size, roller
    corners = turned(angle, (-long/2, 0), (long/2, 0), (long/2, thick), (-long/2, thick))
    dies = ""
    for name, x, y, side in (("up", 0.0, thick + gap + radius, 1), ("left", -span/2, -gap - radius, -1), ("right", span/2, -gap - radius, -1)):
        pilot = f" PILOT {turned(angle, (x, y))}" if name == "up" else ""
        dies += f"DIE {name}{pilot}\n ARC {turned(angle, (x + side*radius, y), (x, y - side*radius), (x - side*radius, y))} 1.E-3\n"
    return deck("PLSTN", "LOG", f"BLOCK b PL8LS 4 m\n {corners}\n {divisions}\n",
                PLASTIC.replace("PENETR 1.E-3", penalty).replace("0.2", "0.1"),
                dies + "CNT2D b 3 up k\nCNT2D b 1 left k\nCNT2D b 1 right k\n" + moves(angle, travel), f"STRAT {step!r} 1.E-7 {step!r} 6 3")


def free_strip(checks):
    """A strip between three rollers that do not touch it yet, as drawn and turned by .6: it lands on two of them and is bent."""
    forces = [last_force(checks.run(f"free-strip-{angle}", strip(angle, (79.95, 0.5), "30 1. 2 1.", (6.49, 57.06), 0.2, "PENETR 1.E-3", 6.0, 0.03)))
              for angle in (0.0, 0.6)]
    return abs(forces[1] - forces[0])/max(forces)


def sheets_on_rollers(checks):
    """Sheets that press on rollers with ten-thousandths of what their penalties are made for, or land on them; beside them a penalty
    that is stated, a thousandth of that."""
    worst = 0.0
    for k, (thick, gap) in enumerate(((0.2, 0.0), (0.3, 0.0), (0.2, 0.3))):
        travel = 15 + 2*gap
        forces = [last_force(checks.run(f"sheet-{k}-{penalty[:3]}", strip(0.3, (84.0, thick), "120 1. 1 1.", (5.0, 60.0), gap, penalty, travel,
                                                                        0.3/travel))) for penalty in ("PENETR 1.E-3", "AKP 1000.")]
        worst = max(worst, abs(forces[1] - forces[0])/max(forces))
    return worst


def under_a_bead(checks):
    """A strip on two tables, one end held along them, that a bead between them begins to press down: its long free part lies on its
    table, and turns up against a plate point by point, in any step. The force on the bead is that of sides half as long."""
    forces = []
    for n, friction in ((40, 0.1), (80, 0.1), (40, 0.0), (80, 0.0)):
        run = checks.run(f"bead-{n}-{friction}", deck(
            "PLSTN", "LOG", f"BLOCK b PL8LS 4 m\n -60. 0. 20. 0. 20. 1. -60. 1.\n {n} 1. 2 1.\n",
            f"LAW m EPLA\n 200000. 0.3\n SWIFT 500. 0.01 0.2\nLAW k COUL2D\n PENETR 2.E-2 PHI {friction}\n",
            "DIE bead PILOT 0. 1.\n SEGM 5. 31. 5. 6.\n ARC 5. 6. 0. 1. -5. 6. 1.E-3\n SEGM -5. 6. -5. 31.\n"
            "DIE left\n SEGM -90. 0. -6.1 0.\n FILLT 3. 1.E-3\n SEGM -6.1 0. -6.1 -40.\n"
            "DIE right\n SEGM 6.1 -40. 6.1 0.\n FILLT 3. 1.E-3\n SEGM 6.1 0. 90. 0.\n"
            "DIE plate\n SEGM -7. 1.02 -90. 1.02\nDIE plates\n SEGM 90. 1.02 7. 1.02\n"
            "CNT2D b 3 bead k\nCNT2D b 1 left k\nCNT2D b 1 right k\nCNT2D b 3 plate k\nCNT2D b 3 plates k\n"
            "FIXED b 2 X\nMOVE bead Y go\nLIC go\n 0. 0. 0.3 -1.5\n", "STRAT 0.01 1.E-6 0.02 5 3"))
        forces.append(abs(run.history["force_y_bead"][-1]))
    return max(abs(forces[0]/forces[1] - 1), abs(forces[2]/forces[3] - 1))


def sheet_on_rubber(checks):
    """A stiff sheet that a punch presses into a pad a ten-thousandth to a hundred-thousandth as stiff, and which nothing else carries:
    the force, and the depth over the allowed, whichever of the two faces the other. Where the sheet faced the pad no step was found."""
    worst = 0.0
    for k, (state, pad, thick, radius, friction, travel) in enumerate((("PLSTN", 2, 2, 4, 0.2, 2.0), ("AXISYM", 2, 1, 4, 0.0, 4.0),
                                                                       ("PLSTN", 20, 1, 12, 0.1, 2.0))):
        forces = []
        for faces, faced in (("sheet 1", "pad 3"), ("pad 3", "sheet 1")):
            run = checks.run(f"on-rubber-{k}-{faces[:3]}", deck(
                state, "LOG", f"BLOCK sheet PL8LS 4 m\n 0. 20. 40. 20. 40. {20 + thick} 0. {20 + thick}\n 40 1. 3 1.\n"
                "BLOCK pad PL8LS 9 rubber MEAN\n 0. 0. 60. 0. 60. 20. 0. 20.\n 30 1. 8 1.\n",
                f"LAW m EPLA\n 200000. 0.3\n SWIFT 1500. 0.01 0.2\nLAW rubber ELA\n {pad} 0.45\nLAW k COUL2D\n PENETR 5.E-3 PHI {friction}\n",
                f"DIE punch PILOT 0. {20 + thick}\n SEGM {radius} 90. {radius} {20 + thick + radius}\n"
                f" ARC {radius} {20 + thick + radius} 0. {20 + thick} -{radius} {20 + thick + radius} 1.E-4\n"
                f"DIE other SIDES {faced}\nCNT2D sheet 3 punch k\nCNT2D {faces} other k\n"
                f"FIXED pad 1 XY\nFIXED pad 4 X\nFIXED sheet 4 X\nMOVE punch Y go\nLIC go\n 0. 0. 1. -{travel}\n", "STRAT 0.005 1.E-6 0.05 5 3"))
            forces.append(abs(run.history["force_y_punch"][-1]))
        worst = max(worst, abs(forces[0]/forces[1] - 1))
    return worst


def creeping_strip_let_go(checks):
    """A strip without elastic limit, bent between rollers and let go by the upper one: nothing holds it while it creeps back, and
    it does so in few iterations however slender it is. The die that goes back has no force."""
    run = checks.run("creeping-strip", deck(
        "PLSTN", "JAUMANN", "BLOCK b PL8LS 4 m\n 0. 0. 16.7859 0. 16.7859 0.6622 0. 0.6622\n 22 1. 2 1.\n",
        "LAW m EVP-NH\n 5000. 0.3\n 0. 5.049 0.5 0.1\nLAW k COUL2D\n PENETR 1.E-3 PHI 0.\n",
        "DIE d PILOT 0. 3.5028\n ARC 2.7838 2.9375 0. 0.6622 -2.7838 2.9375 1.E-3\n"
        "DIE e\n ARC 9.6282 -2.122 11.7502 0. 13.8721 -2.122 1.E-3\nCNT2D b 3 d k\nCNT2D b 1 e k\nFIXED b 4 X\n"
        "MOVE d Y go -5.9484\nLIC go\n 0. 0. 1. 1. 1.3 0.9\n", "STRAT 0.1 1.E-6 0.1 6 3"))
    return abs(run.history["force_y_d"][-1])/abs(run.history["force_y_d"]).max()


def heated_free(checks):
    """A plate heated on one side, that nothing holds and nothing touches: the stress of one that is just held, in as few steps."""
    runs = [checks.run(f"heated-{name}", deck(
        "PLSTS 1.", "LOG", "BLOCK b PL8LS 4 m\n 0. 0. 100. 0. 100. 5. 0. 5.\n 20 1. 3 1.\n",
        "LAW m ELATH\n 200000. 0.3 1.2E-5\nADDEL b PL8TM heat\nLAW heat HEAT\n 50. 3.6\nSTART T 20.\n",
        f"{held}IMPOS b 1 T hot 20.\nLIC hot\n 0. 1. 0.5 10. 1. 10.\nPROBE s MAX mises b\nPROBE u NODE UY 50. 0.\n", "STRAT 0.1 1.E-6 0.1 5 3"))
        for name, held in (("free", ""), ("held", "FIXED POINT 50. 0. XY\nFIXED POINT 100. 0. Y\n"))]
    free, held = (run.history for run in runs)
    if len(free["time"]) > 2*len(held["time"]):
        return 1.0
    # and it stays where it bows, by a tenth of its thickness at most
    peaks = [history["s"].max() for history in (free, held)]
    return max(abs(peaks[0]/peaks[1] - 1), float(abs(free["u"]).max() > 0.5))


def hook(checks):
    """A hook that snaps past a ledge, pushed by its foot; beside the same with the ledge moved: forces on the ledge before and after."""
    body = ("BLOCK b PL8LS 4 m\n 0. 0. 20. 0. 20. 1.5 0. 1.5\n 20 1. 2 1.\nBLOCK h PL8LS 4 m\n 20. 0. 23.5 0. 23.5 1.5 20. 1.5\n 4 1. 2 1.\n"
            "BLOCK k PL8LS 4 m\n 20. 1.5 23.5 1.5 21. 3. 20. 3.\n 4 1. 3 1.\nJOIN b 2 h 4\nJOIN h 3 k 1\n")
    ledge = ("DIE d\n SEGM 28. 10. 28. 2.\n FILLT .1 1.E-3\n SEGM 28. 2. 25. 2.\n FILLT .1 1.E-3\n SEGM 25. 2. 25. 10.\n"
             "CNT2D k 2 3 4 d c\nCNT2D h 2 d c\nCNT2D b 3 d c\n")
    laws = "LAW m ELA\n 2000. 0.35\nLAW c COUL2D\n PENETR 1.E-3 PHI 0.2\n"
    found = []
    for name, moves in (("foot", "MOVE b 4 X t 8.\nFIXED b 4 Y\n"), ("ledge", "MOVE d X t -8.\nFIXED b 4 XY\n")):
        run = checks.run(f"hook-{name}", deck("PLSTN", "LOG", body, laws, ledge + moves + "LIC t\n 0. 0. 0.8 0.8\n", "STRAT 0.01 1.E-6 0.02 5 3"))
        found.append(np.array([np.interp(t, run.history["time"], run.history["force_x_d"]) for t in (0.45, 0.7, 0.8)]))
    return float(abs(found[0]/found[1] - 1).max())


CASES = (Case("free billets under dies that lean", free_billets, 1e-3), Case("free strip on rollers", free_strip, 1e-4),
         Case("creeping strip let go", creeping_strip_let_go, 1e-9), Case("heated and free", heated_free, 1e-5),
         Case("strip under a bead", under_a_bead, 0.1),
         Case("sheets on rollers", sheets_on_rollers, 5e-4),
         Case("stiff sheet on rubber", sheet_on_rubber, 1e-2),
         Case("hook past a ledge", hook, 1e-2))
