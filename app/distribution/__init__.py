"""What the distribution installs as `galloping`: the client of the service, and the lines of the source to try it with.

    from galloping import Client

That needs httpx and pydantic only. The other packages lie beside it in the distribution, as `galloping.app` and so on.
"""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from app.client import Client, JobFailed, NotFound, Refused, ServiceError
    from app.reference.source_lines import EXAMPLE_NAMES, example

__all__ = ["EXAMPLE_NAMES", "Client", "JobFailed", "NotFound", "Refused", "ServiceError", "example"]


def __getattr__(name: str) -> Any:
    """Load a name when it is used: the command line starts without the client."""
    if name not in __all__:
        raise AttributeError(f"module {__name__} has no attribute {name}")
    from app import client  # noqa: PLC0415
    from app.reference import source_lines  # noqa: PLC0415

    return getattr(client if hasattr(client, name) else source_lines, name)
