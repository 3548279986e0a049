"""Workers: Celery processes that run jobs, and the sweeper that recovers lost ones."""
