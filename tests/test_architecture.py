"""The architecture, enforced: layers, a test file per source file, light and portable imports.

Rules: plain `ast` and fresh interpreters; of yarpy only a table is imported here. Each file is read
once, and each rule is one test, which names all that break it. `LAYERS` is the table of the
architecture page with the lowest room first; a room may import itself and the rooms before it, and
within a row only what `BESIDE` lists.
"""

import ast
import os
import re
import subprocess
import sys
from collections.abc import Iterable, Iterator, Sequence
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from yarpy.shipped import PACKAGES

pytestmark = pytest.mark.usefixtures("no_collector", "trees")

ROOT = Path(__file__).parents[1]
SOURCE = ROOT / "src" / "yarpy"
TESTS = ROOT / "tests"

# Rooms are packages, or single files of the top level; of `peers` and `kits` each folder is one;
# what is in a folder `verbs` belongs to the command line, wherever it lies.
CORE_LAYERS: list[set[str]] = [
    {"errors", "log", "fork", "linger", "platform", "callback_thread", "installed"},
    {"limit", "facts", "bounded_file"},
    {"shipped_devices"},
    {"shipped"},
    {"registry", "route", "scope", "threads"},
    {"contact"},
    {"wire", "data"},
    {"carriers", "transports"},
    {"link", "monitors", "qos"},
    {"config"},
    {"names"},
    {"port"},
    {"network", "clock", "module", "resource", "aio", "real_time", "idl"},
    {"nameserver"},
]
PEERS = {"mpi", "mqtt", "ros", "ros2", "zenoh", "zmq"}
KITS = {"autoqos", "devices", "doctor", "launch", "record", "sim", "thrift", "views", "wrap"}
LAYERS: list[set[str]] = [
    *CORE_LAYERS,
    {f"peers.{name}" for name in PEERS},
    {f"kits.{name}" for name in KITS},
    {"cli", "testing"},
    {"__main__"},
]
BESIDE = {
    ("registry", "threads"),
    ("threads", "scope"),
    ("linger", "errors"),
    ("linger", "fork"),
    ("linger", "log"),
    ("linger", "platform"),
    ("platform", "errors"),
    ("link", "monitors"),
    ("link", "qos"),
    ("monitors", "qos"),
    ("aio", "network"),
    ("clock", "network"),
    ("module", "clock"),
    ("module", "network"),
    ("module", "resource"),
    # The topics of ROS 2 are messages of ROS, over Zenoh.
    ("peers.ros2", "peers.ros"),
    ("peers.ros2", "peers.zenoh"),
    ("kits.launch", "kits.record"),
    ("kits.launch", "kits.thrift"),
    ("kits.launch", "kits.views"),
    ("kits.views", "kits.sim"),
    ("kits.views", "kits.devices"),
    ("kits.sim", "kits.devices"),
    ("kits.devices", "kits.thrift"),
}
# Imports that point up and are still to be turned round.
UPWARD: set[tuple[str, str]] = set()
# What a guest brings to a kit lies with the guest and knows that kit, as verbs know the shell;
# the kit asks for it by name.
BROUGHT = {
    *((f"peers/{name}/middleware.py", "kits.wrap") for name in PEERS),
    ("peers/ros/service/method.py", "kits.wrap"),
    ("peers/zmq/broker.py", "kits.wrap"),
    ("peers/zmq/link.py", "kits.wrap"),
    *(
        (f"peers/{name}.py", kit)
        for name in ("ros/robot", "ros/robot_state", "ros2/robot")
        for kit in ("kits.sim", "kits.devices")
    ),
}
# The files that can be compiled.
_TREE = ast.parse((ROOT / "hatch_build.py").read_text("utf-8"))
CORE = {
    f"{word.value}.py"
    for made in _TREE.body
    if isinstance(made, ast.Assign) and getattr(made.targets[0], "id", "") == "CORE"
    for word in ast.walk(made.value)
    if isinstance(word, ast.Constant)
}
# The files of the wire that may know how messages are spelled.
WIRE_KNOWS_DATA = {"message.py", "framing.py", "datagram.py"}

PURE = ("wire/", "data/", "carriers/", "peers/ros/message/", "peers/ros2/message/", "kits/thrift/")
PURE_FILES = {
    *(f"peers/{name}/carrier.py" for name in PEERS),
    *(f"peers/mqtt/{name}.py" for name in ("broker", "packet", "session")),
    *(f"peers/ros/{name}.py" for name in ("body", "greeting", "header", "service/carrier")),
    *(f"peers/zmq/{name}.py" for name in ("zmtp", "role", "writing", "reading")),
    "peers/ros2/body.py",
}
IMPURE_MODULES = {"socket", "threading", "asyncio", "time", "select", "selectors", "queue"}

# Modules that do not exist, or not whole, outside Linux or Unix.
UNIX_MODULES = {
    "fcntl", "grp", "posix", "pty", "pwd", "readline", "resource", "spwd", "syslog", "termios",
    "tty",
}  # fmt: skip
HEAVY_MODULES = ("numpy", "click", "rich", "sqlite3", "asyncio", "email", "http", "xml")

FILES = sorted(SOURCE.rglob("*.py"))
assert FILES, "no sources found"


def relative(path: Path) -> str:
    return str(path.relative_to(SOURCE))


def room(path: Path) -> str:
    parts = path.relative_to(SOURCE).parts
    if "verbs" in parts:
        return "cli"
    return room_of([*parts[:-1], path.stem])


def room_of(parts: Sequence[str]) -> str:
    """The room of the module `yarpy.` + `parts`."""
    return ".".join(parts[:2]) if parts[0] in ("peers", "kits") else parts[0]


def layer(name: str) -> int:
    for number, rooms in enumerate(LAYERS):
        if name in rooms:
            return number
    raise AssertionError(f"the room {name!r} is not in the table of layers")


@cache
def tree(path: Path) -> ast.Module:
    """Return what a file says."""
    return ast.parse(path.read_text("utf-8"))


@cache
def nodes(path: Path) -> dict[type[ast.AST], list[Any]]:
    """Return the imports, classes and handlers of errors anywhere in a file."""
    found: dict[type[ast.AST], list[Any]] = {
        kind: [] for kind in (ast.Import, ast.ImportFrom, ast.ClassDef, ast.ExceptHandler)
    }
    for node in statements(tree(path)):
        if type(node) in found:
            found[type(node)].append(node)
    return found


@pytest.fixture(scope="module")
def trees() -> Iterator[None]:
    """What the files say, until the last test here has looked at it."""
    yield
    for kept in (tree, nodes, imports):
        kept.cache_clear()


def statements(node: ast.AST) -> Iterator[ast.AST]:
    """Return the statements within a node, and what handles errors among them; no expressions,
    which are most of a file."""
    for field in ("body", "handlers", "orelse", "finalbody", "cases"):
        for each in getattr(node, field, ()):
            yield each
            yield from statements(each)


@cache
def imports(path: Path) -> tuple[tuple[str, int], ...]:
    """Return every module that a file imports anywhere, with the line."""
    return tuple(_imports(path))


def _imports(path: Path) -> Iterator[tuple[str, int]]:
    for node in nodes(path)[ast.Import]:
        for alias in node.names:
            yield alias.name, node.lineno
    for node in nodes(path)[ast.ImportFrom]:
        assert node.level == 0, f"{path}:{node.lineno}: a relative import"
        module = node.module or ""
        # `from yarpy.port import command` names the module yarpy.port.answer.command
        for alias in node.names:
            yield f"{module}.{alias.name}" if module.startswith("yarpy") else module, node.lineno


def imported_rooms(path: Path) -> Iterator[tuple[str, int]]:
    for module, line in imports(path):
        parts = module.split(".")
        if parts[0] == "yarpy" and len(parts) > 1:
            if "verbs" in parts:
                yield "cli", line
            elif parts[1] not in ("peers", "kits") or len(parts) > 2:
                yield room_of(parts[1:]), line


def module_level(body: list[ast.stmt]) -> Iterator[ast.stmt]:
    """The statements that run when a module is imported; what is guarded is not among them."""
    for node in body:
        yield node
        if isinstance(node, ast.ClassDef | ast.With):
            yield from module_level(node.body)


def test_imports_point_down_or_stay_in_the_room() -> None:
    wrong = []
    for path in FILES:
        own = room(path)
        if own == "__init__":
            continue  # the public face names everything and imports it when it is asked for
        for other, line in imported_rooms(path):
            if other in (own, "__version__"):
                continue
            fine = layer(other) < layer(own) or (own, other) in BESIDE
            if other.startswith("peers.") and not own.startswith("peers."):
                # Guests are asked for by name; only their own verbs know them.
                fine = relative(path).startswith(other.replace(".", "/") + "/verbs/")
            fine = fine or (relative(path), other) in UPWARD | BROUGHT
            if (own, other) == ("wire", "data"):
                fine = path.name in WIRE_KNOWS_DATA
            if not fine:
                wrong.append(f"{relative(path)}:{line}: {own} imports {other}, which is above it")
    assert wrong == []


def module_name(path: Path) -> str:
    parts = path.relative_to(SOURCE.parent).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def circles(graph: dict[str, set[str]]) -> list[set[str]]:
    """The sets of files that reach each other, each with more than one in it."""
    reached: dict[str, set[str]] = {}
    for start in graph:
        reached[start], waiting = set(), [start]
        while waiting:
            for other in graph[waiting.pop()] - reached[start]:
                reached[start].add(other)
                waiting.append(other)
    found: list[set[str]] = []
    for name in graph:
        circle = {other for other in reached[name] if name in reached[other]}
        if circle and circle not in found:
            found.append(circle)
    return found


def test_no_two_files_import_each_other() -> None:
    """Whether at the top, inside a function or for type checkers alone: who needs another file's
    type depends on that file. Of two that need each other one is handed what it needs: a callable,
    an object, or one described by a Protocol of its own."""
    modules = {module_name(path): path for path in FILES}
    del modules["yarpy"]  # the public face names everything and imports it when it is asked for
    graph: dict[str, set[str]] = {}
    for name, path in modules.items():
        # `from yarpy.port.answer import command` means a file as well.
        found = {
            module if module in modules else module.rpartition(".")[0]
            for module, _ in imports(path)
        }
        graph[name] = found & modules.keys() - {name}
    assert circles(graph) == []


def test_pure_rooms_have_no_sockets_threads_or_clock() -> None:
    wrong = [
        f"{relative(path)}:{line} imports {module}"
        for path in FILES
        if (relative(path).startswith(PURE) and room(path) != "cli") or relative(path) in PURE_FILES
        for module, line in imports(path)
        if module.partition(".")[0] in IMPURE_MODULES
    ]
    assert wrong == []


def test_what_users_call_starts_threads_that_no_signal_handler_cuts() -> None:
    rooms = {"transports", "link", "port", "aio", "network", "names", "module"}
    wrong = [
        relative(path)
        for path in FILES
        if room(path) in rooms and "threading.Thread(" in path.read_text(encoding="utf-8")
    ]
    assert wrong == [], "start a `Thread` of yarpy.threads there"


def readings_of_errors(handlers: Iterable[ast.AST]) -> Iterator[int]:
    """The lines where the text of a caught error is looked into, to find out what has happened."""
    for handler in handlers:
        if not isinstance(handler, ast.ExceptHandler) or handler.name is None:
            continue
        text = ast.dump(ast.parse(f"str({handler.name})", mode="eval").body)
        for node in ast.walk(handler):
            looked: list[ast.expr] = []
            if isinstance(node, ast.Attribute) and node.attr in ("startswith", "endswith", "find"):
                looked = [node.value]
            elif isinstance(node, ast.Compare):
                looked = [*node.comparators]
            if any(ast.dump(one) == text for one in looked):
                yield node.lineno


def test_errors_are_told_apart_by_type_not_by_text() -> None:
    wrong = [
        f"{relative(path)}:{line}"
        for path in FILES
        if relative(path) != "kits/devices/hardware/audio.py"  # PortAudio has but one error
        for line in readings_of_errors(nodes(path)[ast.ExceptHandler])
    ]
    assert wrong == []


def test_reading_of_an_error_is_found() -> None:
    code = "try:\n    f()\nexcept E as error:\n    if {}:\n        g(str(error))"
    for bad in ("str(error).startswith('x')", "'x' in str(error)", "'x' == str(error)"):
        assert [*readings_of_errors(ast.walk(ast.parse(code.format(bad))))] == [4]
    assert [*readings_of_errors(ast.walk(ast.parse(code.format("str(error) in said"))))] == []


def test_nothing_is_reached_in_a_transport_by_getattr() -> None:
    """Each member of a transport is in its contract (transports/base.py)."""
    wrong = [
        f"{relative(path)}:{node.lineno}"
        for path in FILES
        if re.search(r"\b(get|has)attr\(", path.read_text("utf-8"))
        for node in ast.walk(tree(path))
        if isinstance(node, ast.Call)
        and getattr(node.func, "id", "") in ("getattr", "hasattr")
        and getattr(node.args[0], "attr", getattr(node.args[0], "id", ""))
        in ("transport", "through", "handle", "pipe")
    ]
    assert wrong == []


def test_the_core_asks_for_facts_and_not_for_names_of_carriers() -> None:
    """Nothing compares the name of a class of carriers, or keeps a list of them."""
    core = {name for rooms in CORE_LAYERS for name in rooms}
    wrong = [
        f"{relative(path)}:{node.lineno}"
        for path in FILES
        if room(path) in core - {"data"}
        for node in ast.walk(tree(path))
        if isinstance(node, ast.Compare)
        and isinstance(node.left, ast.Attribute)
        and node.left.attr == "name"
        and getattr(node.left.value, "attr", getattr(node.left.value, "id", ""))
        in ("kind", "carrier", "speaker")
    ]
    assert wrong == []


def test_every_thread_is_in_a_table() -> None:
    """Of docs/internals.md, by the first word of its name; those of commands live as long as the
    command."""
    text = (ROOT / "docs" / "internals.md").read_text()
    told = set(re.findall(r"`yarpy (\w+)", text[text.index("## Threads") :]))
    names = {
        (relative(path), word)
        for path in FILES
        if room(path) not in ("cli", "testing")
        for word in re.findall(r'name ?= ?f?"yarpy (\w+)', path.read_text())
    }
    assert names and sorted(item for item in names if item[1] not in told) == []


def test_no_public_name_is_that_of_a_module_too() -> None:
    """Importing `yarpy.NAME` would put the module in its place."""
    code = (
        "import types, yarpy\n"
        "print([n for n in yarpy.__all__ if not isinstance(getattr(yarpy, n), types.ModuleType)])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    names = ast.literal_eval(done.stdout)
    assert names and [n for n in names if any((SOURCE / n).parent.glob(f"{n}.py"))] == []


def test_modules_say_what_they_are_for() -> None:
    """They begin with a docstring."""
    silent = [path for path in FILES if tree(path).body and not ast.get_docstring(tree(path))]
    assert [*map(relative, silent)] == []


def test_files_that_comments_name_are_there() -> None:
    """In backticks, from any folder above: of the file itself, of the rooms, of the checkout."""
    wrong = []
    for path in FILES:
        roots = [
            *(one for one in path.parents if one == SOURCE or SOURCE in one.parents),
            TESTS,
            ROOT,
        ]
        roots += [SOURCE / "kits", SOURCE / "peers"]
        for number, line in enumerate(path.read_text("utf-8").splitlines(), 1):
            for name in re.findall(r"`([\w./]+\.py)`", line):
                ring = name.partition("/")[0]
                if ring in ("kits", "peers") and not (SOURCE / ring).exists():
                    continue  # `make alone`
                if not any((root / name).exists() for root in roots):
                    wrong.append(f"{relative(path)}:{number}: there is no {name}")
    assert wrong == []


def test_modules_have_their_test_files() -> None:
    missing = [
        f"tests/{path.relative_to(SOURCE).parent}/test_{path.name}"
        for path in FILES
        if path.name not in ("__init__.py", "__main__.py")
        and not (TESTS / path.relative_to(SOURCE).parent / f"test_{path.name}").exists()
    ]
    assert missing == []


def test_no_group_is_repeated_possessively() -> None:
    """Python before 3.11.5, as Debian 12 has it, matches `(?:ab?)*+` wrongly: `(?>(?:ab?)*)` is the
    same, and right there."""
    group = re.compile(r"[^\\]\)(?:[*+?]|\{[^}]*\}{1,2})\+")
    places = [
        f"{relative(path)}:{number}"
        for path in [*FILES, *(ROOT / "compat").rglob("*.py")]
        for number, line in enumerate(path.read_text("utf-8").splitlines(), 1)
        if group.search(line)
    ]
    assert places == []


def test_nothing_unix_only_is_imported_at_module_level() -> None:
    wrong = []
    for path in FILES:
        for node in module_level(tree(path).body):
            names: list[str] = []
            if isinstance(node, ast.Import):
                names = [alias.name for alias in node.names]
            elif isinstance(node, ast.ImportFrom):
                names = [node.module or ""]
            found = UNIX_MODULES.intersection(name.partition(".")[0] for name in names)
            if found:
                wrong.append(f"{relative(path)}:{node.lineno} imports {found} wherever it runs")
    assert wrong == []


def run_python(code: str) -> str:
    """What a fresh interpreter prints, started as a user would."""
    environment = {
        k: v for k, v in os.environ.items() if k not in ("PYTHONPATH", "COV_CORE_SOURCE")
    }
    done = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        timeout=30,
        env=environment,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


LOADED = f"print(sorted(set({HEAVY_MODULES!r}) & sys.modules.keys()))"


def test_import_loads_nothing_heavy() -> None:
    assert run_python(f"import sys, yarpy; {LOADED}").strip() == "[]"


GUESTS = "print(sorted(n for n in sys.modules if n.startswith(('yarpy.peers', 'yarpy.kits'))))"


def test_the_core_runs_without_its_guests() -> None:
    """A name server and two ports over tcp load no peer and no kit, though all are installed."""
    code = f"""
import sys, yarpy
{GUESTS}
with yarpy.NameServer() as server:
    host, _, number = server.address.rpartition(":")
    names = yarpy.YarpNameClient(host, int(number))
    with yarpy.Port("/in", names=names) as reader, yarpy.Port("/out", names=names) as writer:
        writer.connect("/in", "tcp")
        writer.write([1, 2])
        assert list(reader.read(timeout=20).value) == [1, 2]
{GUESTS}
"""
    assert run_python(code).split() == ["[]", "[]"]


def test_every_public_name_resolves_without_numpy() -> None:
    """The classes of arrays too: numpy comes with the first array, not with its class."""
    code = f"import sys, yarpy; [getattr(yarpy, name) for name in yarpy.__all__]; {LOADED}"
    assert run_python(code).strip() == "[]"


def test_public_names_are_complete() -> None:
    """`__all__`, what Python finds and what type checkers see are the same names, in the same
    modules; `__all__` is written out, so that it can be read."""
    tree = ast.parse((SOURCE / "__init__.py").read_text())
    typed: dict[str, str] = {}
    modules: dict[str, str] = {}
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("yarpy"):
            for alias in node.names:
                is_module = alias.asname is not None
                found = modules if is_module else typed
                found[alias.name] = f"{node.module}.{alias.name}" if is_module else str(node.module)
    tables = {
        node.targets[0].id: ast.literal_eval(node.value)
        for node in ast.walk(tree)
        if isinstance(node, ast.Assign)
        and isinstance(node.targets[0], ast.Name)
        and isinstance(node.value, ast.Dict | ast.List)
    }
    assert tables["_WHERE"] == typed
    packages = {name: row.target for name, row in PACKAGES.items()}
    assert {**tables["_ROOMS"], **packages} == modules
    assert sorted(tables["__all__"]) == sorted({*typed, "__version__"})
    assert set(run_python("import yarpy; print(*dir(yarpy))").split()) == {*typed, "__version__"}


def test_a_name_that_is_wrong_is_refused_with_the_right_one() -> None:
    command = [sys.executable, "-c", "import yarpy; yarpy.Prot"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60)
    assert """no attribute 'Prot': did you mean "Port"?""" in done.stderr


def test_core_is_importable_where_unix_modules_are_missing() -> None:
    """As on Windows: the modules are not there, and neither are the calls of Unix sockets."""
    code = f"""
import sys
for name in {sorted(UNIX_MODULES - {"posix"})!r}:  # the standard library itself needs that one
    sys.modules[name] = None
import os, socket, select
for module, names in ((socket, ("AF_UNIX", "SO_REUSEPORT", "MSG_DONTWAIT", "recvmsg_into")),
                      (select, ("poll", "epoll")),
                      (os, ("sched_setscheduler", "sched_getscheduler", "getuid", "fork"))):
    for name in names:
        if hasattr(module, name):
            delattr(module, name)
import yarpy
for name in yarpy.__all__:
    getattr(yarpy, name)
with yarpy.NameServer() as server, yarpy.Port("/reader") as reader, yarpy.Port("/writer") as writer:
    writer.connect("/reader")
    writer.write([1, "two"])
    print(reader.read(timeout=5).value.to_text())
"""
    assert run_python(code).strip() == "1 two"


def _from_core(tree: ast.Module) -> set[str]:
    """The compiled files that a file imports, and what it imports from such."""
    imports = [node for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)]
    return {
        alias.name
        for node in imports
        for alias in node.names
        for whole in [f"{node.module}.{alias.name}"]
        if {_file(node.module or ""), _file(whole)} & CORE
    }


def _file(module: str) -> str:
    return module.removeprefix("yarpy.").replace(".", "/") + ".py"


def test_compiled_classes_have_no_interpreted_children() -> None:
    """mypyc refuses that, and only when such an object is made."""
    inside = {path: path.relative_to(SOURCE).as_posix() in CORE for path in FILES}
    found = {path: nodes(path)[ast.ClassDef] for path in FILES}
    core = {node.name for path, classes in found.items() if inside[path] for node in classes}
    assert {"ByteStream", "Receiver"} <= core
    children = [
        f"{path.relative_to(SOURCE)}: {node.name}"
        for path, classes in found.items()
        if not inside[path]
        for node in classes
        for bases in [{ast.unparse(base) for base in node.bases}]
        if "Protocol" not in bases  # of which no objects are made
        and {base.rpartition(".")[2] for base in bases} & core
        and {base.partition(".")[0] for base in bases} & _from_core(tree(path))
    ]
    assert not children
