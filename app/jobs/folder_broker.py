"""The embedded broker: messages are files in a folder, as in Kombu's transport, but appear there only when complete."""

from pathlib import Path
from time import monotonic_ns
from typing import Any
from uuid import uuid4

from kombu.transport import filesystem
from kombu.utils.json import dumps


class Channel(filesystem.Channel):
    """A channel whose messages a worker cannot see half written.

    Kombu's own opens a message under its final name and writes then. A worker that looks between the two takes an
    empty message and loses the job until the sweeper sends it again.
    """

    def _put(self, queue: str, payload: Any, **kwargs: Any) -> None:  # type: ignore[override]  # bases disagree
        folder = Path(self.data_folder_out)
        name = f"{monotonic_ns():020d}_{uuid4()}.{queue}.msg"  # the channel reads in the order of names
        draft = folder / f"{name}.draft"
        try:
            draft.write_text(dumps(payload))
            draft.replace(folder / name)
        except OSError:
            draft.unlink(missing_ok=True)
            raise


class Transport(filesystem.Transport):
    """Kombu's transport with this channel."""

    Channel = Channel
