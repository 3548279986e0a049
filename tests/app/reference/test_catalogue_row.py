from app.reference.conductors import named


def test_a_listed_row_has_the_stranding_for_the_numbers_of_wires() -> None:
    (row,) = named("795 kcmil 26/7")
    listed = row.listed()
    assert listed["stranding"] == "26/7"
    assert "aluminium_wires" not in listed
    assert listed["diameter_m"] == row.diameter_m
