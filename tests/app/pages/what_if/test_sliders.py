from typing import Any

import pytest

from app.pages import examples
from app.pages.measures import FEET, SI
from app.pages.what_if.sliders import Slider, moves, sliders

EXPLICIT = examples.line("c11-twin")


def of_drake(**changes: Any) -> dict[str, Slider]:
    line = {**examples.line(examples.DRAKE), **changes}
    return sliders(line, EXPLICIT, [4.0, 12.0], SI)


def test_a_line_of_an_engineer_is_moved_in_its_own_forms() -> None:
    found = of_drake()
    shown = {name: slider.shown for name, slider in found.items()}
    assert shown == {
        "wind": "12.0 m/s",
        "tension_everyday_share_of_rated_strength": "20.0 %",
        "span": "300 m",
        "ice": "12.0 mm",
        "damping_vertical_ratio": "0.0515 %",
        "damping_torsional_ratio": "30.8 %",
        "pendulum_mass": "0 kg",
        "pendulum_place": "50.0 %",
        "pendulum_arm": "0.500 m",
    }
    assert all(slider.low <= slider.value <= slider.high for slider in found.values())


def test_an_explicit_line_has_no_thickness_and_is_moved_by_its_tension() -> None:
    found = sliders(EXPLICIT, EXPLICIT, [4.0], SI)
    assert found["tension_horizontal_tension_n"].value == 30000.0
    assert not {"ice", "ice_mass"} & found.keys()
    assert found["wind"].high == 20.0


def test_the_length_of_a_section_s_span_stays() -> None:
    assert "span" not in of_drake(section={"spans": []})


def test_sliders_are_in_the_units_of_the_reader_and_move_in_si() -> None:
    line = examples.line(examples.DRAKE)
    found = sliders(line, EXPLICIT, [12.0], FEET)
    assert found["span"].unit == "ft"
    assert found["span"].value == pytest.approx(984.25, abs=0.01)
    assert found["ice"].shown == "0.472 in"
    moved = moves(found, {"span": "1000", "ice": found["ice"].text, "pendulum_place": "25"})
    assert moved == {"span": pytest.approx(304.8), "pendulum_place": 0.25}


@pytest.mark.parametrize("text", ["", None, "twelve", "nan", "1e9", "-3"])
def test_what_is_no_number_in_bounds_moves_nothing(text: str | None) -> None:
    assert of_drake()["ice"].moved_to(text) is None


def test_a_pendulum_of_the_line_is_where_it_hangs() -> None:
    device = {"type": "detuning_pendulum", "position_m": 75.0, "mass_kg": 12.0, "arm_m": 0.35}
    found = of_drake(devices=[device])
    assert [found[f"pendulum_{name}"].value for name in ("mass", "place", "arm")] == [12.0, 25.0, 0.35]
