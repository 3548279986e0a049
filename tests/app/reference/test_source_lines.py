import math

import pytest

from app import schemas
from app.reference.source_lines import EXAMPLE_NAMES, example


@pytest.mark.parametrize("name", EXAMPLE_NAMES)
def test_the_source_lines_are_valid_and_keep_their_figures(name: str) -> None:
    line = schemas.Line.model_validate(example(name))
    assert line.conductor.axial_rigidity == pytest.approx(28418105.784)
    assert line.span.length == 125.88
    assert line.model_dump(mode="json", by_alias=True)["bundle"]["subconductors"] == EXAMPLE_NAMES.index(name) + 1


def test_the_mass_of_the_ice_turns_with_its_shape() -> None:
    at_40, at_270 = (example("c11-single", angle)["ice"] for angle in (40, 270))
    turned = complex(at_270["eccentricity_y_m"], at_270["eccentricity_z_m"])
    ratio = turned / complex(at_40["eccentricity_y_m"], at_40["eccentricity_z_m"])
    assert abs(ratio) == pytest.approx(1.0)
    assert math.degrees(math.atan2(ratio.imag, ratio.real)) % 360.0 == pytest.approx(230.0)
    assert at_270["aerodynamics"]["vertical"][0] == 0.9423
