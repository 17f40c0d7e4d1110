#!/usr/bin/env python3
"""The shipped decks that come of an import: imported anew they are the same cards; they run, are remeshed, and give their references.

usage: run_decks.py [--write]     --write puts the tables into the READMEs of the decks
"""
import csv
import os
import re
import shutil
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "runs"))
from importing import BIN, SOURCE, lagaimport, run  # noqa: E402
from support import Checks  # noqa: E402

DECKS = os.path.join(SOURCE, "decks")
MARK = "<!-- table -->"
# deck: file, cards, how it was imported, new meshes at least
IMPORTS = {
    "import_rib": ("rib.dxf", "rib.inc", ["--body", "billet", "--die", "die", "--rename", "die=upper", "--tolerance", "1e-3", "--pilot", "0", "12",
                                          "--law", "metal"], 3),
    "import_tooth": ("tooth.msh", "tooth.inc", ["--law", "steel"], 1),
    "import_ring": ("ring.inp", "ring.inc", ["--rename", "Ering=ring", "--sides", "bottom", "--sides", "top", "--sides", "inner"], 1),
}
checks = Checks()
check = checks.that


def cards(path):
    """An included file without its first line, which names the version."""
    with open(path, encoding="ascii") as file:
        return file.read().split("\n", 1)[1]


def imported(name, folder, *more, file=None):
    """The deck's folder copied, its cards made anew; the deck."""
    source, target, options, _ = IMPORTS[name]
    own = os.path.join(folder, name)
    shutil.rmtree(own, ignore_errors=True)
    shutil.copytree(os.path.join(DECKS, name), own)
    os.remove(os.path.join(own, target))
    done = lagaimport(file or os.path.join(own, source), "--out", os.path.join(own, target), *options, *more)
    check(done.returncode == 0, f"{name}: lagaimport", done.stderr)
    return os.path.join(own, name + ".lag")


def results(deck, folder):
    """Columns of the history at the end of a run, and the number of meshes."""
    out = os.path.join(folder, "out")
    shutil.rmtree(out, ignore_errors=True)
    done = run(os.path.join(BIN, "lagacycle"), deck, "--out", out, "--quiet", OMP_NUM_THREADS="1")
    check(done.returncode == 0, f"{os.path.basename(deck)}: lagacycle", done.stdout[-300:] + done.stderr)
    with open(os.path.join(out, "history.csv"), encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    meshes = len([name for name in os.listdir(out) if re.search(r"\.g\d+\.h5$", name)])
    with open(os.path.join(out, "summary.json"), encoding="utf-8") as file:
        check('"status": "done"' in file.read().replace('":"', '": "'), f"{os.path.basename(deck)}: done")
    return {name.split(" ")[0]: float(value) for name, value in rows[-1].items()}, meshes


def table(name, head, rows, write):
    """The table of a README, written anew."""
    if not write:
        return
    path = os.path.join(DECKS, name, "README.md")
    with open(path, encoding="utf-8") as file:
        before, _, after = file.read().split(MARK)
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)] + ["| " + " | ".join(map(str, row)) + " |" for row in rows]
    with open(path, "w", encoding="utf-8") as file:
        file.write(before + MARK + "\n" + "\n".join(lines) + "\n" + MARK + after)


def close(found, wanted, percent, what):
    """Within a share of what is wanted; the deviation in percent."""
    off = 100 * (found / wanted - 1)
    check(abs(off) <= percent, what, f"{found:g}, wanted {wanted:g}: {off:+.2f} %")
    return f"{off:+.2f}"


def rib(folder, write):
    """The force depends little on how near the parabolas are to the drawing."""
    runs = {}
    for tolerance in ("1e-3", "1e-4", "1e-2"):
        deck = imported("import_rib", folder, "--tolerance", tolerance)
        if tolerance == "1e-3":
            found = cards(os.path.join(folder, "import_rib", "rib.inc"))
            check(found == cards(os.path.join(DECKS, "import_rib", "rib.inc")), "rib.inc imported anew")
        rows = sum(line.lstrip().startswith("PARAB") for line in cards(os.path.join(folder, "import_rib", "rib.inc")).split("\n"))
        runs[tolerance] = (*results(deck, folder), rows)
        check(runs[tolerance][1] >= 3, "import_rib: new meshes", runs[tolerance][1])
    best = runs["1e-4"][0]
    lines = []
    for tolerance, (last, _, rows) in sorted(runs.items(), reverse=True, key=lambda item: float(item[0])):
        lines.append([tolerance, rows, f"{last['force_y_upper'] / 1e3:.1f}", close(last["force_y_upper"], best["force_y_upper"], 1.0, f"force, tolerance {tolerance}"),
                      f"{last['rim']:.4f}", close(last["rim"], best["rim"], 0.05, f"rim, tolerance {tolerance}")])
        # the billet's volume: of the elastic change only
        check(abs(last["volume_drift"]) < 0.02, "volume", last["volume_drift"])
    table("import_rib", ("tolerance mm", "parabolas of the crown", "force kN", "of that at 1e-4 %", "rim mm", "%"), lines, write)


def tooth(folder, write):
    """Against the same tooth on a mesh of Gmsh with twice as many elements each way."""
    deck = imported("import_tooth", folder)
    check(cards(os.path.join(folder, "import_tooth", "tooth.inc")) == cards(os.path.join(DECKS, "import_tooth", "tooth.inc")), "tooth.inc imported anew")
    last, meshes = results(deck, folder)
    check(meshes >= 2, "import_tooth: new meshes", meshes)
    lines = [["84", "yes", f"{last['force_y_tool'] / 1e3:.3f}", ""]]
    if shutil.which("gmsh"):
        with open(os.path.join(DECKS, "import_tooth", "tooth.geo"), encoding="utf-8") as file:
            text = file.read()
        double = re.sub(r"(Transfinite Curve\{[\d, ]+\} = )(\d+)", lambda m: m.group(1) + str(2 * int(m.group(2)) - 1), text)
        double = double.replace("0.9;", "Sqrt(0.9);").replace("1.05;", "Sqrt(1.05);")
        geo = os.path.join(folder, "double.geo")
        with open(geo, "w", encoding="utf-8") as file:
            file.write(double)
        made = run("gmsh", "-2", geo, "-o", os.path.join(folder, "double.msh"))
        check(made.returncode == 0, "gmsh", made.stdout[-300:])
        deck = imported("import_tooth", folder, file=os.path.join(folder, "double.msh"))
        fine = results(deck, folder)[0]
        off = close(last["force_y_tool"], fine["force_y_tool"], 3.0, "force of the tool")
        lines = [["84", "yes", f"{last['force_y_tool'] / 1e3:.3f}", off], ["336", "yes", f"{fine['force_y_tool'] / 1e3:.3f}", ""]]
        table("import_tooth", ("elements at the start", "remeshed", "force on half a tooth kN", "of the finer %"), lines, write)


def uniform_ring(folder):
    """The ring as a block of 24 x 32 elements in the place of the imported mesh, without new meshes."""
    with open(os.path.join(DECKS, "import_ring", "import_ring.lag"), encoding="utf-8") as file:
        text = file.read()
    remesh = text[text.index("REMSH"):text.index("PRES2D")]
    block = "BLOCK  ring PL8LS 4 metal\n   10. 0. 16. 0. 14. 8. 10. 8.\n   24 1. 32 1.\n   SIDE 2 MID 15.5 4.\n"
    for old, new in ((remesh, ""), ("INCLU  ring.inc\n", block), ("bottom XY", "ring 1 XY"), ("FIXED  top", "FIXED  ring 3"),
                     ("MOVE   top", "MOVE   ring 3"), ("PRES2D inner", "PRES2D ring 4"), ("REACT Y top", "REACT Y ring 3")):
        check(text.count(old) == 1, "import_ring.lag has once", old)
        text = text.replace(old, new)
    deck = os.path.join(folder, "uniform.lag")
    with open(deck, "w", encoding="utf-8") as file:
        file.write(text)
    return deck


def ring(folder, _write):
    """Remeshed against the same ring on 24 x 32 elements that are never remeshed; CalculiX's numbers are in reference.csv."""
    fine = results(uniform_ring(folder), folder)[0]
    deck = imported("import_ring", folder)
    check(cards(os.path.join(folder, "import_ring", "ring.inc")) == cards(os.path.join(DECKS, "import_ring", "ring.inc")), "ring.inc imported anew")
    last, meshes = results(deck, folder)
    check(meshes >= 2, "import_ring: new meshes", meshes)
    for name in ("force", "waist"):
        print(f"import_ring: {name} {last[name]:.6g}, without new meshes {fine[name]:.6g}")
        close(last[name], fine[name], 1.0, f"import_ring: {name}")


def main():
    write = "--write" in sys.argv[1:]
    for one in (rib, tooth, ring):
        one(checks.folder, write)
    checks.end()


if __name__ == "__main__":
    main()
