"""Results of a LAGAMINE run as a page with pictures; nothing here knows the solver, only its files.

    from lagamine_report import print_short
    print_short("out/billet")
"""
from .errors import ReportError
from .reader import Run
from .short import print_short, short_lines

__all__ = ["ReportError", "Run", "print_short", "short_lines"]
