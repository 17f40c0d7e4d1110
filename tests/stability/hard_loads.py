"""Hard cases of bodies under loads alone, that flow: loads that stop and turn back."""
from hard_support import Case, block, deck


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


CASES = (Case("loads turn back", loads_turn_back, 1e-6),)
