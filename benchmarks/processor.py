"""Processor time of a service's processes, read from /proc; other work on the machine hardly affects it."""

import os
from collections import Counter
from pathlib import Path

_TICKS = os.sysconf("SC_CLK_TCK")
_ROLES = {
    "postgres": "postgres",
    "redis": "redis",
    "worker": "worker",
    "app.serve": "app.serve",
    "multiprocessing": "app.serve",  # the API processes, which uvicorn starts
}


def seconds_by_role() -> Counter[str]:
    """Return the processor time of this process's descendants by role [s], with their reaped children."""
    parents: dict[int, int] = {}
    spent: dict[int, float] = {}
    for place in Path("/proc").glob("[0-9]*"):
        try:
            fields = (place / "stat").read_text().rpartition(")")[2].split()
        except OSError:
            continue
        parents[int(place.name)] = int(fields[1])
        spent[int(place.name)] = sum(map(int, fields[11:15])) / _TICKS  # its own, and that of reaped children
    result: Counter[str] = Counter()
    for process, seconds in spent.items():
        role = _role(process) if _descends(process, parents) else None
        if role is not None:
            result[role] += seconds
    return result


def _role(process: int) -> str | None:
    try:
        command = Path(f"/proc/{process}/cmdline").read_text()
    except OSError:
        return None
    return next((role for word, role in _ROLES.items() if word in command), None)


def _descends(process: int, parents: dict[int, int]) -> bool:
    while process in parents and process != os.getpid():
        process = parents[process]
    return process == os.getpid()
