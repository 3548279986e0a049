"""Compute the mode shapes of a request's line at one point, as plain rows for a picture."""

from collections.abc import Mapping
from typing import Any

from app.convert.run import specification_of_point

_COMPONENTS = ("longitudinal", "vertical", "horizontal", "torsional")


def mode_shapes(document: Mapping[str, object], point: int) -> list[dict[str, Any]]:
    """Return one row for each model, direction and number of loops of the analysis, at one point of the study.

    A row has `model`, `direction`, `loops`, `position_m` and the four components at these positions, scaled as in
    `engine.models.mode_shapes`.

    Raises
    ------
    ValueError, ArithmeticError
        If the line at this point is not valid or its computation fails.
    LookupError
        If there is no such point.
    """
    # The API and `galloping --help` need no solver.
    from engine.assemblies.section_mode_shapes import section_mode_shapes  # noqa: PLC0415
    from engine.models.mode_shapes import mode_shapes as compute  # noqa: PLC0415

    line, analysis = specification_of_point(document, point)
    found = compute(line, analysis) if line.section is None else section_mode_shapes(line, analysis)
    return [
        {
            "model": model.value,
            "direction": direction,
            "loops": loops,
            "position_m": found.position.tolist(),
            **dict(zip(_COMPONENTS, getattr(found, model.value)[i, j].tolist(), strict=True)),
        }
        for model in analysis.models
        for i, direction in enumerate(_COMPONENTS[1:])
        for j, loops in enumerate(analysis.loops)
    ]
