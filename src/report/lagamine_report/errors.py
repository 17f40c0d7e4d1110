"""Failures, with the exit codes of all LAGAMINE programs."""
EXIT_DONE = 0
EXIT_INPUT = 2
EXIT_MACHINE = 5
EXIT_BUG = 6


class ReportError(Exception):
    """A failure: a message of one line, its exit code, and perhaps advice for a second line."""

    def __init__(self, message: str, code: int = EXIT_INPUT, advice: str = "") -> None:
        super().__init__(message)
        self.code = code
        self.advice = advice
