#!/usr/bin/env python3
"""Bodies that are asleep until an operation has them (ASLEEP).

usage: run_weld_pass.py [-v] [-k] [--write]     --write puts the table of finer runs into the README of decks/weld_pipe

- `bar`: between two walls a bar is laid at a high temperature beside another; both come to one temperature, then to that of the
  start. Elastic: the mean temperature and the stress are the integrals of what was laid (closed form). Stopped and resumed: the same
  bits. Put to sleep again, it leaves the other bar without stress.
- `exposed`: the side where the other bar will be is free until then: what a bar alone gives off there, with large strains too, and pressed
  there. The volume of both is compared with that when the other has come, without expansion. Named in the wrong operation it is refused.
- `whole`: laid beside a bar of another heat capacity, which depends on the temperature, on four and on eight nodes an element, on meshes that
  differ: the common temperature is that of the heat of both (closed form).
- `gap`: the first bar has come nearer by 15 % of the other's length before that is laid: no strain of it (KINEM SMALL), before and after
  a stop. Pressed by 12 % more it is refused.
"""
import os
import signal
import sys

sys.dont_write_bytecode = True
TESTS = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path[:0] = [os.path.join(TESTS, folder) for folder in ("runs", "cycle")]
from remeshed import put_table  # noqa: E402
from support import (DONE, INPUT, NO_CONVERGENCE, SIGNAL, SOURCE, Checks, history, result_differences, run, said, start, stop_after,  # noqa: E402
                     summary, with_h5py, write)

E, ALPHA, LAID, N = 200000.0, 1e-5, 1020.0, 8
BAR = f"""TITLE  A bar laid on hot beside another, between walls
STATE  PLSTS
KINEM  SMALL
BLOCK  parent PL8LS 4 metal
   0. 0.   10. 0.   10. 1.   0. 1.
   {N} 1.   1 1.
BLOCK  filler PL8LS 4 metal
   10. 0.   20. 0.   20. 1.   10. 1.
   {N} 1.   1 1.
JOIN   parent 2 filler 4
LAW    metal ELATH
   {E} 0.3 {ALPHA}
ADDEL  parent PL8TM heat BILINEAR
ADDEL  filler PL8TM heat BILINEAR
LAW    heat HEAT
   20. 3.6
START  T 20. parent
START  T {LAID} filler
FIXED  parent 1 Y
FIXED  filler 1 Y
FIXED  parent 4 X
FIXED  filler 2 X
NORMS  FORCE 1.E-9 DISPL 1.E-8
PROBE  stress MEAN stress_xx parent filler
PROBE  filler MEAN stress_xx filler
PROBE  t_parent NODE T 0. 0.
PROBE  t_filler NODE T 20. 0.
CKPT   1
OPERA  before
ASLEEP filler
STOP   1.
STRAT  0.5 1.E-6 0.5   6 3
OPERA  laid
STOP   10000.
STRAT  0.01 1.E-6 1000.   6 3  0.25 2.
OPERA  cold
CONVE  parent 3 H 0.1 TS 20.
CONVE  filler 3 H 0.1 TS 20.
STOP   10000.
STRAT  0.01 1.E-6 1000.   6 3  0.25 2.
"""


def bar(checks):
    """Closed forms, bits, and the filler taken away."""
    deck, out = write(checks.path("bar.lag"), BAR + "END\n"), checks.path("bar")
    result = run([deck, "--out", out, "--threads", "1"])
    if not checks.that(result.returncode == DONE, "bar", said(result)):
        return
    rows = history(out)
    ends = [k for k in range(len(rows["step"])) if k + 1 == len(rows["step"]) or rows["operation"][k + 1] != rows["operation"][k]]
    checks.that(rows["filler"][ends[0]] != rows["filler"][ends[0]] and rows["stress"][ends[0]] == 0, "before: nothing is read of it",
                (rows["filler"][ends[0]], rows["stress"][ends[0]]))
    # heat of the whole bar: shared nodes take the temperature of the balance
    laid = (LAID - 20)*10
    for name in ("t_parent", "t_filler"):
        checks.that(abs(rows[name][ends[1]]/(20 + laid/20) - 1) < 1e-9, f"laid: {name}", rows[name][ends[1]])
    checks.that(abs(rows["stress"][ends[1]]) < 1e-6, "laid: what one bar has grown the other has shrunk", rows["stress"][ends[1]])
    exact = E*ALPHA*laid/20
    for name in ("stress", "filler"):
        checks.that(abs(rows[name][ends[2]]/exact - 1) < 1e-8, f"cold: {name}, E alpha times the mean", (rows[name][ends[2]], exact))
    checks.that(abs(rows["heat_imbalance"][-1]) < 1e-9, "balance of heat", rows["heat_imbalance"][-1])
    for row in (1, ends[0] + 4):
        again = checks.path(f"again-{row}")
        code, _, stderr = stop_after(start([deck, "--out", again, "--threads", "1"]), again, row, signal.SIGTERM, 0)
        checks.that(code in (SIGNAL + signal.SIGTERM, DONE), f"stopped after {row} rows", f"{code} {stderr}")
        if code != DONE:
            result = run([deck, "--out", again, "--threads", "1", "--resume", os.path.join(again, "bar.ckp.h5")])
            checks.that(result.returncode == DONE, f"resumed after {row} rows", said(result))
        wrong = result_differences(out, again)
        checks.that(not wrong, f"after {row} rows as in one go", "; ".join(wrong))
    # taken away again, the other bar is without stress
    text = BAR + "OPERA  parted\nASLEEP filler\nCONVE  parent 3 H 0.1 TS 20.\nSTOP   1.\nSTRAT  0.5 1.E-6 0.5   6 3\nEND\n"
    deck, out = write(checks.path("parted.lag"), text), checks.path("parted")
    result = run([deck, "--out", out, "--threads", "1"])
    if checks.that(result.returncode == DONE, "parted", said(result)):
        checks.that(abs(history(out)["stress"][-1]) < 1e-6*exact, "parted: no stress is left", history(out)["stress"][-1])


def shifted(checks, name, after):
    """The bar that is there has come nearer by 1.5 of 10 before the other is laid; it comes by `after` more then."""
    text = BAR.replace("FIXED  parent 4 X", "MOVE   parent 4 X shift").replace("STOP   1.\nSTRAT  0.5", "STOP   1.\nLIC    shift\n   0. 0.  1. 1.5\nSTRAT  0.5")
    text = text.replace("OPERA  laid\n", "OPERA  laid\nLIC    shift\n   0. 0.\n")
    text = text.replace("OPERA  cold\n", f"OPERA  cold\nLIC    shift\n   0. {after!r}\n")
    deck, out = write(checks.path(f"{name}.lag"), text + "END\n"), checks.path(name)
    return run([deck, "--out", out, "--threads", "1"]), deck, out


def gap(checks):
    """Small strains of a body that is laid down count from there; its own are judged as those of others."""
    result, deck, out = shifted(checks, "gap", 0.0)
    if checks.that(result.returncode == DONE, "gap: laid without strain", said(result)):
        exact = E*ALPHA*(LAID - 20)*10/20
        checks.that(abs(history(out)["stress"][-1]/exact - 1) < 1e-8, "gap: stress of the shrinking", history(out)["stress"][-1])
        again = checks.path("gap-again")
        code, _, stderr = stop_after(start([deck, "--out", again, "--threads", "1"]), again, 5, signal.SIGTERM, 0)
        checks.that(code in (SIGNAL + signal.SIGTERM, DONE), "gap: stopped", f"{code} {stderr}")
        if code != DONE:
            result = run([deck, "--out", again, "--threads", "1", "--resume", os.path.join(again, "gap.ckp.h5")])
            checks.that(result.returncode == DONE, "gap: resumed", said(result))
        wrong = result_differences(out, again)
        checks.that(not wrong, "gap: resumed as in one go", "; ".join(wrong))
    result, _, _ = shifted(checks, "pressed", 2.5)
    checks.that(result.returncode == NO_CONVERGENCE and "large strain in KINEM SMALL" in result.stderr, "pressed: refused", said(result))


FREE = """PRES2D parent 2 3 10. load
LIC    load
   0. 0.  1. 1.
CONVE  parent 2 H 0.5 TS 20.
STOP   100.
STRAT  0.01 1.E-6 10.   6 3  0.25 2.
"""
AT_FREE = ("heat_through_parent.2/CONVE", "stress", "t_parent", "x")


def exposed(checks):
    """The side beside a body that is asleep."""
    text = BAR[:BAR.index("OPERA")].replace("KINEM  SMALL", "KINEM  LOG").replace("T 20. parent", "T 500. parent")
    text += "PROBE  x NODE X 10. 0.\n"
    later = "OPERA  laid\nSTOP   1000.\nSTRAT  0.01 1.E-6 100.   6 3  0.25 2.\n"
    alone = "\n".join(line for line in text.replace("parent filler", "parent").split("\n") if "filler" not in line or "MEAN stress_xx parent" in line)
    alone = alone.replace("\n   10. 0.   20. 0.   20. 1.   10. 1.\n   8 1.   1 1.", "")
    runs = {}
    for name, deck in (("exposed", text + "OPERA  before\nASLEEP filler\n" + FREE + later + "END\n"), ("alone", alone + FREE + "END\n")):
        out = checks.path(name)
        result = run([write(checks.path(name + ".lag"), deck), "--out", out, "--threads", "1"])
        if not checks.that(result.returncode == DONE, f"{name}: runs", said(result)):
            return
        runs[name] = history(out)
    last = len(runs["alone"]["step"]) - 1
    for name in AT_FREE:
        one, other = (next(values[last] for column, values in runs[which].items() if column == name) for which in ("exposed", "alone"))
        checks.that(abs(one - other) < 1e-9*abs(other), f"exposed: {name} as of the bar alone", (one, other))
    drift = summary(checks.path("exposed"))["checks"]["volume_drift_unloaded"]
    checks.that(abs(drift) < 1e-5, "exposed: volume without expansion since both are there", drift)
    for name, deck, words in (("sleeps", text + "OPERA  before\nASLEEP filler\nCONVE  filler 4 H 0.5 TS 20.\nSTOP   1.\nSTRAT  0.5 1.E-6 0.5   6 3\n",
                               "CONVE: one of its sides belongs to a body that is asleep"),
                              ("inside", text + "OPERA  both\nCONVE  parent 2 H 0.5 TS 20.\nSTOP   1.\nSTRAT  0.5 1.E-6 0.5   6 3\n",
                               "CONVE: this place is inside the part")):
        result = run([write(checks.path(name + ".lag"), deck + "END\n"), "--check"])
        checks.that(result.returncode == INPUT and words in result.stderr, f"{name}: refused", said(result))


WHOLE = """TITLE  laid hot, its heat capacity by temperature
STATE  PLSTN
KINEM  SMALL
BLOCK  p PL8LS {rule} metal
   0. 0.   10. 0.   10. 2.   0. 2.
   {n} 1.   2 1.
BLOCK  f PL8LS {rule} metal
   10. 0.   14. 0.   14. 2.   10. 2.
   {m} 1.   2 1.
JOIN   p 2 f 4
LAW    metal ELATH
   {e} 0.3 1.E-5
ADDEL  p PL8TM h {nodes}
ADDEL  f PL8TM g {nodes}
LAW    h HEAT
   20. 3.6
LAW    g HEAT
   TEMP   0.
   20. {low}
   TEMP   2000.
   40. {high}
START  T 20. p
START  T 1500. f
FIXED  p 1 Y
FIXED  p 4 X
PROBE  t MEAN T p
STRAT  0.1 1.E-5 50.   5 3
OPERA  before
ASLEEP f
STOP   1.
OPERA  laid
STOP   2000.
END
"""


def whole(checks):
    """20 of volume at 20 degC and 8 at 1500 degC: 72 (T - 20) = 8 int RHOC dT."""
    for k, (n, m, rule, nodes, low, high) in enumerate(((5, 2, 4, "", 2., 6.), (5, 2, 4, "BILINEAR", 2., 6.), (1, 1, 4, "", 2., 6.), (3, 4, 9, "", 2., 6.),
                                                        (5, 2, 4, "", 6., 1.), (5, 2, 4, "", 3., 3.))):
        name = f"whole{k}"
        result = run([write(checks.path(name + ".lag"), WHOLE.format(n=n, m=m, rule=rule, nodes=nodes, low=low, high=high, e=E)), "--out", checks.path(name),
                      "--threads", "1"])
        if not checks.that(result.returncode == DONE, f"{name}: runs", said(result)):
            continue
        cold, hot = 20.0, 1500.0
        for _ in range(100):
            t = (cold + hot)/2
            if 72*(t - 20) < 8*(low*(1500 - t) + (high - low)/4000*(1500**2 - t**2)):
                cold = t
            else:
                hot = t
        found = history(checks.path(name))["t"][-1]
        checks.that(abs(found - t) < 1e-3, f"{name}: common temperature", (found, t))


def table(checks):
    """Finer runs of the weld of a pipe, into its README."""
    folder = os.path.join(SOURCE, "decks", "weld_pipe")
    lines = ["| elements across a pass, along the pipe, `tol` | heat given off kJ | `bent` mm | `far` mm | peak of `heat_affected` | "
             "`hoop_root`, `hoop_cap` | `hoop_in`, `hoop_out` | `axial_in`, `axial_out` |", "|---|---|---|---|---|---|---|---|"]
    for n, m, tol, words in ((3, 12, 10, ""), (4, 16, 10, " (the deck)"), (6, 24, 3, ""), (8, 32, 3, "")):
        out = checks.path(f"weld{n}")
        result = run([os.path.join(folder, "weld_pipe.lag"), "--out", out, "-p", f"n={n}", "-p", f"m={m}", "-p", f"tol={tol}"])
        if not checks.that(result.returncode == DONE, f"weld_pipe, n={n}", said(result)):
            continue
        rows = history(out)
        last = {name: values[-1] for name, values in rows.items()}
        peak = max(value for value in rows["heat_affected"] if value == value)
        pairs = [f"{last[a]:.0f} {last[b]:.0f}" for a, b in (("hoop_root", "hoop_cap"), ("hoop_in", "hoop_out"), ("axial_in", "axial_out"))]
        lines.append(f"| {n}, {m}, {tol}{words} | {-last['heat_in'] / 1e6:.3f} | {last['bent']:.4f} | {last['far']:.4f} | {peak:.0f} | "
                     f"{' | '.join(pairs)} |")
    put_table(os.path.join(folder, "README.md"), "<!-- runs -->", lines)


def main():
    with_h5py()
    checks = Checks()
    bar(checks)
    gap(checks)
    exposed(checks)
    whole(checks)
    if "--write" in sys.argv[1:]:
        table(checks)
    checks.end()


if __name__ == "__main__":
    main()
