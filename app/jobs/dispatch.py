"""The way to the workers: a message carries the id of a job, nothing else. SQL is the truth; messages may be lost."""

import logging
from collections.abc import Iterator, Sequence
from contextlib import closing, contextmanager
from dataclasses import dataclass
from typing import Any
from uuid import UUID

import kombu
from amqp.exceptions import AMQPError
from celery import Celery
from kombu.exceptions import KombuError
from redis.exceptions import RedisError
from sqlalchemy.exc import SQLAlchemyError
from sqlalchemy.orm import Session, sessionmaker

from app.jobs import leases
from app.runtime.settings import Settings

TASK_NAME = "galloping.run_job"
QUEUE_NAME = "galloping"
CHUNK_QUEUE_NAME = "galloping-chunks"

_BROKER_FAULTS = (OSError, AMQPError, KombuError, RedisError)

_logger = logging.getLogger(__name__)


class BrokerUnavailable(Exception):
    """Raised when the broker cannot be reached or does not answer in time."""


@dataclass(frozen=True, slots=True)
class Queue:
    """An open connection to the broker; every use may raise `BrokerUnavailable` from `open_queue`."""

    application: Celery
    connection: kombu.Connection

    def send(self, job_id: UUID, *, chunk: bool = False) -> None:
        """Hand over a message with the id of a job; chunks of batches wait in a queue of their own."""
        _send(self.application, job_id, _queue_name(chunk), connection=self.connection)

    def is_empty(self, *, chunk: bool = False) -> bool:
        """Tell whether no message of jobs, or of chunks, waits for a worker."""
        return self.length(chunk=chunk) == 0

    def length(self, *, chunk: bool = False) -> int:
        """Return how many messages of jobs, or of chunks, wait for a worker."""
        channel = self.connection.default_channel
        declared: Any = kombu.Queue(_queue_name(chunk), channel=channel).queue_declare()
        return int(declared.message_count)


def _queue_name(chunk: bool) -> str:
    return CHUNK_QUEUE_NAME if chunk else QUEUE_NAME


def celery_application(settings: Settings) -> Celery:
    """Make the Celery application that senders and workers share; it knows no task and opens no connection yet."""
    application = Celery("galloping", set_as_current=False)
    application.conf.update(
        **_broker(settings),
        broker_transport_options=_transport_options(settings),
        broker_connection_timeout=settings.broker_timeout_seconds,
        task_default_queue=QUEUE_NAME,
        task_ignore_result=True,
        task_serializer="json",
        accept_content=["json"],
        worker_enable_remote_control=False,
    )
    return application


@contextmanager
def open_queue(settings: Settings) -> Iterator[Queue]:
    """Connect to the broker for a few messages.

    Raises
    ------
    BrokerUnavailable
        If the broker cannot be reached or does not answer in time, now or while the queue is used.
    """
    if settings.has_embedded_broker and not settings.data_dir.exists():  # whoever asks must not make it
        raise BrokerUnavailable(f"{settings.data_dir} is gone")
    try:
        with closing(celery_application(settings)) as application, application.connection_for_write() as connection:
            yield Queue(application, connection)
    except _BROKER_FAULTS as error:
        raise BrokerUnavailable(f"{type(error).__name__}: {error}") from error


@dataclass(frozen=True, slots=True)
class Sender:
    """What a process keeps that sends often: connections to broker and database that threads share."""

    application: Celery
    sessions: sessionmaker[Session]

    def send(self, job_ids: Sequence[UUID], *, chunk: bool = False) -> bool:
        """Send committed jobs, or chunks, then mark them as dispatched; on any fault leave them to the sweeper.

        True means that the messages are with the broker. False does not prove the opposite: a second one is harmless.
        """
        try:
            self._hand_over(job_ids, chunk=chunk)
            with self.sessions.begin() as session:
                leases.mark_dispatched(session, job_ids)
        except (*_BROKER_FAULTS, SQLAlchemyError) as error:
            _logger.warning("%d jobs are left to the sweeper: %s", len(job_ids), error)
            return False
        return True

    def close(self) -> None:
        """Close the connections to the broker."""
        self.application.close()

    def _hand_over(self, job_ids: Sequence[UUID], *, chunk: bool) -> None:
        """Send messages in one exchange with a broker that can take many."""
        with self.application.producer_or_acquire() as producer, producer.batch():
            queue = self.application.amqp.queues[_queue_name(chunk)].bind(producer.channel)  # once for all
            for job_id in job_ids:
                _send(self.application, job_id, queue, producer=producer)


def _send(application: Celery, job_id: UUID, queue: Any, **by: Any) -> None:
    """Send a message by a connection or a producer to a queue, by its name or as a channel has declared it."""
    application.send_task(TASK_NAME, args=[str(job_id)], queue=queue, retry=False, **by)


def _broker(settings: Settings) -> dict[str, str]:
    """Return what names the broker; Kombu takes a transport class only where the address has no scheme."""
    if settings.has_embedded_broker:
        return {"broker_url": "localhost", "broker_transport": f"{__package__}.folder_broker:Transport"}
    return {"broker_url": settings.broker_url}


def _transport_options(settings: Settings) -> dict[str, object]:
    if settings.has_embedded_broker:
        return _folders(settings)
    return {
        "socket_timeout": settings.broker_timeout_seconds,
        "socket_connect_timeout": settings.broker_timeout_seconds,
        "socket_keepalive": True,
        "max_retries": 1,
        "interval_start": 0.0,
        "interval_step": 0.1,
        # The queues in the order in which a worker names them: a single job passes all chunks that wait.
        "queue_order_strategy": "priority",
        # A message comes back only after its process must be dead, and then at once (the default looks every 100 s).
        "visibility_timeout": 2.0 * settings.hard_time_limit_seconds,
        "unacked_restore_interval": 1,
        "unacked_restore_throttle": 1,
    }


def _folders(settings: Settings) -> dict[str, object]:
    """Make the folders of the embedded broker; sender and worker use the same one for both directions."""
    folders = {name: settings.data_dir / "broker" / name for name in ("messages", "control", "processed")}
    for folder in folders.values():
        folder.mkdir(parents=True, exist_ok=True)
    return {
        "data_folder_in": str(folders["messages"]),
        "data_folder_out": str(folders["messages"]),
        "control_folder": str(folders["control"]),
        "processed_folder": str(folders["processed"]),
        "polling_interval": 0.02,
    }
