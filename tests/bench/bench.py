#!/usr/bin/env python3
"""What upsetting costs: element kernel, iteration and whole run, on one thread and on two; and the same billet in CalculiX.

Called by run.sh, which explains the options. Standard library only.
"""
import argparse
import csv
import json
import os
import platform
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

sys.dont_write_bytecode = True
import ccx_billet  # noqa: E402

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
DECK = os.path.join(ROOT, "decks", "upsetting", "upsetting.lag")
README = os.path.join(HERE, "README.md")
BEGIN, END = "<!-- bench: written by run.sh --write -->", "<!-- bench: end -->"

# design page 2, 'Cost to reach'
KERNEL_TARGET_US = 15.0
ITERATION_MESH, ITERATION_TARGET_S = "48x72", 0.20
CCX_MESH, CCX_TARGET = "24x36", 10.0
# Two threads against one: timers of summary.json, and how many times faster they should be.
THREADS_MESH = "48x72"
THREADS_TARGETS = {"displacement": 1.8, "factorisation": None, "assembly": None, "solution": None, "whole run": 1.5}
# Reduction of height at which forces are compared, as shares of the die's travel.
MOMENTS = {"30 %": 0.5, "44 %": 22 / 30, "60 %": 1.0}
TASKS = ("factorisation", "displacement", "assembly", "solution", "contact")
FOLDING, PLAIN, CCX = "folding", "no side contact", "CAX8R"
# The cost of the search: dies of the same shape in pieces few and many, and what contact may take of the run with many.
DOMED = {"die of 2 parabolas": 2, "die of 2000 parabolas": 2000}
DOMED_MESH, MANY, CONTACT_TARGET = "24x36", "die of 2000 parabolas", 0.05
# The cost of friction: both faces on one Coulomb law, without and with it.
SLIDING = {"PHI 0 on all faces": 0.0, "PHI 0.1 on all faces": 0.1}


def deck_without_side_contact():
    """The deck as it is, less the contact of the side: what is left is CalculiX's reference."""
    with open(DECK, encoding="utf-8") as deck:
        text = deck.read()
    for card in (r"CNT2D  billet 2 ", r"LAW    rough"):
        text, count = re.subn(r"(?m)^" + card + r".*\n(?: .*\n)*", "", text)
        if count != 1:
            sys.exit(f"bench: {DECK} has {count} cards '{card.strip()}', one was expected")
    return text


def deck_with_domed_die(pieces):
    """The deck with the die y = 15 + 2e-4 x^2 in so many equal parabolas: any part of a parabola is one."""
    with open(DECK, encoding="utf-8") as deck:
        text = deck.read()
    places = [30 - 31 * k / (2 * pieces) for k in range(2 * pieces + 1)]
    points = [f"{x:.15g} {15 + 2e-4 * x * x:.15g}" for x in places]
    rows = "".join(f"   PARAB {points[k]} {points[k + 1]} {points[k + 2]}\n" for k in range(0, 2 * pieces, 2))
    text, count = re.subn(r"(?m)^   SEGM .*\n", lambda _: rows, text)
    if count != 1:
        sys.exit(f"bench: {DECK} has {count} rows SEGM, one was expected")
    return text


def deck_with_friction(phi):
    """The deck with one Coulomb law on both faces."""
    with open(DECK, encoding="utf-8") as deck:
        text = deck.read()
    for card, new in ((r"^CNT2D  billet 3  upper stick", "CNT2D  billet 3  upper rough"), (r"^LAW    stick.*\n(?: .*\n)*", ""),
                      (r"PHI 0\.5", f"PHI {phi:g}")):
        text, count = re.subn("(?m)" + card, new, text)
        if count != 1:
            sys.exit(f"bench: {DECK} has {count} times '{card}', once was expected")
    return text


def at_moments(times, forces):
    """Forces [kN] at the moments, linear between the instants of a run."""
    found = {}
    for name, moment in MOMENTS.items():
        for k in range(1, len(times)):
            if times[k - 1] < moment <= times[k] + 1e-9:
                share = (moment - times[k - 1]) / (times[k] - times[k - 1])
                found[name] = (forces[k - 1] + share * (forces[k] - forces[k - 1])) / 1000
    return found


def run_lagamine(deck, mesh, folder, threads=1):
    """One run of the solver: a row of numbers."""
    nx, ny = mesh.split("x")
    out = os.path.join(folder, "out")
    shutil.rmtree(out, ignore_errors=True)
    command = [os.path.join(os.environ["LAGAMINE_BIN"], "lagamine"), deck, "--threads", str(threads), "--quiet", "--out", out,
               "-p", f"nx={nx}", "-p", f"ny={ny}"]
    started = time.monotonic()
    result = subprocess.run(command, stderr=subprocess.PIPE, text=True, check=False)
    total = time.monotonic() - started
    if result.returncode != 0:
        print(f"bench: {' '.join(command)}\n  ended with {result.returncode}: {result.stderr.strip()}", file=sys.stderr)
        return None
    with open(os.path.join(out, "summary.json"), encoding="utf-8") as file:
        summary = json.load(file)
    seconds = summary["seconds"]
    with open(os.path.join(out, os.path.basename(deck).replace(".lag", ".log")), encoding="utf-8") as file:
        solves = int(re.findall(r"solution .* s in (\d+) calls", file.read())[-1])
    with open(os.path.join(out, "history.csv"), newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    times = [0.0] + [float(row["time [time]"]) for row in rows]
    forces = [0.0] + [abs(float(row["force_y_upper [force]"])) for row in rows]
    kernel = seconds["displacement"] / summary["effects"]["displacement"]["calls"] / summary["elements"]
    row = {"total": total, "cpu": summary["cpu_s"], "steps": summary["steps"], "iterations": solves,
           "cutbacks": summary["cutbacks"], "unknowns": summary["dofs"], "kernel_us": 1e6 * kernel, "per_iteration": total / solves,
           "evaluations": summary["effects"]["displacement"]["calls"], "forces": at_moments(times, forces)}
    row["seconds"] = dict({task: seconds.get(task, 0.0) for task in TASKS}, **{"whole run": total})
    row["shares"] = {task: seconds.get(task, 0.0) / total for task in TASKS}
    row["shares"]["other"] = 1 - sum(row["shares"].values())
    return row


def run_ccx(mesh, folder):
    """One run of CalculiX: a row of numbers."""
    nx, ny = map(int, mesh.split("x"))
    with open(os.path.join(folder, "billet.inp"), "w", encoding="utf-8") as file:
        file.write(ccx_billet.input_deck(nx, ny))
    environment = dict(os.environ, OMP_NUM_THREADS="1", CCX_NPROC_STIFFNESS="1", CCX_NPROC_EQUATION_SOLVER="1")
    started = time.monotonic()
    before = os.times()
    result = subprocess.run(["ccx", "-i", "billet"], cwd=folder, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                            text=True, check=False)
    total = time.monotonic() - started
    after = os.times()
    answer = ccx_billet.read_answer(folder)
    if result.returncode != 0 or not answer["times"] or answer["times"][-1] < 1 - 1e-6:
        print(f"bench: ccx did not reach the end ({mesh}): {result.stdout[-300:]}", file=sys.stderr)
        return None
    cpu = after.children_user - before.children_user + after.children_system - before.children_system
    return {"total": total, "cpu": cpu, "steps": answer["steps"], "iterations": answer["iterations"], "cutbacks": answer["cutbacks"],
            "per_iteration": total / answer["iterations"], "forces": at_moments(answer["times"], answer["forces"])}


def median_of(rows):
    """Medians of what varies between repetitions."""
    rows = [row for row in rows if row]
    if not rows:
        return None
    middle = dict(rows[0])
    for key in ("total", "cpu", "kernel_us", "per_iteration"):
        if key in middle:
            middle[key] = statistics.median(row[key] for row in rows)
    if "shares" in middle:
        middle["shares"] = {task: statistics.median(row["shares"][task] for row in rows) for task in middle["shares"]}
    return middle


def measure(options, folder):
    """All runs, in turns: every repetition runs every program, in an order turned round each time."""
    plain = os.path.join(folder, "plain.lag")
    with open(plain, "w", encoding="utf-8") as file:
        file.write(deck_without_side_contact())
    results = {}
    for mesh in options.meshes:
        jobs = {FOLDING: lambda mesh=mesh: run_lagamine(DECK, mesh, folder), PLAIN: lambda mesh=mesh: run_lagamine(plain, mesh, folder)}
        if mesh in options.ccx_meshes:
            jobs[CCX] = lambda mesh=mesh: run_ccx(mesh, folder)
        if mesh == DOMED_MESH:
            decks = {name: deck_with_domed_die(pieces) for name, pieces in DOMED.items()}
            decks.update((name, deck_with_friction(phi)) for name, phi in SLIDING.items())
            for k, (name, text) in enumerate(decks.items()):
                path = os.path.join(folder, f"scene{k}.lag")
                with open(path, "w", encoding="utf-8") as file:
                    file.write(text)
                jobs[name] = lambda path=path, mesh=mesh: run_lagamine(path, mesh, folder)
        rows = {name: [] for name in jobs}
        for repetition in range(options.repeat):
            for name in list(jobs)[::1 if repetition % 2 == 0 else -1]:
                rows[name].append(jobs[name]())
                last = rows[name][-1]
                print(f"bench: {mesh} {name}: {last['total']:.2f} s" if last else f"bench: {mesh} {name}: failed", file=sys.stderr, flush=True)
        for name, measured in rows.items():
            results[mesh, name] = median_of(measured)
    return results


def measure_threads(options, folder):
    """Both numbers of threads in turns: the least seconds of every task, and whether the history is the same."""
    least, histories = {1: {}, 2: {}}, set()
    for repetition in range(options.threads_repeat):
        for threads in (1, 2) if repetition % 2 == 0 else (2, 1):
            row = run_lagamine(DECK, THREADS_MESH, folder, threads)
            if not row:
                return None
            print(f"bench: {THREADS_MESH} {threads} threads: {row['total']:.2f} s", file=sys.stderr, flush=True)
            for task in THREADS_TARGETS:
                least[threads][task] = min(least[threads].get(task, float("inf")), row["seconds"][task])
            with open(os.path.join(folder, "out", "history.csv"), "rb") as file:
                histories.add(file.read())
    return {"seconds": least, "same": len(histories) == 1}


def threads_table(measured, repeat):
    """Two threads against one, in Markdown."""
    names = {"displacement": "element loop"}
    lines = ["", f"Two threads against one, {THREADS_MESH}, `{FOLDING}`, "
             + (f"least of {repeat} runs each" if repeat > 1 else "one run each")
             + (f"; histories {'are the same' if measured['same'] else '**differ**'}." if measured else "."), ""]
    if not measured:
        return lines + ["A run did not finish."]
    lines += ["| task | one thread s | two threads s | ratio | wanted | |", "|---|---|---|---|---|---|"]
    for task, target in THREADS_TARGETS.items():
        one, two = (measured["seconds"][threads][task] for threads in (1, 2))
        wanted = f">= {target:g} | {verdict(one / two, target, at_most=False)}" if target else " |"
        lines.append(f"| {names.get(task, task)} | {one:.2f} | {two:.2f} | {one / two:.2f} | {wanted} |")
    return lines


def verdict(value, target, at_most=True):
    """A number and its target."""
    reached = value <= target if at_most else value >= target
    return "reached" if reached else "**not reached**"


def tables(results, options):
    """The results in Markdown."""
    lines = [f"{time.strftime('%Y-%m-%d')}, {processor()}, one thread, "
             + (f"medians of {options.repeat} runs." if options.repeat > 1 else "one run each."), "",
             "| mesh | scene | unknowns | steps | iterations | cutbacks | total s | processor s | s/iteration | kernel us | "
             "30 % | 44 % | 60 % kN |",
             "|---|---|---|---|---|---|---|---|---|---|---|---|---|"]
    for (mesh, name), row in results.items():
        if not row:
            lines.append(f"| {mesh} | {name} | did not finish ||||||||||| ")
            continue
        kernel = f"{row['kernel_us']:.2f}" if "kernel_us" in row else ""
        forces = " | ".join(f"{row['forces'].get(moment, float('nan')):.1f}" for moment in MOMENTS)
        lines.append(f"| {mesh} | {name} | {row.get('unknowns', '')} | {row['steps']} | {row['iterations']} | {row['cutbacks']} | "
                     f"{row['total']:.2f} | {row['cpu']:.2f} | {row['per_iteration']:.4f} | {kernel} | {forces} |")
    lines += ["", "| mesh | scene | " + " | ".join(task + " %" for task in share_names()) + " |", "|---|---" + "|---" * 6 + "|"]
    for (mesh, name), row in results.items():
        if row and "shares" in row:
            lines.append(f"| {mesh} | {name} | " + " | ".join(f"{100 * row['shares'][task]:.1f}" for task in share_keys()) + " |")
    lines += ["", "| target | measured | |", "|---|---|---|"] + targets(results)
    return "\n".join(lines) + "\n"


def share_keys():
    return TASKS + ("other",)


def share_names():
    return [{"displacement": "element loop"}.get(task, task) for task in share_keys()]


def targets(results):
    """Rows of numbers beside what they should be."""
    lines = []
    for (mesh, name), row in results.items():
        if row and "kernel_us" in row:
            lines.append(f"| element kernel <= {KERNEL_TARGET_US:g} us | {mesh}, {name}: {row['kernel_us']:.2f} us | "
                         f"{verdict(row['kernel_us'], KERNEL_TARGET_US)} |")
        if row and mesh == ITERATION_MESH and "kernel_us" in row:
            lines.append(f"| iteration of {mesh} <= {ITERATION_TARGET_S:.2f} s | {name}: {row['per_iteration']:.3f} s | "
                         f"{verdict(row['per_iteration'], ITERATION_TARGET_S)} |")
    for (mesh, name), row in results.items():
        if row and name == MANY:
            share = row["shares"]["contact"]
            lines.append(f"| contact <= {100 * CONTACT_TARGET:g} % of the run | {mesh}, {name}: {100 * share:.2f} % | "
                         f"{verdict(share, CONTACT_TARGET)} |")
    free, rough = (results.get((DOMED_MESH, name)) for name in SLIDING)
    if free and rough:
        cost = [1e6 * row["seconds"]["contact"] / row["evaluations"] for row in (free, rough)]
        lines.append(f"| what friction costs: contact in an evaluation | {DOMED_MESH}, PHI 0 to 0.1: {cost[0]:.0f} to {cost[1]:.0f} us | |")
        lines.append(f"| the same, of the whole run | {100 * (cost[1] - cost[0]) * 1e-6 * rough['evaluations'] / rough['total']:.2f} % | |")
        lines.append(f"| the same, iterations a step | {free['iterations'] / free['steps']:.1f} to {rough['iterations'] / rough['steps']:.1f} | |")
    for (mesh, name), row in results.items():
        ours = results.get((mesh, PLAIN))
        if name != CCX or not row or not ours:
            continue
        total, iteration = row["total"] / ours["total"], row["per_iteration"] / ours["per_iteration"]
        judged = verdict(total, CCX_TARGET, at_most=False) if mesh == CCX_MESH else ""
        wanted = f"CalculiX / LAGAMINE, whole run{f' >= {CCX_TARGET:g}' if mesh == CCX_MESH else ''}"
        lines.append(f"| {wanted} | {mesh}: {total:.1f} | {judged} |")
        lines.append(f"| the same, of processor time | {mesh}: {row['cpu'] / ours['cpu']:.1f} | |")
        lines.append(f"| CalculiX / LAGAMINE, an iteration | {mesh}: {iteration:.1f} | |")
    return lines


def processor():
    """Name of the processor."""
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            names = [line.split(":", 1)[1].strip() for line in file if line.startswith("model name")]
        return names[0] if names else platform.machine()
    except OSError:
        return platform.machine()


def write_csv(path, results):
    """One row per mesh and scene, for programs."""
    with open(path, "w", newline="", encoding="utf-8") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["mesh", "scene", "unknowns", "steps", "iterations", "evaluations", "cutbacks", "total_s", "cpu_s", "s_per_iteration",
                        "kernel_us"] + [f"share_{task}" for task in share_keys()] + [f"force_{name.split()[0]}_kN" for name in MOMENTS])
        for (mesh, name), row in results.items():
            if row:
                table.writerow([mesh, name] + [row.get(key, "") for key in ("unknowns", "steps", "iterations", "evaluations", "cutbacks", "total",
                                                                            "cpu", "per_iteration", "kernel_us")]
                               + [row.get("shares", {}).get(task, "") for task in share_keys()]
                               + [row["forces"].get(moment, "") for moment in MOMENTS])


def put_into_readme(text, begin=BEGIN, end=END):
    """The tables between two marks of README.md."""
    with open(README, encoding="utf-8") as file:
        old = file.read()
    if begin not in old or end not in old:
        sys.exit(f"bench: {README} has no marks '{begin}' and '{end}'")
    with open(README, "w", encoding="utf-8") as file:
        file.write(old.split(begin)[0] + begin + "\n" + text + end + old.split(end)[1])


def main():
    parser = argparse.ArgumentParser(prog="run.sh", description="What upsetting costs, and CalculiX on the same billet.")
    parser.add_argument("--meshes", default="12x18 24x36 48x72", help="meshes NXxNY of the solver")
    parser.add_argument("--ccx", action="store_true", help="run CalculiX too, where it is installed")
    parser.add_argument("--ccx-meshes", default="12x18 24x36", help="meshes for CalculiX (48x72 takes minutes)")
    parser.add_argument("--install-ccx", action="store_true", help="install calculix-ccx first, and run it")
    parser.add_argument("--repeat", type=int, default=1, help="runs of each, of which medians are taken")
    parser.add_argument("--threads-repeat", type=int, default=1, help=f"runs of {THREADS_MESH} with one and with two threads (0: none)")
    parser.add_argument("--write", action="store_true", help="put the tables into tests/bench/README.md")
    parser.add_argument("--out", default=os.path.join(ROOT, "out", "bench"), help="folder of bench.md and bench.csv")
    options = parser.parse_args()
    options.meshes = options.meshes.split()
    for mesh in options.meshes + options.ccx_meshes.split():
        if not re.fullmatch(r"[1-9]\d*x[1-9]\d*", mesh):
            parser.error(f"'{mesh}' is no mesh: NXxNY was expected, such as 12x18")
    wanted = options.ccx or options.install_ccx
    if wanted and not shutil.which("ccx"):
        print("bench: ccx is not installed (--install-ccx installs it): without it", file=sys.stderr)
        wanted = False
    options.ccx_meshes = options.ccx_meshes.split() if wanted else []
    options.repeat = max(options.repeat, 1)
    if options.threads_repeat > 0 and (os.cpu_count() or 1) < 2:
        print("bench: this machine has one processor: without the table of two threads", file=sys.stderr)
        options.threads_repeat = 0
    os.makedirs(options.out, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="lagamine-bench-") as folder:
        results = measure(options, folder)
        two = measure_threads(options, folder) if options.threads_repeat > 0 else None
    text = tables(results, options)
    if options.threads_repeat > 0:
        text += "\n".join(threads_table(two, options.threads_repeat)) + "\n"
    print(text, end="")
    with open(os.path.join(options.out, "bench.md"), "w", encoding="utf-8") as file:
        file.write(text)
    write_csv(os.path.join(options.out, "bench.csv"), results)
    if options.write:
        put_into_readme(text)
    return 0 if all(results.values()) and (two and two["same"] or options.threads_repeat <= 0) else 1


if __name__ == "__main__":
    sys.exit(main())
