"""Every fault is made for real, and found; the page has the doctor's words for it."""

from __future__ import annotations

import os
import re
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace

import pytest
from kits.doctor.faults import FAULTS, Fault, World
from support.doctor import made_up
from support.port import free_port
from support.wait import HANG, runs, wait_until

import yarpy
from yarpy import registry
from yarpy.kits.doctor import Case, Finding, examination, examine
from yarpy.network.traffic import End, Flow
from yarpy.platform.shell import quoted

WINDOW = 0.3  # seconds between two looks
SILENT = {"stopped", "hangs", "descriptors"}  # a port does not answer
PAGE = Path(__file__).parents[3] / "docs" / "doctor.md"


@pytest.fixture
def world(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[World]:
    for name in [name for name in os.environ if name.startswith(("YARP_", "YARPY_"))]:
        monkeypatch.delenv(name)
    monkeypatch.setenv("YARP_CONFIG_HOME", str(tmp_path))
    monkeypatch.setenv("YARP_PORT_RANGE", str(free_port()))
    monkeypatch.setattr("yarpy.kits.doctor.case.TIMEOUT", HANG)
    monkeypatch.setattr("yarpy.kits.doctor.name.TIMEOUT", 5.0)
    server = yarpy.NameServer()
    try:
        (tmp_path / "yarp.conf").write_text(f"127.0.0.1 {server.port} yarp\n")
        world = World(tmp_path, server)
        clock = SimpleNamespace(sleep=world.sleep, monotonic=time.monotonic, time=time.time)
        monkeypatch.setattr("yarpy.kits.doctor.case.time", clock)
        with world.stack:
            yield world
    finally:
        server.close()


@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: f"{fault.probe}: {fault.what}")
def test_fault_is_found(world: World, fault: Fault, monkeypatch: pytest.MonkeyPatch) -> None:
    if fault.probe in SILENT:
        monkeypatch.setattr("yarpy.kits.doctor.case.TIMEOUT", 1.0)
    with fault.make(world) as wanted:
        findings = examine(Case(*wanted, window=WINDOW, **world.options), HANG)
    found = [finding for finding in findings if finding.probe == fault.probe]
    assert found, findings
    assert found[0].advice
    assert not [finding for finding in findings if finding.probe == "unfinished"], findings
    others = [finding.probe for finding in findings if finding.level == "fault"]
    assert set(others) <= {fault.probe, *fault.also}, findings
    if sys.platform != "linux":  # the page tells what Linux knows
        return
    line = row(fault, found[0], world)
    assert line in PAGE.read_text().splitlines(), f"docs/doctor.md has no row\n{line}"


_PROCESS = re.compile(r"\(process \d+(: .*?)?\)(?= is| hangs|,|$| has)|process \d+")
_SAME = (  # numbers that are not measured
    r"line 1\b|YARP \d|FIFO:\d+|SCHED_\w+ \d+|rmem_max=\d+|list of 2: 1 \w+|header of 60|-r 99"
)
_NUMBER = re.compile(rf"{_SAME}|(?<![\w.])\d[\d.]*(?=[ ,;:)`]|$)")


def row(fault: Fault, finding: Finding, world: World) -> str:
    """The fault's row of the table in docs/doctor.md; what differs from day to day is a word."""
    texts = []
    for text in (finding.verdict, finding.advice):
        text = text.replace(str(world.home / "shm"), "/dev/shm")  # for which it stands
        text = text.replace(f"{world.home}{os.sep}", "/home/me/.config/yarp/")
        text = re.sub(r"127\.0\.0\.1([: ])\d+", r"HOST\1PORT", text)
        text = _PROCESS.sub(
            lambda found: "(process PID: python robot.py)" if found[1] else "process PID", text
        )
        text = re.sub(r"-(CONT|p|-pid) \d+", r"-\1 PID", text)
        text = _NUMBER.sub(lambda found: found[0] if re.fullmatch(_SAME, found[0]) else "N", text)
        texts.append(re.sub(r"\s+", " ", text).replace("|", "\\|"))
    return f"| {fault.what} | `{finding.probe}`: {texts[0]} | {texts[1]} |"


def test_page_has_no_row_of_another_fault() -> None:
    rows = re.findall(r"^\| (.*?) \| `[\w-]+`: ", PAGE.read_text(), re.M)
    assert rows == [fault.what for fault in FAULTS]


def test_where_all_is_well_nothing_is_found(world: World) -> None:
    own = f"/well{os.getpid()}"  # others may have ports of usual names on this computer
    talker = world.open(f"{own}/talker", yarpy.Port)
    listener = world.open(f"{own}/listener", callback=lambda message: None)
    talker.connect(listener.name)
    world.again(lambda: talker.write([1.5], yarpy.Stamp(1, time.time())))
    for wanted in ((), (talker.name,), (talker.name, listener.name)):
        assert examine(Case(*wanted, window=WINDOW), HANG) == []


# --- families that fail


def hangs(case: Case) -> Iterator[Finding]:
    yield Finding("before", "it", "something was found")
    threading.Event().wait(HANG)


def fails(case: Case) -> Iterator[Finding]:
    yield Finding("first", "it", "something was found", level="note")
    raise ZeroDivisionError("by mistake")


def endless(case: Case) -> Iterator[Finding]:
    while True:
        yield Finding("again", "it", "and again")


class Swift(threading.Thread):
    """Is at its end, or where it hangs, before its time begins to count."""

    def start(self) -> None:
        super().start()
        wait_until(lambda: not self.is_alive() or runs("Event.wait", self.ident or 0))


def test_a_family_that_fails_costs_no_other(monkeypatch: pytest.MonkeyPatch) -> None:
    families = registry.Registry("findings", {})
    monkeypatch.setattr(registry, "findings", families)
    for family in (fails, hangs, endless):
        families.add(family.__name__, family)
    monkeypatch.setattr(examination, "threading", SimpleNamespace(Thread=Swift))
    found = examine(made_up(), timeout=0.2)
    names = [one.probe for one in found]
    assert names == ["before", "again", "first", "unfinished", "unfinished"]
    assert "ZeroDivisionError: by mistake" in found[3].verdict
    assert "takes longer than 0.2 s" in found[4].verdict


# --- what is advised is pasted into a shell


def cables(case: Case) -> Iterator[Finding]:
    for name in ("/x;id", "/x;id>f", "/a b", "/plain"):
        yield Finding("loose", name, f'"{name}" is loose', f"`yarpy clean {name}`")


def test_names_are_quoted_in_commands_that_a_shell_would_misread(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    families = registry.Registry("findings", {})
    monkeypatch.setattr(registry, "findings", families)
    families.add("cables", cables)
    flow = Flow("/x;id", "/x;id>f", End())
    found = examine(made_up(flow, wanted=("/a b", "/plain")))
    assert [one.verdict for one in found][:2] == ['"/x;id" is loose', '"/x;id>f" is loose']
    assert [one.advice for one in found] == [
        f"`yarpy clean {quoted('/x;id')}`",
        f"`yarpy clean {quoted('/x;id>f')}`",
        f"`yarpy clean {quoted('/a b')}`",
        "`yarpy clean /plain`",
    ]
