"""Result tables as JSON, CSV and Parquet. What the tables hold is decided elsewhere."""
