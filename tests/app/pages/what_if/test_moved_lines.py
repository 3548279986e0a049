from typing import Any

import pytest

from app.pages import examples
from app.pages.measures import SI
from app.pages.what_if.moved_lines import as_job, loops_looked_at, moved_line, speeds_of, to_look
from app.pages.what_if.sliders import sliders

EXPLICIT = examples.line("c11-twin")
DEVICES = [
    {"type": "spacer", "position_m": 60.0, "mass_kg": 6.5, "polar_inertia_kg_m2": 0.4},
    {"type": "detuning_pendulum", "position_m": {"value": 150.0, "unit": "m"}, "mass_kg": 12.0, "arm_m": 0.35},
]


def moved(fields: dict[str, str], **changes: Any) -> dict[str, Any]:
    line = {**examples.line(examples.DRAKE), **changes}
    return moved_line(line, EXPLICIT, sliders(line, EXPLICIT, [12.0], SI), fields)


def test_a_line_that_is_not_moved_stays_what_it_was() -> None:
    assert moved({}) == examples.line(examples.DRAKE)
    found = sliders(EXPLICIT, EXPLICIT, [12.0], SI)
    assert moved_line(EXPLICIT, EXPLICIT, found, {name: slider.text for name, slider in found.items()}) == EXPLICIT


def test_values_are_set_in_the_form_in_which_the_line_is_known() -> None:
    fields = {"tension_everyday_share_of_rated_strength": "25", "ice": "20", "damping_torsional_ratio": "10"}
    made = moved(fields)
    assert made["span"]["everyday"] == {"temperature_c": 15.0, "share_of_rated_strength": 0.25}
    assert made["ice"]["accretion"]["thickness_m"] == 0.02
    assert made["damping"] == {"torsional_ratio": 0.1}


def test_horizontal_damping_keeps_its_ratio_to_the_vertical_one() -> None:
    explicit = {**EXPLICIT, "damping": {"vertical_ratio": 0.001, "horizontal_ratio": 0.002, "torsional_ratio": 0.1}}
    made = moved_line(explicit, explicit, sliders(explicit, explicit, [4.0], SI), {"damping_vertical_ratio": "0.4"})
    assert made["damping"] == {"vertical_ratio": 0.004, "horizontal_ratio": 0.008, "torsional_ratio": 0.1}


def test_what_is_mounted_moves_along_with_the_length() -> None:
    made = moved({"span": "240"}, devices=DEVICES)
    assert [device["position_m"] for device in made["devices"]] == [pytest.approx(48.0), pytest.approx(120.0)]


def test_a_pendulum_is_added_moved_and_taken_away() -> None:
    added = moved({"pendulum_mass": "20", "pendulum_place": "25"})["devices"]
    assert added == [{"type": "detuning_pendulum", "position_m": 75.0, "mass_kg": 20.0, "arm_m": 0.5}]
    kept = moved({"pendulum_place": "10"}, devices=DEVICES)["devices"]
    assert (kept[0], kept[1]["position_m"], kept[1]["mass_kg"]) == (DEVICES[0], 30.0, 12.0)
    assert moved({"pendulum_mass": "0"}, devices=DEVICES)["devices"] == DEVICES[:1]


def test_what_is_looked_at_takes_little() -> None:
    line = examples.line(examples.DRAKE)
    request = {"line": line, "analysis": {**examples.ANALYSIS, "loops": [1, 2, 3], "check": "direct"}}
    made = to_look(request, EXPLICIT, sliders(line, EXPLICIT, [2.0, 12.0], SI), {"wind": "8"})
    assert made["line"]["design_wind_m_per_s"] == 8.0
    assert made["analysis"]["wind_speeds_m_per_s"] == [8.0, 12.0]
    assert (made["analysis"]["models"], made["analysis"]["loops"]) == (["hybrid"], [1, 2])
    assert "check" not in made["analysis"]
    assert loops_looked_at({}) == [1, 2]


def test_a_job_computes_all_that_was_asked_for() -> None:
    line = examples.line(examples.DRAKE)
    request = {"line": line, "analysis": examples.ANALYSIS, "study": {"axes": []}}
    found = sliders(line, EXPLICIT, speeds_of(examples.ANALYSIS), SI)
    assert as_job(request, EXPLICIT, found, {}) == {"line": line, "analysis": examples.ANALYSIS}
    made = as_job(request, EXPLICIT, found, {"wind": "7"})
    assert made["line"]["design_wind_m_per_s"] == 7.0
    assert made["analysis"]["wind_speeds_m_per_s"] == [2.0, 4.0, 6.0, 7.0, 8.0, 10.0, 12.0]
    assert made["analysis"]["models"] == examples.ANALYSIS["models"]
