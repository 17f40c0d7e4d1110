#!/usr/bin/env python3
"""Points of contact that open and close, stick and slip to and fro: the steps converge all the same, few are cut back.

usage: run_chatter.py [-v] [-k]       -v prints every check, -k keeps the results

- `held`: a strip held at both ends is stretched over a punch. Its flange lies on the die with next to no pressure and peels off
  it point by point; each iteration changes the set of points in contact, and shorter steps have the same set to find.
- `snap`: a blank drawn over the die under much friction. At times one side of it snaps off the die, the force on the punch falls
  within a step, and there is no equilibrium nearby, however short the step.
- `stiff`: the billet that folds onto its dies, with a tangential penalty as large as the normal one: a correction reverses the
  slip of a point, the next one reverses it again.

None of this may show in the results: the snap is the same bits with two threads, stopped and resumed, and friction gives no work
back. That the deck's answers stay what they are is held by tests/decks.
"""
import os
import signal
import sys

sys.dont_write_bytecode = True
from support import (DONE, SIGNAL, SOURCE, UPSETTING, Checks, deck_text, result_differences, run, said, start,  # noqa: E402
                     stop_after, summary, with_h5py, write)

DRAW = os.path.join(SOURCE, "decks", "stamping", "draw.lag")
# Options, and the most cutbacks: about twice what there are. Without the control `held` and `snap` end with code 3 after 14 and
# 17 cutbacks, and `stiff` needs 10.
HELD = ["-p", "nx=50", "-p", "ny=2", "-p", "h=12", "-p", "phi=0"], 4
SNAP = ["-p", "phi=0.2"], 6
STIFF = [], 4


def changed(text, old, new):
    """A deck with one passage changed; it must be there."""
    assert text.count(old) == 1, f"the deck no longer says '{old}'"
    return text.replace(old, new)


def case(checks, name, text, options, most):
    """Run to the end with few cutbacks; the folder and the deck."""
    deck, out = write(checks.path(name + ".lag"), text), checks.path(name)
    result = run([deck, "--out", out, "--threads", "1"] + options)
    if checks.that(result.returncode == DONE, f"{name}: done", said(result)):
        reported = summary(out)
        print(f"{name}: {reported['steps']} steps, {reported['iterations']} iterations, {reported['cutbacks']} cutbacks")
        checks.that(reported["cutbacks"] <= most, f"{name}: at most {most} cutbacks", reported["cutbacks"])
        checks.that(reported["checks"]["least_dissipation"] >= -1e-12, f"{name}: friction gives no work back",
                    reported["checks"]["least_dissipation"])
    return deck, out


def main():
    with_h5py()
    checks = Checks()
    os.environ["OMP_WAIT_POLICY"] = "passive"
    case(checks, "held", changed(deck_text(DRAW), "FIXED  blank 4 X", "FIXED  blank 4 X\nFIXED  blank 2 X"), *HELD)
    case(checks, "stiff", changed(deck_text(UPSETTING), "PHI 0.5", "PHI 0.5   AKTAU 2.4E6"), *STIFF)
    options, most = SNAP
    deck, whole = case(checks, "snap", deck_text(DRAW), options, most)

    out = checks.path("two")
    result = run([deck, "--out", out, "--threads", "2"] + options)
    checks.that(result.returncode == DONE, "snap, 2 threads: done", said(result))
    wrong = result_differences(whole, out)
    checks.that(not wrong, "snap: the same bits with 1 and 2 threads", "; ".join(wrong))

    out = checks.path("again")
    code, _, stderr = stop_after(start([deck, "--out", out, "--threads", "1"] + options), out, 65, signal.SIGTERM)
    checks.that(code == SIGNAL + signal.SIGTERM, "snap: stopped", f"{code} {stderr}")
    result = run([deck, "--out", out, "--resume", os.path.join(out, "snap.ckp.h5"), "--threads", "1"] + options)
    checks.that(result.returncode == DONE, "snap: resumed", said(result))
    wrong = result_differences(whole, out)
    checks.that(not wrong, "snap: resumed as in one go", "; ".join(wrong))
    checks.that(summary(out)["iterations"] == summary(whole)["iterations"], "snap: as many iterations as in one go")
    checks.end()


if __name__ == "__main__":
    main()
