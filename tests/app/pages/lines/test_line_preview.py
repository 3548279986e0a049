import math
from typing import Any

import pytest

from app.convert.known import OwnRows
from app.pages import examples
from app.pages.lines.line_preview import preview_of_sound_rows, sag_of
from app.pages.measures import SI


def test_the_sag_is_that_of_a_catenary() -> None:
    line = {"conductor": {"mass_kg_per_m": 2.379}, "span": {"length_m": 125.88, "horizontal_tension_n": 30000.0}}
    parameter = 30000.0 / (2.379 * 9.80665)
    assert sag_of(line) == pytest.approx(parameter * (math.cosh(62.94 / parameter) - 1.0))
    assert sag_of(line) == pytest.approx(1.54, abs=5e-3)
    assert sag_of({"conductor": {"mass_kg_per_m": 2.0}, "span": {"length_m": 100.0, "sag_m": 3.0}}) == 3.0
    by_parameter = {"conductor": {"mass_kg_per_m": 2.0}, "span": {"length_m": 125.88, "catenary_parameter_m": 1285.5}}
    assert sag_of(by_parameter) == pytest.approx(1.541, abs=2e-3)


def request_with(**parts: Any) -> dict[str, Any]:
    return {"line": {**examples.line(examples.DRAKE), **parts}}


SPACER = {"type": "spacer", "position_m": 60.0, "mass_kg": 6.5, "polar_inertia_kg_m2": 0.4}
BAD_SECTION = {"spans": [{"length_m": 300.0}, {"length_m": 250.0}], "strings": []}


@pytest.mark.parametrize(
    ("parts", "pointer", "drawn"),
    [
        ({"devices": [{"type": "spacer", "position_m": 1.0}, SPACER]}, "/line/devices/0/mass_kg", 1),
        ({"devices": [{**SPACER, "position_m": 400.0}, SPACER]}, "/line/devices/0/position_m", 1),
        ({"devices": [SPACER], "section": BAD_SECTION}, "/line/section/strings", 1),
        ({"devices": [SPACER], "climate": {"sectors": []}}, "/line/climate/line_azimuth_deg", 1),
        ({"devices": [SPACER], "phases": [{"y_m": 7.0}]}, "/line/phases/0/name", 1),
    ],
)
def test_rows_at_fault_are_left_out_of_the_drawing(parts: dict[str, Any], pointer: str, drawn: int) -> None:
    shown, faults = preview_of_sound_rows(request_with(**parts), OwnRows(), SI)
    assert shown is not None
    assert pointer in [fault.pointer for fault in faults]
    assert str(shown.span.picture).count('class="device"') == drawn


def test_a_line_at_fault_is_not_drawn() -> None:
    wrong = request_with(span={"length_m": -1.0}, devices=[{"type": "spacer"}])
    shown, faults = preview_of_sound_rows(wrong, OwnRows(), SI)
    assert shown is None
    assert {"/line/span/length_m", "/line/devices/0/mass_kg"} <= {fault.pointer for fault in faults}


def test_faults_that_show_only_without_other_rows_have_the_numbers_of_the_form() -> None:
    rows = [
        {"type": "spacer"},
        SPACER,
        {**SPACER, "position_m": 400.0},
        {"type": "spacer"},
        {**SPACER, "position_m": 70.0},
    ]
    shown, faults = preview_of_sound_rows(request_with(devices=rows), OwnRows(), SI)
    assert shown is not None
    assert str(shown.span.picture).count('class="device"') == 2
    assert {fault.pointer.split("/")[3] for fault in faults} == {"0", "2", "3"}
    assert faults[-1].pointer == "/line/devices/2/position_m"
