"""Pages for people: HTML made on the server from jobs, results and lines, with its styles, scripts and words.

A page shows what the API answers, in words and pictures; it computes no result and reads no table of its own.
"""
