import math

import pytest

from app import schemas
from app.convert.pointers import json_names, to_pointer
from app.schemas.faults import Fault
from engine import outcome
from tests.app.lines import FULL_LINE

LINE = schemas.Line.model_validate(FULL_LINE)


@pytest.mark.parametrize(
    ("field", "pointer"),
    [
        ("span.horizontal_tension", "/line/span/horizontal_tension_n"),
        ("devices.2.stop", "/line/devices/2/to_m"),
        ("ice.segments.0.eccentricity_y", "/line/ice/segments/0/eccentricity_y_m"),
        ("wind.profile.1.position", "/line/wind/profile/1/position_m"),
        ("bundle.positions", "/line/bundle/positions_m"),
        ("bundle.arrangement", "/line/bundle"),  # a rule of several fields is told of what holds them
        ("devices.9.mass", "/line/devices/9/mass"),
        ("harmonics", "/analysis/harmonics"),
        ("analysis.critical_wind_limit", "/analysis/critical_wind_limit_m_per_s"),
    ],
)
def test_the_engines_names_lead_to_the_contracts_fields(field: str, pointer: str) -> None:
    fault = outcome.Fault(field, None, "must be otherwise")
    assert to_pointer(fault, LINE, schemas.Analysis()) == Fault(pointer, "inconsistent", "must be otherwise")


def test_a_value_is_shown_and_cut() -> None:
    fault = to_pointer(outcome.Fault("span.length", "9" * 200, "must be less"), LINE, None)
    assert fault.detail == f"must be less, got {'9' * 80}"


@pytest.mark.parametrize(("angle", "shown"), [(math.radians(100.0), "100.0"), (math.radians(-12.3), "-12.3")])
def test_an_angle_is_shown_in_the_unit_of_its_field(angle: float, shown: str) -> None:
    fault = to_pointer(outcome.Fault("wind.yaw", angle, "must be less"), LINE, None)
    assert fault == Fault("/line/wind/yaw_deg", "inconsistent", f"must be less, got {shown}")


def test_names_of_the_contract_pass_as_they_are() -> None:
    assert json_names(LINE, ["span", "length_m"]) == ["span", "length_m"]
