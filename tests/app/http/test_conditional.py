import pytest

from app.http.conditional import Bodiless, strong_tag, unless_known

TAG = strong_tag("input", "0.1.0", "json")


def test_a_tag_is_strong_and_changes_with_every_part() -> None:
    assert TAG.startswith('"') and TAG.endswith('"')
    others = {strong_tag("other", "0.1.0", "json"), strong_tag("input", "0.2.0", "json"), strong_tag("input", "0.1.0")}
    assert len(others | {TAG}) == 4
    assert strong_tag("input", "0.1.0", "json") == TAG


@pytest.mark.parametrize("known", ["", '"other"', TAG[:-1], TAG.strip('"')])
def test_what_is_not_known_is_sent_with_its_tag(known: str) -> None:
    assert unless_known(known, TAG)["ETag"] == TAG


@pytest.mark.parametrize("known", [TAG, "*", f'"other", {TAG}', f"W/{TAG}"])
def test_what_is_known_is_not_sent(known: str) -> None:
    with pytest.raises(Bodiless) as raised:
        unless_known(known, TAG)
    assert raised.value.status_code == 304
    assert raised.value.headers is not None
    assert raised.value.headers["ETag"] == TAG
