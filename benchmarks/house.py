"""How the source tree keeps its house rules: sizes, names that files share, and no `next()` that may have nothing.

`python -m benchmarks.house` prints the figures of engine, app and worker, and exits with 1 over a bound. It reads the
sources without importing them. The bounds are those of the house rules in docs/decisions/0022-rooms.md.
"""

import ast
import sys
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path
from statistics import median, quantiles

ROOT = Path(__file__).parents[1]
TOPS = ("engine", "app", "worker")

MEDIAN_LINES = 10.0
LONG_LINES = 40.0  # 95 % of the functions are no longer
FILE_LINES = 300
ARGUMENTS = 6
PACKAGE_FILES = 15
ENDS_CAUGHT = Path("engine/progress.py")  # the only place that drives generators by hand
UNBOUNDED = {Path("app/routes")}  # an address is a file: their number follows the interface

# Names that files shared, and the files that had them, before the packages of decision 0022.
SHARED_BEFORE = (28, 65)


@dataclass(frozen=True, slots=True)
class Function:
    """A function or method: where it begins, the lines of its body without the docstring, and its arguments."""

    where: str
    name: str
    lines: int
    arguments: int


@dataclass(frozen=True, slots=True)
class Module:
    """A source file by its path from the root: its lines, its functions, and the files of ours that it imports.

    nexts: lines where `next(...)` has no default, or `.send(...)` or `StopIteration` takes its place. Inside a
    generator an end without a value becomes a RuntimeError, far from where something was missing.
    """

    path: Path
    lines: int
    functions: tuple[Function, ...]
    imports: tuple[Path, ...]
    nexts: tuple[int, ...] = ()


def modules(root: Path, tops: Iterable[str] = TOPS) -> list[Module]:
    """Read all Python files below the named folders of a source tree, sorted by path."""
    return [_module(root, path) for top in tops for path in sorted((root / top).rglob("*.py"))]


def shared_names(found: Iterable[Module]) -> dict[str, list[Path]]:
    """Map each file name that several modules have to their paths; `__init__.py` and `__main__.py` aside."""
    named = [module.path for module in found if not module.path.stem.startswith("__")]
    groups = {name: [path for path in named if path.stem == name] for name in sorted({path.stem for path in named})}
    return {name: paths for name, paths in groups.items() if len(paths) > 1}


def files_by_folder(found: Iterable[Module]) -> dict[Path, int]:
    """Count the modules of each package; its `__init__.py`, the head, is no room of its own and is left out."""
    return dict(Counter(module.path.parent for module in found if module.path.stem != "__init__"))


def body_lines(found: Iterable[Module]) -> tuple[float, float]:
    """Return the median and the 95 % quantile of the lines of all functions' bodies; zeros without functions."""
    lines = [function.lines for module in found for function in module.functions]
    if len(lines) < 2:
        return (float(sum(lines)),) * 2
    return median(lines), quantiles(lines, n=20, method="inclusive")[-1]


def offences(found: list[Module]) -> list[str]:
    """Return a sentence for each bound that a tree breaks, naming the file or the function."""
    return [
        *_offences_of_packages(found),
        *_offences_of_files(found),
        *_offences_of_functions(found),
        *_offences_of_names(found),
        *_offences_of_ends(found),
    ]


def _offences_of_packages(found: list[Module]) -> Iterator[str]:
    for folder, files in sorted(files_by_folder(found).items()):
        if files > PACKAGE_FILES and folder not in UNBOUNDED:
            yield f"{folder}/: {files} files, at most {PACKAGE_FILES}"
    for top, of_top in groupby(found, key=_top):
        middle, long = body_lines(of_top)
        if middle > MEDIAN_LINES or long > LONG_LINES:
            bounds = f"at most {MEDIAN_LINES:g} and {LONG_LINES:g}"
            yield f"{top}/: bodies of functions have {middle:g} lines (median) and {long:g} (95 %), {bounds}"


def _offences_of_files(found: list[Module]) -> Iterator[str]:
    for module in found:
        if module.lines > FILE_LINES:
            yield f"{module.path}: {module.lines} lines, at most {FILE_LINES}"


def _offences_of_functions(found: list[Module]) -> Iterator[str]:
    for module in found:
        for function in module.functions:
            if function.arguments > ARGUMENTS and not _is_command(module, function):
                yield f"{function.where}: {function.name} takes {function.arguments} arguments, at most {ARGUMENTS}"


def _is_command(module: Module, function: Function) -> bool:
    """Tell whether a function is a command of the command line, whose arguments are its options."""
    return module.path.parts[:2] == ("app", "cli") and not function.name.startswith("_")


def _offences_of_names(found: list[Module]) -> Iterator[str]:
    for module in found:
        named = {path for path in module.imports if not path.stem.startswith("__")}
        for name, number in sorted(Counter(path.stem for path in named).items()):
            if number > 1:
                paths = ", ".join(sorted(str(path) for path in named if path.stem == name))
                yield f"{module.path}: imports {number} files of one name: {paths}"


def _offences_of_ends(found: list[Module]) -> Iterator[str]:
    for module in found:
        if _top(module) == "engine" and module.path != ENDS_CAUGHT:
            for line in module.nexts:
                yield f"{module.path}:{line}: next() without a default, or the protocol of generators by hand"


def _top(module: Module) -> str:
    return module.path.parts[0]


def _module(root: Path, path: Path) -> Module:
    text = path.read_text()
    tree = ast.parse(text)
    relative = path.relative_to(root)
    functions = tuple(
        Function(f"{relative}:{node.lineno}", node.name, _lines(node), _arguments(node))
        for node in ast.walk(tree)
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef)
    )
    imports, nexts = tuple(sorted(set(_imports(root, tree)))), tuple(_nexts(tree))
    return Module(relative, len(text.splitlines()), functions, imports, nexts)


def _nexts(tree: ast.Module) -> Iterator[int]:
    for node in ast.walk(tree):
        match node:
            case ast.Call(func=ast.Name(id="next"), args=[_]):
                yield node.lineno
            case ast.Name(id="StopIteration") | ast.Call(func=ast.Attribute(attr="send" | "__next__")):
                yield node.lineno


def _lines(function: ast.FunctionDef | ast.AsyncFunctionDef) -> int:
    """Count the lines of a body from its first statement to its last, the docstring left out."""
    statements = function.body[1:] if ast.get_docstring(function, clean=False) is not None else function.body
    if not statements:
        return 0
    return (statements[-1].end_lineno or statements[-1].lineno) - statements[0].lineno + 1


def _arguments(function: ast.FunctionDef | ast.AsyncFunctionDef) -> int:
    """Count the arguments that a caller passes by name or position: `self`, `cls`, `*` and `**` are none."""
    given = [*function.args.posonlyargs, *function.args.args, *function.args.kwonlyargs]
    return sum(argument.arg not in ("self", "cls") for argument in given)


def _imports(root: Path, tree: ast.Module) -> Iterator[Path]:
    """Find the files below the root that a module imports, wherever in it the import stands."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
            names = [node.module, *(f"{node.module}.{alias.name}" for alias in node.names)]
        else:
            continue
        for name in names:
            path = Path(*name.split(".")).with_suffix(".py")
            if (root / path).is_file():
                yield path


def _figures(found: list[Module]) -> Iterator[str]:
    """Write the figures of one top-level package, line by line."""
    middle, long = body_lines(found)
    longest = sorted(found, key=lambda module: -module.lines)[:3]
    yield f"{_top(found[0])}: bodies of functions {middle:g} lines (median), {long:g} (95 %)"
    yield "  longest files: " + ", ".join(f"{module.path} {module.lines}" for module in longest)
    for folder, files in sorted(files_by_folder(found).items()):
        yield f"  {files:3} {folder}/"


def main() -> int:
    """Print the figures and every broken bound, and return the exit code."""
    found = modules(ROOT)
    for _, of_top in groupby(found, key=_top):
        print("\n".join(_figures(list(of_top))))
    names = shared_names(found)
    files = sum(len(paths) for paths in names.values())
    print(f"file names that several files have: {len(names)} names, {files} files", end="")
    print(f" ({SHARED_BEFORE[0]} names, {SHARED_BEFORE[1]} files before the packages)")
    for name, paths in sorted(names.items()):
        print(f"  {name}: " + ", ".join(str(path.parent) for path in paths))
    broken = offences(found)
    print("\n".join(broken) if broken else "All bounds hold.")
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
