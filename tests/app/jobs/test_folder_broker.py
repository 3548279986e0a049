import contextlib
import json
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any
from unittest.mock import patch

import pytest
from kombu.utils.json import dumps

from app.jobs import folder_broker
from app.jobs.dispatch import QUEUE_NAME, celery_application
from app.runtime.settings import Settings


def test_messages_come_in_the_order_in_which_they_were_sent(settings: Settings) -> None:
    with celery_application(settings).connection_for_write() as connection:
        channel: Any = connection.default_channel
        for number in range(30):
            channel._put(QUEUE_NAME, {"number": number})
        found = [channel._get(QUEUE_NAME)["number"] for _ in range(30)]
    assert found == list(range(30))


def test_a_message_is_seen_only_when_it_is_complete(settings: Settings, tmp_path: Path) -> None:
    """Send while a reader looks without a pause; each name that it sees must hold the whole message."""
    folder, torn, done = tmp_path / "broker" / "messages", [], threading.Event()

    def look() -> None:
        while not done.is_set():
            for path in folder.glob(f"*.{QUEUE_NAME}.msg"):
                with contextlib.suppress(FileNotFoundError):
                    text = path.read_text()
                    path.unlink()
                    torn.extend([text] if not text.endswith("}") else [])

    with celery_application(settings).connection_for_write() as connection:
        channel: Any = connection.default_channel
        reader = threading.Thread(target=look)
        reader.start()
        for number in range(500):
            channel._put(QUEUE_NAME, {"number": number, "filler": "x" * 20_000})
        done.set()
        reader.join()
    assert torn == []


def test_a_full_disk_leaves_no_draft_behind(settings: Settings, tmp_path: Path) -> None:
    with celery_application(settings).connection_for_write() as connection:
        channel: Any = connection.default_channel
        with patch.object(Path, "replace", side_effect=OSError("no space")), pytest.raises(OSError, match="no space"):
            channel._put(QUEUE_NAME, {"number": 1})
        assert list((tmp_path / "broker" / "messages").iterdir()) == []
        channel._put(QUEUE_NAME, {"number": 2})
    (message,) = (tmp_path / "broker" / "messages").iterdir()
    assert json.loads(message.read_text()) == {"number": 2}


def test_queues_are_bound_by_many_at_once_and_the_table_is_never_half_written(settings: Settings) -> None:
    with contextlib.ExitStack() as stack:
        opened = [stack.enter_context(celery_application(settings).connection_for_write()) for _ in range(9)]
        found: list[Any] = [connection.default_channel for connection in opened]
        reader, *channels = found
        seen: list[int] = []

        def probe(table: Any) -> str:
            seen.append(len(reader.get_table("shared")))
            return dumps(table)

        def bind(number: int) -> None:
            channels[number]._queue_bind("shared", "", "", f"queue {number % 4}")

        with patch.object(folder_broker, "dumps", probe), ThreadPoolExecutor(len(channels)) as pool:
            list(pool.map(bind, range(len(channels))))
        assert seen == [0, 1, 2, 3]
        assert {row.queue for row in reader.get_table("shared")} == {f"queue {number}" for number in range(4)}
