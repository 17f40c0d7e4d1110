"""A study as a table for programs (CSV), for people (Markdown), and as pictures."""
import csv
import io
import math
import re
from typing import Dict, List, Sequence, Tuple

from lagamine_report.picture import Picture
from lagamine_report.style import LINES, figure, plain_numbers
from lagamine_report.words import brief

from .errors_of_ladder import Verdict
from .ladders import Ladder, Quantity
from .runs import Result

Verdicts = Dict[Tuple[str, str], Verdict]      # by ladder and quantity
HEADINGS = ["ladder", "run", "exit_code", "quantity", "value", "truth", "truth_from", "relative_error", "order", "processor_s", "wall_s", "steps", "iterations", "elements",
            "equations", "warnings"]


def rows(ladder: Ladder, results: Sequence[Result], quantities: Sequence[Quantity], verdicts: Verdicts) -> List[list]:
    """A row a run and quantity."""
    found = []
    for quantity in quantities:
        verdict = verdicts[ladder.name, quantity.text]
        for k, result in enumerate(results):
            order = verdict.orders[k - 1] if k else float("nan")
            found.append([ladder.name, result.rung.title, result.code, quantity.text, result.values[quantity.text], verdict.truth, verdict.source,
                          verdict.errors[k], order, result.seconds, result.wall, result.steps, result.iterations, result.elements, result.equations,
                          len(result.warnings)])
    return found


def as_csv(all_rows: Sequence[list]) -> bytes:
    """The table for programs; not a number where nothing is known."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(HEADINGS)
    writer.writerows([repr(cell) if isinstance(cell, float) else cell for cell in row] for row in all_rows)
    return text.getvalue().encode("utf-8")


def as_markdown(title: str, ladders: Sequence[Ladder], results: Dict[str, List[Result]], quantities: Sequence[Quantity], verdicts: Verdicts) -> bytes:
    """Tables for people, a ladder and quantity each; runs that did not reach their end are named, and what speaks against others."""
    lines = [f"# {title}", ""]
    for ladder in ladders:
        held = results[ladder.name]
        for quantity in quantities:
            verdict = verdicts[ladder.name, quantity.text]
            lines += [f"## {quantity.text} over {ladder.name}", f"Truth {brief(verdict.truth, 7)}: {verdict.source}.{_price(verdict)}", "",
                      f"| run | value | {_heading(verdict)} | order | processor s | steps | iterations | elements |", "|---|---|---|---|---|---|---|---|"]
            for k, result in enumerate(held):
                order = verdict.orders[k - 1] if k else float("nan")
                lines.append(f"| {result.rung.title} | {_cell(result.values[quantity.text], 7)} | {_cell(verdict.percent * verdict.errors[k], 3)} | {_cell(order, 3)} | "
                             f"{_cell(result.seconds, 3)} | {_cell(result.steps)} | {_cell(result.iterations)} | {_cell(result.elements)} |")
            lines.append("")
        lines += [f"{result.rung.title} did not reach its end: {result.reason}" for result in held if result.code]
        lines += warning_lines(held)
    return ("\n".join(lines).rstrip() + "\n").encode("utf-8")


def warning_lines(results: Sequence[Result]) -> List[str]:
    """What speaks against the runs of a ladder: each warning once, with the numbers of the last run that has it, and the runs."""
    texts: Dict[str, str] = {}
    runs: Dict[str, List[str]] = {}
    for result in results:
        for text in result.warnings:
            same = re.sub(r"[-+.0-9]", "", text)
            texts[same] = text
            if result.rung.title not in runs.setdefault(same, []):
                runs[same].append(result.rung.title)
    return [f"WARNING ({', '.join(runs[same])}): {text}" for same, text in texts.items()]


def _heading(verdict: Verdict) -> str:
    return "error %" if verdict.truth else "error"


def _price(verdict: Verdict) -> str:
    return "" if math.isnan(verdict.half_costs) else f" Half the error costs {brief(verdict.half_costs, 2)} times the time."


def _cell(value: float, digits: int = 6) -> str:
    return "–" if math.isnan(value) else brief(value, digits)


def work_precision(ladders: Sequence[Ladder], results: Dict[str, List[Result]], quantities: Sequence[Quantity], verdicts: Verdicts) -> Picture:
    """Error over seconds, a curve a ladder, a panel a quantity."""
    columns = min(2, len(quantities))
    count = -(-len(quantities) // columns)
    fig, axes = figure(count, columns, (4.7 * columns + (1.6 if columns == 1 else 0), 3.6 * count))
    for panel, quantity in zip(axes.flat, quantities):
        for ladder, colour in zip(ladders, LINES * len(ladders)):
            verdict = verdicts[ladder.name, quantity.text]
            known = [(result.seconds, verdict.percent * error) for result, error in zip(results[ladder.name], verdict.errors) if error > 0 and result.seconds > 0]
            if known:
                panel.loglog(*zip(*known), marker="o", color=colour, label=ladder.name)
        panel.set_title(quantity.text)
        panel.set_xlabel("seconds of processor")
        panel.set_ylabel(_heading(verdicts[ladders[0].name, quantity.text]))
        for axis in (panel.xaxis, panel.yaxis):
            plain_numbers(axis)
        if panel.get_legend_handles_labels()[0]:
            panel.legend()
    for panel in axes.flat[len(quantities):]:
        panel.set_visible(False)
    return Picture("work_precision", "error over seconds of processor", fig, vector=True)
