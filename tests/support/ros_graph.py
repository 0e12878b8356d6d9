"""A ROS 1 of our own: a master on a free port, rospy programs, the command line tools.

Rules: everything on the loopback, with a home of its own; a test that uses it declares the peers
`ros` and `rosmaster`. What is started here ends with `close`.
"""

import os
import subprocess
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

import pytest
from support.peer import brings, demand
from support.port import free_port
from support.process import Process
from support.ros import PYTHON
from support.wait import HANG, wait_until

from yarpy.peers.ros.master import RosMaster


class RosGraph:
    """A master and what runs around it."""

    def __init__(self, home: Path) -> None:
        demand("ros", "rosmaster")
        self.home = home
        self.port = free_port()
        self.uri = f"http://127.0.0.1:{self.port}/"
        self.master = RosMaster(self.uri)
        self.environment: Mapping[str, str] = {
            "PATH": "/usr/bin:/bin",
            "HOME": str(home),
            "ROS_MASTER_URI": self.uri,
            "ROS_IP": "127.0.0.1",
            "ROS_LOG_DIR": str(home / "log"),
            "PYTHONUNBUFFERED": "1",
            "ROS_PACKAGE_PATH": "/usr/share",
        }
        self.core: Process
        self._running: list[Process] = []
        self.start()

    def start(self) -> None:
        """Start the master, again on the same port."""
        self.core = self.run("rosmaster", "--core", "-p", str(self.port))
        wait_until(self.master.answers, HANG, "the ROS master answers")

    def run(self, *words: str) -> Process:
        """Start a tool of ROS."""
        process = Process([PYTHON, f"/usr/bin/{words[0]}", *words[1:]], env=self.environment)
        self._running.append(process)
        return process

    def tool(self, *words: str, timeout: float = 30.0) -> str:
        """What a tool of ROS prints until it ends."""
        done = subprocess.run(
            [PYTHON, f"/usr/bin/{words[0]}", *words[1:]],
            env=dict(self.environment),
            capture_output=True,
            text=True,
            timeout=HANG,
        )
        return done.stdout + done.stderr

    def python(self, program: str, *arguments: str) -> Process:
        """Start a program of ROS's Python."""
        process = Process([PYTHON, "-c", program, *arguments], env=self.environment)
        self._running.append(process)
        return process

    def needs_packages(self, site: Path) -> None:
        """Skip the test if ROS's Python cannot load the packages in a folder."""
        environment = {**self.environment, "PYTHONPATH": str(site)}
        done = subprocess.run([PYTHON, "-c", "import cv2, numpy, yaml"], env=environment)
        if done.returncode:
            pytest.skip(f"the Python of ROS 1 cannot load what is in {site}")

    def yarpy(self, *words: str, **variables: str) -> Process:
        """Start a command of ours, without a YARP name server unless `variables` name one."""
        environment = {
            **{key: os.environ[key] for key in ("PATH", "PYTHONPATH") if key in os.environ},
            **{key: self.environment[key] for key in ("HOME", "ROS_MASTER_URI", "ROS_IP")},
            "YARP_CONFIG_HOME": str(self.home),
            "PYTHONUNBUFFERED": "1",
            **variables,
        }
        process = Process([sys.executable, "-m", "yarpy", *words], env=environment)
        self._running.append(process)
        return process

    def close(self) -> None:
        """End everything."""
        for process in reversed(self._running):
            process.stop()


@contextmanager
def ros_graph(home: Path) -> Iterator[RosGraph]:
    """A graph for as long as a test takes."""
    graph = RosGraph(home)
    try:
        yield graph
    finally:
        graph.close()


@pytest.fixture(scope="module")
@brings("ros", "rosmaster")
def graph_apart(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RosGraph]:
    """A graph for the tests of one file, of which the environment knows nothing; nor of a YARP
    server."""
    with (
        ros_graph(tmp_path_factory.mktemp("ros")) as found,
        pytest.MonkeyPatch.context() as patch,
    ):
        for name in ("YARPY_SERVER", "ROS_MASTER_URI"):
            patch.delenv(name, raising=False)
        patch.setenv("YARP_CONFIG_HOME", str(found.home))
        patch.setenv("ROS_IP", "127.0.0.1")
        yield found


@pytest.fixture(scope="module")
def graph(graph_apart: RosGraph) -> Iterator[RosGraph]:
    """The same; this process finds it by ROS_MASTER_URI."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("ROS_MASTER_URI", graph_apart.uri)
        yield graph_apart
