"""The name store: addresses, allocation, properties, listing, ownership, limits."""

import time
import tracemalloc

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from yarpy.contact import Contact
from yarpy.errors import AddressError
from yarpy.nameserver.store import Limits, NameStore


@pytest.fixture
def store() -> NameStore:
    return NameStore("192.168.0.3", 21100)


def test_register_fills_in_what_is_left_open(store: NameStore) -> None:
    assert store.register("/x", peer="127.0.0.1") == Contact("tcp", "/x", "127.0.0.1", 21102)
    assert store.register("/y", "tcp", "10.0.0.1", 10002).port == 10002
    assert store.register("/z", "...", "...", -1, peer="10.0.0.9") == Contact(
        "tcp", "/z", "10.0.0.9", 21103
    )
    assert store.register("/u", "udp").host == "localhost", "the address of the asker is unknown"
    assert store.query("/x") == Contact("tcp", "/x", "127.0.0.1", 21102)
    assert store.query("/nope") is None


def test_temporary_names(store: NameStore) -> None:
    assert store.register("...").name == "/tmp/port/1"
    assert store.register("=suffix").name == "/tmp/port/2=suffix"
    store.unregister("/tmp/port/1")
    store.unregister("/tmp/port/2=suffix")
    first = store.register("...")
    assert (first.name, first.port) == ("/tmp/port/1", 21102), "same name, same number"
    assert store.register("...").name == "/tmp/port/2"


def test_a_temporary_name_never_replaces_a_port(store: NameStore) -> None:
    store.register("/tmp/port/1", "tcp", "h", 1)
    assert store.register("...").name == "/tmp/port/2"
    assert store.query("/tmp/port/1") == Contact("tcp", "/tmp/port/1", "h", 1)


def test_multicast_groups(store: NameStore) -> None:
    assert store.register("/m", "mcast") == Contact("mcast", "/m", "224.1.1.3", 21102)
    assert store.register("/n", "mcast").host == "224.1.1.4"
    store.unregister("/m")
    assert store.register("/o", "mcast").host == "224.1.1.3"
    for n in range(252):
        store.register(f"/p{n}", "mcast")
    # c = 255: 224.1.(c div 255 + 1).(c mod 255 + 1)
    assert store.query("/p250") == Contact("mcast", "/p250", "224.1.1.255", 21355)
    assert store.query("/p251") == Contact("mcast", "/p251", "224.1.2.1", 21356)


def test_topics_live_at_the_server(store: NameStore) -> None:
    assert store.register("/tp", "topic") == Contact("topic", "/tp", "192.168.0.3", 21100)


def test_the_newest_registration_wins_and_keeps_the_number(store: NameStore) -> None:
    store.register("/x", peer="a")
    store.assign("/x", "offers", ["tcp"])
    store.register("/other")
    assert store.register("/x", peer="b") == Contact("tcp", "/x", "b", 21102)
    assert store.values("/x", "offers") == []


def test_numbers_are_not_lent_where_a_client_took_them_by_itself(store: NameStore) -> None:
    store.register("/own", "tcp", "here", 21102)
    assert store.register("/x", peer="here").port == 21103
    assert store.register("/y", peer="elsewhere").port == 21104
    store.unregister("/own")
    assert store.register("/z", peer="here").port == 21105


def test_running_out_of_numbers_refuses_and_leaves_nothing_behind() -> None:
    store = NameStore("h", 65000)
    for n in range(65535 - 65001):
        store.register(f"/p{n}")
    assert store.query("/p533") == Contact("tcp", "/p533", "localhost", 65535)
    for name, carrier in (("/late", "tcp"), ("...", "tcp"), ("/late", "mcast")):
        with pytest.raises(AddressError, match="ran out of port numbers"):
            store.register(name, carrier)
    assert store.query("/late") is None
    store.unregister("/p7")
    assert store.register("...", "mcast") == Contact("mcast", "/tmp/port/1", "224.1.1.3", 65009)
    store.register("/x", "tcp", "h", 99)  # those who bring a number are still welcome


def test_a_number_changed_by_hand_comes_back(store: NameStore) -> None:
    store.register("/x")
    store.assign("/x", "socket", ["77"])
    assert store.query("/x") == Contact("tcp", "/x", "localhost", 77)
    assert store.register("/x").port == 21102


def test_address_is_made_of_properties(store: NameStore) -> None:
    store.register("/a", "tcp", "h", 5, "yarp/image")
    assert store.values("/a", "type") == ["yarp/image"]
    store.assign("/a", "host", ["9.9.9.9"])
    store.assign("/a", "carrier", ["udp"])
    assert store.query("/a") == Contact("udp", "/a", "9.9.9.9", 5)
    for key in ("host", "carrier", "socket"):
        store.assign("/a", key, [])
    assert store.query("/a") == Contact("tcp", "/a", "localhost", 10000)
    store.assign("/a", "socket", ["seven"])
    assert store.query("/a") == Contact("tcp", "/a", "localhost", 0)
    store.register("/b", "tcp", "h", 5, "*")
    assert store.values("/b", "type") == []


def test_properties_are_sorted_multisets(store: NameStore) -> None:
    store.register("/x")
    given = ["bar", "12", "3.5", "q s", "1 2", "voc", "voc", "é", "z"]
    expected = ["1 2", "12", "3.5", "bar", "q s", "voc", "voc", "z", "é"]
    assert store.assign("/x", "foo", given) == expected
    assert store.values("/x", "foo") == expected
    assert store.values("/x", "other") == []
    assert store.assign("/x", "foo", []) == []
    assert store.assign("/nope", "k", ["v"]) is None
    assert store.values("/nope", "k") is None


def test_list_by_prefix_in_byte_order(store: NameStore) -> None:
    for name in ("/tmp/port/1", "/tm", "noslash", "/é", "/z", "", "/tmp", "/tmpfile"):
        store.register(name, "tcp", "h", 1)
    names = [contact.name for contact in store.contacts()]
    assert names == ["", "/tm", "/tmp", "/tmp/port/1", "/tmpfile", "/z", "/é", "noslash"]
    assert [c.name for c in store.contacts("/tmp")] == ["/tmp", "/tmp/port/1"]
    assert [c.name for c in store.contacts("/tmp/")] == ["/tmp/port/1"]
    assert [c.name for c in store.contacts("/tm")] == ["/tm"]
    assert [c.name for c in store.contacts("/t")] == []


def test_network_chooses_among_ips(store: NameStore) -> None:
    store.register("/x", "tcp", "10.0.0.1", 5)
    store.assign("/x", "ips", ["127.0.0.1", "10.0.0.1", "192.168.1.1"])
    assert store.query("/x", "127") == Contact("tcp", "/x", "127.0.0.1", 5)
    assert store.query("/x", "8.8") == Contact("tcp", "/x", "10.0.0.1", 5)


def test_owned_names_go_first(store: NameStore) -> None:
    for name in ("/a", "/b", "/c", "/d"):
        store.register(name)
    store.assign("/a", "owns", ["/b", "/missing"])
    store.assign("/b", "owns", ["/c", "/a"])
    assert [gone.name for gone in store.unregister("/a")] == ["/c", "/b", "/a"]
    assert [left.name for left in store.contacts()] == ["/d"]
    assert store.unregister("/a") == []


def test_a_long_chain_of_owners(store: NameStore) -> None:
    for n in range(3000):
        store.register(f"/{n}", "tcp", "h", 1)
        store.assign(f"/{n}", "owns", [f"/{n + 1}"])
    assert len(store.unregister("/0")) == 3000
    assert len(store) == 0


def test_star_is_a_name_like_any_other(store: NameStore) -> None:
    store.register("/x")
    assert store.query("*") is None
    assert store.unregister("*") == []
    assert store.assign("*", "k", ["v"]) is None
    store.register("*", "tcp", "h", 1)
    assert [gone.name for gone in store.unregister("*")] == ["*"]
    assert "/x" in store


def test_limits() -> None:
    store = NameStore(limits=Limits(3, 10, 5, 100, 200, 5))
    with pytest.raises(AddressError, match="10 bytes"):
        store.register("/0123456789")
    with pytest.raises(AddressError, match="10 bytes"):
        store.register("/ok", "tcp", "a.host.name")
    with pytest.raises(AddressError, match="65535"):
        store.register("/ok", "tcp", "h", 65536)
    for name in ("/a", "/b", "/c"):
        store.register(name, "tcp", "h", 1)
    with pytest.raises(AddressError, match="3 names"):
        store.register("/d")
    store.register("/a", "tcp", "h", 2)  # a replacement takes no room
    with pytest.raises(AddressError, match="5 property values"):
        store.assign("/a", "k", ["1", "2", "3"])
    with pytest.raises(AddressError, match="100 characters"):
        store.assign("/a", "k", ["x" * 100])
    with pytest.raises(AddressError, match="10 bytes"):
        store.assign("/a", "k" * 11, [])
    assert store.assign("/a", "k", ["x" * 60]) == ["x" * 60]
    with pytest.raises(AddressError, match="memory"):
        store.assign("/b", "k", ["x" * 70])
    store.assign("/a", "k", [])
    assert store.assign("/b", "k", ["x" * 70]) == ["x" * 70]
    store.unregister("/b")
    assert store.assign("/c", "k", ["x" * 70]) == ["x" * 70]


def test_what_is_no_text_is_refused(store: NameStore) -> None:
    with pytest.raises(AddressError, match="not text"):
        store.register("/\ud800")
    store.register("/x")
    with pytest.raises(AddressError, match="not text"):
        store.assign("/x", "k", ["\ud800"])
    raw = b"/caf\xe9".decode("utf-8", "surrogateescape")
    assert store.register(raw, "tcp", "h", 1).name == raw
    assert [c.name for c in store.contacts()] == [raw, "/x"]


def test_what_changed_is_told(store: NameStore) -> None:
    heard: list[tuple[str, str]] = []
    store.watch(lambda kind, key: heard.append((kind, key)))
    store.register("...", "mcast")
    assert sorted(heard) == [
        ("mcastCursor", "224.1.1.3"),
        ("port", "/tmp/port/1"),
        ("regid", "21102"),
        ("tmpid", "/tmp/port/1"),
    ]
    heard.clear()
    store.assign("/tmp/port/1", "k", ["v"])
    assert heard == [("port", "/tmp/port/1")]
    store.watch(None)
    store.unregister("/tmp/port/1")
    assert heard == [("port", "/tmp/port/1")]


NAMES = st.sampled_from(["/a", "/b", "/c", "...", "=s", "*", "", "/tmp/port/1", "/tmp/port/2"])
STEPS = st.one_of(
    st.tuples(
        st.just("register"),
        NAMES,
        st.sampled_from(["", "tcp", "mcast", "topic"]),
        st.sampled_from(["", "h", "224.1.1.3"]),
        st.sampled_from([0, -1, 5, 10003]),
    ),
    st.tuples(st.just("unregister"), NAMES),
    st.tuples(
        st.just("assign"),
        NAMES,
        st.sampled_from(["owns", "socket", "host", "k"]),
        st.lists(st.sampled_from(["/a", "/b", "10002", "77"]), max_size=3),
    ),
)


@settings(max_examples=200)
@given(st.lists(STEPS, max_size=40))
def test_numbers_lent_are_never_shared(steps: list[tuple[object, ...]]) -> None:
    """Whatever is done to it: no number, group or temporary name is lent twice, none is lost."""
    store = NameStore("s", 10000)
    for verb, *arguments in steps:
        getattr(store, str(verb))(*arguments)
    lent = [value for value, used, _ in store.numbers.rows() if used]
    assert len(lent) == len(set(lent))
    for value, used, owner in store.numbers.rows():
        assert not used or owner in store, f"{value} is lost: lent to {owner}"
    for contact in list(store.contacts()):
        store.unregister(contact.name)
    assert len(store) == 0
    assert not any(used for pool in store.pools.values() for _, used, _ in pool.rows())
    assert store._size == 0 and not store._addresses


def test_numbers_of_strangers_are_not_lent() -> None:
    strangers = {("s", 10002), ("s", 10003)}
    store = NameStore("s", 10000, is_taken=lambda host, number: (host, number) in strangers)
    assert store.register("/a", peer="s").port == 10004
    assert store.register("/b", peer="t").port == 10005
    store.unregister("/a")
    strangers.add(("s", 10004))
    assert store.register("/a", peer="s").port == 10006, "not even by habit"
    assert store.register("/c", "tcp", "s", 10003).port == 10003, "who says a number gets it"


def filled(count: int) -> NameStore:
    store = NameStore("h", 10000)
    for n in range(count):
        store.register(f"/module{n % 50}/port{n}", peer=f"10.0.0.{n % 4}")
    return store


def test_small_at_ten_thousand_names() -> None:
    tracemalloc.start()
    store = filled(9998)
    bytes_per_name = tracemalloc.get_traced_memory()[0] / 9998
    tracemalloc.stop()
    assert bytes_per_name < 4000
    assert len(list(store.contacts("/module7"))) == 200


def test_a_query_looks_one_name_up_and_nothing_else() -> None:
    """A thousand queries take about the same time, however many names there are."""

    def cost(store: NameStore) -> float:
        start = time.thread_time()
        for n in range(1000):
            assert store.query(f"/module{n % 50}/port{n}") is not None
        return time.thread_time() - start

    few, many = filled(1000), filled(9998)
    ratios = [cost(many) / max(cost(few), 1e-9) for _ in range(5)]
    assert min(ratios) < 4


@pytest.mark.parametrize("word", ["/a\x1b[2J", "/a\nb", "/\u202egnp", "/\x9b"])
def test_names_that_a_terminal_would_obey(word: str) -> None:
    store = NameStore()
    for fields in ((word, "tcp", "h", 1), ("/a", word, "h", 1), ("/a", "tcp", word, 1)):
        with pytest.raises(AddressError, match="no control characters"):
            store.register(*fields)
    assert store.query("/a") is None


def test_one_computer_cannot_have_all_port_numbers() -> None:
    store = NameStore(limits=Limits(numbers_per_peer=3))
    for number in range(3):
        store.register(f"/{number}", peer="192.0.2.1")
    store.register("/0", peer="192.0.2.1")  # the same name again takes no more
    with pytest.raises(AddressError, match="as many as one computer gets"):
        store.register("/3", peer="192.0.2.1")
    assert store.register("/3", peer="192.0.2.2").port
    assert store.register("/4", "tcp", "192.0.2.1", 5000, peer="192.0.2.1").port == 5000
    store.unregister("/1")
    assert store.register("/5", peer="192.0.2.1").port
