"""The parts of the page of a result that take more than showing a row."""

import json
from collections.abc import Mapping, Sequence
from typing import Any

from markupsafe import Markup

from app.convert import TABLES
from app.pages import tornado
from app.pages.drawings.orbits import orbit_picture
from app.pages.findings import Findings, Row
from app.pages.measures import Units
from app.pages.motions import Motion, worst
from app.pages.moving import name_of, surroundings
from app.pages.shown_tables import ADDRESSES, ShownTable, shown_table
from app.pages.wording import words
from app.plots import PICTURES, drawable
from app.tables import Job

_MOST_ROWS = 200  # the downloads have all of them
_COLUMNS = {
    "critical_wind_speeds": ("wind_speed_m_per_s", "crossing", "type", "direction", "frequency_hz", "model", "loops"),
    "limit_cycles": (
        "wind_speed_m_per_s",
        "vertical_m",
        "horizontal_m",
        "torsional_rad",
        "kind",
        "stability",
        "frequency_hz",
        "model",
        "loops",
        "outcome",
    ),
    "bifurcations": ("wind_speed_m_per_s", "type", "frequency_hz", "second_frequency_hz", "model", "loops"),
    "tensions": (
        "wind_speed_m_per_s",
        "smallest_at_support_n",
        "largest_at_support_n",
        "largest_share_of_rated_strength",
        "kind",
        "stability",
        "model",
        "loops",
    ),
    "clearances": (
        "other_phase",
        "method",
        "loops",
        "wind_speed_m_per_s",
        "distance_m",
        "required_m",
        "margin_m",
        "ok",
        "together",
    ),
    "model_comparisons": (
        "wind_speed_m_per_s",
        "loops",
        "hybrid_vertical_m",
        "finite_element_vertical_m",
        "hybrid_horizontal_m",
        "finite_element_horizontal_m",
        "finite_element_stability",
        "amplitude_difference",
    ),
    "frequencies": ("model", "loops", "vertical_hz", "horizontal_hz", "torsional_hz", "outcome"),
    "remedies": (
        "what",
        "gallops",
        "onset_m_per_s",
        "vertical_peak_to_peak_m",
        "clearance_margin_m",
        "static_tension_n",
        "rank",
        "sentence",
    ),
    "risk": (
        "ice",
        "thickness_m",
        "loops",
        "hours_a_year",
        "hours_lowest",
        "hours_highest",
        "probability_a_year",
        "model",
    ),
}


def parts(job: Job, found: Findings, units: Units, seen: Sequence[Motion]) -> dict[str, Any]:
    """Return the values of the template beside the job, what it found, and the motions of which courses are stored."""
    return {
        "chart_words": json.dumps(vars(words().chart)),
        "downloads": [(ADDRESSES[name], TABLES[name].title.partition(";")[0]) for name in TABLES if found.rows(name)],
        "pictures": [(name, PICTURES[name].title) for name in drawable(found.tables, study=len(found.points) > 1)],
        "job_tags": {tag.key: tag.value for tag in job.tags},
        **findings_parts(found, units, seen),
    }


def findings_parts(found: Findings, units: Units, seen: Sequence[Motion]) -> dict[str, Any]:
    """Return the values that pages and reports share: what was found, in the units of the reader."""
    largest = worst(seen)
    return {
        "largest": None if largest is None else _largest(found, largest, units),
        "facts": facts(found, units),
        "assumed": [row for row in found.rows("assumptions") if row["origin"] == "assumed"],
        "known": [row for row in found.rows("assumptions") if row["origin"] != "assumed"],
        "tornado": tornado.bars(
            found.rows("sensitivities"), units, {row["path"]: row["unit"] for row in found.rows("assumptions")}
        ),
        "physics": next(iter(found.rows("physics")), {}),
        "shown": {name: _table(name, found, units) for name in _COLUMNS if found.rows(name)},
        "spread": next((row for row in found.rows("uncertainty") if row["wind_speed_m_per_s"] is None), None),
    }


def facts(found: Findings, units: Units) -> Sequence[tuple[str, str]]:
    """Return the figures beside the verdict, those that are known."""
    verdict: Row = found.verdict or {}
    static: Mapping[str, Any] = found.here["static"] or {}
    said = words().facts
    given: Sequence[tuple[str, object, str | None]] = (
        (said.onset, verdict.get("onset_m_per_s"), "m/s"),
        (said.worst_wind, verdict.get("worst_wind_m_per_s"), "m/s"),
        (said.worst_loops, verdict.get("worst_loops"), None),
        (said.vertical, verdict.get("vertical_peak_to_peak_m"), "m"),
        (said.horizontal, verdict.get("horizontal_peak_to_peak_m"), "m"),
        (said.ellipse, verdict.get("ellipse_peak_to_peak_m"), "m"),
        (said.tension_range, verdict.get("tension_range_n"), "N"),
        (said.clearance, verdict.get("clearance_m"), "m"),
        (said.probability, verdict.get("probability_gallops"), "1"),
        (said.tension, static.get("horizontal_tension_n"), "N"),
        (said.sag, static.get("sag_m"), "m"),
    )
    return [(name, units.shown(value, si)) for name, value, si in given if value is not None]


def _largest(found: Findings, motion: Motion, units: Units) -> tuple[str, Markup]:
    """Return the name of the motion that the verdict is about, and its picture."""
    name = name_of(motion, units)
    title = words().motion.orbit_title.format(name=name)
    return name, orbit_picture(motion, surroundings(found), units, title)


def _table(name: str, found: Findings, units: Units) -> ShownTable:
    rows = found.rows(name)
    if name == "limit_cycles":  # rest is in the verdict, and in the download
        rows = [row for row in rows if row["kind"] != "equilibrium"]
    return shown_table(name, _COLUMNS[name], rows[:_MOST_ROWS], units)
