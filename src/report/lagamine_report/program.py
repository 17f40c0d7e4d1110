"""What the Python programs share: arguments refused in one line, exit codes, standard streams, files that are there whole or not at all."""
import argparse
import importlib
import os
import stat
import subprocess
import sys
import tempfile
from typing import Callable, NoReturn, Sequence

from .errors import EXIT_DONE, EXIT_INPUT, EXIT_MACHINE, ReportError


class Parser(argparse.ArgumentParser):
    """Wrong arguments in one line, in the format of the other programs."""

    def error(self, message: str) -> NoReturn:
        print_error(f"{self.prog}: {message}")
        print_error(f"{self.prog} --help shows how to call")
        sys.exit(EXIT_INPUT)


class Version(argparse.Action):
    """The version, then what the programs beside this one are made of, as `lagamine --version` has it."""

    def __init__(self, option_strings: Sequence[str], dest: str, version: str, modules: Sequence[str] = ()) -> None:
        super().__init__(option_strings, dest, nargs=0, help="show the version, and those of the libraries")
        self.version = version
        self.modules = modules

    def __call__(self, parser, *_) -> NoReturn:
        print(f"{parser.prog} {self.version}")
        # in share/lagamine/lagamine_report, beside bin
        home = os.path.dirname(os.path.dirname(os.path.dirname(os.path.dirname(os.path.realpath(__file__)))))
        try:
            output = subprocess.run([os.path.join(home, "bin", "lagamine"), "--version"], stdin=subprocess.DEVNULL,
                                  stdout=subprocess.PIPE, text=True, check=False).stdout
        except OSError:
            output = ""
        print("".join(output.splitlines(keepends=True)[1:]), end="")
        for module in self.modules:
            try:
                print(f"{module}: {importlib.import_module(module).__version__}")
            except ImportError:
                print(f"{module}: missing")
        sys.exit(EXIT_DONE)


def run_to_code(program: Callable[[], int]) -> int:
    """The exit code of the program; an output that cannot be written is a failure of the machine."""
    claim_standard_streams()
    code = EXIT_DONE
    try:
        try:
            code = program()
        except SystemExit as ending:       # argparse's --help, --version and mistakes
            code = ending.code
        sys.stdout.flush()
    except BrokenPipeError:
        discard(1)                         # the reader has gone away
    except OSError as error:
        discard(1)
        print_error(f"cannot write to the standard output: {error.strerror}")
        code = code or EXIT_MACHINE
    return code


def claim_standard_streams() -> None:
    """A stream that the program was started without is taken by a file that nothing can be written to: the next file opened would
    have its number otherwise."""
    while True:
        descriptor = os.open(os.devnull, os.O_RDONLY)
        if descriptor > 2:
            os.close(descriptor)
            break
    if sys.stdout is None:
        sys.stdout = open(1, "w", encoding="utf-8", closefd=False)
    if sys.stderr is None:
        sys.stderr = open(2, "w", encoding="utf-8", closefd=False)


def discard(stream: int) -> None:
    """What is left in the buffer of a standard stream goes nowhere, and Python does not fail when it tries again at its end."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, stream)
    os.close(nowhere)


def print_error(message: str) -> None:
    """A failure, on the stream of errors. Where that cannot be written, only the exit code shows it."""
    try:
        print(message, file=sys.stderr, flush=True)
    except OSError:
        discard(2)


def print_failure(error: ReportError) -> int:
    """A failure and what to do about it, on the stream of errors; the exit code."""
    print_error(str(error))
    if error.advice:
        print_error(error.advice)
    return error.code


def refuse_to_replace(path: str) -> None:
    """Output may be put where nothing is, and in the place of a regular file; anything else is left as it is."""
    try:
        mode = os.lstat(path).st_mode
    except OSError:
        return
    if stat.S_ISREG(mode):
        return
    kinds = {stat.S_IFDIR: "a directory", stat.S_IFLNK: "a symbolic link", stat.S_IFCHR: "a device", stat.S_IFBLK: "a device"}
    raise ReportError(f"'{path}' is {kinds.get(stat.S_IFMT(mode), 'a pipe or a socket')}: output replaces regular files only",
                      EXIT_MACHINE, "move it away, or choose another name with --out")


def write(path: str, content: bytes) -> None:
    """Write a file under a temporary name, then rename it: never half a file."""
    refuse_to_replace(path)
    temporary = None
    try:
        handle, temporary = tempfile.mkstemp(prefix=".lagamine-", dir=os.path.dirname(os.path.abspath(path)))
        with os.fdopen(handle, "wb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        mask = os.umask(0)
        os.umask(mask)
        os.chmod(temporary, 0o666 & ~mask)
        os.replace(temporary, path)
    except OSError as error:
        if temporary and os.path.exists(temporary):
            os.unlink(temporary)
        raise ReportError(f"{path}: cannot be written: {error.strerror or error}", EXIT_MACHINE) from error
