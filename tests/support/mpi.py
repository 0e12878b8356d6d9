"""The MPI libraries of this computer, and how a program is started with each.

for name in LIBRARIES:
    with mpi_library(name) as start:         # pytest skips with the reason where it is missing
        Process([*start.command, sys.executable, ...], env=start.environment)
"""

import contextlib
import importlib.metadata
import os
import shutil
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest
from support.process import Process
from support.wait import wait_until

LIBRARIES = ("mpich", "openmpi")


@dataclass(frozen=True)
class Start:
    """`command` goes in front of a program, which gets `environment`."""

    command: list[str]
    environment: dict[str, str]


@contextlib.contextmanager
def mpi_library(name: str) -> Iterator[Start]:
    """One of LIBRARIES, ready for programs that do not know of each other."""
    pytest.importorskip("mpi4py", reason="mpi4py is not installed")
    clean = {
        key: value
        for key, value in os.environ.items()
        if not key.startswith(("OMPI_", "PMIX_", "PMI_", "MPI4PY_"))
    }
    if name == "mpich":
        yield Start([str(_of_mpich("mpiexec")), "-n", "1"], clean | _mpich_variables(clean))
        return
    server = shutil.which("ompi-server")
    if server is None:
        pytest.skip("Open MPI is not installed: apt-get install openmpi-bin")
    with tempfile.TemporaryDirectory(prefix="yarpy-mpi-") as folder:
        where = Path(folder) / "where"
        with Process([server, "--no-daemonize", "-r", str(where)], env=clean):
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
