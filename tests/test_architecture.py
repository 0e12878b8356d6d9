"""The architecture, enforced: layers, a test file per source file, light and portable imports.

Rules: plain `ast` and fresh interpreters; nothing of yarpy is imported here. `LAYERS` is the table
of the architecture page with the lowest room first; a room may import itself and the rooms before
it, and within a row only what `BESIDE` lists.
"""

import ast
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
SOURCE = ROOT / "src" / "yarpy"
TESTS = ROOT / "tests"

# Rooms are packages, or single files of the top level.
LAYERS: list[set[str]] = [
    {"errors", "log"},
    {"registry", "contact", "route"},
    {"wire", "data", "idl"},
    {"carriers", "transports"},
    {"link", "monitors", "qos"},
    {"config"},
    {"names"},
    {"port", "ros", "ros2", "zenoh", "devices", "record"},
    {"network", "module", "resource", "aio", "wrap", "realtime"},
    {"views", "sim", "nameserver"},
    {"cli", "testing"},
    {"__main__"},
]
BESIDE = {
    ("idl", "data"),
    ("registry", "contact"),
    ("link", "monitors"),
    ("link", "qos"),
    ("monitors", "qos"),
    ("ros", "port"),
    ("ros2", "port"),
    ("devices", "port"),
    ("record", "port"),
    ("wrap", "network"),
    ("aio", "network"),
    ("module", "network"),
    ("module", "resource"),
    ("views", "sim"),
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

PURE = ("wire", "data", "idl", "carriers")
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
    return parts[0] if len(parts) > 1 else path.stem


def layer(name: str) -> int:
    for number, rooms in enumerate(LAYERS):
        if name in rooms:
            return number
    raise AssertionError(f"the room {name!r} is not in the table of layers")


def imports(path: Path) -> Iterator[tuple[str, int]]:
    """Every module that a file imports anywhere, with the line."""
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            for alias in node.names:
                yield alias.name, node.lineno
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}:{node.lineno}: a relative import"
            module = node.module or ""
            # `from yarpy.port import command` names the module yarpy.port.command
            for alias in node.names:
                yield (
                    f"{module}.{alias.name}" if module.startswith("yarpy") else module,
                    (node.lineno),
                )


def imported_rooms(path: Path) -> Iterator[tuple[str, int]]:
    for module, line in imports(path):
        parts = module.split(".")
        if parts[0] == "yarpy" and len(parts) > 1:
            yield parts[1], line


def module_level(body: list[ast.stmt]) -> Iterator[ast.stmt]:
    """The statements that run when a module is imported; what is guarded is not among them."""
    for node in body:
        yield node
        if isinstance(node, ast.ClassDef | ast.With):
            yield from module_level(node.body)


@pytest.mark.parametrize("path", FILES, ids=relative)
def test_imports_point_down_or_stay_in_the_room(path: Path) -> None:
    own = room(path)
    if own == "__init__":
        return  # the public face names everything and imports it when it is asked for
    for other, line in imported_rooms(path):
        if other in (own, "__version__"):
            continue
        fine = layer(other) < layer(own) or (own, other) in BESIDE
        if (own, other) == ("wire", "data"):
            fine = path.name in WIRE_KNOWS_DATA
        assert fine, f"{relative(path)}:{line}: {own} imports {other}, which is not below it"


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
        # `from yarpy.port import command` means a file, `from yarpy.port.command import obey` too.
        found = {
            module if module in modules else module.rpartition(".")[0]
            for module, _ in imports(path)
        }
        graph[name] = found & modules.keys() - {name}
    assert circles(graph) == []


@pytest.mark.parametrize("path", FILES, ids=relative)
def test_pure_rooms_have_no_sockets_threads_or_clock(path: Path) -> None:
    if room(path) not in PURE:
        return
    for module, line in imports(path):
        top = module.partition(".")[0]
        assert top not in IMPURE_MODULES, f"{relative(path)}:{line} imports {module}"


def readings_of_errors(tree: ast.Module) -> Iterator[int]:
    """The lines where the text of a caught error is looked into, to find out what has happened."""
    for handler in ast.walk(tree):
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


@pytest.mark.parametrize("path", FILES, ids=relative)
def test_errors_are_told_apart_by_type_not_by_text(path: Path) -> None:
    if relative(path) == "views/audio.py":
        return  # PortAudio has one error for everything
    assert [*readings_of_errors(ast.parse(path.read_text()))] == []


def test_reading_of_an_error_is_found() -> None:
    code = "try:\n    f()\nexcept E as error:\n    if {}:\n        g(str(error))"
    for bad in ("str(error).startswith('x')", "'x' in str(error)", "'x' == str(error)"):
        assert [*readings_of_errors(ast.parse(code.format(bad)))] == [4]
    assert [*readings_of_errors(ast.parse(code.format("str(error) in said")))] == []


@pytest.mark.parametrize("path", FILES, ids=relative)
def test_module_says_what_it_is_for(path: Path) -> None:
    tree = ast.parse(path.read_text())
    if tree.body:
        assert ast.get_docstring(tree), f"{relative(path)} does not begin with a docstring"


@pytest.mark.parametrize("path", FILES, ids=relative)
def test_module_has_its_test_file(path: Path) -> None:
    if path.name == "__init__.py" or path.name == "__main__.py":
        return
    within = path.relative_to(SOURCE)
    expected = TESTS / within.parent / f"test_{path.name}"
    assert expected.exists(), f"{relative(path)} has no {expected.relative_to(ROOT)}"


@pytest.mark.parametrize("path", FILES, ids=relative)
def test_nothing_unix_only_is_imported_at_module_level(path: Path) -> None:
    for node in module_level(ast.parse(path.read_text()).body):
        names: list[str] = []
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            names = [node.module or ""]
        found = UNIX_MODULES.intersection(name.partition(".")[0] for name in names)
        assert not found, f"{relative(path)}:{node.lineno} imports {found} wherever it runs"


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


def test_every_public_name_resolves_without_numpy() -> None:
    """The classes of arrays too: numpy comes with the first array, not with its class."""
    code = f"import sys, yarpy; [getattr(yarpy, name) for name in yarpy.__all__]; {LOADED}"
    assert run_python(code).strip() == "[]"


def test_public_names_are_complete() -> None:
    """`dir(yarpy)`, `__all__` and what type checkers see are the same names."""
    tree = ast.parse((SOURCE / "__init__.py").read_text())
    typed = {
        alias.asname or alias.name
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("yarpy.")
        for alias in node.names
    }
    listed = set(run_python("import yarpy; print(*yarpy.__all__)").split()) - {"__version__"}
    assert listed - typed == set()
    assert typed - listed == set()


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
    trees = {path: ast.parse(path.read_text("utf-8")) for path in SOURCE.rglob("*.py")}
    inside = {path: path.relative_to(SOURCE).as_posix() in CORE for path in trees}
    found = {
        path: [node for node in ast.walk(tree) if isinstance(node, ast.ClassDef)]
        for path, tree in trees.items()
    }
    core = {node.name for path, nodes in found.items() if inside[path] for node in nodes}
    assert {"ByteStream", "Receiver"} <= core
    children = [
        f"{path.relative_to(SOURCE)}: {node.name}"
        for path, nodes in found.items()
        if not inside[path]
        for node in nodes
        for bases in [{ast.unparse(base) for base in node.bases}]
        if "Protocol" not in bases  # of which no objects are made
        and {base.rpartition(".")[2] for base in bases} & core
        and {base.partition(".")[0] for base in bases} & _from_core(trees[path])
    ]
    assert not children
