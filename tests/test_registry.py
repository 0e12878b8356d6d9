"""Plug-ins by name: shipped, installed by strangers, added by hand, broken."""

from __future__ import annotations

import importlib
import os
import subprocess
import sys
import threading
from pathlib import Path

import pytest
from support.guest import is_here
from support.wait import HANG

from yarpy import registry
from yarpy.carriers.base import Carrier
from yarpy.errors import UnknownPlugin
from yarpy.facts import Call, CarrierRow, Row
from yarpy.registry import CarrierRegistry, GraphRegistry, Registry
from yarpy.shipped import CARRIERS, SHIPPED


def test_everything_shipped_loads_and_is_called_so() -> None:
    for name, row in SHIPPED["carriers"].items():
        if not is_here(row):
            continue
        carrier = registry.carriers.load(name)
        assert issubclass(carrier, Carrier)
        assert carrier.name == name
        assert registry.carriers.load(name) is carrier
    assert list(SHIPPED["carriers"])[:1] == ["tcp"]
    assert registry.carriers.names()[: len(SHIPPED["carriers"])] == list(SHIPPED["carriers"])


def test_iteration_gives_them_all() -> None:
    assert {carrier.name for carrier in registry.carriers} >= {
        name for name, row in SHIPPED["carriers"].items() if is_here(row)
    }


@pytest.mark.parametrize(
    ("system", "missing"),
    [
        (("linux", "posix"), set()),
        (("darwin", "posix"), {"memory", "shmem"}),
        (("win32", "nt"), {"memory", "shmem", "unix_stream"}),
    ],
)
def test_what_a_system_lacks_is_not_offered(
    system: tuple[str, str], missing: set[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("yarpy.facts.SYSTEM", system)
    own = CarrierRegistry()
    own.add("mine", object())
    assert {*own.names()} - {*own.offered()} == missing


def test_unknown_name_comes_with_the_nearest() -> None:
    with pytest.raises(UnknownPlugin, match='no carrier "tcpp": did you mean "tcp"'):
        registry.carriers.load("tcpp")
    with pytest.raises(UnknownPlugin, match=r"entry point group yarpy\.monitors"):
        registry.monitors.load("nosuch")


def test_added_by_hand_wins_until_it_is_removed() -> None:
    own = CarrierRegistry()
    shipped = own.load("tcp")
    mine = object()
    own.add("tcp", mine)
    own.add("mine", mine)
    assert own.load("tcp") is own.load("mine") is mine
    assert "mine" in own.names()
    own.remove("tcp")
    own.remove("mine")
    own.remove("never there")
    assert own.load("tcp") is shipped
    assert "mine" not in own.names()


def test_lookup_of_a_shipped_one_scans_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    own = CarrierRegistry()
    monkeypatch.setattr(own, "_entries", lambda: pytest.fail("installed packages were scanned"))
    assert own.load("tcp").name == "tcp"


def install(site: Path, name: str, group: str, line: str, code: str) -> None:
    """As much of an installed distribution as the import system needs."""
    info = site / f"{name}-1.0.dist-info"
    info.mkdir(parents=True)
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text(f"[{group}]\n{line}\n")
    (site / f"{name}.py").write_text(code)


def run(site: Path, code: str) -> str:
    done = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        timeout=20,
        env={**os.environ, "PYTHONPATH": str(site)},
    )
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


def test_shipped_one_that_misses_a_library_troubles_nobody() -> None:
    plugins = CarrierRegistry({**CARRIERS, "odd": CarrierRow("odd", "yarpy.carriers.no_such:Odd")})
    assert "tcp" in [carrier.name for carrier in plugins]
    with pytest.raises(UnknownPlugin, match=r'"odd" cannot be loaded .*no_such'):
        plugins.load("odd")


def test_strangers_come_by_entry_point(tmp_path: Path) -> None:
    code = "from yarpy.carriers.base import Carrier\nclass Other(Carrier):\n    name = 'other'\n"
    install(tmp_path, "stranger", "yarpy.carriers", "other = stranger:Other", code)
    install(tmp_path, "monitor", "yarpy.monitors", "watch = monitor:Watch", "class Watch: pass\n")
    out = run(
        tmp_path,
        "from yarpy import registry\n"
        "import sys\n"
        "print('stranger' in sys.modules, registry.carriers.names()[-1],\n"
        "      registry.carriers.load('other').name, registry.monitors.load('watch').__name__)",
    )
    assert out == "False other other Watch"


def test_broken_stranger_names_its_package_and_troubles_nobody(tmp_path: Path) -> None:
    install(tmp_path, "broken", "yarpy.carriers", "odd = broken:Odd", "import no_such_module\n")
    out = run(
        tmp_path,
        "from yarpy import registry, UnknownPlugin\n"
        "print(len(list(registry.carriers)) > 5)\n"
        "try:\n"
        "    registry.carriers.load('odd')\n"
        "except UnknownPlugin as error:\n"
        "    print(error)",
    )
    first, second = out.splitlines()
    assert first == "True"
    for words in ('"odd" of broken', "ModuleNotFoundError", "repair or uninstall broken"):
        assert words in second


def test_shipped_plugin_whose_library_is_missing_troubles_nobody() -> None:
    """Every incoming connection asks all carriers whether it is theirs."""
    own = CarrierRegistry({"odd": CarrierRow("odd", "no_such_library.odd:Odd"), **CARRIERS})
    with pytest.raises(UnknownPlugin, match="install what is missing"):
        own.load("odd")
    assert "tcp" in [carrier.name for carrier in own]


def test_shipped_name_cannot_be_taken_by_a_stranger(tmp_path: Path) -> None:
    install(tmp_path, "thief", "yarpy.carriers", "tcp = thief:Tcp", "class Tcp: pass\n")
    code = "from yarpy import registry; print(registry.carriers.load('tcp').__module__)"
    assert run(tmp_path, code) == "yarpy.carriers.own.tcp"


def test_several_threads_load_one_class() -> None:
    own = CarrierRegistry()
    found: list[object] = []
    threads = [threading.Thread(target=lambda: found.append(own.load("udp"))) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(HANG)
    assert len(set(found)) == 1


def test_a_connection_imports_the_carrier_that_it_is_of_alone() -> None:
    """Asking 24 carriers whether it is theirs took as long as a hundred messages."""
    code = (
        "import sys\n"
        "from yarpy import registry\n"
        "registry.carriers._entries = lambda: sys.exit('installed packages were scanned')\n"
        "before = set(sys.modules)\n"
        "found = [kind.name for kind in registry.carriers.beginning(b'CONNECT ')]\n"
        "print(found, registry.carriers.facts('zenoh').reaches.topic)\n"
        "rooms = 'yarpy.carriers.', 'yarpy.peers.'\n"
        "print(sorted(name for name in sys.modules.keys() - before if name.startswith(rooms)))\n"
    )
    said, loaded = run(Path("."), code).splitlines()
    assert said == "['text'] True"
    assert loaded == "['yarpy.carriers.base', 'yarpy.carriers.own', 'yarpy.carriers.own.text']"


def test_strangers_are_asked_where_ours_are_not_certain(tmp_path: Path) -> None:
    code = (
        "from yarpy.carriers.base import Carrier\n"
        "from yarpy.facts import TOPIC\n"
        "class Other(Carrier):\n"
        "    name, magic, reaches = 'other', b'GET /oth', TOPIC\n"
    )
    install(tmp_path, "stranger", "yarpy.carriers", "other = stranger:Other", code)
    out = run(
        tmp_path,
        "import sys\n"
        "from yarpy import registry\n"
        "from yarpy.contact import parse_contact\n"
        "from yarpy.link.begin.handshake import recognise\n"
        "print(recognise(b'CONNECT ').name, 'stranger' in sys.modules)\n"
        "print(recognise(b'GET /oth').name, recognise(b'GET /abc').name)\n"
        "print(parse_contact('other://a:1/b').placed, registry.carriers.owner('other'))",
    )
    assert out.splitlines() == ["text False", "other http", "True stranger"]


def test_facts_of_names_that_nobody_knows_are_not_kept() -> None:
    own = CarrierRegistry()
    for number in range(100):
        assert not own.facts(f"nosuch{number}").reaches.foreign
    assert own.facts("h264").reaches.foreign
    assert not own.facts("h264").push
    assert own._facts == {}


def test_modules_of_ours_are_imported_where_no_signal_handler_can_cut_that(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Python would keep a module locked for ever whose import was cut in a bad moment."""
    importing: list[threading.Thread] = []

    def note(name: str) -> object:
        importing.append(threading.current_thread())
        return importlib.import_module(name)

    monkeypatch.setattr(registry, "import_module", note)
    monkeypatch.delitem(sys.modules, "yarpy.carriers.own.mcast", raising=False)
    shipped = {**CARRIERS, "lost": Row("lost", "yarpy.nowhere:It")}
    found = Registry("carriers", shipped)
    assert found.load("mcast").name == "mcast"
    assert importing[-1] is not threading.main_thread()
    with pytest.raises(UnknownPlugin, match="cannot be loaded"):
        found.load("lost")


def test_calls_of_nodes_are_known_before_their_graph_is_imported() -> None:
    graphs = GraphRegistry()
    for request in ("publisherUpdate", "rpup", "rpupdate"):
        found = graphs.call(request)
        assert found is not None
        assert (found[0], found[1].name, found[1].changes) == ("ros", "publisherUpdate", True)
    assert [graphs.call(one) for one in ("publisher", "list", "")] == [None] * 3
    assert not graphs._loaded


def test_a_graph_of_strangers_has_calls_of_its_own() -> None:
    class Ants:
        calls = (Call("smell", "smel"),)

    graphs = GraphRegistry()
    assert graphs.call("smell") is None
    graphs.add("ants", Ants)
    graphs.add("broken", object())
    assert graphs.call("smel") == graphs.call("smell") == ("ants", Ants.calls[0])
    graphs.remove("ants")
    assert graphs.call("smell") is None
