"""The Celery side of a worker: one thin task, and the process that runs the pool (`python -m worker.tasks`)."""

import os
import signal
from functools import cache
from pathlib import Path
from uuid import UUID

from celery import Celery
from celery.signals import setup_logging, worker_process_init, worker_process_shutdown
from sqlalchemy.orm import Session, configure_mappers, sessionmaker

from app.jobs.dispatch import CHUNK_QUEUE_NAME, QUEUE_NAME, TASK_NAME, celery_application
from app.runtime import logs, telemetry
from app.runtime.processes import end_with_parent
from app.runtime.settings import Settings, get_settings
from app.storage.database import make_engine, session_factory
from worker.execute import execute
from worker.memory import settle
from worker.sweep import call_next

OWNER = "GALLOPING_WORKER_OWNER"
_LOST_WAIT_SECONDS = 1.0  # until then the pool takes no message in the place of a killed process's; jobs return nothing


def worker_application(settings: Settings, owner: str) -> Celery:
    """Create the Celery application of a worker, whose leases carry the owner's name."""
    application = celery_application(settings)
    application.conf.update(_worker_options(settings))

    @cache
    def sessions() -> sessionmaker[Session]:
        # Created at the first job of each process, never before the fork: processes must not share connections.
        return session_factory(make_engine(settings, idle_seconds=settings.lease_seconds))

    @application.task(name=TASK_NAME)
    def run(job_id: str) -> None:
        owner_of_job = execute(sessions(), settings, UUID(job_id), owner, _end_process)
        if owner_of_job is not None and settings.running_jobs_per_owner:
            call_next(sessions(), settings, owner_of_job)

    return application


def _end_process() -> None:
    """End this process of the pool, which replaces it."""
    os.kill(os.getpid(), signal.SIGKILL)


def _worker_options(settings: Settings) -> dict[str, object]:
    transport_options = dict(celery_application(settings).conf.broker_transport_options)
    if not settings.has_embedded_broker:
        # Unlike a sender, a worker blocks in reads of one second, and nobody waits for it.
        transport_options |= {"socket_timeout": 10.0, "health_check_interval": 10, "max_retries": None}
    return {
        "broker_transport_options": transport_options,
        "broker_connection_retry_on_startup": True,
        "broker_connection_max_retries": None,
        "task_acks_late": True,
        "task_reject_on_worker_lost": True,
        "task_soft_time_limit": settings.soft_time_limit_seconds,
        "task_time_limit": settings.hard_time_limit_seconds,
        "worker_cancel_long_running_tasks_on_connection_loss": False,
        "worker_concurrency": settings.worker_processes,
        "worker_lost_wait": _LOST_WAIT_SECONDS,
        "worker_max_tasks_per_child": settings.max_jobs_per_process,
        "worker_pool": f"{__package__}.pool:EmbeddedPool" if settings.has_embedded_broker else "prefork",
        "worker_prefetch_multiplier": 1,
        "worker_send_task_events": False,
        "worker_soft_shutdown_timeout": settings.shutdown_seconds,
    }


def _leave_logs(**_: object) -> None:
    """Keep Celery from configuring the logs; it does so unless a handler listens to its signal."""


def load() -> None:
    """Load what every job needs before the fork: once for all processes, so that a replacement is ready at once."""
    from engine import analysis, clearance  # noqa: F401, PLC0415

    configure_mappers()


def _mute_celery() -> None:
    """Drop what Celery prints about signals, on standard output, which reads as if it were said to whoever serves.

    Logs go to standard error.
    """
    with Path(os.devnull).open("wb") as nothing:
        os.dup2(nothing.fileno(), 1)


def _run_pool() -> None:
    end_with_parent()
    _mute_celery()
    settings = get_settings()
    logs.configure(settings)
    telemetry.configure(settings, "worker")
    setup_logging.connect(_leave_logs)
    load()
    worker_process_init.connect(settle)
    worker_process_shutdown.connect(telemetry.finish)
    application = worker_application(settings, os.environ[OWNER])
    quiet = ["--without-gossip", "--without-mingle", "--without-heartbeat", "--hostname=galloping@%h"]
    queues = f"--queues={QUEUE_NAME},{CHUNK_QUEUE_NAME}"
    application.worker_main(["--quiet", "worker", "--loglevel=WARNING", queues, *quiet])


if __name__ == "__main__":
    _run_pool()
