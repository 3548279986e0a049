from dataclasses import replace

import pytest

from engine.spec import (
    CrossSection,
    IceSegment,
    Model,
)
from tests.builders import only, run, source_line


def test_den_hartog_takes_the_smallest_coefficient_on_the_span() -> None:
    line = source_line(2)
    stable = replace(line.ice.aerodynamics, vertical=(1.5, 0.0, 0.0))
    half = replace(line, ice=replace(line.ice, segments=(IceSegment(0.0, 62.94, aerodynamics=stable),)))
    whole = replace(line, ice=replace(line.ice, segments=(IceSegment(0.0, 125.88, aerodynamics=stable),)))
    asked = only(Model.HYBRID, wind_speeds=())
    assert run(half, asked).den_hartog.coefficient == -0.1667
    assert run(whole, asked).den_hartog.coefficient == 1.5
    assert not run(whole, asked).den_hartog.unstable


@pytest.mark.parametrize("section", [None, *CrossSection])
def test_the_section_in_force_stands_beside_the_options(section: CrossSection | None) -> None:
    line, asked = source_line(2), only(Model.HYBRID, wind_speeds=())
    (row,) = run(replace(line, bundle=replace(line.bundle, section=section)), asked).physics
    assert row.section is (section or CrossSection.RIGID)
    single = source_line(1)
    (row,) = run(replace(single, bundle=replace(single.bundle, section=section)), asked).physics
    assert row.section is None
