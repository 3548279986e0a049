from app import convert
from app.plots import Facts, facts_of
from app.plots.facts import Ellipse, Phase
from app.reference.source_lines import example
from tests.app.plots.drawn_motions import NO_MOTIONS

STATIC = {"sag_m": 6.3, "horizontal_tension_n": 38760.0}
REQUEST = {
    "line": {
        **example("c11-twin"),
        "phases": [
            {"name": "top", "y_m": 7.0, "z_m": 0.5},
            {"name": "b", "y_m": -7.0, "z_m": 0.0, "required_clearance_m": 1.2},
        ],
        "required_clearance_m": 1.5,
    },
    "analysis": {"models": ["hybrid"], "wind_speeds_m_per_s": {"start": 4.0, "stop": 6.0, "count": 3}},
}


def test_the_facts_of_a_line_are_what_its_request_and_static_state_say() -> None:
    facts = facts_of("C11", REQUEST, STATIC, {"physics": [{"physics": "source"}]}, "0.4.0")
    assert facts.bundle[0] == (0.2355 * 6.123233995736766e-17, 0.2355)  # at 90 degrees: downwind
    assert facts.phases == (Phase("top", 7.0, 0.5, 1.5), Phase("b", -7.0, 0.0, 1.2))
    ellipse = convert.ellipse("cigre", 6.3, None, 0.0286, 2)
    assert facts.ellipse == Ellipse(ellipse["major_axis_m"], ellipse["minor_axis_m"], ellipse["b_m"])  # type: ignore[arg-type]
    assert facts.footer == (
        "2 sub-conductors, diameter 28.6 mm, span 125.9 m, sag 6.3 m, horizontal tension 38.8 kN a conductor",
        "wind 4 to 6 m/s (3 speeds), hybrid model, source physics, engine 0.4.0",
    )


def test_a_flat_span_has_no_ellipse() -> None:
    assert facts_of("C11", REQUEST, {**STATIC, "sag_m": 0.5}, NO_MOTIONS, None).ellipse is None


def test_a_request_without_a_line_still_has_a_title() -> None:
    assert facts_of("chunk", {}, None, NO_MOTIONS, "0.4.0") == Facts(
        "chunk", bundle=((0.0, 0.0),), footer=("", "engine 0.4.0")
    )


def test_a_study_names_what_it_varies_and_leaves_that_out_of_the_line() -> None:
    study = {"axes": [{"parameter": "span.length_m", "values": [100.0, 120.0]}]}
    facts = facts_of("C11", {**REQUEST, "study": study}, None, NO_MOTIONS, None)
    assert facts.axes == ("span.length_m",)
    assert facts.footer[0] == "2 sub-conductors, diameter 28.6 mm, varied: span: length"
