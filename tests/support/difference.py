"""Where we answer C++ YARP 3.9.1 differently on purpose: capture, step, our answer, the reason.

Rules: the step is the one that asks (role a); our answer is bytes, or a check of them. Everything
that is not listed here has to be equal, byte for byte. What cannot be replayed at all is in
`NOT_REPLAYED`, with its reason; a test sees to it that no capture is in neither place.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass

from yarpy.data.bottle import Bottle
from yarpy.data.value import Vocab
from yarpy.data.walker import Walker
from yarpy.wire.framing import ACK

Check = Callable[[bytes], None]


@dataclass(frozen=True)
class Difference:
    """`ours` instead of what C++ answered to one step, or instead of its silence."""

    ours: bytes | Check
    reason: str


def payload(*elements: object) -> bytes:
    return Bottle(elements).to_bytes()


def refusal(then: bytes = b"") -> Check:
    """`[fail] "why"` and an acknowledgement, followed by `then`."""

    def check(data: bytes) -> None:
        walker = Walker()
        end = walker.advance(data)
        assert walker.done, data
        reply = Bottle.from_bytes(data[:end])
        assert reply[0] == Vocab("fail"), reply
        assert isinstance(reply[1], str), reply
        assert len(reply[1]) > 10, reply
        assert data[end:] == ACK + then

    return check


def reply_line(*lines: str) -> bytes:
    return "".join(f"{line}\r\n" for line in lines).encode()


ECHO_5 = payload(Vocab("ok"), "echo", [5]) + ACK
HANGS = "C++ acknowledges without a reply, for which its own clients wait for ever: we say why"
OUT_OF_STEP = "C++ loses step and understands nothing more; we skip exactly what was announced"
LINE_END = (
    "C++ ends the text of sig objects with a bare LF, that of Bottles with CR LF; we always CR LF"
)
SOUND = (
    "C++ prints a Sound, which is no Bottle, as an empty line; we as a blob that says what it is"
)


def matching(pattern: str) -> Check:
    """Text that is wholly of this shape."""

    def check(data: bytes) -> None:
        assert re.fullmatch(pattern.encode(), data), data

    return check


# Common to replays with bytes alone and to those against a real port.
DIFFERENT: dict[str, dict[int, Difference]] = {
    "bad_bottle_code": {
        2: Difference(refusal(), HANGS),
        4: Difference(ECHO_5, OUT_OF_STEP),
    },
    "bad_item_code": {
        2: Difference(refusal(), HANGS),
        4: Difference(ECHO_5, OUT_OF_STEP),
    },
    "bad_port_command": {2: Difference(ECHO_5, OUT_OF_STEP)},
    "bottle_count_too_big": {
        2: Difference(
            refusal(ECHO_5),
            "C++ takes the missing numbers from the next message; we refuse the short one and "
            "answer the next",
        )
    },
    "bottle_nested_special": {4: Difference(refusal(), HANGS)},
    "unknown_port_command": {4: Difference(ECHO_5, OUT_OF_STEP)},
    "conn_text_ack_sig_replies": {
        2: Difference(b"0.5 1.5 2.5\r\n<ACK>\r\n", LINE_END),
        4: Difference(b"2 3 (0.0 1.0 2.0 10.0 11.0 12.0)\r\n<ACK>\r\n", LINE_END),
        6: Difference(b"[mat] [mono] (1 6 1 3 2) {0 10 20 1 11 21}\r\n<ACK>\r\n", LINE_END),
        8: Difference(matching(r"\{[0-9 ]+\} \(yarpy\.type \(sound\) 51\)\r\n<ACK>\r\n"), SOUND),
    },
}

MONITORS = "we say why a monitor does not start"
WHY = "C++ does not say why it cannot connect; we do"
KEPT = "C++ ends the connection to a port before it looks for the carrier of the next one"
AT_ONCE = (
    "C++ connects, and hangs up with the first message if the monitor does not start; we refuse at "
    "once and say why"
)
REFUSED = r'-1 "Cannot connect to tcp\+.*://cap/in: .*\\r\\n"\r\n<ACK>\r\n'
NOT_CONNECTED = "there is no connection, since its monitor was refused"
NOWHERE = r'-1 "Could not find an incoming connection to /cap/in\\r\\n"\r\n<ACK>\r\n'
REACHED = "in C++ `get out` and `set out` never reach the monitor at the sender's end"
OWN_TEXT = "the prayers are our own; the first two lines are fixed"
MAY_BE_REFUSED = "the process may lack the right to real-time scheduling; we say what is missing"
OWN_THREAD = "C++ remembers the policy for later; we give the output its thread at once"
GRANTED = r'\[(ok|fail)\]( "the system refuses real-time scheduling.*")?\r\n<ACK>\r\n'
SCHEDULED = (
    r"\(sched \(\(policy (1|-1|0)\) \(priority (30|-1|0)\) \(tid -?\d+\)\)\) "
    r"\(qos \(\(tos 0\)\)\)\r\n<ACK>\r\n"
)
POLICY_NAMES = "C++ reads the word SCHED_FIFO as policy 0; we know the names"
DEADLOCK = "C++ deadlocks when a connection asks for its own end; we answer, end it, and serve on"

SELF = (
    r"\(sched \(\(policy -?\d+\) \(priority -?\d+\) \(tid \d+\)\)\) "
    r'\(process \(\(arguments ".*"\) \(name .*\) \(pid \d+\) '
    r"\(policy -?\d\) \(priority -?\d+\)\)\) "
    r'\(platform \(\(hostname "127\.0\.0\.1"\) \(os \w+\)\)\) '
    r'\(port \(\(is_input 1\) \(is_output 1\) \(is_rpc 0\) \(type ""\)\)\)\r\n<ACK>\r\n'
)

# Only against real ports: these answers depend on what a port is and does.
LIVE_DIFFERENT: dict[str, dict[int, Difference]] = {
    **DIFFERENT,
    "admin_add_del": {
        26: Difference(
            matching(r'-1 "Cannot connect to nosuch://cap/in2: no carrier .*\\r\\n"\r\n<ACK>\r\n'),
            WHY,
        ),
        28: Difference(b'"/cap/in" "/cap/in2"\r\n<ACK>\r\n', KEPT),
    },
    "admin_atch_dtch": {
        step: Difference(
            matching(
                r'\[fail\] "Failed to configure the portmonitor plug-in: .*nosuch.*"\r\n<ACK>\r\n'
            ),
            MONITORS,
        )
        for step in (6, 8)
    },
    "admin_pray": {
        2: Difference(
            matching(
                r'"You begin praying to cap\." "You finish your prayer\."( "[^"]+")+\r\n<ACK>\r\n'
            ),
            OWN_TEXT,
        )
    },
    "admin_prop_sched": {
        2: Difference(matching(SELF), "another process on another machine"),
        8: Difference(matching(GRANTED), MAY_BE_REFUSED),
        10: Difference(matching(SCHEDULED), POLICY_NAMES),
        12: Difference(matching(GRANTED), MAY_BE_REFUSED),
        14: Difference(matching(SCHEDULED), OWN_THREAD),
    },
    "api_getqos_1_out": {
        2: Difference(matching(SCHEDULED.replace("tos 0", "tos 144")), OWN_THREAD),
    },
    "api_qos_1_out": {2: Difference(matching(GRANTED), MAY_BE_REFUSED)},
    "api_qos_2_in": {2: Difference(matching(GRANTED), MAY_BE_REFUSED)},
    "cli_sched_set_16_cap_in": {2: Difference(matching(GRANTED), MAY_BE_REFUSED)},
    "ns_admin": {12: Difference(matching(SELF), "another process on another machine")},
    "admin_ros_getPid": {
        2: Difference(
            matching(r'1 "" \d+\r\n<ACK>\r\n<ACK>\r\n'), "another process has another number"
        ),
    },
    "admin_ros_requestTopic": {
        2: Difference(
            matching(r'1 "/cap/out" \(TCPROS "127\.0\.0\.1" \d+\)\r\n<ACK>\r\n<ACK>\r\n'),
            "the port has another number here",
        ),
    },
    "portmonitor_lua_admin_1": {2: Difference(matching(REFUSED), AT_ONCE)},
    "portmonitor_recv_dll_admin_1": {2: Difference(matching(REFUSED), AT_ONCE)},
    "portmonitor_send_admin_3": {2: Difference(b"((level 1))\r\n<ACK>\r\n", REACHED)},
    "portmonitor_send_admin_5": {2: Difference(b"((level 5) (mode fast))\r\n<ACK>\r\n", REACHED)},
    "portmonitor_send_dll_admin_1": {2: Difference(matching(REFUSED), AT_ONCE)},
    "portmonitor_send_dll_admin_2": {2: Difference(matching(NOWHERE), NOT_CONNECTED)},
    "portmonitor_send_dll_admin_4": {2: Difference(b"\r\n<ACK>\r\n", NOT_CONNECTED)},
    "telnet_drop_self_after": {
        0: Difference(
            matching(
                r"Welcome other\r\nThis is /cap/self at tcp://127\.0\.0\.1:\d+/\r\n"
                r"There are no outgoing connections\r\n"
                r"There is an input connection from other to /cap/self using text_ack\r\n<ACK>\r\n"
            ),
            DEADLOCK,
        )
    },
}

NOT_REPLAYED: dict[str, str] = {
    "portmonitor_send_dll": "its monitor is refused as long as there is no port /monitor",
    "api_style_http_1": "in test_http.py: our answer is HTTP, that of C++ a bare line",
}
