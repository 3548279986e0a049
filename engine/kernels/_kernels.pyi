from engine.arrays import AnyArray, FloatArray

Arrays = tuple[AnyArray, ...]
Shape = tuple[int, int, int, int, bool, int]

def newton(
    model: Arrays,
    shape: Shape,
    size: tuple[int, int, bool],
    cycles: Arrays,
    options: tuple[float, float, int],
    results: Arrays,
    /,
) -> None: ...
def linearization(model: Arrays, shape: Shape, size: tuple[int, int], orbits: Arrays, results: Arrays, /) -> None: ...
def monodromies(
    model: Arrays, shape: Shape, size: tuple[int, int, int], orbits: Arrays, matrices: FloatArray, /
) -> None: ...
def eigenvalues(size: tuple[int, int], matrices: FloatArray, values: FloatArray, /) -> None: ...
def even_parts(size: tuple[int, int], places: Arrays, results: Arrays, /) -> None: ...
def reaches(size: tuple[int, int, int, int, int, int, bool], arrays: Arrays, reach: FloatArray, /) -> None: ...
def flows(
    size: tuple[int, int, int, int, int, int, bool],
    equations: Arrays,
    results: Arrays,
    starts: tuple[AnyArray | int, ...] = ...,
    load: Arrays = ...,
    /,
) -> None: ...
