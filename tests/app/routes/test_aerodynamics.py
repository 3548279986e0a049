import httpx
import pytest

from app import schemas
from app.reference.source_lines import example
from app.routes.reference_documentation import FIT, FIT_REQUEST
from tests.app.lines import faults

ADDRESS = "/v1/aerodynamics/fit"


def test_the_example_of_the_documentation_is_what_the_service_answers(shared_client: httpx.Client) -> None:
    answer = shared_client.post(ADDRESS, json=FIT_REQUEST)
    assert answer.status_code == 200
    found = answer.json()
    assert found.keys() == FIT.keys()
    for name in ("vertical", "horizontal", "torsional"):
        assert found["aerodynamics"][name] == pytest.approx(FIT["aerodynamics"][name], abs=1e-4)
        assert found["aerodynamics_at_rest"][name] == pytest.approx(FIT["aerodynamics_at_rest"][name], abs=1e-4)
        assert found["residual"][name] == pytest.approx(FIT["residual"][name], abs=1e-5)
    rows = zip(found["den_hartog_over_angle"], FIT["den_hartog_over_angle"], strict=True)
    assert all(row["coefficient"] == pytest.approx(told["coefficient"], abs=1e-4) for row, told in rows)


def test_the_answer_can_be_put_into_a_line(shared_client: httpx.Client) -> None:
    found = shared_client.post(ADDRESS, json=FIT_REQUEST).json()
    line = example("c11-twin")
    line["ice"] |= {name: found[name] for name in ("aerodynamics", "aerodynamics_at_rest")}
    assert faults({"line": line, "analysis": {"aerodynamic_model": "relative_wind"}}) == []
    taken = schemas.Line.model_validate(line).ice.aerodynamics
    assert isinstance(taken, schemas.Aerodynamics)
    assert taken.fitted_range == pytest.approx(20.0)


@pytest.mark.parametrize(
    ("change", "pointers"),
    [
        ({"half_range_deg": 4.0}, ["/half_range_deg"]),
        ({"static_angle_deg": "x", "half_range_deg": 0.0}, ["/static_angle_deg", "/half_range_deg"]),
        ({"table": FIT_REQUEST["table"][:4]}, ["/table"]),
        ({"table": FIT_REQUEST["table"][::-1]}, ["/table"]),
        ({"colour": 1}, ["/colour"]),
        ({"table": [*FIT_REQUEST["table"], {"angle_deg": 70.0, "lift": 1.0, "moment": 0.0}]}, ["/table/9/drag"]),
    ],
)
def test_faults_name_their_fields(shared_client: httpx.Client, change: dict[str, object], pointers: list[str]) -> None:
    answer = shared_client.post(ADDRESS, json={**FIT_REQUEST, **change})
    assert answer.status_code == 422
    assert [fault["pointer"] for fault in answer.json()["errors"]] == pointers


def test_another_media_type_is_refused(shared_client: httpx.Client) -> None:
    assert shared_client.post(ADDRESS, content="a,b", headers={"Content-Type": "text/csv"}).status_code == 415
