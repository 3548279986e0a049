"""Workers: Celery processes that run jobs, and the sweeper that repairs what was lost."""
