"""The page on which a line is described: the form, what it becomes while it is typed, and its submission."""

import json
from collections.abc import Mapping
from typing import Annotated, Any
from uuid import UUID

from anyio import to_thread
from fastapi import APIRouter, Query, Request, Response

from app.convert.known import OwnRows
from app.http.beside_loop import beside_loop, beside_loop_if_large
from app.http.strict_routes import KnownParametersRoute
from app.owned import records
from app.pages import examples
from app.pages.drawings.phase_places import THIS
from app.pages.forms import Fields
from app.pages.frame import caller_of, moved, page, units_of
from app.pages.lines.line_documents import to_document, to_texts
from app.pages.lines.line_fields import CLOSED, GROUPS, controls, form_fields
from app.pages.lines.line_preview import preview_of_sound_rows
from app.pages.lines.numbers import as_number
from app.pages.lines.placed_faults import of_typed, placed
from app.pages.lines.row_lists import REST, RowList
from app.pages.lines.rows import STEP, WINDS, Changed, changed, fields_in, numbered, rows_in
from app.pages.lines.shown_rows import shown_rows
from app.pages.measures import BY_NAME, FEET, SI, Units
from app.pages.recipes import said
from app.pages.submitting import submit
from app.pages.views.preferences import keep
from app.reference import conductors
from app.reference.ice_shapes import ICE_SHAPES
from app.routes.dependencies import CallerOf, Readers
from app.routes.job_status import find_job
from app.schemas.faults import BadInput, Fault, parse_json

router = APIRouter(include_in_schema=False, prefix="/pages/lines", route_class=KnownParametersRoute)

_MOST_OFFERED = 30
_MOST_ASKED = 100


@router.get("/new")
def new_line(
    request: Request,
    caller: CallerOf,
    readers: Readers,
    example: Annotated[str, Query(max_length=40)] = examples.DRAKE,
    job: UUID | None = None,
) -> Response:
    """Return the form, filled with an example or with the line of an earlier job."""
    if job is None:
        name = example if example in examples.NAMES else examples.DRAKE
        document: dict[str, Any] = {"line": examples.line(name), "analysis": examples.ANALYSIS}
    else:
        with readers() as session:
            document = said(find_job(session, caller, job).document)
    units = units_of(request)
    return _form(request, to_texts(document, units), units)


@router.post("/new")
async def submit_line(request: Request, fields: Fields) -> Response:
    """Submit what the form says; show it again, as it was typed, with its faults if it has any."""
    texts, units = await beside_loop_if_large(request, lambda: numbered(fields)), _units(fields)
    try:
        job = await submit(request, lambda: to_document(texts, units))
    except BadInput as error:
        faults = error.faults
        return await beside_loop(request, lambda: _form(request, texts, units, faults))
    return moved(request, f"/pages/jobs/{job.id}")


@router.post("/preview")
def preview_line(request: Request, fields: Fields) -> Response:
    """Return the part of the page that shows what the line becomes, or which fields are at fault.

    Rows at fault are left out of the drawing, and rows into which nothing was typed yet are not complained about.
    """
    texts, units = numbered(fields), _units(fields)
    shown, text = None, ""
    faults: list[Fault] = []
    try:
        document = to_document(texts, units)
        text = json.dumps(document, indent=1, ensure_ascii=False)
        shown, faults = preview_of_sound_rows(document, _own_rows(request), units)
    except BadInput as error:
        faults = list(error.faults)
    values: dict[str, Any] = {"placed": placed(of_typed(faults, texts), texts), "phase_names": _phase_names(texts)}
    return page(request, "parts/preview.html", shown=shown, text=text, form_units=units, **values)


@router.post("/rows")
def change_rows(request: Request, fields: Fields) -> Response:
    """Return the form after a row was added, copied or removed: for scripts only the group that holds the rows."""
    texts, units = numbered(fields), _units(fields)
    change = changed(texts, fields.get("change", ""))
    if change is None:
        return _form(request, texts, units)
    if "hx-request" not in request.headers:
        return _form(request, change.texts, units, change=change)
    name = _group_of(change.row_list)
    values = _of_form(request, change.texts, units, (), change)
    return page(
        request,
        "parts/line_group.html",
        headers={"HX-Trigger-After-Settle": "rows-changed"},
        name=name,
        names=controls(name),
        said=change.said,
        **values,
    )


@router.post("/units")
def change_units(request: Request, fields: Fields) -> Response:
    """Return the form with its numbers in the other units, which the pages of its result will have, too."""
    units = _units(fields)
    other = SI if units is FEET else FEET
    try:
        answer = _form(request, _exchanged(fields, units, other), other)
        keep(request, answer, "units", other.name)
        return answer
    except BadInput as error:
        return _form(request, fields, units, error.faults)


@router.post("/export")
def export_line(request: Request, fields: Fields) -> Response:
    """Return the request of the form as a file of JSON."""
    units = _units(fields)
    try:
        text = json.dumps(to_document(numbered(fields), units), indent=1, ensure_ascii=False)
    except BadInput as error:
        return _form(request, fields, units, error.faults)
    headers = {"Content-Disposition": 'attachment; filename="line.json"'}
    return Response(text, media_type="application/json", headers=headers)


@router.post("/import")
def import_line(request: Request, fields: Fields) -> Response:
    """Return the form filled with a document of JSON: a request, or a line alone."""
    units, text = units_of(request), fields.get("document", "")
    try:
        document = parse_json(text.encode())
        if not isinstance(document, dict):
            raise BadInput([Fault("", "json_type", "must be an object: a request, or a line")])
    except BadInput as error:
        faults = [Fault("/document", fault.code, fault.detail) for fault in error.faults]
        return _form(request, {REST: ""}, units, faults, imported=text)
    request_document = document if "line" in document else {"line": document, "analysis": examples.ANALYSIS}
    return _form(request, to_texts(request_document, units), units)


@router.get("/conductors")
async def offer_conductors(request: Request, caller: CallerOf, readers: Readers) -> Response:
    """Return the conductors whose names hold the words typed, as choices of the field."""
    asked = next(iter(request.query_params.values()), "")[:_MOST_ASKED]

    def found() -> list[Any]:
        with readers() as session:
            own = records.conductor_rows(session, caller.owner)
        return [row.listed() for row in conductors.search(asked, own)][:_MOST_OFFERED]

    return page(request, "parts/conductors.html", found=await to_thread.run_sync(found))


def _form(
    request: Request,
    texts: dict[str, str],
    units: Units,
    faults: Any = (),
    *,
    imported: str = "",
    change: Changed | None = None,
) -> Response:
    texts = numbered(texts)
    values = _of_form(request, texts, units, faults, change)
    typed = {name for name, text in texts.items() if text.strip()} | values["placed"].beside.keys()
    open_groups = {name for name in CLOSED for field in typed if field.startswith(GROUPS[name])}
    return page(
        request,
        "line.html",
        422 if faults else 200,
        groups={name: controls(name) for name in GROUPS},
        closed=CLOSED,
        open_groups=open_groups | ({_group_of(change.row_list)} if change else set()),
        phase_names=_phase_names(texts),
        imported=imported,
        **values,
    )


def _of_form(
    request: Request, texts: dict[str, str], units: Units, faults: Any, change: Changed | None
) -> dict[str, Any]:
    """Return what the controls of the form need."""
    return {
        "texts": texts,
        "form_units": units,
        "fields": form_fields(),
        "lists": shown_rows(texts),
        "placed": placed(faults, texts),
        "shapes": [*sorted(_own_rows(request).tables), *(shape.name for shape in ICE_SHAPES)],
        "focus": change.focus if change else None,
        "changed_list": change.row_list.name if change else None,
        "refused": change.said if change and change.refused else "",
    }


def _group_of(row_list: RowList) -> str:
    return next(name for name, names in GROUPS.items() if row_list.name in names)


def _own_rows(request: Request) -> OwnRows:
    with request.app.state.readers() as session:
        return records.own_rows(session, caller_of(request).owner)


def _phase_names(texts: Mapping[str, str]) -> list[str]:
    """Return the names that interphase spacers may tie: the line itself, and its phases."""
    return [THIS, *(row["name"] for row in rows_in(texts)["line.phases"] if row.get("name", "").strip())]


def _units(fields: dict[str, str]) -> Units:
    return BY_NAME.get(fields.get("form_units", ""), SI)


def _exchanged(fields: dict[str, str], units: Units, other: Units) -> dict[str, str]:
    """Return the texts of a form in other units; what is no number stays as it was typed."""
    texts = numbered(fields)
    known = fields_in(texts)
    for name, field in {**known, STEP: known[f"{WINDS}.start"]}.items():
        number, unit = as_number(texts.get(name, "")), field.unit(units)
        if number is not None and field.row["type"] == "number":
            texts[name] = field.entered((number - unit.offset) / unit.factor, other)
    return texts
