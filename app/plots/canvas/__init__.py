"""What pictures are drawn on: themes, fonts, the sheet with heading and footer, simplification, and saving as a file.

It knows no tables of results.
"""
