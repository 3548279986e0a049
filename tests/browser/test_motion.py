"""The animation of a motion: it plays, pauses, goes to a moment, and shows another motion."""

from collections.abc import Callable

from playwright.sync_api import Page, expect

Open = Callable[..., Page]


def place_of(page: Page) -> str:
    return page.locator(".motion .moving").get_attribute("transform") or ""


def test_the_motion_plays_pauses_and_goes_to_a_moment(open_page: Open, finished_job: str) -> None:
    page = open_page(finished_job)
    page.wait_for_selector(".motion .moving")
    page.get_by_role("button", name="Pause").click()
    still = place_of(page)
    page.wait_for_timeout(300)
    assert place_of(page) == still
    page.locator("select.speed").select_option("4")
    page.get_by_role("button", name="Play").click()
    page.wait_for_timeout(600)
    assert place_of(page) != still
    page.get_by_label("Moment of the period").fill("0.5")
    expect(page.get_by_role("button", name="Play")).to_be_visible()
    expected = page.evaluate(
        "(() => { const { data } = document.querySelector('.motion').motion;"
        " return `translate(${data.w[30] * data.cross} ${-data.v[30] * data.cross})` })()"
    )
    assert place_of(page).startswith(expected)


def test_another_motion_is_shown_without_loading_the_page(open_page: Open, finished_job: str) -> None:
    page = open_page(finished_job)
    page.wait_for_selector(".motion .moving")
    choice = page.locator(".motion select[name=cycle]")
    first = page.locator(".motion").get_attribute("data-motion")
    other = choice.locator("option:not([selected])").first.get_attribute("value")
    choice.select_option(other)
    expect(page.locator(".motion")).not_to_have_attribute("data-motion", first or "")
    expect(page.locator(".motion .moving")).to_have_count(1)
