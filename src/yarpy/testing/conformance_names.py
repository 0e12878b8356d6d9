"""NamesConformance: what every name client must do, as tests to inherit.

    class TestMine(NamesConformance):
        @contextmanager
        def opened(self):
            yield MyNames(...)              # a service of its own for each test

Rules: methods called `test_*` with plain asserts, as pytest runs them, but without needing it. What
a service does not have is said by the settings, and then not asked.
"""

from __future__ import annotations

import threading
from contextlib import AbstractContextManager
from typing import ClassVar

from yarpy.contact import Contact
from yarpy.names.base import NameClient
from yarpy.port.port import BufferedPort, Port

MANY = 40  # names that several threads register at the same time


class NamesConformance:
    """Subclass it and write `opened`.

    temporary: `...` asks for a name. properties: `set` and `get` keep values. replaces: who
    registers a name that is taken gets it, as with YARP's own servers; else the newcomer may be
    refused. listed: `list` shows ports. timeout: seconds that two ports may take to meet.
    """

    temporary: ClassVar[bool] = True
    properties: ClassVar[bool] = True
    replaces: ClassVar[bool] = True
    listed: ClassVar[bool] = True
    timeout: ClassVar[float] = 10.0

    def opened(self) -> AbstractContextManager[NameClient]:
        """Return a client of a service that no other test uses."""
        raise NotImplementedError("write opened(), which gives a name client")

    def test_has_every_member(self) -> None:
        with self.opened() as names:
            assert isinstance(names, NameClient)
            assert isinstance(names.allocates, bool)

    def test_finds_what_was_registered(self) -> None:
        with self.opened() as names:
            found = names.register("/suite/a", "tcp", "127.0.0.1", 4711)
            # The host may be another one: as other computers reach this one.
            assert found == Contact("tcp", "/suite/a", found.host, 4711) and found.host
            names.announce("/suite/a")
            assert names.query("/suite/a") == found
            names.unregister("/suite/a")

    def test_knows_nothing_of_other_names(self) -> None:
        with self.opened() as names:
            assert names.query("/suite/nobody") is None
            names.unregister("/suite/nobody")  # is ignored
            if self.properties:
                assert [*names.get("/suite/nobody", "key")] == []

    def test_forgets_what_was_unregistered(self) -> None:
        with self.opened() as names:
            names.register("/suite/a", "tcp", "127.0.0.1", 4711)
            names.unregister("/suite/a")
            assert names.query("/suite/a") is None

    def test_hands_out_temporary_names(self) -> None:
        if not self.temporary:
            return
        with self.opened() as names:
            number = None if names.allocates else 4711
            one = names.register("...", "tcp", "127.0.0.1", number)
            other = names.register("...", "tcp", "127.0.0.1", number and number + 1)
            assert one.name.startswith("/") and other.name.startswith("/")
            assert one.name != other.name
            names.unregister(one.name)
            names.unregister(other.name)

    def test_hands_out_numbers_where_it_says_so(self) -> None:
        with self.opened() as names:
            if names.allocates:
                found = names.register("/suite/a")
                assert found.host and 0 < found.port < 65536
                names.unregister("/suite/a")

    def test_gives_a_name_to_who_comes_last(self) -> None:
        if not self.replaces:
            return
        with self.opened() as names:
            names.register("/suite/a", "tcp", "127.0.0.1", 4711)
            names.register("/suite/a", "tcp", "127.0.0.1", 4712)
            found = names.query("/suite/a")
            assert found is not None and found.port == 4712
            names.unregister("/suite/a")

    def test_lists_what_is_below_a_name(self) -> None:
        if not self.listed:
            return
        with self.opened() as names:
            for number, name in enumerate(("/suite/a", "/suite/a/b", "/suite/ab"), 4711):
                names.register(name, "tcp", "127.0.0.1", number)
                names.announce(name)
            every = {item.name for item in names.list()}
            assert {"/suite/a", "/suite/a/b", "/suite/ab"} <= every
            below = {item.name for item in names.list("/suite/a")}
            assert below == {"/suite/a", "/suite/a/b"}
            for name in ("/suite/a", "/suite/a/b", "/suite/ab"):
                names.unregister(name)

    def test_keeps_properties(self) -> None:
        if not self.properties:
            return
        with self.opened() as names:
            names.register("/suite/a", "tcp", "127.0.0.1", 4711)
            assert [*names.set("/suite/a", "accepts", "tcp", "udp")]
            assert {*names.get("/suite/a", "accepts")} == {"tcp", "udp"}
            assert [*names.get("/suite/a", "nothing")] == []
            names.unregister("/suite/a")

    def test_serves_many_threads(self) -> None:
        with self.opened() as names:
            failed: list[BaseException] = []

            def work(number: int) -> None:
                try:
                    name = f"/suite/thread/{number}"
                    names.register(name, "tcp", "127.0.0.1", 20_000 + number)
                    found = names.query(name)
                    assert found is not None and found.port == 20_000 + number
                    names.unregister(name)
                except BaseException as error:
                    failed.append(error)

            threads = [threading.Thread(target=work, args=(number,)) for number in range(MANY)]
            for thread in threads:
                thread.start()
            for thread in threads:
                thread.join()
            assert failed == []

    def test_can_be_used_again_after_close(self) -> None:
        with self.opened() as names:
            names.close()
            names.register("/suite/a", "tcp", "127.0.0.1", 4711)
            assert names.query("/suite/a") is not None
            names.unregister("/suite/a")

    def test_lets_ports_meet(self) -> None:
        with (
            self.opened() as names,
            BufferedPort("/suite/in", names=names) as reader,
            Port("/suite/out", names=names) as writer,
        ):
            writer.connect("/suite/in")
            writer.write(["hello", 1])
            assert reader.read(timeout=self.timeout).value == ["hello", 1]
        with self.opened() as names:
            assert names.query("/suite/out") is None or not self.listed
