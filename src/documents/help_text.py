"""What `PROGRAM --help` prints, as data: the one source of manual pages and of completion.

Two layouts are read: that of lagamine, lagacycle and remdata (`name: purpose`, synopsis, options, exit codes) and that of argparse.
"""
import os
import re
import subprocess
from dataclasses import dataclass, field
from typing import List, Tuple

CODES = "Exit codes:"


@dataclass
class Option:
    """`names` as on the command line, `value` the placeholder of what follows them (empty: nothing), what it does."""

    names: List[str]
    value: str
    text: str


@dataclass
class Help:
    """A program's help: `synopsis`, a call a line; `sections`, (title, options) with a title that may be empty;
    `notes`, paragraphs; `codes`, exit codes and their meanings."""

    program: str
    purpose: str
    synopsis: List[str]
    sections: List[Tuple[str, List[Option]]] = field(default_factory=list)
    notes: List[str] = field(default_factory=list)
    codes: List[Tuple[str, str]] = field(default_factory=list)

    @property
    def options(self) -> List[Option]:
        """Options of all sections; what is given by its place is left out."""
        return [option for _, options in self.sections for option in options if option.names[0].startswith("-")]


def ask(program: str, *arguments: str) -> str:
    """What a program prints; a failure ends with its words."""
    done = subprocess.run([program, *arguments], stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False,
                          env=dict(os.environ, COLUMNS="10000", LC_ALL="C.UTF-8"))
    if done.returncode != 0:
        raise SystemExit(f"{program} {' '.join(arguments)}: ended with {done.returncode}: {done.stderr.strip()}")
    return done.stdout


def read_help(path: str) -> Help:
    """The help of a program."""
    name, text = os.path.basename(path), ask(path, "--help").rstrip()
    text, _, codes = text.partition(CODES)
    paragraphs = [part.split("\n") for part in re.split(r"\n\s*\n", text.strip("\n")) if part.strip()]
    if paragraphs[0][0].startswith("usage: "):
        synopsis, purpose = [" ".join(" ".join(paragraphs[0])[len("usage: "):].split())], " ".join(paragraphs[1]).strip()
        rest = paragraphs[2:]
    else:
        purpose = paragraphs[0][0].partition(": ")[2]
        synopsis, rest = _joined(paragraphs[1]), paragraphs[2:]
    found = Help(name, purpose.rstrip("."), synopsis)
    for lines in rest:
        title = lines.pop(0).rstrip(":") if re.match(r"\S.*:$", lines[0]) else ""
        if not lines[0].startswith(" "):
            found.notes.append(" ".join(" ".join(lines).split()))
            continue
        found.sections.append((title, _options(lines)))
    words = " ".join(codes.split()).rstrip(".")
    found.codes = [(one.split(" ", 1)[0], one.split(" ", 1)[1]) for one in re.split(r", (?=\d)", words)] if words else []
    if not found.synopsis or not found.options:
        raise SystemExit(f"{name} --help: no synopsis or no options found")
    return found


def _joined(lines: List[str]) -> List[str]:
    """Lines that begin with a blank go on with the one before."""
    calls: List[str] = []
    for line in lines:
        if line.startswith(" ") and calls:
            calls[-1] += " " + line.strip()
        else:
            calls.append(line.strip())
    return calls


def _options(lines: List[str]) -> List[Option]:
    """Rows of two columns; rows that begin in the second column go on with the one before."""
    options: List[Option] = []
    left = min(len(line) - len(line.lstrip()) for line in lines)
    for line in lines:
        if len(line) - len(line.lstrip()) > left + 2:
            options[-1].text = f"{options[-1].text} {line.strip()}".strip()
            continue
        head, _, text = re.sub(r"\s{2,}", "\0", line.strip(), count=1).partition("\0")
        spelt = [part.strip().split(" ", 1) for part in head.split(", ")]
        options.append(Option([part[0] for part in spelt], spelt[-1][1] if len(spelt[-1]) > 1 else "", text.strip()))
    return options
