"""Checkpoints altered on purpose whose hash is right all the same (src/store/hdf5_file_hash.f90 says where it stands)."""
import hashlib

BLOCK = 512


def block_of(body):
    """The user block of a file: what it is, its length, SHA-256 of what follows; filled up with null bytes."""
    text = f"LAGAMINE file with its hash\nlength {BLOCK + len(body)}\nsha256 {hashlib.sha256(body).hexdigest()}\n"
    return text.encode().ljust(BLOCK, b"\0")


def alter(path, action):
    """Change a checkpoint as its writer might have: its hash is right."""
    import h5py  # pylint: disable=import-outside-toplevel
    with open(path, "rb") as file:
        if file.read(BLOCK) != block_of(file.read()):
            raise AssertionError(f"{path}: this hash is made another way")
    with h5py.File(path, "r+") as file:
        action(file)
    seal(path)


def seal(path):
    """Write length and hash anew."""
    with open(path, "r+b") as file:
        file.seek(BLOCK)
        block = block_of(file.read())
        file.seek(0)
        file.write(block)


def columns_of(file, group, name):
    """Columns (from 0) of a state variable in `groups/N/state` (element, point, component), of the group called so."""
    place = file[f"groups/{group}"]
    variables = [place[f"variables/{k}"].attrs for k in range(1, 1 + place["variables"].attrs["count"])]
    names = [variable["name"].decode() for variable in variables]
    sizes = [int(variable["components"]) for variable in variables]
    first = sum(sizes[:names.index(name)])
    return slice(first, first + sizes[names.index(name)])
