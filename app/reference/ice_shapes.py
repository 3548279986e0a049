"""Ice shapes whose aerodynamic coefficients were read in a named source, with what the source says of them."""

from dataclasses import asdict, dataclass
from typing import Any

from app.reference.source_lines import COEFFICIENTS, DIAMETER_M

_SOURCE = (
    "Galloping of bundle conductor, Table 3 (single conductor): fits to quasi-steady wind loads measured on a section "
    "grown in a freezing rain simulator"
)
_CAVEATS = (
    "The source states neither Reynolds number nor turbulence nor the range of angles of its fit.",
    "Coefficients at rest are not given, so that the relative wind needs assumed ones.",
    "Natural glaze, 171 mm2 on a conductor of 28.6 mm, which resembles a D; other ice has other coefficients.",
    "The angle is the one to which the weight of the ice has turned the section; it holds for that turn only.",
)


@dataclass(frozen=True, slots=True)
class IceShape:
    """Cubic coefficients of one iced sub-conductor at one angle of its ice, and what their source says of them.

    Coefficients per radian of the angle of attack, in wind axes of the section (paper, appendix A); forces are over the
    reference diameter, moments over its square. None where the source says nothing.
    """

    name: str
    title: str
    static_angle_deg: float
    aerodynamics: dict[str, list[float]]
    aerodynamics_at_rest: dict[str, float] | None
    fitted_range_deg: float | None
    reynolds_number: float | None
    reference_diameter_m: float
    reference: str
    source: str
    caveats: tuple[str, ...]

    def listed(self) -> dict[str, Any]:
        """Return the shape as answers and the command line list it."""
        return {**asdict(self), "caveats": list(self.caveats)}


def _c11(angle_deg: int) -> IceShape:
    return IceShape(
        name=f"c11-{angle_deg}",
        title=f"C11, natural glaze from freezing rain, at {angle_deg} degrees",
        static_angle_deg=float(angle_deg),
        aerodynamics={direction: list(row) for direction, row in COEFFICIENTS[angle_deg].items()},
        aerodynamics_at_rest=None,
        fitted_range_deg=None,
        reynolds_number=None,
        reference_diameter_m=DIAMETER_M,
        reference="bare",
        source=_SOURCE,
        caveats=_CAVEATS,
    )


ICE_SHAPES = tuple(_c11(angle) for angle in COEFFICIENTS)


def named(name: str) -> IceShape | None:
    """Return the shape of a name, ignoring case."""
    return next((shape for shape in ICE_SHAPES if shape.name == name.strip().casefold()), None)
