"""Decks run from Python."""
import os
import re
import subprocess
from typing import Optional

from lagamine_report.errors import ReportError

from .results import Results


def run(deck: str, out: str, programs: Optional[str] = None, threads: Optional[int] = None, **parameters) -> Results:
    """Run a deck with parameters of its PARAM cards into a folder, with new meshes where it asks for them (REMSH), and open the results.

    `programs` is the folder of `lagamine` and `lagacycle` (default: found on PATH). A run that is refused or does not reach its end raises
    LagamineError, with the program's own lines and exit code.
    """
    with open(deck, encoding="utf-8", errors="replace") as file:
        remeshed = re.search(r"(?m)^REMSH\b", file.read()) is not None
    program = "lagacycle" if remeshed else "lagamine"
    command = [os.path.join(programs, program) if programs else program, deck, "--out", out, "--quiet"]
    command += [word for name, value in parameters.items() for word in ("-p", f"{name}={value}")]
    command += ["--threads", str(threads)] if threads else []
    done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False, errors="replace")
    if done.returncode != 0:
        raise ReportError((done.stderr or done.stdout).strip() or f"{program} ended with {done.returncode}", done.returncode)
    return Results(out)
