"""The limits of everything that reads what others wrote: decoders, parsers, scripts.

What an owner may change, for what arrives packed:

    YARPY_MAX_PICTURE     bytes of pixels, of a JPEG or PNG file or a depth image: 256 MiB; and of
                          what is kept between the scans of a JPEG
    YARPY_MAX_UNPACKED    bytes of any other message that was compressed: 64 MiB
    YARPY_MAX_ELEMENTS    elements of one message, with those of the lists in it: 4194304

Rules: a limit counts what would be built, before it is built: bytes, items, levels, steps. Whoever
reads bytes of others takes its limits from here, where they can be seen together and compared
(tests/test_limit.py lists who does not). Those of the environment hold beside the largest message
that a port takes, and for every connection, since the peer may have chosen the monitor; what shares
a message shares them (`Quota`). A setting that is not a number is ignored, with a warning.
"""

from __future__ import annotations

import os
from collections.abc import Hashable, Iterable
from dataclasses import dataclass
from functools import lru_cache
from typing import Final

from yarpy.errors import DecodeError

# HTTP
HTTP_CHALLENGES: Final = 8192  # characters of all that a camera offers
HTTP_CHALLENGE_VALUE: Final = 1024  # characters of a value that is sent back, such as its nonce
HTTP_HEAD: Final = 1 << 14  # bytes of a request line with all headers
HTTP_BODY: Final = 1 << 24  # bytes
HTTP_LINE: Final = 1 << 14  # bytes of one line
HTTP_LINES: Final = 200  # of a head
HTTP_FIELDS: Final = 1000  # of a form
HTTP_FILLED: Final = 1 << 20  # characters that the arguments may expand to
HTTP_CHUNK_LINE: Final = 1000  # bytes of a chunk's size line
MJPEG_FRAME: Final = 1 << 26  # bytes of one JPEG file
WEBSOCKET_TEXT: Final = 1 << 24  # bytes of a message in JSON

# YARP
TEXT_LINE: Final = 1 << 24  # bytes of one payload spelled as text
NAME_LINE: Final = 1 << 20  # bytes of a command
# passes over all pixels that one file may ask for; progressive ones have ten
JPEG_SCANS: Final = 64
EMPTY_IMAGE: Final = 1 << 16  # the longest side of an image that has no pixels
ARRAY_DIMENSIONS: Final = 32  # of an array with a description
PROPERTIES: Final = 1 << 20  # bytes of all together
NAME_REPLY: Final = 64 << 20  # bytes of one whole reply
DISCOVERY_DATAGRAM: Final = 65_507  # bytes of payload in one UDP datagram over IPv4
SERVER_COMMAND: Final = 1 << 20  # bytes of one command
SERVER_UNFINISHED: Final = 1 << 24  # bytes of all that have begun to come
SERVER_EVENTS: Final = 10_000  # that wait for readers
PEEK_MESSAGE: Final = 64 << 20  # bytes of a message
SAMPLE_ANSWER: Final = 1 << 22  # bytes of an answer
SAMPLE_ITEMS: Final = 4096  # connections of one port, and elements of a list
INI_DEPTH: Final = 20  # files that include one another
INI_FILE: Final = 16 << 20  # bytes of one file

# Programs that are started
RUN_REQUEST: Final = 1 << 18  # bytes of a request
RUN_COMMAND: Final = 1 << 16  # characters of a command, or of its environment
RUN_PROGRAMS: Final = 1000  # of one server at a time
RUN_BEHIND: Final = 8 << 20  # bytes of a program's output that wait for their reader
LOG_MESSAGE: Final = 1 << 20  # bytes of a line with all that is told of it
LOG_ORIGINS: Final = 1000  # programs of which it is known what came last
LOG_WAITING: Final = 100_000  # lines that wait to be shown
LOG_WAITING_BYTES: Final = 64 << 20  # ... and what they hold
RUN_KEPT: Final = 200  # lines of a program's output that can be asked for

# Scripts
SCRIPT_INSTRUCTIONS: Final = 100_000_000  # instructions in one call: a second or so
SCRIPT_SECONDS: Final = 5.0  # of a processor in one call, where each of them takes long
# steps that patterns may take in one call at their worst: half a second
SCRIPT_UNWATCHED: Final = 1 << 27
SCRIPT_MEMORY: Final = 128 << 20  # bytes of one script
SCRIPT_FILE: Final = 4 << 20  # bytes of a script
SCRIPT_EVENTS: Final = 1000  # events of one monitor
CONSTRAINT_DEPTH: Final = 100  # parentheses and `not`s inside each other

# ROS
ROS_HEADER: Final = 1 << 20  # bytes of that of a connection
ROS_HEADER_FIELDS: Final = 64  # of a connection
# of a type that a peer describes, with those of the messages in it: each becomes code once a value
# is read or written; the largest message of ROS has 63
ROS_PEER_FIELDS: Final = 400
ROS_REASON: Final = 1 << 16  # bytes of the text that says why there is no answer
ROS_MASTER_ANSWER: Final = 1 << 26  # bytes
ROS_BAG_CHUNK: Final = 1 << 30  # bytes of a compressed part of a file
ROS_BAG_METADATA: Final = 1 << 23  # bytes of the file that says what is in a folder
ROS_TEXT: Final = 1 << 20  # characters of a file; the largest one of ROS has 12 000
ROS_DECLARATIONS: Final = 1000  # fields and constants of a message; each becomes code
ROS_DEPTH: Final = 50  # messages within messages
ROS_ALL_DECLARATIONS: Final = 3000  # fields and constants of a message and of those in it
ROS_SMALLEST: Final = 1 << 26  # bytes, and Python objects, of a value with empty strings and lists
ROS_PARTS: Final = 1 << 20
ROS_FULL_TEXT: Final = 1 << 22  # of a definition that a peer sends, with those of all types in it
# declarations of a file: a list of thousands of different things is no type
ROS_SNIFF_LINES: Final = 2000
ROS_FRAMES: Final = 10_000  # of a buffer of transforms
ROS_FRAME_NAME: Final = 1000  # characters
ROS_GOALS: Final = 1000  # under way, of an action server
ROS_MOMENTS: Final = 10_000  # of a frame
ROS2_TYPES: Final = 1000  # types in a description
ROS2_TOKEN: Final = 4096  # characters
ROS2_PROGRAMS: Final = 10_000  # over DDS, whose nodes are known
ROS2_QUESTIONS: Final = 100  # that wait for a server of a node
ROS2_GOALS: Final = 1000  # of an action server, with those that are over
ROS2_PARAMETERS: Final = 10_000  # of a node

# MQTT, ZeroMQ, MPI, Zenoh
MQTT_PATTERNS: Final = 64  # of one reader
MQTT_HEARD: Final = 1 << 14  # bytes of a packet of somebody who reads
MQTT_CONNECT: Final = 1 << 16  # bytes of the packet that begins a connection
MQTT_TOPIC: Final = 1 << 12  # bytes
MQTT_USER: Final = 1 << 13  # bytes of user properties that are kept of a message
MQTT_WILL: Final = 1 << 16  # bytes of a client's last message
MQTT_UNRELEASED: Final = 1024  # messages with QoS 2 of one client that are under way
ZENOH_ATTACHMENT: Final = 1 << 13  # bytes that are kept of what is attached to a message
ZENOH_PARAMETERS: Final = 1 << 13  # letters of a question's parameters
ZMQ_PREFIX: Final = 1 << 12  # bytes of a subscription
ZMQ_SUBSCRIPTIONS: Final = 1024  # of one peer
ZMQ_HELD: Final = 1 << 16  # bytes of its subscriptions
ZMQ_COMMAND: Final = 1 << 13  # bytes
ZMQ_FRAMES: Final = 64  # of one message
ZMQ_BACKLOG: Final = 1 << 26  # bytes that wait for one SUB
ZMQ_MESSAGE: Final = 1 << 30  # bytes of a message
MPI_LINE: Final = 4096  # what MPI calls a port has some hundred bytes
MPI_NAME: Final = 4096  # bytes
ZENOH_PROPERTY: Final = 1 << 16  # bytes of a property's values
ZENOH_ALL_PORTS: Final = 1 << 23  # bytes of what one program says of all its ports

# Values of the decorators
FRAME_BUFFERS: Final = 4096  # buffers of a frame
TENSOR_PICKLE: Final = 1 << 16  # bytes
TENSOR_OPCODES: Final = 1000  # of the pickle
TENSOR_DIMENSIONS: Final = 32  # of an array
TREE_DEPTH: Final = 200  # levels of nesting
WRAPYFI_HEADER: Final = 1 << 16  # bytes of a header of Wrapyfi

# Thrift
THRIFT_TEXT: Final = 1 << 18  # characters of a file
THRIFT_DEPTH: Final = 20  # of types and values
THRIFT_TYPES: Final = 1000  # types within one, those behind typedefs counted each time
THRIFT_VALUES: Final = 10_000  # elements of a Bottle that a struct may take
# all declarations of a file and those that it includes; each becomes code
THRIFT_DECLARATIONS: Final = 5000
THRIFT_INCLUDES: Final = 200  # files
THRIFT_NESTED: Final = 100  # structs in structs
THRIFT_BASES: Final = 100  # services that a service extends, one over the other
THRIFT_LISTS: Final = 90  # of lists within lists, as a Bottle may have
THRIFT_NAME: Final = 1000  # bytes of the name of a method in a call of Apache's protocols
THRIFT_LEVELS: Final = 64  # of structs and containers in such a call, as in Apache's own readers
# fields of structs and elements of containers in such a call, as far as they are Python objects
THRIFT_ITEMS: Final = 1 << 20
THRIFT_REASON: Final = 1 << 16  # bytes of what a failed call says

# Recordings
RECORDED_CHUNK: Final = 1 << 27  # bytes of a chunk, unpacked, and so of a message
RECORDED_CHUNKS: Final = 1 << 22  # of one file
RECORDED_SUMMARY: Final = 1 << 28  # bytes at the end of a file that say what is in it
RECORDED_TEXT: Final = 1 << 20  # bytes of a name or a note
DUMPED_LINE: Final = 1 << 26  # bytes of a line of a recording of C++
RECORDED_NOTES: Final = 10_000  # notes of one file that are shown
MATLAB_FILE: Final = 1 << 30  # bytes of all values of a file of MATLAB, which are in memory at once
LEROBOT_EPISODES: Final = 1_000_000  # of a data set
LEROBOT_ROW_GROUP: Final = 1 << 30  # bytes of a part of a table, unpacked
VIEW_ORDER: Final = 1 << 18  # bytes of what a page says at a time
VIEW_CLIENTS: Final = 64  # connections of pages at a time
VIEW_SUBSCRIPTIONS: Final = 1000  # of one page
VIEW_SECONDS: Final = 10.0  # in which a page asks, and takes what it is sent

# Devices
MAP_NAMES: Final = 10_000  # places, paths, areas, objects that a server of maps keeps, of each
MAP_GRIDS: Final = 100  # maps that it keeps
MAP_TEXT: Final = 1 << 24  # bytes of a file of names, or of the list of a collection
MAP_FILES: Final = 1000  # in its folder: it writes no more
TALK_LINES: Final = 1000  # of a conversation that are kept
WORLD_OBJECTS: Final = 10_000  # of a simulated world, and devices that somebody has described
SERIAL_WAITING: Final = 1 << 16  # characters that nobody has received yet
SPOKEN_LETTERS: Final = 1000  # of a text that a simulated voice says

# Applications
APPLICATION_FILE: Final = 4 << 20  # bytes of one file
APPLICATION_FILES: Final = 200  # of one application, with those in them
APPLICATION_ELEMENTS: Final = 50_000  # tags of one file
APPLICATION_DEPTH: Final = 20  # tags, and applications, inside each other
APPLICATION_TEXT: Final = 1 << 16  # characters of a text once its variables are in it
APPLICATION_PROGRAMS: Final = 1000
ROBOT_FILES: Final = 2000  # of one robot, each as often as it is included
ROBOT_ELEMENTS: Final = 200_000  # tags of a robot with all its includes
OUTPUT_LINE: Final = 1 << 13  # bytes of a line that a program prints; the rest is left out
OUTPUT_LINES: Final = 1000  # of a program that are kept
CONTROL_LINE: Final = 1 << 16  # bytes of a request to what keeps an application running
CONTROL_REPLY: Final = 1 << 24  # bytes

# Tools
DOCTOR_MESSAGE: Final = 1 << 26  # bytes of a message
JOURNAL: Final = 1 << 24  # bytes

_NAMES: Final = ("YARPY_MAX_PICTURE", "YARPY_MAX_UNPACKED", "YARPY_MAX_ELEMENTS")


@dataclass(frozen=True, slots=True)
class Limits:
    """`picture` and `unpacked` in bytes, `elements` of a list."""

    picture: int = 1 << 28
    unpacked: int = 1 << 26
    elements: int = 1 << 22


def limits() -> Limits:
    """The limits of this process, as its environment says now."""
    return _read(*(os.environ.get(name, "") for name in _NAMES))


@lru_cache(maxsize=8)
def _read(*texts: str) -> Limits:
    given = {}
    for name, field, text in zip(_NAMES, ("picture", "unpacked", "elements"), texts, strict=True):
        if text.isascii() and text.isdigit() and len(text) < 19:
            given[field] = int(text)
        elif text:
            from yarpy.log import logger

            logger("yarpy").warning(
                "%s=%.40r is not a number and is ignored: give bytes or elements in digits",
                name,
                text,
            )
    return Limits(**given)


def number_in(text: str, most: int = 2**31 - 1) -> int | None:
    """Return the number that somebody has written in digits, None if it is none or beyond `most`.

    `int` takes other digits too, and raises for what `str.isdigit` takes, such as "\u00b2".
    """
    if not (text.isascii() and text.isdigit()) or len(text) > len(str(most)):
        return None
    number = int(text)
    return number if number <= most else None


class Quota:
    """The rest of a limit while one message is read: several pictures share one limit."""

    __slots__ = ("_said", "left")

    def __init__(self, most: int, what: str) -> None:
        self.left = most
        self._said = f"more than {most} {what}"

    def take(self, count: int) -> None:
        """Count what is about to be built. DecodeError if the limit is reached."""
        self.left -= count
        if self.left < 0:
            raise DecodeError(self._said)


_FREE: Final = 1 << 10  # characters that are too few to count their elements
_COLLIDING: Final = 100


def check_json(text: str | bytes) -> None:
    """Count the elements of a JSON text before it is parsed. DecodeError if there are too many."""
    if len(text) > _FREE:
        marks = ",[{" if isinstance(text, str) else (b",", b"[", b"{")
        count = sum(map(text.count, marks))  # type: ignore[arg-type]
        if count > (most := limits().elements):
            raise DecodeError(f"JSON of more than {most} elements (YARPY_MAX_ELEMENTS)")


def check_hashes(items: Iterable[Hashable]) -> None:
    """Refuse elements of a set, or keys, that a stranger chose so that all have the same hash:
    each would be compared with every other one. DecodeError; TypeError for what has no hash."""
    hashes = [hash(item) for item in items]
    if len(hashes) - len(set(hashes)) > _COLLIDING:
        raise DecodeError(f"a set or dict with more than {_COLLIDING} elements of the same hash")
