"""A result as one document to keep: the same as HTML and as PDF, from a job or from the command line.

Values and words are those of the page of a result; a report only arranges them for paper.
"""

from app.pages.reports.document import report_html
from app.pages.reports.material import Material, computed_material, job_material
from app.pages.reports.printing import NotPrintable, report_html_alone, report_pdf

__all__ = [
    "Material",
    "NotPrintable",
    "computed_material",
    "job_material",
    "report_html",
    "report_html_alone",
    "report_pdf",
]
