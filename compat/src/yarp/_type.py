"""Type: the name of what a port carries, `Type.byName("yarp/image")`.

Rules: nothing is checked by it; whoever reads is told by what came.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Self

if TYPE_CHECKING:
    from yarp._property import Property


class Type:
    """A name, the name on the wire, and properties; without a name it stands for any type."""

    def __init__(self, alt: Type | None = None) -> None:
        self._name: str = "" if alt is None else alt._name
        self._on_wire: str = "" if alt is None else alt._on_wire
        self._properties: Property | None = None if alt is None else alt._properties

    @staticmethod
    def byName(name: str, name_on_wire: str = "") -> Type:
        """Return a type of this name."""
        made = Type()
        made._name, made._on_wire = name, name_on_wire
        return made

    @staticmethod
    def byNameOnWire(name_on_wire: str) -> Type:
        """Return a type that is a Bottle here and has this name in messages."""
        return Type.byName("yarp/bottle", name_on_wire)

    @staticmethod
    def anon() -> Type:
        """Return a type without a name."""
        return Type()

    def getName(self) -> str:
        return self._name

    def getNameOnWire(self) -> str:
        return self._on_wire

    def hasName(self) -> bool:
        return self._name != ""

    isValid = hasName

    def readProperties(self) -> Property:
        """The properties."""
        return self.writeProperties()

    def writeProperties(self) -> Property:
        """The properties, to be changed."""
        if self._properties is None:
            from yarp._property import Property

            self._properties = Property()
        return self._properties

    def addProperty(self, key: str, val: Any) -> Self:
        """Note a property."""
        self.writeProperties().put(key, val)
        return self

    def toString(self) -> str:
        """The name, with that on the wire behind a colon if there is one; `null` without any."""
        return f"{self._name}:{self._on_wire}" if self._on_wire else self._name or "null"

    toString_c = toString
