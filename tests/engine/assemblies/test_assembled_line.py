"""Sections as assemblies of spans."""

import numpy as np
import pytest

from engine.assemblies.assembled_line import assembled_section, product_along
from engine.mechanics.finite_elements import FIELDS
from tests.builders import THREE_SPANS, section_line


def test_a_section_has_its_spans_as_members() -> None:
    whole = assembled_section(section_line(THREE_SPANS, interest=2))
    assert [line.span.length for line in whole.members.lines] == list(THREE_SPANS)
    assert whole.interest == 1
    assert whole.assembly.stiffness.shape == (3 * FIELDS * 21,) * 2
    assert whole.assembly.ties.shape[0] == 4


def test_a_product_is_integrated_along_the_arcs() -> None:
    whole = assembled_section(section_line(THREE_SPANS))
    wave = np.broadcast_to(np.sin(np.pi * np.linspace(0.0, 1.0, 21)), (3, 2, 21))
    assert product_along(whole, wave, wave)[:, 0] == pytest.approx(0.5 * whole.members.profile.arc_length, rel=1e-4)
