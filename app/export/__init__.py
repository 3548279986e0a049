"""Result tables as JSON, CSV, Parquet and XLSX. Other packages decide what the tables contain."""
