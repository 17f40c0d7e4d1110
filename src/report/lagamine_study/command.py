"""`lagastudy DECK --ladder ... --quantity ...`: arguments -> runs -> tables and a picture -> exit code."""
import os
import shlex
import sys
from typing import Dict, List, Sequence

from lagamine_report.errors import EXIT_DONE, ReportError
from lagamine_report.program import Parser, Version, print_failure, refuse_to_replace, run_to_code, write

from .errors_of_ladder import judge
from .ladders import Ladder, Rung, read_ladder, read_quantity
from .runs import MARK, Result, command_of, digest_of, is_there, make_runs, read_result, refuse_times

EXIT_CODES = "Exit codes: 0 done, 2 the deck or an option is refused, 3 a run did not reach its end (the tables name it), 5 the machine failed, 128+n stopped by signal n."
NOT_AT_END = 3
FEWER = 0.7      # of a number of steps: shorter ones, in a ladder that begins with the finest run; contact and events change it by less
MODULES = ("numpy", "h5py", "matplotlib")


def main(arguments: Sequence[str], version: str) -> int:
    """The exit code of the program."""
    return run_to_code(lambda: run_program(arguments, version))


def run_program(arguments: Sequence[str], version: str) -> int:
    """Read the arguments, make the runs that are missing, write tables and picture."""
    options = _parser(version).parse_args(list(arguments))
    for stream in (sys.stdout, sys.stderr):
        stream.reconfigure(errors="replace")
    try:
        return study(options)
    except ReportError as error:
        return print_failure(error)


def _parser(version: str) -> Parser:
    parser = Parser("lagastudy", description="One deck over ladders of its parameters: errors, orders, and what accuracy costs in time.", epilog=EXIT_CODES)
    parser.add_argument("deck", metavar="DECK")
    parser.add_argument("--ladder", metavar="'NAME=V1,V2,...'", action="append", required=True,
                        help="values of a parameter from the coarsest run to the finest; several that change together in one text "
                        "('nx=4,8,16 ny=6,12,24'); may be repeated, each ladder with all others at the values of the deck")
    parser.add_argument("--quantity", metavar="COLUMN[@WHEN]", action="append", required=True,
                        help="a column of history.csv at the end, or @max, @min, @TIME; may be repeated")
    parser.add_argument("--exact", metavar="QUANTITY=VALUE", action="append", default=[],
                        help="what a quantity should be (default: Richardson's extrapolation where three runs allow it, otherwise the finest run)")
    parser.add_argument("-p", metavar="NAME=VALUE", dest="parameters", action="append", default=[], help="a parameter for all runs")
    parser.add_argument("--out", metavar="DIR", help="folder of the runs, of study.csv, study.md and work_precision.svg (default: study_NAME in the present one)")
    parser.add_argument("--jobs", metavar="N", type=int, default=1, help="runs at a time (default 1)")
    parser.add_argument("--threads", metavar="N", type=int, default=1, help="threads of a run (default 1); seconds are those of all of them")
    parser.add_argument("--slurm", metavar="FILE", help="write a script for a Slurm array of the runs that are missing instead of making them; "
                        "the same command without it then makes the tables")
    parser.add_argument("--quiet", action="store_true", help="print nothing when all goes well")
    parser.add_argument("--version", action=Version, version=version, modules=MODULES)
    return parser


def study(options) -> int:
    """The study; its exit code."""
    out = options.out or "study_" + os.path.splitext(os.path.basename(options.deck))[0]
    for name in ("jobs", "threads"):
        if getattr(options, name) < 1:
            raise ReportError(f"--{name}: expected 1 or more")
    ladders = [read_ladder(text, out) for text in options.ladder]
    if len({ladder.name for ladder in ladders}) < len(ladders):
        raise ReportError("--ladder: two ladders of the same parameters")
    quantities = [read_quantity(text, options.exact) for text in dict.fromkeys(options.quantity)]
    for word in options.exact:
        if not any(quantity.text == word.rpartition("=")[0] for quantity in quantities):
            raise ReportError(f"--exact {word}: of no --quantity")
    missing, marks = missing_runs(options, ladders)
    refuse_times(missing, quantities)
    if options.slurm:
        return hand_over(options, missing, marks)
    rungs = {rung.folder: rung for ladder in ladders for rung in ladder.rungs}

    def made(folder: str) -> None:
        # a quantity that a run does not have is known before the next one
        read_result(rungs[folder], quantities)
        if not options.quiet:
            print(f"  {os.path.relpath(folder, out)}", flush=True)

    make_runs(missing, marks, options.jobs, made)
    return write_study(options, out, ladders, quantities)


def missing_runs(options, ladders: Sequence[Ladder]):
    """Calls and marks, by folder, of the runs that are not there yet."""
    programs = os.path.join(os.path.dirname(os.path.dirname(os.path.dirname(os.path.dirname(os.path.realpath(__file__))))), "bin")
    programs = os.environ.get("LAGAMINE_BIN") or programs
    digest = digest_of(options.deck)
    rungs: Dict[str, Rung] = {rung.folder: rung for ladder in ladders for rung in ladder.rungs}
    calls, marks = {}, {}
    for folder, rung in rungs.items():
        call = command_of(options.deck, rung, options.parameters, os.path.abspath(programs), options.threads)
        mark = {"deck_sha256": digest, "call": [os.path.basename(call[0]), *call[4:]]}
        if not is_there(rung, mark):
            calls[folder], marks[folder] = call, mark
    return calls, marks


def hand_over(options, missing: Dict[str, List[str]], marks: Dict[str, Dict[str, object]]) -> int:
    """A script for a Slurm array: a task a run; none where all runs are there."""
    import json
    if not missing:
        if not options.quiet:
            print("all runs are there: the same command without --slurm reads them")
        return EXIT_DONE
    for folder in missing:
        os.makedirs(folder, exist_ok=True)
        write(os.path.join(folder, MARK), json.dumps(marks[folder], indent=1).encode("utf-8"))
    lines = ["#!/bin/sh", f"#SBATCH --array=1-{len(missing)}", f"#SBATCH --cpus-per-task={options.threads}", f"cd {shlex.quote(os.getcwd())}",
             'case "${SLURM_ARRAY_TASK_ID:?}" in']
    lines += [f"{k}) exec {shlex.join(call)} ;;" for k, call in enumerate(missing.values(), 1)]
    refuse_to_replace(options.slurm)
    write(options.slurm, ("\n".join([*lines, "esac"]) + "\n").encode("utf-8"))
    if not options.quiet:
        print(f"{len(missing)} runs: sbatch {options.slurm}")
    return EXIT_DONE


def refuse_backwards(ladder: Ladder, results: Sequence[Result]) -> None:
    """A ladder of numbers that goes from the finest run to the coarsest one, which would be its truth: elements that become fewer, or as many with
    fewer and fewer steps."""
    ends = [result for result in results if result.code == EXIT_DONE]
    if len(ends) < 2 or None in ladder.ratios():
        return
    counts = [(result.elements, result.steps) for result in ends]
    pairs = list(zip(counts, counts[1:]))
    for k, what in enumerate(("elements", "steps")):
        if all(b[0] == a[0] and b[1] < FEWER * a[1] for a, b in pairs) if k else all(b[0] < a[0] for a, b in pairs):
            raise ReportError(f"--ladder {ladder.name}: expected runs from the coarsest to the finest, found {counts[0][k]:g} {what} with {ends[0].rung.title} "
                              f"and {counts[-1][k]:g} with {ends[-1].rung.title}", advice="give the values in the other order: the runs are there")


def write_study(options, out: str, ladders: Sequence[Ladder], quantities) -> int:
    """Tables and picture; 3 where a run did not reach its end."""
    from .tables import as_csv, as_markdown, rows, work_precision
    results = {ladder.name: [read_result(rung, quantities) for rung in ladder.rungs] for ladder in ladders}
    for ladder in ladders:
        refuse_backwards(ladder, results[ladder.name])
    verdicts = {(ladder.name, quantity.text): judge([result.values[quantity.text] for result in results[ladder.name]], ladder.ratios(),
                                                    [result.seconds for result in results[ladder.name]], quantity.exact)
                for ladder in ladders for quantity in quantities}
    table = as_markdown(os.path.basename(options.deck), ladders, results, quantities, verdicts)
    picture = work_precision(ladders, results, quantities, verdicts)
    write(os.path.join(out, "study.csv"), as_csv([row for ladder in ladders for row in rows(ladder, results[ladder.name], quantities, verdicts)]))
    write(os.path.join(out, "study.md"), table)
    write(os.path.join(out, "work_precision.svg"), picture.svg())
    if not options.quiet:
        print(table.decode("utf-8"), end="")
    return NOT_AT_END if any(result.code for held in results.values() for result in held) else EXIT_DONE
