"""The key that signs cursors, sessions, forms and webhooks: the operator's secret, or one in a private file."""

import os
import secrets
from pathlib import Path

from app.runtime.private_files import make_private_folder
from app.runtime.settings import Settings

_FILE = "signing-secret"
_FORMER_FILE = "cursor-secret"  # written by earlier versions


class SecretUnavailable(OSError):
    """Raised when the file with the secret is gone or cannot be read."""


def make_signing_key(settings: Settings) -> None:
    """Make a secret in a private file, unless there is one; for the start, while the disk has room.

    It is never made later: what was signed until then would be refused without anybody noticing.

    Raises
    ------
    OSError
        If the file can be neither read nor written.
    """
    if settings.signing_secret is None and not _file(settings).exists():
        make_private_folder(settings.data_dir)
        _keep_secret(_file(settings))


def signing_key(settings: Settings) -> bytes:
    """Return the key.

    Raises
    ------
    SecretUnavailable
        If its file is gone or cannot be read.
    """
    if settings.signing_secret is not None:
        return settings.signing_secret.get_secret_value().encode()
    try:
        return _file(settings).read_bytes()
    except OSError as error:
        raise SecretUnavailable(error.errno, error.strerror, error.filename) from error


def _file(settings: Settings) -> Path:
    former = settings.data_dir / _FORMER_FILE
    return former if former.exists() else settings.data_dir / _FILE


def _keep_secret(path: Path) -> None:
    """Write a random secret; linking a finished file is atomic, so several processes agree on one secret."""
    draft = path.with_name(f"{path.name}.{os.getpid()}.{secrets.token_hex(4)}")
    descriptor = os.open(draft, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    with os.fdopen(descriptor, "w", encoding="utf-8") as file:
        file.write(secrets.token_urlsafe(32))
    try:
        path.hardlink_to(draft)
    except FileExistsError:
        pass  # another process was first; use its secret
    finally:
        draft.unlink()
