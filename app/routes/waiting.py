"""Wait for the end of a job or a batch: `Prefer: wait=` (RFC 7240), bounded, without holding a thread or connection."""

import re
from contextlib import aclosing
from typing import Annotated, Any

from fastapi import Depends, Header, Request

from app.coalescing.shared_watch import SharedWatch
from app.jobs.watched_states import BatchSeen, JobSeen
from app.security.caller import Owned

_WAIT = re.compile(r'(?:^|,)\s*wait\s*=\s*"?(\d{1,9})"?\s*(?=[,;]|$)', re.IGNORECASE)
APPLIED_HEADER: dict[str, Any] = {
    "Preference-Applied": {
        "description": "`wait=` and the most seconds that the service waited, if the client asked it to wait",
        "schema": {"type": "string"},
        "example": "wait=10",
    }
}


async def _job_watch(request: Request) -> SharedWatch[Owned, JobSeen]:
    watch: SharedWatch[Owned, JobSeen] = request.app.state.job_watch
    return watch


async def _batch_watch(request: Request) -> SharedWatch[Owned, BatchSeen]:
    watch: SharedWatch[Owned, BatchSeen] = request.app.state.batch_watch
    return watch


async def _wait(
    request: Request,
    prefer: Annotated[  # the code below reads all headers of this name
        str | None,
        Header(description="`wait=N` delays the answer until the end, for at most N seconds"),
    ] = None,
) -> int | None:
    found = _WAIT.search(", ".join(request.headers.getlist("prefer")))
    return min(int(found[1]), int(request.app.state.settings.longest_wait_seconds)) if found else None


JobWatch = Annotated[SharedWatch[Owned, JobSeen], Depends(_job_watch)]
BatchWatch = Annotated[SharedWatch[Owned, BatchSeen], Depends(_batch_watch)]
Wait = Annotated[int | None, Depends(_wait)]


def applied(wait: int | None) -> dict[str, str]:
    """Return the header that confirms the client's preference."""
    return {"Preference-Applied": f"wait={wait}"} if wait is not None else {}


async def wait_for_end(
    watch: SharedWatch[Owned, JobSeen] | SharedWatch[Owned, BatchSeen], subject: Owned, seconds: int | None
) -> None:
    """Return at the end of a job or a batch, after so many seconds, or at once if the owner has none of that id."""
    if not seconds:
        return
    async with aclosing(watch.follow(subject, seconds)) as states:
        async for state in states:
            if state.ended:
                return
