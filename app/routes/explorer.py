"""The page on which the interface is read and tried, with its script and style sheet from here alone."""

from fastapi import APIRouter, Request
from fastapi.openapi.docs import get_swagger_ui_html
from fastapi.responses import HTMLResponse
from starlette.staticfiles import StaticFiles

ASSETS = "/docs/assets"

router = APIRouter(include_in_schema=False)


@router.get("/docs")
def docs(request: Request) -> HTMLResponse:
    """Return the page, also behind a proxy that puts a path before every address."""
    before = request.scope.get("root_path", "").rstrip("/")
    return get_swagger_ui_html(
        openapi_url=f"{before}/openapi.json",
        title="Galloping of iced conductors",
        swagger_js_url=f"{before}{ASSETS}/swagger-ui-bundle.js",
        swagger_css_url=f"{before}{ASSETS}/swagger-ui.css",
        swagger_favicon_url="data:,",
        swagger_ui_parameters={"validatorUrl": None},
    )


def assets() -> StaticFiles:
    """Return the application that serves the page's files."""
    return StaticFiles(packages=[("app", "vendor/swagger-ui")])
