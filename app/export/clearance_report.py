"""Clearances with the columns of the clearance reports that utilities process already."""

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

Row = Mapping[str, Any]

_FROM = {
    "phase": "phase",
    "ahead_span_length": "ahead_span_length_m",
    "galloping_ellipse_method": "method",
    "distance": "distance_m",
    "overlap": "overlap_m",
    "mid_span_sag": "mid_span_sag_m",
    "span_swing_angle": "span_swing_angle_deg",
    "major_axis_length": "major_axis_m",
    "minor_axis_length": "minor_axis_m",
    "b_distance": "b_distance_m",
    "other_phase": "other_phase",
    "loops": "loops",
    "wind_speed": "wind_speed_m_per_s",
    "required": "required_m",
    "margin": "margin_m",
    "ok": "ok",
}
COLUMNS = (
    "structure",
    "set",
    "phase",
    "ahead_span_length",
    "galloping_ellipse_method",
    "distance",
    "overlap",
    "wind_from",
    "mid_span_sag",
    "insulator_swing_angle",
    "span_swing_angle",
    "major_axis_length",
    "minor_axis_length",
    "b_distance",
    "other_phase",
    "loops",
    "wind_speed",
    "required",
    "margin",
    "ok",
)
"""The columns of a report in their order, lengths in m and angles in degrees, and after them what only this one has."""


def report_rows(line: Row, clearances: Iterable[Row]) -> Iterator[dict[str, Any]]:
    """Yield a row of the report for each row of the table `clearances`.

    The structure is the tag `structure` of the line, else its `asset_id`, else its name; the set is its tag `set`. The
    wind blows to the right of somebody who looks from the left support to the right one, so it comes from the left.
    The strings of a single span are springs along the line and have no swing angle.
    """
    tags = line.get("tags") or {}
    structure = tags.get("structure") or line.get("asset_id") or line.get("name")
    for row in clearances:
        known = {name: row.get(column) for name, column in _FROM.items()}
        yield {
            "structure": structure,
            "set": tags.get("set"),
            "wind_from": "left",
            "insulator_swing_angle": None,
        } | known
