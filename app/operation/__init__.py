"""What the operator of a service needs: metrics, status, pruning, and which workers are there."""
