"""Who asks, and what they may do."""

import re
from dataclasses import dataclass
from enum import StrEnum
from typing import NamedTuple
from uuid import UUID

OWNER_PATTERN = re.compile(r"[A-Za-z0-9][A-Za-z0-9._@-]{0,63}")
"""What the name of an owner looks like."""


class Scope(StrEnum):
    """What a key lets its bearer do with what belongs to its owner."""

    READ = "read"
    SUBMIT = "submit"
    CANCEL = "cancel"


@dataclass(frozen=True, slots=True)
class Caller:
    """Who asks: the owner of everything that they see or make, their scopes, and their key if there are any."""

    owner: str
    scopes: frozenset[Scope]
    key_id: UUID | None = None


class Owned(NamedTuple):
    """A job or batch of an owner by its id; the same id of another owner is missing."""

    owner: str
    id: UUID


LOCAL = Caller("local", frozenset(Scope))
"""The caller of a service without keys, which is open to its own machine only."""
