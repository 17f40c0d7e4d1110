#!/usr/bin/env python3
"""Turn a pFUnit test file (.pf) into Fortran that runs with the small `funit` of this folder.

usage: pf_translate.py FILE.pf OUT.F90 [--label NAME]     one test module; NAME is how failures call the file
       pf_translate.py --driver OUT.F90 MODULE...         the main program that runs the suites of these modules

Directives: @test, @test(ifdef=NAME), @test(ifndef=NAME), @disable, @before, @after and the asserts in `ASSERTS`.
Whatever pFUnit would misread is refused here, with file and line, so that a file which runs here runs there.
"""
import os
import re
import sys

# Assert as spelled in Fortran, and how many operands it must have.
ASSERTS = {
    "assertEqual": 2, "assertNotEqual": 2, "assertRelativelyEqual": 2,
    "assertLessThan": 2, "assertLessThanOrEqual": 2, "assertGreaterThan": 2, "assertGreaterThanOrEqual": 2,
    "assertTrue": 1, "assertFalse": 1, "assertIsNaN": 1, "assertIsFinite": 1, "assertFail": 1,
}
BY_LOWER = {name.lower(): name for name in ASSERTS}

LINE_LENGTH = 132       # free form Fortran; the call pFUnit writes must fit
NAME_LENGTH = 43        # longer test names do not survive pFUnit

MODULE = re.compile(r"\s*module\s+(\w+)\s*$", re.I)
PROCEDURE = re.compile(r"\s*subroutine\s+(\w+)\s*(?:\(\s*\))?\s*(?:!.*)?$", re.I)
DIRECTIVE = re.compile(r"\s*@(\w+)\s*(.*?)\s*$")
CONDITION = re.compile(r"\(\s*(ifdef|ifndef)\s*=\s*(\w+)\s*\)$", re.I)


class Refused(Exception):
    """A line that cannot be translated."""

    def __init__(self, line, text):
        super().__init__(text)
        self.line = line


def code_only(line):
    """The line with its text literals and its comment blanked out, same length."""
    out, quote = [], ""
    for i, c in enumerate(line):
        if quote:
            out.append(" ")
            quote = "" if c == quote else quote
        elif c in "'\"":
            out.append(" ")
            quote = c
        elif c == "!":
            out.append(" " * (len(line) - i))
            break
        else:
            out.append(c)
    return "".join(out)


def operands(text):
    """How many arguments stand in `text`, or None where its brackets do not close before its end."""
    code, depth, count = code_only(text), 0, 1
    for c in code:
        depth += (c in "([") - (c in ")]")
        if depth < 0:
            return None
        count += c == "," and depth == 0
    if depth:
        return None
    return count if text.strip() else 0


class Translator:
    """Reads the lines of one file and gathers what its suite needs."""

    def __init__(self, path, label):
        self.path, self.label = path, label
        self.module = None
        self.tests = []                     # (name, disabled, condition)
        self.fixture = {"before": None, "after": None}
        self.waiting = None                 # (directive, line, disabled, condition) that wants a subroutine next
        self.out = []

    def run(self, lines):
        # The compiler, too, shall name the test file.
        self.out.append(f'#line 1 "{self.path}"')
        for number, line in enumerate(lines, 1):
            line = line.rstrip("\r\n")
            if not line.strip() or line.lstrip().startswith("!"):
                self.out.append(line)
            elif line.lstrip().startswith("@"):
                self.directive(number, line)
            else:
                self.plain(number, line)
        if self.waiting:
            raise Refused(self.waiting[1], f"@{self.waiting[0]} has no subroutine after it")
        if not self.module:
            raise Refused(1, "no `module NAME` line, which must carry nothing else")
        self.suite()
        return "\n".join(self.out) + "\n"

    def plain(self, number, line):
        if "@" in code_only(line):
            raise Refused(number, "a directive must stand alone on its line")
        start = MODULE.match(line)
        if start and not self.module:
            self.module = start.group(1)
            stem = os.path.splitext(os.path.basename(self.path))[0]
            if self.module.lower() != stem.lower():
                raise Refused(number, f"module {self.module} in file {stem}.pf: the names must be the same")
        if self.waiting:
            self.procedure(number, line)
        self.out.append(line)

    def procedure(self, number, line):
        word, _, disabled, condition = self.waiting
        found = PROCEDURE.match(line)
        if not found:
            raise Refused(number, f"after @{word} comes `subroutine NAME()`, without prefix or arguments")
        name = found.group(1)
        if word != "test":
            self.fixture[word] = name
        elif len(name) > NAME_LENGTH:
            raise Refused(number, f"test name {name} is longer than {NAME_LENGTH} characters")
        elif name.lower() in (known.lower() for known, _, _ in self.tests):
            raise Refused(number, f"test {name} is there twice")
        else:
            self.tests.append((name, disabled, condition))
        self.waiting = None

    def directive(self, number, line):
        found = DIRECTIVE.match(line)
        if not found:
            raise Refused(number, "`@` without a directive")
        word, rest = found.group(1).lower(), found.group(2)
        if word in BY_LOWER:
            self.check(number, line, BY_LOWER[word], rest)
        elif word in ("test", "before", "after"):
            self.start(number, word, rest)
            self.out.append("!" + line)
        elif word == "disable":
            if not self.waiting or self.waiting[0] != "test" or rest:
                raise Refused(number, "@disable stands alone, between @test and its subroutine")
            self.waiting = (*self.waiting[:2], True, self.waiting[3])
            self.out.append("!" + line)
        else:
            known = "@test @disable @before @after @" + " @".join(ASSERTS)
            raise Refused(number, f"unknown directive @{found.group(1)}; known: {known}")

    def start(self, number, word, rest):
        if self.waiting:
            raise Refused(number, f"@{word} where the subroutine of @{self.waiting[0]} should be")
        if word != "test" and self.fixture[word]:
            raise Refused(number, f"a second @{word}")
        condition = CONDITION.match(rest)
        if rest and (word != "test" or not condition):
            raise Refused(number, f"@{word} does not take `{rest}`; @test takes (ifdef=NAME) or (ifndef=NAME)")
        self.waiting = (word, number, False, (condition.group(1).lower(), condition.group(2)) if condition else None)

    def check(self, number, line, name, rest):
        if self.waiting:
            raise Refused(number, f"@{name} where the subroutine of @{self.waiting[0]} should be")
        inner = rest[1:-1] if rest.startswith("(") and rest.endswith(")") else None
        count = operands(inner) if inner is not None else None
        if count is None:
            raise Refused(number, f"@{name} must be closed on its own line, with nothing after its last bracket")
        if count < ASSERTS[name]:
            raise Refused(number, f"@{name} wants at least {ASSERTS[name]} argument(s), has {count}")
        call = f"  call {name}({inner}, &"
        if len(call) > LINE_LENGTH:
            raise Refused(number, f"@{name} is {len(call) - LINE_LENGTH} characters too long for the call made of it")
        self.out += [
            f'#line {number} "{self.path}"',
            call,
            f"    & location=SourceLocation('{self.label}', {number}))",
            "  if (anyExceptions()) return",
            f'#line {number + 1} "{self.path}"',
        ]

    def suite(self):
        arguments = "".join(f", {key}={name}" for key, name in self.fixture.items() if name)
        self.out += [
            "",
            f"subroutine {self.module}_suite()",
            "  use funit_run, only: funit_run_test => run_test",
            f"  use {self.module}",
            "  implicit none",
        ]
        for name, disabled, condition in self.tests:
            call = [
                f"  call funit_run_test('{self.module}%{name}', &",
                f"    & {name}, {'.true.' if disabled else '.false.'}{arguments})",
            ]
            self.out += [f"#{condition[0]} {condition[1]}", *call, "#endif"] if condition else call
        self.out += [f"end subroutine {self.module}_suite"]


def driver(modules):
    """Main program: runs every suite, then reports."""
    lines = ["program test_driver", "  use funit_run, only: start_run, end_run", "  implicit none", "  interface"]
    for module in modules:
        lines += [f"    subroutine {module}_suite()", f"    end subroutine {module}_suite"]
    lines += ["  end interface", "  call start_run()"]
    lines += [f"  call {module}_suite()" for module in modules]
    return "\n".join(lines + ["  call end_run()", "end program test_driver", ""])


def write(path, text):
    """Write only what differs, so that nothing is built again for nothing."""
    if os.path.exists(path):
        with open(path, encoding="utf-8") as old:
            if old.read() == text:
                return
    os.makedirs(os.path.dirname(os.path.abspath(path)), exist_ok=True)
    with open(path, "w", encoding="utf-8") as new:
        new.write(text)


def main(arguments):
    if len(arguments) >= 3 and arguments[0] == "--driver":
        write(arguments[1], driver(arguments[2:]))
        return 0
    if len(arguments) not in (2, 4) or (len(arguments) == 4 and arguments[2] != "--label"):
        print(__doc__, file=sys.stderr)
        return 2
    path, out = arguments[:2]
    label = arguments[3] if len(arguments) == 4 else os.path.basename(path)
    with open(path, encoding="utf-8") as source:
        lines = source.readlines()
    try:
        text = Translator(path, label).run(lines)
    except Refused as refused:
        print(f"{path}:{refused.line}: error: {refused}", file=sys.stderr)
        return 2
    if os.path.exists(out):
        os.remove(out)      # its time must be newer than the source's even where the text is the same
    write(out, text)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
