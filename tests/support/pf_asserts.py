#!/usr/bin/env python3
"""Write the Fortran module `funit_numbers`: the asserts on numbers, one specific procedure per type and rank.

usage: pf_asserts.py OUT.f90
Each procedure only hands its arguments, as lists with their shapes, to `funit_compare`, where the rules are.
"""
import sys

# Letter in the procedure names, declaration, comparing procedure, value as that procedure takes it.
REAL = ("r", "real(real64)", "compare_reals", "{}")
TYPES = [
    REAL,
    ("i", "integer(int32)", "compare_integers", "int({}, int64)"),
    ("l", "integer(int64)", "compare_integers", "{}"),
    ("b", "logical", "compare_logicals", "{}"),
]
# Rank of the expected value and of the actual one.
RANKS = [(0, 0), (0, 1), (0, 2), (1, 1), (2, 2)]
# Assert, relation in funit_compare, letters of the types that have it.
ASSERTS = [
    ("assertEqual", "is_equal", "rilb"),
    ("assertNotEqual", "is_not_equal", "rilb"),
    ("assertLessThan", "is_less", "ril"),
    ("assertLessThanOrEqual", "is_less_or_equal", "ril"),
    ("assertGreaterThan", "is_greater", "ril"),
    ("assertGreaterThanOrEqual", "is_greater_or_equal", "ril"),
    ("assertRelativelyEqual", "is_relatively_equal", "r"),
]


def as_list(name, rank, form):
    """The argument as a list, in storage order."""
    value = form.format(name)
    return {0: f"[{value}]", 1: value, 2: f"reshape({value}, [size({name})])"}[rank]


def specific(name, relation, kind, ranks):
    """One procedure."""
    _, declaration, compare, form = kind
    dims = ["", "(:)", "(:, :)"]
    tolerance = kind is REAL
    # A relative comparison without a tolerance would be an exact one in disguise; pFUnit wants it too.
    optional = "" if relation == "is_relatively_equal" else ", optional"
    lines = [f"  subroutine {name}(expected, actual, {'tolerance, ' if tolerance else ''}message, location)"]
    lines += [f"    {declaration}, intent(in) :: expected{dims[ranks[0]]}, actual{dims[ranks[1]]}"]
    lines += [f"    real(real64), intent(in){optional} :: tolerance"] if tolerance else []
    lines += [
        "    character(len=*), intent(in), optional :: message",
        "    type(SourceLocation), intent(in), optional :: location",
        "",
        f"    call {compare}({relation}, {as_list('expected', ranks[0], form)}, &",
        f"      & {as_list('actual', ranks[1], form)}, shape(expected), shape(actual), &",
        f"      & {'tolerance, ' if tolerance else ''}message, location)",
        f"  end subroutine {name}",
        "",
    ]
    return lines


def module():
    """The whole file."""
    names = [name for name, _, _ in ASSERTS]
    head = [
        "!> Asserts on numbers and logicals, written by pf_asserts.py.",
        "module funit_numbers",
        "  use, intrinsic :: iso_fortran_env, only: int32, int64, real64",
        "  use funit_compare, only: " + ", ".join(sorted({kind[2] for kind in TYPES})),
        "  use funit_compare, only: " + ", &\n    & ".join(relation for _, relation, _ in ASSERTS),
        "  use funit_report, only: SourceLocation",
        "  implicit none",
        "  private",
        "  public :: " + ", &\n    & ".join(names),
        "",
    ]
    body = []
    for name, relation, letters in ASSERTS:
        head += [f"  interface {name}"]
        for kind in TYPES:
            if kind[0] not in letters:
                continue
            for ranks in RANKS:
                own = f"{relation[3:]}_{kind[0]}{ranks[0]}{ranks[1]}"
                head += [f"    module procedure :: {own}"]
                body += specific(own, relation, kind, ranks)
        head += [f"  end interface {name}", ""]
    return "\n".join([*head, "contains", "", *body, "end module funit_numbers", ""])


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    with open(sys.argv[1], "w", encoding="utf-8") as out:
        out.write(module())
