"""Ports and plain programs of Zenoh: messages, questions, and what goes wrong."""

from __future__ import annotations

import logging
import time
from queue import Queue
from typing import Any

import pytest
from support.wait import HANG, wait_until

import yarpy
from yarpy.limit import ZENOH_ATTACHMENT, ZENOH_PARAMETERS
from yarpy.peers.zenoh import endpoint
from yarpy.peers.zenoh.endpoint import Publisher, Server, Subscriber
from yarpy.peers.zenoh.library import WAKE
from yarpy.peers.zenoh.transport import share

zenoh = pytest.importorskip("zenoh", reason='Zenoh: pip install "yarpy[zenoh]"')
pytestmark = pytest.mark.usefixtures("names")


def taken(queue: Queue[Any], count: int) -> list[tuple[str, bytes]]:
    samples = [queue.get(timeout=HANG) for _ in range(count)]
    return [(str(sample.key_expr), sample.payload.to_bytes()) for sample in samples]


def test_a_plain_subscriber_gets_what_a_port_writes(client: Any) -> None:
    heard = Queue[Any]()
    client.declare_subscriber("robot/**", heard.put)
    with yarpy.Port("/out") as out:
        out.connect("zenoh+block://robot/arm")  # behind many others it would be dropped
        wait_until(lambda: out.write("?") == 1 and not heard.empty())  # once it is known
        wait_until(lambda: heard.empty() or not heard.get())
        out.write([1, 2.5])
        out.write(b"raw")
        found = []
        while len(found) < 2:
            found += [one for one in taken(heard, 1) if one[1] != b'"?"']
        assert found == [("robot/arm", b"[1, 2.5]"), ("robot/arm", b"raw")]
        assert out.disconnect("zenoh+block://robot/arm") and out.stats.outputs == []


def test_a_port_reads_what_a_plain_program_puts(client: Any) -> None:
    with yarpy.BufferedPort("/in", strict=True) as reader:
        assert yarpy.connect("zenoh://robot/*/goal", "/in").carrier == "zenoh+sub"
        publisher = client.declare_publisher("robot/arm/goal")
        wait_until(lambda: publisher.matching_status.matching)
        publisher.put("[1, 2]")
        publisher.delete()
        publisher.put("free text")
        assert [reader.read(timeout=HANG).value for _ in range(2)] == [[1, 2], "free text"]
        assert yarpy.disconnect("zenoh://robot/*/goal", "/in")


def test_a_subscription_to_many_keys_tells_them_apart(client: Any) -> None:
    with yarpy.BufferedPort("/in", strict=True) as reader:
        reader.connect("zenoh+sub://robot/*/goal")
        for name in ("r1", "r2"):
            publisher = client.declare_publisher(f"robot/{name}/goal")
            wait_until(lambda publisher=publisher: publisher.matching_status.matching)  # type: ignore[misc]
            publisher.put(f'"{name}"')
            message = reader.read(timeout=HANG)
            assert (message.value, message.source) == (name, f"/zenoh://robot/{name}/goal")


def test_a_server_that_raises_replies_with_an_error(client: Any) -> None:
    def answer(message: yarpy.Message) -> object:
        if message.value == ["chosen"]:
            return [yarpy.Vocab("fail"), "not today"]
        raise ZeroDivisionError("division by zero")

    with yarpy.RpcServer("/server", answer) as server:
        server.listen_to("zenoh+srv://robot/raises")

        def ask() -> list[Any]:
            return [*client.get("robot/raises", payload="[1]")]

        wait_until(lambda: ask())
        (reply,) = ask()
        assert reply.ok is None
        assert reply.err.payload.to_string() == "ZeroDivisionError: division by zero"
        with yarpy.RpcClient("zenoh://robot/raises") as asker:
            with pytest.raises(yarpy.RemoteError, match="division by zero") as raised:
                asker.call(1)
            assert raised.value.type == "ZeroDivisionError"
            assert asker.call("chosen") == [yarpy.Vocab("fail"), "not today"]


def test_an_interrupted_server_replies_with_an_error(client: Any) -> None:
    """All who ask share its end, which stays."""
    with yarpy.RpcServer("/server", lambda message: "done") as server:
        server.listen_to("zenoh+srv://robot/paused")

        def ask() -> list[Any]:
            return [*client.get("robot/paused", payload="[1]")]

        wait_until(lambda: ask())
        server.interrupt()
        (reply,) = ask()
        assert reply.err.payload.to_string().startswith("PortClosed: the port is interrupted")
        server.resume()
        (reply,) = ask()
        assert reply.ok.payload.to_string() == '"done"'


def test_a_port_answers_a_plain_get(client: Any) -> None:
    with yarpy.RpcServer("/server", lambda message: ["ok", *message.value]):
        assert yarpy.connect("zenoh+srv://robot/ask", "/server").carrier == "zenoh+srv+sub"

        def ask(**said: Any) -> list[str]:
            return [reply.ok.payload.to_string() for reply in client.get("robot/ask", **said)]

        wait_until(lambda: ask(payload="[1]") == ['["ok", 1]'])
        assert ask() == ['["ok"]']


def test_what_a_plain_program_says_of_its_payload_counts(client: Any) -> None:
    with yarpy.BufferedPort("/in", strict=True) as reader:
        reader.connect("zenoh+sub://robot/typed")
        waits = zenoh.CongestionControl.BLOCK  # where there is no room
        publisher = client.declare_publisher("robot/typed", congestion_control=waits)
        wait_until(lambda: publisher.matching_status.matching)
        publisher.put("42", encoding="text/plain")
        publisher.put(b"42", encoding="application/octet-stream")
        publisher.put("42", encoding="application/json")
        publisher.put("42")
        assert [reader.read(timeout=HANG).value for _ in range(4)] == ["42", b"42", 42, 42]


def test_the_parameters_of_a_plain_get_reach_the_port(client: Any) -> None:
    heard: list[tuple[Any, str]] = []

    def answer(message: yarpy.Message) -> list[str]:
        heard.append((message.value, message.source))
        return ["ok"]

    with yarpy.RpcServer("/server", answer) as server:
        server.listen_to("zenoh+srv://robot/asked")

        def ask(selector: str, **said: Any) -> bool:
            return any(reply.ok is not None for reply in client.get(selector, **said))

        wait_until(lambda: ask("robot/asked"))
        del heard[:]
        assert ask("robot/asked?x=1;name=left arm")
        assert ask("robot/asked?x=1", payload="[2]")
        assert ask("robot/asked", payload="43", encoding="text/plain")
        assert heard[0] == (
            [["x", 1], ["name", "left arm"]],
            "/zenoh://robot/asked?x=1;name=left arm",
        )
        assert heard[1] == ([2], "/zenoh://robot/asked?x=1")
        assert heard[2][0] == "43" and "?" not in heard[2][1]
        assert not ask("robot/asked?x=" + "1" * ZENOH_PARAMETERS)


def test_a_port_asks_a_plain_queryable(client: Any) -> None:
    def answer(query: Any) -> None:
        if query.payload.to_bytes() == b'["bad"]':
            query.reply_err(b"no\x1b such")
        else:
            query.reply("robot/add", b"[3]")

    queryable = client.declare_queryable("robot/add", answer)
    with yarpy.RpcClient("zenoh://robot/add") as asker:
        nobody = [yarpy.Vocab("fail"), "nobody answers at the key robot/add of Zenoh"]
        wait_until(lambda: asker.call(1, 2) != nobody)  # until it is known
        assert asker.call(1, 2) == [3]
        assert asker.call("bad") == [yarpy.Vocab("fail"), r"no\x1b such"]
        queryable.undeclare()
        wait_until(lambda: asker.call(1, 2) == nobody)


def test_too_many_questions_are_refused(
    client: Any, router: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(endpoint, "MOST_QUESTIONS", 2)
    server = Server(share(router), "robot/busy")
    wait_until(lambda: server.waiting == 2 or client.get("robot/busy", timeout=0.1) is None)
    (refused,) = client.get("robot/busy")
    assert refused.err.payload.to_string() == "too many questions are waiting"
    server.close()
    server.close()
    assert server.ended()


def test_more_than_is_read_is_dropped_and_counted(
    router: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(endpoint, "KEPT", 3)
    subscriber, publisher = (kind(share(router), "robot/x") for kind in (Subscriber, Publisher))
    assert isinstance(publisher, Publisher)
    for number in range(10):
        publisher.send([endpoint.Outgoing(bytes([number]))])
    wait_until(lambda: subscriber.dropped == 7)
    assert subscriber.receive() == (subscriber,)
    found = [subscriber.receive() for _ in range(3)]
    assert [item[0].payload for item in found if item] == [b"\7", b"\x08", b"\x09"]  # type: ignore[attr-defined]
    publisher.close()
    subscriber.close()
    with pytest.raises(BrokenPipeError):
        publisher.send([endpoint.Outgoing(b"")])


def test_strange_payloads_are_messages(client: Any, caplog: pytest.LogCaptureFixture) -> None:
    with yarpy.BufferedPort("/in", strict=True) as reader, caplog.at_level(logging.WARNING):
        reader.connect("zenoh+sub://robot/strange")
        publisher = client.declare_publisher("robot/strange")
        wait_until(lambda: publisher.matching_status.matching)
        strange = (b"", b"[[[[", b"\xff\xd8\xff", b'{"a": ', b"\0" * 100)
        for data in strange:
            publisher.put(data)
        for data in strange:
            assert reader.read(timeout=HANG).value in (data, data.decode("latin-1"))
        assert not caplog.text


def test_an_envelope_is_the_attachment(client: Any) -> None:
    heard = Queue[Any]()
    client.declare_subscriber("robot/beside", heard.put)
    with yarpy.Port("/out") as out, yarpy.BufferedPort("/in", strict=True) as reader:
        out.connect("zenoh://robot/beside")
        wait_until(lambda: out.write(1, stamp="7 1.5") and not heard.empty())
        assert heard.get().attachment.to_string() == "7 1.5"
        reader.connect("zenoh+sub://robot/there")
        waits = zenoh.CongestionControl.BLOCK  # where there is no room
        publisher = client.declare_publisher("robot/there", congestion_control=waits)
        wait_until(lambda: publisher.matching_status.matching)
        publisher.put("[1]", attachment="note")
        publisher.put("[2]", attachment=b"x" * 100_000)
        publisher.put("[3]")
        found = [reader.read(timeout=HANG).envelope for _ in range(3)]
        assert found == ["note", "x" * ZENOH_ATTACHMENT, ""]


def test_a_delete_is_a_message_where_it_is_asked_for(client: Any) -> None:
    with yarpy.BufferedPort("/in", strict=True) as reader:
        reader.connect("zenoh+sub+delete://robot/*")
        publisher = client.declare_publisher("robot/gone")
        wait_until(lambda: publisher.matching_status.matching)
        publisher.delete()
        message = reader.read(timeout=HANG)
        assert message.value == [yarpy.Vocab("delete")]
        assert message.source == "/zenoh://robot/gone"


def test_what_only_wakes_a_reader_of_this_process_is_no_delete(client: Any) -> None:
    with yarpy.BufferedPort("/in", strict=True) as reader, share() as shared:
        reader.connect("zenoh+sub+delete://robot/*")
        shared.session.delete("robot/topic", attachment=WAKE)
        shared.session.delete("robot/gone")
        assert reader.read(timeout=HANG).source == "/zenoh://robot/gone"


def test_a_port_puts_with_a_priority(client: Any) -> None:
    heard = Queue[Any]()
    client.declare_subscriber("robot/fast", heard.put)
    with yarpy.Port("/out") as out:
        out.connect("zenoh+priority.REAL_TIME+block+express://robot/fast")
        wait_until(lambda: out.write(1) and not heard.empty())
        sample = heard.get()
        assert sample.priority == zenoh.Priority.REAL_TIME
        assert sample.congestion_control == zenoh.CongestionControl.BLOCK
        assert sample.express


def test_a_port_deletes(client: Any) -> None:
    heard = Queue[Any]()
    client.declare_subscriber("robot/place", heard.put)
    with yarpy.Port("/out") as out:
        out.connect("zenoh+delete+block://robot/place")
        wait_until(lambda: out.write(1) and not heard.empty())
        out.write(yarpy.Vocab("delete"), stamp="7 1.5")
        while (sample := heard.get(timeout=HANG)).kind == zenoh.SampleKind.PUT:
            pass
        assert (str(sample.key_expr), sample.attachment.to_string()) == ("robot/place", "7 1.5")


def test_timestamps_go_both_ways(client: Any) -> None:
    heard = Queue[Any]()
    client.declare_subscriber("robot/when", heard.put)
    before = time.time()
    with yarpy.Port("/out") as out, yarpy.BufferedPort("/in", strict=True) as reader:
        out.connect("zenoh+timestamp://robot/when")
        wait_until(lambda: out.write(1) and not heard.empty())
        assert before - 1 < heard.get().timestamp.get_time().timestamp() < time.time() + 1
        reader.connect("zenoh+sub+timestamp://robot/then")
        waits = zenoh.CongestionControl.BLOCK  # where there is no room
        publisher = client.declare_publisher("robot/then", congestion_control=waits)
        wait_until(lambda: publisher.matching_status.matching)
        when = client.new_timestamp()
        publisher.put("[1]", timestamp=when)
        publisher.put("[2]", timestamp=when, attachment="note")
        first, second = (reader.read(timeout=HANG) for _ in range(2))
        assert first.stamp.time == pytest.approx(when.get_time().timestamp(), abs=1e-6)
        assert second.envelope == "note"


def test_a_port_has_a_token_of_liveliness(client: Any) -> None:
    tokens = client.liveliness()
    seen = Queue[Any]()
    tokens.declare_subscriber("robot/live/*", seen.put)
    with yarpy.Port("/out") as out, yarpy.RpcServer("/server", lambda message: ["ok"]) as server:
        for port, target in ((out, "zenoh+liveliness"), (server, "zenoh+srv+liveliness")):
            key = f"robot/live/{'put' if port is out else 'asked'}"
            (port.connect if port is out else port.listen_to)(f"{target}://{key}")
            sample = seen.get(timeout=HANG)
            assert (str(sample.key_expr), sample.kind) == (key, zenoh.SampleKind.PUT)

        def found() -> set[str]:
            return {str(reply.ok.key_expr) for reply in tokens.get("robot/live/*")}

        wait_until(lambda: found() == {"robot/live/put", "robot/live/asked"})
    gone = [seen.get(timeout=HANG) for _ in range(2)]
    assert [sample.kind for sample in gone] == [zenoh.SampleKind.DELETE] * 2


def test_a_port_hears_tokens_of_liveliness(client: Any) -> None:
    before = client.liveliness().declare_token("robot/alive/r1")
    with yarpy.BufferedPort("/in", strict=True) as reader:
        reader.connect("zenoh+sub+liveliness://robot/alive/*")
        message = reader.read(timeout=HANG)
        assert (message.value, message.source) == (
            [yarpy.Vocab("here")],
            "/zenoh://robot/alive/r1",
        )
        after = client.liveliness().declare_token("robot/alive/r2")
        assert reader.read(timeout=HANG).source == "/zenoh://robot/alive/r2"
        for token, name in ((before, "r1"), (after, "r2")):
            token.undeclare()
            message = reader.read(timeout=HANG)
            assert (message.value, message.source) == (
                [yarpy.Vocab("gone")],
                f"/zenoh://robot/alive/{name}",
            )


def test_what_a_plain_program_says_of_a_sample_keeps_nothing_out(client: Any) -> None:
    """Priority, congestion control, express and reliability are the business of who puts."""
    with yarpy.BufferedPort("/in", strict=True) as reader:
        reader.connect("zenoh+sub://robot/said")
        rows = [
            *({"priority": each} for each in (zenoh.Priority.REAL_TIME, zenoh.Priority.BACKGROUND)),
            {"express": True},
            {"reliability": zenoh.Reliability.BEST_EFFORT},
        ]
        for number, row in enumerate(rows):
            waits = zenoh.CongestionControl.BLOCK
            publisher = client.declare_publisher("robot/said", congestion_control=waits, **row)
            wait_until(lambda publisher=publisher: publisher.matching_status.matching)  # type: ignore[misc]
            publisher.put(str(number))
            assert reader.read(timeout=HANG).value == number
            publisher.undeclare()


def test_a_querier_asks_a_port(client: Any) -> None:
    with yarpy.RpcServer("/server", lambda message: ["ok", *message.value]) as server:
        server.listen_to("zenoh+srv://robot/queried")
        querier = client.declare_querier("robot/queried")
        wait_until(lambda: querier.matching_status.matching)
        (reply,) = querier.get(payload="[1]", attachment="7 1.5")
        assert reply.ok.payload.to_string() == '["ok", 1]'
