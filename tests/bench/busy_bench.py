#!/usr/bin/env python3
"""What threads cost on an idle machine and on a busy one: the upsetting deck by default, on one thread and on two.

usage: busy_bench.py [--mesh NXxNY] [--repeat N] [--busy N] [--patience S] [--write]      a minute and a half on an idle machine

Busy: N other processes (1) compute without end beside the run. All six in turns; the least seconds of so many runs (3) of each.
Before a run on an idle machine it waits, no longer than S seconds (60), until nobody else is at work; how many processors others
took during the least run all the same stands in brackets. Exit code 1 when the default costs more than its limit times the better
of one and two threads, or results differ. OMP_*, GOMP_* and OPENBLAS_* of the environment are left out. Linux only (/proc/stat).
"""
import argparse
import json
import os
import re
import subprocess
import sys
import tempfile
import time

sys.dont_write_bytecode = True
from bench import DECK, processor, put_into_readme  # noqa: E402

HERE = os.path.dirname(os.path.abspath(__file__))
BIN = os.environ.get("LAGAMINE_BIN", os.path.join(os.path.dirname(os.path.dirname(HERE)), "build", "bin"))
BEGIN, END = "<!-- busy: written by busy_bench.py --write -->", "<!-- busy: end -->"
LIMITS = {"idle": 1.1, "busy": 1.3}
WAYS = {"default": [], "1": ["--threads", "1"], "2": ["--threads", "2"]}
# Fewer processors at work than this are rest; a loop that ends by itself, should this script be killed.
AT_REST, LONGEST_LOOP = 0.25, 600
LOOP = f"import time\nend = time.monotonic() + {LONGEST_LOOP}\nwhile time.monotonic() < end: pass"


def processor_seconds():
    """Seconds that all processors together were at work since the machine was started."""
    with open("/proc/stat", encoding="ascii") as file:
        user, nice, system, _, _, *interrupts = map(int, file.readline().split()[1:9])
    return (user + nice + system + sum(interrupts)) / os.sysconf("SC_CLK_TCK")


def wait_for_rest(patience):
    """Wait until the machine has been idle for half a second."""
    limit = time.monotonic() + patience
    while time.monotonic() < limit:
        before = processor_seconds()
        time.sleep(0.5)
        if processor_seconds() - before < 0.5 * AT_REST:
            return


def run(mesh, words, busy, folder):
    """Seconds of one run, the processors that others took meanwhile (the busy loops left out), and its history."""
    nx, ny = mesh.split("x")
    environment = {name: value for name, value in os.environ.items() if not name.startswith(("OMP_", "GOMP_", "OPENBLAS_"))}
    loops = [subprocess.Popen([sys.executable, "-c", LOOP]) for _ in range(busy)]
    try:
        if busy:
            time.sleep(0.3)
        taken, start = processor_seconds(), time.perf_counter()
        process = subprocess.Popen([os.path.join(BIN, "lagamine"), DECK, "--out", folder, "--quiet", "-p", f"nx={nx}", "-p",
                                    f"ny={ny}", *words], env=environment, stdin=subprocess.DEVNULL)
        _, status, usage = os.wait4(process.pid, 0)
        wall = time.perf_counter() - start
        taken = processor_seconds() - taken
        process.returncode = os.waitstatus_to_exitcode(status)
    finally:
        for loop in loops:
            loop.kill()
            loop.wait()
    if process.returncode != 0:
        sys.exit(f"busy_bench: lagamine {' '.join(words)}: exit code {process.returncode}")
    others = max((taken - usage.ru_utime - usage.ru_stime) / wall, 0.0)
    with open(os.path.join(folder, "history.csv"), "rb") as file:
        return wall, others, file.read()


def measure(options, folder):
    """The least run of all six, in turns, and whether all histories are the same."""
    least, histories = {}, set()
    for repetition in range(options.repeat):
        for way, words in list(WAYS.items())[::1 if repetition % 2 == 0 else -1]:
            for state in LIMITS:
                if state == "idle":
                    wait_for_rest(options.patience)
                wall, others, history = run(options.mesh, words, options.busy if state == "busy" else 0, folder)
                least[state, way] = min(least.get((state, way), (wall, others)), (wall, others))
                histories.add(history)
                print(f"busy_bench: {state} {way}: {wall:.2f} s, others {others:.2f}", file=sys.stderr, flush=True)
    return least, len(histories) == 1


def table(options, least, same, folder):
    """The results in Markdown, and whether all limits hold."""
    with open(os.path.join(folder, "summary.json"), encoding="utf-8") as file:
        blas = json.load(file)["blas"]
    lines = [f"{time.strftime('%Y-%m-%d')}, {processor()}, {os.cpu_count()} processors, {blas}, {options.mesh}, the least of "
             f"{options.repeat} runs; busy: {options.busy} other process{'es' if options.busy > 1 else ''}; histories "
             f"{'are the same' if same else '**differ**'}.", "",
             "| machine | default s | 1 thread s | 2 threads s | default over the better | at most | |", "|---|---|---|---|---|---|---|"]
    reached = same
    for state, limit in LIMITS.items():
        cells = [f"{wall:.2f} ({others:.2f})" for wall, others in (least[state, way] for way in WAYS)]
        ratio = least[state, "default"][0] / min(least[state, "1"][0], least[state, "2"][0])
        reached = reached and ratio <= limit
        lines.append(f"| {state} | {' | '.join(cells)} | {ratio:.2f} | {limit} | {'reached' if ratio <= limit else '**not reached**'} |")
    return "\n".join(lines) + "\n", reached


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("--mesh", default="24x36")
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--busy", type=int, default=1)
    parser.add_argument("--patience", type=float, default=60.0)
    parser.add_argument("--write", action="store_true")
    options = parser.parse_args()
    if not re.fullmatch(r"[1-9]\d*x[1-9]\d*", options.mesh) or options.repeat < 1 or options.busy < 1:
        parser.error("expected a mesh such as 24x36, and one run and one other process at least")
    with tempfile.TemporaryDirectory(prefix="lagamine-busy-") as folder:
        least, same = measure(options, folder)
        text, reached = table(options, least, same, folder)
    print(text, end="")
    if options.write:
        put_into_readme(text, BEGIN, END)
    return 0 if reached else 1


if __name__ == "__main__":
    sys.exit(main())
