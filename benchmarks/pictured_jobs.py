"""Jobs and a batch for `benchmarks.page_pictures`: one of each kind of page."""

import json
import time
from itertools import pairwise
from math import cos, radians, sin
from typing import Any

import httpx

from app.pages import examples
from app.reference.source_lines import example

_PATIENCE_SECONDS = 300.0
_CLIMATE = {
    "line_azimuth_deg": 60.0,
    "sectors": [
        {"direction_deg": 240.0, "width_deg": 60.0, "share": 0.55, "weibull_shape": 2.1, "weibull_scale_m_per_s": 6.5},
        {"direction_deg": 330.0, "width_deg": 120.0, "share": 0.45, "weibull_shape": 1.8, "weibull_scale_m_per_s": 5.0},
    ],
    "icing": [{"kind": "glaze", "hours_a_year": 30.0, "hours_a_year_lowest": 10.0, "hours_a_year_highest": 60.0}],
}
_HYBRID = {**examples.ANALYSIS, "models": ["hybrid"]}
_LONG = {"loops": [1, 2, 3, 4], "wind_speeds_m_per_s": {"start": 1.0, "stop": 30.0, "count": 200}}
_METRES_A_DEGREE = 111_195.0  # of a meridian
_ANEW = {"Cache-Control": "no-cache"}


def paths(client: httpx.Client) -> dict[str, str]:
    """Compute a job of each kind and a batch, and return the paths of their pages by kind."""
    drake, twin = examples.line(examples.DRAKE), example("c11-twin")
    phases = [{"name": "top", "y_m": 7.0, "z_m": 0.5}, {"name": "earth wire", "y_m": 12.0, "z_m": -1.0}]
    axes = [
        {"parameter": "span.horizontal_tension_n", "values": [24000, 27000, 30000, 33000, 36000]},
        {"parameter": "span.length_m", "values": [110, 120, 130, 140]},
    ]
    documents = {
        "result": {"line": {**drake, "phases": phases, "required_clearance_m": 2.5}, "analysis": examples.ANALYSIS},
        "remedies": {"line": drake, "analysis": _HYBRID, "remedies": {}},
        "risk": {"line": {**drake, "climate": _CLIMATE}, "analysis": _HYBRID},
        "study": {"line": twin, "analysis": {"models": ["hybrid"]}, "study": {"axes": axes}},
    }
    found = {name: _ended(client, "/v1/jobs", json=document) for name, document in documents.items()}
    head = {"Content-Type": "application/geo+json"}
    file, asked = _spans(twin), {"analysis": json.dumps(_HYBRID)}
    found["batch"] = _ended(client, "/v1/batches", params=asked, json=file, headers=head)
    cancelled = _sent(client, "/v1/jobs", json={"line": twin, "analysis": _LONG})
    client.delete(cancelled).raise_for_status()
    return {**found, "cancelled": cancelled.replace("/v1/", "/pages/")}


def under_way(client: httpx.Client) -> str:
    """Submit a job that takes a minute, and return the path of its page."""
    document = {"line": example("c11-quad"), "analysis": _LONG}
    return _sent(client, "/v1/jobs", json=document).replace("/v1/", "/pages/")


def _spans(line: dict[str, Any]) -> dict[str, Any]:
    """Return a line of twelve spans as GeoJSON, each as long as its coordinates say; the last one has a fault."""
    place, towers, lengths = (10.0, 60.0), [(10.0, 60.0)], [105.0 + 8.0 * number for number in range(12)]
    for number, length in enumerate(lengths):
        bearing = radians(60.0 + 35.0 * sin(0.6 * number))
        east, north = length * sin(bearing), length * cos(bearing)
        place = place[0] + east / (_METRES_A_DEGREE * cos(radians(place[1]))), place[1] + north / _METRES_A_DEGREE
        towers.append(place)
    features = []
    for number, (ends, length) in enumerate(zip(pairwise(towers), lengths, strict=True)):
        tags = {"circuit": "north" if number % 3 else "south"}
        span = {**line["span"], "length_m": length, "horizontal_tension_n": -1.0 if number == 11 else 30000.0}
        own = {**line, "name": f"Span {number + 1}", "tags": tags, "span": span}
        geometry = {"type": "LineString", "coordinates": [list(end) for end in ends]}
        features.append({"type": "Feature", "geometry": geometry, "properties": own})
    return {"type": "FeatureCollection", "features": features}


def _sent(client: httpx.Client, path: str, **request: Any) -> str:
    headers = {**_ANEW, **request.pop("headers", {})}
    return str(client.post(path, headers=headers, **request).raise_for_status().headers["location"])


def _ended(client: httpx.Client, path: str, **request: Any) -> str:
    """Send a job or batch, wait for its end, and return the path of its page.

    Raises
    ------
    RuntimeError
        If it ends without a result.
    """
    location, until = _sent(client, path, **request), time.monotonic() + _PATIENCE_SECONDS
    while (state := client.get(location, headers={"Prefer": "wait=10"}).json()["status"]) in {"accepted", "running"}:
        if time.monotonic() > until:
            raise RuntimeError(f"{location} takes too long")
    if state != "successful":
        raise RuntimeError(f"{location} is {state}")
    return location.replace("/v1/", "/pages/")
