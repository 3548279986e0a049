"""Numbers as people write them: with a comma or a point, with a minus sign of print, with spaces between thousands."""


def as_number(text: str) -> float | None:
    """Return the number that a text says; None if it says none."""
    plain = text.replace("\N{MINUS SIGN}", "-").replace("\N{NARROW NO-BREAK SPACE}", "").replace(" ", "")
    if plain.count(",") == 1 and "." not in plain:
        plain = plain.replace(",", ".")
    try:
        return float(plain)
    except ValueError:
        return None
