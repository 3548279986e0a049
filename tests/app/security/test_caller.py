import pytest

from app.security.caller import OWNER_PATTERN


@pytest.mark.parametrize("name", ["acme", "North-Grid_2.eu", "ops@utility.example", "a" * 64])
def test_names_of_owners(name: str) -> None:
    assert OWNER_PATTERN.fullmatch(name)


@pytest.mark.parametrize("name", ["", " ", "a b", "-a", "a\n", "ä", "a" * 65, "a/b"])
def test_what_is_no_name_of_an_owner(name: str) -> None:
    assert not OWNER_PATTERN.fullmatch(name)
