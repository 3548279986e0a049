"""FastAPI dependencies of the routes: settings, sessions, the caller, and whether stored results may be reused."""

from typing import Annotated

from fastapi import Depends, Header, Request
from sqlalchemy.orm import Session, sessionmaker

from app.http.problems import invalid_document
from app.jobs.dispatch import Sender
from app.runtime.settings import Settings
from app.schemas.faults import Fault
from app.security import webhook_addresses
from app.security.caller import Caller
from app.security.webhook_addresses import RefusedAddress

PREFIX = "/v1"
RETRY_SECONDS = "1"


# The dependencies are coroutines: FastAPI would call a plain function in a thread for every request.
async def _settings(request: Request) -> Settings:
    settings: Settings = request.app.state.settings
    return settings


async def _readers(request: Request) -> sessionmaker[Session]:
    factory: sessionmaker[Session] = request.app.state.readers
    return factory


async def _writers(request: Request) -> sessionmaker[Session]:
    factory: sessionmaker[Session] = request.app.state.writers
    return factory


async def _sender(request: Request) -> Sender:
    sender: Sender = request.app.state.sender
    return sender


async def _caller(request: Request) -> Caller:
    caller: Caller = request.state.caller  # set by app.security.gate
    return caller


SettingsOf = Annotated[Settings, Depends(_settings)]
Readers = Annotated[sessionmaker[Session], Depends(_readers)]
Writers = Annotated[sessionmaker[Session], Depends(_writers)]
SenderOf = Annotated[Sender, Depends(_sender)]
CallerOf = Annotated[Caller, Depends(_caller)]


async def _may_reuse(
    cache_control: Annotated[
        str,
        Header(
            description="`no-cache` computes everything anew, even if results of the same input are stored",
            examples=["no-cache"],
        ),
    ] = "",
) -> bool:
    return "no-cache" not in cache_control.lower()


MayReuse = Annotated[bool, Depends(_may_reuse)]


async def vet_webhook(settings: Settings, url: str, pointer: str = "/webhook_url") -> None:
    """Check that webhooks may go to an address, which a document gives at a pointer.

    Raises
    ------
    ProblemError
        422 if they may not.
    """
    try:
        await webhook_addresses.vet(url, private=settings.webhook_private_networks)
    except RefusedAddress as error:
        raise invalid_document([Fault(pointer, "refused_address", str(error))]) from error
