#!/usr/bin/env python3
"""A run stopped or killed at any moment and resumed ends as the run in one go, bit by bit; a checkpoint that is not this run's,
or not whole, is refused by name.

usage: run_resume.py [-v] [-k] [SEED [KILLS]]       -v prints every check, -k keeps the results, SEED draws other moments (default 1),
KILLS without warning (default 8)
"""
import os
import random
import shutil
import signal
import sys

sys.dont_write_bytecode = True
from support import (DONE, INPUT, SIGNAL, UPSETTING, Checks, add_cards, deck_text, history, mesh, result_differences,  # noqa: E402
                     rows_so_far, run, said, start, stop_after, summary, with_h5py, write)

EVERY = 3       # steps from one save of the deck called often to the next
NAME = {signal.SIGTERM: "TERM", signal.SIGINT: "INT"}


def resume(deck, out, options):
    """Go on from the checkpoint in a folder."""
    return run([deck, "--out", out, "--resume", os.path.join(out, "billet.ckp.h5"), "--threads", "1"] + options)


def stops(checks, draw, deck, name, options, whole, moments):
    """Stopped by a signal at drawn moments, resumed; some are stopped twice."""
    steps = len(history(whole)["step"])
    for k in range(moments):
        number = (signal.SIGTERM, signal.SIGINT)[k % 2]
        out = checks.path(f"{name}-{k}")
        rows = sorted(draw.sample(range(0, steps - 12), 1 + (k % 3 == 2)))
        what = f"{name}, {NAME[number]} after {' and '.join(map(str, rows))} steps"
        arguments = [deck, "--out", out, "--threads", "1"] + options
        for turn, row in enumerate(rows):
            if turn:
                arguments = arguments + ["--resume", os.path.join(out, "billet.ckp.h5")]
            # A stop before the signals are caught would be an ordinary death: wait for a row of this very process.
            row = max(row, rows_so_far(out) + 1 if turn else 1)
            code, _, stderr = stop_after(start(arguments), out, row, number, draw.uniform(0, 0.01))
            checks.that(code == SIGNAL + number, f"{what}: exit code {SIGNAL + number}", f"{code} {stderr}")
            checks.that(stderr == "" or stderr.count("\n") <= 2, f"{what}: few words", stderr)
            if code != SIGNAL + number:
                break
            reported = summary(out)
            checks.that(reported["exit_code"] == code and "signal" in reported["stop_reason"] and reported["steps"] == rows_so_far(out),
                        f"{what}: summary states the signal and the step", reported["stop_reason"])
        else:
            result = resume(deck, out, options)
            checks.that(result.returncode == DONE, f"{what}: resumed", said(result))
            wrong = result_differences(whole, out)
            checks.that(not wrong, f"{what}: as in one go", "; ".join(wrong))
            one, two = summary(whole), summary(out)
            differing = [key for key in ("steps", "iterations", "cutbacks", "checks", "energy") if one[key] != two[key]]
            checks.that(not differing, f"{what}: summary as in one go", differing)
        shutil.rmtree(out)


def stops_between_saves(checks, deck, options, whole):
    """Stopped before one of the last two saves, between them, and resumed: the save before the last one is there as in one go."""
    steps = len(history(whole)["step"])
    found = 0
    for row in range(steps - 6, steps):
        out = checks.path(f"between-{row}")
        code, _, stderr = stop_after(start([deck, "--out", out, "--threads", "1"] + options), out, row, signal.SIGTERM, 0)
        between = code == SIGNAL + signal.SIGTERM and summary(out)["steps"] % EVERY != 0
        found += between
        if code == SIGNAL + signal.SIGTERM:
            result = resume(deck, out, options)
            wrong = result_differences(whole, out) if result.returncode == DONE else [said(result)]
            checks.that(not wrong, f"stopped at step {row}, between saves: as in one go, with the save before", "; ".join(wrong))
        else:
            checks.that(code == DONE, f"stopped at step {row}, between saves: ended before", f"{code} {stderr}")
        shutil.rmtree(out)
    checks.that(found > 0, "stopped between the last two saves", found)


def kills(checks, draw, deck, options, whole, moments):
    """Killed without warning at drawn moments, resumed from what is there."""
    steps = len(history(whole)["step"])
    for k in range(moments):
        out = checks.path(f"kill-{k}")
        row = draw.randrange(6, steps - 6)
        what = f"killed after {row} steps"
        code, _, _ = stop_after(start([deck, "--out", out, "--threads", "1"] + options), out, row, signal.SIGKILL,
                                draw.uniform(0, 0.01))
        checks.that(code == -signal.SIGKILL, f"{what}: it was running", code)
        result = resume(deck, out, options)
        checks.that(result.returncode == DONE, f"{what}: resumed from the last checkpoint", said(result))
        if result.returncode == DONE:
            wrong = result_differences(whole, out)
            checks.that(not wrong, f"{what}: as in one go", "; ".join(wrong))
        shutil.rmtree(out)


def older_checkpoint(checks, deck, options, whole):
    """The checkpoint before the last one is as good, in a folder with later results and in an empty one."""
    for place in ("same", "empty"):
        out = checks.path(f"older-{place}")
        shutil.copytree(whole, out)
        if place == "empty":
            for folder, _, names in os.walk(out):
                for name in names:
                    if name != "billet.ckp.1.h5":
                        os.remove(os.path.join(folder, name))
        result = run([deck, "--out", out, "--resume", os.path.join(out, "billet.ckp.1.h5"), "--threads", "1"] + options)
        checks.that(result.returncode == DONE, f"the older checkpoint, {place} folder: resumed", said(result))
        if place == "same":
            wrong = result_differences(whole, out, previous=False)
        else:
            wrong = [] if history(out)["force_y_upper"][-1] == history(whole)["force_y_upper"][-1] else ["last force"]
        checks.that(not wrong, f"the older checkpoint, {place} folder: as in one go", "; ".join(wrong))


def at_the_end(checks, deck, options, whole):
    """Resuming what has reached its end changes nothing."""
    out = checks.path("ended")
    shutil.copytree(whole, out)
    result = resume(deck, out, options)
    checks.that(result.returncode == DONE, "resumed at its end: done", said(result))
    wrong = result_differences(whole, out)
    checks.that(not wrong, "resumed at its end: nothing changed", "; ".join(wrong))


def refused(checks, result, path, what, phrase=""):
    """Exit code 2, one line that names the file, nothing on standard output."""
    checks.that(result.returncode == INPUT, f"{what}: exit code 2", said(result))
    first = (result.stderr.splitlines() or [""])[0]
    checks.that(path in first and phrase in first, f"{what}: the first line names the file", result.stderr[:300])
    checks.that(result.stdout == "", f"{what}: nothing on standard output", result.stdout[:200])


def refusals(checks, draw, deck, text, options, whole):
    """What must not be taken up, and that refusing it touches no result."""
    checkpoint = os.path.join(whole, "billet.ckp.h5")
    out = checks.path("refused")
    shutil.copytree(whole, out)
    with open(checkpoint, "rb") as file:
        good = file.read()
    other = write(checks.path("other", "billet.lag"), text.replace("PHI 0.5", "PHI 0.4"))
    call = ["--out", out, "--resume", checkpoint, "--threads", "1"]
    refused(checks, run([other] + call + options), checkpoint, "another deck", "another deck")
    refused(checks, run([deck] + call + mesh(6, 10)), checkpoint, "another -p", "another deck")
    refused(checks, run([deck] + call), checkpoint, "no -p", "another deck")

    bad = checks.path("bad.ckp.h5")
    call = [deck, "--out", out, "--resume", bad, "--threads", "1"] + options
    damages = {"a text file": text.encode(), "an empty file": b"", "another HDF5 file": None}
    for share in (0.02, 0.5, 0.97):
        damages[f"cut to {share:.0%}"] = good[:int(share * len(good))]
    damages["cut by one byte"] = good[:-1]
    for name, data in damages.items():
        if data is None:
            shutil.copy(os.path.join(whole, "billet.g01.h5"), bad)
        else:
            with open(bad, "wb") as file:
                file.write(data)
        refused(checks, run(call), bad, name)
    os.remove(bad)
    refused(checks, run(call), bad, "no such file")
    os.mkdir(bad)
    refused(checks, run(call), bad, "a folder")
    os.rmdir(bad)

    # A flipped bit lies in the state, in HDF5's own tables, or in a gap of the file where it means nothing: refused, or the same run.
    ignored = 0
    for _ in range(24):
        at = draw.randrange(len(good))
        altered = bytearray(good)
        altered[at] ^= 1 << draw.randrange(8)
        with open(bad, "wb") as file:
            file.write(altered)
        result = run(call)
        if result.returncode == DONE:
            ignored += 1
            wrong = result_differences(whole, out)
            checks.that(not wrong, f"byte {at} altered, not seen: as in one go", "; ".join(wrong))
        else:
            refused(checks, result, bad, f"byte {at} altered")
    checks.that(ignored <= 12, "most altered bytes are seen", f"{ignored} of 24 not")
    wrong = result_differences(whole, out)
    checks.that(not wrong, "refusals touch no result", "; ".join(wrong))


def main():
    with_h5py()
    checks = Checks()
    seed, number, *_ = [int(word) for word in sys.argv[1:] if word.isdigit()] + [1, 8][sum(word.isdigit() for word in sys.argv[1:]):]
    draw = random.Random(seed)
    text = deck_text(UPSETTING).replace("SAVE   20", "SAVE   7")
    deck = write(checks.path("billet.lag"), text)
    often = write(checks.path("often", "billet.lag"), add_cards(text, f"CKPT   {EVERY}"))
    small, middle = mesh(6, 9), mesh(12, 18)
    wholes = {}
    for name, path, options in (("small", deck, small), ("middle", deck, middle), ("often", often, small)):
        wholes[name] = checks.path(f"whole-{name}")
        result = run([path, "--out", wholes[name], "--threads", "1"] + options)
        checks.that(result.returncode == DONE, f"{name}: in one go", said(result))
    stops(checks, draw, deck, "6x9", small, wholes["small"], 8)
    stops(checks, draw, deck, "12x18", middle, wholes["middle"], 3)
    stops_between_saves(checks, often, small, wholes["often"])
    kills(checks, draw, often, small, wholes["often"], number)
    older_checkpoint(checks, often, small, wholes["often"])
    at_the_end(checks, deck, small, wholes["small"])
    refusals(checks, draw, deck, text, small, wholes["small"])
    checks.end()


if __name__ == "__main__":
    main()
