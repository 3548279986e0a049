"""Pictures by HTTP; what they show is tested in tests/app/plots."""

import httpx
import pytest

from app.plots import MEDIA_TYPES, PICTURES
from app.runtime.settings import Settings
from tests.app import service
from tests.documents import short_request

STUDY = {"axes": [{"parameter": "span.horizontal_tension_n", "values": [24000.0, 30000.0]}]}
STARTS = {"svg": b"<?xml", "png": b"\x89PNG\r\n\x1a\n", "pdf": b"%PDF"}


@pytest.fixture(scope="module")
def address(shared_client: httpx.Client, shared_settings: Settings) -> str:
    """Give the address of a finished study of two tensions."""
    return service.finished(shared_client, shared_settings, {**short_request(), "study": STUDY})


@pytest.mark.parametrize("picture", PICTURES)
def test_every_picture_of_the_registry_has_its_address(shared_client: httpx.Client, address: str, picture: str) -> None:
    answer = shared_client.get(f"{address}/plots/{picture}.svg")
    assert (answer.status_code, answer.headers["content-type"]) == (200, "image/svg+xml")
    assert PICTURES[picture].title.encode() in answer.content
    links = {link["rel"]: link["href"] for link in shared_client.get(address).json()["links"]}
    assert links[f"{picture}-plot"] == f"{address}/plots/{picture}.svg"


@pytest.mark.parametrize("extension", MEDIA_TYPES)
def test_pictures_come_in_three_formats(shared_client: httpx.Client, address: str, extension: str) -> None:
    answer = shared_client.get(f"{address}/plots/orbit.{extension}")
    assert answer.headers["content-type"] == MEDIA_TYPES[extension]  # type: ignore[index]
    assert answer.content.startswith(STARTS[extension])


def test_each_point_of_a_study_has_its_own_picture(shared_client: httpx.Client, address: str) -> None:
    pictures = [shared_client.get(f"{address}/plots/orbit.svg?point={point}") for point in range(3)]
    assert [picture.status_code for picture in pictures] == [200, 200, 404]
    assert pictures[0].content != pictures[1].content
    assert b"24 kN a conductor" in pictures[0].content
    assert shared_client.get(f"{address}/plots/orbit.svg").content == pictures[0].content


def test_theme_and_size_change_the_picture_and_its_tag(shared_client: httpx.Client, address: str) -> None:
    looks = ["", "?theme=dark", "?width=500", "?width=500&height=400"]
    answers = [shared_client.get(f"{address}/plots/tensions.svg{look}") for look in looks]
    assert len({answer.content for answer in answers}) == len({answer.headers["etag"] for answer in answers}) == 4
    assert b'width="500" height="400"' in answers[3].content
    known = {"If-None-Match": answers[1].headers["etag"]}
    assert shared_client.get(f"{address}/plots/tensions.svg?theme=dark", headers=known).status_code == 304
    assert shared_client.get(f"{address}/plots/tensions.svg", headers=known).status_code == 200


def test_a_study_has_a_picture_of_all_its_points(shared_client: httpx.Client, address: str) -> None:
    reduced = shared_client.get(f"{address}/plots/study.svg")
    own_unit = shared_client.get(f"{address}/plots/study.svg?abscissa=parameter")
    assert [reduced.status_code, own_unit.status_code] == [200, 200]
    assert b"span: horizontal tension [N]" in own_unit.content
    assert b"span: horizontal tension [N]" not in reduced.content


@pytest.mark.parametrize(
    "path", ["orbit.svg?point=-1", "orbit.svg?theme=blue", "orbit.svg?width=10", "study.svg?abscissa=x", "orbit.gif"]
)
def test_what_cannot_be_drawn_is_refused(shared_client: httpx.Client, address: str, path: str) -> None:
    answer = shared_client.get(f"{address}/plots/{path}")
    assert answer.status_code in {400, 404}
    assert answer.headers["content-type"] == "application/problem+json"


def test_no_other_owner_sees_a_picture(shared_client: httpx.Client, address: str) -> None:
    missing = address[:-4] + "0000"
    assert shared_client.get(f"{missing}/plots/orbit.svg").status_code == 404
