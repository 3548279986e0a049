import json
import re
from typing import Any

import httpx
import pytest

from app.pages import examples
from app.pages.lines.line_documents import to_texts
from app.pages.measures import SI
from tests.app.pages.reading import BROWSER, read, send

FORM = "/pages/lines/new"
ALONE = {"form_units": "si"}


def texts_of(name: str, **changes: str) -> dict[str, str]:
    request = {"line": examples.line(name), "analysis": examples.ANALYSIS}
    return {**to_texts(request, SI), **ALONE, **changes}


def values(client: httpx.Client, path: str) -> dict[str, str]:
    return read(client, path).fields


def test_the_form_begins_with_an_example_or_an_earlier_line(shared_client: httpx.Client, known_job: str) -> None:
    assert values(shared_client, FORM)["line.conductor.catalogue"] == "Drake"
    assert values(shared_client, f"{FORM}?example=c11-quad")["line.span.length_m"] == "125.88"
    earlier = values(shared_client, f"{FORM}?job={known_job}")
    assert earlier["line.conductor.catalogue"] == "Drake"
    assert earlier["line.span.everyday.share_of_rated_strength"] == "0.2"
    assert earlier["line.required_clearance_m"] == "1.5"


@pytest.mark.parametrize("name", examples.NAMES)
def test_a_line_is_submitted(shared_client: httpx.Client, name: str) -> None:
    answer = send(shared_client, FORM, texts_of(name))
    assert answer.status_code == 303, re.findall(r'role="alert">(.*?)</div>', answer.text, re.DOTALL)
    status = shared_client.get(answer.headers["location"].replace("/pages/", "/v1/")).json()
    assert status["name"] == examples.line(name)["name"]


def test_faults_stand_beside_their_fields_and_what_was_typed_is_kept(shared_client: httpx.Client) -> None:
    typed = {"line.span.length_m": "-5", "line.bundle.spacing_m": "wide", "rest": '{"line": {"colour": "red"}}'}
    answer = send(shared_client, FORM, texts_of(examples.DRAKE, **typed))
    assert answer.status_code == 422
    beside = re.search(r'id="line-span-length_m-fault">(.*?)</p>', answer.text)
    assert beside is not None
    assert "greater than or equal to 1" in beside[1]
    assert 'value="-5" autocomplete="off" inputmode="decimal" aria-invalid="true"' in answer.text
    assert "/line/colour" in answer.text
    assert 'value="wide"' in answer.text


def test_the_preview_draws_the_line_and_lists_its_assumptions(shared_client: httpx.Client) -> None:
    text = send(shared_client, "/pages/lines/preview", texts_of(examples.DRAKE)).text
    assert 'class="drawing bundle"' in text
    assert 'class="drawing span"' in text
    assert "Vertical damping ratio" in text
    assert "style=" not in text
    assert "sag 6.29 m" in text
    wrong = send(shared_client, "/pages/lines/preview", texts_of(examples.DRAKE, **{"line.span.length_m": "x"})).text
    assert 'class="drawing' not in wrong
    assert re.search(r'id="line-span-length_m-fault" hx-swap-oob="true">[^<]*number', wrong)


def test_the_form_changes_its_units_and_they_are_kept(own_client: httpx.Client) -> None:
    answer = send(own_client, "/pages/lines/units", texts_of(examples.DRAKE))
    text = answer.text
    assert "galloping_units=feet" in answer.headers["set-cookie"]  # the pages of its result will have them, too
    assert 'name="line.span.length_m" value="984.252"' in text
    assert 'name="line.span.temperature_c" value="23"' in text
    assert 'name="form_units" value="feet"' in text


def exported(answer: httpx.Response) -> dict[str, Any]:
    assert "attachment" in answer.headers["content-disposition"]
    document: dict[str, Any] = json.loads(answer.text)
    return document


def test_a_line_is_saved_and_opened_again(shared_client: httpx.Client) -> None:
    saved = exported(send(shared_client, "/pages/lines/export", texts_of("c11-triple")))
    assert saved["line"]["span"]["length_m"] == 125.88
    opened = send(shared_client, "/pages/lines/import", {"document": json.dumps(examples.line("c11-triple"))})
    assert 'name="line.span.length_m" value="125.88"' in opened.text
    for text in ("{", "[]"):
        assert send(shared_client, "/pages/lines/import", {"document": text}).status_code == 422


def test_conductors_are_offered_by_the_words_typed(shared_client: httpx.Client) -> None:
    address = "/pages/lines/conductors"
    text = shared_client.get(address, params={"line.conductor.catalogue": "dra"}, headers=BROWSER).text
    assert '<option value="Drake">' in text
    assert "28.1 mm" in text
    assert shared_client.get(address, params={"x": "no such conductor"}, headers=BROWSER).text.strip() == ""


DEVICES = {
    "line.devices.0.type": "spacer",
    "line.devices.0.position_m": "60",
    "line.devices.0.mass_kg": "6.5",
    "line.devices.0.polar_inertia_kg_m2": "0.4",
    "line.devices.3.type": "detuning_pendulum",
    "line.devices.3.position_m": "900",
}
CHANGE = "/pages/lines/rows"


def test_rows_are_submitted_as_lists(shared_client: httpx.Client) -> None:
    winds = {"analysis.wind_speeds_m_per_s.0": "4", "analysis.wind_speeds_m_per_s.1": "5,5"}
    typed = texts_of("c11-twin", **winds) | {name: text for name, text in DEVICES.items() if ".0." in name}
    typed = {name: text for name, text in typed.items() if name.rpartition(".")[2] not in {"start", "stop", "count"}}
    answer = send(shared_client, FORM, typed)
    assert answer.status_code == 303, answer.text
    job = answer.headers["location"].rpartition("/")[2]
    copied = values(shared_client, f"{FORM}?job={job}")
    assert (copied["line.devices.0.position_m"], copied["analysis.wind_speeds_m_per_s.1"]) == ("60", "5.5")


def test_faults_stand_beside_the_fields_of_rows_in_the_form_and_in_the_preview(shared_client: httpx.Client) -> None:
    typed = texts_of(examples.DRAKE, **DEVICES)
    answer = send(shared_client, FORM, typed)
    assert answer.status_code == 422
    assert re.search(r'id="line-devices-1-mass_kg-fault">field required</p>', answer.text)
    assert 'name="line.devices.1.position_m" value="900"' in answer.text
    assert '<a href="#line-devices-1-arm_m">Device 2: Arm</a>' in answer.text
    text = send(shared_client, "/pages/lines/preview", typed).text
    assert re.search(r'id="line-devices-1-arm_m-fault" hx-swap-oob="true">field required', text)
    assert text.count('class="device"') == 2  # the sound spacer on the span, and in the legend


def test_a_row_is_added_by_a_script_in_its_group_and_without_one_on_the_whole_page(shared_client: httpx.Client) -> None:
    typed = texts_of(examples.DRAKE, **DEVICES, change="add line.devices", **{"add.line.devices": "airflow_spoiler"})
    whole = send(shared_client, CHANGE, typed)
    mark = {"mark": values(shared_client, "/")["mark"]}
    part = shared_client.post(CHANGE, data=mark | typed, headers={**BROWSER, "HX-Request": "true"})
    assert part.headers["hx-trigger-after-settle"] == "rows-changed"
    assert part.text.lstrip().startswith('<div class="fields" id="group-devices"')
    for text in (whole.text, part.text):
        assert 'name="line.devices.2.aerodynamics.horizontal.2"' in text
        assert re.search(r'<select id="line-devices-2-type"[^>]* autofocus', text)
        assert 'name="line.devices.1.position_m" value="900"' in text
    assert "<html" in whole.text
    assert 'value="Drake"' in whole.text
    assert "Device 3 is added" in part.text


def test_rows_keep_their_numbers_in_the_other_units(own_client: httpx.Client) -> None:
    text = send(own_client, "/pages/lines/units", texts_of(examples.DRAKE, **DEVICES, **{"fill.step": "1"})).text
    assert 'name="line.devices.0.position_m" value="196.8504"' in text
    assert 'name="line.devices.0.polar_inertia_kg_m2" value="9.492144"' in text
    assert 'name="fill.step" value="2.236936"' in text


def test_a_change_that_makes_no_sense_shows_the_form_again(shared_client: httpx.Client) -> None:
    answer = send(shared_client, CHANGE, texts_of(examples.DRAKE, change="remove line.devices 99"))
    assert answer.status_code == 200
    assert 'value="Drake"' in answer.text


def test_a_hostile_number_of_rows_is_refused_by_the_schema(shared_client: httpx.Client) -> None:
    typed = texts_of(examples.DRAKE) | {f"line.phases.{number}.name": f"p{number}" for number in range(500)}
    answer = send(shared_client, FORM, typed)
    assert answer.status_code == 422
    assert re.search(r'id="line-phases-fault">[^<]*at most 20', answer.text)


def test_the_first_button_of_the_form_computes_so_that_enter_never_removes_a_row(shared_client: httpx.Client) -> None:
    text = send(shared_client, CHANGE, texts_of(examples.DRAKE, change="add line.devices")).text
    form = text[text.index('<form id="line"') :]
    assert form.index('<button class="unseen" tabindex="-1"') < form.index('<button class="quiet"')


def test_coefficients_of_another_form_than_the_shape_are_complained_about_at_their_fields(
    shared_client: httpx.Client,
) -> None:
    typed = {"line.ice.aerodynamics.torsional.1": "2", "line.ice.aerodynamics.table.0.lift": "1"}
    answer = send(shared_client, FORM, texts_of(examples.DRAKE, **typed))
    assert answer.status_code == 422
    for place in ("torsional-0", "table"):
        assert re.search(rf'id="line-ice-aerodynamics-{place}-fault">[^<]*belongs to another form', answer.text)
    assert values(shared_client, f"{FORM}?example=c11-twin")["line.ice.aerodynamics.vertical.1"] == "-4.0547"
