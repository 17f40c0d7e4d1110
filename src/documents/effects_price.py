#!/usr/bin/env python3
"""What each effect costs: one billet, pressed in the same steps, with one effect more from bar to bar; a stacked picture and a table.

usage: effects_price.py [--programs BIN] [--out FILE.svg]
Seconds of processor of one thread, shared out by the tasks that each run books (`seconds` in summary.json). Default: tests/bench/effects_price.svg.
"""
import argparse
import json
import os
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
sys.path.insert(0, os.path.join(ROOT, "src", "report"))
from lagamine_report.picture import Picture  # noqa: E402
from lagamine_report.style import LINES, figure  # noqa: E402

TAIL = "LIC    press\n   0. 0.   1. -0.6\nSTRAT  0.02 1.E-5 0.02   5 3\n"
STEPS = "NORMS  PATH 0. RATE 0.\n"
ELASTIC = "LAW    steel ELA\n   200000. 0.3\n"
PLASTIC = "LAW    steel EPLA\n   200000. 0.3\n   LINEAR 700. 300.\n"
HELD = "FIXED  billet 1 Y\nFIXED  billet 4 X\n"
PUSHED = "MOVE   billet 3 Y press\n"
DIE = "DIE    upper PILOT 0. 15.\n   SEGM  30. 15.   -1. 15.\nCNT2D  billet 2 3 upper -3 film\nMOVE   upper Y press\n"
SMOOTH = "LAW    film COUL2D\n   PENETR 1.E-3   PHI 0.\n"
ROUGH = "LAW    film COUL2D\n   PENETR 1.E-3   PHI 0.3\n"
HEAT = "ADDEL  billet PL8TM metal BILINEAR\nLAW    metal HEAT\n   50. 3.6\n   QUINNEY 0.9\nSTART  T 20.\n"
CHILL = "TDIE   upper T 20.\nCOU2DC billet 2 3 upper H 20. FRIC 1. SHARE 0.5\n"
REST = "the rest"
MARK = "<!-- effects -->"
# Each is the one before with one effect more: kinematics and cards.
BARS = [
    ("displacement", "SMALL", ELASTIC + HELD + PUSHED + STEPS),
    ("+ large strain", "LOG", ELASTIC + HELD + PUSHED + STEPS),
    ("+ plasticity", "LOG", PLASTIC + HELD + PUSHED + STEPS),
    ("+ contact", "LOG", PLASTIC + HELD + SMOOTH + DIE + STEPS),
    ("+ friction", "LOG", PLASTIC + HELD + ROUGH + DIE + STEPS),
    ("+ heat", "LOG", PLASTIC + HELD + ROUGH + DIE + HEAT + STEPS),
    ("+ heat at contact", "LOG", PLASTIC + HELD + ROUGH + DIE + HEAT + CHILL + STEPS),
    ("+ errors of the path", "LOG", PLASTIC + HELD + ROUGH + DIE + HEAT + CHILL),
    ("+ error estimates", "LOG", PLASTIC + HELD + ROUGH + DIE + HEAT + CHILL + "ESTIM\n"),
]


def run(programs, folder, kinematics, cards):
    """Seconds of processor by tasks, and the summary."""
    deck = os.path.join(folder, "bar.lag")
    with open(deck, "w", encoding="utf-8") as file:
        file.write(f"TITLE  billet\nSTATE  AXISYM\nKINEM  {kinematics}\nBLOCK  billet PL8LS 4 steel\n   0. 0.   10. 0.   10. 15.   0. 15.\n   16 1.   24 1.\n"
                   + cards + TAIL + "END\n")
    out = os.path.join(folder, "out")
    subprocess.run([os.path.join(programs, "lagamine"), deck, "--out", out, "--quiet", "--threads", "1"], check=True)
    with open(os.path.join(out, "summary.json"), encoding="utf-8") as file:
        summary = json.load(file)
    booked = summary["seconds"]
    # tasks are timed on the wall; beside other work that is more than what the processor took
    share = min(1.0, summary["cpu_s"] / max(sum(booked.values()), 1e-9))
    seconds = {task: share * value for task, value in booked.items()}
    seconds[REST] = max(summary["cpu_s"] - sum(seconds.values()), 0.0)
    return seconds, summary


def put(table):
    """The table into the page of the benchmarks, between its marks."""
    page = os.path.join(ROOT, "tests", "bench", "README.md")
    with open(page, encoding="utf-8") as file:
        old = file.read()
    first, _, rest = old.partition(MARK + "\n")
    _, _, last = rest.partition(MARK)
    with open(page, "w", encoding="utf-8") as file:
        file.write(first + MARK + "\n" + table + "\n" + MARK + last)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--programs", default=os.path.join(ROOT, "build", "bin"))
    parser.add_argument("--out", default=os.path.join(ROOT, "tests", "bench", "effects_price.svg"))
    options = parser.parse_args()
    bars = []
    for title, kinematics, cards in BARS:
        with tempfile.TemporaryDirectory() as folder:
            bars.append((title, *run(options.programs, folder, kinematics, cards)))
    tasks = sorted({task for _, seconds, _ in bars for task in seconds if task != REST}, key=lambda task: -max(seconds.get(task, 0.0) for _, seconds, _ in bars))
    # as many as there are colours, the rest in one
    shown, rest = tasks[:len(LINES) - 1], tasks[len(LINES) - 1:]
    if rest:
        for _, seconds, _ in bars:
            seconds[REST] = sum([seconds.pop(task, 0.0) for task in {REST, *rest}])
        shown.append(REST)
    fig, axes = figure(1, 1, (8.0, 4.2))
    panel = axes.flat[0]
    left = [0.0] * len(bars)
    for task, colour in zip(shown, LINES):
        widths = [seconds.get(task, 0.0) for _, seconds, _ in bars]
        panel.barh([title for title, _, _ in bars], widths, left=left, label=task, color=colour)
        left = [a + b for a, b in zip(left, widths)]
    panel.invert_yaxis()
    panel.set_xlabel("seconds of processor")
    panel.legend(fontsize=7)
    picture = Picture("effects_price", "what each effect costs", fig, vector=True)
    with open(options.out, "wb") as file:
        file.write(picture.svg())
    lines = ["| with | s | iterations | equations | " + " | ".join(shown) + " |", "|" + "---|" * (4 + len(shown))]
    for title, seconds, summary in bars:
        lines.append(f"| {title} | {sum(seconds.values()):.2f} | {summary['iterations']} | {summary['dofs']} | "
              + " | ".join(f"{seconds[task]:.2f}" if task in seconds else "–" for task in shown) + " |")
    put("\n".join(lines))
    print("\n".join(lines))


if __name__ == "__main__":
    main()
