"""Cores: the shares of containers count, bindings do not."""

from __future__ import annotations

import math
import os
from pathlib import Path

import pytest

from yarpy.link import cores as module
from yarpy.link.begin.greeting import driver_of
from yarpy.link.cores import cores, share
from yarpy.transports.tcp import TcpListener, TcpTransport, dial


def group(root: Path, own: str, **files: str) -> float:
    for name, text in files.items():
        path = root / name.replace("__", "/").replace("DOT", ".")
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    (root / "own").write_text(own)
    return share(root, root / "own")


@pytest.mark.parametrize(
    ("own", "files", "wanted"),
    [
        ("0::/\n", {"cpuDOTmax": "max 100000\n"}, math.inf),
        ("0::/\n", {"cpuDOTmax": "150000 100000\n"}, 1.5),
        ("0::/a/b\n", {"a__b__cpuDOTmax": "max 100000", "a__cpuDOTmax": "50000 100000"}, 0.5),
        ("0::/../c\n", {"cpuDOTmax": "nonsense"}, math.inf),
        ("0::/\n", {"cpuDOTmax": "1 0"}, math.inf),
        (
            "4:memory:/x\n3:cpu,cpuacct:/x\n",
            {"cpu__x__cpuDOTcfs_quota_us": "200000", "cpu__x__cpuDOTcfs_period_us": "100000"},
            2.0,
        ),
        ("3:cpu:/\n", {"cpu__cpuDOTcfs_quota_us": "-1", "cpu__cpuDOTcfs_period_us": "9"}, math.inf),
        ("nonsense\n\n", {}, math.inf),
    ],
)
def test_shares(tmp_path: Path, own: str, files: dict[str, str], wanted: float) -> None:
    assert group(tmp_path, own, **files) == wanted


def test_a_system_without_groups(tmp_path: Path) -> None:
    assert share(tmp_path, tmp_path / "missing") == math.inf


def test_less_than_one_is_one(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "share", lambda root, own: 0.25)
    assert cores() == 1


@pytest.mark.skipif(not hasattr(os, "sched_setaffinity"), reason="no bindings here")
def test_who_is_bound_to_a_processor_polls(monkeypatch: pytest.MonkeyPatch) -> None:
    """Its peers may have others."""
    monkeypatch.setattr(module, "share", lambda root, own: math.inf)
    monkeypatch.setattr(os, "cpu_count", lambda: 64)
    before = os.sched_getaffinity(0)
    listener = TcpListener()
    try:
        os.sched_setaffinity(0, {min(before)})
        transport: TcpTransport = dial("127.0.0.1", listener.port)
        assert driver_of(transport).eager
        monkeypatch.setattr(module, "share", lambda root, own: 0.5)
        assert not driver_of(transport).eager
        transport.close()
    finally:
        os.sched_setaffinity(0, before)
        listener.close()
        listener.release()
