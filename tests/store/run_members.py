#!/usr/bin/env python3
"""Every component of the types that a checkpoint holds is named by the routine that visits them: kept, or `derived` with a reason.

usage: run_members.py [-v]

A routine that visits a type has the arguments `class(visitor_t) :: visitor` and `type(NAME_t) :: self`. Components are read from the
source; so is what the routines name. Then each visit is taken away in turn, and must be missed.
"""
import glob
import os
import re
import sys

SOURCE = os.environ.get("LAGAMINE_SOURCE", os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))))
# What a checkpoint is made of; the types within them are found.
ROOTS = ("scene_t", "solution_t", "contact_end_t", "deck_source_t")

TYPE = re.compile(r"^\s*type\s*(?:,[^:]*)?(?:::)?\s*(\w+)\s*$", re.I)
EXTENDS = re.compile(r"extends\(\s*(\w+)\s*\)", re.I)
DECLARATION = re.compile(r"^\s*(?P<what>[a-z]\w*\s*(?:\((?:[^()]|\([^()]*\))*\))?[^:]*)::\s*(?P<names>.*)$", re.I)
ROUTINE = re.compile(r"^\s*(?:pure\s+)?subroutine\s+(\w+)", re.I)
SELF = re.compile(r"^\s*type\((\w+)\)\s*,\s*intent\(inout\)\s*::\s*self\b", re.I | re.M)
VISITOR = re.compile(r"^\s*class\(visitor_t\)\s*,\s*intent\(inout\)\s*::\s*visitor\b", re.I | re.M)
VISIT = re.compile(r"call\s+(?:visitor%(?:member|fixed|long_text)\(\s*'[\w]+'\s*,|(?P<routine>visit_\w+)\(\s*visitor\s*,)\s*self%(?P<name>\w+)",
                   re.I)
DERIVED = re.compile(r"call\s+visitor%derived\(\s*'(?P<name>\w+)'\s*,\s*(?P<reason>'[^']+'|\w+)\s*\)", re.I)


def statements(path):
    """Statements of a file without comments, continued lines joined."""
    with open(path, encoding="utf-8") as file:
        found, begun = [], ""
        for line in file:
            line = re.sub(r"!.*", "", re.sub(r"'[^']*'", lambda text: text.group().replace("!", "."), line)).rstrip()
            line = begun + line.strip() if begun else line
            begun = line[:-1].rstrip() + " " if line.endswith("&") else ""
            if not begun and line.strip():
                found.append(line)
        return found


def names_declared(text):
    """Names in `a(:, :), b = f(1, 2)`."""
    depth, part, parts = 0, "", []
    for letter in text + ",":
        depth += {"(": 1, "[": 1, ")": -1, "]": -1}.get(letter, 0)
        if letter == "," and depth == 0:
            parts.append(part)
            part = ""
        else:
            part += letter
    return [re.match(r"\s*(\w+)", part).group(1).lower() for part in parts]


def read_source(files):
    """Types: name -> {component: type of it or ''}. Routines that visit: (name, type, statements)."""
    types, routines, parents = {}, [], {}
    for lines in files.values():
        here, body = None, None
        for line in lines:
            if here is not None:
                if re.match(r"\s*end\s*type\b", line, re.I):
                    here = None
                elif re.match(r"\s*contains\b", line, re.I):
                    here = {}
                else:
                    found = DECLARATION.match(line)
                    if found and not re.match(r"\s*(procedure|generic|final)\b", line, re.I):
                        of_type = re.match(r"\s*type\((\w+)\)", found["what"], re.I)
                        for name in names_declared(found["names"]):
                            here[name] = of_type.group(1).lower() if of_type else ""
                continue
            found = TYPE.match(line)
            if found:
                here = types.setdefault(found.group(1).lower(), {})
                above = EXTENDS.search(line)
                if above:
                    parents[found.group(1).lower()] = above.group(1).lower()
            elif ROUTINE.match(line):
                body = [line]
            elif body is not None:
                body.append(line)
                if re.match(r"\s*end\s*subroutine\b", line, re.I):
                    text = "\n".join(body)
                    of_type = SELF.search(text)
                    if of_type and VISITOR.search(text):
                        routines.append((ROUTINE.match(body[0]).group(1).lower(), of_type.group(1).lower(), body))
                    body = None
    for name, parent in parents.items():
        types[name].update(types[parent])
    return types, routines


def complaints(types, routines):
    """What is not visited, twice visited, or not there."""
    found = []
    visited, derived, types_of = {}, {}, {}
    for routine, of_type, body in routines:
        types_of[routine] = of_type
        for line in body:
            for match in VISIT.finditer(line):
                visited.setdefault(of_type, {}).setdefault(match["name"].lower(), []).append((match["routine"] or "").lower())
            for match in DERIVED.finditer(line):
                derived.setdefault(of_type, set()).add(match["name"].lower())
    asked = list(ROOTS)
    for of_type in asked:
        here, away = visited.get(of_type, {}), derived.get(of_type, set())
        if of_type not in types:
            found.append(f"{of_type}: no such type")
            continue
        for name, inner in types[of_type].items():
            if name in here:
                if inner and inner not in asked:
                    asked.append(inner)
                for routine in here[name]:
                    # a routine that goes on with the same type visits it under another name
                    if routine and types_of.get(routine, inner) not in (inner, of_type):
                        found.append(f"{of_type}%{name}: {routine} visits {types_of[routine]}")
            elif name not in away:
                found.append(f"{of_type}%{name}: neither visited nor derived")
            if name in here and name in away:
                found.append(f"{of_type}%{name}: visited, and derived too")
        found += [f"{of_type}%{name}: visited, but no component" for name in (set(here) | away) - set(types[of_type])]
    return found, asked


def main():
    verbose = "-v" in sys.argv
    paths = glob.glob(os.path.join(SOURCE, "src", "**", "*.f90"), recursive=True)
    files = {path: statements(path) for path in paths}
    types, routines = read_source(files)
    found, asked = complaints(types, routines)
    for line in found:
        print("FAILED", line)
    failed, trials = len(found), 0
    # each visit is missed when it is gone
    for k, (routine, of_type, body) in enumerate(routines):
        for n, line in enumerate(body):
            match = VISIT.search(line) or DERIVED.search(line)
            if match is None or of_type not in asked:
                continue
            others = [text for i, text in enumerate(body) if i != n]
            again, _ = complaints(types, routines[:k] + [(routine, of_type, others)] + routines[k + 1:])
            trials += 1
            if not any(f"{of_type}%{match['name'].lower()}: neither" in text for text in again):
                failed += 1
                print(f"FAILED {of_type}%{match['name']}: not missed without its visit in {routine}")
    if verbose:
        print(f"types: {', '.join(sorted(asked))}")
    print(f"{sum(len(types.get(name, {})) for name in asked)} components of {len(asked)} types, {trials} visits, {failed} failed")
    sys.exit(1 if failed or not trials else 0)


if __name__ == "__main__":
    main()
