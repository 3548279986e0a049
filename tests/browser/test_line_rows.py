"""Rows of the form of a line: added, filled, copied and removed, by the mouse and by the keyboard, to a result."""

import re
from collections.abc import Callable

from playwright.sync_api import Page, expect

Open = Callable[..., Page]


def focused(page: Page) -> str:
    return str(page.evaluate("document.activeElement.id"))


def press_until(page: Page, wanted: str, key: str = "Tab") -> None:
    """Press a key until the control of an id has the focus."""
    for _ in range(60):
        if focused(page) == wanted:
            return
        page.keyboard.press(key)
    raise AssertionError(f"{key} does not lead to {wanted}")


def test_devices_and_winds_are_filled_by_rows_and_the_line_runs(open_page: Open) -> None:
    page = open_page("/pages/lines/new?example=c11-twin")
    page.get_by_label("Name", exact=True).fill("A line with devices")
    page.get_by_label("Kind of the next one").select_option(label="Detuning pendulum")
    page.get_by_role("button", name="Add a device").click()
    pendulum = page.get_by_role("group", name="Device 1", exact=True)
    expect(pendulum.get_by_label("Kind")).to_be_focused()
    for label, text in (("Place", "900"), ("Mass", "12"), ("Arm", "0.35")):
        pendulum.get_by_label(re.compile(rf"^{label} \[")).fill(text)
    expect(page.locator("#line-devices-0-position_m-fault")).to_contain_text("must lie on the span")
    expect(page.locator("#preview-said")).to_have_text("Places at fault: 1.")
    pendulum.get_by_label(re.compile(r"^Place \[")).fill("60")
    expect(page.locator("#line-devices-0-position_m-fault")).to_be_empty()
    expect(page.locator("#preview-said")).to_have_text("Nothing is at fault.")
    expect(page.locator("#preview .legend")).to_contain_text("Detuning pendulum: 1")
    page.get_by_label("First wind speed").fill("4")
    page.get_by_label("Last wind speed").fill("5")
    page.get_by_label("Step [m/s]").fill("0.5")
    page.get_by_role("button", name="List them").click()
    expect(page.locator("ul.plain input")).to_have_count(3)
    page.get_by_role("button", name="Remove Wind speed 2").click()
    expect(page.locator("ul.plain input")).to_have_count(2)
    page.get_by_role("button", name="Compute").click()
    page.wait_for_selector(".verdict", timeout=180_000)
    expect(page.locator("h1")).to_have_text("A line with devices")


def test_rows_are_made_by_the_keyboard_alone(open_page: Open) -> None:
    page = open_page("/pages/lines/new")
    expect(page.locator("#preview .drawing.span")).to_be_visible()
    page.locator("#line-required_clearance_m").focus()
    press_until(page, "add-line-phases")
    page.keyboard.press("Enter")
    expect(page.locator("#line-phases-0-name")).to_be_focused()
    expect(page.locator("#rows-said")).to_have_text("Phase 1 is added. There are 1 now.")
    page.keyboard.type("top")
    press_until(page, "line-phases-0-y_m")
    page.keyboard.type("7")
    expect(page.locator("#preview .drawing.phases .phase")).to_have_count(1)
    for _ in range(20):
        page.keyboard.press("Tab")
        if page.evaluate("document.activeElement.textContent").startswith("Copy"):
            break
    page.keyboard.press("Space")
    expect(page.locator("#line-phases-1-name")).to_be_focused()
    expect(page.locator("#line-phases-1-name")).to_have_value("top")
    page.keyboard.press("Control+A")
    page.keyboard.type("low")
    press_until(page, "line-phases-1-y_m")
    page.keyboard.press("Control+A")
    page.keyboard.type("-7")
    expect(page.locator("#preview .drawing.phases .phase")).to_have_count(2)
    for _ in range(20):
        page.keyboard.press("Tab")
        if page.evaluate("document.activeElement.textContent").startswith("Remove"):
            break
    page.keyboard.press("Enter")
    expect(page.locator("#line-phases-1")).to_have_count(0)
    expect(page.locator("#line-phases-0")).to_be_focused()
    expect(page.locator("#preview .drawing.phases .phase")).to_have_count(1)


def test_measured_coefficients_are_pasted_from_a_sheet(open_page: Open) -> None:
    page = open_page("/pages/lines/new?example=c11-twin")
    page.locator("summary", has_text="Own coefficients of the ice").wait_for()
    group = page.locator("#group-coefficients")
    for field in group.locator(
        "input[name*='.vertical.'], input[name*='.horizontal.'], input[name*='.torsional.']"
    ).all():
        field.fill("")
    group.get_by_label(re.compile("^Largest angle of attack")).fill("")
    group.get_by_label(re.compile("^Measured: angle at rest")).fill("40")
    group.get_by_label(re.compile("^Measured: range to either side")).fill("20")
    group.locator("summary", has_text="Paste from a sheet").click()
    rows = [
        (20, 0.6, 1.0, 0.1),
        (30, 0.5, 1.05, 0.05),
        (40, 0.3, 1.1, 0.0),
        (50, 0.0, 1.2, -0.1),
        (60, -0.2, 1.3, -0.1),
    ]
    text = "angle\tlift\tdrag\tmoment\n" + "\n".join("\t".join(str(cell) for cell in row) for row in rows)
    group.locator("textarea").fill(text)
    group.get_by_role("button", name="Make rows of it").click()
    expect(page.locator("#rows-said")).to_have_text("Rows from the sheet: 5.")
    expect(page.locator("#line-ice-aerodynamics-table-0-angle_deg")).to_be_focused()
    expect(page.locator("#line-ice-aerodynamics-table-4-drag")).to_have_value("1.3")
    expect(page.locator("#preview-said")).to_have_text("Nothing is at fault.")


def test_the_kind_of_a_row_changes_its_fields_and_keeps_what_both_kinds_have(open_page: Open) -> None:
    page = open_page("/pages/lines/new")
    page.get_by_role("button", name="Add a device").click()
    page.locator("#line-devices-0-mass_kg").fill("8")
    page.locator("#line-devices-0-type").select_option("torsional_damper")
    expect(page.locator("#line-devices-0-damping_n_m_s")).to_be_visible()
    expect(page.locator("#line-devices-0-mass_kg")).to_have_value("8")
    expect(page.locator("#line-devices-0-type")).to_be_focused()


def test_rows_work_without_scripts(open_page: Open) -> None:
    page = open_page("/pages/lines/new", scripts=False)
    page.get_by_role("button", name="Add a device").click()
    page.locator("#line-devices-0-mass_kg").fill("8")
    page.locator("#line-devices-0").get_by_role("button", name="Copy").click()
    expect(page.locator("#line-devices-1-mass_kg")).to_have_value("8")
    page.locator("#line-devices-0").get_by_role("button", name="Remove").click()
    expect(page.locator("#line-devices-1")).to_have_count(0)
    page.locator("#line-devices-0-position_m").fill("60")
    page.locator("#line-devices-0-polar_inertia_kg_m2").fill("0.4")
    page.locator("#line-devices-0-polar_inertia_kg_m2").press("Enter")
    expect(page).to_have_url(re.compile("/pages/jobs/"))


def test_axe_finds_nothing_serious_in_a_form_with_rows(
    open_page: Open, serious_faults: Callable[[Page], list[str]]
) -> None:
    for scheme in ("light", "dark"):
        page = open_page("/pages/lines/new", scheme=scheme)
        for kind in ("airflow_spoiler", "interphase_spacer", "detuning_pendulum"):
            page.locator("#add-line-devices-kind").select_option(kind)
            page.get_by_role("button", name="Add a device").click()
            expect(page.locator("select[id^=line-devices][id$=type]:focus")).to_have_value(kind)
        page.get_by_role("button", name="Add a phase").click()
        expect(page.locator("#line-phases-0-name")).to_be_focused()
        page.get_by_role("button", name="Add a wind speed").click()
        expect(page.locator("ul.plain input")).to_be_focused()
        page.wait_for_load_state("networkidle")
        for details in page.locator("details").all():
            details.evaluate("element => { element.open = true }")
        assert serious_faults(page) == []
