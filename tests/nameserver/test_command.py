"""The command language beyond what `test_capture` replays: odd cases, HTTP, events, strangers."""

import threading
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.name_line import new_service
from support.wait import HANG

from yarpy.contact import Contact
from yarpy.data.bottle import Bottle
from yarpy.errors import YarpError
from yarpy.names.registration_line import END
from yarpy.nameserver.command import NameService, without_request
from yarpy.nameserver.reply import Reply
from yarpy.nameserver.store import Limits, NameStore
from yarpy.nameserver.topology import Topology


@pytest.fixture
def service() -> NameService:
    return new_service(21100)


def ask(service: NameService, *commands: str) -> list[str]:
    """The lines of the last reply, without the end line; a Bottle reply is marked by `>`."""
    for command in commands:
        reply = service.answer_text(command, "127.0.0.1")
    if reply.bottle is not None:
        assert reply.lines == ()
        return [f"> {reply.bottle.to_text()}"]
    assert reply.lines[-1] == END
    return list(reply.lines[:-1])


# Every row continues where the one before it left off.
DIALOGUE = [
    ("register /x", ["registration name /x ip 127.0.0.1 port 21102 type tcp"]),
    ("register /y tcp 10.0.0.1 10002", ["registration name /y ip 10.0.0.1 port 10002 type tcp"]),
    ("register /z tcp ... ...", ["registration name /z ip 127.0.0.1 port 21103 type tcp"]),
    ("register ...", ["registration name /tmp/port/1 ip 127.0.0.1 port 21104 type tcp"]),
    ("register /m mcast ... ...", ["registration name /m ip 224.1.1.3 port 21105 type mcast"]),
    ("register /tp topic", ["registration name /tp ip 127.0.0.1 port 21100 type topic"]),
    (
        "register =suffix",
        ["registration name /tmp/port/2=suffix ip 127.0.0.1 port 21106 type tcp"],
    ),
    (
        'register "/grab" "..." "..." -1 "yarp/image"',
        ["registration name /grab ip 127.0.0.1 port 21107 type tcp"],
    ),
    ("get /grab type", ["port /grab property type = yarp/image"]),
    (
        "bot register /bb",
        ["port", "name /bb", "ip 127.0.0.1", "port_number 21108", "carrier tcp"],
    ),
    ("bot unregister /bb", ["port", "error -2 port not known"]),
    (
        "bot query /x",
        ['> port (name "/x") (ip "127.0.0.1") (port_number 21102) (carrier tcp)'],
    ),
    ("bot query /nope", ['> port (error -2 "port not known")']),
    ("query udp://x", ["registration name /x ip 127.0.0.1 port 21102 type tcp"]),
    ("query /udp://x", ["registration name /x ip 127.0.0.1 port 21102 type tcp"]),
    ("query tcp:/x", []),
    ("set /x ips 10.0.0.7 127.0.0.1", ["port /x property ips = 10.0.0.7 127.0.0.1"]),
    ("query /net=10/x", ["registration name /x ip 10.0.0.7 port 21102 type tcp"]),
    ("query /NET=127/x", ["registration name /x ip 127.0.0.1 port 21102 type tcp"]),
    ("query /net=9/x", ["registration name /x ip 127.0.0.1 port 21102 type tcp"]),
    (
        'set /x foo bar 12 3.5 "q s" (1 2) [voc]',
        ["port /x property foo = 1 2 12 3.5 bar q s voc"],
    ),
    ("bot get /x foo", ['> "1 2" 12 3.5 bar "q s" voc']),
    ("bot set /x foo x y x", ["> x x y"]),
    ("bot get /nope foo", ["> "]),
    ("bot set /nope foo 1", ["> "]),
    ("check /x foo y", ["port /x property foo value y present true"]),
    ("check /x foo 7", ["port /x property foo value 7 present false"]),
    ("bot check /x foo y", ["port /x property foo value y present true"]),
    ("check /x foo (1 (2))", ["port /x property foo value 1 (2) present false"]),
    (
        'set /x odd "a\\\\b" "x\\"y" "[voc]" "(1 2)"',
        ["port /x property odd = (1 2) [voc] a\\\\b x\\y"],
    ),
    ("bot get /x odd", ['> (1 2) [voc] "a\\\\b" "x\\"y"']),
    ("check /nope foo y", []),
    ("bot route /x /y", ["port /x route /y = tcp://y"]),
    ("route /x DEST", ["port /x route DEST = tcp:/DEST"]),
    ("set /x yarprun true", ["port /x property yarprun = true"]),
    ("runners", ["registration name /x ip 127.0.0.1 port 21102 type tcp"]),
    (
        "bot runners",
        ['> ports (port (name "/x") (ip "127.0.0.1") (port_number 21102) (carrier tcp))'],
    ),
    ("set /x socket 77", ["port /x property socket = 77"]),
    ("query /x", ["registration name /x ip 127.0.0.1 port 77 type tcp"]),
    ("bot gc", ["garbage collection done."]),
    ("bogus", []),
    ("version", []),
    ("", []),
    ("bot", []),
    ("NAME_SERVER", []),
    ("NAME_SERVER bot runners", None),
    ("bot announce /x", []),
    ("NAME_SERVER announce /x", []),
    ("announce", ["> [ok]"]),
    ('topic /t1 "(a 1)"', ["> [ok]"]),
    ("topic /t0", ["> [ok]"]),
    ("topic", ['> "/t0" "/t1"']),
    ("untopic /nope", ["> [ok]"]),
    ("subscribe /s1 topic://topic1", ["> [ok]"]),
    ("subscribe /x /y from", ["> [ok]"]),
    ("subscribe /nope /y from", ["> [ok]"]),
    (
        "subscribe",
        [
            '> subscriptions (subscription (src "/s1") (dest "topic://topic1") (topic 0 1)) '
            '(subscription (src "/x") (dest "/y") (mode from))'
        ],
    ),
    ("subscribe topic1", ["> subscriptions"]),
    ("subscribe /s1 7", None),
    ("register 123 tcp h 5", ["registration name  ip h port 5 type tcp"]),
    ("query 7", ["registration name  ip h port 5 type tcp"]),
    ("unregister (a b)", []),
    ("register true tcp h 5.9", ["registration name true ip h port 5 type tcp"]),
    ("unregister true", []),
    ('set /x (a b) "" c', ["port /x property a b =  c"]),
    ("bot get /x (a b)", ["> c"]),
    ("register /tq topic ... -1", ["registration name /tq ip 127.0.0.1 port 21109 type topic"]),
    ('set /tq host ""', ["port /tq property host = "]),
    ("query /tq", ["registration name /tq ip localhost port 21109 type topic"]),
    (
        "subscribe /topic1",
        ['> subscriptions (subscription (src "/s1") (dest "topic://topic1") (topic 0 1))'],
    ),
    ("subscribe /x /y both", None),
    ("type yarp image", ["> [fail]"]),
    ('type yarp image "(w 1)"', ["> [ok]"]),
    ("type yarp image", ['> type yarp image "(w 1)"']),
    ("type yarp", ["> [fail]"]),
    ("type ros image x", ["> [fail]"]),
    ("unregister *", []),
    ("query /y", ["registration name /y ip 10.0.0.1 port 10002 type tcp"]),
]


def test_dialogue(service: NameService) -> None:
    for command, expected in DIALOGUE:
        got = ask(service, command)
        assert expected is None or got == expected, command


def test_help(service: NameService) -> None:
    plain = ask(service, "help")
    assert plain[0] == "Here are some ways to use the name server:"
    assert plain[2] == "+ list [$prefix]"
    reply = service.answer_text("bot help")
    assert list(reply.bottle or ()) == plain[1:]
    assert len(plain) == 14


def test_owned_names_leave_a_word_each(service: NameService) -> None:
    ask(service, "register /a", "register /b mcast", "register /c", "set /a owns /b /c")
    reply = service.answer_text("unregister /a")
    assert reply.lines == ("old", "old", END)
    assert [event.to_text() for event in reply.events] == ['[del] "/c"', '[del] "/a"']
    assert ask(service, "list") == []
    assert ask(service, "register /a", "set /a owns /none /none2", "unregister /a") == ["old"] * 2


def test_an_ipv4_peer_of_an_ipv6_server_is_named_as_ipv4(service: NameService) -> None:
    reply = service.answer_text("register /x", "::ffff:10.0.0.7")
    assert reply.lines[0] == "registration name /x ip 10.0.0.7 port 21102 type tcp"


def test_registering_again_says_so_to_listeners(service: NameService) -> None:
    assert [e.to_text() for e in service.answer_text("register /x").events] == ['[add] "/x"']
    assert [e.to_text() for e in service.answer_text("register /x").events] == [
        '[del] "/x"',
        '[add] "/x"',
    ]
    assert service.answer_text("register /m mcast").events == ()
    assert service.answer_text("unregister /m").events == ()
    assert service.answer_text("unregister /nope").events == ()


def test_actions_of_persistent_connections(service: NameService) -> None:
    ask(service, "register /a", "register /b", "announce /a", "announce /b")
    (action,) = service.answer_text("subscribe /a udp://b").actions
    assert (action.kind, action.ask, action.destination, action.carrier) == (
        *("connect", "/a", "/b", "udp"),
    )
    gone = service.answer_text("register /a")
    assert [(a.kind, a.ask) for a in gone.actions] == [("disconnect", "/b")]
    assert [a.kind for a in service.answer_text("announce /a").actions] == ["connect"]
    assert service.answer_text("unsubscribe /a /b").actions == ()
    assert service.answer_text("unregister /a").actions == ()


def test_a_subscription_dies_with_its_end(service: NameService) -> None:
    ask(service, "register /a", "register /b", "subscribe /a /b to")
    assert ask(service, "unregister /b", "subscribe") == ["> subscriptions"]


def test_unregistering_what_was_only_announced(service: NameService) -> None:
    ask(service, "announce /a", "unregister /a")
    assert service.topology.live == {}


def test_somebody_complains(service: NameService) -> None:
    ask(service, "announce /a")
    assert "/a" in service.topology.live
    service.topology.clock = lambda: 2000.0
    assert ask(service, "announce /a 0") == ["> [ok]"]
    assert "/a" not in service.topology.live
    assert ask(service, "announce /a", "gc") == ["garbage collection done."]
    assert service.topology.live == {}


def test_refusals_are_said_in_the_reply() -> None:
    limits = Limits(names=2, name_bytes=20, values_per_name=5, subscriptions=1)
    service = NameService(NameStore("h", 65534, limits), Topology(lambda: 0.0, limit=1))
    for command, start in (
        ("register /x", "error ran out of port numbers"),
        (f"register /{'x' * 20} tcp h 5", "error a name is at most 20 bytes"),
        ("register /x tcp h 65536", "error port number 65536"),
        ("register /x tcp h 1", "registration name /x"),
        ("set /x k 1 2 3 4", "error a name has at most 5"),
        ("announce /x", "> [ok]"),
        ("announce /y", "> [fail] "),
        ("subscribe /x /y", "> [ok]"),
        ("subscribe /y /x", "> [fail] "),
        ("register /y tcp h 1", "registration name /y"),
        ("register /z tcp h 1", "error this server keeps at most 2 names"),
    ):
        assert ask(service, command)[0].startswith(start)


def test_a_failed_registration_still_says_what_it_replaced() -> None:
    service = NameService(NameStore("h", 65533), Topology(lambda: 0.0))
    ask(service, "register /last", "register /x tcp h 1")
    reply = service.answer_text("register /x")
    assert reply.lines[0].startswith("error ran out")
    assert [event.to_text() for event in reply.events] == ['[del] "/x"']


# --- what HTTP adds

JUNK = '(REQUEST_URI "/?req=x") (format json) (req x)'


@pytest.mark.parametrize(
    ("command", "expected"),
    [
        ("query /x", '> port (name "/x") (ip "127.0.0.1") (port_number 21102) (carrier tcp)'),
        ("get /x pp", "> 7"),
        ("check /x pp 7", "port /x property pp value 7 present true"),
        ("topic", "> "),
        ("subscribe", "> subscriptions"),
        ("set /x pp 8 (a b c) 9", '> 8 9 "a b c"'),
        ("bogus", None),
    ],
)
def test_http_requests_are_json_and_lose_their_junk(
    service: NameService, command: str, expected: str | None
) -> None:
    ask(service, "register /x", "set /x pp 7")
    assert ask(service, f"{command} {JUNK} (port /x)") == ([expected] if expected else [])


def test_http_registration_registers(service: NameService) -> None:
    assert ask(service, f"register /x tcp {JUNK}", "query /x") == [
        "registration name /x ip 127.0.0.1 port 21102 type tcp"
    ]


def test_other_formats_are_old_style(service: NameService) -> None:
    ask(service, "register /x")
    assert ask(service, "query /x (format html)") == [
        "registration name /x ip 127.0.0.1 port 21102 type tcp"
    ]
    assert without_request(["set", "/x", "k", ["a", "b"]]) == (
        ["set", "/x", "k", ["a", "b"]],
        False,
    )


# --- multicast


def test_multicast_may_ask_but_not_change(service: NameService) -> None:
    ask(service, "register /root tcp 10.0.0.1 10000")
    line = "registration name /root ip 10.0.0.1 port 10000 type tcp"
    assert service.answer_multicast("query /root") == line
    assert service.answer_multicast("NAME_SERVER query /root") == line
    assert service.answer_multicast("query /nope") == END
    assert service.answer_multicast("bot get /root k") == ""
    for command in ("unregister /root", "bot register /x", "announce /root", "", "(" * 300):
        assert service.answer_multicast(command) is None
    assert ask(service, "query /root") == [line]


# --- strangers

VERBS = [
    *("query", "register", "unregister", "list", "runners", "set", "get", "check", "route", "gc"),
    *("help", "announce", "subscribe", "unsubscribe", "topic", "untopic", "type"),
    *("bot", "NAME_SERVER", "web", "", "..."),
]
WORDS = st.one_of(
    st.sampled_from([*VERBS, "/a", "/b", "/net=1/a", "topic://t", "*", "yarp", "mcast", "owns"]),
    st.integers(-(2**63), 2**63 - 1),
    st.floats(),
    st.booleans(),
    st.text(max_size=20),
    st.binary(max_size=20),
)
ITEMS: st.SearchStrategy[Any] = st.recursive(
    WORDS, lambda inner: st.lists(inner, max_size=4).map(Bottle), max_leaves=8
)


def sound(reply: Reply) -> None:
    assert isinstance(reply, Reply)
    if reply.bottle is None:
        assert reply.lines[-1] == END
        assert not any("\n" in line or "\r" in line for line in reply.lines)
    else:
        reply.bottle.to_text()
    for event in reply.events:
        event.to_bytes()


@settings(max_examples=150)
@given(st.lists(st.tuples(st.sampled_from(VERBS), st.lists(ITEMS, max_size=6)), max_size=6))
def test_any_command_is_answered(commands: list[tuple[str, list[Any]]]) -> None:
    service = new_service()
    for verb, rest in commands:
        try:
            sound(service.answer(Bottle([verb, *rest]), "127.0.0.1"))
        except YarpError as error:
            raise AssertionError("nothing a stranger sends raises") from error


@settings(max_examples=300)
@given(st.binary(max_size=200))
def test_any_line_is_answered(line: bytes) -> None:
    service = new_service()
    sound(service.answer_text(line))
    service.answer_multicast(line.decode("utf-8", "surrogateescape"))


def test_hundreds_of_brackets_are_answered(service: NameService) -> None:
    assert ask(service, f"query {'(' * 5000}{')' * 5000}") == []


def test_many_threads_get_different_numbers(service: NameService) -> None:
    def register(who: int) -> None:
        for n in range(100):
            service.answer_text(f"register /{who}/{n}")

    threads = [threading.Thread(target=register, args=(who,)) for who in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    ports = [contact.port for contact in service.store.contacts()]
    assert len(ports) == len(set(ports)) == 800


# --- a name that a living port has


def with_living(*living: str) -> NameService:
    return NameService(
        NameStore("127.0.0.1", 21100), Topology(lambda: 0.0), lambda contact: contact.name in living
    )


@pytest.mark.parametrize("again", ["", " ... ... -1", " tcp 127.0.0.1 0 yarp/image"])
def test_a_living_port_keeps_its_name_and_number(again: str) -> None:
    service = with_living("/x")
    first = ask(service, "register /x ... ... -1 yarp/sound")
    ask(service, "announce /x", "set /x process 5")
    reply = service.answer_text("register /x" + again, "127.0.0.1")
    assert list(reply.lines[:-1]) == first, "so that the newcomer cannot listen"
    assert (reply.events, reply.actions) == ((), ())
    assert ask(service, "get /x process") == ["port /x property process = 5"]
    assert ask(service, "get /x type") == ["port /x property type = yarp/sound"]
    nested = ask(service, f"NAME_SERVER bot register /x{again}")
    assert nested == ["port", "name /x", "ip 127.0.0.1", "port_number 21102", "carrier tcp"]


@pytest.mark.parametrize(
    "again",
    ["/x tcp 127.0.0.1 5", "/x tcp 10.0.0.9", "/x mcast", "/dead", "..."],
    ids=["own number", "other host", "multicast", "dead port", "temporary"],
)
def test_other_registrations_are_as_ever(again: str) -> None:
    before = ("register /x", "register /dead", "register /own tcp 127.0.0.1 21103")
    living, plain = with_living("/x"), with_living()
    assert ask(living, *before, f"register {again}") == ask(plain, *before, f"register {again}")
    assert ask(living, "list") == ask(plain, "list")


def test_others_are_served_while_a_port_is_asked_whether_it_lives() -> None:
    asked, goes_on = threading.Event(), threading.Event()

    def is_alive(contact: Contact) -> bool:
        asked.set()
        return goes_on.wait(HANG)

    service = NameService(NameStore("127.0.0.1", 21100), Topology(lambda: 0.0), is_alive)
    replies = [ask(service, "register /x")]
    slow = threading.Thread(target=lambda: replies.append(ask(service, "register /x")))
    slow.start()
    assert asked.wait(HANG)
    others = threading.Thread(target=lambda: ask(service, "unregister /x", "register /y"))
    others.start()
    others.join(HANG)
    assert not others.is_alive()
    goes_on.set()
    slow.join(HANG)
    assert replies[1] == replies[0], "the number of before, or a new one: it has been unregistered"
    assert ask(service, "query /x") == replies[1]
