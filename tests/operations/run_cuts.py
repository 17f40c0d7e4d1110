#!/usr/bin/env python3
"""Cuts: trimming along a line (TRIM) and webs that part (PIERC), by closed forms; cycles killed on the way.

usage: run_cuts.py [-v] [-k] [--seed N]

- `flash`: a disc pressed without friction, its rim cut off, pressed on. The volume removed is pi (R^2 - c^2) h, with R and h where nodes are;
  what is left keeps its plastic strain, which is the same everywhere, and the next stroke bears the force of a disc of radius c.
- `heat`: a block of 25 in thickness whose temperature rises in proportion to x, cut along an inclined line: the volume, and the heat that is left, which closed forms give.
- `shaved`: as `heat`, less than a thousandth of the volume: a mean of the whole is none of what is left.
- `punch`: a blank without hardening, punched through. The slug's volume is that of the cut; the force at the cut is near that of shear along
  the web, 2 pi r w k, between one time it (nothing but shear) and twice (pressed together as well).
- `through`: punches of two edge radii go through the blank; the slug's volume is that under the punch, and what the cut leaves is no lip.
- `corner`: a corner of the disc cut off, whose surface belongs to both sides of a contact.
- killed at random and gone on with by the same command, `flash` comes to the same history.
- Lines beside the part, through its inside, and that leave two pieces are refused, each in one line.
"""
import csv
import math
import os
import random
import signal
import subprocess
import sys
import time

sys.dont_write_bytecode = True
TESTS = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path[:0] = [os.path.join(TESTS, folder) for folder in ("runs", "cycle", "patch")]
from remeshed import CYCLE, cycle, tries  # noqa: E402
from support import DONE, Checks, history, run, said, summary, with_h5py, write  # noqa: E402

INPUT = 2
FLASH = """TITLE  Disc pressed, trimmed, pressed on
STATE  AXISYM
KINEM  LOG
BLOCK  disc PL8LS 4 metal
   0. 0.   10. 0.   10. 6.   0. 6.
   6 1.   4 1.
LAW    metal EPLA
   70000. 0.33
   LINEAR 200. 200.
LAW    film COUL2D
   PENETR 1.E-4   PHI 0.   AUGMENT 10
FIXED  disc 1 Y
FIXED  disc 4 X
STRAT  0.02 1.E-6 0.1   6 3
PROBE  height NODE UY 0. 6.
PROBE  radius NODE UX 10. 0.
PROBE  least MIN plastic_strain disc
PROBE  most MAX plastic_strain disc
REMSH
CKPT   1
OPERA  press
DIE    upper PILOT 0. 6.
   SEGM   40. 6.   -1. 6.
CNT2D  disc 2 3 upper film
LIC    press
   0. 0.   1. -1.
MOVE   upper Y press
OPERA  trim
CUT
STOP   0.1
OPERA  again
DIE    upper PILOT 0. 5.1
   SEGM   40. 5.1   -1. 5.1
CNT2D  disc 2 3 upper film
LIC    press
   0. 0.   1. -0.6
MOVE   upper Y press
END
"""
CUT = "TRIM   disc 9. -1. 9. 7. KEEP 0. 0."
HEAT = """TITLE  Hot block cut along a line
STATE  PLSTN 25.
KINEM  SMALL
BLOCK  block PL8TM 4 metal BILINEAR
   0. 0.   10. 0.   10. 6.   0. 6.
   5 1.   3 1.
LAW    metal HEAT
   20. 3.6
START  T 20.
STRAT  0.5 1.E-6 1.E9   6 3
PROBE  cold NODE T 0. 0.
PROBE  inside NODE T 4. 3.
PROBE  gone NODE T 10. 6.
PROBE  beside NODE T 8.2 0.
PROBE  edge NODE T 7.5 0.
REMSH
OPERA  warm
IMPOS  block 4 T low
IMPOS  block 2 T high
LIC    low
   0. 20.
LIC    high
   0. 120.
STOP   1.E6
OPERA  cut
TRIM   block 8. -1. 4. 7. KEEP 0. 0.
STOP   0.001
END
"""
FORK = """TITLE  Fork that is to be cut
STATE  PLSTN
KINEM  SMALL
BODY   fork PL8TM 4 metal BILINEAR
   SEGM   0. 0.   6. 0.
   SEGM   6. 0.   6. 6.
   SEGM   6. 6.   4. 6.
   SEGM   4. 6.   4. 2.
   SEGM   4. 2.   2. 2.
   SEGM   2. 2.   2. 6.
   SEGM   2. 6.   0. 6.
   SEGM   0. 6.   0. 0.
LAW    metal HEAT
   20. 3.6
START  T 20.
STRAT  0.5 1.E-6 1.E9   6 3
REMSH
   SIZE 0.5 1.
OPERA  wait
STOP   1.
OPERA  cut
CUT
STOP   1.
END
"""
PUNCH = """TITLE  Blank punched through
STATE  AXISYM
KINEM  LOG
BLOCK  blank PL8LS 4 metal
   0. 0.   18. 0.   18. 4.   0. 4.
   15 1.   5 1.
LAW    metal EPLA
   200000. 0.3
   LINEAR 300. 0.
LAW    film COUL2D
   PENETR 1.E-3   PHI 0.05
DIE    punch PILOT 0. 4.
   SEGM   10. 14.   10. 4.
   FILLT  0.4 1.E-3
   SEGM   10. 4.   -1. 4.
DIE    floor
   SEGM   10.3 -10.   10.3 0.
   FILLT  0.4 1.E-3
   SEGM   10.3 0.   30. 0.
DIE    other PILOT 30. 9.
   SEGM   40. 9.   15. 9.
CNT2D  blank 1 floor film
CNT2D  blank 3 punch film
CNT2D  blank 2 3 other film
FIXED  blank 4 X
LIC    down
   0. 0.   1. -2.
MOVE   punch Y down
STRAT  0.02 1.E-6 0.05   5 3
REMSH
PIERC  blank other WEB 1.
PIERC  blank punch WEB 2.6
END
"""


def volume_of(checkpoint):
    """Volume of the 8-node elements of a checkpoint of a scene of revolution, where its nodes are now."""
    import h5py   # with_h5py has found a Python that has it
    import numpy as np
    from patch_support import quad8
    with h5py.File(checkpoint, "r") as file:
        x = file["mesh/coordinates"][()] + file["fields/displacement/value"][()]
        elements = file["groups/1/connectivity"][()] - 1
    points, weights = np.polynomial.legendre.leggauss(4)
    total = 0.0
    for r, a in zip(points, weights):
        for s, b in zip(points, weights):
            n, (nr, ns) = quad8(r, s)
            dr, ds = (np.einsum("k,ekc->ec", one, x[elements]) for one in (nr, ns))
            total += a * b * np.sum((dr[:, 0] * ds[:, 1] - dr[:, 1] * ds[:, 0]) * (x[elements][:, :, 0] @ n))
    return 2 * math.pi * total


def pressed(checks, deck):
    """Volumes, strain and force of the trimmed disc."""
    out = checks.path("flash")
    result = cycle(deck, out, "--quiet")
    if not checks.that(result.returncode == DONE, "flash: done", result.stdout + result.stderr):
        return None
    rows = history(out)
    last = [k for k in range(len(rows["operation"])) if k + 1 == len(rows["operation"]) or rows["operation"][k + 1] != rows["operation"][k]]
    cut = summary(out, "summary.trim.json")
    released, told = last[1], cut["cuts"][0]
    # the rim goes with the cut, and its probes with it: the released disc has the volume of the whole
    height = 6 + rows["height"][released]
    checks.that(math.isnan(rows["radius"][released]) and rows["radius"][last[0]] > 0.8, "flash: a probe of what was cut off is nan",
                rows["radius"][released])
    whole = 6 * math.pi * 10**2
    checks.that(told["made"] and told["generation"] == 3, "flash: cut on mesh 3", told)
    checks.that(abs(told["volume_removed"] / (whole - math.pi * 81 * height) - 1) < 1e-3, "flash: volume removed",
                (told["volume_removed"], whole - math.pi * 81 * height))
    left = volume_of(os.path.join(out, "deck.g03.start.h5"))
    checks.that(abs(told["volume_removed"] + left - whole) < 1e-4 * whole, "flash: removed and left are the whole", told["volume_removed"] + left - whole)
    checks.that(abs(cut["checks"]["volume_drift"]) < 1e-4, "flash: no drift of the volume", cut["checks"]["volume_drift"])
    before, after = ((rows["least"][k], rows["most"][k]) for k in (last[0], released))
    checks.that(before[0] - 1e-9 <= after[0] <= after[1] <= before[1] + 1e-9 and before[1] / before[0] - 1 < 1e-3,
                "flash: plastic strain over the cut", (before, after))
    column = [one["removed_volume [volume]"] for one in tries(out)]
    checks.that(any(value and abs(float(value) - told["volume_removed"]) < 1e-9 * whole for value in column), "flash: cycle.csv", column)
    with open(os.path.join(out, "deck.log"), encoding="utf-8") as file:
        checks.that("disc trimmed at time" in file.read(), "flash: listing")
    # without friction the disc stays one: the flow stress over the area now
    volume, now = left, 5.1 - 0.6
    flow = 200 + 200 * rows["most"][-1]
    force = abs(rows["force_y_upper"][-1])
    checks.that(abs(force / (flow * volume / now) - 1) < 2e-3, "flash: force of the next stroke", (force, flow * volume / now))
    checks.that(abs(summary(out)["checks"]["energy_imbalance"]) < 0.01, "flash: energy", summary(out)["checks"]["energy_imbalance"])
    return out


def warm(checks):
    """A linear temperature, cut: the line x = 8 - (y + 1)/2 over 0 <= y <= 6."""
    out = checks.path("heat")
    result = cycle(write(os.path.join(checks.folder, "heat.lag"), HEAT), out, "--quiet")
    if not checks.that(result.returncode == DONE, "heat: done", result.stdout + result.stderr):
        return
    ends = [8 - 0.5 * (y + 1) for y in (0, 6)]
    area = 6 * sum(ends) / 2
    told = summary(out)["cuts"][0]
    removed = 25 * (60 - area)
    checks.that(abs(told["volume_removed"] - removed) < 1e-9 * 25, "heat: volume removed, of the thickness", (told["volume_removed"], removed))
    column = [one["removed_volume [volume]"] for one in tries(out)]
    checks.that(any(value and abs(float(value) - removed) < 1e-6 for value in column), "heat: cycle.csv", column)
    import h5py   # with_h5py has found a Python that has it
    with h5py.File(os.path.join(out, "heat.g03.start.h5"), "r") as file:
        x = file["mesh/coordinates"][()]
        error = abs(file["fields/temperature/value"][()][:, 0] - (20 + 10 * x[:, 0])).max()
        far = (x[:, 0] - 8 + 0.5 * (x[:, 1] + 1)).max()
    checks.that(error < 1e-6 * 100, "heat: the temperature of what is left", error)
    checks.that(abs(far) < 1e-9 * 10, "heat: nothing is left beyond the line", far)
    rows = history(out)
    checks.that(math.isnan(rows["gone"][-1]) and rows["gone"][0] > 0, "heat: a probe of what was cut off is nan", rows["gone"][-1])
    # outside by less than an element, and on the cut
    checks.that(math.isnan(rows["beside"][-1]), "heat: a probe beside the cut is nan", rows["beside"][-1])
    checks.that(abs(rows["edge"][-1] - 95) < 10, "heat: a probe on the cut reads the node there", rows["edge"][-1])
    checks.that(abs(rows["inside"][-1] - 60) < 10, "heat: a probe of what is left reads the node next to it", rows["inside"][-1])
    checks.that(abs(summary(out)["checks"]["heat_imbalance"]) < 1e-6, "heat: balance", summary(out)["checks"]["heat_imbalance"])


def shaved(checks):
    """A corner of the hot side: what is left keeps its temperatures, and is no less hot for it."""
    deck = write(os.path.join(checks.folder, "shaved.lag"), HEAT.replace("TRIM   block 8. -1. 4. 7.", "TRIM   block 9.7 6. 10. 5.7"))
    out = checks.path("shaved")
    result = cycle(deck, out, "--quiet")
    if not checks.that(result.returncode == DONE, "shaved: done", result.stdout + result.stderr):
        return
    told = summary(out)["cuts"][0]["volume_removed"]
    checks.that(abs(told / (25 * 0.3**2 / 2) - 1) < 1e-6, "shaved: volume removed", told)
    import h5py   # with_h5py has found a Python that has it
    with h5py.File(os.path.join(out, "shaved.g03.start.h5"), "r") as file:
        x = file["mesh/coordinates"][()]
        error = abs(file["fields/temperature/value"][()][:, 0] - (20 + 10 * x[:, 0])).max()
    # with the mean of the whole it would be 0.1
    checks.that(error < 1e-6 * 100, "shaved: the temperature of what is left", error)


def punched(checks):
    """Volume and force of a slug."""
    out = checks.path("punch")
    result = cycle(write(os.path.join(checks.folder, "punch.lag"), PUNCH), out, "--quiet")
    if not checks.that(result.returncode == DONE, "punch: done", result.stdout + result.stderr):
        return
    idle, told = summary(out)["cuts"]
    warned = [one["text"] for one in summary(out)["warnings"]]
    checks.that(not idle["made"] and any("has not parted under other" in text for text in warned), "punch: a web that has not parted is told", (idle, warned))
    if not checks.that(told["made"], "punch: parted", told):
        return
    shear = 2 * math.pi * 10.15 * told["web"] * 300 / math.sqrt(3)
    checks.that(1 < told["force"] / shear < 2, "punch: force over that of shear", told["force"] / shear)
    slug = math.pi * 10.15**2 * 4
    checks.that(abs(told["volume_removed"] / slug - 1) < 0.03, "punch: volume of the slug over that of the hole", told["volume_removed"] / slug)
    rows = history(out)
    drift = summary(out)["checks"]["volume_drift"]
    checks.that(abs(drift) < 2e-3, "punch: drift of the volume", drift)
    # the web that is cut out is pressed together otherwise than what is left
    drift = summary(out)["checks"]["volume_drift_unloaded"]
    checks.that(abs(drift) < 1e-4, "punch: drift without elastic strain", drift)
    at = min(range(len(rows["time"])), key=lambda k: abs(rows["time"][k] - told["time"]))
    checks.that(abs(abs(rows["force_y_punch"][at]) / told["force"] - 1) < 0.05, "punch: force in the history", rows["force_y_punch"][at])


def punched_through(checks):
    """The cut begins where the punch ends: no lip is left under its edge, which it would fold until no mesh fits it."""
    for radius in (0.2, 0.7):
        out = checks.path(f"through-{radius}")
        text = PUNCH.replace("1. -2.", "1. -4.5").replace("FILLT  0.4", f"FILLT  {radius}", 1)
        result = cycle(write(os.path.join(checks.folder, "through.lag"), text), out, "--quiet")
        if not checks.that(result.returncode == DONE, f"through, {radius}: done", said(result)):
            continue
        slug = math.pi * 10**2 * 4
        removed = summary(out)["cuts"][1]["volume_removed"]
        checks.that(abs(removed / slug - 1) < 0.06, f"through, {radius}: volume of the slug over that under the punch", removed / slug)


def corner_cut(checks):
    """A cut that leads from one of the sides of a contact to the other belongs to both, and is there once."""
    out = checks.path("corner")
    first, rest = FLASH.split("OPERA  trim\n")
    again = rest.split("OPERA  again\n")[1]
    text = first + "OPERA  trim\nTRIM   disc  16. 1.   6. 7.  KEEP 1. 1.\n" + again
    result = cycle(write(os.path.join(checks.folder, "corner.lag"), text), out, "--quiet")
    checks.that(result.returncode == DONE, "corner: done", said(result))


def same_history(one, other):
    with open(os.path.join(one, "history.csv"), newline="", encoding="utf-8") as a, \
            open(os.path.join(other, "history.csv"), newline="", encoding="utf-8") as b:
        return list(csv.reader(a)) == list(csv.reader(b))


def killed(checks, deck, whole, seed, number):
    """Killed, all processes at once, and gone on with until it ends."""
    draw = random.Random(seed)
    landed = 0
    out = checks.path("killed")
    for kill in range(number + 1):
        process = subprocess.Popen([CYCLE, deck, "--out", out, "--threads", "1", "--quiet"], stdin=subprocess.DEVNULL,
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
        if kill < number:
            time.sleep(draw.uniform(0.05, 0.6))
            if process.poll() is None:
                landed += 1
                os.killpg(process.pid, signal.SIGKILL)
        process.wait()
    checks.that(landed > 0, "killed: at least once before its end", landed)
    checks.that(process.returncode == DONE and same_history(whole, out), f"killed {landed} times: the same history", process.returncode)


def refused(checks):
    """Lines that cut nothing, end within, or leave two pieces."""
    for name, cut, phrase in (
            ("beside", "9. -1. 9. 7. KEEP 0. 0.", "does not cross the body"),
            ("along", "5.99 -1. 5.99 7. KEEP 0. 0.", "is along the side of the body, so that nothing is cut"),
            ("within", "3. -1. 3. 1. KEEP 0. 0.", "begins or ends within the body"),
            ("pieces", "-1. 4. 7. 4. KEEP 1. 5.", "leaves 2 pieces of the body")):
        deck = write(os.path.join(checks.folder, f"{name}.lag"), FORK.replace("CUT", "TRIM   fork " + cut))
        result = cycle(deck, checks.path(name), "--quiet")
        lines = [line for line in result.stderr.splitlines() if "TRIM" in line]
        checks.that(result.returncode == INPUT and len(lines) == 1 and phrase in lines[0], f"{name}: refused in one line",
                    (result.returncode, result.stderr))


def joined(checks):
    """A body that shares its sides with another one of the same law is not cut: the deck is refused before anything runs."""
    blocks = ("BLOCK  fork PL8TM 4 metal BILINEAR\n   0. 0.   6. 0.   6. 3.   0. 3.\n   6 1.   3 1.\n"
              "BLOCK  top PL8TM 4 metal BILINEAR\n   0. 3.   6. 3.   6. 6.   0. 6.\n   6 1.   3 1.\nJOIN   fork 3 top 1\n")
    text = FORK[:FORK.index("BODY")] + blocks + FORK[FORK.index("LAW "):]
    deck = write(os.path.join(checks.folder, "joined.lag"), text.replace("CUT", "TRIM   fork 5. -1. 5. 7. KEEP 0. 0."))
    for result in (run([deck, "--check"]), cycle(deck, checks.path("joined"), "--quiet")):
        checks.that(result.returncode == INPUT and "'fork' shares sides with 'top'" in result.stderr, "joined: refused",
                    (result.returncode, result.stderr))


def main():
    with_h5py()
    checks = Checks()
    seed = int(sys.argv[sys.argv.index("--seed") + 1]) if "--seed" in sys.argv else 1123
    deck = write(os.path.join(checks.folder, "deck.lag"), FLASH.replace("CUT\n", CUT + "\n"))
    whole = pressed(checks, deck)
    warm(checks)
    shaved(checks)
    punched(checks)
    punched_through(checks)
    corner_cut(checks)
    if whole:
        killed(checks, deck, whole, seed, 4)
    refused(checks)
    joined(checks)
    checks.end()


if __name__ == "__main__":
    main()
