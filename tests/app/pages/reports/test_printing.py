from dataclasses import replace
from io import BytesIO

from pypdf import PdfReader

from app.pages.measures import SI
from app.pages.reports import Material, report_html_alone, report_pdf


def test_the_file_has_the_words_of_the_report_on_several_pages(material: Material) -> None:
    named = replace(material, name="Линия 12, خط")
    content = report_pdf(named, SI)
    assert content == report_pdf(named, SI)
    reader = PdfReader(BytesIO(content))
    assert len(reader.pages) >= 4
    assert reader.metadata is not None
    assert reader.metadata.title == named.name
    first = " ".join(reader.pages[0].extract_text().split())
    verdict = material.found.verdict
    assert verdict is not None
    assert verdict["sentence"][:40] in first
    assert "Линия 12" in first
    assert f"1 / {len(reader.pages)}" in first


def test_html_alone_refers_to_nothing_outside(material: Material) -> None:
    text = report_html_alone(material, SI)
    assert 'href="data:text/css' in text
    assert text.count('src="data:image/svg+xml') == 2
    assert 'src="/' not in text
    assert "http:" not in text.replace("http://www.w3.org", "")
