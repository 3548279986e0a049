import json
import math
from uuid import UUID

import pytest
from sqlalchemy.orm import Session

from app.pages.drawings.bundles import positions
from app.pages.drawings.device_marks import legend
from app.pages.drawings.orbits import wires
from app.pages.findings import Findings
from app.pages.measures import FEET, SI
from app.pages.motions import Motion, motions, worst
from app.pages.moving import moving, name_of, surroundings
from app.runtime.settings import Settings
from app.storage.database import make_engine, session_factory
from app.tables import Job


@pytest.fixture(scope="module")
def job_and_motion(shared_settings: Settings, known_job: str, found: Findings) -> tuple[Job, Motion]:
    engine = make_engine(shared_settings)
    with session_factory(engine, read_only=True)() as session:
        job = session.get_one(Job, UUID(known_job))
        largest = _largest(session, job, found)
        session.expunge(job)
    engine.dispose()
    return job, largest


def _largest(session: Session, job: Job, found: Findings) -> Motion:
    chosen = worst(motions(session, job, found))
    assert chosen is not None
    return chosen


def test_the_course_has_the_amplitudes_of_its_row(job_and_motion: tuple[Job, Motion]) -> None:
    _, largest = job_and_motion
    half = 0.5 * (max(largest.vertical) - min(largest.vertical))
    assert half == pytest.approx(largest.row["vertical_m"], rel=2e-3)


def test_the_script_gets_the_motion_and_the_shape_of_its_loop(
    job_and_motion: tuple[Job, Motion], found: Findings
) -> None:
    job, largest = job_and_motion
    shown = moving(job, found, largest, SI)
    data = json.loads(shown.data)
    assert data["period"] == pytest.approx(1.0 / largest.row["frequency_hz"])
    assert data["v"] == pytest.approx(largest.vertical, abs=1e-5)
    shape = data["span"]["f"]
    assert shape[0] == pytest.approx(0.0, abs=1e-3)
    assert shape[len(shape) // 2] == pytest.approx(1.0, abs=2e-3)
    assert shown.computed_shape
    assert "moving-side" in str(shown.span)
    assert [name for _, name in shown.legend] == [name for _, name in legend(found.line_here)]
    assert name_of(largest, FEET).startswith(FEET.shown(largest.row["wind_speed_m_per_s"], "m/s"))


def test_the_design_ellipse_is_that_of_the_verdict(found: Findings) -> None:
    around = surroundings(found)
    assert found.verdict is not None
    assert around.ellipse is not None
    assert around.ellipse[0] == pytest.approx(found.verdict["ellipse_peak_to_peak_m"])
    assert around.phases == [("top", (0.0, 7.0), 1.5)]


def test_sub_conductors_move_by_equation_3() -> None:
    motion = Motion(0, {}, {"vertical": [0.1], "horizontal": [0.2], "torsional": [0.01]})
    (first, second) = wires(motion, positions({"subconductors": 2, "radius_m": 0.3, "orientation_deg": 90.0}))
    assert first[0] == pytest.approx((0.3 + 0.2, 0.1 - 0.3 * 0.01))
    assert second[0] == pytest.approx((-0.3 + 0.2, 0.1 + 0.3 * 0.01))
    assert math.isclose(first[0][1] - second[0][1], -0.006)
