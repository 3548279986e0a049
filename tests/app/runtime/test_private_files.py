import os
import stat
from pathlib import Path

import pytest

from app.runtime.private_files import make_private_file, make_private_folder


def _mode(path: Path) -> int:
    return stat.S_IMODE(path.stat().st_mode)


def test_new_ones_are_private(tmp_path: Path) -> None:
    make_private_folder(tmp_path / "data")
    make_private_file(tmp_path / "data" / "x")
    assert _mode(tmp_path / "data") == 0o700
    assert _mode(tmp_path / "data" / "x") == 0o600


def test_earlier_ones_become_private_and_keep_what_they_hold(tmp_path: Path) -> None:
    folder = tmp_path / "data"
    folder.mkdir()
    folder.chmod(0o755)
    file = folder / "galloping.sqlite3"
    file.write_text("kept")
    file.chmod(0o644)
    make_private_folder(folder)
    make_private_file(file)
    assert (_mode(folder), _mode(file), file.read_text()) == (0o700, 0o600, "kept")


def test_a_folder_with_what_is_not_ours_keeps_its_mode(tmp_path: Path) -> None:
    tmp_path.chmod(0o755)
    (tmp_path / "letters.txt").touch()
    make_private_folder(tmp_path)
    assert _mode(tmp_path) == 0o755


def test_a_folder_that_cannot_be_written_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "access", lambda *_: False)  # the superuser may write everywhere
    with pytest.raises(PermissionError, match="no permission to write in this folder") as caught:
        make_private_folder(tmp_path)
    assert caught.value.filename == str(tmp_path)
