import pytest

from benchmarks.capacity import limit, simulate

FIGURES = {
    "line_worker_ms": 10.0,
    "line_database_ms": 0.5,
    "line_broker_ms": 0.01,
    "line_messages": 0.01,
    "line_log_bytes": 15_000.0,
    "claim_database_ms": 1.0,
    "heartbeat_database_ms": 0.3,
    "sweep_database_ms": 0.6,
}


def test_one_worker_is_as_fast_as_its_own_work_and_what_it_waits_for() -> None:
    found = simulate(FIGURES, workers=1, processors=4)
    assert found.lines_per_s == pytest.approx(1000.0 / (10.0 + 0.5 + 0.01), rel=0.1)
    assert found.database < 0.05


def test_a_database_that_is_full_sets_the_rate() -> None:
    found = simulate(FIGURES, workers=200, processors=2)
    assert found.database == pytest.approx(1.0, abs=0.05)
    assert found.lines_per_s == pytest.approx(2.0 * 1000.0 / 0.5, rel=0.3)
    assert found.lines_per_s < simulate(FIGURES, workers=200, processors=8).lines_per_s
    assert limit(found) == "database"
    assert limit(simulate(FIGURES, workers=10, processors=8)) == "workers"


def test_the_same_seed_gives_the_same_figures() -> None:
    first, again = (simulate(FIGURES, workers=20, processors=4, seed=3) for _ in range(2))
    assert first == again
    assert first != simulate(FIGURES, workers=20, processors=4, seed=4)
