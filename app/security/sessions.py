"""Sessions of browsers, made from a key, and the marks that protect forms; signed texts, of which nothing is stored.

A session holds the digest under which the key is stored, so it ends when the key is revoked or expires, at the latest
after some hours. Only the database knows what a digest stands for, and it admits nobody by itself. A mark of a form
holds whose form it is; another site cannot read it, and so cannot send the form in the name of somebody signed in.
"""

from http.cookies import CookieError, SimpleCookie

from itsdangerous import BadSignature, URLSafeTimedSerializer

from app.runtime.settings import Settings
from app.runtime.signing import signing_key

COOKIE = "galloping_session"
LASTS_SECONDS = 12 * 3600


def issue(settings: Settings, digest: str) -> str:
    """Return the text of a session's cookie for the digest of a key."""
    return _serializer(settings, "session").dumps(digest)


def digest_of(settings: Settings, cookies: str) -> str | None:
    """Return the digest of the key of the session in a Cookie header, None without one that is valid."""
    text = _cookie(cookies)
    return None if text is None else _loaded(settings, "session", text)


def form_mark(settings: Settings, whose: str) -> str:
    """Return the mark for the forms of somebody."""
    return _serializer(settings, "form").dumps(whose)


def is_form_mark(settings: Settings, whose: str, mark: str) -> bool:
    """Tell whether this service gave this mark to the same one, not too long ago."""
    return _loaded(settings, "form", mark) == whose


def _cookie(cookies: str) -> str | None:
    try:
        found = SimpleCookie(cookies).get(COOKIE)
    except CookieError:
        return None
    return found.value if found is not None else None


def _loaded(settings: Settings, use: str, text: str) -> str | None:
    try:
        value = _serializer(settings, use).loads(text, max_age=LASTS_SECONDS)
    except BadSignature:
        return None
    return value if isinstance(value, str) else None


def _serializer(settings: Settings, use: str) -> URLSafeTimedSerializer:
    return URLSafeTimedSerializer(signing_key(settings), salt=f"galloping {use}")
