"""HTTP below the routes: problem documents, limits, headers, paging, request log. No lines, no jobs."""
