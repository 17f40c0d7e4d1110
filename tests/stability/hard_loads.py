"""Hard cases of bodies under loads alone: loads that stop and turn back, dies under a force, springs."""
import math

from hard_support import Case, block, deck, report


def loads_turn_back(checks):
    """A block pulled by 1.1 times its yield stress, then sheared, let go by a tenth and loaded again: points that flowed unload, at once
    and however short the step is, and the block comes back to where it was."""
    worst = 0.0
    for modulus, step in ((2000, 0.05), (2000, 0.07), (5000, 0.2)):
        run = checks.run(f"turn-back-{modulus}-{step}", deck(
            "PLSTN", "LOG", block("0. 0. 10. 0. 10. 10. 0. 10.", "4 1. 4 1."), f"LAW m EPLA\n 200000. 0.3\n LINEAR 300. {modulus}.\n",
            "FIXED b 1 XY\nTRACT b 3 Y 330. pull\nTRACT b 3 X 120. shear\nLIC pull\n 0. 0. 1. 1. 1.5 1. 2. 0.9 2.5 1.\n"
            "LIC shear\n 0. 0. 1. 0. 1.5 1. 2. 0.9 2.5 1.\nPROBE ux NODE UX 10. 10.\nPROBE uy NODE UY 10. 10.\n",
            f"STRAT {step} 1.E-6 {step} 40 3\nNORMS FORCE 1.E-8"))
        for column in ("ux", "uy"):
            loaded, let_go, again = (run.history[column][abs(run.history["time"] - time).argmin()] for time in (1.5, 2.0, 2.5))
            worst = max(worst, abs(again - loaded)/abs(let_go - loaded))
    return worst


def cone_under_a_force(checks):
    """A blunt cone stands with its point on the axis of an elastic block, and a force takes it in: what a moved one answers at the same
    depth, for all steps, and near Sneddon's half-space (Int. J. Engng Sci. 3 (1965) 47-57: F = 2 E* d**2 tan(a)/pi)."""
    slope, depth, worst = 0.05, 0.1, 0.0
    force = 2*200000/(1 - 0.3**2)*depth**2/slope/math.pi
    for name, load in (("moved", f"MOVE d Y go -{depth}\n"), ("pushed", f"FORCE d Y {{force!r}} go\n")):
        for step in (0.5, 0.1):
            run = checks.run(f"cone-{name}-{step}", deck(
                "AXISYM", "LOG", block("0. 0. 40. 0. 40. 40. 0. 40.", "24 30. 24 0.0333"), "LAW m ELA\n 200000. 0.3\nLAW k COUL2D\n PENETR 1.E-3 PHI 0.\n",
                f"FIXED b 1 Y\nFIXED b 4 X\nDIE d PILOT 0. 40.\n SEGM 60. {40 + 60*slope!r} 0. 40.\n SEGM 0. 40. -60. {40 + 60*slope!r}\n"
                f"CNT2D b 2 3 d k\n{load.format(force=-force)}LIC go\n 0. 0. 1. 1.\n", f"STRAT {step} 1.E-6 {step} 6 3"))
            if name == "moved":
                worst = max(worst, abs(run.history["force_y_d"][-1]/force - 1))
                force = abs(run.history["force_y_d"][-1])
            else:
                worst = max(worst, 10*abs(run.history["displacement_y_d"][-1]/-depth - 1))
    return worst


def lifted_by_springs(checks):
    """A block on weak springs along X, pressed on another with friction and lifted off: it comes to rest on its
    springs at once, and stays there without a correction."""
    run = checks.run("lifted-by-springs", deck(
        "PLSTN", "LOG", block("-8.9304 0. 8.9304 0. 8.9304 5.0368 -8.9304 5.0368", "5 1. 5 1.")
        + "BLOCK q PL8LS 4 h\n -8.9304 5.0368 11.6095 5.0368 11.6095 10.0368 -8.9304 10.0368\n 7 1. 3 1.\nDIE d SIDES q 1\n",
        "LAW m EPLA\n 200000. 0.3\n SWIFT 600. 0.01 0.2\nLAW k COUL2D\n PENETR 1.E-3 PHI 0.2\nLAW h EPLA\n 200000. 0.3\n LINEAR 600. 1000.\n",
        "CNT2D b 3 d k\nFIXED b 1 XY\nSPRNG q X 1.\nMOVE q 3 Y go -0.6934\nLIC go\n 0. 0. 1. 1. 1.5 0.2\n",
        "STRAT 0.02 1.E-6 0.02 6 3"))
    return max(abs(report(run)["checks"]["spring_share"]), run.history["iterations"][-10:].sum())


CASES = (Case("loads turn back", loads_turn_back, 1e-6), Case("cone under a force", cone_under_a_force, 0.05),
         Case("lifted on springs", lifted_by_springs, 1e-3))
