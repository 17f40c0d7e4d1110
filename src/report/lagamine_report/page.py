"""The page: one HTML file with everything in it, which needs no network."""
import math
import os
from typing import Dict, Iterable, List, Sequence, Tuple

from .accuracy import accuracy_section
from .cooling import cooling_table
from .markup import Sections, document, escape, figure, joined, table
from .picture import Picture
from .reader import Run
from .remesh_section import remesh_section
from .short import Check, checks, command
from .tables import number, warnings_of
from .unfinished import UNDER_WAY
from .words import brief

# Sections in reading order: anchor, heading, pictures by name.
SECTIONS: List[Tuple[str, str, Sequence[str]]] = [
    ("shape", "Shape and mesh", ("mesh", "meshes")),
    ("fields", "Fields", ("fields", "more")),
    ("series", "Fields over time", ("series", "strain_rate")),
    ("profiles", "Profiles", ("profiles",)),
    ("forces", "Forces on the dies", ("force",)),
    ("contact", "Contact", ("pressure", "contact")),
    ("probes", "Probes", ("probes",)),
    ("cooling", "Cooling", ("cooling",)),
    ("steels", "Steels", ()),
    ("march", "Steps and iterations", ("steps",)),
    ("energy", "Energies", ("energy",)),
    ("heat", "Heat", ("heat",)),
    ("seconds", "Seconds", ("seconds",)),
]
# Pictures whose names begin so are in a section too, as many as there are.
PREFIXES = {"series": "series_", "steels": "diagram_"}
LONGEST_LIST = 40


def page(run: Run, pictures: Sequence[Picture], version: str) -> str:
    """The whole page as text."""
    judged = checks(run)
    body = [_with_table(run, section) for section in _sections(pictures)]
    body[1:1] = remesh_section(run, pictures)       # next to the shape, which is always there
    body += accuracy_section(run) + _checks(judged) + _effects(run) + _notes(run) + _origin(run)
    links = "".join(f'<a href="#{anchor}">{escape(heading)}</a>' for anchor, heading, _ in body)
    sections = joined(body)
    header = f"""<h1>{escape(run.title)}</h1>
{_status(run)}
{_tiles(run)}
{_alerts(run, judged)}
<nav>{links}</nav>"""
    footer = f"""lagareport {escape(version)}, from {escape(os.path.basename(os.path.abspath(run.folder)))}/ of
{escape(run.summary.get('program', 'lagamine'))} {escape(run.summary.get('version', ''))}.
Lengths, forces and stresses are in the units of the deck: [stress] stands for its unit of stress, and so on."""
    return document(run.title, header, sections, footer)


def _status(run: Run) -> str:
    s = run.summary
    look = _look(run)
    reason = s.get("stop_reason") or ""
    code = f'<span>exit code {escape(s.get("exit_code"))}</span>' if run.ended and look else ""
    return (f'<p class="reason"><span class="status{look}">{escape(s["status"])}</span>'
            f'<span>{escape(reason)}</span>{code}</p>')


def _look(run: Run) -> str:
    """Class of the line that shows how the run ended: empty when it ended normally."""
    if not run.ended:
        return " open" if run.summary["status"] == UNDER_WAY else " stopped"
    return "" if run.summary.get("exit_code", 0) == 0 else " stopped"


def _tiles(run: Run) -> str:
    s = run.summary
    end = f", of {brief(number(s['end_time']))}" if "end_time" in s else ""
    tiles = [(brief(number(s.get("time"))), "time reached" + end)]
    for key, word in (("steps", "steps"), ("iterations", "iterations"), ("cutbacks", "cutbacks"), ("remeshings", "remeshings"),
                      ("elements", "elements"), ("dofs", "equations")):
        if key in s:
            tiles.append((brief(number(s[key]), 9), word))
    for die in run.die_names:
        columns = [run.history[name] for name in (f"force_y_{die}", f"force_x_{die}") if name in run.history]
        columns = [column for column in columns if len(column.known)]
        if columns:
            column = max(columns, key=lambda column: abs(column.largest))
            tiles.append((brief(column.largest), f"largest {column.name}"))
    for field in ("plastic_strain", "mises"):
        largest = run.largest_at_points(run.steps[-1], field) if run.steps else None
        if largest is not None:
            tiles.append((brief(largest), f"largest {field} at points, {'at the end' if run.ended else 'as last saved'}"))
    tiles += _cost(run)
    return '<div class="tiles">' + "".join(f'<div class="tile"><b>{escape(value)}</b><span>{escape(word)}</span></div>'
                                           for value, word in tiles) + "</div>"


def _cost(run: Run) -> List[Tuple[str, str]]:
    """Seconds and memory. A run of several calls has those of the calls that ended: a killed call reports none."""
    s, calls = run.summary, run.calls
    if not run.ended and calls.number == 0:
        return []
    threads = f", {escape(s['threads'])} threads" if "threads" in s else ""
    if run.ended and calls.number < 2:
        tiles = [(f"{brief(number(s.get('wall_s')), 3)} s", f"on the wall{threads}")]
        if "peak_rss_mb" in s:
            tiles.append((f"{brief(number(s['peak_rss_mb']), 3)} MB", "memory at its peak"))
        return tiles
    remesher = [row.numbers["remdata"] for row in run.tries if not math.isnan(row.numbers["remdata"])]
    tiles = [(f"{brief(calls.wall, 3)} s", f"on the wall in {calls.number} calls of lagamine{threads}")]
    if remesher:
        tiles.append((f"{brief(sum(remesher), 3)} s", f"on the wall in {len(remesher)} calls of remdata"))
    return tiles + [(f"{brief(calls.memory, 3)} MB", "memory of lagamine at its peak")]


def _alerts(run: Run, judged: Iterable[Check]) -> str:
    lines = [escape(check.warning).replace(escape(check.name), f"<b>{escape(check.name)}</b>", 1)
             for check in judged if check.good is False]
    lines += [escape(text) for text in warnings_of(run.summary, checks=False)]
    look = _look(run)
    if look == " open":
        lines.insert(0, "<b>The run is under way.</b> The page shows what it has written so far; made again, it shows more.")
    elif not run.ended:
        lines.insert(0, "<b>The run has been interrupted</b>, or is under way where this machine does not see it. "
                        "The page shows what it has written so far.")
    elif look:
        lines.insert(0, f"<b>The run did not reach its end:</b> {escape(run.summary.get('stop_reason', ''))}")
    if not lines:
        return ""
    return f'<div class="alerts{look}" role="note">' + "".join(f"<p>{line}</p>" for line in lines) + "</div>"


def _sections(pictures: Sequence[Picture]) -> Sections:
    """Pictures under their headings; a heading without pictures is left out."""
    by_name: Dict[str, Picture] = {picture.name: picture for picture in pictures}
    result = []
    for anchor, heading, names in SECTIONS:
        own = [by_name[name] for name in names if name in by_name]
        if anchor in PREFIXES:
            own += [picture for picture in pictures if picture.name.startswith(PREFIXES[anchor])]
        parts = [figure(picture, heading) for picture in own]
        if own:
            result.append((anchor, heading, "\n".join(parts)))
    return result


def _with_table(run: Run, section: Tuple[str, str, str]) -> Tuple[str, str, str]:
    """What is read from cooling curves, under their picture."""
    anchor, heading, content = section
    if anchor != "cooling":
        return section
    rows = [("", [escape(cell) for cell in row]) for row in cooling_table(run)]
    return anchor, heading, content + "\n" + table(("probe", "800 to 500 °C [s]", "rate at 700 °C [K/s]", "last [°C]"), rows)


def _checks(judged: Sequence[Check]) -> Sections:
    if not judged:
        return []
    marks = {True: '<span class="good">✓ holds</span>', False: '<span class="bad">! warning</span>', None: ""}
    rows = [("bad" if check.good is False else "",
             (escape(check.name), escape(check.found), escape(check.allowed), marks[check.good], escape(check.advice)))
            for check in judged]
    return [("checks", "Checks", table(("check", "found", "allowed", "", "what to do"), rows))]


def _effects(run: Run) -> Sections:
    if not run.summary["effects"]:
        return []
    rows = []
    for name, effect in run.summary["effects"].items():
        calls, seconds = number(effect.get("calls", 0)), number(effect.get("wall_s", 0))
        cost = f"{brief(seconds, 3)} s in {brief(calls, 9)} calls" if calls > 0 else ""
        rows.append(("" if effect.get("on") else "off", (f"<b>{escape(name)}</b>" if effect.get("on") else escape(name),
                     "on" if effect.get("on") else "off", escape(effect.get("why", "")), escape(effect.get("adds", "")), cost)))
    return [("effects", "Effects", table(("effect", "", "why", "adds", "cost"), rows))]


def _notes(run: Run) -> Sections:
    parts = []
    for kind, heading in (("warnings", "Warnings"), ("cutbacks", "Steps that were cut back")):
        lines = run.notes[kind]
        if not lines:
            continue
        text = "\n".join(escape(line) for line in lines[:LONGEST_LIST])
        more = ""
        if len(lines) > LONGEST_LIST:
            rest = "\n".join(escape(line) for line in lines[LONGEST_LIST:])
            more = f"<details><summary>{len(lines) - LONGEST_LIST} more</summary><pre>{rest}</pre></details>"
        parts.append(f"<h3>{heading}: {len(lines)}</h3>\n<pre>{text}</pre>{more}")
    if not parts:
        parts = ["<p>No warnings, no cutbacks.</p>"]
    return [("notes", "From the listing", "\n".join(parts))]


def _origin(run: Run) -> Sections:
    s = run.summary
    rows = []
    if run.ended:
        rows = [("", ("deck", f"<code>{escape(s['deck'])}</code>")),
                ("", ("SHA-256 of the deck", f"<code>{escape(s.get('deck_sha256', 'not given'))}</code>")),
                ("", ("program", escape(f"{s.get('program', 'lagamine')} {s.get('version', '')}")))]
    files = [f"<code>{escape(os.path.basename(generation.path))}</code> {len(generation.steps)} saved steps, "
             f"{len(generation.topology)} elements" for generation in run.generations]
    rows.append(("", ("fields", "<br>".join(files))))
    heading = "To make it again" if run.ended else "To go on with it"
    return [("origin", heading, f"<pre>{escape(command(run))}</pre>\n" + table(("", ""), rows))]
