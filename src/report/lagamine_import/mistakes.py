"""Mistakes in a file that is imported: collected, and reported all at once."""
from typing import List

from lagamine_report.errors import ReportError

MOST = 40    # lines printed; the rest is counted


class Refused(ReportError):
    """A file that is not imported: a line a mistake."""


class Mistakes:
    """Lines `FILE: entity: what is wrong, what was expected`."""

    def __init__(self, path: str) -> None:
        self.path = path
        self.lines: List[str] = []

    def add(self, where: str, what: str) -> None:
        """One mistake: the entity it is in (or a line number), and what was expected."""
        line = f"{self.path}:{where}: {what}" if where.isdigit() else f"{self.path}: {where}: {what}"
        if line not in self.lines:
            self.lines.append(line)

    def refuse(self) -> None:
        """Stop where there are any."""
        if self.lines:
            shown = self.lines[:MOST]
            if len(self.lines) > MOST:
                shown.append(f"{self.path}: {len(self.lines) - MOST} more")
            raise Refused("\n".join(shown))


def count(number: int, one: str, many: str = "") -> str:
    """`1 node`, `3 nodes`."""
    return f"{number} {one if number == 1 else many or one + 's'}"


def at(point) -> str:
    """A place as shown in messages."""
    return "(" + ", ".join(f"{float(value):.6g}" for value in point[:2]) + ")"
