"""The parameters of another node of ROS 2, by its services."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from yarpy.errors import UnknownName
from yarpy.peers.ros2.parameter.server import SERVICES
from yarpy.peers.ros2.parameter.value import NOT_SET, Value, from_ros, named
from yarpy.peers.ros2.rmw import Caller


class RemoteParameters:
    """Asks the node called `name`. `caller(service, type)` makes what asks; each is made when it is
    used first. `timeout`: seconds for each answer.

    All methods raise UnknownName where the node is not there, Timeout, LinkClosed.
    """

    def __init__(
        self, name: str, caller: Callable[[str, str], Caller], timeout: float | None = 5.0
    ) -> None:
        self.name = name
        self.timeout = timeout
        self._make = caller
        self._callers: dict[str, Caller] = {}

    def wait(self, timeout: float | None = None) -> bool:
        """Wait until the node serves its parameters; return False if time is over."""
        return self._caller("get_parameters").wait(timeout)

    def get(self, name: str) -> Value:
        """Return a parameter's value. Raises UnknownName if the node has none of that name."""
        (value,) = self._ask("get_parameters", {"names": [name]}).values or [None]
        known = value is not None and (value.type != NOT_SET or name in self.names())
        if not known:
            raise UnknownName(f'{self.name} has no parameter "{name[:80]}"')
        return from_ros(value)

    def names(self, *prefixes: str, depth: int = 0) -> list[str]:
        """Return the names below some prefixes, all without any. A depth of 0 is any."""
        asked = {"prefixes": [*prefixes], "depth": depth}
        return [*self._ask("list_parameters", asked).result.names]

    def all(self) -> dict[str, Value]:
        """Return all parameters by name."""
        names = self.names()
        values = self._ask("get_parameters", {"names": names}).values
        return {name: from_ros(value) for name, value in zip(names, values, strict=True)}

    def describe(self, *names: str) -> list[Any]:
        """Return the descriptors, objects of rcl_interfaces/msg/ParameterDescriptor."""
        return [*self._ask("describe_parameters", {"names": [*names]}).descriptors]

    def set(self, name: str, value: Any) -> None:
        """Change a parameter. Raises ValueError with the node's reason where it refuses; TypeError
        for what can be no parameter."""
        results = self._ask("set_parameters", {"parameters": named({name: value})}).results
        for result in results:
            self._check(result)

    def set_all(self, values: dict[str, Any]) -> None:
        """Change parameters together, or none of them. Raises as `set`."""
        asked = {"parameters": named(values)}
        self._check(self._ask("set_parameters_atomically", asked).result)

    def close(self) -> None:
        """Give back what was used for asking. Idempotent."""
        for caller in self._callers.values():
            caller.close()
        self._callers.clear()

    def _check(self, result: Any) -> None:
        if not result.successful:
            raise ValueError(f"{self.name} refuses: {result.reason or 'it says no reason'}")

    def _caller(self, service: str) -> Caller:
        found = self._callers.get(service)
        if found is None:
            made = self._make(f"{self.name}/{service}", SERVICES[service])
            found = self._callers.setdefault(service, made)
        return found

    def _ask(self, service: str, request: dict[str, Any]) -> Any:
        caller = self._caller(service)
        return caller.call(request, self.timeout)
