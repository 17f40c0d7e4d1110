"""The runs of a study: those that are there already are taken, the others are made, one after the other or several at a time."""
import fcntl
import hashlib
import json
import os
import re
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Dict, List, Sequence, Tuple

from lagamine_report.errors import EXIT_MACHINE, ReportError
from lagamine_report.program import write
from lagamine_report.reader import Run
from lagamine_report.tables import number, read_object, read_summary, warnings_of

from .ladders import Quantity, Rung

MARK = "study.json"      # in the folder of a run: the call that made it
LOCK = "lagamine.lock"   # there too: locked while a program is at work
SPENT = "study.seconds.json"      # beside it: seconds of processor of that call, all programs


@dataclass
class Result:
    """What a run ended with; `values` by the texts of the quantities."""

    rung: Rung
    code: int
    reason: str
    values: Dict[str, float]
    seconds: float      # of processor
    wall: float
    steps: float
    iterations: float
    elements: float
    equations: float
    warnings: List[str]


def program_of(deck: str) -> str:
    """`lagacycle` for a deck that asks for new meshes, in itself or in a file that it includes, `lagamine` for others."""
    return "lagacycle" if any(re.search(rb"(?m)^(\xef\xbb\xbf)?REMSH\b", content) for content in files_of(deck).values()) else "lagamine"


def command_of(deck: str, rung: Rung, fixed: Sequence[str], programs: str, threads: int) -> List[str]:
    """The call of one run. Parameters of the ladder count more than fixed ones."""
    words = [f"{name}={value}" for name, value in rung.parameters.items()]
    words = [word for word in fixed if word.partition("=")[0] not in rung.parameters] + words
    return [os.path.join(programs, program_of(deck)), deck, "--out", rung.folder, "--quiet", "--threads", str(threads),
            *(part for word in words for part in ("-p", word))]


def files_of(deck: str) -> Dict[str, bytes]:
    """The deck and the files it includes, those of steels among them (which name steels, and no files), each with its content."""
    found: Dict[str, bytes] = {}
    waiting, steels = [os.path.abspath(deck)], set()
    while waiting:
        path = waiting.pop()
        if path in found:
            continue
        try:
            with open(path, "rb") as file:
                found[path] = file.read()
        except OSError as error:
            raise ReportError(f"{path}: cannot be read: {error.strerror}") from error
        if path in steels:
            continue
        for word, a, b in re.findall(rb"(?im)^[ \t]*(INCLU|STEEL)[ \t]+(?:'([^']*)'|(\S+))", found[path]):
            waiting.append(os.path.join(os.path.dirname(path), os.fsdecode(a or b)))
            if word.upper() == b"STEEL":
                steels.add(waiting[-1])
    return found


def digest_of(deck: str) -> str:
    """SHA-256 of a deck and the files it includes."""
    digest = hashlib.sha256()
    for content in files_of(deck).values():
        digest.update(content)
    return digest.hexdigest()


def is_there(rung: Rung, mark: Dict[str, object]) -> bool:
    """The folder has the results of the same call, to their end."""
    try:
        return read_object(os.path.join(rung.folder, MARK)) == mark and read_summary(os.path.join(rung.folder, "summary.json")).get("exit_code") in (0, 3)
    except ReportError:
        return False


def make_runs(commands: Dict[str, List[str]], marks: Dict[str, Dict[str, object]], jobs: int, tell) -> None:
    """Run the calls by folder, `jobs` at a time. A folder is marked before its run, so that one of another call is not taken for it. After a
    failure no more are begun; INT and TERM end the programs that are at work too, and the study with 128 + their number."""
    at_work: List[subprocess.Popen] = []
    ended = threading.Event()

    def one(folder: str) -> None:
        if ended.is_set():
            return
        try:
            make(folder)
        except BaseException:
            ended.set()
            raise

    def make(folder: str) -> None:
        try:
            refuse_at_work(folder)
            if os.path.isfile(os.path.join(folder, MARK)):
                shutil.rmtree(folder)
            os.makedirs(folder)
            write(os.path.join(folder, MARK), json.dumps(marks[folder], indent=1).encode("utf-8"))
            try:
                code, said, spent = call(commands[folder], at_work)
            except OSError as error:
                raise ReportError(f"{commands[folder][0]}: cannot be started: {error.strerror}", EXIT_MACHINE) from error
            write(os.path.join(folder, SPENT), json.dumps({"processor_s": spent}).encode("utf-8"))
        except FileExistsError as error:
            raise ReportError(f"{folder}: is there, and no run of a study", advice="move it away, or choose another --out") from error
        except OSError as error:
            raise ReportError(f"{folder}: cannot be written: {error.strerror}", EXIT_MACHINE) from error
        if code not in (0, 3):
            raise ReportError(f"{shlex.join(commands[folder])}: {said.strip() or f'ended with {code}'}", code)
        tell(folder)

    before = {number: signal.signal(number, lambda number, _: sys.exit(128 + number)) for number in (signal.SIGINT, signal.SIGTERM)}
    with ThreadPoolExecutor(jobs) as pool:
        waiting = [pool.submit(one, folder) for folder in commands]
        try:
            for finished in waiting:
                finished.result()
        except BaseException as error:
            for number in before:
                signal.signal(number, signal.SIG_IGN)
            ended.set()
            if not isinstance(error, ReportError):
                for program in list(at_work):
                    program.terminate()
            raise
        finally:
            pool.shutdown()
            for number, handler in before.items():
                signal.signal(number, handler)


def refuse_times(commands: Dict[str, List[str]], quantities: Sequence[Quantity]) -> None:
    """Times of quantities at which steps of a run do not end, by what `lagamine --check` says of its deck. A deck that is refused is left to its run,
    one of several operations to the first run that ends."""
    if not any(quantity.place == "time" for quantity in quantities):
        return
    for words in commands.values():
        with tempfile.TemporaryDirectory() as folder:
            check = [os.path.join(os.path.dirname(words[0]), "lagamine"), words[1], "--check", "--quiet", "--out", folder, *words[words.index("--threads") + 2:]]
            try:
                code = subprocess.run(check, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False).returncode
            except OSError as error:
                raise ReportError(f"{check[0]}: cannot be started: {error.strerror}", EXIT_MACHINE) from error
            scenes = os.listdir(folder)
            if code == 0 and len(scenes) == 1:
                scene = read_object(os.path.join(folder, scenes[0]))
                for quantity in quantities:
                    quantity.refuse_before(scene)


def refuse_at_work(folder: str) -> None:
    """Programs that a killed study has left go on, and their folder is theirs until they end."""
    try:
        with open(os.path.join(folder, LOCK), "rb") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except FileNotFoundError:
        return
    except BlockingIOError as error:
        raise ReportError(f"{folder}: a program is at work there", EXIT_MACHINE, advice="wait until it ends, or stop it: lagamine.lock there says which") from error


def call(words: Sequence[str], at_work: List[subprocess.Popen]) -> Tuple[int, str, float]:
    """Exit code, messages and seconds of processor of a program and of all that it has started and waited for; it is among those at work meanwhile."""
    with tempfile.TemporaryFile() as messages:
        with subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=messages) as program:
            at_work.append(program)
            try:
                _, status, used = os.wait4(program.pid, 0)
                program.returncode = os.waitstatus_to_exitcode(status)
            finally:
                at_work.remove(program)
        messages.seek(0)
        return program.returncode, messages.read().decode("utf-8", errors="replace"), used.ru_utime + used.ru_stime


def read_result(rung: Rung, quantities: Sequence[Quantity]) -> Result:
    """A finished run. One that did not reach its end has no values."""
    run = Run(rung.folder)
    s = run.summary
    code = int(number(s.get("exit_code", 0)))
    values = {quantity.text: quantity.of(run.history) if code == 0 else float("nan") for quantity in quantities}
    calls = run.calls
    wall = calls.wall if calls.number > 1 else number(s.get("wall_s"))
    wall += sum(row.numbers["remdata"] for row in run.tries if row.numbers["remdata"] == row.numbers["remdata"])
    spent = os.path.join(rung.folder, SPENT)
    # runs of a scheduler have what their last program says
    seconds = number(read_object(spent).get("processor_s")) if os.path.isfile(spent) else number(s.get("cpu_s"))
    return Result(rung, code, s.get("stop_reason") or "", values, seconds, wall, number(s.get("steps")), number(s.get("iterations")),
                  number(s.get("elements")), number(s.get("dofs")), warnings_of(s))
