"""The process pool for the embedded broker."""

import os
from typing import Any

from celery.concurrency.prefork import TaskPool


class EmbeddedPool(TaskPool):
    """A prefork pool that exits, to be restarted, when one of its idle processes is killed.

    For a broker without an event loop the processes share one pipe under a lock. A process killed while it waits for
    work keeps the lock, and no other process would get a job again. A process killed during a job holds no lock; the
    pool replaces it, and the other jobs continue.
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
        pool: Any = vars(self)["_pool"]  # Celery's class offers no public access to it
        return {pid for job in list(pool._cache.values()) for pid in job.worker_pids()}
