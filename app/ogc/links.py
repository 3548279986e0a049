"""Addresses of the routes of OGC API - Processes, links to them, and the names of what they take."""

BASE = "/ogc"
PROCESS = "galloping"
INPUTS = ("line", "analysis", "study", "placement", "remedies")


def link(rel: str, path: str, title: str, media_type: str = "application/json") -> dict[str, str]:
    """Return a link of this service."""
    return {"rel": rel, "href": path, "type": media_type, "title": title}
