from app.pages.batches.histograms import counted, histogram
from app.pages.measures import FEET, SI


def test_every_value_is_counted_once_in_bins_of_round_width() -> None:
    bins = counted([0.0, 0.1, 0.25, 0.9, 1.0])
    assert sum(count for _, _, count in bins) == 5
    assert (bins[0], bins[-1]) == ((0.0, 0.1, 1), (1.0, 1.1, 1))
    assert counted([]) == []
    assert counted([0.0, 0.0]) == [(0.0, 0.1, 2), *counted([0.0, 0.0])[1:]]


def test_bars_say_their_range_and_their_number() -> None:
    drawn = histogram("Onset", [2.0, 2.1, 5.0], "m/s", SI)
    assert "Onset: bars over 3 lines" in drawn
    assert "<title>2.00 to 2.50 m/s: 2</title>" in drawn
    assert "Onset [m/s]" in drawn
    assert "mph" in histogram("Onset", [2.0], "m/s", FEET)
    assert histogram("Onset", [], "m/s", SI) == ""
