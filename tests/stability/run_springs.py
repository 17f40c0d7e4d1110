#!/usr/bin/env python3
"""Bodies that only weak springs (SPRNG) hold until dies do.

usage: run_springs.py [-v] [-k]      -v prints every check, -k keeps the results

`free`: a block without supports is pushed by a force at its middle: it moves by force over stiffness, along both axes, in each plane
state and for each kinematics; the springs hold half the work. `floating`: a billet with a gap to both dies is told without springs
(`--check`); with them it is taken along, laid down and pressed, with the force of homogeneous compression. Springs that are too
stiff are told at the end.
"""
import json
import math
import os
import subprocess
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), os.pardir, "patch"))
from patch_support import LAGAMINE, Checks, Run  # noqa: E402

FREE = """TITLE  A block that springs alone hold
STATE  {state}
KINEM  {kinem}
BLOCK  b PL8LS 4 m
   1. 0.   3. 0.   3. 2.   1. 2.
   2 1.   2 1.
LAW    m ELA
   1.E6 0.3
{springs}LIC    on
   0. 0.   1. 1.
{forces}STRAT  0.5 1.E-6 0.5   5 3
NORMS  FORCE 1.E-10 DISPL 1.E-10
{probes}END
"""

BILLET = """TITLE  A billet that floats between two dies
STATE  AXISYM
KINEM  LOG
BLOCK  billet PL8LS 4 steel
   0. 0.   10. 0.   10. 15.   0. 15.
   4 1.   6 1.
LAW    steel EPLA
   200000. 0.3
   LINEAR 300. 500.
LAW    smooth COUL2D
   PENETR 1.E-4   PHI 0.
DIE    upper PILOT 0. 15.4
   SEGM   30. 15.4   0. 15.4
DIE    lower
   SEGM   0. -0.3   30. -0.3
CNT2D  billet 3 upper -3 smooth
CNT2D  billet 1 lower -3 smooth
FIXED  billet 4 X
{springs}MOVE   upper Y press
LIC    press
   0. 0.   1. -3.7
STRAT  0.02 1.E-6 0.05   5 3
PROBE  top NODE UY 0. 15.
PROBE  below NODE UY 0. 0.
END
"""


def summary(run):
    """summary.json of a run."""
    with open(os.path.join(run.out, "summary.json"), encoding="utf-8") as file:
        return json.load(file)


def free(checks):
    """Force over stiffness."""
    for state, directions in (("PLSTN", "XY"), ("PLSTS", "XY"), ("AXISYM", "Y")):
        for kinem in ("SMALL", "LOG"):
            name = f"free-{state}-{kinem}"
            forces = "".join(f"BFORC  b {c} {0.25*(k + 1)} on\n" for k, c in enumerate(directions))
            springs = "".join(f"SPRNG  b {c} {2.0*(k + 1)}\n" for k, c in enumerate(directions))
            run = Run(checks, name, FREE.format(state=state, kinem=kinem, springs=springs, forces=forces,
                                                probes="".join(f"PROBE  u{c} NODE U{c} 3. 2.\n" for c in directions)))
            if not run.ok:
                continue
            volume = math.pi*(9 - 1)*2 if state == "AXISYM" else 4.0
            held = 0.0
            for k, c in enumerate(directions):
                way = 0.25*(k + 1)*volume/(2.0*(k + 1))
                held += 0.5*2.0*(k + 1)*way**2
                # ELA's own strains are none: forces of springs and of the volume are in balance everywhere
                checks.small(abs(run.history[f"u{c}"][-1]/way - 1), 1e-6, f"{name}: way along {c}")
            told = summary(run)
            checks.small(abs(told["energy"]["springs"]/held - 1), 1e-6, f"{name}: energy of the springs")
            checks.small(abs(told["checks"]["energy_imbalance"]), 1e-6, f"{name}: books")


def floating(checks):
    """A billet that is taken along, laid down and pressed."""
    path = os.path.join(checks.folder, "without.lag")
    with open(path, "w", encoding="utf-8") as file:
        file.write(BILLET.format(springs=""))
    said = subprocess.run([LAGAMINE, path, "--check"], check=False, text=True, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE).stdout
    checks.that("nothing holds it in Y before it meets a die" in said, "without springs: told")
    for stiffness, weak in ((1.0, True), (3.0e4, False)):
        run = Run(checks, f"floating-{stiffness}", BILLET.format(springs=f"SPRNG  billet Y {stiffness}\n"))
        if not run.ok:
            continue
        told = summary(run)
        values = told["checks"]
        checks.that(("spring_share" in told["advice"]) is not weak, f"stiffness {stiffness}: told where it counts", values["spring_share"])
        checks.that(not any("nothing holds" in warning for warning in told.get("warnings", [])), "no warning of a free body")
        if not weak:
            continue
        mean = (run.history["top"][-1] + run.history["below"][-1])/2
        checks.small(abs(values["spring_force"]/abs(stiffness*mean) - 1), 1e-3, "force of the springs")
        # 15 to 12: homogeneous, volume kept but for elastic strain
        strain = math.log(15/12)
        flow = 300 + 500*(strain - 300/200000)/(1 + 500/200000)
        area = math.pi*100*15/12*(1 - (1 - 2*0.3)*flow/200000)
        checks.small(abs(abs(run.history["force_y_upper"][-1])/(flow*area) - 1), 2e-3, "force of homogeneous compression")
        print(f"floating billet: {told['steps']} steps, {told['iterations']} iterations, {told['cutbacks']} cutbacks; springs "
              f"{100*values['spring_share']:.2g} % of the largest force, force {run.history['force_y_upper'][-1]:.6g} ({flow*area:.6g})")


def main():
    checks = Checks()
    free(checks)
    floating(checks)
    checks.end()


if __name__ == "__main__":
    main()
