"""Sliders: the curve and the verdict follow them, by pointer and by keyboard, and a lost connection is said."""

from collections.abc import Callable

from playwright.sync_api import Browser, Page, Route, expect

Open = Callable[..., Page]
LAST = "document.querySelector('.chart').chart.data.pieces.at(-1).vertical.at(-1)"


def opened(open_page: Open, finished_job: str, **options: int) -> Page:
    page = open_page(f"{finished_job}/what-if", **options)
    expect(page.locator("#verdict .answer")).to_have_text("It gallops", timeout=60_000)
    return page


def test_the_curve_and_the_verdict_follow_a_slider(open_page: Open, finished_job: str) -> None:
    page = opened(open_page, finished_job)
    sentence, amplitude = page.locator("#verdict .lead").inner_text(), page.evaluate(LAST)
    box = page.locator("#ice").bounding_box()
    assert box is not None
    page.mouse.move(box["x"] + 0.3 * box["width"], box["y"] + 0.5 * box["height"])
    page.mouse.down()
    page.mouse.move(box["x"] + 0.6 * box["width"], box["y"] + 0.5 * box["height"], steps=8)
    page.mouse.up()
    expect(page.locator("#verdict .lead")).not_to_have_text(sentence)
    expect(page.locator(".chart:not([aria-busy])")).to_be_visible()
    assert page.evaluate(LAST) != amplitude
    assert page.evaluate("document.querySelector('.chart').chart.data.before.at(-1).vertical.at(-1)") == amplitude
    page.get_by_role("button", name="As it was").click()
    expect(page.locator("#verdict .lead")).to_have_text(sentence)


def test_a_slider_is_moved_by_the_keyboard_and_says_its_value(open_page: Open, finished_job: str) -> None:
    page = opened(open_page, finished_job, width=360)
    slider = page.locator("#pendulum_mass")
    slider.focus()
    page.keyboard.press("ArrowRight")
    assert slider.get_attribute("aria-valuetext") == page.locator("#pendulum_mass-shown").inner_text() != "0 kg"
    expect(page.locator(".chart:not([aria-busy])")).to_have_count(1)


def test_a_lost_connection_is_said_and_the_curve_stays(browser: Browser, service: str, finished_job: str) -> None:
    context = browser.new_context(base_url=service)  # its own, since the browser complains about what is refused here
    page = context.new_page()
    page.goto(f"{finished_job}/what-if")
    expect(page.locator(".chart canvas")).to_be_visible(timeout=60_000)
    expect(page.locator(".chart:not([aria-busy])")).to_have_count(1)
    busy = {"type": "/problems/busy", "status": 429}

    def refuse(route: Route) -> None:
        route.fulfill(status=429, json=busy, headers={"Retry-After": "1"})

    page.route("**/what-if/curves*", refuse, times=1)
    page.locator("#ice").fill("20")
    expect(page.locator("#message")).to_contain_text("computes for others")
    assert page.locator(".chart canvas").count() == 1
    expect(page.locator("#message")).to_be_hidden()
    page.route("**/what-if/curves*", lambda route: route.abort(), times=1)
    page.locator("#ice").fill("22")
    expect(page.locator("#connection")).to_be_visible()
    expect(page.locator("#connection")).to_be_hidden()
    context.close()


def test_the_moved_line_becomes_a_job(open_page: Open, finished_job: str) -> None:
    page = opened(open_page, finished_job)
    page.locator("#ice").fill("20")
    page.get_by_role("button", name="Make a job of it").click()
    page.wait_for_selector(".verdict .answer", timeout=120_000)
    assert "what-if" not in page.url
    assert page.url != finished_job
