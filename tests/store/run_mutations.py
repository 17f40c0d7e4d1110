#!/usr/bin/env python3
"""Checkpoints changed at random: refused by name, or read; never a crash, a hang, or a number that is none.

usage: run_mutations.py [-v] [-k] [--cases N] [--bits N] [--seed S] [--first K] [--programs SHARE] [--minutes M]

Checkpoints of several decks are changed in two ways. Bytes: bits turned, stretches overwritten, cut, moved; any such file must be
refused. Structure, by HDF5's own interface, with the hash made anew: values, NaN, extents, types, names, links, attributes; what no
writer could have meant must be refused, what could be meant may be read. `checkpoint_reader` reads them as the programs do, all in one
process; a SHARE of those it takes is given to `remdata` and `lagamine --resume` themselves.

Case K of a seed is always the same: `--seed S --first K` goes on where a run was stopped. Without options it takes about a minute.
LAGAMINE_BIN chooses the build, its reader is looked for in BUILD/tests. The long form: --cases 100000 --bits 20000.
"""
import argparse
import os
import random
import resource
import select
import shutil
import subprocess
import sys
import time

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.abspath(__file__))
for folder in ("runs", "cycle"):
    sys.path.insert(0, os.path.join(os.path.dirname(HERE), folder))
from sealed import BLOCK, seal  # noqa: E402
from support import BIN, INPUT, SOURCE, UPSETTING, Checks, add_cards, deck_text, said, with_h5py, write  # noqa: E402

LONGEST = 5.0            # seconds of processor time for one file, whoever reads it
WAIT = 12                # times as long on the wall, where other processes want the machine too
ENDS = {0, 2, 3, 4}      # of the programs with a file that could be meant


def bin_path(name):
    return os.path.join(os.path.abspath(BIN), name)


class Reader:
    """`checkpoint_reader`, started again whenever it has died or does not answer."""

    def __init__(self, deck):
        self.command = [os.path.join(os.path.dirname(os.path.abspath(BIN)), "tests", "checkpoint_reader"), deck]
        self.process = None

    def start(self):
        self.process = subprocess.Popen(self.command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                        text=True, errors="backslashreplace", bufsize=1)

    def ask(self, path):
        """Exit codes, message; codes None with the reason where there is no answer."""
        if self.process is None or self.process.poll() is not None:
            self.start()
        self.process.stdin.write(path + "\n")
        self.process.stdin.flush()
        ready, _, _ = select.select([self.process.stdout], [], [], WAIT * LONGEST)
        if not ready:
            self.stop()
            return None, f"no answer in {WAIT * LONGEST} s"
        answer = self.process.stdout.readline()
        if not answer.endswith("\n"):
            errors = self.process.stderr.read()
            code = self.process.wait()
            self.process = None
            return None, f"died with {code}: {errors[-3000:]}"
        words = answer.split(" ", 3)
        return [int(word) for word in words[:3]], words[3].strip()

    def stop(self):
        if self.process is not None:
            self.process.kill()
            self.process.wait()
            for pipe in (self.process.stdin, self.process.stdout, self.process.stderr):
                try:
                    pipe.close()
                except OSError:
                    pass
            self.process = None


# ---- bytes

def turn_bit(data, rng):
    place = rng.randrange(len(data))
    data[place] ^= 1 << rng.randrange(8)


def turn_first_bit(data, rng):
    data[rng.randrange(2 * BLOCK)] ^= 1 << rng.randrange(8)


def overwrite(data, rng):
    first = rng.randrange(len(data))
    last = min(len(data), first + rng.choice([1, 2, 4, 8, 64, 512, 4096]))
    data[first:last] = rng.choice([bytes(last - first), b"\xff" * (last - first), rng.randbytes(last - first)])


def cut(data, rng):
    del data[rng.randrange(len(data)):]


def append(data, rng):
    data.extend(rng.randbytes(rng.randrange(1, 2000)))


def take_out(data, rng):
    first = rng.randrange(len(data))
    del data[first:first + rng.choice([1, 8, 512])]


def swap(data, rng):
    n = rng.choice([8, 64, 512])
    a, b = rng.randrange(len(data) - n), rng.randrange(len(data) - n)
    data[a:a + n], data[b:b + n] = data[b:b + n], data[a:a + n]


BYTES = [turn_bit, turn_bit, turn_bit, turn_first_bit, overwrite, overwrite, cut, append, take_out, swap]


# ---- structure: each answers whether the file must be refused (True), may be (None), or must be read (False)

def datasets(file, kinds="if"):
    import h5py  # pylint: disable=import-outside-toplevel
    found = []
    file.visititems(lambda name, thing: found.append(name) if isinstance(thing, h5py.Dataset)
                    and (thing.dtype.kind in kinds) else None)
    return found


def one(file, rng, kinds="ifS", filled=True):
    return file[rng.choice([name for name in datasets(file, kinds) if not filled or file[name].size])]


def place_in(dataset, rng):
    return tuple(rng.randrange(n) for n in dataset.shape)


def change_integer(file, rng):
    dataset = one(file, rng, "i")
    old = dataset[place_in(dataset, rng)] if dataset.shape else dataset[()]
    new = rng.choice([-1, 0, 1, 2, int(old) + 1, int(old) - 1, 2**31 - 1, -2**31, rng.randrange(-100, 100), rng.randrange(2**31)])
    dataset[place_in(dataset, rng)] = min(max(new, -2**31), 2**31 - 1)


def change_real(file, rng):
    dataset = one(file, rng, "f")
    place = place_in(dataset, rng)
    old = float(dataset[place])
    dataset[place] = rng.choice([-old, 0.0, old * rng.uniform(0.5, 2), old + 1e-12, 1e300, -1e300, 1e-300, 1e30, rng.uniform(-10, 10),
                                 1.7e308, 2.0**31, -1.0])


def change_all(file, rng):
    dataset = one(file, rng, "if")
    values = dataset[()]
    dataset[...] = rng.choice([values * 0, values * 0 + 1, -values, values[..., ::-1] if dataset.shape else values * 2])


def not_a_number(file, rng):
    dataset = one(file, rng, "f")
    dataset[place_in(dataset, rng)] = rng.choice([float("nan"), float("inf"), float("-inf")])
    return True


def numbers(file, kinds):
    """Numbers and texts of parts, which are attributes of groups: (group, name). Attributes of datasets are for people."""
    import h5py  # pylint: disable=import-outside-toplevel
    import numpy as np  # pylint: disable=import-outside-toplevel
    found = []
    file.visititems(lambda name, thing: found.extend((name, key) for key in thing.attrs if np.asarray(thing.attrs[key]).dtype.kind in kinds)
                    if isinstance(thing, h5py.Group) else None)
    return found


def change_integer_member(file, rng):
    import numpy as np  # pylint: disable=import-outside-toplevel
    place, name = rng.choice(numbers(file, "i"))
    old = int(file[place].attrs[name])
    new = rng.choice([-1, 0, 1, 2, old + 1, old - 1, 2**31 - 1, -2**31, rng.randrange(-100, 100), rng.randrange(2**31)])
    file[place].attrs[name] = np.int32(min(max(new, -2**31), 2**31 - 1))


def change_real_member(file, rng):
    import numpy as np  # pylint: disable=import-outside-toplevel
    place, name = rng.choice(numbers(file, "f"))
    old = float(file[place].attrs[name])
    file[place].attrs[name] = np.float64(rng.choice([-old, 0.0, old * rng.uniform(0.5, 2), old + 1e-12, 1e300, -1e300, 1e-300, 1e30,
                                                     rng.uniform(-10, 10), 1.7e308, 2.0**31, -1.0]))


def change_text_member(file, rng):
    import h5py  # pylint: disable=import-outside-toplevel
    import numpy as np  # pylint: disable=import-outside-toplevel
    place, name = rng.choice(numbers(file, "S"))
    new = rng.choice([b"\0", b"x", b"..", b"/", b"a/b", b"\n", b"\xff\xfe", b"stress", b"PL8LS", b"1", b"z" * 5000, b"a\0b"])
    file[place].attrs.create(name, np.array(new, dtype=f"S{len(new)}"), dtype=h5py.string_dtype("utf-8", len(new)))


def no_number_member(file, rng):
    import numpy as np  # pylint: disable=import-outside-toplevel
    place, name = rng.choice(numbers(file, "f"))
    file[place].attrs[name] = np.float64(rng.choice(["nan", "inf", "-inf"]))
    return True


def lose_member(file, rng):
    """Gone, renamed, of another type, or more than one value."""
    import numpy as np  # pylint: disable=import-outside-toplevel
    place, name = rng.choice(numbers(file, "ifS"))
    attributes_of = file[place].attrs
    value = attributes_of[name]
    kind = rng.choice(["gone", "renamed", "type", "array"])
    del attributes_of[name]
    if kind == "renamed":
        attributes_of[name + "~"] = value
    elif kind == "type":
        other = np.int32(1) if np.asarray(value).dtype.kind != "i" else np.float64(1.0)
        attributes_of[name] = other
    elif kind == "array":
        attributes_of[name] = np.array([value, value])
    return True


def extents(file, rng):
    import numpy as np  # pylint: disable=import-outside-toplevel
    dataset = one(file, rng, "ifS", filled=False)
    name, values = dataset.name, dataset[()]
    shape = list(dataset.shape)
    if not shape:
        new = np.full((rng.choice([0, 1, 2]),), values)
    elif rng.random() < 0.2:
        new = values.reshape(-1) if len(shape) > 1 else values.reshape(1, -1)
    else:
        k = rng.randrange(len(shape))
        shape[k] = max(0, shape[k] + rng.choice([-1, 1, 1, 2, 17, -shape[k]]))
        new = np.resize(values, shape) if values.size else np.zeros(shape, values.dtype)
    if new.shape == dataset.shape:
        return None
    file.create_dataset(name + "~", data=new.astype(values.dtype))
    del file[name]
    file.move(name + "~", name)
    # lists that are as long as they like have no length to be held against, nor has the text of an empty list
    return None if any(word in name for word in ("fixations", "sides", "contours", "pieces", "connectivity", "coordinates", "deck/")) \
        else True


def wrong_type(file, rng):
    import h5py  # pylint: disable=import-outside-toplevel
    import numpy as np  # pylint: disable=import-outside-toplevel
    dataset = one(file, rng, "if")
    name, values = dataset.name, dataset[()]
    types = ["<i8", "<i2", ">i4", "<u4", "<f4", ">f8", "<f8" if dataset.dtype.kind == "i" else "<i4", "S8", "c16", "?", "V8", "enum",
             "compound", "vlen", "words", "array", "reference"]
    kind = rng.choice(types)
    del file[name]
    with np.errstate(all="ignore"):
        if kind == "enum":
            file.create_dataset(name, shape=np.shape(values), dtype=h5py.enum_dtype({"A": 0, "B": 1}, basetype="i4"))
        elif kind == "compound":
            file.create_dataset(name, shape=np.shape(values), dtype=[("a", "<i4"), ("b", "<f8")])
        elif kind == "vlen":
            file.create_dataset(name, shape=np.shape(values), dtype=h5py.vlen_dtype(np.dtype("i4")))
        elif kind == "words":
            file.create_dataset(name, shape=np.shape(values), dtype=h5py.string_dtype())
        elif kind == "array":
            file.create_dataset(name, shape=np.shape(values), dtype=np.dtype(("<i4", (2,))))
        elif kind == "reference":
            file.create_dataset(name, shape=np.shape(values), dtype=h5py.ref_dtype)
        else:
            file.create_dataset(name, data=np.zeros(np.shape(values), dtype=kind))
    return True


def stored_elsewhere(file, rng):
    import h5py  # pylint: disable=import-outside-toplevel
    import numpy as np  # pylint: disable=import-outside-toplevel
    dataset = one(file, rng, "if")
    name, values, shape, dtype = dataset.name, dataset[()], dataset.shape, dataset.dtype
    kind = rng.choice(["null", "chunked", "zip", "unwritten", "outside", "huge"])
    if kind in ("chunked", "zip", "outside") and not shape:
        kind = "null"
    del file[name]
    if kind == "null":
        file.create_dataset(name, data=h5py.Empty(dtype))
    elif kind == "chunked":
        file.create_dataset(name, data=values, chunks=True)
    elif kind == "zip":
        file.create_dataset(name, data=values, compression="gzip")
    elif kind == "outside":
        file.create_dataset(name, shape=shape, dtype=dtype, external=[("/dev/zero", 0, h5py.h5f.UNLIMITED)])
    elif kind == "huge":
        space = h5py.h5s.create_simple(tuple(rng.choice([2**20, 2**31, 2**40, 2**62]) for _ in shape) or (2**40,))
        properties = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
        properties.set_alloc_time(h5py.h5d.ALLOC_TIME_LATE)
        if rng.random() < 0.5:
            properties.set_chunk(tuple(1000 for _ in shape) or (1000,))
        try:
            h5py.h5d.create(file.id, name.encode(), h5py.h5t.py_create(np.dtype(dtype)), space, properties)
        except (ValueError, RuntimeError, OSError):
            pass
    else:
        properties = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
        properties.set_alloc_time(h5py.h5d.ALLOC_TIME_LATE)
        h5py.h5d.create(file.id, name.encode(), h5py.h5t.py_create(np.dtype(dtype)), h5py.h5s.create_simple(shape) if shape
                        else h5py.h5s.create(h5py.h5s.SCALAR), properties)
    return True


def names_of(file):
    found = []
    file.visit(found.append)
    return found


def delete(file, rng):
    name = rng.choice(names_of(file))
    del file[name]
    return True


def rename(file, rng):
    name = rng.choice(names_of(file))
    file.move(name, name + rng.choice(["x", "~", " ", "\u00e9", "y" * 300, "/z"]))
    return True


def exchange(file, rng):
    a, b = one(file, rng, filled=False).name, one(file, rng, filled=False).name
    if a != b:
        file.move(a, "/~")
        file.move(b, a)
        file.move("/~", b)


def links(file, rng):
    import h5py  # pylint: disable=import-outside-toplevel
    import numpy as np  # pylint: disable=import-outside-toplevel
    name = rng.choice(names_of(file))
    above = name.rpartition("/")[0] or "/"
    other = rng.choice(["/", above, rng.choice(names_of(file))])
    kind = rng.choice(["loop", "twice", "soft", "external", "dangling", "itself", "type"])
    if kind == "loop":
        file[above][name.rpartition("/")[2] + "~"] = file[above]
    elif kind == "twice":
        target = file[other]
        if name == other or other.startswith(name + "/"):
            file["~"] = target
        else:
            del file[name]
            file[name] = target
    elif kind == "type":
        file["~"] = np.dtype("<f8")
    else:
        del file[name]
        file[name] = {"soft": h5py.SoftLink("/" + name + "x"), "dangling": h5py.SoftLink("/nowhere"),
                      "itself": h5py.SoftLink("/" + name), "external": h5py.ExternalLink("/dev/zero", "/")}[kind]
    return True


def attributes(file, rng):
    import h5py  # pylint: disable=import-outside-toplevel
    import numpy as np  # pylint: disable=import-outside-toplevel
    thing = file[rng.choice(["/", *names_of(file)])]
    kind = rng.choice(["array", "words", "null", "int64", "schema", "version", "gone", "more"])
    version = int(file.attrs["schema_version"])
    if kind == "array":
        thing.attrs["schema_version"] = np.full((1000,), version, "<i4")
    elif kind == "words":
        thing.attrs["unit"] = "length"        # of variable length
    elif kind == "null":
        thing.attrs["unit"] = h5py.Empty("i4")
    elif kind == "int64":
        thing.attrs["schema_version"] = np.int64(version)
    elif kind == "schema":
        file.attrs["schema"] = np.bytes_(rng.choice([b"", b"x", b"lagamine checkpoints", b"y" * 60000]))
    elif kind == "version":
        file.attrs["schema_version"] = np.int32(rng.choice([-1, 0, version - 1, version + 1, 2**31 - 1]))
    elif kind == "gone":
        del file.attrs[rng.choice(["schema", "schema_version"])]
    else:
        thing.attrs["more"] = np.int32(1)     # nobody asks for it
        return False
    return True


def more(file, rng):
    """What nobody reads is not in the way."""
    import numpy as np  # pylint: disable=import-outside-toplevel
    file[rng.choice(["more", "more/and/more", "groups/more"])] = rng.choice([np.float64(1.5), np.int32(7)])
    return False


def group_for_dataset(file, rng):
    import numpy as np  # pylint: disable=import-outside-toplevel
    name = rng.choice(names_of(file))
    is_group = hasattr(file[name], "keys")
    del file[name]
    if is_group:
        file[name] = np.int32(1)
    else:
        file.create_group(name)
    return True


def text(file, rng):
    import numpy as np  # pylint: disable=import-outside-toplevel
    dataset = one(file, rng, "S")
    name, values = dataset.name, dataset[()]
    new = np.bytes_(rng.choice([b"", b"x", b"..", b"/", b"a/b", b"\n", b"\xff\xfe", b"stress", b"PL8LS", b"1", b"z" * 5000, b"a\0b"]))
    if new == b"":
        new = b"\0"
    del file[name]
    if np.shape(values):
        words = list(values)
        words[rng.randrange(len(words))] = new
        data = np.array(words)
    else:
        data = np.array(new)
    if data.dtype.itemsize == 0:
        data = data.astype("S1")
    file.create_dataset(name, data=data)


STRUCTURE = [change_integer_member] * 5 + [change_real_member] * 3 + [change_text_member] * 2 + [no_number_member] * 2 + \
    [lose_member] * 3 + [change_integer] * 5 + [change_real] * 5 + [change_all] * 2 + [not_a_number] * 2 + [extents] * 3 + [
    wrong_type, stored_elsewhere, delete, delete, rename, exchange, links, links, attributes, more, group_for_dataset, text, text]


# ---- checkpoints to begin with

def call(checks, words, codes, limit=300):
    result = subprocess.run(words, text=True, errors="backslashreplace", stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE, timeout=limit,
                            check=False)
    checks.that(result.returncode in codes, " ".join(os.path.basename(word) for word in words), said(result))


def seeds(checks):
    """Pairs of a deck and a checkpoint of it, with the checkpoint that the remesher makes of it where it does."""
    upsetting = write(checks.path("upsetting.lag"), add_cards(deck_text(UPSETTING), "CKPT 2\nREMSH\n   TIMES 0.1")
                      .replace("nx 12", "nx 3").replace("ny 18", "ny 4").replace("travel 9", "travel 2"))
    with open(os.path.join(SOURCE, "decks", "press_fit", "press_fit.lag"), encoding="utf-8") as file:
        fit = file.read().replace("PARAM  n 8 ", "PARAM  n 2 ").replace("   4 1.   4 1.", "   2 1.   2 1.")
    rings = write(checks.path("rings.lag"), fit.replace("STOP   2.", "REMSH\n   TIMES 1.5\nSTOP   2."))
    zones = checks.path("zones.lag")
    shutil.copy(os.path.join(SOURCE, "decks", "forging_zones", "forging_zones.lag"), zones)
    found = []
    for deck in (upsetting, rings, zones):
        name = os.path.splitext(os.path.basename(deck))[0]
        out = checks.path(name)
        call(checks, [bin_path("lagamine"), deck, "--out", out, "--threads", "1", "--quiet"], {4})
        old, new = os.path.join(out, name + ".ckp.h5"), checks.path(name + "-new.h5")
        call(checks, [bin_path("remdata"), old, "--out", new, "--quiet"], {0})
        found += [(deck, old), (deck, new)]
    return found


class Fuzz:
    """Cases one by one, and what was wrong with them."""

    def __init__(self, checks, options):
        self.checks, self.options = checks, options
        self.seeds = seeds(checks)
        self.readers = {deck: Reader(deck) for deck, _ in self.seeds}
        self.bodies = {}
        for _, path in self.seeds:
            with open(path, "rb") as file:
                self.bodies[path] = file.read()
        self.bad = checks.path("bad.h5")
        self.counts = {}

    def count(self, what):
        self.counts[what] = self.counts.get(what, 0) + 1

    def complain(self, case, what, detail):
        """A case that went wrong, with the file kept beside."""
        keep = self.checks.path(f"case-{case}.h5")
        if os.path.exists(self.bad):
            shutil.copy(self.bad, keep)
        self.checks.that(False, f"case {case}: {what}", f"{detail} (kept: {keep})")

    def bytes_case(self, case, rng, mutators):
        deck, path = rng.choice(self.seeds)
        data = bytearray(self.bodies[path])
        mutator = rng.choice(mutators)
        mutator(data, rng)
        if bytes(data) == self.bodies[path]:
            return
        with open(self.bad, "wb") as file:
            file.write(data)
        codes, message = self.readers[deck].ask(self.bad)
        self.count(f"bytes {mutator.__name__}")
        if codes is None:
            self.complain(case, mutator.__name__, message)
        elif codes != [INPUT] * 3 or self.bad not in message:
            self.complain(case, f"{mutator.__name__} is not refused by name", (codes, message))

    def structure_case(self, case, rng):
        import h5py  # pylint: disable=import-outside-toplevel
        deck, path = rng.choice(self.seeds)
        mutator = rng.choice(STRUCTURE)
        with open(self.bad, "wb") as file:
            file.write(self.bodies[path])
        try:
            with h5py.File(self.bad, "r+") as file:
                refused = mutator(file, rng)
        except (ValueError, KeyError, RuntimeError, OSError, IndexError, TypeError):
            self.count("not made")
            return
        seal(self.bad)
        codes, message = self.readers[deck].ask(self.bad)
        self.count(f"structure {mutator.__name__} {'no answer' if codes is None else codes}")
        if codes is None:
            self.complain(case, mutator.__name__, message)
        elif not set(codes) <= {0, INPUT}:
            self.complain(case, f"{mutator.__name__}: exit codes", (codes, message))
        elif refused and codes[0] == 0 and codes[1] == 0:
            self.complain(case, f"{mutator.__name__} is taken", codes)
        elif refused is False and codes != [0, 0, 0]:
            self.complain(case, f"{mutator.__name__} is refused", (codes, message))
        elif 0 in codes and rng.random() < self.options.programs:
            self.programs(case, mutator, deck)

    def programs(self, case, mutator, deck):
        """The programs themselves, with a file that their reader takes."""
        new, out = self.checks.path("new.h5"), self.checks.path("again")
        shutil.rmtree(out, ignore_errors=True)
        for words in ([bin_path("remdata"), self.bad, "--out", new, "--quiet"],
                      [bin_path("lagamine"), deck, "--resume", self.bad, "--out", out, "--threads", "1", "--quiet"]):
            limit = int(LONGEST * self.options.patience)
            try:
                result = subprocess.run(words, text=True, errors="backslashreplace", stdin=subprocess.DEVNULL,
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                        timeout=WAIT * limit, check=False,
                                        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (limit, limit)))
            except subprocess.TimeoutExpired:
                self.complain(case, f"{mutator.__name__}: {os.path.basename(words[0])}", f"no end in {WAIT * limit} s")
                continue
            self.count(f"{os.path.basename(words[0])} {result.returncode}")
            if result.returncode not in ENDS:
                self.complain(case, f"{mutator.__name__}: {os.path.basename(words[0])}", said(result) + result.stderr[-3000:])

    def run(self):
        options = self.options
        started = time.monotonic()
        for case in range(options.first, options.first + options.cases + options.bits):
            if time.monotonic() - started > 60 * options.minutes:
                print(f"stopped before case {case}: --seed {options.seed} --first {case} goes on")
                break
            rng = random.Random(f"{options.seed}/{case}")
            if case < options.bits:
                self.bytes_case(case, rng, [turn_bit])
            elif case % 2:
                self.bytes_case(case, rng, BYTES)
            else:
                self.structure_case(case, rng)
            if self.checks.failed > 50:
                print(f"too many: stopped after case {case}")
                break
        for reader in self.readers.values():
            reader.stop()
        if self.checks.verbose:
            for what, number in sorted(self.counts.items()):
                print(f"{number:7} {what}")
        self.checks.that(sum(self.counts.values()) > 0, "something was tried")


def main():
    with_h5py()
    parser = argparse.ArgumentParser()
    parser.add_argument("-v", action="store_true")
    parser.add_argument("-k", action="store_true")
    parser.add_argument("--cases", type=int, default=2500)
    parser.add_argument("--bits", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--programs", type=float, default=0.02)
    parser.add_argument("--minutes", type=float, default=1e9)
    parser.add_argument("--patience", type=float, default=1.0, help="the longest processor time of a program, over 5 s")
    checks = Checks()
    Fuzz(checks, parser.parse_args()).run()
    checks.end()


if __name__ == "__main__":
    main()
