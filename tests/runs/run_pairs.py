#!/usr/bin/env python3
"""Contact between deformable bodies whose pairs change all the way (decks/press_fit/drive_on): stopped and resumed, and with any
number of threads, the same bits; steps that are cut back and predictions that are thrown away leave nothing behind.

usage: run_pairs.py [-v] [-k]       -v prints every check, -k keeps the results
"""
import os
import signal
import sys

sys.dont_write_bytecode = True
from support import DONE, SIGNAL, SOURCE, Checks, deck_text, history, result_differences, run, said, start, stop_after, with_h5py, \
    write  # noqa: E402

DRIVE_ON = os.path.join(SOURCE, "decks", "press_fit", "drive_on.lag")
FINER = ["-p", "n=2"]


def main():
    with_h5py()
    checks = Checks()
    os.environ["OMP_WAIT_POLICY"] = "passive"
    fine, coarse = "STRAT  0.0025 1.E-6 0.0025", "STRAT  0.02 1.E-6 0.02"   # long steps: pairs change in most of them
    text = deck_text(DRIVE_ON)
    checks.that(text.count(fine) == 1, f"drive_on.lag has {fine}")
    text = text.replace(fine, coarse).replace("\nEND", "\nSAVE 5\nCKPT 1\nEND")
    deck = write(checks.path("drive_on.lag"), text)
    whole = checks.path("whole")
    result = run([deck, "--out", whole, "--threads", "1"] + FINER)
    if checks.that(result.returncode == DONE, "in one go", said(result)):
        steps = len(history(whole)["step"])
        for rows in (1, steps//3, steps//2, steps - 4):
            out = checks.path(f"stopped-{rows}")
            code, _, stderr = stop_after(start([deck, "--out", out, "--threads", "1"] + FINER), out, rows, signal.SIGTERM)
            checks.that(code == SIGNAL + signal.SIGTERM, f"stopped after {rows} steps", f"{code} {stderr}")
            result = run([deck, "--out", out, "--threads", "1", "--resume", os.path.join(out, "drive_on.ckp.h5")] + FINER)
            checks.that(result.returncode == DONE, f"stopped after {rows} steps: resumed", said(result))
            wrong = result_differences(whole, out)
            checks.that(not wrong, f"stopped after {rows} steps: as in one go", "; ".join(wrong))
        for threads in ("2", "3"):
            out = checks.path("threads-" + threads)
            result = run([deck, "--out", out, "--threads", threads] + FINER)
            checks.that(result.returncode == DONE, f"{threads} threads: done", said(result))
            wrong = result_differences(whole, out)
            checks.that(not wrong, f"{threads} threads: the same bits", "; ".join(wrong))
    checks.end()


if __name__ == "__main__":
    main()
