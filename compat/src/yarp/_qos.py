"""QosStyle: the priority of a connection, for `Network.setConnectionQos`.

Rules: packets have one of the numbers DSCP_..., of which four are levels; -1 or DSCP_Undefined
leaves everything as it is.
"""

from __future__ import annotations

from typing import Any

import yarpy
from yarp import _names
from yarp._log import say
from yarpy.qos import DSCP, Sched

_LEVELS = {"LOW": 10, "NORM": 0, "HIGH": 36, "CRIT": 44}
_UNDEFINED = 0x7FFF
_INVALID = -1


class QosStyle:
    """Settings to ask for: `setThreadPolicy(1)`, `setPacketPriority("LEVEL:HIGH")` and so on."""

    PacketPriorityInvalid = DSCP_Invalid = _INVALID
    PacketPriorityUndefined = DSCP_Undefined = _UNDEFINED
    PacketPriorityNormal, PacketPriorityLow = _LEVELS["NORM"], _LEVELS["LOW"]
    PacketPriorityHigh, PacketPriorityCritical = _LEVELS["HIGH"], _LEVELS["CRIT"]
    DSCP_CS0, DSCP_CS1, DSCP_CS2, DSCP_CS3, DSCP_CS4, DSCP_CS5, DSCP_CS6, DSCP_CS7 = range(0, 64, 8)
    DSCP_AF11, DSCP_AF12, DSCP_AF13, DSCP_AF21, DSCP_AF22, DSCP_AF23 = 10, 12, 14, 18, 20, 22
    DSCP_AF31, DSCP_AF32, DSCP_AF33, DSCP_AF41, DSCP_AF42, DSCP_AF43 = 26, 28, 30, 34, 36, 38
    DSCP_VA, DSCP_EF = 44, 46

    def __init__(self) -> None:
        self._priority = self._policy = -1
        self._tos = -1

    def setThreadPriority(self, priority: int) -> None:
        self._priority = int(priority)

    def getThreadPriority(self) -> int:
        return self._priority

    def setThreadPolicy(self, policy: int) -> None:
        """0 for SCHED_OTHER, 1 for SCHED_FIFO, 2 for SCHED_RR."""
        self._policy = int(policy)

    def getThreadPolicy(self) -> int:
        return self._policy

    def setPacketPriority(self, priority: str) -> bool:
        """`LEVEL:HIGH`, `DSCP:AF42` or `TOS:144`; False for anything else."""
        key, _, value = priority.partition(":")
        dscp = _INVALID
        if key == "LEVEL":
            dscp = self.getLevelByVocab(value)
        elif key == "DSCP":
            dscp = self.getDSCPByVocab(value)
        elif key == "TOS" and value.isascii() and value.isdigit() and int(value) < 256:
            dscp = int(value) >> 2
        self._tos = dscp << 2 if dscp >= 0 else -1
        return dscp >= 0

    def setPacketPriorityByLevel(self, level: int) -> None:
        self.setPacketPriorityByDscp(level)

    def setPacketPriorityByDscp(self, dscp: int) -> None:
        self._tos = -1 if dscp in (_INVALID, _UNDEFINED) else int(dscp) << 2

    def setPacketPrioritybyTOS(self, tos: int) -> None:
        self._tos = int(tos)

    def getPacketPriorityAsTOS(self) -> int:
        return self._tos

    def getPacketPriorityAsDSCP(self) -> int:
        return self._tos >> 2 if self._tos >= 0 else _INVALID

    def getPacketPriorityAsLevel(self) -> int:
        """The level; PacketPriorityInvalid if it is none."""
        dscp = self.getPacketPriorityAsDSCP()
        return dscp if dscp in _LEVELS.values() else _INVALID

    @staticmethod
    def getDSCPByVocab(vocab: int | str) -> int:
        """The number of a class such as `AF42`, or of its vocab."""
        return DSCP.get(_word(vocab), _INVALID)

    @staticmethod
    def getLevelByVocab(vocab: int | str) -> int:
        """The number of `LOW`, `NORM`, `HIGH` or `CRIT`, or of its vocab."""
        return _LEVELS.get(_word(vocab), _INVALID)

    def _qos(self) -> yarpy.Qos:
        return yarpy.Qos.of(Sched(self._policy, self._priority), self._tos)

    def _show(self, found: yarpy.Qos) -> None:
        self._policy, self._priority = found.sched.policy, found.sched.priority
        self._tos = found.tos


def _word(vocab: int | str) -> str:
    return vocab if isinstance(vocab, str) else str(yarpy.Vocab.from_code(vocab))


def set_connection_qos(
    src: str, dest: str, style: QosStyle, dest_style: Any = None, quiet: bool = True
) -> bool:
    """Give a connection this priority at its beginning, and the other, or the same, at its end."""
    from yarpy.network.qos import grant

    receiver = dest_style if isinstance(dest_style, QosStyle) else style
    try:
        grant(src, dest, sender=style._qos(), receiver=receiver._qos(), names=_names.names())
    except (yarpy.YarpError, ValueError) as error:
        if not (dest_style if isinstance(dest_style, bool) else quiet):
            say("ERROR", str(error))
        return False
    return True


def get_connection_qos(
    src: str, dest: str, src_style: QosStyle, dest_style: QosStyle, quiet: bool = True
) -> bool:
    """Fill in the priorities of a connection, at its beginning and at its end."""
    from yarpy.network.qos import granted

    try:
        sender, receiver = granted(src, dest, _names.names())
    except yarpy.YarpError as error:
        if not quiet:
            say("ERROR", str(error))
        return False
    src_style._show(sender)
    dest_style._show(receiver)
    return True
