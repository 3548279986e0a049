import pytest

from app.pages.measures import FEET, SI, plain


@pytest.mark.parametrize(
    ("number", "digits", "text"),
    [
        (0.0, 3, "0"),
        (1.7583, 3, "1.76"),
        (38757.8, 3, "38\N{NARROW NO-BREAK SPACE}800"),
        (-0.1667, 3, "-0.167"),
        (0.000515, 3, "0.000515"),
        (2.84e7, 3, "28\N{NARROW NO-BREAK SPACE}400\N{NARROW NO-BREAK SPACE}000"),
        (2.84e9, 3, "2.84e+09"),
        (3.2e-7, 2, "3.2e-07"),
        (9.996, 3, "10.0"),
    ],
)
def test_numbers_have_as_many_digits_as_are_known(number: float, digits: int, text: str) -> None:
    assert plain(number, digits) == text


@pytest.mark.parametrize(
    ("si", "number", "text"),
    [
        ("m", 0.3048, "1.00 ft"),
        ("m/s", 4.4704, "10.0 mph"),
        ("N", 4.4482216152605, "1.00 lbf"),
        ("kg/m", 1.48816394357, "1.00 lb/ft"),
        ("degC", 0.0, "32.0 °F"),
        ("degC", -40.0, "-40.0 °F"),
        ("Hz", 0.4816, "0.482 Hz"),
        ("1", 0.9062, "0.906"),
        ("m2", 0.0254**2, "1.00 in²"),
    ],
)
def test_feet_and_pounds_are_exact(si: str, number: float, text: str) -> None:
    assert FEET.shown(number, si) == text


def test_what_is_no_number_is_shown_as_it_is() -> None:
    assert SI.shown(None, "m") == "\N{EN DASH}"
    assert SI.number("crescent") == "crescent"
    assert SI.shown(3, "1") == "3"
    assert SI.shown(True) == "True"


def test_quantities_within_a_sentence_are_in_the_units_of_the_reader_with_as_many_digits() -> None:
    said = "Gallops from 1.9 m/s; at 12 m/s in one loop, 2.67 m peak to peak; keeps -0.15 m; 45 mm, 3.1 m2, C11 m."
    in_feet = FEET.sentence(said).replace("\N{NO-BREAK SPACE}", " ")
    assert in_feet.startswith("Gallops from 4.3 mph; at 27 mph in one loop, 8.76 ft peak to peak; keeps -0.49 ft;")
    assert in_feet.endswith("; 45 mm, 3.1 m2, C11 m.")
    assert SI.sentence(said).replace("\N{NO-BREAK SPACE}", " ") == said
    assert "12\N{NO-BREAK SPACE}m/s" in SI.sentence(said)


def test_both_ends_of_a_range_are_in_the_units_of_the_reader() -> None:
    said = "the onset rises from 2.25 to 3.10 m/s, the motion falls from 1.2 to 0.8 m peak to peak"
    assert FEET.sentence(said).replace("\N{NO-BREAK SPACE}", " ") == (
        "the onset rises from 5.03 to 6.93 mph, the motion falls from 3.9 to 3 ft peak to peak"
    )
    assert SI.sentence(said).replace("\N{NO-BREAK SPACE}", " ") == said
