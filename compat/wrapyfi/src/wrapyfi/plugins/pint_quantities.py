"""Quantities of Pint: a number and its units.

    ["PintData", base64 of {"magnitude": 3.5, "units": "meter / second ** 2"}, "Quantity"]

Rules: units are read as a product of powers, and no expression of a stranger is evaluated. A
quantity belongs to the registry of the program (`pint.get_application_registry()`).
"""

from __future__ import annotations

import json
import math
import re
from base64 import b64decode, b64encode
from typing import Any

from wrapyfi.utils.core_utils import Plugin, PluginRegistrar
from yarpy.errors import DecodeError

try:
    from pint import Quantity

    HAVE_PINT = True
except ImportError:
    HAVE_PINT = False

_FACTOR = re.compile(r"([*/]?) *+([^\W\d]\w*+|1)(?: *+\*\* *+(-?[\d.]{1,12}+))? *+")
_MOST = 2000  # characters of units


@PluginRegistrar.register(types=(Quantity,) if HAVE_PINT else None)
class PintData(Plugin):
    """`pint.Quantity`."""

    def encode(self, obj: Any, *args: Any, **kwargs: Any) -> tuple[bool, dict[str, Any]]:
        if not isinstance(obj, Quantity):
            return False, {}
        number = obj.magnitude
        if hasattr(number, "item") and not getattr(number, "shape", ()):
            number = number.item()
        if not isinstance(number, (int, float)):
            raise TypeError(
                f"a quantity of {type(number).__qualname__} cannot be sent: send its magnitude, "
                "and its units as a text"
            )
        # In the long words of any registry: the format of the program may be another one.
        text = json.dumps({"magnitude": number, "units": f"{obj.units:D}"})
        return True, {"__wrapyfi__": ("PintData", b64encode(text.encode()).decode(), "Quantity")}

    def decode(self, obj_type: Any, obj_full: Any, *args: Any, **kwargs: Any) -> tuple[bool, Any]:
        if not HAVE_PINT or obj_full[2] != "Quantity":
            return False, None
        found = json.loads(b64decode(obj_full[1], validate=True))
        number = found["magnitude"]
        if type(number) not in (int, float):
            raise DecodeError("a quantity whose magnitude is no number")
        return True, _quantity(number, str(found["units"]))


def _quantity(number: float, units: str) -> Any:
    import pint
    from pint.util import UnitsContainer

    powers: dict[str, float] = {}
    place = 0
    while place < len(units) and len(units) <= _MOST:
        match = _FACTOR.match(units, place)
        if match is None or bool(match[1]) != bool(place):
            break
        power = float(match[3] or 1) * (-1 if match[1] == "/" else 1)
        if match[2] not in ("1", "dimensionless"):
            powers[match[2]] = powers.get(match[2], 0) + power
        place = match.end()
    if place < len(units) or not all(map(math.isfinite, powers.values())):
        raise DecodeError(f"not units: {units[:80]}")
    registry = pint.get_application_registry()
    whole = {name: int(power) if power.is_integer() else power for name, power in powers.items()}
    try:
        for name in whole:
            registry.get_name(name)
        return registry.Quantity(number, UnitsContainer(whole))
    except (AttributeError, pint.UndefinedUnitError) as error:
        raise DecodeError(f"units that this program does not know: {error}") from error
