"""Problems of an application that only this computer and the network can tell: programs, folders,
hosts, ports that are taken.

Rules: nothing is started or changed. Where no name server answers, its part is left out.
"""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path

from yarpy.errors import YarpError
from yarpy.kits.launch.application.application import Application, Module
from yarpy.kits.launch.document.advice import advice
from yarpy.kits.launch.document.problem import Problem, Where
from yarpy.names.base import NameClient
from yarpy.names.default import DEFAULT


def checked(application: Application, names: NameClient | None = None) -> Iterator[Problem]:
    """Yield what will not work here and now."""
    yield from here(application)
    try:
        known = {one.name for one in (names or DEFAULT.current()).list()}
    except YarpError as error:
        if application.files:
            where = Where(application.files[0])
            yield Problem(where, f"ports and hosts are not looked at: {error}")
        return
    for module in application.modules:
        if module.node and module.node not in known:
            near = advice(module.node, sorted(known))
            text = f'nothing called "{module.node}" runs, which would start "{module.label}"{near}'
            yield Problem(module.where, text)
    own = {module.prefix for module in application.modules if module.prefix}
    for one in application.connections:
        for name, external in (
            (one.source, one.source_external),
            (one.target, one.target_external),
        ):
            if external and name.startswith("/") and name not in known:
                yield Problem(one.where, f'the external port "{name}" is not there')
            elif not external and name in known and any(name.startswith(f"{p}/") for p in own):
                yield Problem(one.where, f'"{name}" is taken: it is registered already')


def here(application: Application) -> Iterator[Problem]:
    """Yield what this computer alone can tell."""
    for module in application.modules:
        if not module.node:
            yield from _local(module)


def _local(module: Module) -> Iterator[Problem]:
    folder = Path(module.workdir) if module.workdir else Path()
    if not folder.is_dir():
        yield Problem(module.where, f'the folder "{folder}" is not there', fatal=True)
    words = module.command
    program = words[0]
    if not shutil.which(program) and not (folder / program).is_file():
        text = f'"{module.label}": there is no program "{program}" on the PATH'
        yield Problem(module.where, text, fatal=True)
