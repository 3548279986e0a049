"""Addresses of the routes of OGC API - Processes, and links to them."""

BASE = "/ogc"
PROCESS = "galloping"


def link(rel: str, path: str, title: str, media_type: str = "application/json") -> dict[str, str]:
    """Return a link of this service."""
    return {"rel": rel, "href": path, "type": media_type, "title": title}
