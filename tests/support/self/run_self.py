#!/usr/bin/env python3
"""Test of the stand-in for pFUnit: what must fail fails, with the right words, place and exit code.

Needs a Fortran compiler: LAGAMINE_FC, else gfortran. Works in a folder of its own, which it removes.
"""
import os
import re
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
SUPPORT = os.path.dirname(HERE)
COMPILER = os.environ.get("LAGAMINE_FC") or "gfortran"
FLAGS = ["-cpp", "-std=f2008", "-pedantic", "-Wall", "-Wextra", "-Wimplicit-interface", "-Wconversion", "-Werror", "-g",
         "-fcheck=all", "-ffpe-trap=invalid,zero,overflow"] if "gfortran" in os.path.basename(COMPILER) else []
LIBRARY = ["funit_report.f90", "funit_compare.f90", "funit_basic.f90", "funit_numbers.f90", "funit_run.f90", "funit.f90"]

MODULE = "module test_one\n  use funit\n  implicit none\ncontains\n{}end module test_one\n"
TEST = "  @test\n  subroutine {0}()\n    {1}\n  end subroutine {0}\n"

# Files that must be refused: name, text, line and words of the error.
REFUSED = [
    ("unknown directive", MODULE.format(TEST.format("a", "@assertExactly(1, 1)")), 7, "unknown directive @assertExactly"),
    ("unknown assert of pFUnit", MODULE.format(TEST.format("a", "@assertAll([.true.])")), 7, "unknown directive @assertAll"),
    ("parameterised test", MODULE.format("  @testCase\n"), 5, "unknown directive @testCase"),
    ("processes", MODULE.format("  @test(npes=[1])\n  subroutine a()\n  end subroutine a\n"), 5, "does not take"),
    ("assert over two lines", MODULE.format(TEST.format("a", "@assertEqual(1, &\n      & 1)")), 7, "on its own line"),
    ("comment after assert", MODULE.format(TEST.format("a", "@assertEqual(1, 1) ! (one)")), 7, "on its own line"),
    ("assert without operands", MODULE.format(TEST.format("a", "@assertEqual('1, 1')")), 7, "wants at least 2"),
    ("assert inside a line", MODULE.format(TEST.format("a", "if (.true.) @assertTrue(.true.)")), 7, "stand alone"),
    ("assert too long", MODULE.format(TEST.format("a", f"@assertEqual(1, 1{' ' * 110})")), 7, "too long"),
    ("lonely sign", MODULE.format(TEST.format("a", "@ assertTrue(.true.)")), 7, "without a directive"),
    ("disable before test", MODULE.format("  @disable\n" + TEST.format("a", "continue")), 5, "between @test"),
    ("disable after test", MODULE.format(TEST.format("a", "@disable")), 7, "between @test"),
    ("test without subroutine", MODULE.format("  @test\n"), 6, "after @test comes"),
    ("test with arguments", MODULE.format("  @test\n  subroutine a(x)\n"), 6, "after @test comes"),
    ("test with prefix", MODULE.format("  @test\n  recursive subroutine a()\n"), 6, "after @test comes"),
    ("two tests in a row", MODULE.format("  @test\n  @test\n"), 6, "should be"),
    ("two fixtures", MODULE.format(2 * "  @before\n  subroutine a()\n  end subroutine a\n"), 8, "a second @before"),
    ("name twice", MODULE.format(2 * TEST.format("a", "continue")), 10, "there twice"),
    ("name too long", MODULE.format(TEST.format("a" * 44, "continue")), 6, "longer than"),
    ("name of another file", MODULE.replace("test_one", "test_two").format(""), 1, "names must be the same"),
    ("no module", "subroutine a()\nend subroutine a\n", 1, "no `module NAME` line"),
]

passed = failed = 0


def check(name, good, detail=""):
    """Count one result and show it if it is bad."""
    global passed, failed
    if good:
        passed += 1
    else:
        failed += 1
        print(f"FAILED: {name}\n{detail}")


def run(*words, folder=None):
    """Exit code and everything printed."""
    done = subprocess.run(words, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)
    return done.returncode, done.stdout


def need(*words, folder=None):
    """A command without which the rest makes no sense."""
    code, text = run(*words, folder=folder)
    if code:
        sys.exit(f"{' '.join(words)}\n{text}")


def translate(path, out, *more):
    return run(sys.executable, os.path.join(SUPPORT, "pf_translate.py"), path, out, *more)


def build(folder, source, program):
    """Translate, compile and link the tests of one file."""
    module = os.path.splitext(os.path.basename(source))[0]
    code, text = translate(source, os.path.join(folder, module + ".F90"))
    if code:
        sys.exit(text)
    main = os.path.join(folder, module + "_driver.f90")
    need(sys.executable, os.path.join(SUPPORT, "pf_translate.py"), "--driver", main, module)
    # Unused things and NaN made on purpose are no fault of a test file.
    need(COMPILER, *FLAGS, "-Wno-unused", "-Wno-compare-reals", module + ".F90", main, *objects, "-o", program, folder=folder)
    return os.path.join(folder, program)


def wanted_failures(path):
    """(line of the assert, words its report must have) for each `!= ` comment."""
    wanted = []
    with open(path, encoding="utf-8") as source:
        for number, line in enumerate(source, 1):
            if line.strip().startswith("!= "):
                wanted.append((number + 1, [word.strip() for word in line.strip()[3:].split(" | ")]))
    return wanted


def reports(text, name):
    """Line of the assert -> its report."""
    out, line = {}, None
    for row in text.splitlines():
        start = re.match(re.escape(name) + r":(\d+): ", row)
        line = int(start.group(1)) if start else (line if row.startswith("    ") else None)
        if line is not None:
            out[line] = out.get(line, "") + row + "\n"
    return out


def test_refusals(folder):
    path = os.path.join(folder, "test_one.pf")
    for name, text, line, words in REFUSED:
        with open(path, "w", encoding="utf-8") as out:
            out.write(text)
        code, said = translate(path, os.path.join(folder, "refused.F90"))
        good = code != 0 and f"{path}:{line}: error: " in said and words in said
        check(f"refuse: {name}", good, f"  wanted line {line}, '{words}'; exit code {code}\n{said}")
        check(f"refuse: {name}: nothing written", not os.path.exists(os.path.join(folder, "refused.F90")))


def test_failures(folder):
    source = os.path.join(HERE, "test_fails.pf")
    code, said = run(build(folder, source, "fails"))
    wanted = wanted_failures(source)
    found = reports(said, "test_fails.pf")
    for line, words in wanted:
        report = found.pop(line, "")
        check(f"test_fails.pf:{line}", all(word in report for word in words), f"  wanted {words}\n  got {report}")
    check("no other failure", not found, str(found))
    check("closing line counts the failures", f"{len(wanted)} tests, {len(wanted)} failures" in said, said[-200:])
    check("exit code of failures", code == 1, f"  exit code {code}")


def test_passes(folder):
    program = build(folder, os.path.join(HERE, "test_funit.pf"), "passes")
    code, said = run(program, "-v")
    check("what must pass", code == 0 and ", 0 failures, 1 disabled" in said, said)
    check("-v names the tests", "test_funit%order_of_numbers\n" in said and "disabled: test_funit%" in said, said)
    check("ifdef", "test_for_another_machine" not in said and "test_for_this_machine" in said, said)
    code, said = run(program, "-f", "order")
    check("filter", code == 0 and said == "1 tests, 0 failures\n", said)
    code, said = run(program, "-f", "no test has this name")
    check("no test left by the filter", code == 1 and "0 tests, 0 failures" in said, said)
    code, said = run(program, "--what")
    check("unknown option", code == 2 and "unknown option --what" in said, said)


def test_nothing(folder):
    path = os.path.join(folder, "test_one.pf")
    disabled = TEST.format("a", "@assertTrue(.true.)").replace("@test\n", "@test\n@disable\n")
    for name, text in (("no test", ""), ("all disabled", disabled)):
        with open(path, "w", encoding="utf-8") as out:
            out.write(MODULE.format(text))
        code, said = run(build(folder, path, "nothing"))
        check(name, code == 1 and "0 tests, 0 failures" in said, said)


with tempfile.TemporaryDirectory() as work:
    need(sys.executable, os.path.join(SUPPORT, "pf_asserts.py"), os.path.join(work, "funit_numbers.f90"))
    objects = []
    for file in LIBRARY:
        path = file if file == "funit_numbers.f90" else os.path.join(SUPPORT, file)
        need(COMPILER, *FLAGS, "-c", path, folder=work)
        objects.append(file.replace(".f90", ".o"))
    test_refusals(work)
    test_failures(work)
    test_passes(work)
    test_nothing(work)
print(f"{passed} passed, {failed} failed")
sys.exit(1 if failed or not passed else 0)
