"""CIM files for tests: the frame of RDF/XML, and objects in it."""

from collections.abc import Iterator

HEAD = (
    '<?xml version="1.0" encoding="UTF-8"?>'
    '<rdf:RDF xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#" xmlns:cim="{namespace}" '
    'xmlns:md="http://iec.ch/TC57/61970-552/ModelDescription/1#">'
)
CIM100 = "http://iec.ch/TC57/CIM100#"


def file(*objects: str, namespace: str = CIM100) -> bytes:
    """Return a file with these objects."""
    return (HEAD.replace("{namespace}", namespace) + "".join(objects) + "</rdf:RDF>").encode()


def an_object(kind: str, identity: str, **attributes: str) -> str:
    """Write an object; `Class__name` is the attribute `Class.name`, and a text that begins with # refers to another."""
    inner = "".join(
        f'<cim:{name.replace("__", ".")} rdf:resource="{text}"/>'
        if text.startswith(("#", "http"))
        else f"<cim:{name.replace('__', '.')}>{text}</cim:{name.replace('__', '.')}>"
        for name, text in attributes.items()
    )
    return f'<cim:{kind} rdf:ID="{identity}">{inner}</cim:{kind}>'


def pieces(body: bytes, size: int = 1000) -> Iterator[bytes]:
    """Yield a body in pieces."""
    for first in range(0, len(body), size):
        yield body[first : first + size]
