"""HTTP below the routes: problem documents, limits, headers, paging, request log. Nothing about lines or jobs."""
