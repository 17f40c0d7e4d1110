"""`lagareport DIR`: arguments -> page -> exit code."""
import argparse
import importlib
import os
import stat
import subprocess
import sys
import tempfile
from typing import NoReturn, Sequence

from .errors import EXIT_DONE, EXIT_INPUT, EXIT_MACHINE, ReportError
from .reader import Run
from .short import print_short

EXIT_CODES = "Exit codes: 0 done, 2 no results or a damaged file, 5 the page cannot be written."


class _Parser(argparse.ArgumentParser):
    """Wrong arguments in one line, in the format of the other programs."""

    def error(self, message: str) -> NoReturn:
        print_error(f"{self.prog}: {message}")
        print_error(f"{self.prog} --help shows how to call")
        sys.exit(EXIT_INPUT)


class _Version(argparse.Action):
    """The version, then what the programs beside this one are made of, as `lagamine --version` has it."""

    def __init__(self, option_strings: Sequence[str], dest: str, version: str) -> None:
        super().__init__(option_strings, dest, nargs=0, help="show the version, and those of the libraries")
        self.version = version

    def __call__(self, parser, *_) -> NoReturn:
        print(f"lagareport {self.version}")
        # in share/lagamine/lagamine_report, beside bin
        home = os.path.dirname(os.path.dirname(os.path.dirname(os.path.dirname(os.path.realpath(__file__)))))
        try:
            output = subprocess.run([os.path.join(home, "bin", "lagamine"), "--version"], stdin=subprocess.DEVNULL,
                                  stdout=subprocess.PIPE, text=True, check=False).stdout
        except OSError:
            output = ""
        print("".join(output.splitlines(keepends=True)[1:]), end="")
        for module in ("numpy", "h5py", "matplotlib"):
            print(f"{module}: {importlib.import_module(module).__version__}")
        sys.exit(EXIT_DONE)


def main(arguments: Sequence[str], version: str) -> int:
    """The exit code of the program; an output that cannot be written is a failure of the machine."""
    claim_standard_streams()
    code = EXIT_DONE
    try:
        try:
            code = run_program(arguments, version)
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


def run_program(arguments: Sequence[str], version: str) -> int:
    """Read the arguments, make the page, print the short result."""
    parser = _Parser("lagareport", description="The results of a run as one self-contained HTML page with pictures.",
                     epilog=EXIT_CODES)
    parser.add_argument("folder", metavar="DIR", help="folder of the results: what `lagamine DECK --out DIR` wrote")
    parser.add_argument("--out", metavar="FILE", help="the page (default: DIR/report.html)")
    parser.add_argument("--field", metavar="NAME", action="append", default=[],
                        help="show this field large and over time, instead of the usual ones; may be repeated")
    parser.add_argument("--png", metavar="DIR", help="write the pictures as PNG files into this folder too")
    parser.add_argument("--mirror", action="store_true", help="axisymmetric scenes: show both halves of the section")
    parser.add_argument("--quiet", action="store_true", help="print nothing when all goes well")
    parser.add_argument("--version", action=_Version, version=version)
    options = parser.parse_args(list(arguments))
    for stream in (sys.stdout, sys.stderr):
        stream.reconfigure(errors="replace")     # a title may hold letters that the terminal has not
    try:
        target = options.out or os.path.join(options.folder, "report.html")
        refuse_to_replace(target)
        run = Run(options.folder)
        # Only now: matplotlib takes its time, and what is refused is refused at once.
        from .album import make_pictures
        from .page import page
        pictures = make_pictures(run, options.field, options.mirror)
        write(target, page(run, pictures, version).encode("utf-8"))
        if options.png:
            write_pngs(options.png, pictures)
        for picture in pictures:
            picture.close()
    except ReportError as error:
        print_error(str(error))
        if error.advice:
            print_error(error.advice)
        return error.code
    if not options.quiet:
        print_short(run)
        print(f"  page: {target}")
    return EXIT_DONE


def write_pngs(folder: str, pictures: Sequence) -> None:
    """mesh.png, fields.png, force.png ... into a folder."""
    try:
        os.makedirs(folder, exist_ok=True)
    except OSError as error:
        raise ReportError(f"{folder}: cannot be made: {error.strerror}", EXIT_MACHINE) from error
    for picture in pictures:
        write(os.path.join(folder, picture.name + ".png"), picture.png())


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
        handle, temporary = tempfile.mkstemp(prefix=".lagareport-", dir=os.path.dirname(os.path.abspath(path)))
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
