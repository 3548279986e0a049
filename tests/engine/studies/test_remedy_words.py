"""Remedies in words."""

from typing import Any

from engine.spec import AddedDevices, ChangedTension, DetuningPendulum, Model, MovedDevices, Spacer
from engine.studies.remedy_words import what_is_done, what_it_does
from tests.builders import only, run, source_line

RESULT = run(source_line(1), only(Model.HYBRID, loops=(1,), wind_speeds=()))
NONE: dict[str, float | None] = {"improves": None, "worsens": None}


def row(onset: float | None, motion: float | None, clearance: float | None = None) -> dict[str, Any]:
    return {"onset_m_per_s": onset, "motion_peak_to_peak_m": motion, "gallops": "yes", "clearance_m": clearance}


def test_what_is_done() -> None:
    pendulums = AddedDevices(DetuningPendulum(0.0, 20.0, 0.4), 2)
    text = what_is_done(pendulums, (75.0, 225.5), RESULT, RESULT)
    assert text == "2 detuning pendulums of 20 kg, arm 0.4 m, at 75 and 225.5 m"
    assert what_is_done(pendulums, None, RESULT, RESULT) == "2 detuning pendulums of 20 kg, arm 0.4 m"
    assert what_is_done(MovedDevices(Spacer), (60.0,), RESULT, RESULT) == "1 spacer moved, at 60 m"
    assert what_is_done(ChangedTension(1.2), None, RESULT, RESULT).startswith("1.2 times the tension: 30,000 N")


def test_what_it_does() -> None:
    shares: dict[str, float | None] = {"improves": 0.75, "worsens": 0.0}
    assert what_it_does("better", row(2.0, 1.0), row(2.5, 0.8), shares, None) == (
        "Better: the onset rises from 2.00 to 2.50 m/s, the largest motion falls from 1.00 to 0.80 m peak to peak; "
        "better in 75 % of the samples, worse in 0 %."
    )
    assert "is gone, at rest at the wind speeds" in what_it_does("better", row(2.0, 1.0), row(None, 0.0), NONE, None)
    assert "stays at 2.00 m/s" in what_it_does("worse", row(2.0, 1.0), row(2.01, 1.5), NONE, None)
    assert "line with the remedy" in what_it_does("undecided", row(2.0, 1.0), row(None, None), NONE, None)
    assert "line without it" in what_it_does("undecided", row(None, None), row(2.0, 1.0), NONE, None)
    nearer = what_it_does("no_improvement", row(2.0, 1.0, 5.0), row(2.0, 0.8, 4.5), NONE, None)
    assert nearer.endswith("the smallest clearance falls from 5.00 to 4.50 m.")
    found = what_it_does("no_improvement", row(2.0, 1.0), row(2.0, 1.0), NONE, 31)
    assert found == "No improvement found: none of 31 arrangements is better than nothing; none is proposed."
