"""The JSON of answers, as pydantic models. Schemas of result rows follow from the tables that the engine declares."""
