import math

import pytest

from app.pages.lines.line_preview import sag_of


def test_the_sag_is_that_of_a_catenary() -> None:
    line = {"conductor": {"mass_kg_per_m": 2.379}, "span": {"length_m": 125.88, "horizontal_tension_n": 30000.0}}
    parameter = 30000.0 / (2.379 * 9.80665)
    assert sag_of(line) == pytest.approx(parameter * (math.cosh(62.94 / parameter) - 1.0))
    assert sag_of(line) == pytest.approx(1.54, abs=5e-3)
    assert sag_of({"conductor": {"mass_kg_per_m": 2.0}, "span": {"length_m": 100.0, "sag_m": 3.0}}) == 3.0
    by_parameter = {"conductor": {"mass_kg_per_m": 2.0}, "span": {"length_m": 125.88, "catenary_parameter_m": 1285.5}}
    assert sag_of(by_parameter) == pytest.approx(1.541, abs=2e-3)
