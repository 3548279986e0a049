"""Tests of the pages in a real browser, `make test-pages`: they open every page and use it as people do."""
