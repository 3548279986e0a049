"""The page on which the interface is read and tried, with its script and style sheet from here alone."""

from fastapi import APIRouter
from fastapi.openapi.docs import get_swagger_ui_html
from fastapi.responses import HTMLResponse
from starlette.staticfiles import StaticFiles

ASSETS = "/docs/assets"

router = APIRouter(include_in_schema=False)


@router.get("/docs")
def docs() -> HTMLResponse:
    """Return the page."""
    return get_swagger_ui_html(
        openapi_url="/openapi.json",
        title="Galloping of iced conductors",
        swagger_js_url=f"{ASSETS}/swagger-ui-bundle.js",
        swagger_css_url=f"{ASSETS}/swagger-ui.css",
        swagger_favicon_url="data:,",
        swagger_ui_parameters={"validatorUrl": None},
    )


def assets() -> StaticFiles:
    """Return the application that serves the page's files."""
    return StaticFiles(packages=[("app", "vendor/swagger-ui")])
