#!/usr/bin/env python3
"""Manual pages (man 1) of the programs, from what they print as --help.

usage: manual_pages.py --readme README.md --out DIR PROGRAM...
The files that a run leaves are those of the table in the README. The date is that of SOURCE_DATE_EPOCH, so that a build may be repeated.
"""
import argparse
import datetime
import os
import re
import sys
import time

sys.dont_write_bytecode = True
from help_text import Help, ask, read_help  # noqa: E402

SOLVERS = ("lagamine", "lagacycle")


def escaped(text: str) -> str:
    """Text as roff has it."""
    text = text.replace("\\", "\\e").replace("-", "\\-").replace("`", "")
    return "\\&" + text if text[:1] in (".", "'") else text


def marked(text: str) -> str:
    """A call: capital words are what the user puts there, the others are typed."""
    words = re.split(r"([A-Z][A-Z0-9]*(?:=[A-Z]+)?)", text)
    return "".join(f"\\fI{escaped(word)}\\fR" if k % 2 else escaped(word) for k, word in enumerate(words))


def run_files(readme: str):
    """Rows (file, what it holds) of the table of files in the README."""
    with open(readme, encoding="utf-8") as file:
        part = file.read().partition("| file | holds |\n")[2].partition("\n\n")[0]
    rows = [line.strip("|").split("|") for line in part.splitlines()[1:]]
    if not rows:
        raise SystemExit(f"{readme}: no table of files")
    return [(name.strip(), re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", text.strip())) for name, text in rows]


def page(text: Help, version: str, readme: str, others) -> str:
    """The page of a program."""
    date = datetime.date.fromtimestamp(int(os.environ.get("SOURCE_DATE_EPOCH", time.time())))
    lines = [f'.TH {text.program.upper()} 1 "{date}" "lagamine {version}" "LAGAMINE 2D"', ".SH NAME",
             f"{escaped(text.program)} \\- {escaped(text.purpose)}", ".SH SYNOPSIS"]
    for call in text.synopsis:
        name, _, rest = call.partition(" ")
        lines += [f".B {escaped(name)}", marked(rest), ".br"]
    for title, options in text.sections:
        lines.append(f".SH {escaped(title).upper() or 'OPTIONS'}")
        for option in options:
            lines += [".TP", ", ".join(f"\\fB{escaped(name)}\\fR" for name in option.names)
                      + (f" \\fI{escaped(option.value)}\\fR" if option.value else ""), escaped(option.text)]
    if text.notes:
        lines += [".SH NOTES", *(line for note in text.notes for line in (".PP", escaped(note)))]
    if text.codes:
        lines.append(".SH EXIT STATUS")
        for code, meaning in text.codes:
            lines += [".TP", f"\\fB{escaped(code)}\\fR", escaped(meaning)]
    if text.program in SOLVERS:
        lines.append(".SH FILES")
        for name, holds in run_files(readme):
            lines += [".TP", f"\\fI{escaped(name)}\\fR", escaped(holds)]
    lines += [".SH SEE ALSO", ", ".join(f"\\fB{escaped(name)}\\fR(1)" for name in others if name != text.program),
              ".PP", "The manual of decks and the shipped decks are beside the documents of the package, in", ".I decks/README.md."]
    return "\n".join(lines) + "\n"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--readme", required=True)
    parser.add_argument("--out", required=True)
    parser.add_argument("programs", nargs="+")
    options = parser.parse_args()
    os.makedirs(options.out, exist_ok=True)
    names = [os.path.basename(program) for program in options.programs]
    for program in options.programs:
        version = ask(program, "--version").split()[1]
        with open(os.path.join(options.out, os.path.basename(program) + ".1"), "w", encoding="utf-8") as file:
            file.write(page(read_help(program), version, options.readme, names))
    # a program that only another one calls
    with open(os.path.join(options.out, "remdata_gmsh.1"), "w", encoding="utf-8") as file:
        file.write(".so man1/remdata.1\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
