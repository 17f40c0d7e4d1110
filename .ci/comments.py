#!/usr/bin/env python3
"""Count the array arguments of public procedures whose shape and unit stand beside them.

usage: comments.py [--list] [ROOT] | --selftest
Looks at src/ and remdata/ below ROOT (default: the project). A table by folder; ends with 1 where a share is below its floor.
--list names every array argument that lacks something: file, line, procedure, argument, what is missing.

Public are procedures in a module's `public` list, those behind a generic name in it, bodies of interfaces in it, and bound
procedures of types in it. Beside an argument stands a comment on a line of its declaration, `!>` lines above or `!!` lines below.
- Shape: in the declaration itself (`stress(4)`), or in the comment in brackets with one entry a dimension: `(2, n)`.
- Unit: reals and complex numbers only; in square brackets: `[length]`, `[stress/length]`, `[-]`.
"""
import collections
import os
import re
import sys
import tempfile

# Least share of array arguments with shape and unit, per cent. To be raised with what is written; the aim is 90.
FLOORS = {"src": 95, "remdata": 100}

Statement = collections.namedtuple("Statement", "line text comment")
Argument = collections.namedtuple("Argument", "file line procedure name missing")

DECLARATION = re.compile(r"(integer|real|complex|logical|character|type\s*\(|class\s*\()", re.I)
PROCEDURE = re.compile(r"(?:[\w()*=,]+\s+)*?(?:subroutine|function)\s+(\w+)\s*(?:\(([^)]*)\))?", re.I)
MODULE = re.compile(r"module\s+(?!procedure\b|subroutine\b|function\b)(\w+)$", re.I)
BOUND = re.compile(r"(?:procedure|generic)\b([^:]*)::\s*(.*)$", re.I)
NAME = r"[A-Za-z]\w*(?:%\w+)*"
TERM = rf"(?:\d+|{NAME}(?:\([\w%:, ]*\))?)"
SUM = rf"{TERM}(?:\s*[*+/-]\s*{TERM})*"
ENTRY = re.compile(rf"(?::|{SUM}|(?:{SUM})?\s*(?::|\.\.\.|or|to)\s*(?:{SUM})?)")
UNIT = re.compile(r"\[(?:-|[A-Za-z1%][^\[\],]*)\]")


def split_comment(line):
    """The code of a line and its comment, which begins at the first `!` outside of texts."""
    quote = ""
    for k, letter in enumerate(line):
        if quote:
            quote = "" if letter == quote else quote
        elif letter in "'\"":
            quote = letter
        elif letter == "!":
            return line[:k].strip(), line[k:].strip()
    return line.strip(), ""


def split_list(text):
    """What commas outside of brackets separate."""
    parts, depth = [""], 0
    for letter in text:
        depth += (letter in "([") - (letter in ")]")
        if letter == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += letter
    return [part.strip() for part in parts if part.strip()]


def statements(lines):
    """Whole statements with the comments beside them."""
    found, above, code, comment, start = [], "", "", "", 0
    for number, line in enumerate(lines, 1):
        text, remark = split_comment(line)
        if not text:
            if code:
                comment += " " + remark
            elif remark.startswith("!!") and found and not above:
                found[-1] = found[-1]._replace(comment=found[-1].comment + " " + remark)
            else:
                above = above + " " + remark if remark.startswith(("!>", "!!")) else ""
            continue
        start = start or number
        comment += " " + remark
        code += " " + text.strip("&").strip()
        if not text.endswith("&"):
            found.append(Statement(start, code.strip(), (above + comment).strip()))
            above, code, comment, start = "", "", "", 0
    return found


def has_shape(comment, rank):
    """Some round brackets hold one entry a dimension."""
    for start in (k for k, letter in enumerate(comment) if letter == "("):
        depth = 0
        for k in range(start, len(comment)):
            depth += (comment[k] == "(") - (comment[k] == ")")
            if depth == 0:
                entries = split_list(comment[start + 1:k])
                if len(entries) == rank and all(ENTRY.fullmatch(entry) for entry in entries):
                    return True
                break
    return False


def entities(text):
    """Names and shapes (None: a scalar) that a declaration declares."""
    left, right = text.split("::", 1)
    common = None
    for attribute in split_list(left):
        if attribute.lower().startswith("dimension"):
            common = attribute[attribute.index("(") + 1:attribute.rindex(")")]
    for entity in split_list(right):
        own = re.match(r"(\w+)\s*(?:\((.*)\))?", entity)
        yield own.group(1).lower(), own.group(2) if own.group(2) is not None else common


def judge(statement, shape):
    """What is missing beside an array; empty where nothing is."""
    dimensions = split_list(shape)
    missing = []
    if any(":" in dimension or dimension == "*" for dimension in dimensions) and not has_shape(statement.comment, len(dimensions)):
        missing.append("shape")
    if re.match(r"real|complex", statement.text, re.I) and not UNIT.search(statement.comment):
        missing.append("unit")
    return " and ".join(missing)


class Module:
    """What a module makes public, and the array arguments of every procedure it declares."""

    def __init__(self, file, lines):
        self.file = file
        self.public = set()
        self.aliases = collections.defaultdict(set)     # generic names and types -> procedures
        self.arguments = collections.defaultdict(list)
        self.is_module = False
        self.read(statements(lines))

    def read(self, found):
        open_procedures, in_interface, generic, in_type, bound = [], False, "", "", False
        for statement in found:
            text, low = statement.text, statement.text.lower()
            if not open_procedures and MODULE.match(text):
                self.is_module = True
            elif re.match(r"public\s*(::|\s\w)", low):
                self.public |= set(split_list(re.sub(r"^public\s*(::)?", "", low)))
            elif re.match(r"(abstract\s+)?interface\b", low) and not in_interface:
                in_interface, generic = True, re.sub(r"^(abstract\s+)?interface\s*", "", low)
            elif re.match(r"end\s*interface\b", low):
                in_interface, generic = False, ""
            elif re.match(r"type\b(?!\s*\()(?!\s+is\b)", low):
                in_type, bound = re.split(r"::|\s", low)[-1].strip(), False
            elif re.match(r"end\s*type\b", low):
                in_type = ""
            elif in_type:
                bound = bound or low == "contains"
                self.read_bound(in_type, low, bound)
            elif re.match(r"end\s*(subroutine|function|procedure)\b", low) or low == "end" and open_procedures:
                open_procedures.pop()
            elif re.match(r"module\s+procedure\b", low):
                if in_interface:
                    self.aliases[generic] |= set(split_list(re.sub(r"^module\s+procedure\s*(::)?", "", low)))
                else:
                    open_procedures.append(None)
            elif "::" not in text and PROCEDURE.match(text):
                start = PROCEDURE.match(low)
                nested = bool(open_procedures)
                open_procedures.append(None if nested else (start.group(1), set(split_list(start.group(2) or ""))))
                if in_interface and generic and not nested:
                    self.aliases[generic].add(start.group(1))
            elif open_procedures and open_procedures[-1] and "::" in text and DECLARATION.match(text):
                procedure, dummies = open_procedures[-1]
                for name, shape in entities(text):
                    if shape is not None and name in dummies:
                        missing = judge(statement, shape)
                        self.arguments[procedure].append(Argument(self.file, statement.line, procedure, name, missing))

    def read_bound(self, name, low, bound):
        """A line of a type: its bound procedures belong to it."""
        line = BOUND.match(low)
        if bound and line and "private" not in line.group(1):
            for part in split_list(line.group(2)):
                self.aliases[name].add(part.split("=>")[-1].strip())

    def public_arguments(self):
        """Array arguments of what can be called from outside."""
        names, seen = set(self.public), set()
        while names - seen:
            name = (names - seen).pop()
            seen.add(name)
            names |= self.aliases.get(name, set())
        return [argument for name in sorted(seen) for argument in self.arguments.get(name, [])] if self.is_module else []


def collect(root):
    """All array arguments of public procedures below src and remdata, by file."""
    found = []
    for top in FLOORS:
        for folder, folders, files in os.walk(os.path.join(root, top)):
            folders.sort()
            for file in sorted(files):
                if file.endswith(".f90"):
                    path = os.path.join(folder, file)
                    with open(path, encoding="utf-8") as source:
                        lines = source.read().splitlines()
                    found += Module(os.path.relpath(path, root).replace(os.sep, "/"), lines).public_arguments()
    return found


def report(found):
    """The table by folder and tree; the trees below their floors."""
    counts = collections.Counter()
    for argument in found:
        top, folder = argument.file.split("/")[0], os.path.dirname(argument.file)
        for place in {top, folder}:
            counts[place, "all"] += 1
            counts[place, "good"] += not argument.missing
    below = []
    print(f"{'folder':<24} {'arrays':>6} {'with shape and unit':>20}")
    for place in sorted({place for place, _ in counts}):
        share = 100*counts[place, "good"]/counts[place, "all"]
        print(f"{place:<24} {counts[place, 'all']:6d} {counts[place, 'good']:6d} {share:11.1f} %")
        if share < FLOORS.get(place, 0):
            below.append(f"{place}: {share:.1f} % of the array arguments of public procedures have shape and unit beside them; "
                         f"at least {FLOORS[place]} % must (--list names the others)")
    return below


# Text of a module's specification and body, and the arguments wanted: name and what is missing.
HEAD = "module m\n  implicit none\n  private\n  public :: a{}\n{}contains\n"
BODY = "  subroutine a(x)\n    {}\n  end subroutine a\nend module m\n"


def case(declaration, more="", specification=""):
    return HEAD.format(more, specification) + BODY.format(declaration)


SELFTEST = [
    ("nothing", case("real(wp), intent(in) :: x(:)"), ["x: shape and unit"]),
    ("both", case("real(wp), intent(in) :: x(:, :)   !! (2, n) coordinates [length]"), []),
    ("rank", case("real(wp), intent(in) :: x(:, :)   !! (n) coordinates [length]"), ["x: shape"]),
    ("no unit", case("real(wp), intent(in) :: x(:)   !! (n)"), ["x: unit"]),
    ("no dimension", case("real(wp), intent(in) :: x(:)   !! (n) [-]"), []),
    ("an interval is no unit", case("real(wp), intent(in) :: x(:)   !! (n) in [-1, 1]"), ["x: unit"]),
    ("words are no shape", case("real(wp), intent(in) :: x(:)   !! lengths (those of sides) [length]"), ["x: shape"]),
    ("explicit shape", case("real(wp), intent(in) :: x(4)   ! [stress]"), []),
    ("dimension", case("real(wp), dimension(:, :), intent(in) :: x  !! (2*n + 1, size(k)) [stress]"), []),
    ("integer", case("integer, intent(in) :: x(:)   !! (n) elements"), []),
    ("integer without", case("integer, intent(in) :: x(:)   !! elements"), ["x: shape"]),
    ("type", case("type(side_t), intent(in) :: x(:)"), ["x: shape"]),
    ("scalar", case("real(wp), intent(in) :: x"), []),
    ("local", case("real(wp) :: y(:)"), []),
    ("continued", case("real(wp), intent(in), &   !! (n)\n      contiguous :: x(:)   !! [length]"), []),
    ("above", case("!> (n) [length]\n    real(wp), intent(in) :: x(:)"), []),
    ("below", case("real(wp), intent(in) :: x(:)\n    !! (n) [length]"), []),
    ("a comment on something else", case("integer :: k   !! (n) [length]\n\n    real(wp), intent(in) :: x(:)"), ["x: shape and unit"]),
    ("a comment above the procedure", HEAD.format("", "") + "  !> (n) [length]\n" + BODY.format("real :: x(:)"),
     ["x: shape and unit"]),
    ("private", case("real :: x(:)   !! (n) [-]") .replace("end module", "subroutine b(y)\nreal :: y(:)\nend subroutine\nend module"),
     []),
    ("internal", case("real :: x(:)   !! (n) [-]\n  contains\n    subroutine a(x)\n    real :: x(:)\n    end subroutine"), []),
    ("generic", case("real :: x(:)   !! (n) [-]", ", c", "interface c\n module procedure b\nend interface\n")
     .replace("end module", "subroutine b(y)\nreal :: y(:)\nend subroutine\nend module"), ["y: shape and unit"]),
    ("interface", case("real :: x(:)   !! (n) [-]", ", f_i",
                       "abstract interface\n pure function f_i(y) result(z)\n  real, intent(in) :: y(:)\n  real :: z(:)\n"
                       " end function f_i\nend interface\n"), ["y: shape and unit"]),
    ("bound", case("real :: x(:)   !! (n) [-]", ", t_t",
                   "type :: t_t\n integer :: k(3)\ncontains\n procedure :: go => b\n procedure, private :: c\nend type t_t\n")
     .replace("end module", "subroutine b(t, y)\nclass(t_t) :: t\nreal :: y(:)\nend subroutine\n"
                            "subroutine c(t, z)\nclass(t_t) :: t\nreal :: z(:)\nend subroutine\nend module"),
     ["y: shape and unit"]),
    ("a text with a mark", case("character(len=*), intent(in) :: x(:)   !! (n)").replace("private\n", "private\n  !\n"), []),
    ("a submodule", case("real :: x(:)").replace("module m\n  implicit", "submodule(k) m\n  implicit"), []),
]


def selftest():
    """Every case is a tree of one file."""
    failed = 0
    for name, text, wanted in SELFTEST:
        with tempfile.TemporaryDirectory() as root:
            os.makedirs(os.path.join(root, "src", "base"))
            with open(os.path.join(root, "src", "base", "m.f90"), "w", encoding="utf-8") as file:
                file.write(text)
            found = [f"{argument.name}: {argument.missing}" for argument in collect(root) if argument.missing]
        if found != wanted:
            failed += 1
            print(f"FAILED: {name}: wanted {wanted}, got {found}")
    print(f"{len(SELFTEST) - failed} passed, {failed} failed")
    return 1 if failed else 0


def main(arguments):
    if arguments == ["--selftest"]:
        return selftest()
    listing = "--list" in arguments
    places = [argument for argument in arguments if argument != "--list"]
    if len(places) > 1 or places and places[0].startswith("-"):
        print(__doc__, file=sys.stderr)
        return 2
    found = collect(places[0] if places else os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
    if listing:
        for argument in found:
            if argument.missing:
                print(f"{argument.file}:{argument.line}: {argument.procedure}: {argument.name}: no {argument.missing}")
    below = report(found)
    for line in below or ([] if found else ["comments: no public procedure was found"]):
        print(line)
    return 1 if below or not found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
