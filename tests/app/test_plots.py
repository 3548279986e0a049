from typing import get_args

from app import plots


def test_there_is_a_media_type_for_each_format() -> None:
    assert plots.MEDIA_TYPES == {"svg": "image/svg+xml", "png": "image/png", "pdf": "application/pdf"}
    assert set(plots.MEDIA_TYPES) == set(get_args(plots.Extension))


def test_what_is_exported_is_there() -> None:
    assert all(hasattr(plots, name) for name in plots.__all__)
