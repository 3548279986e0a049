"""The page of estimates is that of the code."""

from benchmarks.estimates import PAGE, page


def test_the_page_is_up_to_date() -> None:
    assert PAGE.read_text(encoding="utf-8") == page(), "run `python -m benchmarks.estimates`"
