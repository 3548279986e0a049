"""Problems of RFC 9457, and the pages that explain them."""

from pydantic import ConfigDict, Field

from app.answers.jobs import Link
from app.schemas.fields import Answer, example_of, told


class FaultItem(Answer):
    """One fault of a request."""

    pointer: str = told("JSON pointer of the field; /query/... and /path/... for parameters", "/line/span/length_m")
    code: str = told("The kind of fault, for programs", "greater_than_equal")
    detail: str = told("What is wrong, in a sentence", "input should be greater than or equal to 1, got -5.0")


class Problem(Answer):
    """Problem details of RFC 9457."""

    model_config = ConfigDict(extra="allow", frozen=True)

    type: str = told("Address of the page that explains this type", "/problems/invalid-document")
    title: str = told("The type in words", "Invalid document")
    status: int = told("Status code of the answer [1]", 422)
    detail: str = told("What is wrong this time", "The document has 1 fault.")
    instance: str = told("Address that was asked", "/v1/jobs")
    errors: list[FaultItem] = Field(
        default=[], description="Every fault of the request", examples=[[example_of(FaultItem)]]
    )
    links: list[Link] = Field(default=[], description="Where to go on", examples=[[example_of(Link)]])


class ProblemPage(Answer):
    """What a type of problem means."""

    slug: str = told("Last part of its address", "not-found")
    status: int = told("Status code that it comes with [1]", 404)
    title: str = told("The type in words", "Not found")
    description: str = told("What it means", "There is nothing at this address, or no longer.")
