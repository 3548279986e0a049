"""Tables as spreadsheet programs write them: which bytes are text, which text is a row, which cell is a number."""
