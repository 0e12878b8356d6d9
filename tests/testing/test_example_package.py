"""The example of a package: a carrier, a transport and a name client, in a wheel of its own.

Installed by pip they are used by their names, with no other change; and they pass the suites.
"""

from __future__ import annotations

import json
import os
import socket
import subprocess
import sys
from pathlib import Path

import pytest
from support.package import EXAMPLES, install
from support.wait import HANG

PACKAGE = EXAMPLES / "carrier_package"
SOURCE = PACKAGE / "yarpy_json_lines"

SUITES = """
import contextlib, json, tempfile

from yarpy.testing import CarrierConformance, NamesConformance, TransportConformance
from yarpy_json_lines.carrier import JsonHere, JsonLines
from yarpy_json_lines.names import FileNames
from yarpy_json_lines.transport import AbstractSockets


class TestJsonLines(CarrierConformance):
    carrier = JsonLines
    values = (
        [],
        [1, -(2**40), 1.5, True, None],
        ["text", "", \'quo"te\', "back\\\\slash", "line\\nbreak\\r", "\u00fc\u4f60"],
        [[], [1, ["deep"]]],
        {"key": 1, "group": {"inner": [1, 2]}},
        "a string",
        7,
    )

    def expected(self, value):
        return json.loads(json.dumps(value, default=list))

    def _check(self, message, value):
        assert message.value == self.expected(value)


class TestJsonHere(TestJsonLines):
    carrier = JsonHere


class TestAbstractSockets(TransportConformance):
    opener = AbstractSockets


class TestFileNames(NamesConformance):
    @contextlib.contextmanager
    def opened(self):
        with tempfile.TemporaryDirectory() as folder:
            yield FileNames(folder + "/names.json")
"""


def test_each_file_is_short() -> None:
    files = {path.name: path for path in SOURCE.glob("*.py")}
    assert sorted(files) == ["__init__.py", "carrier.py", "names.py", "transport.py"]
    lengths = {name: len(path.read_text().splitlines()) for name, path in files.items()}
    assert lengths["carrier.py"] < 85 and lengths["transport.py"] < 65 and lengths["names.py"] < 160


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return install("carrier_package", tmp_path_factory)


USE = """
import sys, yarpy
with yarpy.NameServer(), yarpy.Port("/out") as out, yarpy.Port("/in") as in_:
    out.connect("/in", "json_lines")
    out.write(["hello", 1, [2.5]], yarpy.Stamp(3, 4.5))
    message = in_.read(timeout=30)
    print(message.value, message.stamp, message.source, in_.inputs[0].carrier)
    print(yarpy.disconnect("/out", "/in"), out.outputs)
    with yarpy.RpcServer("/server", lambda message: sum(message.value)):
        with yarpy.RpcClient("/server", carrier="json_lines") as client:
            print(client.call(1, 2, 3))
print(sorted(name for name in sys.modules if "json_lines" in name))
"""


def run(code: str, *path: Path, **settings: str) -> str:
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(map(str, path)), **settings}
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
        "['yarpy_json_lines', 'yarpy_json_lines.carrier']",
    ]


@pytest.mark.timeout(6 * HANG)
def test_it_passes_the_suites_that_ship(installed: Path, tmp_path: Path) -> None:
    (tmp_path / "test_suites.py").write_text(SUITES)
    environment = {**os.environ, "PYTHONPATH": str(installed)}
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "--rootdir", "."]
    done = subprocess.run(
        [*command, "test_suites.py"],
        cwd=tmp_path, capture_output=True, text=True, timeout=5 * HANG, env=environment,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout[-5000:] + done.stderr[-1000:]
    assert " passed" in done.stdout


HERE = """
import os, sys, yarpy
print(os.environ["YARPY_SERVER"].partition("+")[0])
with yarpy.Port("/out") as out, yarpy.Port("/in") as in_:
    out.connect("/in", "json_here")
    out.write(["hello", 1])
    print(in_.read(timeout=30).value, in_.inputs[0].carrier)
    print([contact.name for contact in yarpy.names().list()])
"""


def test_its_transport_and_its_names_are_used_by_name(installed: Path, tmp_path: Path) -> None:
    code = HERE.replace("yarpy.names().list()", "DEFAULT.current().list()")
    code = "from yarpy.names.default import DEFAULT\n" + code
    where = {"YARPY_SERVER": f"json_file+{tmp_path}/names.json"}
    assert run(code, installed, **where).splitlines() == [
        "json_file",
        "['hello', 1] json_here",
        "['/in', '/out']",
    ]
    assert json.loads((tmp_path / "names.json").read_text()) == {}


def test_its_names_are_a_mode_of_the_configuration_files(installed: Path, tmp_path: Path) -> None:
    (tmp_path / "yarp.conf").write_text(f"{tmp_path}/names.json 0 json_file\n")
    code = """
import yarpy
with yarpy.Port("/out", tcp_port=0) as out:
    print(yarpy.query("/out").name)
"""
    where = {"YARPY_SERVER": "", "YARP_CONFIG_HOME": str(tmp_path)}
    assert run(code, installed, **where).splitlines() == ["/out"]
    assert (tmp_path / "names.json").exists()


def test_the_command_line_knows_it(installed: Path, tmp_path: Path) -> None:
    environment = {
        **os.environ,
        "PYTHONPATH": str(installed),
        "YARPY_SERVER": f"json_file+{tmp_path}/names.json",
    }
    command = [sys.executable, "-m", "yarpy"]
    where = subprocess.run(
        [*command, "where"], capture_output=True, text=True, timeout=HANG, env=environment
    )
    assert "names in a file" in where.stdout, where.stderr
    listed = subprocess.run(
        [*command, "plugin"], capture_output=True, text=True, timeout=HANG, env=environment
    )
    assert "json_lines" in listed.stdout, listed.stdout


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
        process.communicate("\n", timeout=HANG)
    assert process.returncode == 0
