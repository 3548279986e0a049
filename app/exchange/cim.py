"""Read the line segments of IEC CIM as lines: what they are made of, how their wires hang, where they stand.

Classes and attributes are those of IEC 61970-301 and IEC 61968-11, in any edition whose names are the same (CIM15 to
CIM100 and later); docs/exchange.md lists them. Lengths are in metres, except in CGMES, whose profiles declare
kilometres.
"""

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from app.exchange.cim_places import Places
from app.exchange.cim_wires import WIRES, Wires, number
from app.exchange.rdf import CimModel, CimObject, bare, read_rdf
from app.exchange.spans import SpanNotes, lines_along
from app.schemas.faults import BadInput, Fault
from app.sheets.columns import PlacedLine

_SEGMENT = "ACLineSegment"
_NAMES = frozenset({"IdentifiedObject.name", "IdentifiedObject.mRID"})
_WANTED: Mapping[str, frozenset[str]] = {
    _SEGMENT: _NAMES
    | {
        "Conductor.length",
        "ACLineSegment.WireSpacingInfo",
        "PowerSystemResource.AssetDatasheet",
        "PowerSystemResource.Location",
    },
    "Asset": _NAMES | {"Asset.AssetInfo", "Asset.PowerSystemResources", "Asset.Location"},
    **WIRES,
    **Places.WANTED,
}
_IN_KILOMETRES = ("entsoe.eu/CIM/", "/ns/CIM/")
_SHOWN = 80
_LENGTH_FROM = "from Conductor.length; positions of the towers divide a segment of several spans"
_MISSING = {
    "/conductor": "no WireInfo of a known conductor belongs to the segment",
    "/ice": "CIM has no ice",
    "/span": "it has neither Conductor.length nor two positions",
    "/span/length_m": "it has neither Conductor.length nor two positions",
}


@dataclass(frozen=True, slots=True)
class SegmentLines:
    """The lines of a file, and notes."""

    lines: Iterator[PlacedLine]
    notes: SpanNotes


def read_segments(pieces: Iterable[bytes], defaults: object, most_kept: int, most_silent: int) -> SegmentLines:
    """Read a whole file; its segments become lines one after another.

    Parameters
    ----------
    pieces : iterable of bytes
        RDF/XML.
    defaults : any
        The defaults of the batch: if they say a conductor, unknown names of wires are left out.
    most_kept, most_silent : int
        Bounds, as `app.exchange.rdf.read_rdf` has them.

    Raises
    ------
    BadInput
        If it is no CIM in RDF/XML, or has no line segment.
    BodyTooLarge
        If it exceeds a bound.
    """
    model = read_rdf(pieces, _WANTED, most_kept, most_silent)
    segments = model.all_of(frozenset({_SEGMENT}))
    if not segments:
        raise BadInput([Fault("", "no_segment", "the file has no ACLineSegment")])
    notes = SpanNotes()
    factor = 1000.0 if any(part in profile for profile in model.profiles for part in _IN_KILOMETRES) else 1.0
    unit = "kilometres, as CGMES declares it" if factor > 1.0 else "metres, as CIM declares it"
    if any("Conductor.length" in segment.texts for segment in segments):
        notes.others.append(f"Conductor.length was read in {unit}.")
    has_conductor = isinstance(defaults, dict) and defaults.get("conductor") is not None
    reader = _Reader(model, Wires(model, has_conductor), Places(model, notes), _assets(model), notes, factor)
    return SegmentLines((line for segment in segments for line in reader.lines(segment)), notes)


def _assets(model: CimModel) -> dict[str, list[CimObject]]:
    found = defaultdict(list)
    for asset in model.all_of(frozenset({"Asset"})):
        for link in asset.links.get("Asset.PowerSystemResources", ()):
            found[bare(link)].append(asset)
    return found


@dataclass(frozen=True, slots=True)
class _Reader:
    """What segments refer to, ready to be looked up; factor: what a length is multiplied by to be in metres."""

    model: CimModel
    wires: Wires
    places: Places
    assets: Mapping[str, Sequence[CimObject]]
    notes: SpanNotes
    factor: float

    def lines(self, segment: CimObject) -> Iterator[PlacedLine]:
        """Yield the lines of a segment: one for each span between its positions, or one as a whole."""
        place = f"{_SEGMENT} {segment.identity[:_SHOWN]}"
        assets = self.assets.get(bare(segment.identity), ())
        of_assets = [link for asset in assets for link in asset.links.get("Asset.AssetInfo", ())]
        made = self.wires.of(segment, of_assets)
        course, geometry = self.places.of(segment, assets)
        document, faults = _labels(segment, assets), list(made.faults)
        document |= made.document
        sources = {**_MISSING, **made.sources}
        length, fault = number(segment, "Conductor.length", "/span/length_m")
        several = course is not None and len(course.positions) > 2
        if fault is not None:
            faults.append(fault)
        elif length is not None and several:
            self.notes.compare(place, length * self.factor, course.length() if course is not None else 0.0)
        elif length is not None:
            document["span"] = {"length_m": length * self.factor}
            sources["/span/length_m"] = _LENGTH_FROM
        line = PlacedLine(place, document, tuple(faults), sources=sources)
        if made.refusal is not None:
            yield PlacedLine(place, BadInput([Fault("", "cable", made.refusal)]))
        else:
            yield from lines_along(line, course, geometry, self.notes)


def _labels(segment: CimObject, assets: Sequence[CimObject]) -> dict[str, Any]:
    labels = {"reference": segment.texts.get("IdentifiedObject.mRID", segment.identity)}
    if "IdentifiedObject.name" in segment.texts:
        labels["name"] = segment.texts["IdentifiedObject.name"]
    if assets:
        labels["asset_id"] = assets[0].texts.get("IdentifiedObject.mRID", assets[0].identity)
    return {name: text for name, text in labels.items() if text}
