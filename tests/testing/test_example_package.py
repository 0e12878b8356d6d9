"""The example of a carrier package: installed by pip it is used by name, with no other change."""

from __future__ import annotations

import importlib.util
import json
import os
import socket
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from yarpy.testing import CarrierConformance

PACKAGE = Path(__file__).parents[2] / "examples" / "carrier_package"
SOURCE = PACKAGE / "yarpy_json_lines.py"


def load() -> Any:
    spec = importlib.util.spec_from_file_location("yarpy_json_lines", SOURCE)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


class TestJsonLines(CarrierConformance):
    carrier = load().JsonLines
    values = (
        [],
        [1, -(2**40), 1.5, True, None],
        ["text", "", 'quo"te', "back\\slash", "line\nbreak\r", "\u00fc\u4f60"],
        [[], [1, ["deep"]]],
        {"key": 1, "group": {"inner": [1, 2]}},
        "a string",
        7,
    )

    def expected(self, value: Any) -> Any:
        return json.loads(json.dumps(value, default=list))

    def _check(self, message: Any, value: Any) -> None:
        assert message.value == self.expected(value)


def test_example_is_one_short_file() -> None:
    files = [path.name for path in PACKAGE.iterdir() if not path.name.startswith(("_", "."))]
    assert sorted(files) == ["pyproject.toml", "yarpy_json_lines.py"]
    assert len(SOURCE.read_text().splitlines()) < 60


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The package, installed by pip into a folder of its own; nothing is fetched."""
    pytest.importorskip("hatchling", reason="the build backend comes with yarpy[test]")
    target = tmp_path_factory.mktemp("site")
    options = ["--quiet", "--no-deps", "--no-build-isolation", "--no-index", "--no-cache-dir"]
    command = [sys.executable, "-m", "pip", "--disable-pip-version-check", "install", *options]
    done = subprocess.run(
        [*command, "--target", str(target), str(PACKAGE)],
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert done.returncode == 0, done.stderr
    return target


USE = """
import sys, yarpy
with yarpy.NameServer(), yarpy.Port("/out") as out, yarpy.Port("/in") as in_:
    out.connect("/in", "json_lines")
    out.write(["hello", 1, [2.5]], yarpy.Stamp(3, 4.5))
    message = in_.read(timeout=5)
    print(message.value, message.stamp, message.source, in_.inputs[0].carrier)
    print(yarpy.disconnect("/out", "/in"), out.outputs)
    with yarpy.RpcServer("/server", lambda message: sum(message.value)):
        with yarpy.RpcClient("/server", carrier="json_lines") as client:
            print(client.call(1, 2, 3))
print(sorted(name for name in sys.modules if "json_lines" in name))
"""


def run(code: str, *path: Path) -> str:
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(map(str, path))}
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, timeout=30, env=environment
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_installed_carrier_is_used_by_name(installed: Path) -> None:
    assert run(USE, installed).splitlines() == [
        "['hello', 1, [2.5]] Stamp(count=3, time=4.5) /out json_lines",
        "True []",
        "6",
        "['yarpy_json_lines']",
    ]


def test_without_it_the_name_is_unknown() -> None:
    code = """
import yarpy
names = yarpy.LocalNames()
with yarpy.Port("/out", names=names) as out, yarpy.Port("/in", names=names):
    try:
        out.connect("/in", "json_lines")
    except yarpy.UnknownPlugin as error:
        print(error)
"""
    assert 'no carrier "json_lines"' in run(code)


def test_person_with_netcat(installed: Path) -> None:
    """Any program that can open a socket takes part."""
    code = """
import yarpy
server = yarpy.RpcServer("/adder", lambda message: sum(message.value), names=yarpy.LocalNames())
with server:
    print(server.address, flush=True)
    input()
"""
    environment = {**os.environ, "PYTHONPATH": str(installed)}
    with subprocess.Popen(
        [sys.executable, "-c", code],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        env=environment,
    ) as process:
        assert process.stdout is not None
        host, _, port = process.stdout.readline().strip().rpartition(":")
        with socket.create_connection((host, int(port)), 5) as person:
            person.sendall(b'JSONLINE me\n{"data": [1, 2], "reply": true}\n')
            assert json.loads(person.makefile().readline()) == {"data": 3}
        process.communicate("\n", timeout=10)
    assert process.returncode == 0
