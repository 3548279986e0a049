import pytest

from app import schemas


def test_a_range_of_wind_speeds_meets_both_ends() -> None:
    analysis = schemas.Analysis.model_validate({"wind_speeds_m_per_s": {"start": 4.0, "stop": 6.1, "count": 22}})
    speeds = analysis.speeds()
    assert len(speeds) == 22
    assert (speeds[0], speeds[-1]) == (4.0, 6.1)
    assert speeds[1] == pytest.approx(4.1)


def test_a_list_of_wind_speeds_is_taken_as_it_is() -> None:
    assert schemas.Analysis.model_validate({"wind_speeds_m_per_s": [5, 4.5]}).speeds() == (5.0, 4.5)
