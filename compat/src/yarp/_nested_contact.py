"""NestedContact: the parts of a name that stands for a topic of a node, `/topic+@/node`.

Rules: the forms are `/topic+@/node`, `/node=+/topic` and `/node+#/topic`; + publishes, -
subscribes, and a 1 behind them offers or calls a service. `~` puts a type behind.
"""

from __future__ import annotations


class NestedContact:
    """`NestedContact("/chatter+@/talker")`."""

    def __init__(self, fullName: str = "") -> None:
        self._full = self._node = self._inner = self._category = self._wire_type = ""
        if fullName:
            self.fromString(fullName)

    def fromString(self, nFullName: str) -> bool:
        """Become the parts of a name; False if it has none of the forms."""
        full = nFullName.partition(":/")[2] or nFullName
        full, typed, kind = full.partition("~")
        self._full, self._node, self._inner, self._category = full, full, "", ""
        if typed:
            self._wire_type = kind
        if "@" in full:
            topic, _, self._node = full.partition("@")
            self._inner = topic
            if topic[-2:] in _SERVICES or topic[-1:] in _TOPICS:
                size = 2 if topic[-2:] in _SERVICES else 1
                self._inner, self._category = topic[:-size], topic[-size:]
            return True
        if "=" in full:
            self._node, _, inner = full.partition("=")
            category, slash, rest = inner.partition("/")
            if slash:
                self._category, self._inner = category, slash + rest
                return True
            self._inner = inner
        if "#" in full:
            self._node, _, self._inner = full.partition("#")
            if self._node[-1:] in _TOPICS:
                self._node, self._category = self._node[:-1], self._node[-1]
            return True
        return False

    def getFullName(self) -> str:
        return self._full

    def getNodeName(self) -> str:
        return self._node

    def getNestedName(self) -> str:
        return self._inner

    def getCategory(self) -> str:
        """Return `+`, `-`, `+1`, `-1` or nothing."""
        return self._category

    def setCategoryWrite(self) -> None:
        """It publishes."""
        self._category = "+"

    def setCategoryRead(self) -> None:
        """It subscribes."""
        self._category = "-"

    def getTypeName(self) -> str:
        return self._wire_type

    def getTypeNameStar(self) -> str:
        """Return the type, `*` if none was said."""
        return self._wire_type or "*"

    def setTypeName(self, nWireType: str) -> None:
        self._wire_type = nWireType

    def isNested(self) -> bool:
        """Return whether there is a topic."""
        return bool(self._inner)

    def toString(self) -> str:
        """`/topic+@/node`."""
        if not self._inner:
            return self._node
        return f"{self._inner}{self._category}@{self._node}"

    def __repr__(self) -> str:
        return f"<yarp.NestedContact {self.toString()}>"


_TOPICS = ("+", "-")
_SERVICES = ("+1", "-1")
