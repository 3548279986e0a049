from app.convert import TABLES
from app.pages.findings import Findings
from app.pages.measures import FEET, SI
from app.pages.result_parts import facts, parts
from app.tables import Job


def test_facts_are_those_of_the_verdict_in_the_units_of_the_reader(found: Findings) -> None:
    assert found.verdict is not None
    metric = dict(facts(found, SI))
    assert metric["Vertical, peak to peak"] == SI.shown(found.verdict["vertical_peak_to_peak_m"], "m")
    assert metric["Sag"].endswith(" m")
    assert dict(facts(found, FEET))["Gallops from"].endswith(" mph")


def test_parts_hold_what_was_found_and_a_download_for_each_table(found: Findings) -> None:
    made = parts(Job(tags=[]), found, SI, [])
    assert {row["origin"] for row in made["assumed"]} == {"assumed"}
    assert len(made["assumed"]) + len(made["known"]) == len(found.rows("assumptions"))
    assert {"critical_wind_speeds", "limit_cycles", "tensions", "clearances"} <= made["shown"].keys()
    assert len(made["downloads"]) == sum(1 for name in TABLES if found.rows(name))
    kinds = [row[4] for row in made["shown"]["limit_cycles"].rows]
    assert "equilibrium" not in kinds
