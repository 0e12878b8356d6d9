"""The classes of an event loop have what the others have: no method can be missing."""

import inspect

import pytest

import yarpy
from yarpy import aio

PAIRS = [
    (yarpy.Port, aio.Port),
    (yarpy.BufferedPort, aio.BufferedPort),
    (yarpy.RpcServer, aio.RpcServer),
    (yarpy.RpcClient, aio.RpcClient),
]
# What a class of one kind has for itself, and why.
SYNC_ONLY = {
    "__iter__", "__enter__", "__exit__",  # have an awaited form
    "__del__",  # the port underneath is what complains of not being closed
}  # fmt: skip
AIO_ONLY = {"open", "port", "__aiter__", "__aenter__", "__aexit__"}
# What a loop cannot do: it would not turn while it asks a socket again and again.
SYNC_PARAMETERS = {"spin", "register", "role", "lock"}


def public(cls):
    """The names that programs use, those of `object` left out."""
    names = {name for one in cls.__mro__[:-1] for name in vars(one)}
    special = {name for name in names if name.startswith("__")}
    wanted = {name for name in special if name in SYNC_ONLY | AIO_ONLY}
    return {name for name in names if not name.startswith("_")} | wanted


@pytest.mark.parametrize(("sync", "awaited"), PAIRS, ids=lambda cls: cls.__name__)
def test_public_names_are_the_same(sync, awaited):
    assert public(awaited) - AIO_ONLY == public(sync) - SYNC_ONLY


@pytest.mark.parametrize(("sync", "awaited"), PAIRS, ids=lambda cls: cls.__name__)
def test_parameters_are_the_same(sync, awaited):
    different = {}
    for name in sorted(public(sync) & public(awaited) | {"__init__"}):
        ours, theirs = (getattr(cls, name) for cls in (awaited, sync))
        if isinstance(theirs, property):
            assert isinstance(ours, property), name
            continue
        found = [
            {
                parameter.name: (parameter.kind, parameter.default)
                for parameter in inspect.signature(method).parameters.values()
                if parameter.name not in SYNC_PARAMETERS
            }
            for method in (ours, theirs)
        ]
        if found[0] != found[1]:
            different[name] = found
    assert not different


@pytest.mark.parametrize(("sync", "awaited"), PAIRS, ids=lambda cls: cls.__name__)
def test_properties_exist_before_and_after_the_port_is_open(sync, awaited):
    made = awaited("/x", *([lambda message: None] if awaited is aio.RpcServer else []))
    assert not made.closed
    assert made.__class__.__name__ == sync.__name__
    with pytest.raises(yarpy.PortClosed, match="not open"):
        made.interrupt()
