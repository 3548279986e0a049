"""The house rules, held against small trees that break one of them each, and against this one."""

from dataclasses import replace
from pathlib import Path

import pytest

from benchmarks import house


def written(root: Path, files: dict[str, str]) -> list[house.Module]:
    for name, text in files.items():
        path = root / "engine" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return house.modules(root, ["engine"])


def function(lines: int, name: str = "long") -> str:
    return f'def {name}():\n    """One line.\n\n    More.\n    """\n' + "    x = 1\n" * lines


def test_this_tree_keeps_its_rules(capsys: pytest.CaptureFixture[str]) -> None:
    assert house.main() == 0
    assert capsys.readouterr().out.endswith("All bounds hold.\n")


def test_a_docstring_is_no_part_of_a_body(tmp_path: Path) -> None:
    (module,) = written(tmp_path, {"a.py": function(7)})
    assert [found.lines for found in module.functions] == [7]
    assert house.body_lines([module]) == (7.0, 7.0)


def test_median_and_95_percent_are_of_all_functions(tmp_path: Path) -> None:
    found = written(tmp_path, {"a.py": "".join(function(lines, f"f{lines}") for lines in range(1, 102))})
    assert house.body_lines(found) == (51.0, 96.0)
    assert [sentence.split(":")[0] for sentence in house.offences(found)] == ["engine/", "engine/a.py"]


def test_an_empty_tree_has_no_offences(tmp_path: Path) -> None:
    assert house.offences(written(tmp_path, {})) == []


def test_a_file_has_300_lines_at_most(tmp_path: Path) -> None:
    found = written(tmp_path, {"a.py": "x = 1\n" * 300, "b.py": "x = 1\n" * 301})
    assert house.offences(found) == ["engine/b.py: 301 lines, at most 300"]


def test_a_package_has_15_modules_beside_its_head(tmp_path: Path) -> None:
    names = [f"{letter}.py" for letter in "abcdefghijklmnop"]
    assert house.offences(written(tmp_path, dict.fromkeys(["__init__.py", *names[:15]], ""))) == []
    assert house.offences(written(tmp_path, {names[15]: ""})) == ["engine/: 16 files, at most 15"]


def test_arguments_are_what_a_caller_gives(tmp_path: Path) -> None:
    six = "class A:\n    def f(self, a, b, c, d=1, *rest, e, f, **more): ...\n"
    assert house.offences(written(tmp_path, {"a.py": six})) == []
    seven = "def f(a, b, c, d=1, *, e, f, g): ...\n"
    assert house.offences(written(tmp_path, {"a.py": seven})) == ["engine/a.py:1: f takes 7 arguments, at most 6"]
    (module,) = written(tmp_path, {"a.py": seven + seven.replace("f(", "_f(")})
    offences = house.offences([replace(module, path=Path("app/cli/a.py"))])  # where options of commands are arguments
    assert [sentence.split(": ")[1].split()[0] for sentence in offences] == ["_f"]


def test_names_that_files_share_are_listed(tmp_path: Path) -> None:
    names = ["one/__init__.py", "two/__init__.py", "one/a.py", "two/a.py", "b.py"]
    found = written(tmp_path, dict.fromkeys(names, ""))
    assert house.shared_names(found) == {"a": [Path("engine/one/a.py"), Path("engine/two/a.py")]}


@pytest.mark.parametrize(
    "text",
    [
        "from engine.one import a\nfrom engine.two import a as other\n",
        "from engine.one.a import f\ndef g():\n    from engine.two.a import f\n",
        "import engine.one.a\nimport engine.two.a\n",
    ],
)
def test_no_module_imports_two_files_of_one_name(tmp_path: Path, text: str) -> None:
    files = {"one/__init__.py": "", "two/__init__.py": "", "one/a.py": "", "two/a.py": "", "b.py": text}
    sentence = "engine/b.py: imports 2 files of one name: engine/one/a.py, engine/two/a.py"
    assert house.offences(written(tmp_path, files)) == [sentence]


def test_one_file_may_be_imported_twice(tmp_path: Path) -> None:
    files = {"one/a.py": "", "b.py": "from engine.one import a\nfrom engine.one.a import f\nimport numpy\n"}
    assert house.offences(written(tmp_path, files)) == []


@pytest.mark.parametrize(
    "text",
    [
        "next(found)",
        "next(x for x in found)",
        "found.send(1)",
        "found.__next__()",
        "try: ...\nexcept StopIteration: ...",
    ],
)
def test_no_end_of_a_generator_is_met_unawares(tmp_path: Path, text: str) -> None:
    line = text.count("\n") + 1
    expected = [f"engine/a.py:{line}: next() without a default, or the protocol of generators by hand"]
    assert house.offences(written(tmp_path, {"a.py": text + "\n"})) == expected
    caught = {"progress.py": text + "\n", "b.py": "next(found, None)\n"}
    assert house.offences(written(tmp_path / "other", caught)) == []
