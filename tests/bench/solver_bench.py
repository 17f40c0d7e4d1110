#!/usr/bin/env python3
"""What the linear solvers cost: the first part of upsetting on two meshes, with each solver in turns.

usage: solver_bench.py [--meshes "24x36 48x72"] [--until 0.1] [--threads 1] [--repeat 3] [--write]
--until    end of the run, as a share of the whole stroke
--write    put the table into tests/bench/README.md
LAGAMINE_BIN is the folder of `lagamine`. Standard library only.
"""
import argparse
import os
import sys
import tempfile
import time

sys.dont_write_bytecode = True
import bench  # noqa: E402

SOLVERS = ("MIXED", "FRONT", "MUMPS")
BEGIN, END = "<!-- solvers: written by solver_bench.py --write -->", "<!-- solvers: end -->"


def deck_with(solver, until):
    """The deck of upsetting with a solver and an end."""
    with open(bench.DECK, encoding="utf-8") as deck:
        head, end = deck.read().rsplit("\nEND", 1)
    return f"{head}\nSOLVR  {solver}\nSTOP   {until:g}\nEND{end}"


def measure(options, folder):
    """The least seconds of all repetitions, by mesh and solver; None where a run failed."""
    results = {}
    for mesh in options.meshes.split():
        for repetition in range(options.repeat):
            for solver in SOLVERS[::1 if repetition % 2 == 0 else -1]:
                deck = os.path.join(folder, f"{solver}.lag")
                with open(deck, "w", encoding="utf-8") as file:
                    file.write(deck_with(solver, options.until))
                row = bench.run_lagamine(deck, mesh, folder, options.threads)
                if not row:
                    return None
                print(f"bench: {mesh} {solver}: {row['total']:.2f} s", file=sys.stderr, flush=True)
                best = results.setdefault((mesh, solver), row)
                for task in row["seconds"]:
                    best["seconds"][task] = min(best["seconds"][task], row["seconds"][task])
    return results


def table(results, options):
    """The results in Markdown: milliseconds of one linear system."""
    lines = [f"{time.strftime('%Y-%m-%d')}, {bench.processor()}, threads: {options.threads}, until {options.until:g} of the stroke, "
             f"the least of {options.repeat} runs.", "",
             "| mesh | solver | unknowns | steps | iterations | factorisation ms/iteration | solution ms/iteration | whole run s |",
             "|---|---|---|---|---|---|---|---|"]
    for (mesh, solver), row in results.items():
        cost = [1000 * row["seconds"][task] / row["iterations"] for task in ("factorisation", "solution")]
        lines.append(f"| {mesh} | {solver} | {row['unknowns']} | {row['steps']} | {row['iterations']} | {cost[0]:.2f} | {cost[1]:.2f} | "
                     f"{row['seconds']['whole run']:.2f} |")
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description="What the linear solvers cost.")
    parser.add_argument("--meshes", default="24x36 48x72", help="meshes NXxNY")
    parser.add_argument("--until", type=float, default=0.1, help="end of the run, as a share of the stroke")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--repeat", type=int, default=3, help="runs of each, of which the least seconds are taken")
    parser.add_argument("--write", action="store_true", help="put the table into tests/bench/README.md")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="lagamine-bench-") as folder:
        results = measure(options, folder)
    if not results:
        return 1
    text = table(results, options)
    print(text, end="")
    if options.write:
        bench.put_into_readme(text, BEGIN, END)
    return 0


if __name__ == "__main__":
    sys.exit(main())
