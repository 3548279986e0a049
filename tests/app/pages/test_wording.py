import pytest
from jinja2 import Environment, PackageLoader, nodes

from app.pages import examples
from app.pages.wording import word_for, words


def test_a_text_that_is_missing_is_noticed() -> None:
    with pytest.raises(AttributeError):
        _ = words().start.there_is_no_such_text
    assert word_for(words().states, "successful") == "done"
    assert word_for(words().values, "any_new_value") == "any new value"


def test_every_example_has_its_words() -> None:
    assert all(getattr(words().examples, name).title for name in examples.NAMES)


@pytest.mark.parametrize("name", sorted(Environment(loader=PackageLoader("app.pages")).list_templates()))
def test_templates_name_texts_that_are_there(name: str) -> None:
    environment = Environment(loader=PackageLoader("app.pages"))
    assert environment.loader is not None
    tree = environment.parse(environment.loader.get_source(environment, name)[0])
    missing = [path for path in _paths(tree) if not _is_there(path)]
    assert missing == []


def _paths(tree: nodes.Template) -> list[list[str]]:
    """Return the chains of names that begin with `words`."""
    found = []
    for node in tree.find_all(nodes.Getattr):
        names, inner = [node.attr], node.node
        while isinstance(inner, nodes.Getattr):
            names.insert(0, inner.attr)
            inner = inner.node
        if isinstance(inner, nodes.Name) and inner.name == "words":
            found.append(names)
    return found


def _is_there(path: list[str]) -> bool:
    value = words()
    for name in path:
        if not hasattr(value, name):
            return False
        value = getattr(value, name)
    return True
