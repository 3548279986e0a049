"""Result rows out of arrays, one module named after each table. Nothing is solved here."""
