"""One form of a text, so that letters with accents are equal however a system writes them.

macOS and many GIS write "é" as two characters (Unicode's form NFD), Windows and most keyboards as one (NFC).
"""

import unicodedata


def composed(text: str) -> str:
    """Return a text in NFC, the form in which the service stores names and tags."""
    return unicodedata.normalize("NFC", text)


def folded(text: str) -> str:
    """Return a text as searches compare it: in NFC, without case."""
    return composed(composed(text).casefold())


def written_forms(text: str) -> frozenset[str]:
    """Return the forms in which a text may be stored: NFC, and NFD in rows of earlier versions."""
    return frozenset({composed(text), unicodedata.normalize("NFD", text)})
