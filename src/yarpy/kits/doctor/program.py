"""Findings about programs: stopped, hanging, closed to us, short of file descriptors."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from typing import Final

from yarpy.kits.doctor import process
from yarpy.kits.doctor.case import Case
from yarpy.kits.doctor.finding import Finding
from yarpy.network.traffic import PortState

SCARCE: Final = 0.9  # of the descriptors that it may have


def find(case: Case) -> Iterator[Finding]:
    """stopped, hangs, denied, descriptors."""
    seen: set[int] = set()
    for state in case.ports.values():
        if state.state == "denied":
            yield Finding(
                "denied",
                state.name,
                f'"{state.name}" does not let this computer ask: {state.error}',
                "allow it in the access.toml of that program's computer; there `yarpy check "
                "--access` says what holds",
            )
            continue
        pid = case.pid(state.name)
        short = list(_descriptors(state, pid)) if pid else []
        if pid not in seen:
            seen.add(pid)
            yield from short
        if state.state == "silent" and not short:
            yield _silent(state, pid)


def _silent(state: PortState, pid: int) -> Finding:
    who = f"its program (process {pid}: {process.command(pid)})" if pid else "its program"
    if pid and process.state(pid) in ("T", "t"):
        return Finding(
            "stopped",
            state.name,
            f'{who} is stopped, by SIGSTOP, ^Z or a debugger; "{state.name}" takes nothing '
            "meanwhile",
            f"`kill -CONT {pid}`",
        )
    return Finding(
        "hangs",
        state.name,
        f'"{state.name}" takes connections at {state.contact.address} and says nothing: {who} '
        "hangs, is stopped, or has no time for its ports",
        f"look at it: {'' if sys.platform == 'win32' else f'`top -p {pid}`, '}"
        f"`py-spy dump --pid {pid}`"
        if pid
        else "look at it on its computer; a program stopped by ^Z goes on with `kill -CONT PID`",
    )


def _descriptors(state: PortState, pid: int) -> Iterator[Finding]:
    most, used = process.limit(pid, "Max open files"), process.open_files(pid)
    if most and used and used >= SCARCE * most:
        yield Finding(
            "descriptors",
            state.name,
            f'the program of "{state.name}" (process {pid}) has {used} of the {most} file '
            "descriptors that it may have: each connection takes one, and new ones find none",
            f"`ulimit -n {4 * most}` in its shell before it starts; now: `prlimit --pid {pid} "
            f"--nofile={4 * most}`",
            "fault" if state.state == "silent" else "warning",
        )
