"""OpenAPI examples for batches, and the forms of a batch's body."""

import json
from typing import Any

from app import convert
from app.answers.batches import RankedLine
from app.export.formats import GEOJSON, PARQUET, RDF_XML, XLSX
from app.reference.source_lines import example
from app.routes import documentation
from app.schemas.fields import example_of

_BATCH = "0199a3c4-5b7e-7c1a-9d2e-3f4a5b6c7d8f"
_ADDRESS = f"/v1/batches/{_BATCH}"
_ANALYSIS = {"loops": [1, 2], "models": ["hybrid"], "wind_speeds_m_per_s": [4.0, 5.0, 6.0]}
_LINES = [
    {"reference": "row-1", "asset_id": "L204-S017", **example("c11-twin")},
    {"reference": "row-2", "asset_id": "L204-S018", **example("c11-triple")},
]
_CSV = (
    "reference,asset_id,conductor.diameter_m,conductor.axial_rigidity_n,conductor.torsional_rigidity_n_m2,"
    "conductor.mass_kg_per_m,conductor.polar_inertia_kg_m,bundle.subconductors,bundle.radius_m,bundle.orientation_deg,"
    "span.length_m,span.horizontal_tension_n,ice.eccentricity_y_m,ice.eccentricity_z_m,ice.aerodynamics.vertical,"
    "ice.aerodynamics.horizontal,ice.aerodynamics.torsional,damping.vertical_ratio,damping.horizontal_ratio,"
    "damping.torsional_ratio\n"
    "row-1,L204-S017,0.0286,28418105.8,101.0,2.379,3.334e-4,2,0.2355,90.0,125.88,30000.0,2.05e-3,-0.63e-3,"
    '"[-0.1667, -4.0547, 8.3581]","[0.8605, 0.8325, 1.7815]","[-0.7272, 0.2935, 5.9704]",0.000515,0.000515,0.308\n'
)
_COUNTS = {
    "total": 2,
    "accepted": 2,
    "running": 0,
    "successful": 0,
    "failed": 0,
    "dismissed": 0,
    "rejected": 0,
    "reused": 0,
}
FAULT = {
    "number": 3,
    "reference": "row-3",
    "row": 4,
    "place": "row 4",
    "pointer": "/span/length_m",
    "code": "greater_than_equal",
    "detail": "input should be greater than or equal to 1",
}
_SUMMARY: dict[str, Any] = {
    "id": _BATCH,
    "status": "accepted",
    "progress": 0.0,
    "name": None,
    "tags": {},
    "lines": _COUNTS,
    "created_at": "2026-11-22T10:00:00+00:00",
    "started_at": None,
    "finished_at": None,
    "duration_seconds": None,
    "links": [{"rel": "self", "href": _ADDRESS}],
}
ACCEPTED: dict[str, Any] = {**_SUMMARY, "errors": [], "notes": []}
FINISHED: dict[str, Any] = {
    **ACCEPTED,
    "status": "successful",
    "progress": 1.0,
    "lines": {**_COUNTS, "total": 3, "accepted": 0, "successful": 2, "rejected": 1},
    "started_at": "2026-11-22T10:00:01+00:00",
    "finished_at": "2026-11-22T10:00:02+00:00",
    "duration_seconds": 1.0,
    "errors": [FAULT],
    "links": [{"rel": "self", "href": _ADDRESS}, {"rel": "results", "href": f"{_ADDRESS}/results"}],
}
CHECKED: dict[str, Any] = {"total": 3, "rejected": 1, "seconds": 1.3, "errors": [FAULT], "notes": []}
DISMISSED: dict[str, Any] = {**ACCEPTED, "status": "dismissed", "lines": {**_COUNTS, "accepted": 0, "dismissed": 2}}
STOPPING: dict[str, Any] = {**ACCEPTED, "status": "running", "lines": {**_COUNTS, "accepted": 0, "running": 2}}
ACCEPTED_ANSWER: dict[str, Any] = {
    **documentation.body("Accepted; Location is the address of its status", ("application/json", ACCEPTED)),
    "headers": documentation.ACCEPTED_HEADERS,
}
PAGE: dict[str, Any] = {"batches": [_SUMMARY], "next": None}
RANKING: dict[str, Any] = {"lines": [example_of(RankedLine) | {"clearance_m": None}], "next": None}
ERRORS: dict[str, Any] = {"errors": [FAULT]}
_LABELS = {"number": 1, "reference": "row-1", "asset_id": "L204-S017"}
RESULT: dict[str, Any] = {
    **_LABELS,
    "status": "successful",
    "failure": None,
    "static": convert.example_row(convert.StaticState),
    "den_hartog": convert.example_row(convert.DenHartog),
    "warnings": [],
    "engine_version": "0.1.0",
    **convert.example_tables(),
}
_GEOMETRY = {"type": "LineString", "coordinates": [[14.4205, 50.0871, 312.0], [14.4236, 50.0889, 318.5]]}
_RESULT_FEATURE: dict[str, Any] = {
    "type": "Feature",
    "id": 1,
    "geometry": _GEOMETRY,
    "properties": {
        **_LABELS,
        "name": "C11 twin",
        "status": "successful",
        "failure": None,
        **convert.example_row(convert.TABLES["verdict"].row),
    },
}
_COLLECTION: dict[str, Any] = {
    "type": "object",
    "required": ["type", "features"],
    "properties": {
        "type": {"const": "FeatureCollection"},
        "features": {
            "type": "array",
            "items": {
                "type": "object",
                "required": ["type", "geometry", "properties"],
                "properties": {
                    "type": {"const": "Feature"},
                    "geometry": {"type": ["object", "null"], "description": "LineString or Point in WGS 84, or null"},
                    "properties": {"type": ["object", "null"], "description": "Fields of the line by their names"},
                },
            },
        },
    },
}
RESULTS_ANSWER: dict[str, Any] = {
    "description": "NDJSON with one object for each line, or the rows of one table",
    "content": {
        "application/x-ndjson": {"schema": {"type": "string"}, "example": json.dumps(RESULT) + "\n"},
        "application/json": {
            "schema": {"type": "object", "additionalProperties": {"type": "array", "items": {"type": "object"}}},
            "example": {"frequencies": [{**_LABELS, **row} for row in convert.example_tables()["frequencies"]]},
        },
        "text/csv": {
            "schema": {"type": "string"},
            "example": documentation.table_as_csv("frequencies", _LABELS),
        },
        PARQUET: {"schema": {"type": "string", "format": "binary"}},
        XLSX: {"schema": {"type": "string", "format": "binary"}},
        GEOJSON: {"schema": _COLLECTION, "example": {"type": "FeatureCollection", "features": [_RESULT_FEATURE]}},
    },
}


_FEATURES: dict[str, Any] = {
    "type": "FeatureCollection",
    "analysis": _ANALYSIS,
    "defaults": {
        "conductor": {"catalogue": "Drake"},
        "span": {"everyday": {"share_of_rated_strength": 0.2}},
        "ice": {"accretion": {"shape": "crescent", "thickness_m": 0.012}, "aerodynamics": {"catalogue": "c11-40"}},
    },
    "features": [
        {
            "type": "Feature",
            "id": "L204-S017",
            "geometry": _GEOMETRY,
            "properties": {"name": "Span 17", "bundle.subconductors": 2, "bundle.spacing_m": 0.457},
        }
    ],
}


_CIM = """<rdf:RDF xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#" xmlns:cim="http://iec.ch/TC57/CIM100#">
  <cim:OverheadWireInfo rdf:ID="_wire">
    <cim:IdentifiedObject.name>Drake</cim:IdentifiedObject.name>
  </cim:OverheadWireInfo>
  <cim:ACLineSegment rdf:ID="_segment">
    <cim:Conductor.length>305.5</cim:Conductor.length>
    <cim:PowerSystemResource.AssetDatasheet rdf:resource="#_wire"/>
  </cim:ACLineSegment>
</rdf:RDF>
"""


def request_body() -> dict[str, Any]:
    """Return the OpenAPI entry for the body of a batch; Python reads it as a stream and cannot declare it."""
    ndjson = "".join(json.dumps(item) + "\n" for item in ({"analysis": _ANALYSIS}, *_LINES))
    schema = {"$ref": "#/components/schemas/BatchRequest"}  # `app.openapi` writes it, with both forms of a line
    return {
        "requestBody": {
            "required": True,
            "description": "JSON; NDJSON whose first object is the analysis; or CSV, the first sheet of a workbook "
            "(XLSX), GeoJSON or IEC CIM as RDF/XML with the analysis in the query. `defaults`, beside the analysis, "
            "are fields of a line for all lines that leave them open. Columns, and properties of features, are dotted "
            "field names such as `span.length_m`; a list is JSON in one cell, or one column for each item "
            "(`ice.aerodynamics.vertical.0`). Commas, semicolons or tabs separate the cells of a CSV; decimal commas, "
            "UTF-16 and Windows-1252 are understood, and the status says so. A LineString of GeoJSON is a span, or one "
            "for each of its segments; length, direction and level difference follow from its coordinates. Each "
            "ACLineSegment of CIM is a line. `Content-Encoding: gzip` is accepted.",
            "content": {
                "application/json": {"schema": schema, "example": {"lines": _LINES, "analysis": _ANALYSIS}},
                "application/x-ndjson": {"schema": {"type": "string"}, "example": ndjson},
                "text/csv": {"schema": {"type": "string"}, "example": _CSV},
                XLSX: {"schema": {"type": "string", "format": "binary"}},
                GEOJSON: {"schema": _COLLECTION, "example": _FEATURES},
                RDF_XML: {"schema": {"type": "string"}, "example": _CIM},
            },
        }
    }
