"""The pictures of a page drawn by several processes, one for each processor."""
import os
import pickle
from typing import List, Sequence

from .picture import Picture

MOST = 4        # processes; a page has some twenty pictures


def draw_side_by_side(pictures: Sequence[Picture]) -> None:
    """Each picture as it stands in the page, `drawn`. What another process has not drawn to its end is left to the page itself."""
    shares = [list(pictures[k::processes()]) for k in range(processes())]
    pipes = [begin(share) for share in shares[1:] if share]
    for picture in shares[0]:
        picture.data_uri()
    for share, (process, pipe) in zip(shares[1:], pipes):
        with os.fdopen(pipe, "rb") as file:
            data = file.read()
        if os.waitpid(process, 0)[1] == 0:
            for picture, drawn in zip(share, pickle.loads(data)):
                picture.drawn = drawn


def processes() -> int:
    """How many can be at work: one where a process cannot be doubled."""
    return min(len(os.sched_getaffinity(0)), MOST) if hasattr(os, "fork") and hasattr(os, "sched_getaffinity") else 1


def begin(share: List[Picture]):
    """A copy of this process that draws a share of the pictures; its number and the end of a pipe that gives the drawn ones."""
    out, into = os.pipe()
    process = os.fork()
    if process:
        os.close(into)
        return process, out
    code = 1
    try:
        data = pickle.dumps([picture.data_uri() for picture in share])
        with os.fdopen(into, "wb") as file:
            file.write(data)
        code = 0
    finally:
        os._exit(code)      # nothing of the parent's is flushed or closed here
