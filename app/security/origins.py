"""Where a request comes from: this machine itself, and a program or a page of this service rather than another site's.

Browsers say what a page cannot forge: `Sec-Fetch-Site` to addresses that they trust, such as those of this machine, and
`Origin` with everything that changes something. Programs say neither.
"""

from collections.abc import Collection, Mapping
from urllib.parse import urlsplit

from starlette.types import Scope

from app.runtime.loopback import is_loopback

Headers = Mapping[bytes, bytes]

_FORWARDED = (b"forwarded", b"true-client-ip", b"via", b"x-client-ip", b"x-original-host", b"x-real-ip")
_OWN_SITE = frozenset({b"same-origin", b"none"})  # a page of this very origin, or the person at the browser
_READING = frozenset({"GET", "HEAD"})


def is_from_this_machine(scope: Scope, headers: Headers) -> bool:
    """Tell whether a request comes from this machine and addresses it by a loopback name.

    A proxy on this machine must not forward requests from elsewhere. A page in a local browser must not reach the
    service through a name that resolves to this machine (DNS rebinding).
    """
    server, client = (str((scope.get(end) or ("",))[0]) for end in ("server", "client"))
    # Older nginx speaks HTTP/1.0 to what it forwards to, and adds no field, unless it is told to.
    forwarded = scope.get("http_version") == "1.0" or any(
        name in _FORWARDED or name.startswith(b"x-forwarded") for name in headers
    )
    return is_loopback(server) and is_loopback(client) and is_loopback(_host(headers)) and not forwarded


def is_of_another_site(scope: Scope, headers: Headers, admitted: Collection[str]) -> bool:
    """Tell whether a page of another origin makes a request in a browser, unless the operator admits this origin.

    A person may follow a link to this service: that reads a page, and the page that had the link learns nothing.
    """
    origin = headers.get(b"origin")
    if origin is not None and ("*" in admitted or origin.decode("latin-1") in admitted):
        return False
    if b"sec-fetch-site" in headers:
        return is_told_of_another_site(scope, headers)
    own = f"{scope['scheme']}://".encode() + headers.get(b"host", b"").lower()
    return origin is not None and origin.lower() != own


def is_told_of_another_site(scope: Scope, headers: Headers) -> bool:
    """Tell whether the browser itself says that a page of another origin makes a request.

    Unlike `is_of_another_site`, this also holds behind a proxy that changes `Host`, with which `Origin` is compared.
    """
    visit = headers.get(b"sec-fetch-mode") == b"navigate" and headers.get(b"sec-fetch-dest") == b"document"
    shown = visit and scope["method"] in _READING
    return headers.get(b"sec-fetch-site", b"none") not in _OWN_SITE and not shown


def _host(headers: Headers) -> str:
    try:
        return urlsplit(f"//{headers.get(b'host', b'').decode('latin-1')}").hostname or ""
    except ValueError:
        return ""
