"""Read the objects of IEC CIM from RDF/XML as it arrives (IEC 61970-552); nothing is expanded or fetched.

Only the classes and attributes that are asked for are kept, so that a model of a whole network costs little more than
its lines.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from defusedxml.common import DefusedXmlException
from defusedxml.ElementTree import DefusedXMLParser, ParseError

from app.schemas.faults import BadInput, BodyTooLarge, Fault

_RDF = "http://www.w3.org/1999/02/22-rdf-syntax-ns#"
_CIM = ("http://iec.ch/TC57/", "https://cim.ucaiug.io/", "http://cim.ucaiug.io/")
_MODEL = "http://iec.ch/TC57/61970-552/ModelDescription/1#"
_PROFILE = "Model.profile"
_DEEPEST = 32
_MOST_CHARACTERS = 10_000
_OBJECT, _ATTRIBUTE = 2, 3
_OBJECT_COST, _ATTRIBUTE_COST = 40, 20  # characters, for the memory that even an empty one takes


@dataclass(slots=True)
class CimObject:
    """One object: its identity as the file writes it, its class, and by attribute its texts and what it refers to."""

    identity: str
    kind: str = ""
    texts: dict[str, str] = field(default_factory=dict)
    links: dict[str, list[str]] = field(default_factory=dict)


@dataclass(slots=True)
class CimModel:
    """Objects by their identity without marks, in the order of the file, and the profiles that the file follows."""

    objects: dict[str, CimObject] = field(default_factory=dict)
    profiles: list[str] = field(default_factory=list)

    def all_of(self, kinds: frozenset[str]) -> list[CimObject]:
        """Return the objects of these classes."""
        return [found for found in self.objects.values() if found.kind in kinds]


def bare(identity: str) -> str:
    """Return an identity without the marks by which the same object may be written: #_x, _x, urn:uuid:x."""
    return identity.removeprefix("#").removeprefix("urn:uuid:").removeprefix("_")


def read_rdf(
    pieces: Iterable[bytes], wanted: Mapping[str, frozenset[str]], most_kept: int, most_silent: int
) -> CimModel:
    """Read a whole file.

    Parameters
    ----------
    pieces : iterable of bytes
        The file in any encoding that XML declares.
    wanted : mapping
        The attributes of each class that are kept.
    most_kept : int
        Bound on the characters that are kept.
    most_silent : int
        Bound on the bytes of one tag or text.

    Raises
    ------
    BadInput
        If it is no RDF/XML of CIM, is nested deeply, or has a DOCTYPE or entities.
    BodyTooLarge
        If it exceeds a bound.
    """
    target = _Target(wanted, most_kept)
    parser = DefusedXMLParser(target=target, forbid_dtd=True)
    events, silent = 0, 0
    try:
        for piece in pieces:
            parser.feed(piece)
            silent = silent + len(piece) if target.events == events else 0
            events = target.events
            if silent > most_silent:
                raise BodyTooLarge(f"A tag or a text of the file is longer than {most_silent} bytes.")
        parser.close()
    except DefusedXmlException as error:
        detail = "must have neither a DOCTYPE nor entities: CIM files need none, and they could name other files"
        raise _fault("xml_refused", detail) from error
    except (ParseError, ValueError, LookupError) as error:
        if isinstance(error, BadInput):
            raise
        raise _fault("xml_invalid", f"not XML that can be read: {str(error)[:200]}") from error
    if not target.is_cim:
        raise _fault("not_cim", f"has no object in a namespace of IEC CIM ({_CIM[0]}...)")
    return target.model


class _Target:
    """What the parser tells of: the beginning and the end of each element, and its text."""

    def __init__(self, wanted: Mapping[str, frozenset[str]], most_kept: int) -> None:
        self.model = CimModel()
        self.events = 0
        self.is_cim = False
        self._wanted = wanted
        self._attributes = frozenset().union(*wanted.values())
        self._room = most_kept
        self._depth = 0
        self._object: CimObject | None = None
        self._attribute = ""
        self._text: list[str] = []
        self._length = 0

    def start(self, tag: str, attributes: Mapping[str, str]) -> None:
        """Begin an element: the root, an object, or an attribute of an object."""
        self.events += 1
        self._depth += 1
        namespace, _, name = tag.removeprefix("{").rpartition("}")
        if self._depth == 1 and (namespace, name) != (_RDF, "RDF"):
            raise _fault("not_rdf", f"must be RDF/XML, whose outermost element is rdf:RDF, got {name[:80]}")
        if self._depth > _DEEPEST:
            raise _fault("too_deep", f"elements may be nested up to {_DEEPEST} deep")
        if self._depth == _OBJECT:
            self._begin_object(namespace, name, attributes)
        elif self._depth == _ATTRIBUTE and self._object is not None:
            self._begin_attribute(namespace, name, attributes)

    def data(self, text: str) -> None:
        """Take a part of a text."""
        if self._attribute and self._depth == _ATTRIBUTE:
            self.events += 1
            self._text.append(text)
            self._length += len(text)
            self._take(len(text))
            if self._length > _MOST_CHARACTERS:
                raise BodyTooLarge(f"{self._attribute} has more than {_MOST_CHARACTERS} characters.")

    def end(self, _: str) -> None:
        """End an element."""
        self.events += 1
        if self._depth == _ATTRIBUTE:
            text = "".join(self._text).strip()
            if self._attribute == _PROFILE:
                self.model.profiles.append(text)
            elif self._attribute and self._object is not None and text:
                self._object.texts[self._attribute] = text
            self._attribute, self._text, self._length = "", [], 0
        elif self._depth == _OBJECT and self._object is not None:
            self._keep(self._object)
            self._object = None
        self._depth -= 1

    def close(self) -> None:
        """End the file."""

    def _begin_object(self, namespace: str, name: str, attributes: Mapping[str, str]) -> None:
        self.is_cim = self.is_cim or namespace.startswith(_CIM)
        is_open = (namespace, name) in {(_RDF, "Description"), (_MODEL, "FullModel")}
        if is_open or (name in self._wanted and namespace.startswith(_CIM)):
            identity = attributes.get(f"{{{_RDF}}}ID") or attributes.get(f"{{{_RDF}}}about") or ""
            self._take(len(identity) + _OBJECT_COST)
            self._object = CimObject(identity.removeprefix("#")[:_MOST_CHARACTERS], "" if is_open else name)

    def _begin_attribute(self, namespace: str, name: str, attributes: Mapping[str, str]) -> None:
        assert self._object is not None, "an attribute belongs to an object"
        link = attributes.get(f"{{{_RDF}}}resource")
        if (namespace, name) == (_RDF, "type"):
            self.is_cim = self.is_cim or (link or "").startswith(_CIM)
            self._object.kind = (link or "").rpartition("#")[2]
        elif name in self._attributes and link is not None:
            self._take(len(link) + _ATTRIBUTE_COST)
            self._object.links.setdefault(name, []).append(link)
        elif name in self._attributes or (namespace, name) == (_MODEL, _PROFILE):
            self._attribute = name
            self._take(_ATTRIBUTE_COST)

    def _keep(self, found: CimObject) -> None:
        """Keep an object of a class that is asked for; parts of one object may stand in several places."""
        attributes = self._wanted.get(found.kind)
        if attributes is None:
            return
        known = self.model.objects.setdefault(bare(found.identity) or f"#{len(self.model.objects)}", found)
        if known is not found:
            known.texts.update(found.texts)
            for name, links in found.links.items():
                known.links.setdefault(name, []).extend(links)

    def _take(self, characters: int) -> None:
        self._room -= characters
        if self._room < 0:
            raise BodyTooLarge("The lines of the file, with what describes them, are larger than a JSON body may be.")


def _fault(code: str, detail: str) -> BadInput:
    return BadInput([Fault("", code, detail)])
