"""The MPI libraries of this computer, and how a program is started with each.

with mpi_library("mpich") as start:      # or "openmpi", which is a peer
    Process([*start.command, sys.executable, ...], env=start.environment)
"""

import contextlib
import importlib.metadata
import os
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest
from support.peer import program
from support.process import Process
from support.wait import wait_until


@dataclass(frozen=True)
class Start:
    """`command` goes in front of a program, which gets `environment`."""

    command: list[str]
    environment: dict[str, str]


@contextlib.contextmanager
def mpi_library(name: str) -> Iterator[Start]:
    """MPICH or Open MPI, ready for programs that do not know of each other."""
    pytest.importorskip("mpi4py", reason="mpi4py is not installed")
    clean = {
        key: value
        for key, value in os.environ.items()
        if not key.startswith(("OMPI_", "PMIX_", "PMI_", "MPI4PY_"))
    } | {"YARPY_MPI": "yes"}
    if name == "mpich":
        yield Start([str(_of_mpich("mpiexec")), "-n", "1"], clean | _mpich_variables(clean))
        return
    with tempfile.TemporaryDirectory(prefix="yarpy-mpi-") as folder:
        where = Path(folder) / "where"
        with Process(
            [program("ompi-server", of="openmpi"), "--no-daemonize", "-r", str(where)], env=clean
        ):
            wait_until(lambda: where.exists() and where.read_text(), what="ompi-server is there")
            yield Start(
                [],
                clean | {"MPI4PY_MPIABI": "openmpi", "OMPI_MCA_pmix_server_uri": f"file:{where}"},
            )


def _of_mpich(name: str) -> Path:
    try:
        files = importlib.metadata.files("mpich") or []
    except importlib.metadata.PackageNotFoundError:
        files = []
    for file in files:
        if file.name == name:
            return Path(str(file.locate())).resolve()
    pytest.skip("MPICH is not installed: pip install mpich")


def _mpich_variables(clean: dict[str, str]) -> dict[str, str]:
    folder = str(_of_mpich("libmpi.so.12").parent)
    return {"LD_LIBRARY_PATH": ":".join(filter(None, (folder, clean.get("LD_LIBRARY_PATH"))))}
