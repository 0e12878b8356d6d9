"""The merged view of a robot: what each device gets, and where each parameter comes from."""

from __future__ import annotations

from collections.abc import Iterator

from yarpy.kits.launch.robot.description import PHASES, Description, Parameter


def lines(description: Description) -> Iterator[str]:
    """Yield the lines: devices with their parameters, then the actions in their order."""
    yield f"robot {description.name}, ports {description.portprefix}"
    for parameter in description.parameters:
        yield from _parameter(parameter, 1)
    for device in description.devices:
        yield f"device {device.name} ({device.type})  {device.where}"
        for parameter in device.parameters:
            yield from _parameter(parameter, 1)
    for phase in PHASES:
        for level, actions in description.levels(phase):
            for action in actions:
                targets = action.targets
                if targets is None:
                    more = " all"
                else:
                    more = "".join(f" {name}" for name in targets.values())
                yield f"{phase} {level}: {action.device} {action.kind}{more}  {action.where}"


def _parameter(one: Parameter, depth: int) -> Iterator[str]:
    origin = one.given or str(one.where)
    if not one.members:
        yield f"{'  ' * depth}{one.bottle.to_text()}  {origin}"
        return
    yield f"{'  ' * depth}{one.name}:"
    for member in one.members:
        yield from _parameter(member, depth + 1)
