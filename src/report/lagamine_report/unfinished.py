"""A run that has not ended, or ended without a message: there is no summary, what is there is shown all the same."""
import glob
import os
import time
from typing import Any, Dict, Optional

import numpy as np

from .tables import Column

UNDER_WAY, INTERRUPTED = "under way", "interrupted"
LISTING = ".log"
STOPPED = "stopped:"


def unfinished_name(folder: str) -> Optional[str]:
    """Name of the run whose listing was written to last; None where there is no listing."""
    listings = glob.glob(os.path.join(glob.escape(folder), "*" + LISTING))
    if not listings:
        return None
    return os.path.basename(max(listings, key=os.path.getmtime))[:-len(LISTING)]


def unfinished_summary(folder: str, name: str, history: Dict[str, Column], elements: int, remeshings: int) -> Dict[str, Any]:
    """What a summary would state, as far as history and meshes give it."""
    status = UNDER_WAY if is_open(os.path.join(folder, name + LISTING)) else INTERRUPTED
    summary: Dict[str, Any] = {"status": status, "stop_reason": f"last written to {last_written(folder)}", "time": 0.0, "steps": 0,
                               "iterations": 0, "cutbacks": 0, "remeshings": remeshings}
    if elements:
        summary["elements"] = elements
    for key, column, count in (("time", "time", np.max), ("steps", "step", np.max), ("iterations", "iterations", np.sum),
                               ("cutbacks", "cutbacks", np.max)):
        if column in history and len(history[column].values):
            value = float(count(history[column].values))
            summary[key] = value if key == "time" else int(value)
    return summary


def stop_reason(folder: str, name: str) -> Optional[str]:
    """Why a run stopped, by its listing; None where that does not say."""
    reason = None
    try:
        with open(os.path.join(folder, name + LISTING), encoding="utf-8", errors="replace") as listing:
            for line in listing:
                if line.startswith(STOPPED):
                    reason = line[len(STOPPED):].strip()
    except OSError:
        return None
    return reason


def last_written(folder: str) -> str:
    """Date and time of the latest change of a file that is not the report's."""
    places = (os.path.join(top, file) for top, _, files in os.walk(folder) for file in files
              if not file.endswith((".html", ".png")))
    return time.strftime("%Y-%m-%d %H:%M:%S", time.localtime(max(map(modified, places))))


def modified(path: str) -> float:
    """When a file was written to; 0 when it has gone meanwhile."""
    try:
        return os.path.getmtime(path)
    except OSError:
        return 0.0


def is_open(path: str) -> bool:
    """Has a process that we may look at this file open? The solver keeps its listing open to its end."""
    for descriptor in glob.glob("/proc/[0-9]*/fd/*"):
        try:
            if os.path.samefile(descriptor, path):
                return True
        except OSError:     # a process of another user, or one that has just ended
            continue
    return False
