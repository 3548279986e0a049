"""How large the fault tests are: a share of their full size by FAULTS_SCALE."""

import os

SCALE = float(os.environ.get("FAULTS_SCALE", "1"))  # less than 1 for a quick look
