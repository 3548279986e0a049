"""The courier sends webhooks in its own thread, many at once, so that one hanging receiver delays no others."""

import asyncio
import logging
import ssl
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from datetime import UTC, datetime

import anyio
import httpx
from sqlalchemy.exc import SQLAlchemyError
from sqlalchemy.orm import Session, sessionmaker

from app.jobs import webhooks
from app.jobs.webhooks import Attempt, Message, Share
from app.ogc import callbacks
from app.runtime.settings import Settings
from app.security import webhook_addresses
from app.security.webhook_addresses import RefusedAddress
from app.storage.stored_results import CorruptResult

_AT_ONCE = 64
_AN_OWNER = 16
_A_RECEIVER = 4
_POLL_SECONDS = 0.5

_logger = logging.getLogger(__name__)


@contextmanager
def courier(sessions: sessionmaker[Session], settings: Settings) -> Iterator[None]:
    """Send due webhooks while the context lasts; another courier resends those still in progress at its end."""
    stopped = threading.Event()
    rounds = _Rounds(sessions, settings)
    thread = threading.Thread(target=asyncio.run, args=(rounds.run(stopped),), name="courier", daemon=True)
    thread.start()
    try:
        yield
    finally:
        stopped.set()
        rounds.wake()
        thread.join(2.0 * _POLL_SECONDS)


async def send(settings: Settings, message: Message, payload: str, context: ssl.SSLContext) -> Attempt:
    """Send a message once, to the current address of its host; read only the status of the answer."""
    try:
        with anyio.fail_after(settings.webhook_timeout_seconds):
            target = await webhook_addresses.vet(message.url, private=settings.webhook_private_networks)
            async with httpx.AsyncClient(verify=context, trust_env=False, follow_redirects=False) as client:
                headers = {
                    **webhooks.signed_headers(settings, message, payload, datetime.now(UTC)),
                    "Host": target.url.netloc.decode(),
                }
                name = {"sni_hostname": target.url.raw_host.decode()}
                async with client.stream(
                    "POST", target.pinned, content=payload, headers=headers, extensions=name
                ) as answer:
                    return Attempt(answer.status_code)
    except RefusedAddress as error:
        return Attempt(None, str(error))
    except TimeoutError:
        return Attempt(None, f"no answer within {settings.webhook_timeout_seconds:g} s")
    except (httpx.HTTPError, OSError) as error:
        return Attempt(None, f"{type(error).__name__}: {error}"[:300])


class _Rounds:
    """Repeated rounds of taking and sending due messages."""

    def __init__(self, sessions: sessionmaker[Session], settings: Settings) -> None:
        self._sessions, self._settings = sessions, settings
        self._in_progress = Share(_AT_ONCE, _AN_OWNER, _A_RECEIVER)
        self._loop: asyncio.AbstractEventLoop | None = None
        self._changed = asyncio.Event()

    def wake(self) -> None:
        """Start the next round at once; callable from any thread."""
        if self._loop is not None:
            with suppress(RuntimeError):  # the loop has ended already
                self._loop.call_soon_threadsafe(self._changed.set)

    async def run(self, stopped: threading.Event) -> None:
        """Send due messages until stopped."""
        self._loop = asyncio.get_running_loop()
        context = ssl.create_default_context(cafile=self._settings.webhook_ca_file)
        tasks: set[asyncio.Task[None]] = set()
        while not stopped.is_set():
            try:
                for message in await asyncio.to_thread(self._take):
                    self._in_progress.add(message.owner, message.receiver)
                    task = asyncio.create_task(self._deliver(message, context))
                    tasks.add(task)
                    task.add_done_callback(tasks.discard)
            except SQLAlchemyError as error:
                _logger.warning("the database failed; webhooks wait: %s", error)
            await self._pause()
        for task in tasks:
            task.cancel()

    async def _pause(self) -> None:
        """Wait for the next round, or until a message was sent, which frees a place for its owner and receiver."""
        with suppress(TimeoutError):
            async with asyncio.timeout(_POLL_SECONDS):
                await self._changed.wait()
        self._changed.clear()

    def _take(self) -> list[Message]:
        with self._sessions.begin() as session:
            webhooks.enlist(session, self._settings.root_path)
            return webhooks.take_due(session, self._in_progress, 2.0 * self._settings.webhook_timeout_seconds)

    async def _deliver(self, message: Message, context: ssl.SSLContext) -> None:
        try:
            payload = message.payload or await asyncio.to_thread(self._composed, message)
            if payload is None:  # the job was removed, and its messages with it
                return
            attempt = await send(self._settings, message, payload, context)
            await asyncio.to_thread(self._note, message, attempt)
        except CorruptResult as error:
            await asyncio.to_thread(self._note, message, Attempt(None, str(error)))
        except SQLAlchemyError as error:
            _logger.warning("could not store the outcome of a webhook; it will be sent again: %s", error)
        finally:
            self._in_progress.remove(message.owner, message.receiver)
            self._changed.set()

    def _composed(self, message: Message) -> str | None:
        assert message.job_id is not None
        with self._sessions() as session:
            return callbacks.body(session, message.job_id, message.event, self._settings.root_path)

    def _note(self, message: Message, attempt: Attempt) -> None:
        with self._sessions.begin() as session:
            webhooks.note(session, self._settings, message, attempt)
