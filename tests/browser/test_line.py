"""A line: the form is filled, the drawing follows, faults stand beside fields, and the line runs."""

from collections.abc import Callable

from playwright.sync_api import Page, expect

Open = Callable[..., Page]


def test_the_drawing_and_the_assumptions_follow_what_is_typed(open_page: Open) -> None:
    page = open_page("/pages/lines/new")
    expect(page.locator("#preview .drawing.bundle .wire")).to_have_count(2)
    page.get_by_label("Sub-conductors", exact=True).fill("3")
    page.get_by_label("Arrangement").select_option("")
    expect(page.locator("#preview .drawing.bundle .wire")).to_have_count(3)
    page.get_by_label("Length [m]").fill("-1")
    expect(page.locator("#line-span-length_m-fault")).to_contain_text("greater than or equal to 1")
    page.get_by_label("Length [m]").fill("280")
    expect(page.locator("#line-span-length_m-fault")).to_be_empty()


def test_the_catalogue_offers_conductors(open_page: Open) -> None:
    page = open_page("/pages/lines/new")
    page.get_by_label("Conductor of the catalogue").fill("Hawk")
    expect(page.locator("#conductors option[value='LA 280 Hawk']")).to_have_count(1)


def test_a_line_of_the_form_runs(open_page: Open) -> None:
    page = open_page("/pages/lines/new?example=c11-twin")
    page.get_by_label("Name", exact=True).fill("A line of mine")
    page.get_by_label("Number of wind speeds").fill("3")
    page.get_by_role("button", name="Compute").click()
    page.wait_for_selector(".verdict", timeout=180_000)
    expect(page.locator("h1")).to_have_text("A line of mine")
