"""How a process that runs the engine handles memory: settled once, before its first job."""

import ctypes
import gc

TRIM_THRESHOLD, MAPPING_THRESHOLD = -1, -3  # names of glibc's mallopt for the two limits below
KEPT_BYTES = 256 * 2**20  # of free memory that the process keeps; a chunk of lines at its peak needs less
MAPPED_BYTES = 32 * 2**20  # smallest array that is mapped from the kernel by itself: the largest limit that glibc takes
YOUNG_OBJECTS = 100_000  # after which they are looked through for reference cycles; a chunk of lines makes fewer


def settle(**_: object) -> None:
    """Exclude what is loaded from garbage collection, make it rare, and keep freed memory for the next arrays.

    What is loaded lives as long as the process. The engine creates no reference cycles, so most later objects are freed
    without collection, and collections while it computes find nothing.
    """
    gc.collect()
    gc.freeze()
    gc.set_threshold(YOUNG_OBJECTS)
    keep_freed_memory()


def keep_freed_memory() -> None:
    """Let the C library keep freed memory, where it is glibc.

    By default it returns the engine's arrays to the kernel, which clears every page again for the next ones.
    """
    set_option = getattr(ctypes.CDLL(None), "mallopt", None)
    if set_option is not None:
        set_option(TRIM_THRESHOLD, KEPT_BYTES)
        set_option(MAPPING_THRESHOLD, MAPPED_BYTES)
