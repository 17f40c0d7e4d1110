#!/usr/bin/env python3
"""lagacycle: solver and remesher in turns. Killed at any moment it goes on to the same results, bit by bit; a remesher that fails in
any way, and a mesh that the solver refuses, lead to another try or to a clear stop with a checkpoint that can be used.

usage: run_cycle.py [-v] [-k] [KILLS [SEED]]      -v prints every check, -k keeps the results; default 8 kills, seed 1
"""
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import time

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.abspath(__file__))
for folder in ("runs", "report"):
    sys.path.insert(0, os.path.join(os.path.dirname(HERE), folder))
from check_xdmf import check_folder  # noqa: E402
from remeshed import CYCLE, cycle, tries, within_limits  # noqa: E402
from support import (BIN, DONE, INPUT, LONGEST_RUN, MACHINE, NO_CONVERGENCE, SIGNAL, UPSETTING, Checks, add_cards,  # noqa: E402
                     deck_text, history, result_differences, run, said, summary, with_h5py, write)

REMDATA = os.path.join(os.path.abspath(BIN), "remdata")
LAGAMINE = os.path.join(os.path.abspath(BIN), "lagamine")
REMESH = 4
ACTIONS = ["as the deck says", "other transfer", "finer", "without zones", "earlier", "coarser", "old mesh"]
STOPS = (signal.SIGTERM, signal.SIGINT, signal.SIGHUP)
LOOKS = 5               # at files that another program is changing
# What is measured in seconds differs from run to run.
CLOCKS = ("remdata [s]", "restart [s]")


def hear_signals():
    """A shell cannot catch what was ignored when it began, as under nohup."""
    for number in STOPS:
        signal.signal(number, signal.SIG_DFL)


def begin(deck, out, **environment):
    """A cycle that is not waited for. Its output goes nowhere: a program left behind by a kill would hold a pipe open."""
    return subprocess.Popen([CYCLE, deck, "--out", out, "--threads", "1"], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                            stderr=subprocess.DEVNULL, env=dict(os.environ, **environment), preexec_fn=hear_signals)


def read_json(path):
    with open(path, encoding="utf-8") as file:
        return {key: value for key, value in json.load(file).items() if key not in ("wall_s", "seconds")}


def differences(first, second):
    """What differs between two cycles that should have done the same."""
    wrong = []
    for fault in result_differences(first, second):
        name = fault.split(":")[0]
        if name.endswith(".json") and ": " in fault:
            if read_json(os.path.join(first, name)) != read_json(os.path.join(second, name)):
                wrong.append(fault)
        elif fault.startswith("cycle.csv: "):
            rows = [[{key: row[key] for key in row if key not in CLOCKS} for row in tries(out)] for out in (first, second)]
            if rows[0] != rows[1]:
                wrong.append("cycle.csv: other rows")
        else:
            wrong.append(fault)
    one, two = summary(first), summary(second)
    wrong += [f"summary: {key}" for key in ("steps", "iterations", "cutbacks", "remeshings", "checks", "energy", "error")
              if one[key] != two[key]]
    return wrong


def ends_the_same(checks, deck, out, whole, what, **environment):
    """The same command goes on to the results of the undisturbed cycle, and leaves no lock behind."""
    result = cycle(deck, out, **environment)
    if checks.that(result.returncode == DONE, f"{what}: the same command goes on", said(result)):
        wrong = differences(whole, out)
        checks.that(not wrong, f"{what}: as in one go", "; ".join(wrong[:5]))
    left = [name for name in ("lagamine.lock", "case.said") if os.path.exists(os.path.join(out, name))]
    checks.that(not left, f"{what}: nothing is left of the cycle's own", left)


def undisturbed(checks, deck, out):
    """The cycle ends, prints a line per mesh, writes a row per try, and has nothing to do when called again."""
    result = cycle(deck, out)
    checks.that(result.returncode == DONE, "undisturbed: done", said(result))
    checks.that(result.stderr == "", "undisturbed: no word of errors", result.stderr)
    lines = result.stdout.splitlines()
    wanted = ["lagamine begins", "remdata makes mesh 2", "lagamine takes up mesh 2", "mesh 2", "remdata makes mesh 3",
              "lagamine takes up mesh 3", "mesh 3", "done"]
    reported = [line for line in lines if not line.startswith("step ")]
    checks.that(len(reported) == len(wanted) and all(line.startswith(words) for line, words in zip(reported, wanted)),
                "undisturbed: a line for each program, each mesh and the end", result.stdout)
    checks.that([line.split()[1] for line in lines if line.startswith("step ")] == ["1", "7", "11", "25"],
                "undisturbed: progress of each run of the solver", result.stdout)
    rows = tries(out)
    checks.that([(row["generation [-]"], row["action"], row["accepted"]) for row in rows]
                == [("2", ACTIONS[0], "y"), ("3", ACTIONS[0], "y")], "undisturbed: a row for each mesh", rows)
    for row in rows:
        empty = [key for key in row if not row[key] and key not in ("stage", "reason", "removed_volume [volume]", "force_over_limit [-]")]
        checks.that(not empty, f"mesh {row['generation [-]']}: every column is filled", empty)
        reported = read_json(os.path.join(out, f"case.g0{row['generation [-]']}.restart.json"))
        checks.that(reported["first_residual"] > 0 and not reported["remesh_refused"], f"mesh {row['generation [-]']}: the restart", reported)
    within_limits(checks, out)
    reported = summary(out)
    checks.that(reported["remeshings"] == 2 and reported["exit_code"] == 0 and reported["restart"]["generation"] == 3,
                "undisturbed: the summary reports the last mesh", reported.get("restart"))
    steps = history(out)["step"]
    checks.that(steps == list(range(1, len(steps) + 1)), "undisturbed: one row of the history a step", steps)
    faults = check_folder(out)[0]
    checks.that(not faults, "undisturbed: the XDMF file is right", faults[:3])
    page = subprocess.run([os.path.join(os.path.dirname(CYCLE), "lagareport"), out, "--out", checks.path("page.html")],
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    checks.that(page.returncode == DONE and os.path.getsize(checks.path("page.html")) > 10000, "undisturbed: lagareport's page",
                page.stdout)
    times = {path: os.stat(path).st_mtime_ns for path in files_of(out)}
    result = cycle(deck, out)
    checks.that(result.returncode == DONE and "nothing to do" in result.stdout, "again: says that there is nothing to do", said(result))
    checks.that({path: os.stat(path).st_mtime_ns for path in files_of(out)} == times, "again: touches no file")
    other = write(os.path.join(os.path.dirname(deck), "other", "case.lag"), deck_text(deck).replace("PHI 0.5", "PHI 0.4"))
    result = cycle(other, out)
    checks.that(result.returncode == INPUT and "another deck" in result.stderr, "another deck: refused", said(result))
    checks.that({path: os.stat(path).st_mtime_ns for path in files_of(out)} == times, "another deck: touches no file")
    copy = checks.path("fresh")
    shutil.copytree(out, copy)
    result = cycle(deck, copy, "--fresh")
    checks.that(result.returncode == DONE and "mesh 3" in result.stdout, "--fresh begins anew", said(result))
    checks.that(not differences(out, copy), "--fresh: as in one go", differences(out, copy)[:5])


def says_at_once(checks, deck):
    """What is under way is printed before it has ended, a line at a time; --quiet prints nothing."""
    slow = write(checks.path("slow.lag"), deck_text(deck).replace("nx 3", "nx 24").replace("ny 4", "ny 36"))
    out = checks.path("slow")
    process = subprocess.Popen([CYCLE, slow, "--out", out, "--threads", "1"], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                               stderr=subprocess.DEVNULL, text=True, preexec_fn=hear_signals)
    first = [process.stdout.readline(), process.stdout.readline()]
    at_work = process.poll() is None and not tries(out)
    checks.that(at_work and first[0].startswith("lagamine begins") and first[1].startswith("step 1 "),
                "says at once what is under way, and the first step", first)
    process.send_signal(signal.SIGTERM)
    process.communicate(timeout=LONGEST_RUN)
    result = cycle(deck, checks.path("quiet"), "--quiet")
    checks.that(result.returncode == DONE and result.stdout == result.stderr == "", "--quiet: not a word", said(result))


def files_of(folder):
    return sorted(os.path.join(place, name) for place, _, names in os.walk(folder) for name in names)


def program_at_work(process):
    """Number and name of the program that lagacycle has called, None when there is none."""
    try:
        with open(f"/proc/{process.pid}/task/{process.pid}/children", encoding="ascii") as file:
            number = int(file.read().split()[0])
        with open(f"/proc/{number}/comm", encoding="utf-8") as file:
            return number, file.read().strip()
    except (OSError, ValueError, IndexError):
        return None


def kill_one(draw, process, victim, wait):
    """Kill lagacycle, or the next lagamine or remdata it calls, after so many seconds; which one, None when it had ended."""
    end = time.monotonic() + wait
    while time.monotonic() < end and process.poll() is None:
        time.sleep(0.0005)
    while process.poll() is None:
        if victim == "lagacycle":
            process.kill()
            return victim
        found = program_at_work(process)
        if found and found[1] == victim:
            time.sleep(draw.uniform(0, 0.03) if victim == "remdata" else 0)
            try:
                os.kill(found[0], signal.SIGKILL)
                return victim
            except ProcessLookupError:
                continue
        time.sleep(0.0002)
    return None


def kills(checks, draw, deck, whole, number, seconds, **environment):
    """One of the three programs is killed, once or up to three times in one cycle; what is there can be looked at at any moment."""
    hits = {"lagacycle": 0, "lagamine": 0, "remdata": 0}
    for k in range(number):
        out = checks.path(f"kill-{k}")
        story = []
        for _ in range(1 + draw.randrange(3)):
            victim = draw.choice(sorted(hits))
            wait = draw.uniform(0, seconds * (0.5 if victim == "remdata" else 1))
            process = begin(deck, out, **environment)
            hit = kill_one(draw, process, victim, wait)
            code = process.wait(timeout=LONGEST_RUN)
            if not hit:
                seconds = 0.7 * seconds     # the machine is quicker than when they were measured
                break
            hits[victim] += 1
            story.append(f"{victim} after {wait:.2f} s")
            if os.path.exists(os.path.join(out, "case.xdmf")):
                # an instant may have been saved and not been entered yet
                # and a solver whose cycle was killed may take instants out between a look at the XDMF file and one at them
                for _ in range(LOOKS):
                    faults = [fault for fault in check_folder(out)[0] if not fault.endswith("is not in it")]
                    if not faults:
                        break
                    time.sleep(0.5)
                checks.that(not faults, f"killed {story[-1]}: the XDMF file is right", faults[:3])
            checks.that(code in (-signal.SIGKILL, SIGNAL + signal.SIGKILL, DONE), f"killed {story[-1]}: exit code", code)
        ends_the_same(checks, deck, out, whole, "killed " + ", ".join(story), **environment)
        shutil.rmtree(out)
    print("kills:", ", ".join(f"{count} of {name}" for name, count in hits.items()))
    checks.that(sum(hits.values()) >= number // 2, "most kills met a program at work", hits)


def stops(checks, draw, deck, whole, seconds):
    """Stopped by a signal: exit code 128+n, and the same command goes on."""
    for number in STOPS:
        out, wait, code = checks.path(f"stop-{number}"), max(draw.uniform(0.1, 0.6) * seconds, 0.1), DONE
        while code == DONE and wait > 0.05:     # a machine that is quicker now has ended before the signal
            shutil.rmtree(out, ignore_errors=True)
            process = begin(deck, out)
            time.sleep(wait)
            process.send_signal(number)
            code = process.wait(timeout=LONGEST_RUN)
            wait = 0.5 * wait
        checks.that(code == SIGNAL + number, f"signal {number}: exit code {SIGNAL + number}", code)
        ends_the_same(checks, deck, out, whole, f"signal {number}")


def two_at_once(checks, deck, whole):
    """A second cycle, and a run by hand, in the same folder are refused while the first goes on; a lock of one that is gone is no
    hindrance, whatever its file states."""
    out = checks.path("twice")
    process = begin(deck, out)
    wait_for_holder(out, process)
    with open(os.path.join(out, "lagamine.lock"), encoding="utf-8") as file:
        checks.that(file.read().split()[:3] == ["lagacycle", str(process.pid), os.uname().nodename], "two at once: the lock's file states")
    for what, result in {"lagacycle": cycle(deck, out), "lagamine": run([deck, "--out", out, "--threads", "1"])}.items():
        lines = result.stderr.splitlines()
        checks.that(result.returncode == MACHINE and len(lines) == 2 and f"'{out}' is in use by lagacycle (process {process.pid} on "
                    in lines[0] and "since" in lines[0], f"two at once: {what} is refused, with the one at work", said(result))
    checks.that(process.wait(timeout=LONGEST_RUN) == DONE, "two at once: the first one is done")
    checks.that(not differences(whole, out), "two at once: as in one go", differences(whole, out)[:5])
    for words in ("lagacycle 999999 %s 2000-01-01 00:00:00+0000 17", f"lagacycle {os.getpid()} %s 2000-01-01 00:00:00+0000 17", "", "\0"):
        write(os.path.join(out, "lagamine.lock"), words.replace("%s", os.uname().nodename))
        result = cycle(deck, out)
        checks.that(result.returncode == DONE, f"a lock's file that says '{words}', of no process: taken over", said(result))
    for name, make in {"a pipe": os.mkfifo, "a folder": os.mkdir, "a link": lambda path: os.symlink("/dev/null", path)}.items():
        place = checks.path("lock-" + name.split()[1])
        os.makedirs(place)
        make(os.path.join(place, "lagamine.lock"))
        for what, result in {"lagacycle": cycle(deck, place), "lagamine": run([deck, "--out", place, "--threads", "1"])}.items():
            checks.that(result.returncode == MACHINE and "lagamine.lock" in result.stderr and len(os.listdir(place)) == 1,
                        f"{name} where the lock's file should be: {what} refuses", said(result))


def wait_for_holder(out, process):
    """Until the lock's file states who has it."""
    while process.poll() is None:
        try:
            with open(os.path.join(out, "lagamine.lock"), encoding="utf-8") as file:
                if file.read().endswith("\n"):
                    return
        except OSError:
            pass
        time.sleep(0.001)


# A solver that a signal does not end: it is at work for a while after its cycle has been killed.
STUBBORN = """#!/bin/sh
trap '' TERM
: >"$READY"
sleep "$LAGS"
exec "$REALSOLVER" "$@"
"""


def has_ended(number):
    """A process is gone, or is one that has ended and of which only the exit code is left."""
    try:
        with open(f"/proc/{number}/stat", encoding="utf-8") as file:
            return file.read().rpartition(")")[2].split()[0] in "ZX"
    except OSError:
        return True


def foreign_processes(checks, deck, whole):
    """What a killed lagacycle has left at work is waited for, for it has inherited the lock; a run by hand is refused meanwhile. A
    process that has a number from the lock's file is not touched."""
    out = checks.path("foreign")
    script = write(checks.path("bin", "stubborn"), STUBBORN)
    os.chmod(script, 0o755)
    ready = checks.path("ready")
    process = begin(deck, out, LAGAMINE=script, REALSOLVER=LAGAMINE, LAGS="6", READY=ready)
    wait_for_holder(out, process)
    # before its trap is set a signal would end it
    while not os.path.exists(ready) and process.poll() is None:
        time.sleep(0.001)
    left = program_at_work(process)
    process.kill()
    process.wait()
    result = run([deck, "--out", out, "--threads", "1"])
    checks.that(result.returncode == MACHINE and f"what lagacycle (process {process.pid} on " in result.stderr,
                "a program left at work: lagamine is refused", said(result))
    result = cycle(deck, out)
    checks.that(result.returncode == DONE and "waiting for the end of what an earlier lagacycle has started" in result.stdout,
                "a program left at work: waited for", said(result))
    checks.that(left and has_ended(left[0]), "a program left at work: has ended by itself", left)
    checks.that(not differences(whole, out), "a program left at work: as in one go", differences(whole, out)[:5])
    with subprocess.Popen([sys.executable, "-c", "import time; time.sleep(100)", "lagacycle", "case"]) as other:
        with open(f"/proc/{other.pid}/stat", encoding="utf-8") as file:
            started = file.read().rpartition(")")[2].split()[19]
        write(os.path.join(out, "lagamine.lock"), f"lagacycle {other.pid} {os.uname().nodename} 2000-01-01 00:00:00+0000 {started}\n")
        write(os.path.join(out, "case.lock", "child.1"), str(other.pid))
        result = cycle(deck, out)
        checks.that(result.returncode == DONE and other.poll() is None, "a process of a number in the lock's file: left alone", said(result))
        other.kill()


# A remesher that fails in a given way in its first calls ($FAILS of them).
FAILING = """#!/bin/sh
echo "$*" >>"$CALLS"
[ "$(wc -l <"$CALLS")" -gt "$FAILS" ] && exec "$REAL" "$@"
case $WAY in
  crash) kill -SEGV $$ ;;
  hang) exec sleep 1000 ;;
  text) echo rubbish >"$3"; exit 0 ;;
  half) "$REAL" "$@"; head -c 20000 "$3" >"$3.cut"; mv "$3.cut" "$3"; exit 0 ;;
  old) cp "$1" "$3"; exit 0 ;;
  nothing) exit 0 ;;
  full) ulimit -f 8; exec "$REAL" "$@" ;;
  *) echo "made to fail" >&2; exit "$WAY" ;;
esac
"""


def failing(checks, name, way, fails):
    """Environment of a cycle whose remesher fails."""
    script = write(checks.path("bin", "remdata"), FAILING)
    os.chmod(script, 0o755)
    return {"REMDATA": script, "REAL": REMDATA, "CALLS": checks.path(name + ".calls"), "WAY": way, "FAILS": str(fails)}


def remesher_fails_once(checks, deck):
    """However the remesher fails, another way is tried, and the cycle ends."""
    bad = "not a checkpoint"
    ways = {"crash": "signal 11", "hang": "no answer", "text": bad, "half": bad, "old": bad, "nothing": bad, "3": "exit code 3",
            "5": "exit code 5", "6": "exit code 6", "full": "exit code 5"}
    for way, word in ways.items():
        out = checks.path("once-" + way)
        result = cycle(deck, out, "--limit", "2", **failing(checks, "once-" + way, way, 1))
        what = f"remdata fails once ({way})"
        checks.that(result.returncode == DONE, f"{what}: done", said(result))
        rows = tries(out)
        checks.that(len(rows) == 3 and rows[0]["accepted"] == "n" and rows[1]["accepted"] == rows[2]["accepted"] == "y"
                    and word in rows[0]["result"] and rows[0]["stage"] and rows[0]["reason"],
                    f"{what}: the row states", rows)
        checks.that(len(rows) > 1 and rows[1]["action"] == "finer" and rows[2]["action"] == ACTIONS[0],
                    f"{what}: finer elements come next, the next mesh is the deck's", [row["action"] for row in rows])
        left = [name for name in os.listdir(out) if ".try" in name or ".tmp" in name]
        checks.that(not left, f"{what}: nothing is left of the try", left)


def decision_is_killed(checks, deck, whole):
    """The program that decides what comes next is killed: one line says so, and the same command goes on."""
    folder, out = checks.path("killed-decision"), checks.path("killed-decision", "out")
    os.makedirs(folder, exist_ok=True)
    shutil.copy(CYCLE, folder)
    once = os.path.join(folder, "once")
    # after the first step on the second mesh, once
    script = write(os.path.join(folder, "remdata"), f"""#!/bin/sh
case "$*" in *"--next"*"--ran remdata"*) [ -e {once} ] || {{ : >{once}; kill -9 $$; }} ;; esac
exec {REMDATA} "$@"
""")
    os.chmod(script, 0o755)
    words = [os.path.join(folder, "lagacycle"), deck, "--out", out, "--threads", "1", "--quiet"]
    for code, line in ((137, ["remdata --next was stopped by signal 9: the same command goes on"]), (DONE, [])):
        result = subprocess.run(words, capture_output=True, text=True, stdin=subprocess.DEVNULL, check=False,
                                env=dict(os.environ, LAGAMINE=os.path.join(os.path.abspath(BIN), "lagamine"), REMDATA=REMDATA))
        told = [one for one in result.stderr.splitlines() if "Killed" not in one]   # of the shell
        checks.that(result.returncode == code and told == line, f"decision killed: {code}, in one line", (result.returncode, result.stderr))
    ends_the_same(checks, deck, out, whole, "decision killed")


def an_earlier_save(checks, draw, deck, seconds):
    """The mesh is made from the save before: rows and instants after it are made again, killed or not."""
    script = write(checks.path("bin", "choosy"), "#!/bin/sh\ncase $1 in *.end.1.h5) exec \"$REAL\" \"$@\" ;; esac\nexit 3\n")
    os.chmod(script, 0o755)
    environment = {"REMDATA": script, "REAL": REMDATA}
    whole = checks.path("earlier")
    result = cycle(deck, whole, **environment)
    rows = tries(whole)
    checks.that(result.returncode == NO_CONVERGENCE or result.returncode == DONE, "an earlier save: ends", said(result))
    checks.that([row["action"] for row in rows[:3]] == [ACTIONS[0], "finer", "earlier"]
                and [row["accepted"] for row in rows[:3]] == ["n", "n", "y"]
                and int(rows[2]["step [-]"]) < int(rows[2]["stop_step [-]"]), "an earlier save: taken up", rows)
    steps = history(whole)["step"]
    checks.that(steps == list(range(1, len(steps) + 1)), "an earlier save: one row of the history a step", steps)
    faults = check_folder(whole)[0]
    checks.that(not faults, "an earlier save: the XDMF file is right", faults[:3])
    if result.returncode == DONE:
        kills(checks, draw, deck, whole, 4, seconds, **environment)


def all_ways_fail(checks, deck):
    """Every way in turn, then the old mesh for a while, then a clear stop; the checkpoint can be used."""
    out = checks.path("never")
    environment = failing(checks, "never", "3", 999)
    result = cycle(deck, out, **environment)
    checks.that(result.returncode == NO_CONVERGENCE, "remdata never answers well: exit code 3", said(result))
    lines = result.stderr.splitlines()
    checks.that(len(lines) == 2 and "no new mesh is good enough at step" in lines[0] and "case.ckp.h5" in lines[1],
                "remdata never answers well: what, where, and what is left", result.stderr)
    rows = tries(out)
    first = [row["action"] for row in rows if row["stop_step [-]"] == rows[0]["stop_step [-]"]]
    second = [row["action"] for row in rows if row["stop_step [-]"] != rows[0]["stop_step [-]"]]
    # a failure in making the mesh is not mended by another transfer
    checks.that(first == ["as the deck says", "finer", "earlier", "coarser", "old mesh"], "the ways at the first stop", first)
    checks.that(second == ["as the deck says", "finer", "earlier", "coarser"], "the ways at the second stop", second)
    with open(environment["CALLS"], encoding="utf-8") as file:
        calls = [line.split() for line in file]
    checks.that(["--finer" in call for call in calls[:4]] == [False, True, False, True] and calls[2][0].endswith("end.1.h5"),
                "the arguments of remdata", calls)
    again = cycle(deck, out, **environment)
    checks.that(again.returncode == NO_CONVERGENCE and tries(out) == rows, "the same command: the same stop", said(again))
    used = run([deck, "--out", out, "--resume", os.path.join(out, "case.ckp.h5"), "--threads", "1"])
    checks.that(used.returncode == DONE, "the checkpoint that is left can be used", said(used))
    shutil.rmtree(out)
    result = cycle(deck, out, "--tries", "0", **failing(checks, "never-0", "crash", 999))
    checks.that(result.returncode == NO_CONVERGENCE and len(tries(out)) == 1, "--tries 0: one way only", said(result))
    shutil.rmtree(out)
    result = cycle(deck, out, **failing(checks, "killed", "137", 1))
    checks.that(result.returncode == SIGNAL + 9 and not tries(out), "remdata killed from outside: no try, a stop", said(result))


def solver_refuses(checks):
    """The deck is so strict that the solver refuses whatever is made: every way is tried, the old mesh goes on, and nothing of its
    results is touched meanwhile: they are those of the solver alone, resumed at every stop."""
    cards = "CKPT 2\nREMSH\n   TIMES 0.1 0.25\n   ACCEPT ITERATIONS 40 FORCE 1.E-6"
    text = add_cards(deck_text(UPSETTING).replace("SAVE   20", "SAVE   3"), cards)
    deck = write(checks.path("poor", "case.lag"), text.replace("nx 12", "nx 4").replace("ny 18", "ny 6"))
    alone, out = checks.path("poor", "alone"), checks.path("poor", "out")
    code, resume = REMESH, []
    while code == REMESH:
        code = run([deck, "--out", alone, "--threads", "1"] + resume).returncode
        resume = ["--resume", os.path.join(alone, "case.ckp.h5")]
    checks.that(code == DONE, "the old mesh can go on to the end", code)
    result = cycle(deck, out)
    rows = tries(out)
    ways = [way for way in ACTIONS if way != "without zones"]  # the deck has none
    checks.that(result.returncode == NO_CONVERGENCE, "every mesh refused at restart: exit code 3", said(result))
    checks.that([row["action"] for row in rows] == ways + ways[:5], "every way is tried at both stops, the old mesh goes on once",
                [row["action"] for row in rows])
    checks.that(all(row["stage"] in ("contact", "transfer") and "at restart" in row["result"] and float(row["first_residual [-]"]) > 0
                    and "refused at step" in row["reason"] for row in rows if row["action"] != "old mesh"),
                "every row states the responsible stage and the numbers of the restart", rows)
    result = run([deck, "--out", out, "--threads", "1", "--resume", os.path.join(out, "case.ckp.h5")])
    checks.that(result.returncode == DONE, "the checkpoint that is left can be used", said(result))
    ours = ("cycle.csv", "case.g01.end.h5", "case.g01.end.1.h5")
    wrong = [fault for fault in result_differences(alone, out) if not fault.startswith(ours)]
    checks.that(not wrong, "refused meshes have touched no result", "; ".join(wrong))


# A solver that fails at once on the first new mesh: it takes the mesh up, is stopped in its first step (again, should that have come
# too late), and says that it failed.
FALLING = """#!/bin/sh
out=$3
case "$*" in
  *.try1.h5*) ;;
  *) exec "$REALSOLVER" "$@" ;;
esac
[ ! -e "$FELL" ] || exec "$REALSOLVER" "$@"
: >"$FELL"
place() { "$ASK" --about "$1" | sed -n '/^generation\\|^step/p'; }
cp -r "$out" "$FELL.before"
while :; do
  rm -f "$out/case.g02.restart.json"
  "$REALSOLVER" "$@" &
  while [ ! -e "$out/case.g02.restart.json" ]; do :; done
  kill -TERM $!
  wait $!
  [ "$(place "$out/case.ckp.1.h5")" != "$(place "$out/case.g02.try1.h5")" ] || break
  cp -r "$FELL.before/." "$out"
done
cp "$out/case.ckp.1.h5" "$out/case.ckp.h5"
echo "no convergence: made to" >&2
exit 3
"""


def no_step_from_it(checks, deck):
    """A mesh that balances and allows no step is taken back."""
    script = write(checks.path("bin", "falling"), FALLING)
    os.chmod(script, 0o755)
    out = checks.path("no-step")
    result = cycle(deck, out, LAGAMINE=script, REALSOLVER=LAGAMINE, ASK=REMDATA, FELL=checks.path("fell"))
    rows = tries(out)
    checks.that(result.returncode == DONE, "no step from a new mesh: done in the end", said(result))
    checks.that([(row["action"], row["accepted"]) for row in rows]
                == [(ACTIONS[0], "n"), ("finer", "y"), (ACTIONS[0], "y")] and "on probation" in rows[0]["result"],
                "no step from a new mesh: taken back, then finer elements", rows)
    steps = history(out)["step"]
    checks.that(steps == list(range(1, len(steps) + 1)), "no step from a new mesh: one row of the history a step", steps)


def full_disk(checks, deck, whole):
    """The disk fills at several moments: 5, and with more room the same command goes on to the same results."""
    disk = checks.path("disk")
    os.makedirs(disk)
    mounted = os.getuid() == 0 and subprocess.run(["mount", "-t", "tmpfs", "-o", "size=4k", "none", disk], stdout=subprocess.DEVNULL,
                                                  stderr=subprocess.DEVNULL, check=False).returncode == 0
    if not mounted:
        print("full disk: not tried, no leave to mount one")
        return
    needed = sum(-(-os.path.getsize(file) // 4096) * 4 for file in files_of(whole))
    out = os.path.join(disk, "out")
    try:
        for share in (0.001, 0.02, 0.1, 0.2, 0.25, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9):
            what = f"room for {share:.1%} of the results"
            shutil.rmtree(out, ignore_errors=True)
            subprocess.run(["mount", "-o", f"remount,size={max(int(share * needed), 8)}k", disk], check=True)
            result = cycle(deck, out)
            lines = result.stderr.splitlines()
            checks.that(result.returncode == MACHINE and 1 <= len(lines) <= 2, f"{what}: exit code 5, in a line", said(result))
            subprocess.run(["mount", "-o", f"remount,size={4 * needed}k", disk], check=True)
            ends_the_same(checks, deck, out, whole, what)
        larger_mesh(checks, disk, out)
    finally:
        subprocess.run(["umount", disk], check=True)


def larger_mesh(checks, disk, out):
    """Room for the checkpoint once more, but not for a new mesh of many more elements: no fault of the mesh."""
    deck = write(checks.path("larger.lag"), add_cards(deck_text(UPSETTING).replace("travel 9", "travel 4"),
                                                      "CKPT 2\nREMSH\n   TIMES 0.1\n   SIZE 0.9 0.9\n   COUNT 300").replace("nx 12", "nx 3")
                 .replace("ny 18", "ny 4"))
    whole, part = checks.path("larger"), checks.path("larger-part")
    cycle(deck, whole)
    subprocess.run([LAGAMINE, deck, "--out", part, "--quiet"], check=False, stderr=subprocess.DEVNULL)
    there = sum(-(-os.path.getsize(file) // 4096) * 4 for file in files_of(part))
    sizes = [os.path.getsize(os.path.join(folder, f"larger.{name}.h5"))/1024 for folder, name in ((part, "ckp"), (whole, "g02.start"))]
    checks.that(sizes[1] > 1.5*sizes[0], "larger mesh: its file is larger", sizes)
    for copies in (1.5, 3.6, 4.4, 5.1):
        what = f"larger mesh: room for {copies} checkpoints"
        shutil.rmtree(out, ignore_errors=True)
        subprocess.run(["mount", "-o", f"remount,size={there + int(copies*sizes[0])}k", disk], check=True)
        result = cycle(deck, out)
        checks.that(result.returncode == MACHINE and len(result.stderr.splitlines()) <= 2, f"{what}: exit code 5, in a line", said(result))
        checks.that("refused" not in result.stdout + result.stderr, f"{what}: not refused", said(result))
        subprocess.run(["mount", "-o", "remount,size=200m", disk], check=True)
        ends_the_same(checks, deck, out, whole, what)


def main():
    with_h5py()
    checks = Checks()
    numbers = [int(word) for word in sys.argv[1:] if word.isdigit()] + [8, 1][len([w for w in sys.argv[1:] if w.isdigit()]):]
    draw = random.Random(numbers[1])
    text = add_cards(deck_text(UPSETTING).replace("SAVE   20", "SAVE   3").replace("travel 9", "travel 4"),
                     "CKPT 2\nREMSH\n   TIMES 0.1 0.25").replace("nx 12", "nx 3").replace("ny 18", "ny 4")
    deck = write(checks.path("case.lag"), text)
    whole = checks.path("whole")
    undisturbed(checks, deck, whole)
    says_at_once(checks, deck)
    started = time.monotonic()
    shutil.rmtree(checks.path("fresh"))
    cycle(deck, checks.path("fresh"))
    seconds = time.monotonic() - started
    kills(checks, draw, deck, whole, numbers[0], seconds)
    stops(checks, draw, deck, whole, seconds)
    two_at_once(checks, deck, whole)
    foreign_processes(checks, deck, whole)
    remesher_fails_once(checks, deck)
    decision_is_killed(checks, deck, whole)
    an_earlier_save(checks, draw, deck, seconds)
    all_ways_fail(checks, deck)
    solver_refuses(checks)
    no_step_from_it(checks, deck)
    full_disk(checks, deck, whole)
    checks.end()


if __name__ == "__main__":
    main()
