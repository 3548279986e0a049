"""The pool of processes that works for the embedded broker."""

import os
from typing import Any

from celery.concurrency.prefork import TaskPool


class EmbeddedPool(TaskPool):
    """A prefork pool that ends, to be started anew, when one of its idle processes is killed.

    For a broker without an event loop the processes share one pipe under a lock. A process that is killed while it
    waits for work takes the lock with it, and no other would ever get a job again. One that is killed at work holds
    no lock; the pool replaces it, and the other jobs go on.
    """

    def on_start(self) -> None:
        """Start the processes."""
        self.options["on_process_down"] = self._on_process_down
        super().on_start()

    def _on_process_down(self, process: Any) -> None:
        killed = process.exitcode is not None and process.exitcode < 0
        if killed and process.pid not in self._busy():
            os._exit(1)

    def _busy(self) -> set[int]:
        pool: Any = vars(self)["_pool"]  # what Celery's own class keeps there has no name for others
        return {pid for job in list(pool._cache.values()) for pid in job.worker_pids()}
