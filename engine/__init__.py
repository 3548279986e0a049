"""Galloping of iced conductor bundles: statics, modes, critical wind speeds and limit cycles.

Frozen dataclasses in, frozen dataclasses out; SI units and radians; numpy and scipy only. No clock, environment,
files, logging or printing. `engine.analysis` is the only module that knows the order of the steps.
"""

ENGINE_VERSION = "0.7.2"
