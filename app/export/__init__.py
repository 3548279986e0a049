"""Result tables as JSON, CSV and Parquet. Other packages decide what the tables contain."""
