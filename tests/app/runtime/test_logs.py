import json
import logging
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextvars import copy_context
from pathlib import Path

import pytest

from app.runtime import correlation, logs
from app.runtime.correlation import Ids
from app.runtime.settings import Settings


@pytest.fixture(autouse=True)
def logging_as_before() -> Iterator[None]:
    """Give pytest its handlers back."""
    handlers, level = logging.root.handlers[:], logging.root.level
    yield
    logging.root.handlers[:] = handlers
    logging.root.setLevel(level)
    logging.captureWarnings(False)


def lines(capsys: pytest.CaptureFixture[str]) -> list[dict[str, object]]:
    return [json.loads(line) for line in capsys.readouterr().err.splitlines()]


def test_a_line_holds_the_ids_and_the_facts(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    logs.configure(Settings(data_dir=tmp_path))
    with correlation.bound(Ids("r1", "00-" + "a" * 32 + "-" + "b" * 16 + "-01", "j1", 2)):
        logging.getLogger("app.some").info("it %s", "happens", extra={"points": 3})
        context = copy_context()
    thread = threading.Thread(target=context.run, args=(logging.getLogger("app.some").warning, "beside"))
    thread.start()
    thread.join()
    logging.getLogger("app.some").info("after\nwards")
    first, beside, after = lines(capsys)
    ids = {"request_id": "r1", "trace_id": "a" * 32, "job_id": "j1", "attempt": 2}
    assert {name: first[name] for name in ids} == ids
    assert (first["event"], first["level"], first["logger"], first["points"]) == ("it happens", "info", "app.some", 3)
    assert str(first["timestamp"]).endswith("Z")
    assert {name: beside[name] for name in ids} == ids
    assert (after["event"], set(ids) & set(after)) == ("after\nwards", set())


def test_a_defect_is_one_line_with_its_traceback(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    logs.configure(Settings(data_dir=tmp_path))
    try:
        raise ValueError("wrong")
    except ValueError:
        logging.getLogger("app.some").exception("it failed")
    (line,) = lines(capsys)
    assert "Traceback" in str(line["exception"]) and "ValueError: wrong" in str(line["exception"])


def test_levels_are_the_settings(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    logs.configure(Settings(data_dir=tmp_path, log_level="warning"))
    logging.getLogger("app.some").info("not shown")
    logging.getLogger("celery").warning("shown")
    assert [line["event"] for line in lines(capsys)] == ["shown"]
    logs.configure(Settings(data_dir=tmp_path))
    logging.getLogger("celery.worker.strategy").info("not shown")
    assert lines(capsys) == []


def test_people_get_text(tmp_path: Path) -> None:
    program = "import logging; from app.runtime import logs; from app.runtime.settings import Settings; "
    program += "logs.configure(Settings(log_format='text')); logging.getLogger('a').warning('hello', extra={'n': 1})"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True, cwd=tmp_path)
    assert "hello" in done.stderr and "n=1" in done.stderr and not done.stderr.startswith("{")
