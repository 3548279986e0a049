from app.plots import fonts


def test_the_font_files_are_true_type_of_two_weights() -> None:
    found = fonts()
    assert list(found) == ["normal", "bold"]
    assert all(content.startswith(b"\x00\x01\x00\x00") for content in found.values())
    assert found["normal"] != found["bold"]
