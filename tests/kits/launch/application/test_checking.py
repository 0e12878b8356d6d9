"""What only this computer and the network can tell of an application."""

import sys
from pathlib import Path

import yarpy
from yarpy.kits.launch.application.application import Application, Connection, Module
from yarpy.kits.launch.application.checking import checked
from yarpy.kits.launch.document.problem import Where

HERE = Where("a", 1, 1)
PYTHON = sys.executable


def said(names, *modules: Module, connections: tuple[Connection, ...] = ()) -> list[str]:
    found = Application("x", modules=[*modules], connections=[*connections], files=["a"])
    return [str(one).partition(": ")[2] for one in checked(found, names)]


def test_programs_and_folders(network: yarpy.LocalNames, tmp_path) -> None:
    assert said(network, Module("a", PYTHON), Module("b", PYTHON, workdir=str(tmp_path))) == []
    assert said(network, Module("a", "slep"), Module("b", PYTHON, workdir="/no/such")) == [
        'error: "a": there is no program "slep" on the PATH',
        f'error: the folder "{Path("/no/such")}" is not there',
    ]


def test_hosts_and_ports(network: yarpy.LocalNames) -> None:
    far = [Module(one, "x", node=f"/{one}", prefix="/p") for one in ("here", "gone", "heer")]
    links = (
        Connection("/there", "/gone", source_external=True, target_external=True),
        Connection("/p/out", "/p/in"),
    )
    with (
        yarpy.Port("/here", names=network),
        yarpy.Port("/there", names=network),
        yarpy.Port("/p/out", names=network),
    ):
        assert said(network, *far, connections=links) == [
            'warning: nothing called "/gone" runs, which would start "gone"',
            'warning: nothing called "/heer" runs, which would start "heer": did you mean "/here"?',
            'warning: the external port "/gone" is not there',
            'warning: "/p/out" is taken: it is registered already',
        ]
