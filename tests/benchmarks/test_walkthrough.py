"""The walk through the guide: what it shows is what the command prints now."""

from benchmarks.walkthrough import PAGE, request_of, with_output


def test_the_page_shows_what_the_command_prints() -> None:
    page = PAGE.read_text(encoding="utf-8")
    assert with_output(page) == page


def test_the_request_says_only_what_an_engineer_knows() -> None:
    line = request_of(PAGE.read_text(encoding="utf-8"))["line"]
    assert line["conductor"] == {"catalogue": "Drake"}
    assert set(line["ice"]) == {"accretion", "aerodynamics"}
    assert not {"damping", "supports", "wind"} & set(line)
