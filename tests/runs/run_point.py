#!/usr/bin/env python3
"""`lagamine --point`: the decks of decks/point against closed forms, paths of stress and of strain, refusals, failures.

usage: run_point.py [-v] [-k]       -v prints every check, -k keeps the results
"""
import csv
import math
import os
import shutil
import sys

sys.dont_write_bytecode = True
from support import DONE, INPUT, NO_CONVERGENCE, SOURCE, UPSETTING, Checks, deck_text, run, said, write  # noqa: E402

POINTS = os.path.join(SOURCE, "decks", "point")
TENSION = os.path.join(SOURCE, "decks", "trip_tension")
E, NU = 200000.0, 0.3
G = E/(2*(1 + NU))
EXACT = 1.0e-8          # share: Newton stops at 1e-11 of the stresses

BASE = """TITLE  Base
KINEM  LOG
LAW    steel EPLA
   200000. 0.3
   LINEAR 300. 1000.
PATH   steel
   1. 10   E 0.1  S 0.  E 0.  S 0.
   2. 10   S 0.   S 0.  S 50. S 0.
END
"""
WARM = """TITLE  Warm
KINEM  SMALL
LAW    bar ELATH
   200000. 0.3 1.E-5
PATH   bar T 20.
   1. 10   S 0.   S 0.  S 0.  S 0.
   2. 10   S 0.   E 0.  S 0.  S 0.  T 100.
END
"""

# What is changed in the base, and what the error must say, where.
REFUSED = [
    ("PATH   steel", "PATH   steal", 6, "nearest: 'steel'"),
    ("   1. 10   E 0.1", "   0. 10   E 0.1", 7, "a time later than the one before"),
    ("   2. 10   S 0. ", "   1. 10   S 0. ", 8, "a time later than the one before"),
    ("   1. 10   E 0.1", "   1. 0    E 0.1", 7, "the number of steps"),
    ("   1. 10   E 0.1", "   1. 2.5  E 0.1", 7, "a whole number"),
    ("E 0.1  S 0.", "E 0.1  X 0.", 7, "E (strain) or S (stress) for yy"),
    ("E 0.1  S 0.", "0.1  S 0.", 7, "E (strain) or S (stress) for xx"),
    ("E 0.  S 0.\n", "E 0.\n", 7, "E (strain) or S (stress) for zz"),
    ("PATH   steel", "PATH   steel T", 6, "the temperature at the start"),
    ("PATH   steel", "PATH   steel T 20.", 6, "does not depend on the temperature"),
    ("S 50. S 0.", "S 50. S 0. T 100.", 8, "wants one at the start"),
    ("S 50. S 0.", "S 50. S 0. 3.", 8, "T and a temperature, or the end of the line"),
    ("KINEM  LOG", "KINEM  HENCKY", 2, "'JAUMANN'"),
    ("KINEM  LOG", "STATE  PLSTN\nKINEM  LOG", 2, "there is no such card"),
    ("LAW    steel EPLA\n   200000. 0.3\n   LINEAR 300. 1000.", "LAW    steel COUL2D\n   PHI 0.1", 5, "expected one for solids"),
    ("PATH   steel", "LAW    other ELA\n   1. 0.\nPATH   steel", 6, "defined and never used"),
    ("END\n", "PATH   steel\n   1. 1  E 0. E 0. E 0. E 0.\nEND\n", 9, "given twice"),
]


def table(folder, name):
    """Columns of NAME.point.csv by name without unit."""
    with open(os.path.join(folder, name + ".point.csv"), newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    names = [title.split(" [")[0] for title in rows[0]]
    return {name: [float(row[k]) for row in rows[1:]] for k, name in enumerate(names)}, rows[0]


def follow(checks, name, deck, *options):
    """Run a path; its table."""
    result = run(["--point", deck, "--out", checks.path(name), "--quiet", *options])
    if not checks.that((result.returncode, result.stdout, result.stderr) == (DONE, "", ""), f"{name}: done, quietly", said(result)):
        return None
    stem = os.path.splitext(os.path.basename(deck))[0]
    checks.that(os.listdir(checks.path(name)) == [stem + ".point.csv"], f"{name}: leaves the table and no more")
    return table(checks.path(name), stem)[0]


def near(checks, found, wanted, scale, what, share=EXACT):
    """Two numbers agree to a share of `scale`; NaN agrees with nothing."""
    return checks.that(abs(found - wanted) <= share*scale, what, f"found {found}, wanted {wanted}")


def tension(checks):
    """Kirchhoff stress = yield(p), strains tau/E + p and -nu tau/E - p/2; unloaded, p is what stays."""
    path = follow(checks, "tension", os.path.join(POINTS, "tension.point"))
    if not path:
        return
    checks.that(len(path["time"]) == 111 and path["time"][100] == 1.0 and path["time"][-1] == 2.0, "tension: a row a step")
    for k in range(1, 101):
        p = path["plastic_strain"][k]
        tau = 500.0 - 200.0*math.exp(-12.0*p) + 50.0*p
        near(checks, path["strain_yy"][k], 0.005*k, 1.0, f"tension, step {k}: the strain asked for", 1e-14)
        near(checks, path["strain_yy"][k], tau/E + p, 0.1, f"tension, step {k}: strain along")
        near(checks, path["strain_xx"][k], -NU*tau/E - p/2, 0.1, f"tension, step {k}: strain across")
        near(checks, path["stress_yy"][k], tau*math.exp(-(1 - 2*NU)*tau/E), tau, f"tension, step {k}: stress")
        near(checks, path["von_mises"][k], path["stress_yy"][k], tau, f"tension, step {k}: von Mises")
    checks.that(max(path["iterations"]) <= 12, "tension: few iterations, at the corners too", max(path["iterations"]))
    near(checks, path["stress_yy"][-1], 0.0, 500.0, "unloaded: no stress")
    near(checks, path["strain_yy"][-1], path["plastic_strain"][-1], 0.1, "unloaded: the plastic strain stays")
    near(checks, path["plastic_strain"][-1], path["plastic_strain"][100], 0.1, "unloaded: elastically")


def shear_cycles(checks):
    """At each turn tau = yield(p)/sqrt 3, and between two the shear is (tau + tau')/G + sqrt 3 (p' - p)."""
    path = follow(checks, "cycles", os.path.join(POINTS, "shear_cycles.point"))
    if not path:
        return
    tau, p, root = 0.0, 0.0, math.sqrt(3.0)
    for k, at in enumerate((20, 60, 100, 140, 180)):
        travel = 0.02 if k == 0 else 0.04
        # (300 + 2000 p')/sqrt 3 = tau'
        p = (travel - tau/G - (300.0/root)/G + root*p)/(root + 2000.0/root/G)
        tau = (300.0 + 2000.0*p)/root
        near(checks, path["plastic_strain"][at], p, p, f"cycles, turn {k}: plastic strain")
        near(checks, path["stress_xy"][at]*(-1)**k, tau, tau, f"cycles, turn {k}: shear stress")
    other = follow(checks, "wider", os.path.join(POINTS, "shear_cycles.point"), "-p", "gamma=0.04")
    if other:
        checks.that(max(other["shear_xy"]) == 0.04, "a parameter from the command line")


def large_shear(checks):
    """G sin gamma; with LOG 2 G asinh(gamma/2) 2/sqrt(4 + gamma^2)."""
    path = follow(checks, "jaumann", os.path.join(POINTS, "large_shear.point"))
    if path:
        for gamma, tau, xx in zip(path["shear_xy"], path["stress_xy"], path["stress_xx"]):
            # the sums miss the integrals by gamma (0.01/4)^2 and less
            near(checks, tau, 1000*math.sin(gamma), 1000, f"JAUMANN, shear {gamma}", 1e-4)
            near(checks, xx, 1000*(1 - math.cos(gamma)), 1000, f"JAUMANN, shear {gamma}, stress xx", 1e-4)
    deck = write(checks.path("log.point"), deck_text(os.path.join(POINTS, "large_shear.point")).replace("KINEM  JAUMANN", "KINEM  LOG"))
    path = follow(checks, "log", deck)
    if path:
        for gamma, tau, xx in zip(path["shear_xy"], path["stress_xy"], path["stress_xx"]):
            size = 2000*math.asinh(gamma/2)/math.sqrt(4 + gamma*gamma)
            near(checks, tau, 2*size, 1000, f"LOG, shear {gamma}", 1e-10)
            near(checks, xx, gamma*size, 1000, f"LOG, shear {gamma}, stress xx", 1e-10)


def there_and_back(checks):
    """Stresses asked for are reached; the strains they needed, asked for, give these stresses again."""
    for kinematics in ("LOG", "JAUMANN", "SMALL"):
        head = BASE.replace("LOG", kinematics).split("PATH")[0]
        goals = [(200.0, 350.0, 60.0, -50.0), (-100.0, 380.0, -120.0, 0.0), (0.0, 0.0, 200.0, 0.0)]
        rows = "".join(f"   {k + 1}. 5 " + " ".join(f"S {v}" for v in goal) + "\n" for k, goal in enumerate(goals))
        stress = follow(checks, "stress_" + kinematics, write(checks.path(kinematics, "stress.point"), head + "PATH steel\n" + rows + "END\n"))
        if not stress:
            continue
        for k, goal in enumerate(goals):
            for name, value in zip(("xx", "yy", "xy", "zz"), goal):
                near(checks, stress["stress_" + name][5*k + 5], value, 300.0, f"{kinematics}: stress {name} of row {k + 1}", 1e-10)
        names = ("strain_xx", "strain_yy", "shear_xy", "strain_zz")
        rows = "".join(f"   {k}. 1 " + " ".join(f"E {stress[name][k]!r}" for name in names) + "\n" for k in range(1, 16))
        strain = follow(checks, "strain_" + kinematics, write(checks.path(kinematics, "strain.point"), head + "PATH steel\n" + rows + "END\n"))
        if strain:
            for k in range(1, 16):
                for name in ("stress_xx", "stress_yy", "stress_xy", "stress_zz"):
                    near(checks, strain[name][k], stress[name][k], 300.0, f"{kinematics}: {name} at step {k}, back from strains", 1e-7)


def temperatures(checks):
    """Temperatures are linear between rows, and stay where a row has none; a bar held along y answers by -E alpha dT."""
    path = follow(checks, "warm", write(checks.path("warm.point"), WARM))
    if not path:
        return
    checks.that(path["temperature"][:11] == [20.0]*11 and path["temperature"][-1] == 100.0, "temperatures of rows", path["temperature"])
    for k in range(11):
        near(checks, path["temperature"][10 + k], 20.0 + 8.0*k, 100.0, f"temperature {k}", 1e-14)
        near(checks, path["stress_yy"][10 + k], -200000.0*1.0e-5*8.0*k, 160.0, f"held bar, step {k}: stress")
        near(checks, path["strain_xx"][10 + k], 1.0e-5*8.0*k*1.3, 1e-3, f"held bar, step {k}: strain across")
    for old, new, line, phrase in (("PATH   bar T 20.", "PATH   bar", 5, "depends on the temperature"),
                                   ("T 100.", "T 100. 3.", 7, "the end of the line")):
        deck = write(checks.path("cold.point"), WARM.replace(old, new))
        result = run(["--point", deck])
        checks.that(result.returncode == INPUT and f"{deck}:{line}:" in result.stderr and phrase in result.stderr, f"'{new}': refused", said(result))


def other_kinds(checks):
    """A scene, a point and steels are told apart in one line."""
    point = write(checks.path("kind.point"), WARM)
    scene = os.path.join(SOURCE, "decks", "upsetting", "upsetting.lag")
    steels = os.path.join(SOURCE, "tests", "refused", "steel.met")
    for words, phrase in ((["--point", scene], "STATE: this is a deck of a scene, expected a deck of one point of a law; 'lagamine DECK' reads it"),
                          ([point], "PATH: this is a deck of one point of a law, expected a deck of a scene; 'lagamine --point DECK' reads it"),
                          ([steels], "STEEL: this is a file of steels, expected a deck of a scene; 'lagamine --met FILE' reads it"),
                          (["--met", point], "PATH: this is a deck of one point of a law, expected a file of steels")):
        result = run([*words, "--quiet"])
        checks.that(result.returncode == INPUT and phrase in result.stderr and len(result.stderr.splitlines()) == 1, f"{words}: one line", said(result))


def phases(checks):
    """code_aster's HSNV102: martensite forms under tension, without and with transformation plasticity."""
    deck = os.path.join(TENSION, "martensite.point")
    for trip, strains in (("0", (0.034283, 0.061978, 0.069844)), ("1", (0.051507, 0.101970, 0.109844))):
        path = follow(checks, "martensite" + trip, deck, "-p", "trip=" + trip)
        if not path:
            return
        for time, fraction, p, strain in zip((26.0, 40.0, 90.0), (0.259182, 0.988891, 1.0), (0.037217, 0.062523, 0.074074), strains):
            k = path["time"].index(time)
            near(checks, path["martensite"][k], fraction, 1.0, f"HSNV102, {time} s, {trip}: fraction", 1e-6)
            near(checks, path["plastic_strain"][k], p, p, f"HSNV102, {time} s, {trip}: plastic strain", 1e-4)
            near(checks, path["strain_yy"][k], strain, strain, f"HSNV102, {time} s, {trip}: strain", 1e-3)
            others = sum(path[name][k] for name in ("austenite", "ferrite", "pearlite", "bainite", "tempered"))
            near(checks, path["martensite"][k] + others, 1.0, 1.0, f"HSNV102, {time} s, {trip}: sum of fractions", 1e-12)
    text = deck_text(deck).replace("TIME 1.", "")
    shutil.copy(os.path.join(TENSION, "tension.met"), checks.path("tension.met"))
    alone = write(checks.path("alone.point"), text)
    result = run(["--point", alone])
    checks.that(result.returncode == INPUT and "is driven by 'austenite', which a point alone does not have" in result.stderr,
                "phases that nothing finds: refused", said(result))
    # a mistake in the steel's file is all that is told
    write(checks.path("wrong", "tension.met"), "STEEL w\nSOURCE 'none'\nTEMPS MS 300\nMARTEN BETA 0.011\nPHASE ALL\n   NUU 0.3\nEND\n")
    wrong = BASE.replace("   200000. 0.3\n   LINEAR 300. 1000.\n", "   STEEL tension.met w\n   STRESS 1.   TIME 1.\n").replace("EPLA", "ARBTHMET") \
        .replace("PATH   steel", "PATH   steel T 20.")
    result = run(["--point", write(checks.path("wrong", "a.point"), wrong)])
    checks.that(result.returncode == INPUT and "found 'NUU'" in result.stderr and "driven" not in result.stderr,
                "a mistake in the steel's file: told alone", said(result))


def refusals(checks):
    """One line with file and line; code 2; nothing is left behind."""
    for k, (old, new, line, phrase) in enumerate(REFUSED):
        name = f"refused{k}"
        assert BASE.count(old) == 1, old
        deck = write(checks.path(name + ".point"), BASE.replace(old, new))
        result = run(["--point", deck, "--out", checks.path(name)])
        reported = [text for text in result.stderr.splitlines() if text.startswith(deck)]
        checks.that(result.returncode == INPUT, f"'{new}': refused", said(result))
        checks.that(any(text.startswith(f"{deck}:{line}:") and phrase in text for text in reported), f"'{new}': line {line}, '{phrase}'", said(result))
        checks.that(not os.path.exists(checks.path(name)), f"'{new}': leaves nothing")
    for name, text, phrase in (("no_path", BASE.split("PATH")[0] + "END\n", "the deck has no such card"),
                               ("a_scene", deck_text(UPSETTING), "STATE: this is a deck of a scene")):
        result = run(["--point", write(checks.path(name + ".point"), text), "--out", checks.path(name)])
        checks.that(result.returncode == INPUT and phrase in result.stderr, f"{name}: refused", said(result))
    result = run(["--point", checks.path("warm.point"), "--resume", "a.h5"])
    checks.that(result.returncode == INPUT and "--resume" in result.stderr, "--resume: refused", said(result))


def failures(checks):
    """A stress beyond what the law can carry: code 3, the row, and the table up to there."""
    text = BASE.split("PATH")[0].replace("LINEAR 300. 1000.", "LINEAR 300. 0.")
    deck = write(checks.path("beyond.point"), text + "PATH steel\n   1. 10  S 400. S 0. S 0. S 0.\nEND\n")
    result = run(["--point", deck, "--out", checks.path("beyond")])
    checks.that(result.returncode == NO_CONVERGENCE and f"{deck}:7:" in result.stderr, "beyond yield: code 3 and the row", said(result))
    found = table(checks.path("beyond"), "beyond")[0]
    checks.that(len(found["time"]) == 8 and abs(found["stress_xx"][-1] - 280.0) < 1e-6, "beyond yield: the table up to there", found["stress_xx"])


def words(checks):
    """--check runs nothing; the screen names the point, ends of rows and the table; titles have units."""
    deck = write(checks.path("base.point"), BASE)
    result = run(["--point", deck, "--check", "--out", checks.path("checked")])
    checks.that(result.returncode == DONE and "20 steps until time 2" in result.stdout, "--check: states the path", said(result))
    checks.that(not os.path.exists(checks.path("checked")), "--check: runs nothing")
    result = run(["--point", deck, "--out", checks.path("reported")])
    lines = result.stdout.splitlines()
    checks.that(result.returncode == DONE and lines[0] == "Base" and lines[-1].startswith("done: 20 steps") and len(lines) == 7, "the screen", lines)
    titles = table(checks.path("reported"), "base")[1]
    checks.that(all(title.endswith("]") for title in titles) and "stress_xx [stress]" in titles and "plastic_work [stress]" in titles,
                "titles have units", titles)


def main():
    checks = Checks()
    tension(checks)
    shear_cycles(checks)
    large_shear(checks)
    there_and_back(checks)
    temperatures(checks)
    other_kinds(checks)
    phases(checks)
    refusals(checks)
    failures(checks)
    words(checks)
    checks.end()


if __name__ == "__main__":
    main()
