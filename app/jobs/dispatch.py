"""The way to the workers: a message carries the id of a job, nothing else. SQL is the truth; messages may be lost."""

import asyncio
import logging
from collections.abc import Callable, Iterator, Sequence
from contextlib import closing, contextmanager
from dataclasses import dataclass
from functools import partial
from typing import Any
from uuid import UUID

import kombu
from amqp.exceptions import AMQPError
from celery import Celery
from kombu.exceptions import KombuError
from redis.exceptions import RedisError
from sqlalchemy.exc import SQLAlchemyError
from sqlalchemy.orm import Session, sessionmaker

from app.coalescing.grouped_calls import Groups
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
    application = Celery("galloping", broker=settings.broker_url, set_as_current=False)
    application.conf.update(
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
        """Send committed jobs, or chunks, and mark them as dispatched; on any fault leave them to the sweeper.

        True means that the messages are with the broker. False does not prove the opposite: a second one is harmless.
        """
        return self.hand_over(job_ids, chunk=chunk) and self.mark(job_ids)

    def hand_over(self, job_ids: Sequence[UUID], *, chunk: bool = False) -> bool:
        """Send messages, in one exchange with a broker that can take many; on any fault leave all to the sweeper."""
        try:
            with self.application.producer_or_acquire() as producer, producer.batch():
                queue = self.application.amqp.queues[_queue_name(chunk)].bind(producer.channel)  # once for all
                for job_id in job_ids:
                    _send(self.application, job_id, queue, producer=producer)
        except _BROKER_FAULTS as error:
            return _left(job_ids, error)
        return True

    def mark(self, job_ids: Sequence[UUID]) -> bool:
        """Note that the messages of jobs are with the broker; on any fault leave all to the sweeper."""
        try:
            with self.sessions.begin() as session:
                leases.mark_dispatched(session, job_ids)
        except SQLAlchemyError as error:
            return _left(job_ids, error)
        return True

    def close(self) -> None:
        """Close the connections to the broker."""
        self.application.close()


class Dispatcher:
    """Sends the jobs of many requests together, without letting any of them wait.

    That they are sent is noted a moment later, for all since the last time in one transaction. Where the process dies
    meanwhile, the sweeper sends them again.
    """

    def __init__(self, sender: Sender, note_seconds: float) -> None:
        """Take what sends, and the time between two notes, which is less than the sweeper's patience."""
        self._messages: Groups[UUID, bool] = Groups("messages", _for_all(sender.hand_over))
        self._notes: Groups[UUID, bool] = Groups("notes", _for_all(sender.mark), note_seconds)

    def put(self, job_id: UUID) -> None:
        """Send a committed job soon."""
        self._messages.put(job_id).add_done_callback(partial(self._note, job_id))

    async def close(self) -> None:
        """Send and note what is left."""
        await self._messages.close()
        await asyncio.sleep(0)  # for the last callback
        await self._notes.close()

    def _note(self, job_id: UUID, sent: "asyncio.Future[bool]") -> None:
        if not sent.cancelled() and sent.exception() is None and sent.result():
            self._notes.put(job_id)


def _for_all(act: Callable[[Sequence[UUID]], bool]) -> Callable[[Sequence[UUID]], list[bool]]:
    return lambda job_ids: [act(job_ids)] * len(job_ids)


def _left(job_ids: Sequence[UUID], error: Exception) -> bool:
    _logger.warning("%d jobs are left to the sweeper: %s", len(job_ids), error)
    return False


def _send(application: Celery, job_id: UUID, queue: Any, **by: Any) -> None:
    """Send a message by a connection or a producer to a queue, by its name or as a channel has declared it."""
    application.send_task(TASK_NAME, args=[str(job_id)], queue=queue, retry=False, **by)


def _transport_options(settings: Settings) -> dict[str, object]:
    if settings.broker_url.startswith("filesystem:"):
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
        "polling_interval": 0.1,
    }
