"""The interactive page for the API, with its script and style sheet served from here."""

from fastapi import APIRouter, Request
from fastapi.openapi.docs import get_swagger_ui_html
from fastapi.responses import HTMLResponse
from starlette.staticfiles import StaticFiles

import app
from app.http.prefix import prefix_of

ASSETS = "/docs/assets"

router = APIRouter(include_in_schema=False)


@router.get("/docs")
def docs(request: Request) -> HTMLResponse:
    """Return the page, also behind a proxy that adds a prefix to every path."""
    prefix = prefix_of(request.scope)
    return get_swagger_ui_html(
        openapi_url=f"{prefix}/openapi.json",
        title="Galloping of iced conductors",
        swagger_js_url=f"{prefix}{ASSETS}/swagger-ui-bundle.js",
        swagger_css_url=f"{prefix}{ASSETS}/swagger-ui.css",
        swagger_favicon_url="data:,",
        swagger_ui_parameters={"validatorUrl": None},
    )


def assets() -> StaticFiles:
    """Return the application that serves the page's files."""
    return StaticFiles(packages=[(app.__name__, "vendor/swagger-ui")])
