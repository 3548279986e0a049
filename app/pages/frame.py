"""What every page has: its templates, the words and addresses that they use, its headers, and the page of a problem."""

import json
from collections.abc import Callable, Mapping
from functools import cache
from typing import Any
from urllib.parse import quote

from fastapi import Request, Response
from fastapi.responses import HTMLResponse, RedirectResponse
from jinja2 import Environment, PackageLoader, StrictUndefined

from app.convert import ENGINE_VERSION
from app.http.prefix import path_of, prefix_of
from app.http.problems import ProblemError, ProblemKind
from app.pages import assets, measures
from app.pages.wording import word_for, words
from app.runtime.signing import SecretUnavailable
from app.security import sessions
from app.security.caller import LOCAL, Caller
from app.security.origins import is_told_of_another_site

POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; connect-src 'self'; "
    "base-uri 'none'; form-action 'self'; frame-ancestors 'none'"
)
"""The Content-Security-Policy of pages: no script or style but from files of this service."""

THEMES = ("system", "light", "dark")
_SCRIPTS = json.dumps({"allowEval": False, "includeIndicatorStyles": False, "selfRequestsOnly": True})


def page(
    request: Request, template: str, status: int = 200, *, headers: Mapping[str, str] | None = None, **values: Any
) -> HTMLResponse:
    """Return a page, or a part of one, from a template.

    Templates find `words` (the texts), `units`, `address(path)` (behind the prefix of a proxy), `asset(name)`,
    `form_mark` (the field `mark` of every form that is posted), `theme`, `here` and `signed_in`, beside `values`.
    """
    text = _templates().get_template(template).render(**_common(request), **values)
    return HTMLResponse(text, status, {"Content-Security-Policy": POLICY, "Vary": "Accept, Cookie", **(headers or {})})


def rendered(template: str, **values: Any) -> str:
    """Return the text of a template that is no page of the frame."""
    return _templates().get_template(template).render(**values)


def moved(request: Request, path: str) -> RedirectResponse:
    """Return the answer to a form that leads to another page; scripts and plain browsers follow it alike."""
    return RedirectResponse(address(request)(path), 303)


def address(request: Request) -> Callable[[str], str]:
    """Return the function that puts the prefix of a proxy before a path of this service."""
    prefix = prefix_of(request.scope)
    return lambda path: prefix + path


def wants_page(request: Request) -> bool:
    """Tell whether a browser asks, and not a program."""
    return "text/html" in request.headers.get("accept", "")


def caller_of(request: Request) -> Caller:
    """Return the caller that the gate found, or the one without keys at addresses that are open to everybody."""
    caller: Caller = getattr(request.state, "caller", LOCAL)
    return caller


def units_of(request: Request) -> measures.Units:
    """Return the units in which the reader wants numbers."""
    return measures.BY_NAME.get(request.cookies.get("galloping_units", ""), measures.SI)


def check_form(request: Request, fields: Mapping[str, str]) -> None:
    """Check that a form comes from a page of this service that the same caller read.

    Raises
    ------
    ProblemError
        403 if it does not.
    """
    marked = sessions.is_form_mark(request.app.state.settings, _whose(request), fields.get("mark", ""))
    if not marked or is_told_of_another_site(request.scope, dict(request.scope["headers"])):
        raise ProblemError(ProblemKind.FORBIDDEN, words().problem.old_form)


def shown_problem(request: Request, problem: ProblemError) -> Response | None:
    """Return the page that explains a problem, where a person asked for a page; lead to the sign-in without a key."""
    path = path_of(request.scope)
    if not (path == "/" or path.startswith("/pages/")) or not wants_page(request):
        return None
    if problem.kind is ProblemKind.UNAUTHENTICATED:
        back = path if request.method == "GET" else "/"
        return moved(request, f"/pages/sign-in?back={quote(back)}")
    said = words().problem
    hint = getattr(said, problem.kind.slug.replace("-", "_"), said.other)
    try:
        return page(request, "problem.html", problem.status_code, headers=problem.headers, problem=problem, hint=hint)
    except SecretUnavailable:  # every page has a form, whose mark cannot be made
        return None


def _common(request: Request) -> dict[str, Any]:
    theme = request.cookies.get("galloping_theme", "")
    return {
        "words": words(),
        "units": units_of(request),
        "address": address(request),
        "asset": lambda name: address(request)(assets.address(name)),
        "form_mark": sessions.form_mark(request.app.state.settings, _whose(request)),
        "theme": theme if theme in THEMES else THEMES[0],
        "themes": THEMES,
        "here": path_of(request.scope) + (f"?{request.url.query}" if request.url.query else ""),
        "signed_in": caller_of(request).owner if caller_of(request).key_id is not None else None,
        "version": ENGINE_VERSION,
        "script_settings": _SCRIPTS,
    }


def _whose(request: Request) -> str:
    caller = caller_of(request)
    return f"{caller.owner} {caller.key_id}"


@cache
def _templates() -> Environment:
    found = Environment(
        loader=PackageLoader(__package__),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        auto_reload=False,
    )
    found.globals["word_for"] = word_for
    found.globals["all_units"] = list(measures.BY_NAME.values())
    return found
