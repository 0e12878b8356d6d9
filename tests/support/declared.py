"""Holds services that are declared in Python against their `.thrift` file."""

from pathlib import Path
from types import ModuleType
from typing import Any

from yarpy.kits.thrift import Service, Struct, describe, load


def assert_as_the_file_says(module: ModuleType) -> None:
    """Compare the services and structs of a module `functions` with those of its file: names, docs,
    types and defaults, and the bytes of a question and of every struct."""
    said = load(Path(str(module.__file__)).with_suffix(".thrift"))
    compared = 0
    for name, theirs in vars(said).items():
        if not isinstance(theirs, type) or not issubclass(theirs, Service | Struct):
            continue
        ours: Any = getattr(module, name, None)
        if name == "Status":
            from yarpy.kits.devices.declared import Status as ours  # noqa: N813
        assert ours is not None, f"{name} is in the file alone"
        assert describe(ours) == describe(theirs)
        compared += 1
        if issubclass(theirs, Struct):
            assert ours().to_wire() == theirs().to_wire()
            nested = [spec.nested for spec in theirs._specs()]
            assert [spec.nested for spec in ours._specs()] == nested
            continue
        for method, other in theirs._methods.items():
            mine = ours._methods[method]
            assert mine.head == other.head and mine.words == other.words
            assert [part.nested for part in mine.parts] == [part.nested for part in other.parts]
            # an answer of nothing but defaults
            assert mine.answer(mine.result()) == other.answer(other.result())
    services = [one for one in vars(module).values() if isinstance(one, type)]
    assert compared >= sum(one.__module__ == module.__name__ for one in services) > 0
