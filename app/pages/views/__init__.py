"""The addresses of pages: each module answers those of one page, and turns forms into what the API takes."""

from fastapi import APIRouter

from app.pages.views import (
    batches,
    jobs,
    line_form,
    preferences,
    remedy_trials,
    report,
    result,
    sign_in,
    start,
    what_if,
)

__all__ = ["BATCH_FILES", "routers"]

BATCH_FILES = batches.FILES
"""The address that takes files of batches, which may be larger than other bodies."""


def routers() -> tuple[APIRouter, ...]:
    """Return the routers of all pages."""
    return tuple(
        module.router
        for module in (start, batches, jobs, line_form, report, result, what_if, remedy_trials, preferences, sign_in)
    )
