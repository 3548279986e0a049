from collections.abc import Iterator

import pytest

from app.exchange.rdf import CimModel, bare, read_rdf
from app.schemas.faults import BadInput, BodyTooLarge
from tests.app.exchange.cim_files import an_object, file, pieces

WANTED = {"Wire": frozenset({"IdentifiedObject.name", "Wire.link"})}


def read(body: bytes, size: int = 1000, most_kept: int = 10_000) -> CimModel:
    return read_rdf(pieces(body, size), WANTED, most_kept, 5_000)


def refused(body: bytes) -> tuple[str, str]:
    with pytest.raises(BadInput) as caught:
        read(body)
    return caught.value.faults[0].code, caught.value.faults[0].detail


@pytest.mark.parametrize("size", [1, 13, 10_000])
def test_objects_have_texts_and_links(size: int) -> None:
    body = file(
        an_object("Wire", "_a", IdentifiedObject__name="A &amp; B", Wire__link="#_b", Wire__other="x"),
        an_object("Other", "_c", IdentifiedObject__name="not asked for"),
        '<cim:Wire rdf:about="#_a"><cim:Wire.link rdf:resource="urn:uuid:d"/></cim:Wire>',
    )
    model = read(body, size)
    (found,) = model.objects.values()
    assert (found.identity, found.kind, found.texts) == ("_a", "Wire", {"IdentifiedObject.name": "A & B"})
    assert [bare(link) for link in found.links["Wire.link"]] == ["b", "d"]


def test_descriptions_profiles_and_other_encodings_are_read() -> None:
    body = file(
        '<md:FullModel rdf:about="urn:uuid:m"><md:Model.profile>http://entsoe.eu/CIM/EquipmentCore/3/1</md:Model.profile>'
        "</md:FullModel>",
        '<rdf:Description rdf:about="#_a"><rdf:type rdf:resource="http://iec.ch/TC57/CIM100#Wire"/>'
        "<cim:IdentifiedObject.name>Ä</cim:IdentifiedObject.name></rdf:Description>",
    )
    for encoded in (body, body.decode().replace("UTF-8", "UTF-16").encode("utf-16")):
        model = read(encoded)
        assert model.profiles == ["http://entsoe.eu/CIM/EquipmentCore/3/1"]
        assert model.objects["a"].texts == {"IdentifiedObject.name": "Ä"}


def test_other_files_are_refused_in_words() -> None:
    assert refused(b"")[0] == "xml_invalid"
    assert refused(b"<a>")[0] == "not_rdf"
    assert refused(b'{"a": 1}')[0] == "xml_invalid"
    assert refused(file("<cim:Wire>"))[0] == "xml_invalid"
    assert refused(file(an_object("Wire", "a"), namespace="http://example.com/#"))[0] == "not_cim"
    assert refused(file("<cim:a>" * 40 + "</cim:a>" * 40))[0] == "too_deep"
    assert refused(file().replace(b"UTF-8", b"UTF-99"))[0] == "xml_invalid"


@pytest.mark.parametrize(
    "doctype",
    [
        '<!DOCTYPE r [<!ENTITY a "x"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;">]>',
        '<!DOCTYPE r [<!ENTITY a SYSTEM "file:///etc/passwd">]>',
        '<!DOCTYPE r SYSTEM "http://127.0.0.1/x.dtd">',
        '<!DOCTYPE r [<!ENTITY % p SYSTEM "http://127.0.0.1/x">%p;]>',
    ],
)
def test_entities_are_neither_expanded_nor_fetched(doctype: str) -> None:
    body = file(an_object("Wire", "_a", IdentifiedObject__name="&b;")).replace(b"?>", b"?>" + doctype.encode(), 1)
    code, detail = refused(body)
    assert (code, "DOCTYPE" in detail) == ("xml_refused", True)


def test_memory_is_bounded() -> None:
    taken = []

    def endless(begin: bytes, filling: bytes) -> Iterator[bytes]:
        yield file().removesuffix(b"</rdf:RDF>") + begin
        for number in range(10_000):
            taken.append(number)
            yield filling * 100

    for begin, filling in (
        (b"", b'<cim:Wire rdf:ID="_"/>'),
        (b"<cim:Wire>", b"<cim:Wire.link/>"),
        (b"<cim:Wire><cim:IdentifiedObject.name>", b"long text "),
        (b"<cim:Wire><cim:IdentifiedObject.name>", b"&amp;"),
        (b"<cim:Wire a='", b"long attribute "),
        (b"<!-- ", b"long comment "),
        (b"<cim:", b"name"),
    ):
        taken.clear()
        with pytest.raises(BodyTooLarge):
            read_rdf(endless(begin, filling), WANTED, 20_000, 50_000)
        assert len(taken) < 500
