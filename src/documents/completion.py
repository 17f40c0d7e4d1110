#!/usr/bin/env python3
"""Completion for bash, from what the programs print as --help: a file a program, as bash-completion loads them.

usage: completion.py --out DIR PROGRAM...
"""
import argparse
import os
import re
import sys

sys.dont_write_bytecode = True
from help_text import Help, read_help  # noqa: E402

# Endings of the files that a program reads (folders are offered too).
READS = {"lagamine": "lag|point|met", "lagacycle": "lag", "remdata": "h5", "lagareport": "lag",
         "lagaimport": "msh|inp|med|dxf|csv|txt", "lagastudy": "lag"}
FOLDERS = ("DIR",)
FILES = ("FILE", "NEW", "CHECKPOINT", "DIR/NAME")

SCRIPT = """\
# Completion of {program} for bash, made from its --help.
_{program}()
{{
    local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}}
    COMPREPLY=()
    case $before in
{values}    esac
    if [[ $word == -* ]]; then
        mapfile -t COMPREPLY < <(compgen -W '{options}' -- "$word")
        return
    fi
    compopt -o filenames 2>/dev/null
    mapfile -t COMPREPLY < <(compgen -d -- "$word"{files})
}}
complete -F _{program} {program}
"""
LAWS = """\
        --law)
            mapfile -t COMPREPLY < <(compgen -W "$({program} --law 2>/dev/null | awk '{{print $1}}')" -- "$word")
            return ;;
"""


def case(names, command: str) -> str:
    """What completes the word after these options."""
    action = f"mapfile -t COMPREPLY < <(compgen {command} -- \"$word\")" if command else ":"
    first = "            compopt -o filenames 2>/dev/null\n" if command else ""
    return f"        {'|'.join(names)})\n{first}            {action}\n            return ;;\n"


def script(text: Help) -> str:
    """The file of a program."""
    values = ""
    for option in text.options:
        if option.names == ["--law"] and text.program == "lagamine":
            values += LAWS.format(program=text.program)
        elif option.value:
            choices = re.fullmatch(r"\{(.*)\}", option.value)
            kind = option.value.split()[0]
            command = f"-W '{choices.group(1).replace(',', ' ')}'" if choices else "-d" if kind in FOLDERS else "-f" if kind in FILES else ""
            values += case(option.names, command)
    names = {name for option in text.options for name in option.names}
    names |= set(re.findall(r"--[a-z]+", " ".join(text.synopsis)))
    files = "".join(f"; compgen -f -X '!*.{ending}' -- \"$word\"" for ending in READS[text.program].split("|"))
    return SCRIPT.format(program=text.program, values=values, options=" ".join(sorted(names)), files=files)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", required=True)
    parser.add_argument("programs", nargs="+")
    options = parser.parse_args()
    os.makedirs(options.out, exist_ok=True)
    for program in options.programs:
        with open(os.path.join(options.out, os.path.basename(program)), "w", encoding="utf-8") as file:
            file.write(script(read_help(program)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
