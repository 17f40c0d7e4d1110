"""Checkpoints altered on purpose whose digest is right all the same (src/store/hdf5_file_digest.f90 says what it is made of)."""
import hashlib

import numpy as np

DIGEST = "digest"


def digest_of(file):
    """A line per group, attribute and dataset: path, type, extent, SHA-256 of the bytes; and the SHA-256 of the lines."""
    lines = []

    def line_of(kind, identity, shape, words):
        body = np.empty(shape, dtype=identity.dtype)
        if body.size:
            if kind == "dataset":
                import h5py  # pylint: disable=import-outside-toplevel
                identity.read(h5py.h5s.ALL, h5py.h5s.ALL, body, mtype=identity.get_type())
            else:
                identity.read(body, mtype=identity.get_type())
        extent = "".join(f" {n}" for n in reversed(shape))
        width = identity.get_type()
        lines.append(f"{kind} {words} {width.get_class()} {width.get_size()}{extent} {hashlib.sha256(body.tobytes()).hexdigest()}\n")

    def attributes(thing, path):
        for name in sorted(thing.attrs):
            if path == "/" and name == DIGEST:
                continue
            identity = thing.attrs.get_id(name)
            line_of("attribute", identity, identity.shape, f"{path} {name}")

    def group(thing, path):
        lines.append(f"group {path}\n")
        attributes(thing, path)
        for name in sorted(thing):
            if hasattr(thing[name], "keys"):
                group(thing[name], f"{path}{name}/")
            else:
                line_of("dataset", thing[name].id, thing[name].shape, path + name)
                attributes(thing[name], path + name)

    group(file, "/")
    return hashlib.sha256("".join(lines).encode()).hexdigest()


def alter(path, action):
    """Change a checkpoint as its writer might have: its digest fits."""
    import h5py  # pylint: disable=import-outside-toplevel
    with h5py.File(path, "r+") as file:
        stored = file.attrs[DIGEST]
        text = stored.decode() if isinstance(stored, bytes) else str(stored)
        if digest_of(file) != text:
            raise AssertionError(f"{path}: this digest is made another way")
        action(file)
        file.attrs.modify(DIGEST, np.bytes_(digest_of(file)))


def columns_of(file, group, name):
    """Columns (from 0) of a state variable in `groups/N/state` (element, point, component), of the group called so."""
    place = file[f"groups/{group}"]
    names = [word.decode() if isinstance(word, bytes) else str(word) for word in place["variables"][()]]
    sizes = [int(n) for n in place["components"][()]]
    first = sum(sizes[:names.index(name)])
    return slice(first, first + sizes[names.index(name)])
