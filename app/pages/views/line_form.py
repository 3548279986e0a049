"""The page on which a line is described: the form, what it becomes while it is typed, and its submission."""

import json
from typing import Annotated, Any
from uuid import UUID

from anyio import to_thread
from fastapi import APIRouter, Query, Request, Response

from app.owned import records
from app.pages import examples
from app.pages.forms import Fields
from app.pages.frame import caller_of, moved, page, units_of
from app.pages.lines.line_documents import REST, to_document, to_texts
from app.pages.lines.line_fields import CLOSED, GROUPS, form_fields
from app.pages.lines.line_preview import preview
from app.pages.measures import BY_NAME, FEET, SI, Units
from app.pages.recipes import said
from app.pages.submitting import submit
from app.reference import conductors
from app.reference.ice_shapes import ICE_SHAPES
from app.routes.dependencies import CallerOf, Readers
from app.routes.job_status import find_job
from app.schemas.faults import BadInput, Fault, parse_json

router = APIRouter(include_in_schema=False, prefix="/pages/lines")

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
    units = _units(fields)
    try:
        job = await submit(request, to_document(fields, units))
    except BadInput as error:
        return _form(request, fields, units, error.faults)
    return moved(request, f"/pages/jobs/{job.id}")


@router.post("/preview")
def preview_line(request: Request, fields: Fields) -> Response:
    """Return the part of the page that shows what the line becomes, or which fields are at fault."""
    units = _units(fields)
    shown, faults, text = None, [], ""
    try:
        document = to_document(fields, units)
        text = json.dumps(document, indent=1, ensure_ascii=False)
        shown = preview(request, document, units)
    except BadInput as error:
        faults = list(error.faults)
    beside, others = _placed(faults)
    values: dict[str, Any] = {"beside": beside, "others": others, "text": text, "form_units": units}
    return page(request, "parts/preview.html", shown=shown, fields=form_fields(), **values)


@router.post("/units")
def change_units(request: Request, fields: Fields) -> Response:
    """Return the form with its numbers in the other units."""
    units = _units(fields)
    other = SI if units is FEET else FEET
    try:
        return _form(request, _exchanged(fields, units, other), other)
    except BadInput as error:
        return _form(request, fields, units, error.faults)


@router.post("/export")
def export_line(request: Request, fields: Fields) -> Response:
    """Return the request of the form as a file of JSON."""
    units = _units(fields)
    try:
        text = json.dumps(to_document(fields, units), indent=1, ensure_ascii=False)
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
        return _form(request, {REST: ""}, units, faults, text)
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


def _form(request: Request, texts: dict[str, str], units: Units, faults: Any = (), imported: str = "") -> Response:
    beside, others = _placed(faults)
    with request.app.state.readers() as session:
        own = sorted(records.own_rows(session, caller_of(request).owner).tables)
    return page(
        request,
        "line.html",
        422 if faults else 200,
        texts=texts,
        form_units=units,
        fields=form_fields(),
        groups=GROUPS,
        closed=CLOSED,
        beside=beside,
        others=others,
        shapes=[*own, *(shape.name for shape in ICE_SHAPES)],
        imported=imported,
    )


def _units(fields: dict[str, str]) -> Units:
    return BY_NAME.get(fields.get("form_units", ""), SI)


def _exchanged(fields: dict[str, str], units: Units, other: Units) -> dict[str, str]:
    """Return the texts of a form in other units; what is no number stays as it was typed."""
    changed = dict(fields)
    for name, field in form_fields().items():
        unit = field.unit(units)
        try:
            number = float(fields.get(name, ""))
        except ValueError:
            continue
        if field.row["type"] == "number":
            changed[name] = field.entered((number - unit.offset) / unit.factor, other)
    return changed


def _placed(faults: Any) -> tuple[dict[str, list[str]], list[Fault]]:
    """Return the faults that stand beside a field, by its name, and all others."""
    names = {field.pointer: name for name, field in form_fields().items()}
    beside: dict[str, list[str]] = {}
    others = []
    for fault in faults:
        if fault.pointer in names:
            beside.setdefault(names[fault.pointer], []).append(fault.detail)
        else:
            others.append(fault)
    return beside, others
