"""Measurements and tables that the documents quote; nothing of the product imports this."""

import os

from app.runtime.processes import ONE_BLAS_THREAD

for _name, _value in ONE_BLAS_THREAD.items():  # before numpy loads: threads that wait spend processor time
    os.environ.setdefault(_name, _value)
