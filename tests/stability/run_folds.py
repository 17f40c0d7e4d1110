#!/usr/bin/env python3
"""Bodies that fold onto themselves: contact of a body with itself, and its detection where no contact is given.

usage: run_folds.py [-v] [-k] [-a]       -v prints every check, -k keeps the results, -a the long cases too

References are exact: by symmetry a C or a ring that is pressed shut is its half against a rigid, frictionless plane of twice the penalty;
two blocks joined far away by a link a hundred million times softer are the two blocks alone. Before, all of these ended with 0 and
passed through themselves, or were refused. What meets where no card says so is compared with the same run with such cards.
"""
import csv
import json
import os
import subprocess
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), os.pardir, "patch"))
from patch_support import BIN, Checks, Run, np  # noqa: E402

STEEL = "LAW m EPLA\n 200000. 0.3\n LINEAR 300. 500.\n"
STRAT = "STRAT 0.02 1.E-6 0.05 5 3\nSAVE 5\nEND\n"


def block(name, x, y, n):
    """A rectangle of the law m."""
    return f"BLOCK {name} PL8LS 4 m\n {x[0]} {y[0]} {x[1]} {y[0]} {x[1]} {y[1]} {x[0]} {y[1]}\n {n[0]} 1. {n[1]} 1.\n"


def arms(x, state, whole, contact, arm=1.0, more=""):
    """A C of two arms and a back, its opening to the right, from x on; or its lower half below a line of symmetry."""
    text = f"TITLE C pressed shut\nSTATE {state}\nKINEM LOG\n"
    text += block("lowb", (x, x + 1), (-0.1 - arm, -0.1), (2, 3)) + block("low", (x + 1, x + 4), (-0.1 - arm, -0.1), (6, 3))
    text += block("back", (x, x + 1), (-0.1, 0.1 if whole else 0.0), (2, 2 if whole else 1))
    joins = "JOIN lowb 2 low 4\nJOIN lowb 3 back 1\n"
    loads = "FIXED lowb 4 X\nFIXED back 4 X\nMOVE low 1 Y press\n"
    if whole:
        text += block("upb", (x, x + 1), (0.1, 0.1 + arm), (2, 3)) + block("up", (x + 1, x + 4), (0.1, 0.1 + arm), (6, 3))
        joins += "JOIN upb 2 up 4\nJOIN back 3 upb 1\n"
        loads += "FIXED upb 4 X\nMOVE up 3 Y press -1.\n"
    else:
        loads += "FIXED back 3 Y\n"
    return text + joins + STEEL + contact + loads + f"PROBE force REACT Y low 1\nPROBE tip NODE X {x + 4} -0.1\n" + more


def cees(checks):
    """A C against its half: force and place of a tip; friction does nothing on a line of symmetry."""
    for x, state in ((0.0, "PLSTN"), (5.0, "AXISYM")):
        found = []
        for whole in (True, False):
            contact = "DIE skin SIDES low 3 back 2 up 1\nCNT2D skin skin k\nLAW k COUL2D\n AKP 2.E7 PHI 0.3\n" if whole else \
                f"DIE line\n SEGM {x + 9} 0. {x - 1} 0.\nCNT2D low 3 line -33 k\nLAW k COUL2D\n AKP 4.E7 PHI 0.\n"
            run = Run(checks, f"cee-{state}-{'whole' if whole else 'half'}".lower(),
                      arms(x, state, whole, contact, more="LIC press\n 0. 0. 1. 0.3\n") + STRAT)
            if not run.ok:
                return
            found.append([run.history["force"][-1], run.history["tip"][-1] - x])
        off = abs(np.array(found[0])/found[1] - 1)
        checks.small(off[0], 1e-3, f"C, {state}: force beside that of its half")
        checks.small(off[1], 1e-3, f"C, {state}: place of a tip beside that of its half")


def open_walls(checks):
    """Arms far thinner than their sides are long, pressed but not shut: no wall is taken for contact."""
    found = []
    for contact in ("", "DIE skin SIDES lowb 1 4 low 1 2 3 back 2 4 up 1 2 3 upb 3 4\nCNT2D skin skin k\nLAW k COUL2D\n PHI 0.3\n"):
        run = Run(checks, "walls-" + ("contact" if contact else "alone"),
                  arms(0.0, "PLSTN", True, contact, arm=0.1, more="LIC press\n 0. 0. 1. 0.02\n") + STRAT)
        found.append(run.history["force"] if run.ok else np.array([np.nan]))
    same = len(found[0]) == len(found[1])
    checks.small(np.abs(found[0]/found[1] - 1).max() if same else np.inf, 1e-9, "walls: forces as without contact")


def detection(checks):
    """Without contact the run ends where the tips meet, with the place and what to try."""
    run = Run(checks, "through", arms(0.0, "PLSTN", True, "", more="LIC press\n 0. 0. 1. 0.3\n") + STRAT, code=3)
    for words in ("a body passes through itself: step", "low passes through itself at x = ", "DIE name SIDES place"):
        checks.that(words in run.said, f"through: says '{words}'", run.said)
    with open(os.path.join(run.out, "summary.json"), encoding="utf-8") as file:
        checks.that(json.load(file)["cutbacks"] >= 3, "through: shorter steps were tried")
    shut = 0.1/0.3
    checks.that(0.8*shut < run.history["time"][-1] < 1.2*shut, "through: where the tips meet", run.history["time"][-1])


def unasked(checks):
    """No card lets the sides meet, but the body has another contact: its law is theirs from where they meet, as if a card gave it."""
    far = "DIE far\n SEGM -1. -5. 9. -5.\nCNT2D low 1 far k\nLAW k COUL2D\n AKP 2.E7 PHI 0.3\n"
    found = []
    for name, card in (("asked", "DIE skin SIDES low 3 back 2 up 1\nCNT2D skin skin k\n"), ("unasked", "")):
        run = Run(checks, name, arms(0.0, "PLSTN", True, card + far, more="LIC press\n 0. 0. 1. 0.3\n")
                  + STRAT.replace("0.02 1.E-6 0.05", "0.01 1.E-6 0.01"))
        if not run.ok:
            return
        found.append([run.history["force"][-1], run.history["tip"][-1], run.history["external_work"][-1]])
        with open(os.path.join(run.out, "summary.json"), encoding="utf-8") as file:
            summary = json.load(file)
        told = any("has met itself" in warning["text"] for warning in summary["warnings"])
        checks.that(told == (card == ""), f"{name}: what no card asks for is told", summary["warnings"])
        found[-1] += [summary["checks"]["energy_imbalance"], run.history["step_length"].min()]
    checks.small(abs(found[1][3] - found[0][3]), 2e-3, "unasked: balance of energy beside that with cards")
    off = np.abs(np.array(found[1][:3])/found[0][:3] - 1)
    checks.small(off[0], 2e-3, "unasked: force beside that with cards")
    checks.small(off[1], 1e-3, "unasked: place of a tip beside that with cards")
    checks.small(off[2], 2e-3, "unasked: work beside that with cards")
    checks.that(not any("itself" in title for title in run.history), "unasked: the columns of the history stay")
    # the attempts without contact, each of half the length of the one before, leave no shorter steps
    checks.that(found[1][4] > 0.2*found[0][4], "unasked: steps go on at their length", f"{found[1][4]} and {found[0][4]} with cards")


def tube(body):
    """A tube of radius 20, 3 thick and 40 high, crushed along its axis."""
    return f"TITLE tube crushed\nSTATE AXISYM\nKINEM LOG\n{body}" \
        "LAW m EPLA\n 70000. 0.33\n LINEAR 200. 200.\nLAW film COUL2D\n PENETR 1.E-3 PHI 0.1 AUGMENT 10\n" \
        "DIE upper PILOT 0. 40.\n SEGM 60. 40. 0. 40.\nDIE lower\n SEGM 0. 0. 60. 0.\n" \
        "CNT2D tube 2 3 4 upper film\nCNT2D tube 1 2 4 lower film\nLIC press\n 0. 0. 1. -28.\nMOVE upper Y press\n" \
        "STRAT 0.002 1.E-6 0.02 6 3\n"


def crushed_tube(checks):
    """A tube crushed along its axis folds like a bellows: its folds meet inside and outside, and no card says so."""
    run = Run(checks, "tube", tube("BLOCK tube PL8LS 4 m\n 20. 0. 23. 0. 23. 40. 20. 40.\n 2 1. 16 1.\n") + "END\n")
    if run.ok:
        checks.that("tube passes through itself" in run.said, "tube: says where it has met itself", run.said[-300:])
        checks.that(abs(run.history["volume_drift"][-1]) < 0.01, "tube: volume", run.history["volume_drift"][-1])


def crushed_on_new_meshes(checks):
    """So does one with new meshes: on one of them its sides meet within the first steps. Shorter steps meet too; the mesh is not refused
    for them, and the run goes on to its end."""
    path, out = os.path.join(checks.folder, "crushed.lag"), os.path.join(checks.folder, "crushed")
    with open(path, "w", encoding="utf-8") as deck:
        deck.write(tube("BODY tube PL8LS 4 m\n SEGM 20. 0. 23. 0.\n SEGM 23. 0. 23. 40.\n SEGM 23. 40. 20. 40.\n SEGM 20. 40. 20. 0.\n")
                   + "REMSH\nSAVE 20\nEND\n")
    done = subprocess.run([os.path.join(BIN, "lagacycle"), path, "--out", out], check=False, stdin=subprocess.DEVNULL, capture_output=True,
                          text=True)
    if not checks.that(done.returncode == 0, "crushed: exit code 0", f"{done.returncode} {done.stderr[-300:]}"):
        return
    with open(os.path.join(out, "crushed.log"), encoding="utf-8") as file:
        checks.that("from here on its sides press on one another" in file.read(), "crushed: met itself")
    with open(os.path.join(out, "cycle.csv"), newline="", encoding="utf-8") as file:
        tries = list(csv.DictReader(file))
    checks.that(not any("passes through itself" in one["reason"] for one in tries), "crushed: no mesh is refused for it",
                [one["reason"] for one in tries])


def closed_hole(checks):
    """A hole in four joined blocks is pressed shut from its ends, where its sides meet on each new mesh anew: on the second one of them
    they have contact, instead of ever more meshes, none of which is good enough in the end."""
    q = 4/np.sqrt(2)
    text = "TITLE A hole pressed shut\nSTATE PLSTN\nKINEM LOG\n"
    around = ((2 + q, -q, 10, -10), (2 + q, q, 10, 10), (2 - q, q, -10, 10), (2 - q, -q, -10, -10))
    for k, name in enumerate("RTLB"):
        (a, b, c, d), (e, f, g, h) = around[k], around[(k + 1) % 4]
        text += f"BLOCK {name} PL8LS 4 m\n {a} {b} {c} {d} {g} {h} {e} {f}\n 2 1. 3 1.\n SIDE 4 ARC 2. 0.\n"
    text += "JOIN R 3 T 1\nJOIN T 3 L 1\nJOIN L 3 B 1\nJOIN B 3 R 1\nLAW m EPLA\n 200000. 0.3\n LINEAR 300. 300.\nLAW f COUL2D\n PHI 0.2\n" \
        "DIE up PILOT 0. 10.\n SEGM 30. 10. -30. 10.\nDIE lo\n SEGM -30. -10. 30. -10.\n"
    text += "".join(f"CNT2D {name} 2 {die} f\n" for die, names in (("up", "TLR"), ("lo", "BLR")) for name in names)
    text += "FIXED POINT 0. -10. X\nLIC g\n 0. 0. 1. -6.\nMOVE up Y g\nSTRAT 0.005 1.E-6 0.05 6 3\nREMSH\nEND\n"
    path, out = os.path.join(checks.folder, "hole.lag"), os.path.join(checks.folder, "hole")
    with open(path, "w", encoding="utf-8") as deck:
        deck.write(text)
    done = subprocess.run([os.path.join(BIN, "lagacycle"), path, "--out", out], check=False, stdin=subprocess.DEVNULL, capture_output=True,
                          text=True)
    if not checks.that(done.returncode == 0, "hole: exit code 0", f"{done.returncode} {done.stderr[-300:]}"):
        return
    with open(os.path.join(out, "summary.json"), encoding="utf-8") as file:
        summary = json.load(file)
    checks.that(any("R has met itself" in warning["text"] for warning in summary["warnings"]), "hole: told", summary["warnings"])
    checks.small(abs(summary["checks"]["volume_drift_unloaded"]), 2e-3, "hole: volume")


def inside_out(checks):
    """A thin lens in an elastic block without contact is pressed shut in one step: all of its sides go past one another, none crosses another at the
    end of the step, and the block has passed through itself all the same."""
    text = "TITLE A lens\nSTATE PLSTN\nKINEM LOG\n"
    for name, x, y, side in (("ul", -3, 0, ""), ("um", -1, 0, "1 ARC 0. -25."), ("ur", 1, 0, ""), ("ll", -3, -3, ""), ("lm", -1, -3, "3 ARC 0. 25."), ("lr", 1, -3, "")):
        text += f"BLOCK {name} PL8LS 4 m\n {x} {y} {x + 2} {y} {x + 2} {y + 3} {x} {y + 3}\n 2 1. 2 1.\n" + (f" SIDE {side}\n" if side else "")
    text += "JOIN ul 2 um 4\nJOIN um 2 ur 4\nJOIN ll 2 lm 4\nJOIN lm 2 lr 4\nJOIN ul 1 ll 3\nJOIN ur 1 lr 3\nLAW m ELA\n 1000. 0.3\n"
    text += "".join(f"FIXED {name} 1 Y\n" for name in ("ll", "lm", "lr")) + "FIXED ll 4 X\n" + "".join(f"MOVE {name} 3 Y down\n" for name in ("ul", "um", "ur"))
    path = os.path.join(checks.folder, "lens.lag")
    with open(path, "w", encoding="utf-8") as deck:
        deck.write(text + "LIC down\n 0. 0. 1. -0.3\nSTRAT 1. 1.E-3 1. 8 3\nEND\n")
    done = subprocess.run([os.path.join(BIN, "lagamine"), path, "--out", os.path.join(checks.folder, "lens")], check=False, stdin=subprocess.DEVNULL,
                          capture_output=True, text=True)
    checks.that(done.returncode == 3 and "um passes through itself" in done.stderr, "lens: told", f"{done.returncode} {done.stderr[-300:]}")


def linked(link, width, low, die, place, loads):
    """A block on another one, alone or joined by a soft link into one body."""
    text = "TITLE linked blocks\nSTATE PLSTN\nKINEM LOG\n" + block("low", (0, 10), (0, 2), (10, 2))
    text += block("up", (8 - width, 8), (low, low + 2), (7, 3))
    if link:
        soft = (block("link", (10, 14), (0, 2), (4, 2)) + block("knee", (14, 16), (0, 2), (2, 2)) + block("post", (14, 16), (2, 5), (2, 3))
                + block("top", (14, 16), (5, 7), (2, 3))
                + f"BLOCK arm PL8LS 4 m\n 8 {low} 14 5 14 7 8 {low + 2}\n 4 1. 3 1.\n").replace("PL8LS 4 m", "PL8LS 4 s")
        text += soft + "JOIN low 2 link 4\nJOIN link 2 knee 4\nJOIN knee 3 post 1\nJOIN post 3 top 1\nJOIN top 4 arm 2\nJOIN arm 4 up 2\n"
        text += "LAW s ELA\n 1.E-4 0.\n"
    return text + f"LAW m ELA\n 20000. 0.3\nLAW k COUL2D\n PENETR 1.E-3 PHI 0.3\nDIE own SIDES {die}\nCNT2D {place} own k\n" \
        + "FIXED low 1 XY\n" + loads + STRAT


def remeshed(checks):
    """A C that is shut gets a new mesh: the fold stays, its lap is told, and the force is that of the half on its own new mesh; so it
    is where multipliers hold the pressure in the fold."""
    found = []
    for name, whole, law in (("whole", True, "AKP 2.E7 PHI 0.3"), ("half", False, "AKP 4.E7 PHI 0."),
                             ("multipliers", True, "PENETR 1.E-3 PHI 0.3 AUGMENT 10"), ("unasked", True, "AKP 2.E7 PHI 0.3")):
        contact = ("DIE far\n SEGM -1. -5. 9. -5.\nCNT2D low 1 far k\n" if name == "unasked" else
                   "DIE skin SIDES low 3 back 2 up 1\nCNT2D skin skin k\n" if whole else
                   "DIE line\n SEGM 9. 0. -1. 0.\nCNT2D low 3 line -33 k\n") + f"LAW k COUL2D\n {law}\n"
        path, out = os.path.join(checks.folder, f"remeshed-{name}.lag"), os.path.join(checks.folder, f"remeshed-{name}")
        with open(path, "w", encoding="utf-8") as deck:
            deck.write(arms(0.0, "PLSTN", whole, contact, more="LIC press\n 0. 0. 1. 0.25\nREMSH\n TIMES 0.7\n") + STRAT)
        done = subprocess.run([os.path.join(BIN, "lagacycle"), path, "--out", out, "--quiet"], check=False, stdin=subprocess.DEVNULL,
                              capture_output=True, text=True)
        if not checks.that(done.returncode == 0, "remeshed: exit code 0", f"{done.returncode} {done.stderr[-300:]}"):
            return
        with open(os.path.join(out, "history.csv"), newline="", encoding="utf-8") as file:
            rows = list(csv.reader(file))
        found.append(float(rows[-1][[title.split(" [")[0] for title in rows[0]].index("force")]))
        with open(os.path.join(out, "cycle.csv"), newline="", encoding="utf-8") as file:
            tries = list(csv.DictReader(file))
        checks.that([one["accepted"] for one in tries] == ["y"], f"remeshed, {name}: one new mesh at the first try ({len(tries)})")
        laps, depth = int(tries[0]["laps [-]"]), float(tries[0]["lap_depth [length]"])
        # the arms lie on each other from a tip to the ground of the slot, 3 long
        checks.that((laps == 1 and 2.0 < depth < 3.2) if whole else laps == 0, "remeshed: laps", f"{laps}, {depth}")
    checks.small(abs(found[0]/found[1] - 1), 0.02, "remeshed: force beside that of the half on a new mesh")
    checks.small(abs(found[2]/found[0] - 1), 1e-3, "remeshed: force with multipliers")
    checks.small(abs(found[3]/found[0] - 1), 0.02, "remeshed: force where no card lets the sides meet")


def friction(checks):
    """A block dragged over another: friction of two bodies, of sides of one, and of all sides of one that face one another."""
    loads = "MOVE up 3 Y press\nMOVE up 3 X drag\nLIC press\n 0. 0. 0.2 -0.02 1. -0.02\nLIC drag\n 0. 0. 0.2 0. 1. -1.\nPROBE f REACT X up 3\n"
    all_of_it = "low 3 link 3 post 4 arm 1 up 1"
    found = []
    for name, link, die, place in (("bodies", False, "low 3", "up 1"), ("sides", True, "low 3", "up 1"), ("skin", True, all_of_it, "own")):
        run = Run(checks, "drag-" + name, linked(link, 5, 2, die, place, loads))
        found.append(run.history["f"][-1] if run.ok else np.nan)
    checks.small(abs(found[1]/found[0] - 1), 1e-7, "drag: two sides of one body as two bodies")
    checks.small(abs(found[2]/found[0] - 1), 1e-4, "drag: a body that faces itself as two bodies")


def slot(checks):
    """A slot between sides of 1 and of 10/7 closes: a uniform pressure, that of the force."""
    loads = "FIXED low 4 X\nFIXED up 4 X\nMOVE up 3 Y press\nLIC press\n 0. 0. 1. -0.2\nPROBE f REACT Y up 3\nPROBE x NODE X 8. 2.1\n"
    text = linked(True, 8, 2.1, "low 3 link 3 post 4 arm 1 up 1", "own", loads).replace("PHI 0.3", "PHI 0.").replace("low 1 XY", "low 1 Y")
    # both blocks as wide as the slot, so that nothing sticks out of it
    text = text.replace(" 0 0 10 0 10 2 0 2\n 10 1. 2 1.", " 0 0 8 0 8 2 0 2\n 10 1. 2 1.").replace(" 10 0 14 0 14 2 10 2", " 8 0 14 0 14 2 8 2")
    run = Run(checks, "slot", text)
    if not run.ok:
        return
    state = run.state("own/own", "pressure", "contact_status", "die_piece")
    # the side at the end of the slot bends with the link's corner
    pressure = state[(state[:, 1] != 0) & (state[:, 2] < 10), 0]
    mean = abs(run.history["f"][-1])/run.history["x"][-1]
    checks.small(abs(pressure/mean - 1).max() if len(pressure) > 150 else np.inf, 1e-2, "slot: pressure of the points over that of the force")


def crushed_ring(checks):
    """A ring crushed between plates until its walls lie on each other, against its half over a plane."""
    found = []
    for whole in (True, False):
        quarters = "".join(f"BLOCK {name} PL8LS 4 m\n {corners}\n {n}\n SIDE 2 ARC 0. 0.\n SIDE 4 ARC 0. 0.\n" for name, corners, n in (
            ("low", "0. -8.5 0. -10. 10. 0. 8.5 0.", "2 1. 16 1."), ("up", "8.5 0. 10. 0. 0. 10. 0. 8.5", "2 1. 16 1."))[:2 if whole else 1])
        text = "TITLE ring crushed\nSTATE PLSTN\nKINEM LOG\n" + quarters + STEEL + "LAW plate COUL2D\n PENETR 1.E-3 PHI 0.2\n" \
            + "DIE bottom PILOT 0. -10.\n SEGM -1. -10. 20. -10.\nCNT2D low 2 bottom plate\nMOVE bottom Y press\nFIXED low 1 X\n"
        if whole:
            text += "JOIN low 3 up 1\nDIE top PILOT 0. 10.\n SEGM 20. 10. -1. 10.\nCNT2D up 2 top plate\nMOVE top Y press -1.\nFIXED up 3 X\n" \
                "DIE bore SIDES low 4 up 4\nCNT2D bore bore k\nLAW k COUL2D\n AKP 1.E6 PHI 0.\nFIXED POINT 10. 0. Y\n"
        else:
            text += "DIE line\n SEGM 20. 0. -1. 0.\nCNT2D low 4 line -33 k\nLAW k COUL2D\n AKP 2.E6 PHI 0.\nFIXED low 3 Y\n"
        run = Run(checks, "ring-" + ("whole" if whole else "half"), text + "LIC press\n 0. 0. 1. 8.75\nPROBE x NODE X 10. 0.\n"
                  + STRAT.replace("0.02 1.E-6 0.05", "0.02 1.E-6 0.03"))
        if not run.ok:
            return
        found.append([run.history["force_y_bottom"][-1], run.history["x"][-1]])
    off = abs(np.array(found[0])/found[1] - 1)
    checks.small(off[0], 0.02, "ring: force beside that of its half")
    checks.small(off[1], 0.005, "ring: width beside that of its half")


def main():
    checks = Checks()
    for case in (cees, open_walls, detection, unasked, crushed_tube, crushed_on_new_meshes, closed_hole, inside_out, remeshed, friction, slot):
        case(checks)
    if "-a" in sys.argv[1:]:
        crushed_ring(checks)
    checks.end()


if __name__ == "__main__":
    main()
