"""What `help` says: something of everything, and examples that come out."""

import ast
import doctest
import inspect
from pathlib import Path

import pytest

import gearstudy as gs
from gearstudy import _gearstudy, declared, errors, searching, studies

MODULES = (gs, _gearstudy, declared, errors, searching, studies)
COMPILED = [(name, thing) for name, thing in vars(_gearstudy).items() if inspect.isclass(thing) or inspect.isbuiltin(thing)]


def hints():
    """What the stubs say that each property is."""
    stubs = ast.parse(Path(_gearstudy.__file__).with_name("_gearstudy.pyi").read_text())
    classes = [node for node in stubs.body if isinstance(node, ast.ClassDef)]
    return {
        f"{of.name}.{node.name}": ast.unparse(node.returns) if node.returns else ""
        for of in classes for node in of.body if isinstance(node, ast.FunctionDef)
    }


DECLARED = hints()


@pytest.fixture(scope="module")
def named(quick, tmp_path_factory):
    """What examples have at hand, as the package's docstring makes it."""
    names = dict(vars(gs))
    exec("\n".join(example.source for example in doctest.DocTestParser().get_examples(gs.__doc__)[:4]), names)
    return {**names, "study": quick, "folder": tmp_path_factory.mktemp("folder")}


@pytest.mark.parametrize("module", MODULES, ids=lambda module: module.__name__)
def test_examples(module, named):
    runner = doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE | doctest.ELLIPSIS)
    found = doctest.DocTestFinder().find(module, globs=named)
    if module is _gearstudy:
        # The finder knows functions of Python, and classes; not what is compiled.
        known = {test.name for test in found}
        parser = doctest.DocTestParser()
        found += [
            parser.get_doctest(thing.__doc__ or "", named, name, None, None)
            for name, thing in COMPILED if f"{module.__name__}.{name}" not in known
        ]
    said = []
    for test in found:
        test.globs = dict(named)
        runner.run(test, out=said.append)
    assert runner.failures == 0, "".join(said)
    assert runner.tries > 0 or module is errors


@pytest.mark.parametrize(("name", "thing"), COMPILED, ids=lambda each: each if isinstance(each, str) else "")
def test_everything_is_described(name, thing):
    if name in ("declarations", "_end"):
        return
    assert ">>>" in (thing.__doc__ or ""), f"{name} has no example"
    for member, value in vars(thing).items() if inspect.isclass(thing) else ():
        if member.startswith("_"):
            continue
        text = inspect.getdoc(value)
        assert text, f"{name}.{member} has no docstring"
        # `help` shows no types: what is an array says its shape.
        hint = DECLARED.get(f"{name}.{member}", "")
        assert "shape (" in text or "Array" not in hint, f"{name}.{member} does not say its shape: {text}"


def test_what_the_package_exports_is_described():
    for name in gs.__all__:
        thing = getattr(gs, name)
        if inspect.isclass(thing) or inspect.isroutine(thing):
            assert inspect.getdoc(thing), name
