"""Hard cases of solids: what makes programs fail that are right on easy ones. Each answers how far it is off, and its bound."""
import math

from hard_support import Case, LONG, PLASTIC, block, deck, np, report

STEEL = "LAW m ELA\n 200000. 0.3\n"


def limit_load(checks):
    """A thick cylinder without hardening under more pressure than it bears: the last equilibrium is at the limit (Hill 1950)."""
    limit = 2/math.sqrt(3)*250*math.log(2.0)
    run = checks.run("limit-load", deck(
        "PLSTN", "SMALL", block("100. 0. 200. 0. 0. 200. 0. 100.", "12 2. 12 1.", " SIDE 2 ARC 0. 0.\n SIDE 4 ARC 0. 0.\n"),
        "LAW m EPLA\n 200000. 0.3\n LINEAR 250. 0.\n", "FIXED b 1 Y\nFIXED b 3 X\nPRES2D b 4 3 400. p\nLIC p\n 0. 0. 1. 1.\n",
        "STRAT 0.02 1.E-6 0.02 5 3"), code=3)
    return abs(run.history["time"][-1]*400/limit - 1)


def deep_notch(checks):
    """A deeply notched strip pulled far beyond its limit load: the force stays at Prandtl's, it neither climbs nor falls."""
    run = checks.run("deep-notch", deck(
        "PLSTN", "SMALL", block("0. 0. 5. 0. 5. 40. 0. 40.", "10 1. 20 20.")
        + "BLOCK c PL8LS 4 m\n 5. 0. 40. 0. 40. 40. 5. 40.\n 14 20. 20 20.\nJOIN b 2 c 4\n",
        "LAW m EPLA\n 200000. 0.3\n LINEAR 250. 0.\n",
        "FIXED b 1 Y\nFIXED b 4 X\nMOVE b 3 Y go\nMOVE c 3 Y go\nLIC go\n 0. 0. 1. 0.6\nPROBE f REACT Y b 3\nPROBE g REACT Y c 3\n",
        "STRAT 0.02 1.E-6 0.05 5 3"))
    force, limit = run.history["f"] + run.history["g"], 5*2*250/math.sqrt(3)*(1 + math.pi/2)
    return max(abs(force[-1]/limit - 1), abs(force.max()/force[-1] - 1))


def penalties(checks):
    """A block pressed by a die with penalties from a hundredth to a million times its stiffness: two springs one after the other."""
    worst = 0.0
    for k, factor in enumerate((1e-2, 1.0, 1e2, 1e4, 1e6)):
        penalty = factor*200000/2.5
        run = checks.run(f"penalty-{k}", deck(
            "PLSTN", "SMALL", block("0. 0. 10. 0. 10. 10. 0. 10.", "4 1. 4 1."),
            f"LAW m ELA\n 200000. 0.\nLAW k COUL2D\n AKP {penalty!r} PHI 0.\n",
            "FIXED b 1 Y\nFIXED b 4 X\nDIE d PILOT 0. 10.\n SEGM 20. 10. -5. 10.\nCNT2D b 3 d k\nMOVE d Y go\nLIC go\n 0. 0. 1. -0.01\n",
            "STRAT 0.5 1.E-6 0.5 5 3"))
        expected = 0.01/(10/200000 + 1/penalty)*10
        worst = max(worst, abs(abs(run.history["force_y_d"][-1])/expected - 1))
    return worst


def rate_exponents(checks):
    """A Norton-Hoff bar pulled, from nearly without rate to linear in the rate: the stress is the law's at the strain rate of now."""
    worst = 0.0
    for k, m in enumerate((0.005, 0.05, 0.3, 1.0)):
        run = checks.run(f"rate-{k}", deck(
            "AXISYM", "LOG", block("0. 0. 5. 0. 5. 10. 0. 10.", "2 1. 2 1."),
            f"LAW m EVP-NH\n 200000. 0.3\n 0. 50. {m!r} 0.\n",
            "FIXED b 1 Y\nFIXED b 4 X\nMOVE b 3 Y go\nLIC go\n 0. 0. 1. 3.\nPROBE s POINT stress_yy 2. 5.\n", "STRAT 0.01 1.E-6 0.02 5 3"))
        rate = 3/13
        worst = max(worst, abs(run.history["s"][-1]/(50*math.sqrt(3)*(math.sqrt(3)*rate)**m) - 1))
    return worst


def stiffness_ratio(checks):
    """Two joined blocks, one a hundred million times stiffer: both give way as they should."""
    run = checks.run("stiffness-ratio", deck(
        "PLSTN", "SMALL", block("0. 0. 10. 0. 10. 5. 0. 5.", "3 1. 3 1.")
        + "BLOCK hard PL8LS 4 h\n 0. 5. 10. 5. 10. 10. 0. 10.\n 3 1. 3 1.\nJOIN b 3 hard 1\n",
        "LAW m ELA\n 1. 0.\nLAW h ELA\n 1.E8 0.\n",
        "FIXED b 1 Y\nFIXED b 4 X\nTRACT hard 3 Y -0.01 go\nLIC go\n 0. 0. 1. 1.\nPROBE u NODE UY 0. 5.\nPROBE a MAX stress_yy hard\nPROBE z MIN stress_yy hard\n",
        "STRAT 1. 1. 1. 5 3"))
    return max(abs(run.history["u"][-1]/-0.05 - 1), *(abs(run.history[name][-1]/-0.01 - 1) for name in "az"))


def full_turn(checks):
    """A bar glued to a die that turns once around: no stress, and every node where it began."""
    run = checks.run("full-turn", deck(
        "PLSTN", "LOG", block("0. 0. 4. 0. 4. 10. 0. 10.", "2 1. 5 1."), STEEL + "LAW k GLUE2D\n PENETR 1.E-3\n",
        "DIE d PILOT 0. 0.\n SEGM -5. 0. 10. 0.\nCNT2D b 1 d k\nMOVE d A go\nLIC go\n 0. 0. 1. 2*pi\n"
        "PROBE s MAX mises b\nPROBE ux NODE UX 4. 10.\nPROBE uy NODE UY 4. 10.\n", "STRAT 0.05 1.E-6 0.05 5 3"))
    return max(run.history["s"].max()/200000, abs(run.history["ux"][-1])/10, abs(run.history["uy"][-1])/10)


def axis_aspect(checks):
    """Elements on the axis, a hundred times as high as wide, pulled: the stress is uniform, as in a round bar."""
    run = checks.run("axis-aspect", deck(
        "AXISYM", "SMALL", block("0. 0. 1. 0. 1. 100. 0. 100.", "10 1. 10 1."), STEEL,
        "FIXED b 1 Y\nMOVE b 3 Y go\nLIC go\n 0. 0. 1. 0.1\nPROBE a MAX stress_yy b\nPROBE z MIN stress_yy b\nPROBE r MAX stress_xx b\n",
        "STRAT 1. 1. 1. 5 3"))
    a, z, r = (run.history[name][-1]/200.0 for name in "azr")
    return max(abs(a - 1), abs(z - 1), abs(r))


def off_centre(checks):
    """Middle nodes off the middle of their sides by a tenth: a uniform stress is still met exactly."""
    place = {1: (0, 0), 2: (4, 0), 3: (4, 3), 4: (0, 3), 5: (2.4, 0), 6: (4, 1.7), 7: (1.6, 3), 8: (0, 1.2),
             9: (9, 0), 10: (9, 3), 11: (6, 0), 12: (9, 1.3), 13: (7, 3)}
    rows = "".join(f" {k} {x!r} {y!r}\n" for k, (x, y) in place.items())
    run = checks.run("off-centre", deck(
        "PLSTN", "LOG", f"NODES\n{rows}PL8LS b 9 m\n 1 1 2 3 4 5 6 7 8\n 2 2 9 10 3 11 12 13 6\nSIDES low\n 1 1\n 2 1\nSIDES left\n 1 4\n"
        "SIDES right\n 2 2\n", STEEL, "FIXED low Y\nFIXED left X\nMOVE right X go\nLIC go\n 0. 0. 1. 0.9\n"
        "PROBE a MAX stress_xx b\nPROBE z MIN stress_xx b\nPROBE s MAX stress_yy b\n", "STRAT 0.5 0.1 0.5 5 3"))
    a, z, s = (run.history[name][-1] for name in "azs")
    return max(abs(a/z - 1), abs(s)/a)


def under_a_holder(checks):
    """A blank held by a force on its holder from the first step on, while the punch bends it: contact opens and closes point by
    point however short the step is (no first step converged within 20 iterations). The dies' forces are in balance."""
    run = checks.run("holder", deck(
        "AXISYM", "LOG", block("0. 0. 50. 0. 50. 1. 0. 1.", "60 1. 2 1."),
        "LAW m EPLA\n 200000. 0.3\n SWIFT 600. 0.01 0.2\nLAW k COUL2D\n PENETR 0.01 PHI 0.1 AUGMENT 10\n",
        "DIE punch\n SEGM 25. 60. 25. 1.\n FILLT 5. 1.E-3\n SEGM 25. 1. -1. 1.\n"
        "DIE ring\n SEGM 26.4 -60. 26.4 0.\n FILLT 6. 1.E-3\n SEGM 26.4 0. 80. 0.\n"
        "DIE holder PILOT 40. 1.\n SEGM 80. 1. 27. 1.\nCNT2D b 3 punch k\nCNT2D b 1 ring k\nCNT2D b 3 holder k\nFIXED b 4 X\n"
        "LIC go\n 0. 0. 1. -5.\nLIC on\n 0. 0. 0.04 1.\nMOVE punch Y go\nFORCE holder Y -8000. on\nSPRNG holder Y 1.\n",
        "STRAT 0.008 1.E-6 0.04 6 3"))
    forces = [run.history[f"force_y_{die}"] for die in ("punch", "holder", "ring")]
    return (abs(sum(forces))/abs(forces[2])).max()


def drawn_under_a_holder(checks):
    """A cup drawn from a blank under a holder: the contact of the flange is light, and a motion that goes straight on loses all of it,
    by less than the allowed penetration. The dies' forces are in balance, in at most 215 steps (268 where the prediction
    does not keep that contact)."""
    run = checks.run("drawn", deck(
        "AXISYM", "LOG", block("0. 0. 45. 0. 45. 1.5 0. 1.5", "80 1. 2 1."),
        "LAW m EPLA\n 200000. 0.3\n LINEAR 300. 300.\nLAW k COUL2D\n PENETR 1.E-3 PHI 0.05 AUGMENT 10\n",
        "DIE punch PILOT 0. 1.5\n SEGM 25. 60. 25. 1.5\n FILLT 5. 1.E-3\n SEGM 25. 1.5 -1. 1.5\n"
        "DIE ring\n SEGM 26.8 -60. 26.8 0.\n FILLT 6. 1.E-3\n SEGM 26.8 0. 80. 0.\n"
        "DIE holder PILOT 0. 1.5\n SEGM 80. 1.5 26.8 1.5\nCNT2D b 3 punch k\nCNT2D b 1 2 ring k\nCNT2D b 3 holder k\nFIXED b 4 X\n"
        "LIC go\n 0. 0. 1. -16.\nLIC on\n 0. 1. 1. 1.\nMOVE punch Y go\nFORCE holder Y -20000. on\n",
        "STRAT 0.002 1.E-6 0.02 6 3"))
    forces = [run.history[f"force_y_{die}"] for die in ("punch", "holder", "ring")]
    if not (abs(sum(forces))/abs(forces[2])).max() < 1e-4:
        raise RuntimeError("the forces of the dies are not in balance")
    return len(forces[0])/215


UPSET = ("BLOCK b PL8LS 4 m\n 0. 0. {r} 0. {r} {h} 0. {h}\n 6 1. 8 1.\n",
         "LAW m EPLA\n {e} 0.3\n LINEAR {y} {t}\nLAW k COUL2D\n PENETR 1.E-3 PHI 0.3\n",
         "FIXED b 1 Y\nFIXED b 4 X\nDIE d PILOT 0. {h}\n SEGM {w} {h} {l} {h}\nCNT2D b 2 3 d -3 k\nMOVE d Y go\nLIC go\n 0. 0. 1. {way}\n"
         "PROBE bulge NODE UX {r} 0.\n")


def upset(checks, name, length=1.0, stress=1.0, strat="STRAT 0.02 1.E-6 0.05 5 3", threads=1, code=0):
    """A billet with friction and a folding side, pressed to half its height, in units of this length and stress."""
    r, h, w, low, way = (repr(length*v) for v in (10.0, 15.0, 30.0, -1.0, -6.0))
    e, y, t = (repr(stress*v) for v in (200000.0, 700.0, 300.0))
    body, laws, loads = (part.format(r=r, h=h, w=w, l=low, way=way, e=e, y=y, t=t) for part in UPSET)
    return checks.run(name, deck("AXISYM", "LOG", body, laws, loads, strat), code=code, threads=threads)


def units(checks):
    """The same billet in mm-N-MPa and in m-N-Pa: the same numbers and as many iterations."""
    one, other = upset(checks, "units-mm"), upset(checks, "units-m", 1e-3, 1e6)
    if len(one.history["time"]) != len(other.history["time"]) or sum(one.history["iterations"]) != sum(other.history["iterations"]):
        return 1.0
    return max(np.abs(other.history["force_y_d"]/one.history["force_y_d"] - 1).max(),
               np.abs(other.history["bulge"]*1e3/one.history["bulge"] - 1).max())


def threads(checks):
    """The same billet by one, two, four and eight threads: the same bits."""
    runs = [upset(checks, f"threads-{n}", threads=n).history for n in (1, 2, 4, 8)]
    return 0.0 if all(np.array_equal(runs[0][c], run[c]) for run in runs[1:] for c in ("time", "force_y_d", "bulge", "iterations")) else 1.0


def long_steps(checks):
    """The same billet with a first step of the whole stroke: it recovers by cutting, and ends where short steps end."""
    one, other = upset(checks, "steps-short"), upset(checks, "steps-long", strat="STRAT 1. 1.E-6 1. 5 3")
    return max(abs(other.history[c][-1]/one.history[c][-1] - 1) for c in ("force_y_d", "bulge"))


def mirrored(checks):
    """A block pressed by a tilted die with friction, and its mirror image with elements in the other order, in the same steps."""
    runs = []
    for name, s in (("image", 1), ("mirror", -1)):
        left, right = (f"{s*-6.0!r}", f"{s*6.0!r}")
        corners = f"{left} 0. {right} 0. {right} 8. {left} 8." if s > 0 else f"{right} 0. {left} 0. {left} 8. {right} 8."
        a, b = (12.0, 8.0), (-12.0, 10.0)
        piece = f" SEGM {a[0]!r} {a[1]!r} {b[0]!r} {b[1]!r}\n" if s > 0 else f" SEGM {-b[0]!r} {b[1]!r} {-a[0]!r} {a[1]!r}\n"
        runs.append(checks.run(name, deck(
            "PLSTN", "LOG", block(corners, "6 1. 4 1."), PLASTIC, f"FIXED b 1 XY\nDIE d PILOT 0. 9.\n{piece}CNT2D b 2 3 4 d -3 k\n"
            f"MOVE d Y go\nLIC go\n 0. 0. 1. -2.5\nPROBE u NODE UY {s*6.0!r} 8.\nNORMS PATH 0. RATE 0.\n",
            "STRAT 0.02 1.E-6 0.05 5 3")).history)
    one, other = runs
    if len(one["time"]) != len(other["time"]):
        return 1.0
    size = abs(one["force_y_d"]).max()
    return max(abs(one["force_y_d"] - other["force_y_d"]).max()/size, abs(one["force_x_d"] + other["force_x_d"]).max()/size,
               abs(one["u"][-1]/other["u"][-1] - 1))


def friction_alone(checks):
    """A block that two dies hold by friction alone, pushed sideways by four fifths of what friction bears: it stays."""
    run = checks.run("friction-alone", deck(
        "PLSTN", "LOG", block("0. 0. 10. 0. 10. 6. 0. 6.", "6 1. 4 1."), STEEL + "LAW k COUL2D\n PENETR 1.E-3 PHI 0.25\n",
        "DIE low\n SEGM -5. 0. 20. 0.\nDIE up PILOT 0. 6.\n SEGM 20. 6. -5. 6.\nCNT2D b 1 low k\nCNT2D b 3 up k\n"
        "MOVE up Y grip\nLIC grip\n 0. 0. 1. -0.01 2. -0.01\nTRACT b 4 X 1. push\nLIC push\n 0. 0. 1. 0. 2. 20.\n"
        "PROBE u NODE UX 0. 3.\n", "STRAT 0.1 1.E-6 0.1 5 3"))
    grip = abs(run.history["force_y_up"][-1])
    balance = abs(run.history["force_x_up"][-1] + run.history["force_x_low"][-1])/120 - 1
    return max(abs(balance), abs(run.history["u"][-1])/10, 0.0 if 120 < 2*0.25*grip else 1.0)


def contact_again(checks):
    """A die presses a billet, leaves it, and presses it again as far: the force of before, as the metal answers elastically."""
    run = checks.run("contact-again", deck(
        "AXISYM", "LOG", block("0. 0. 10. 0. 10. 15. 0. 15.", "5 1. 7 1."), PLASTIC.replace("PHI 0.2", "PHI 0."),
        "FIXED b 1 Y\nFIXED b 4 X\nDIE d PILOT 0. 15.\n SEGM 30. 15. -1. 15.\nCNT2D b 2 3 d -3 k\nMOVE d Y go\n"
        "LIC go\n 0. 0. 1. -3. 2. 5. 3. -3.\n", "STRAT 0.02 1.E-6 0.1 5 3"))
    time, force = run.history["time"], run.history["force_y_d"]
    first, gap, again = (force[np.argmin(abs(time - t))] for t in (1, 2, 3))
    return max(abs(again/first - 1), abs(gap/first))


def released(checks):
    """A billet pressed between two dies that then let it go, in the plane and round: it rests where it was, and is pressed again."""
    worst = 0.0
    for state, axis in (("PLSTN", ""), ("AXISYM", "FIXED b 4 X\n")):
        run = checks.run("released-" + state.lower(), deck(
            state, "LOG", block("0. 0. 10. 0. 10. 10. 0. 10.", "4 1. 4 1."), PLASTIC,
            "DIE low\n SEGM -5. 0. 20. 0.\nDIE up PILOT 0. 10.\n SEGM 20. 10. -5. 10.\nCNT2D b 1 low k\nCNT2D b 3 up k\n"
            "MOVE up Y go\nMOVE low Y lift\nLIC go\n 0. 0. 1. -2. 2. 3. 3. -2.\nLIC lift\n 0. 0. 1. 0. 2. -3. 3. 0.\n" + axis
            + "PROBE x NODE X 10. 0.\nPROBE y NODE Y 10. 10.\n", "STRAT 0.02 1.E-6 0.1 5 3"))
        time, force = run.history["time"], run.history["force_y_up"]
        free = (time > 1.2) & (time < 2.8)
        for name in ("x", "y"):
            worst = max(worst, np.ptp(run.history[name][free])/10)
        worst = max(worst, abs(force[free]).max()/abs(force).max(), 0.0 if force[-1] > 0.8*force.max() else 1.0)
    return worst


def lifts_off(checks):
    """A die that presses a billet goes back at once or after a while, by half its way or far beyond it: no step is cut."""
    cuts = 0
    for k, way in enumerate(("1.05 -2.5", "1.05 20.", "1.1 -3. 1.2 2.")):
        for name, law in (("slip", PLASTIC), ("stick", PLASTIC.replace("PHI 0.2", "M 0.9 AUGMENT 10"))):
            cuts += report(checks.run(f"lifts-off-{k}-{name}", deck(
                "PLSTN", "LOG", block("0. 0. 10. 0. 10. 15. 0. 15.", "5 1. 7 1."), law,
                "FIXED b 1 Y\nFIXED b 4 X\nDIE d PILOT 0. 15.\n SEGM 30. 15. -5. 15.\nCNT2D b 2 3 d k\nMOVE d Y go\n"
                f"LIC go\n 0. 0. 1. -3. {way}\n", "STRAT 0.02 1.E-6 0.05 6 3")))["cutbacks"]
    return cuts


def another_press_turns(checks):
    """A punch with a fillet goes on into one part, another press to and fro on a second one; a bar is pulled to and fro by its end."""
    law = PLASTIC.replace("200000. 0.3\n LINEAR 300. 500.", "70000. 0.33\n LINEAR 200. 100.").replace("PHI 0.2", "PHI 0.1")
    strat = "STRAT 0.01 1.E-6 0.02 6 3"
    part = block("0. 0. 10. 0. 10. 10. 0. 10.", "6 1. 6 1.")
    other = block("20. 0. 30. 0. 30. 10. 20. 10.", "6 1. 6 1.").replace("BLOCK b", "BLOCK c")
    runs = (checks.run("another-press", deck(
        "PLSTN", "LOG", part + other, law,
        "DIE one PILOT 0. 10.\n SEGM 8. 30. 8. 10.\n FILLT 2. 1.E-3\n SEGM 8. 10. -5. 10.\n"
        "DIE two PILOT 20. 10.\n SEGM 35. 10. 15. 10.\nCNT2D b 3 one -3 k\nCNT2D c 3 two -3 k\nFIXED b 1 XY\nFIXED c 1 XY\n"
        "LIC go\n 0. 0. 1. -4.\nLIC turn\n 0. 0. .2 -.5 .3 -.48 .4 -.8 .5 -.78 .6 -1.1 .7 -1.08 .8 -1.4 .9 -1.38 1. -1.7\n"
        "MOVE one Y go\nMOVE two Y turn\n", strat)),
        checks.run("pulled-often", deck(
            "PLSTN", "LOG", block("0. 0. 10. 0. 10. 10. 0. 10.", "4 1. 4 1."), "LAW m EPLA\n 70000. 0.33\n LINEAR 200. 100.\n",
            "FIXED b 1 XY\nMOVE b 3 Y go\nLIC go\n 0. 0. .1 .5 .2 .48 .3 .8 .4 .3 .5 1. .6 .5 .8 1.3 1. -.5\n", strat)))
    # 240 and 170; 319 and 182 where all went back with a die that turns, and none with a support
    return max(report(run)["iterations"]/most for run, most in zip(runs, (280, 176)))


def wall_peels(checks):
    """A slender wall that lies on its punch meets a ring and peels off, point by point: in one step, whose iterations go on."""
    run = checks.run("wall-peels", deck(
        "PLSTN", "LOG", block("0. 0. 1. 0. 1. 30. 0. 30.", "4 1. 60 1."),
        "LAW m EPLA\n 200000. 0.3\n LINEAR 300. 500.\nLAW k COUL2D\n PENETR 1.E-3 PHI 0.05 AUGMENT 10\n",
        "DIE punch PILOT 0. 0.\n SEGM 0. 60. 0. -5.\nDIE ring\n SEGM .85 -40. .85 -3.\n FILLT 2. 1.E-3\n"
        " SEGM .85 -3. 2.5 -3+1.65/tan(12*pi/180)\nCNT2D b 4 punch -3 k\nCNT2D b 2 ring k\nMOVE punch Y go\nMOVE b 1 Y go\n"
        "LIC go\n 0. 0. 1. -25.\nSTOP .1\n", "STRAT 0.002 1.E-7 0.01 6 3"))
    return report(run)["cutbacks"]


def lifted_off(checks):
    """A block is lifted by its top off a fixed die or another body, at once or after it has lain there: no force, few steps are cut."""
    cuts, worst = 0, 0.0
    for k, (way, below) in enumerate((("0. 0. 1. 0.1", "SEGM -5. 0. 13. 0.\n"), ("0. 0. 1. 0. 1.5 0.1 2. 0.2", "SEGM -5. 0. 13. 0.\n"),
                                      ("0. 0. 1. 0.1", "SIDES low 3\n"))):
        low = block("-2. -4. 10. -4. 10. 0. -2. 0.", "9 1. 4 1.").replace("BLOCK b", "BLOCK low") if "low" in below else ""
        run = checks.run(f"lifted-{k}", deck(
            "PLSTN", "LOG", block("0. 0. 8. 0. 8. 4. 0. 4.", "8 1. 4 1.") + low, PLASTIC.replace("PHI 0.2", "PHI 0.1 AUGMENT 20"),
            ("FIXED low 1 XY\n" if low else "") + f"DIE d{' ' if low else chr(10) + '   '}{below}CNT2D b 1 d k\nFIXED b 3 X\nMOVE b 3 Y go\nLIC go\n {way}\n"
            "PROBE f REACT Y b 3\n", "STRAT 0.1 1.E-6 0.1 5 3"))
        cuts += report(run)["cutbacks"]
        worst = max(worst, *abs(run.history["f"]))
    return max(cuts - 5, worst/1000)


def slides_off_an_edge(checks):
    """Points that slide off the edge of a flat punch lose their pressure; multipliers do not hold it, and the books of energy close."""
    worst = 0.0
    for k, (radius, height, edge, way) in enumerate(((17.392, 8.698, 10.4354, -2.1745), (17.3923, 8.6981, 10.4354, -2.17454))):
        run = checks.run(f"off-edge-{k}", deck(
            "AXISYM", "LOG", block(f"0. 0. {radius} 0. {radius} {height} 0. {height}", "8 1. 6 1."),
            "LAW m EPLA\n 200000. 0.3\n LINEAR 100. 50.\nLAW k COUL2D\n PENETR 1.E-3 M 0.1 AUGMENT 20\n",
            f"DIE d PILOT 0. {height}\n SEGM {edge} 26.094 {edge} {height}\n SEGM {edge} {height} -1. {height}\nCNT2D b 2 3 d k\nMOVE d Y go\n"
            f"FIXED b 1 Y\nFIXED b 4 X\nLIC go\n 0. 0. 1. {way}\n", "STRAT 0.005 1.E-6 0.04 6 3"))
        worst = max(worst, abs(report(run)["checks"]["energy_imbalance"]))
    return worst


def lets_go(checks):
    """A closed die goes back from a full flange: its flash loses contact first and is pushed out by what is inside, however little the die
    moves; damped steps find the way, the books close, and at the end nothing presses. Once with temperatures in turns."""
    worst = 0.0
    warm = "".join(f"ADDEL {body} PL8TM h BILINEAR\n" for body in ("b", "core", "flash")) + "LAW h HEAT\n 20. 3.6\nSTART T 20.\nSOLVE ONCE\n"
    for name, phi, press, more in (("less", 0.15, 0.15, ""), ("more", 0.2, 0.25, ""), ("warm", 0.15, 0.15, warm)):
        run = checks.run(f"lets-go-{name}", deck(
            "AXISYM", "LOG", block("0. 0. 12. 0. 12. 1. 0. 1.", "12 1. 2 1.")
            + block("0. 1. 12. 1. 12. 9. 0. 9.", "12 1. 8 1.").replace("BLOCK b", "BLOCK core")
            + block("12. 0. 19. 0. 19. 1. 12. 1.", "14 1. 2 1.").replace("BLOCK b", "BLOCK flash") + "JOIN b 3 core 1\nJOIN b 2 flash 4\n",
            f"LAW m EPLA\n 200000. 0.3\n SWIFT 500. 0.01 0.18\n{more}LAW k COUL2D\n PENETR 1.E-3 PHI {phi} AUGMENT 10\n",
            "DIE base\n SEGM -10. 0. 40. 0.\nCNT2D b 1 base k\nCNT2D flash 1 2 base k\n"
            "DIE top PILOT 0. 9.\n SEGM 40. 1. 12.05 1.\n FILLT 0.4 1.E-3\n SEGM 12.05 1. 12. 9.\n SEGM 12. 9. -10. 9.\n"
            "CNT2D core 2 3 top k\nCNT2D flash 2 3 top k\nFIXED b 4 X\nFIXED core 4 X\nMOVE top Y down\n"
            f"LIC down\n 0. 0. 1. {-press} 2. 2.\n", "STRAT 0.005 1.E-6 0.02 6 3"))
        if "top withdraws" not in run.said:
            raise RuntimeError(run.said)
        books, force = report(run)["energy"], abs(run.history["force_y_top"])
        if not books["damping"] > 0:
            raise RuntimeError("no step was damped")
        worst = max(worst, abs(report(run)["checks"]["energy_imbalance"]), force[-1]/max(force))
    return worst


def driven_on(checks):
    """A block on a table that goes down, pushed by more than friction holds from .7 on: no release of what was stored, but no equilibrium,
    whatever is damped; the run says so soon after."""
    run = checks.run("driven-on", deck(
        "PLSTN", "LOG", block("0. 0. 10. 0. 10. 5. 0. 5.", "8 1. 4 1."), "LAW m ELA\n 1000. 0.3\nLAW k COUL2D\n PENETR 1.E-3 PHI 0.2\n",
        "DIE table PILOT 0. 0.\n SEGM -100. 0. 100. 0.\nCNT2D b 1 table k\nTRACT b 3 Y -10. weight\nTRACT b 4 X 6. push\nMOVE table Y down\n"
        "LIC weight\n 0. 0. 0.1 1. 2. 1.\nLIC push\n 0. 0. 0.1 0. 1. 1.\nLIC down\n 0. 0. 0.1 0. 1. -1.\n", "STRAT 0.01 1.E-6 0.05 5 3"), 3)
    if "nothing holds it" not in run.said:
        raise RuntimeError(run.said)
    return abs(run.history["time"][-1] - 0.7)


def past_the_end(checks):
    """A block under a weight dragged over the open end of its table and back: it stays whole, and the force is friction's."""
    run = checks.run("past-the-end", deck(
        "PLSTN", "LOG", block("-20. 0. 20. 0. 20. 10. -20. 10.", "10 1. 3 1."), STEEL + "LAW k COUL2D\n PENETR 1.E-3 PHI 0.2\n",
        "DIE table\n SEGM -60. 0. 25. 0.\nCNT2D b 1 table -3 k\nTRACT b 3 Y -10. weight\nLIC weight\n 0. 0. 0.1 1. 3. 1.\n"
        "MOVE b 4 X drag\nLIC drag\n 0. 0. 0.1 0. 1. 12. 2. 0. 3. -3.\nPROBE f REACT X b 4\n", "STRAT 0.01 1.E-6 0.05 5 3"))
    time, force = run.history["time"], run.history["f"]
    return max(abs(force[np.argmin(abs(time - t))]/(s*80) - 1) for t, s in ((1.0, 1), (2.0, -1), (3.0, -1)))


def round_a_fillet(checks):
    """A bar pushed through a die whose cone begins and ends in fillets: iterations over steps, points slide round the bends."""
    run = checks.run("fillet", deck(
        "AXISYM", "LOG", "PARAM rise 0.5/tan(15*pi/180)\n" + block("0. $rise 5. $rise 5. 25. 0. 25.", "5 1. 24 1."),
        "LAW m EPLA\n 70000. 0.33\n LINEAR 200. 50.\nLAW k COUL2D\n PENETR 1.E-3 PHI 0.05 AUGMENT 10\n",
        "DIE d\n SEGM 4.5 -20. 4.5 0.\n FILLT 2. 1.E-3\n SEGM 4.5 0. 5. $rise\n FILLT 2. 1.E-3\n"
        " SEGM 5. $rise 5. 30.\nDIE p PILOT 0. 25.\n SEGM 6. 25. -1. 25.\nCNT2D b 1 2 d -3 k\nCNT2D b 3 p -3 k\nFIXED b 4 X\n"
        "MOVE p Y go\nLIC go\n 0. 0. 1. -8.\n", "STRAT 0.002 1.E-6 0.02 6 3"))
    return run.history["iterations"].mean()


def stick_slip(checks):
    """A block driven to and fro on a table: the force is friction's on every way, and friction never gives work back."""
    run = checks.run("stick-slip", deck(
        "PLSTN", "LOG", block("-20. 0. 20. 0. 20. 10. -20. 10.", "8 1. 2 1."), STEEL + "LAW k COUL2D\n PENETR 1.E-3 PHI 0.3\n",
        "DIE table\n SEGM -60. 0. 60. 0.\nCNT2D b 1 table -3 k\nTRACT b 3 Y -10. weight\nLIC weight\n 0. 0. 0.1 1. 5. 1.\n"
        "MOVE b 4 X drag\nLIC drag\n 0. 0. 0.1 0. 1. 1. 2. -1. 3. 1. 4. -1. 5. 0.\nPROBE f REACT X b 4\n", "STRAT 0.02 1.E-6 0.1 5 3"))
    time, force = run.history["time"], run.history["f"]
    least = report(run)["checks"]["least_dissipation"]
    return max(max(abs(force[np.argmin(abs(time - t))]/(s*120) - 1) for t, s in ((1, 1), (2, -1), (3, 1), (4, -1), (5, 1))),
               0.0 if least > -1e-12 else 1.0)


def ends_on_the_axis(checks):
    """A ball pressed into an elastic block and taken back: its arc ends on the axis, where the parabola has a slope that the arc has not. The node
    on the axis was now on its last piece and now beyond its end, and the way back ended at half of it; as of a ball that goes on beyond the axis."""
    forces = []
    for name, more in (("ends", ""), ("goes-on", " SEGM 0. 12. -1. 12.\n")):
        run = checks.run("axis-" + name, deck(
            "AXISYM", "LOG", block("0. 0. 15. 0. 15. 12. 0. 12.", "15 1. 10 1."),
            STEEL + "LAW k COUL2D\n PENETR 1.E-3 PHI 0.2 AUGMENT 10\n",
            "FIXED b 1 Y\nFIXED b 4 X\nDIE ball PILOT 0. 12.\n ARC 5. 17. 5*sin(.8) 17-5*cos(.8) 0. 12. 1.E-3\n" + more
            + "CNT2D b 3 ball k\nMOVE ball Y go\nLIC go\n 0. 0. 1. -0.05 2. 0.\n", "STRAT 0.004 1.E-6 0.04 6 3"))
        forces.append(max(abs(run.history["force_y_ball"])))
    return abs(forces[0]/forces[1] - 1)


def on_a_soft_pad(checks):
    """A strip of steel pressed into a pad of rubber, ten thousand times softer: no step was found where the strip faces the pad, as penalties were
    those of steel. Whichever of them faces the other, the force is the same."""
    forces = []
    for name, faces in (("strip", "DIE face SIDES pad 3\nCNT2D b 1 face k\n"), ("pad", "DIE face SIDES b 1\nCNT2D pad 3 face k\n")):
        run = checks.run("soft-" + name, deck(
            "PLSTN", "LOG", block("0. 0. 30. 0. 30. 2. 0. 2.", "45 1. 4 1.")
            + "BLOCK pad PL8LS 9 rubber MEAN\n 0. -10. 30. -10. 30. 0. 0. 0.\n 20 1. 6 1.\nLAW rubber ELA\n 20. 0.49\n", PLASTIC.replace("PHI 0.2", "PHI 0.1 AUGMENT 10"),
            faces + "FIXED pad 1 XY\nFIXED pad 2 4 X\nFIXED b 4 X\nDIE punch PILOT 0. 2.\n ARC 6. 8. 6*sin(pi/4) 8-6*cos(pi/4) 0. 2. 1.E-3\n"
            "CNT2D b 3 punch k\nMOVE punch Y go\nLIC go\n 0. 0. 1. -2.\n", "STRAT 0.004 1.E-6 0.04 6 3"))
        forces.append(run.history["force_y_punch"][-1])
    return abs(forces[0]/forces[1] - 1)


def s_shaped(checks):
    """A block pressed into an S-shaped die of parabolas by a second of the same shape: it runs, and keeps its volume."""
    run = checks.run("s-shaped", deck(
        "PLSTN", "LOG", block("0. 4. 30. 4. 30. 7. 0. 7.", "30 1. 3 1."), PLASTIC,
        "DIE low\n PARAB -2. 0. 6.5 -4. 15. 0.\n PARAB 15. 0. 23.5 4. 32. 0.\n"
        "DIE up PILOT 0. 7.\n PARAB 32. 11. 23.5 15. 15. 11.\n PARAB 15. 11. 6.5 7. -2. 11.\n"
        "CNT2D b 1 low k\nCNT2D b 3 up k\nMOVE up Y go\nLIC go\n 0. 0. 1. -7.6\nFIXED POINT 15. 4. X\n", "STRAT 0.01 1.E-6 0.02 5 3"))
    return abs(report(run)["checks"]["volume_drift_unloaded"])


def thin_rib(checks):
    """A rib of half an element's width pressed into a block: the force is that of elements a third as wide within a half."""
    forces = []
    for name, n in (("rib-coarse", 8), ("rib-fine", 24)):
        run = checks.run(name, deck(
            "PLSTN", "LOG", block("0. 0. 8. 0. 8. 6. 0. 6.", f"{n} 1. {3*n//4} 1."), PLASTIC,
            "FIXED b 1 Y\nFIXED b 4 X\nFIXED b 2 X\nDIE rib PILOT 0. 6.\n SEGM 0.5 20. 0.5 6.5\n ARC 0.5 6.5 0.5-0.5*(1-sqrt(0.5)) 6.5-0.5*sqrt(0.5) 0. 6. 1.E-3\n"
            " SEGM 0. 6. -1. 6.\nCNT2D b 3 rib k\nMOVE rib Y go\nLIC go\n 0. 0. 1. -0.5\n", "STRAT 0.02 1.E-6 0.02 5 3"))
        forces.append(abs(run.history["force_y_rib"][-1]))
    return abs(forces[0]/forces[1] - 1)


def slender(checks, name, body, loads, strat):
    """A slender part that one or two points of contact hold: cuts over steps, and that the books of energy close."""
    summary = report(checks.run(name, deck("PLSTN", "LOG", body, PLASTIC.replace("PHI 0.2", "PHI 0.1"), loads, strat)))
    return summary["cutbacks"]/summary["steps"] + (0.0 if abs(summary["checks"]["energy_imbalance"]) < 0.01 else 1.0)


def round_a_pin(checks):
    """A clamped beam bent round a pin that slides along it: cuts over steps (0.44 where a lost die was not touched again)."""
    return slender(checks, "pin", block("0. 0. 50. 0. 50. 1. 0. 1.", "50 1. 2 1."),
                   "FIXED b 4 XY\nDIE pin PILOT 45. 4.\n ARC 48. 4. 45. 1. 42. 4. 1.E-3\nCNT2D b 3 pin k\nMOVE pin Y down\nMOVE pin X left\n"
                   "LIC down\n 0. 0. 1. -35.\nLIC left\n 0. 0. 0.3 -3. 1. -20.\n", "STRAT 0.01 1.E-7 0.02 5 3")


def three_point_bending(checks):
    """A strip bent between three rollers and let go: cuts over steps (0.28 where searches ended after six shares)."""
    return slender(checks, "bending", block("0. 0. 40. 0. 40. 2. 0. 2.", "40 1. 3 1."),
                   "FIXED b 4 X\nDIE punch PILOT 0. 2.\n ARC 5. 7. 5*sin(pi/4) 7-5*cos(pi/4) 0. 2. 1.E-3\n"
                   " ARC 0. 2. -5*sin(pi/4) 7-5*cos(pi/4) -5. 7. 1.E-3\nDIE rest\n ARC 25. -5. 30-5*sin(pi/4) -5+5*cos(pi/4) 30. 0. 1.E-3\n"
                   " ARC 30. 0. 30+5*sin(pi/4) -5+5*cos(pi/4) 35. -5. 1.E-3\nCNT2D b 3 punch k\nCNT2D b 1 rest k\nMOVE punch Y go\n"
                   "LIC go\n 0. 0. 1. -15. 2. 0.\n", "STRAT 0.01 1.E-7 0.05 5 3")


def rolling(checks):
    """A strip drawn in by a roll that turns, a fifth thinner behind it: its length grows as its height falls (plane strain)."""
    run = checks.run("rolling", deck(
        "PLSTN", "LOG", block("-30. 0. 0. 0. 0. 2. -30. 2.", "40 1. 3 1."), PLASTIC.replace("PHI 0.2", "PHI 0.3"),
        "FIXED b 1 Y\nDIE roll PILOT 10. 41.6\n"
        " ARC 10+40*sin(0.6) 41.6-40*cos(0.6) 10. 1.6 10-40*sin(0.6) 41.6-40*cos(0.6) 1.E-3\n"
        " ARC 10-40*sin(0.6) 41.6-40*cos(0.6) 10-40*sin(1.1) 41.6-40*cos(1.1) 10-40*sin(1.6) 41.6-40*cos(1.6) 1.E-3\nCNT2D b 2 3 roll k\nMOVE roll A turn\n"
        "LIC turn\n 0. 0. 1. 0.9\nMOVE b 4 X push\nLIC push\n 0. 0. 0.1 3. 1. 33.\nPROBE h NODE Y -15. 2.\nPROBE a NODE X -20. 1.\n"
        "PROBE c NODE X -10. 1.\n", "STRAT 0.005 1.E-6 0.02 5 3"))
    lengths = run.history["c"] - run.history["a"]
    return max(abs(run.history["h"][-1]/2*lengths[-1]/lengths[0] - 1), abs(run.history["h"][-1]/1.6 - 1))


def rocking_die(checks):
    """A block between dies of constant-factor friction, the upper one rocking while it comes down: corners slide, stick and slide
    back. With PHI 1 it goes to the end on two meshes, with the force of both (with M alone there need not be an equilibrium)."""
    forces = []
    for name, divisions, m in (("coarse", "20 1. 8 1.", 0.2), ("fine", "30 1. 12 1.", 0.2), ("rough", "20 1. 8 1.", 0.6)):
        run = checks.run("rocking-die-" + name, deck(
            "PLSTN", "LOG", block("-10. 0. 10. 0. 10. 8. -10. 8.", divisions),
            f"LAW m EPLA\n 70000. 0.33\n SWIFT 200. 0.02 0.15\nLAW k COUL2D\n PENETR 1.E-3 M {m} PHI 1.\n",
            "DIE up PILOT 0. 8.\n SEGM 40. 8. -40. 8.\nDIE low\n SEGM -40. 0. 40. 0.\nCNT2D b 2 3 4 up k\nCNT2D b 1 2 4 low k\n"
            "FIXED POINT 0. 0. X\nMOVE up Y down\nMOVE up A rock\nLIC down\n 0. 0. 2. -2.\nLIC rock\n 0. 0. 0.5 0.05 1.5 -0.05 2. 0.\n",
            "STRAT 0.01 1.E-7 0.05 5 3"))
        forces.append(run.history["force_y_up"][-1])
    return abs(forces[0]/forces[1] - 1)


def nearly_incompressible(checks):
    """Lame's cylinder, nu = 0.49999: the displacement of the bore is that of the closed form."""
    nu, young, a, b, p = 0.49999, 1000.0, 4.0, 10.0, 10.0
    run = checks.run("nearly-incompressible", deck(
        "AXISYM", "SMALL", block("4. 0. 10. 0. 10. 1. 4. 1.", "5 1. 1 1."), f"LAW m ELA\n 1000. {nu!r}\n",
        "FIXED b 1 3 Y\nPRES2D b 4 2 10. go\nLIC go\n 0. 0. 1. 1.\nPROBE u NODE UX 4. 0.\n", "STRAT 1. 1. 1. 5 3"))
    exact = (1 + nu)/young*p*a*a/(b*b - a*a)*((1 - 2*nu)*a + b*b/a)
    return abs(run.history["u"][-1]/exact - 1)


def past_the_peak(checks):
    """A bar without a flaw pulled to three times the strain of the largest force: it stays a bar, the force falls as Considere says."""
    e, y, h = 200000.0, 500.0, 500.0
    run = checks.run("past-the-peak", deck(
        "AXISYM", "LOG", block("0. 0. 5. 0. 5. 20. 0. 20.", "4 1. 10 1."), f"LAW m EPLA\n {e!r} 0.3\n LINEAR {y!r} {h!r}\n",
        "FIXED b 1 Y\nFIXED b 4 X\nMOVE b 3 Y go\nLIC go\n 0. 0. 1. 20.\nPROBE f REACT Y b 3\nPROBE r NODE X 5. 0.\nPROBE top NODE X 5. 20.\n",
        "STRAT 0.01 1.E-6 0.05 5 3"))
    strain = math.log(2.0)
    stress = (y + h*strain)/(1 + h/e)
    force = math.pi*25*stress/2
    return max(abs(run.history["f"][-1]/force - 1), abs(run.history["r"][-1]/run.history["top"][-1] - 1),
               float(run.history["f"][-1] > 0.9*run.history["f"].max()))


def other_solver(checks):
    """The billet with MUMPS in the place of FRONT: the same path."""
    one = upset(checks, "solver-front")
    other = upset(checks, "solver-mumps", strat="STRAT 0.02 1.E-6 0.05 5 3\nSOLVR MUMPS")
    if len(one.history["time"]) != len(other.history["time"]):
        return 1.0
    return max(np.abs(other.history[c]/one.history[c] - 1).max() for c in ("force_y_d", "bulge"))


def joined(checks):
    """A billet between sticking plates as one block, and as three blocks in another order, joined: other numbers, the same force."""
    law, strat = "LAW m EPLA\n 200000. 0.3\n LINEAR 300. 500.\n", "STRAT 0.05 1.E-6 0.05 5 3\nNORMS FORCE 1.E-10 DISPL 1.E-10 PATH 0 RATE 0"
    one = checks.run("one-block", deck(
        "AXISYM", "LOG", block("0. 0. 10. 0. 10. 12. 0. 12.", "4 1. 6 1."), law,
        "FIXED b 1 Y\nFIXED b 4 X\nFIXED b 3 X\nMOVE b 3 Y go\nLIC go\n 0. 0. 1. -3.\nPROBE f REACT Y b 3\n", strat))
    three = checks.run("three-blocks", deck(
        "AXISYM", "LOG", "BLOCK c PL8LS 4 m\n 0. 8. 10. 8. 10. 12. 0. 12.\n 4 1. 2 1.\nBLOCK b PL8LS 4 m\n 10. 0. 10. 4. 0. 4. 0. 0.\n 2 1. 4 1.\n"
        "BLOCK d PL8LS 4 m\n 0. 8. 0. 4. 10. 4. 10. 8.\n 2 1. 4 1.\nJOIN b 2 d 2\nJOIN d 4 c 1\n", law,
        "FIXED b 4 Y\nFIXED b 3 X\nFIXED c 4 X\nFIXED d 1 X\nFIXED c 3 X\nMOVE c 3 Y go\nLIC go\n 0. 0. 1. -3.\nPROBE f REACT Y c 3\n", strat))
    return np.abs(three.history["f"]/one.history["f"] - 1).max()


def pressed_often(checks):
    """A block pressed into its plastic range and let go, five times to the same depth: from the second time on it is elastic, and
    every time it bears the same."""
    times = "".join(f" {k}. {-0.1*(k % 2)!r}\n" for k in range(11))
    run = checks.run("pressed-often", deck(
        "PLSTN", "LOG", block("0. 0. 10. 0. 10. 10. 0. 10.", "4 1. 4 1."), "LAW m EPLA\n 200000. 0.3\n LINEAR 300. 500.\nLAW k COUL2D\n PENETR 1.E-4 PHI 0.\n",
        "FIXED b 1 Y\nFIXED b 4 X\nDIE d PILOT 0. 10.\n SEGM 20. 10. -5. 10.\nCNT2D b 3 d k\nMOVE d Y go\nLIC go\n" + times, "STRAT 0.1 1.E-6 0.25 5 3"))
    force = abs(run.history["force_y_d"])
    tops = [force[np.argmin(abs(run.history["time"] - k))] for k in (1, 3, 5, 7, 9)]
    rests = [force[np.argmin(abs(run.history["time"] - k))] for k in (2, 4, 6, 8, 10)]
    return max(max(abs(top/tops[0] - 1) for top in tops), max(rests)/tops[0])


def one_step_or_many(checks):
    """An elastic bar stretched by a half in one step and in forty: Hencky's stress does not know how it came there."""
    ends = []
    for name, step in (("one-step", 1.0), ("forty-steps", 0.025)):
        run = checks.run(name, deck(
            "AXISYM", "LOG", block("0. 0. 5. 0. 5. 10. 0. 10.", "2 1. 3 1."), "LAW m ELA\n 100. 0.45\n",
            "FIXED b 1 Y\nFIXED b 4 X\nMOVE b 3 Y go\nLIC go\n 0. 0. 1. 5.\nPROBE f REACT Y b 3\n", f"STRAT {step} 1.E-3 {step} 5 3\nNORMS STRAIN 1. FORCE 1.E-12 DISPL 1.E-12"))
        ends.append(run.history["f"][-1])
    return abs(ends[1]/ends[0] - 1)


def slender_billet(checks, name="slender-billet", mesh="4 1. 20 1.", wide=2.0, points=4, friction=0.3, travel=2.0, steps=(0.02, 0.1, 0.3)):
    """A slender billet bent by 0.01, less than a hundredth of its thickness, upset between rough dies: it buckles in long steps as in short ones, to its own side."""
    ends = []
    for step in steps:
        run = checks.run(f"{name}-{step}", deck(
            "PLSTN", "LOG", block(f"0. 0. {wide} 0. {wide} 10. 0. 10.", mesh, f" SIDE 2 MID {wide + 0.01} 5.\n SIDE 4 MID 0.01 5.\n",
                                  points),
            f"LAW m EPLA\n 200000. 0.3\n LINEAR 300. 500.\nLAW k COUL2D\n PENETR 1.E-3 PHI {friction}\n",
            "DIE low\n SEGM -9. 0. 9. 0.\nDIE top PILOT 0. 10.\n SEGM 9. 10. -9. 10.\nCNT2D b 1 low k\nCNT2D b 3 top k\n"
            f"MOVE top Y go\nLIC go\n 0. 0. 1. -{travel}\nPROBE side NODE UX {wide + 0.01} 5.\n", f"STRAT {step} 1.E-6 {step} 5 3"))
        ends.append((run.history["force_y_top"][-1], run.history["side"][-1]))
    return max(float(min(side for _, side in ends) < 1), max(abs(force/ends[0][0] - 1) for force, _ in ends))


def slides_as_it_buckles(checks):
    """Little friction: all points of contact are about to slip, and corrections are longer than the billet: it stays between its dies."""
    return slender_billet(checks, "slides-as-it-buckles", "2 1. 10 1.", points=9, friction=0.15, steps=(0.02, 0.1, 0.15))


def first_step_past_buckling(checks):
    """The first step ends far past the load of buckling, where both sides are stable: the billet bulges to its own."""
    return slender_billet(checks, "first-step", "6 1. 30 1.", wide=1.2, travel=1.0, steps=(0.02, 0.1))


CASES = (
    Case("limit load", limit_load, 1e-3), Case("deep notch", deep_notch, 0.03), Case("penalty 1e-2 to 1e6", penalties, 1e-6),
    Case("rate exponent .005 to 1", rate_exponents, 0.003), Case("stiffness ratio 1e8", stiffness_ratio, 1e-5),
    Case("turn by 360 degrees", full_turn, 1e-8), Case("aspect 100 on the axis", axis_aspect, 1e-9),
    Case("middle nodes off centre", off_centre, 1e-9), Case("change of units", units, 1e-9), Case("threads", threads, 0.0),
    Case("steps far too long", long_steps, 0.02), Case("mirror image", mirrored, 1e-7),
    Case("held by friction alone", friction_alone, 1e-2), Case("contact again", contact_again, 0.01),
    Case("released and pressed again", released, 1e-9), Case("lifts off", lifts_off, 0), Case("lifted off", lifted_off, 1e-9),
    Case("wall that peels off", wall_peels, 1), Case("another press turns back", another_press_turns, 1.0),
    Case("past a die's end", past_the_end, 1e-2), Case("slides off an edge", slides_off_an_edge, 0.03), Case("flash let go", lets_go, 0.01), Case("driven on", driven_on, 0.15),
    Case("round a fillet", round_a_fillet, 5.0),
    Case("stick-slip reversal", stick_slip, 1e-3),
    Case("bent round a pin", round_a_pin, 0.25), Case("bent between three rollers", three_point_bending, 0.2),
    Case("blank under a holder", under_a_holder, 1e-4), Case("drawn under a holder", drawn_under_a_holder, 1.0),
    Case("rolling", rolling, 0.01, LONG), Case("rocking die", rocking_die, 0.02),
    Case("ends on the axis", ends_on_the_axis, 1e-6), Case("on a soft pad", on_a_soft_pad, 5e-3), Case("S-shaped dies", s_shaped, 1e-3), Case("rib thinner than elements", thin_rib, 0.5, LONG),
    Case("nearly incompressible", nearly_incompressible, 1e-9), Case("past the peak", past_the_peak, 1e-9),
    Case("another solver", other_solver, 1e-6), Case("three blocks for one", joined, 1e-8), Case("pressed often", pressed_often, 1e-5),
    Case("one step or many", one_step_or_many, 1e-9), Case("slender billet", slender_billet, 0.03),
    Case("slides as it buckles", slides_as_it_buckles, 0.03), Case("first step past buckling", first_step_past_buckling, 0.04))
