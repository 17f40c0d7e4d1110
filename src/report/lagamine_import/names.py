"""Names that a deck may use, and those that a user gives instead."""
import re
from typing import Dict, Sequence

from .mistakes import Mistakes, Refused

VALID = re.compile(r"[A-Za-z][A-Za-z0-9_-]{0,31}\Z")
TAKEN = ("NODE", "POINT")


def read_renames(words: Sequence[str]) -> Dict[str, str]:
    """`OLD=NEW` of the option --rename."""
    result = {}
    for word in words:
        old, equals, new = word.rpartition("=")
        if not equals or not old or not VALID.match(new):
            raise Refused(f"--rename {word}: expected OLD=NEW, NEW a letter, then at most 31 letters, digits, '_' or '-'")
        result[old] = new
    return result


class Names:
    """Gives things of a file their names in the deck; every name once."""

    def __init__(self, renames: Dict[str, str], mistakes: Mistakes) -> None:
        self.renames = renames
        self.mistakes = mistakes
        self.used: Dict[str, str] = {}
        self.asked: set = set()

    def name(self, found: str, what: str) -> str:
        """The name of a thing in the deck; a mistake where it is none."""
        name = self.renames.get(found, found)
        self.asked.add(found)
        if not VALID.match(name) or name in TAKEN:
            self.mistakes.add(f"{what} '{found}'", "its name is none of a deck: expected a letter, then at most 31 letters, digits, "
                              f"'_' or '-', and neither NODE nor POINT; give another by --rename '{found}=NAME'")
        elif name in self.used:
            self.mistakes.add(f"{what} '{found}'", f"the name '{name}' is taken by the {self.used[name]}; "
                              f"give another by --rename '{found}=NAME'")
        self.used[name] = f"{what} '{found}'"
        return name

    def refuse_unknown(self) -> None:
        """A name that was to be replaced is there."""
        for old in self.renames:
            if old not in self.asked:
                self.mistakes.add(f"--rename {old}={self.renames[old]}", f"nothing that is imported is called '{old}'"
                                  + (f"; there are: {', '.join(sorted(self.asked))}" if self.asked else ""))
