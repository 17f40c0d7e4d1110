#!/usr/bin/env python3
"""Syntax colours of decks for vim and for editors with TextMate grammars (VS Code), from `lagamine --cards` and `lagamine --law`.

usage: syntax_colours.py --lagamine PROGRAM --out DIR
Writes DIR/vim/{syntax,ftdetect}/lagamine.vim and DIR/vscode, a folder that VS Code takes as an extension.
"""
import argparse
import json
import os
import sys

sys.dont_write_bytecode = True
from help_text import ask  # noqa: E402

NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eEdD][-+]?\d+)?"
WORD = r"(?<![\w-])"                 # what stands before a word of a deck
ENDINGS = ("lag", "point")

VIM = '''\
" Vim syntax: decks of LAGAMINE 2D. Made by syntax_colours.py from the list of cards.
if exists("b:current_syntax")
  finish
endif
syntax case match
syntax match lagWord /\\%(\\S\\)\\@<!\\u[A-Z0-9_]\\+\\ze\\%(\\s\\|$\\)/
syntax match lagUnknown /^[A-Za-z][A-Za-z0-9_-]*/
syntax match lagCard /^\\%({cards}\\)\\ze\\%(\\s\\|$\\)/
syntax match lagTitle /\\%(^TITLE\\)\\@<=\\s[^!]*/
syntax match lagNumber /\\%([A-Za-z_0-9$]\\)\\@<![-+]\\=\\%(\\d\\+\\.\\=\\d*\\|\\.\\d\\+\\)\\%([eEdD][-+]\\=\\d\\+\\)\\=\\ze\\%([^A-Za-z0-9_]\\|$\\)/
syntax match lagParameter /\\$[A-Za-z][A-Za-z0-9_-]*/
syntax match lagLaw /\\%(\\S\\)\\@<!\\%({laws}\\)\\ze\\%(\\s\\|$\\)/
syntax match lagComment /!.*/
highlight default link lagUnknown Error
highlight default link lagCard Statement
highlight default link lagTitle String
highlight default link lagNumber Number
highlight default link lagParameter Identifier
highlight default link lagLaw Type
highlight default link lagWord Keyword
highlight default link lagComment Comment
let b:current_syntax = "lagamine"
'''


def words(program: str, *arguments: str):
    """The first words of the lines that a program prints."""
    found = [line.split()[0] for line in ask(program, *arguments).splitlines() if line.strip()]
    if len(found) < 2:
        raise SystemExit(f"{program} {' '.join(arguments)}: expected a list, found '{' '.join(found)}'")
    return found


def vim(cards, laws) -> str:
    """The syntax file of vim. A later rule wins where two begin at one place."""
    return VIM.format(cards="\\|".join(sorted(cards)), laws="\\|".join(sorted(laws, key=len, reverse=True)))


def grammar(cards, laws) -> dict:
    """The TextMate grammar."""
    def rule(name, match):
        return {"name": f"{name}.lagamine", "match": match}
    return {
        "name": "LAGAMINE deck", "scopeName": "source.lagamine", "fileTypes": list(ENDINGS),
        "patterns": [
            {"match": r"^(TITLE)(\s[^!]*)?", "captures": {"1": {"name": "keyword.control.lagamine"}, "2": {"name": "string.unquoted.lagamine"}}},
            rule("comment.line", "!.*$"),
            rule("keyword.control", rf"^(?:{'|'.join(sorted(cards))})(?=\s|$)"),
            rule("invalid.illegal", r"^[A-Za-z][\w-]*"),
            rule("support.class", rf"(?<!\S)(?:{'|'.join(sorted(laws, key=len, reverse=True))})(?=\s|$)"),
            rule("variable.parameter", r"\$[A-Za-z][\w-]*"),
            rule("constant.language", r"(?<!\S)[A-Z][A-Z0-9_]+(?=\s|$)"),
            rule("constant.numeric", rf"{WORD}{NUMBER}(?![\w])"),
        ],
    }


def extension(version: str) -> dict:
    """package.json of the folder for VS Code."""
    return {"name": "lagamine", "displayName": "LAGAMINE decks", "publisher": "lagamine", "version": version, "engines": {"vscode": "^1.40.0"},
            "contributes": {
                "languages": [{"id": "lagamine", "extensions": ["." + ending for ending in ENDINGS], "configuration": "./language.json"}],
                "grammars": [{"language": "lagamine", "scopeName": "source.lagamine", "path": "./lagamine.tmLanguage.json"}]}}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--lagamine", required=True)
    parser.add_argument("--out", required=True)
    options = parser.parse_args()
    cards, laws = words(options.lagamine, "--cards"), words(options.lagamine, "--law")
    version = ask(options.lagamine, "--version").split()[1]
    patterns = ",".join("*." + ending for ending in ENDINGS)
    files = {"vim/syntax/lagamine.vim": vim(cards, laws),
             "vim/ftdetect/lagamine.vim": f"autocmd BufRead,BufNewFile {patterns} setfiletype lagamine\n",
             "vscode/lagamine.tmLanguage.json": json.dumps(grammar(cards, laws), indent=1) + "\n",
             "vscode/language.json": json.dumps({"comments": {"lineComment": "!"}}) + "\n",
             "vscode/package.json": json.dumps(extension(version), indent=1) + "\n"}
    for name, text in files.items():
        path = os.path.join(options.out, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
