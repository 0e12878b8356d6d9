"""Every name client keeps the same promises."""

from collections.abc import Iterator

import pytest
from support.name_line import serve_names

from yarpy.contact import Contact
from yarpy.names.base import NameClient, introduce
from yarpy.names.client import YarpNameClient
from yarpy.names.fallback_client import SeveralNames
from yarpy.nameserver.local import LocalNames


@pytest.fixture(params=["local", "client", "several"])
def names(request: pytest.FixtureRequest) -> Iterator[NameClient]:
    if request.param == "local":
        yield LocalNames()
        return
    with serve_names() as server, YarpNameClient("127.0.0.1", server.port, 5.0) as client:
        yield client if request.param == "client" else SeveralNames([client, LocalNames()])


def test_promises(names: NameClient) -> None:
    assert isinstance(names, NameClient)
    contact = names.register("/a", "tcp", "127.0.0.1", 4100)
    assert contact == Contact("tcp", "/a", "127.0.0.1", 4100) == names.query("/a")
    assert names.register("/a/b", "udp", "127.0.0.1", 4101, "yarp/image").carrier == "udp"
    assert names.get("/a/b", "type") == ["yarp/image"]
    temporary = names.register("...", "tcp", "127.0.0.1", 4102)
    assert temporary.name.startswith("/tmp/port/")
    names.announce("/a")
    names.announce("/a", ok=False)
    introduce(names, "/a", {"words": ["y", 6], "more": []})
    assert names.get("/a", "words") == ["6", "y"]
    assert names.set("/a", "words", "two words", "x", 5) == ["5", "two words", "x"]
    assert names.get("/a", "words") == ["5", "two words", "x"]
    assert names.get("/a", "nothing") == names.get("/nope", "words") == []
    assert names.set("/nope", "words", "x") == []
    assert names.list("/a") == [names.query("/a"), names.query("/a/b")]
    assert [c.name for c in names.list()] == ["/a", "/a/b", temporary.name]
    names.unregister("/a")
    names.unregister("/a")
    assert names.query("/a") is None
    assert names.register("...", "mcast").host.startswith("224.1.")
    names.close()
    assert names.query("/a/b") is not None, "a closed client may be used again"
