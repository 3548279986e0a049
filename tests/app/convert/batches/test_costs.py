from app import convert
from app.convert import estimate, read_analysis, seconds_a_line
from app.reference.source_lines import example
from app.routes.own_documentation import KNOWN_LINE
from tests.app.lines import SHORT


def test_estimated_cost_grows_with_what_is_asked() -> None:
    asked = [
        {"loops": [1], "models": ["hybrid"], "wind_speeds_m_per_s": [4.0]},
        {"loops": [1, 2], "models": ["hybrid"], "wind_speeds_m_per_s": [4.0, 5.0]},
        {"loops": [1, 2], "models": ["hybrid", "finite_element"], "finite_element_loops": []},
        {"loops": [1, 2]},
        {"loops": [1, 2], "static_twist": "solved"},
        {"loops": [1, 2], "static_twist": "solved", "loop_competition": "checked"},
        {"loops": [1, 2], "static_twist": "solved", "loop_competition": "checked", "device_effect": "reported"},
        {"loops": [1, 2], "models": ["hybrid"], "check": "direct"},
        {"loops": [1, 2], "check": "direct"},
    ]
    costs = [seconds_a_line(read_analysis(document)) for document in asked]
    assert costs == sorted(set(costs))
    assert costs[3] > 10.0 * costs[1]


def test_estimated_cost_knows_what_physics_costs() -> None:
    asked = {"loops": [1, 2], "models": ["hybrid"], "wind_speeds_m_per_s": [4.0, 5.0]}
    source, unsaid, full, unexpanded, table = (
        seconds_a_line(read_analysis({**asked, **physics}))
        for physics in (
            {"physics": "source"},
            {},
            {"physics": "full"},
            {"physics": "full", "aerodynamic_load": "unexpanded"},
            {"aerodynamic_model": "table"},
        )
    )
    assert source < unsaid == full  # whose lines may or may not have the data for it
    assert unexpanded > 10.0 * full
    assert full < table < unexpanded
    assert seconds_a_line(read_analysis({**asked, "physics": "source", "stretching": "included"})) == full
    assert seconds_a_line(read_analysis({**asked, "closure": "published"})) == source


def test_samples_cost_as_many_lines_more() -> None:
    few, many = (seconds_a_line(read_analysis({**SHORT, "uncertainty": {"samples": samples}})) for samples in (0, 128))
    assert few == seconds_a_line(read_analysis(SHORT))
    assert many > 128 * few


def estimated(document: dict[str, object]) -> float | None:
    return estimate(convert.read(convert.explicit_request(document))).seconds


def test_a_study_costs_a_line_for_each_point_and_an_assumed_line_its_samples() -> None:
    line, axis = example("c11-twin"), {"parameter": "span.horizontal_tension_n", "values": [24000, 30000, 36000]}
    single = estimated({"line": line, "analysis": SHORT})
    assert single == seconds_a_line(read_analysis(SHORT))
    assert estimated({"line": line, "analysis": SHORT, "study": {"axes": [axis]}}) == 3 * single
    assumed = estimated({"line": KNOWN_LINE, "analysis": SHORT})
    assert assumed == estimated({"line": KNOWN_LINE, "analysis": {**SHORT, "uncertainty": {"samples": 64}}})
    assert assumed is not None
    assert assumed > 64 * single


def test_what_a_search_costs_is_not_known() -> None:
    assert estimated({"line": example("c11-twin"), "analysis": SHORT, "remedies": {}}) is None
