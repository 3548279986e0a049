"""Fields of a line in words, with the unit that their name ends with."""

from collections.abc import Mapping

_UNITS: Mapping[str, str] = {
    "_kg_per_m3": "kg/m\u00b3",
    "_n_per_m": "N/m",
    "_kg_per_m": "kg/m",
    "_m_per_s": "m/s",
    "_n_m2": "N m\u00b2",
    "_kg_m2": "kg m\u00b2",
    "_kg_m": "kg m",
    "_n_m": "N m",
    "_deg": "\u00b0",
    "_m2": "m\u00b2",
    "_pa": "Pa",
    "_kg": "kg",
    "_n": "N",
    "_m": "m",
    "_c": "\u00b0C",
}


def words_of(path: str) -> str:
    """Return a field such as span.length_m in words, without its unit."""
    part, _, name = path.rpartition(".")
    words = name.removesuffix(_ending(name)).replace("_", " ")
    return f"{part.replace('.', ' ').replace('_', ' ')}: {words}" if part else words


def label_of(path: str) -> str:
    """Return a field in words with its unit in brackets, if it has one."""
    unit = _UNITS.get(_ending(path))
    return f"{words_of(path)} [{unit}]" if unit else words_of(path)


def _ending(name: str) -> str:
    return next((ending for ending in _UNITS if name.endswith(ending)), "")
