"""The JSON that goes out, as pydantic models. Rows of results are made of the tables that the engine declares."""
