"""Every module of answers, so that a new one is held by the same tests."""

from importlib import import_module
from pkgutil import iter_modules

from app import answers

ANSWER_MODULES = [import_module(f"{answers.__name__}.{module.name}") for module in iter_modules(answers.__path__)]
