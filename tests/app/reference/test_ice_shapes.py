import pytest

from app.reference.ice_shapes import ICE_SHAPES, named
from app.reference.source_lines import example
from app.schemas import Aerodynamics

# Paper Table 3, single conductor, in the order of its rows: a_y, a_z, a_theta of i = 1, 2, 3.
TABLE_3 = {
    40.0: ((-0.1667, 0.8605, -0.7272), (-4.0547, 0.8325, 0.2935), (8.3581, 1.7815, 5.9704)),
    270.0: ((0.9423, 1.3186, -0.8567), (-0.9245, -3.2000, 0.9026), (2.6352, -13.0623, -0.2353)),
}


def test_the_shapes_have_the_coefficients_of_the_source() -> None:
    found = {
        shape.static_angle_deg: tuple(
            zip(*(shape.aerodynamics[d] for d in ("vertical", "horizontal", "torsional")), strict=True)
        )
        for shape in ICE_SHAPES
    }
    assert found == TABLE_3


@pytest.mark.parametrize("shape", ICE_SHAPES)
def test_a_shape_fits_into_a_line(shape: object) -> None:
    assert hasattr(shape, "aerodynamics")
    Aerodynamics.model_validate(shape.aerodynamics)


def test_the_reference_diameter_is_that_of_the_source_line() -> None:
    assert {shape.reference_diameter_m for shape in ICE_SHAPES} == {example("c11-twin")["conductor"]["diameter_m"]}


def test_a_shape_is_found_by_its_name() -> None:
    shape = named(" C11-270")
    assert shape is not None
    assert shape.static_angle_deg == 270.0
    assert named("c11") is None
