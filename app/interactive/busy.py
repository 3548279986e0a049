"""The refusal of work that would have to wait too long."""


class Busy(Exception):
    """Raised when too much of a kind is under way already, of all owners or of this one."""
