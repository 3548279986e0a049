"""The caller of a request and the caller's scopes."""

import re
from dataclasses import dataclass
from enum import StrEnum
from typing import NamedTuple
from uuid import UUID

OWNER_PATTERN = re.compile(r"[A-Za-z0-9][A-Za-z0-9._@-]{0,63}")
"""Pattern of an owner's name."""


class Scope(StrEnum):
    """What a key allows its bearer to do with the owner's data."""

    READ = "read"
    SUBMIT = "submit"
    CANCEL = "cancel"


@dataclass(frozen=True, slots=True)
class Caller:
    """The owner of the data, the scopes of the key, and the id of the key if there is one."""

    owner: str
    scopes: frozenset[Scope]
    key_id: UUID | None = None


class Owned(NamedTuple):
    """A job or batch of an owner by its id; the same id of another owner is missing."""

    owner: str
    id: UUID


LOCAL = Caller("local", frozenset(Scope))
"""The caller while no key exists; the service then answers its own machine only."""
