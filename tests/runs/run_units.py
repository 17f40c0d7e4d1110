#!/usr/bin/env python3
"""No number of the solver has a unit: the billet in mm-N-MPa, in m-N-Pa, in inches and pounds, and in units of no one, takes the
same steps and iterations up to 60 % and gives the same forces, to 1e-9.

usage: run_units.py [-v] [-k]       -v prints every check, -k keeps the results
`section`: a bar that is bent across between sections that are free, of thickness 1 in whatever unit: what is found does not depend on it,
nor which of several points that are as near PROBE takes.
The `binary` units are powers of two of mm, MPa and s: there even the round-off is the same, so the whole history must be, bit by bit.
In the others the last bits differ; that they stay last bits while the side folds onto the die shows that no decision hangs on them.
"""
import sys

sys.dont_write_bytecode = True
from support import DONE, Checks, history, run, said, write  # noqa: E402

# Units of length in mm, of stress in MPa, of time in s.
UNITS = {"mm-N-MPa": (1.0, 1.0, 1.0), "m-N-Pa": (1.0e3, 1.0e-6, 1.0), "in-lbf-psi": (25.4, 4.4482216152605 / 25.4**2, 1.0),
         "nm-TPa-hour": (1.0e-6, 1.0e6, 3600.0), "binary": (2.0**12, 2.0**-22, 2.0**6)}
TOLERANCE = 1.0e-9
STICK = "LAW    stick GLUE2D\n   PENETR 1.E-3   AUGMENT 10\n"

# The billet with all that has a dimension: sticking by gluing, sliding friction with a bound and cohesion, given penalties.
DECK = """TITLE  Billet in {name}
STATE  AXISYM
KINEM  LOG
BLOCK  billet PL8LS 4 steel
   0. 0.   {L:10} 0.   {L:10} {L:15}   0. {L:15}
   {nx} 1.   {ny} 1.
LAW    steel EPLA
   {S:200000} 0.3
   {hardening}
LAW    rough COUL2D
   {rough}
{stick}DIE    upper PILOT 0. {L:15}
   SEGM  {L:30} {L:15}   {L:-1} {L:15}
CNT2D  {end}
CNT2D  billet 2 upper 2 rough
FIXED  billet 1 Y
FIXED  billet 4 X
LIC    press
   0. 0.   {T:1} {L:-9}
MOVE   upper Y press
{more}STRAT  {T:0.01} {T:1e-5} {T:0.05}   5 3
STOP   {T:1}
END
"""
GLUED = {"end": "billet 3 upper 2 stick", "rough": "PENETR 1.E-3   PHI 0.5   AUGMENT 10", "hardening": "LINEAR {S:700} {S:300}",
         "more": ""}
SLIDING = {"end": "billet 3 upper 2 rough", "rough": "AKP {P:60000}   AKTAU {P:6000}   PHI 0.2   PBOUE {S:2}   "
           "TAUMAX {S:120}", "hardening": "VOCE {S:300} {S:250} 6. {S:80}",
           "more": "PRES2D billet 2 2 {S:30} squeeze\nBFORC  billet Y {P:-0.4} squeeze\nCENTR  billet {D:8E-9} {W:1E4} squeeze\nLIC    squeeze\n   0. 0.   {T:1} 1.\n"}


BAR = """TITLE  A long bar bent and pressed across, in {name}
STATE  GPLSTN
SECTN  E FREE
SECTN  KX FREE
SECTN  KY FREE
KINEM  LOG
BLOCK  bar PL8LS 4 steel
   0. 0.   {L:20} 0.   {L:20} {L:10}   0. {L:10}
   4 1.   3 1.
LAW    steel EPLA
   {S:200000} 0.3
   LINEAR {S:250} {S:500}
LIC    press
   0. 0.   {T:1} 1.   {T:1.5} 0.
MOVE   bar 2 Y press {L:-0.5}
PRES2D bar 3 2 {S:90} press
FIXED  bar 4 XY
STRAT  {T:0.1} {T:1e-5} {T:0.1}   5 3
STOP   {T:1.5}
NORMS  PATH 0 RATE 0
{probes}END
"""


# Between elements, as far from the points of one as of the other.
BETWEEN = [(x, y) for x in (5.0, 10.0, 15.0) for y in (1.2, 5.0, 8.9)]


class Scaled:
    """A quantity to be written in other units: `{L:10}` is 10 mm."""

    def __init__(self, unit):
        self.unit = unit

    def __format__(self, number):
        return repr(float(number) / self.unit)


def scaled_deck(name, scene, nx, ny):
    """The deck in a system of units."""
    length, stress, time = UNITS[name]
    units = {"L": Scaled(length), "S": Scaled(stress), "T": Scaled(time), "P": Scaled(stress / length),
             "W": Scaled(1 / time), "D": Scaled(stress * time**2 / length**2)}
    parts = {key: value.format(**units) for key, value in scene.items()}
    text = DECK.format(name=name, stick=STICK, nx=nx, ny=ny, **units, **parts)
    # A law that is not used is refused.
    return text if "stick" in parts["end"] else text.replace(STICK, "")


def section(checks):
    """A section of generalised plane strain: iterations, axial strain and curvature."""
    runs = {}
    for name in ("mm-N-MPa", "m-N-Pa", "in-lbf-psi"):
        length, stress, time = UNITS[name]
        where = checks.path(f"section-{name}")
        probes = "".join(f"PROBE p{k} POINT mises {x / length!r} {y / length!r}\n" for k, (x, y) in enumerate(BETWEEN))
        deck = write(where + ".lag", BAR.format(name=name, L=Scaled(length), S=Scaled(stress), T=Scaled(time), probes=probes))
        result = run([deck, "--out", where, "--threads", "1"])
        if checks.that(result.returncode == DONE, f"section in {name}: done", said(result)):
            runs[name] = history(where)
    if len(runs) < 3:
        return
    one = runs.pop("mm-N-MPa")
    for name, two in runs.items():
        checks.that(one["iterations"] == two["iterations"], f"section in {name}: the same iterations", (one["iterations"], two["iterations"]))
        columns = [("section_strain", 1.0), ("section_curvature_x", 1/UNITS[name][0])]
        for column, unit in columns + [(f"p{k}", UNITS[name][1]) for k in range(len(BETWEEN))]:
            worst = max(abs(a - b*unit) for a, b in zip(one[column], two[column]))/max(abs(a) for a in one[column])
            checks.that(worst <= TOLERANCE, f"section in {name}: {column}", f"{worst:.1e} apart")


def compare(checks, what, one, two, name):
    """Steps and iterations are the same, times, forces and motions to the tolerance."""
    length, stress, time = UNITS[name]
    if not checks.that(one["iterations"] == two["iterations"] and one["cutbacks"] == two["cutbacks"], f"{what}: the same iterations",
                       f"{sum(one['iterations']):.0f} in {len(one['step'])} steps, {sum(two['iterations']):.0f} in {len(two['step'])}"
                       + first_other(one, two)):
        return
    units = {"time": time, "force_y_upper": stress * length**2, "force_x_upper": stress * length**2, "plastic_work": stress * length**3,
             "external_work": stress * length**3, "friction_work": stress * length**3}
    for column, unit in units.items():
        largest = max(abs(value) for value in one[column]) or 1.0
        if name == "binary":
            checks.that(one[column] == [b * unit for b in two[column]], f"{what}: {column}, every bit")
        # Over the largest value of the whole run: forces begin at zero.
        worst = max(abs(a - b * unit) for a, b in zip(one[column], two[column])) / largest
        checks.that(worst <= TOLERANCE, f"{what}: {column}", f"{worst:.1e} apart")
    worst = max(abs(a - b * stress * length**2) / max(abs(a), 1e-300) for a, b in zip(one["force_y_upper"], two["force_y_upper"]))
    checks.that(worst <= TOLERANCE, f"{what}: force, each step over its own", f"{worst:.1e} apart")


def first_other(one, two):
    """Where two runs part."""
    for a, b, step in zip(one["iterations"], two["iterations"], one["step"]):
        if a != b:
            return f", first at step {step:.0f}: {a:.0f} and {b:.0f}"
    return ""


def main():
    checks = Checks()
    for scene_name, scene, nx, ny in (("glued", GLUED, 6, 9), ("glued", GLUED, 7, 11), ("glued", GLUED, 12, 18), ("sliding", SLIDING, 6, 9)):
        runs = {}
        for name in UNITS if nx == 6 else ("mm-N-MPa", "m-N-Pa", "binary"):
            where = checks.path(f"{scene_name}-{nx}-{name}")
            deck = write(where + ".lag", scaled_deck(name, scene, nx, ny))
            result = run([deck, "--out", where, "--threads", "1"])
            if checks.that(result.returncode == DONE, f"{scene_name} {nx}x{ny} in {name}: done", said(result)):
                runs[name] = history(where)
        for name, table in runs.items():
            if name != "mm-N-MPa" and "mm-N-MPa" in runs:
                compare(checks, f"{scene_name} {nx}x{ny} in {name}", runs["mm-N-MPa"], table, name)
    section(checks)
    checks.end()


if __name__ == "__main__":
    main()
