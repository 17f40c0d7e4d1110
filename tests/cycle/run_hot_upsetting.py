#!/usr/bin/env python3
"""Hot upsetting to 60 % between chilled dies by lagacycle, with all ways of coupling: balances of energy and heat over all meshes.

usage: run_hot_upsetting.py [-v] [-k] [--write]     --write puts the tables into decks/hot_upsetting/README.md

Energy and heat close to 1 %; over each new mesh the heat (the integral of the temperature over the volume) is kept to 1e-3 and
temperatures stay within their old bounds; heat of plastic work and friction is their work to 1 %; the die has got what is its
temperature now. The ways of coupling, with steps and meshes of their own, agree to 1 % of temperatures, to 0.2 % of the heat
released and to 3 % of the force. With ONCE the heat of the last step comes after the end: MONOLITHIC's is that of the step before.
"""
import glob
import os
import resource
import sys

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [HERE, os.path.join(os.path.dirname(HERE), "heat")]
from remeshed import ROOT, cycle, put_table, tries, within_limits  # noqa: E402
from run_coupling import content  # noqa: E402
from support import DONE, Checks, history, said, summary, write  # noqa: E402

DECK = os.path.join(ROOT, "decks", "hot_upsetting", "hot_upsetting.lag")
README = os.path.join(os.path.dirname(DECK), "README.md")
MARK = "<!-- cycle -->"
WAYS = ("ONCE", "CONVERGE", "MONOLITHIC")
# The force on a die differs by this much from mesh to mesh (run_upsetting_remesh.py).
FORCE = 0.03
BALANCE, RELEASED, KEPT, BOUNDS = 0.01, 0.002, 1e-3, 1e-3


def processor_seconds():
    """Of all programs that were called: what others do on the machine does not count."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def meshes(checks, way, out):
    """Heat and bounds over each new mesh; rows of the table."""
    lines = []
    for one in tries(out):
        if one["accepted"] != "y":
            continue
        generation = int(one["generation [-]"])
        before = glob.glob(os.path.join(out, f"*.g{generation - 1:02d}.end.h5"))[0]
        after = glob.glob(os.path.join(out, f"*.g{generation:02d}.start.h5"))[0]
        (old, low, high), (new, least, most) = content(before), content(after)
        checks.that(abs(new/old - 1) < KEPT, f"{way}, mesh {generation}: heat", f"{new/old - 1:.2e}")
        slack = BOUNDS*(high - low)
        checks.that(low - slack <= least and most <= high + slack, f"{way}, mesh {generation}: bounds of the temperature",
                    f"{least} to {most}, were {low} to {high}")
        lines.append(f"| {generation} | {float(one['stop_time [time]']):.3f} | {one['old_elements [-]']} -> {one['new_elements [-]']} | "
                     f"{100*(new/old - 1):+.4f} | {least:.0f} to {most:.0f} |")
    return lines


def heat_at(rows, time):
    """Heat released at a time, linear between the steps."""
    k = next(k for k, end in enumerate(rows["time"]) if end >= time)
    begin, end, before, after = rows["time"][k - 1], rows["time"][k], rows["heat_released"][k - 1], rows["heat_released"][k]
    return before + (after - before)*(time - begin)/(end - begin)


def main():
    checks = Checks()
    with open(DECK, encoding="utf-8") as file:
        text = file.read()
    table = ["| coupling | steps | meshes | seconds of processor | force kN | core C | face C | die C | heat released, J | released / work % | energy missing % | heat missing % |",
             "|---|---|---|---|---|---|---|---|---|---|---|---|"]
    ends, runs, listed = {}, {}, []
    for way in WAYS:
        out = checks.path(way)
        deck = write(checks.path(f"{way}.lag"), text.replace("\nSAVE ", f"\nSOLVE  {way}\nSAVE "))
        begun = processor_seconds()
        result = cycle(deck, out)
        seconds = processor_seconds() - begun
        if not checks.that(result.returncode == DONE, f"{way}: the cycle ends by itself", said(result)):
            continue
        within_limits(checks, out)
        rows = history(out)
        checks.that(abs(rows["displacement_y_upper"][-1] + 9) < 1e-9, f"{way}: 60 % reached", rows["displacement_y_upper"][-1])
        checks.that(len(tries(out)) >= 4, f"{way}: at least 4 remeshings", len(tries(out)))
        lines = meshes(checks, way, out)
        listed = listed or lines
        energy, heat = summary(out)["checks"]["energy_imbalance"], rows["heat_imbalance"][-1]
        k = -2 if way == "ONCE" else -1
        share = rows["heat_released"][-1]/(0.9*rows["plastic_work"][k] + rows["friction_work"][k])
        checks.that(abs(energy) < BALANCE, f"{way}: energy", energy)
        checks.that(abs(heat) < 1e-8, f"{way}: heat", heat)
        checks.that(abs(share - 1) < BALANCE, f"{way}: heat of plastic work and friction", share)
        got = sum(flow*step for flow, step in zip(rows["heat_flow_upper"], rows["step_length"]))
        checks.that(abs(2e5*(rows["temperature_upper"][-1] - 250)/got - 1) < 1e-9, f"{way}: heat in the die", got)
        runs[way] = rows
        ends[way] = [rows[name][-1] for name in ("force_y_upper", "core", "face", "temperature_upper")]
        force, core, face, die = ends[way]
        table.append(f"| `{way}` | {len(rows['step'])} | {1 + sum(t['accepted'] == 'y' for t in tries(out))} | {seconds:.1f} | {force/1000:.2f} | "
                     f"{core:.1f} | {face:.1f} | {die:.2f} | {rows['heat_released'][-1]/1000:.2f} | {100*share:.2f} | {100*energy:+.3f} | {100*heat:+.1e} |")
    if len(ends) == len(WAYS):
        for one in ("ONCE", "CONVERGE"):
            force, *others = (a/b - 1 for a, b in zip(ends[one], ends["MONOLITHIC"]))
            time = runs[one]["time"][-2 if one == "ONCE" else -1]
            heat = runs[one]["heat_released"][-1]/heat_at(runs["MONOLITHIC"], time) - 1
            table.append(f"| `{one}` to `MONOLITHIC` | | | | {100*force:+.2f} % | " + " | ".join(f"{100*a:+.2f} %" for a in (*others, heat))
                         + " | | |")
            checks.that(abs(force) < FORCE, f"{one} and MONOLITHIC: force, each on meshes of its own", f"{force:.2%}")
            checks.that(max(map(abs, others)) < BALANCE, f"{one} and MONOLITHIC: temperatures", f"{max(map(abs, others)):.2%}")
            checks.that(abs(heat) < RELEASED, f"{one} and MONOLITHIC: heat released", f"{heat:.2%}")
    lines = table + ["", "| mesh | at s | elements | heat % | temperatures |", "|---|---|---|---|---|"] + listed
    print("\n".join(lines))
    if "--write" in sys.argv:
        put_table(README, MARK, lines)
    checks.end()


if __name__ == "__main__":
    main()
