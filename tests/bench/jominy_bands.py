#!/usr/bin/env python3
"""How deep Li's kinetics harden: the end-quench test of five steels against the bands of SAE J1268, a table of decks/jominy/README.md.

usage: jominy_bands.py [--write]

Each steel of jominy.met is run by the deck as it is; hardness at sixteenths of an inch from the quenched end is compared with its band in
bands.csv (HRC, turned into HV by ASTM E 140). --write puts the table between the lines <!-- bands --> of the README.
"""
import csv
import os
import re
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
FOLDER = os.path.join(ROOT, "decks", "jominy")
LAGAMINE = os.path.join(os.environ.get("LAGAMINE_BIN") or os.path.join(ROOT, "build", "bin"), "lagamine")
# ASTM E 140, HV of 20, 21, ... HRC
VICKERS = (238, 243, 248, 254, 260, 266, 272, 279, 286, 294, 302, 310, 318, 327, 336, 345, 354, 363, 372, 382, 392, 402, 412, 423, 434, 446, 458,
           471, 484, 498, 513, 528, 544, 560, 577, 595, 613, 633, 653, 674, 697, 720, 746, 772, 800, 832)
SHOWN = (1, 2, 3, 4, 5, 6, 8, 12, 16, 24)


def bands():
    """By steel: least and most HV by sixteenths; below 20 HRC nothing is said."""
    with open(os.path.join(FOLDER, "bands.csv"), newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    steels = {}
    for row in rows:
        least = VICKERS[int(row["least"]) - 20] if row["least"] else 0
        steels.setdefault(row["steel"], {})[int(row["sixteenths"])] = (least, VICKERS[int(row["most"]) - 20])
    return steels


def hardness(steel, folder):
    """HV at the end by sixteenths."""
    out = os.path.join(folder, steel)
    subprocess.run([LAGAMINE, os.path.join(FOLDER, "jominy.lag"), "--out", out, "--quiet", "-p", f"grade={steel}"], check=True)
    with open(os.path.join(out, "history.csv"), newline="", encoding="utf-8") as file:
        titles, *rows = csv.reader(file)
    last = {title.partition(" [")[0]: float(value) for title, value in zip(titles, rows[-1])}
    return {int(name[1:]): value for name, value in last.items() if re.fullmatch(r"j[0-9]+", name)}


def cell(found, band):
    """A place of the table: HV, and how far it is beyond the band."""
    least, most = band
    beyond = found - most if found > most else min(found - least, 0)
    return f"{found:.0f}" + (f" ({beyond:+.0f})" if abs(beyond) >= 0.5 else "")


def main():
    rows = ["| steel | " + " | ".join(f"{k}/16" for k in SHOWN) + " | places in the band |", "|---" * (len(SHOWN) + 2) + "|"]
    with tempfile.TemporaryDirectory() as folder:
        for steel, band in bands().items():
            found = hardness(steel, folder)
            inside = sum(least - 0.5 < found[k] < most + 0.5 for k, (least, most) in band.items())
            cells = [cell(found[k], band[k]) if k in band else f"{found[k]:.0f}" for k in SHOWN]
            rows.append(f"| `{steel}` | " + " | ".join(cells) + f" | {inside} of {len(band)} |")
    print("\n".join(rows))
    if "--write" in sys.argv[1:]:
        page = os.path.join(FOLDER, "README.md")
        with open(page, encoding="utf-8") as file:
            text = file.read()
        with open(page, "w", encoding="utf-8") as file:
            file.write(re.sub(r"(<!-- bands -->\n).*?(<!-- bands -->)", lambda m: m[1] + "\n".join(rows) + "\n" + m[2], text, flags=re.DOTALL))


if __name__ == "__main__":
    main()
