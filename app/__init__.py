"""The web service and its command line: they take documents, keep jobs in SQL, and return results and pictures."""
