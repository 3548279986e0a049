"""The OpenAPI document as validators and client generators take it; what operations say stands with their routes."""

from app.openapi.about import about
from app.openapi.finish import finished

__all__ = ["about", "finished"]
