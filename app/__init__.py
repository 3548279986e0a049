"""The web service and the command line: documents in, jobs kept in SQL, results and pictures out."""
