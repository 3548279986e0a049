"""Problem details (RFC 9457), and the pages that explain them."""

from pydantic import ConfigDict, Field

from app.answers.jobs import Link
from app.schemas.fields import Answer, described, example_of


class FaultItem(Answer):
    """One fault of a request."""

    pointer: str = described(
        "JSON pointer of the field; /query/... and /path/... for parameters", "/line/span/length_m"
    )
    code: str = described("The kind of fault, for programs", "greater_than_equal")
    detail: str = described("What is wrong, in a sentence", "input should be greater than or equal to 1, got -5.0")


class Problem(Answer):
    """Problem details of RFC 9457."""

    model_config = ConfigDict(extra="allow", frozen=True)

    type: str = described("Address of the page that explains this type", "/problems/invalid-document")
    title: str = described("The type in words", "Invalid document")
    status: int = described("Status code of the answer [1]", 422)
    detail: str = described("This occurrence of the problem", "The document has 1 fault.")
    instance: str = described("Address of the request", "/v1/jobs")
    errors: list[FaultItem] = Field(
        default=[], description="Every fault of the request", examples=[[example_of(FaultItem)]]
    )
    links: list[Link] = Field(default=[], description="Links to related addresses", examples=[[example_of(Link)]])


class ProblemPage(Answer):
    """The meaning of a type of problem."""

    slug: str = described("Last part of its address", "not-found")
    status: int = described("Status code of such answers [1]", 404)
    title: str = described("The type in words", "Not found")
    description: str = described("Meaning of the problem", "There is nothing at this address, or it was removed.")
