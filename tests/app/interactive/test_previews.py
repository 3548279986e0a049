import asyncio
from collections.abc import Coroutine
from typing import Any

import pytest

from app import convert, schemas
from app.convert import PointResult
from app.interactive import Busy, Previews, TakesTooLong
from app.reference.source_lines import example

QUICK = {"loops": [1], "models": ["hybrid"], "wind_speeds_m_per_s": [4.0]}
SLOW = {"loops": [1, 2, 3], "wind_speeds_m_per_s": {"start": 2.0, "stop": 20.0, "count": 200}}


def kept(analysis: dict[str, Any]) -> dict[str, Any]:
    return schemas.JobRequest.model_validate({"line": example("c11-twin"), "analysis": analysis}).kept()


def run(steps: Coroutine[Any, Any, Any]) -> Any:
    return asyncio.run(steps)


def test_a_preview_is_what_a_job_computes() -> None:
    (expected,) = (item for item in convert.run(kept(QUICK)) if isinstance(item, PointResult))
    found = run(Previews(60.0).compute("owner", kept(QUICK)))
    assert found.tables == expected.tables
    assert found.static == expected.static


def test_a_line_that_takes_too_long_is_ended_and_the_next_one_computed() -> None:
    async def main() -> PointResult:
        previews = Previews(0.02)
        with pytest.raises(TakesTooLong):
            await previews.compute("owner", kept(SLOW))
        previews.seconds = 60.0
        return await previews.compute("owner", kept(QUICK))

    assert run(main()).tables["limit_cycles"]


def test_an_owner_with_two_previews_is_refused_a_third_and_others_are_not() -> None:
    async def main() -> list[Any]:
        previews = Previews(60.0)
        calls = [previews.compute(owner, kept(QUICK)) for owner in ("one", "one", "one", "two")]
        return await asyncio.gather(*calls, return_exceptions=True)

    assert [type(answer) for answer in run(main())] == [PointResult, PointResult, Busy, PointResult]


def test_no_more_than_eight_wait() -> None:
    async def main() -> list[Any]:
        previews = Previews(60.0)
        calls = [previews.compute(f"owner {number}", kept(QUICK)) for number in range(10)]
        answers = await asyncio.gather(*calls, return_exceptions=True)
        return [*answers, await previews.compute("owner 9", kept(QUICK))]

    assert [type(answer) for answer in run(main())] == [*[PointResult] * 8, Busy, Busy, PointResult]
