"""The embedded broker: messages are files in a folder, as in Kombu's transport, but files appear only when complete."""

from pathlib import Path
from time import monotonic_ns
from typing import Any
from uuid import uuid4

from kombu.transport import filesystem
from kombu.utils.json import dumps


class Channel(filesystem.Channel):
    """A channel whose files another process cannot see half written.

    Kombu's own opens a file under its final name and writes then. A worker that looks between the two takes an empty
    message and loses the job until the sweeper sends it again; two processes that begin at once fail at the table of
    an exchange, which says what queues are bound to it.
    """

    def _queue_bind(self, exchange: str, routing_key: str, pattern: str, queue: str) -> None:  # type: ignore[override]
        folder = Path(self.control_folder)
        folder.mkdir(exist_ok=True)
        bound = filesystem.exchange_queue_t(routing_key or "", pattern or "", queue or "")
        with (folder / f"{exchange}.lock").open("w", encoding="utf-8") as held:
            filesystem.lock(held, filesystem.LOCK_EX)  # type: ignore[attr-defined]  # each platform has its own
            known = self.get_table(exchange)
            if bound not in known:
                draft = folder / f"{exchange}.draft"
                draft.write_text(dumps([bound, *known]), encoding="utf-8")
                draft.replace(folder / f"{exchange}.exchange")

    def _put(self, queue: str, payload: Any, **kwargs: Any) -> None:  # type: ignore[override]  # bases disagree
        folder = Path(self.data_folder_out)
        name = f"{monotonic_ns():020d}_{uuid4()}.{queue}.msg"  # the channel reads in the order of names
        draft = folder / f"{name}.draft"
        try:
            draft.write_text(dumps(payload), encoding="utf-8")
            draft.replace(folder / name)
        except OSError:
            draft.unlink(missing_ok=True)
            raise


class Transport(filesystem.Transport):
    """Kombu's transport with this channel."""

    Channel = Channel
