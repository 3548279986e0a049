"""Result rows written from arrays, one module named after each table. No motion is searched for here."""
