"""Computations over several lines: placement of devices, and studies that follow cycles over a field."""
