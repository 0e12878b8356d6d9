"""The examples in Wrapyfi's own package, as they are, with only the package exchanged.

Rules: the files are those that pip has installed; `programs/examples.py` runs them, with stand-ins
for camera, microphone, loudspeaker and keyboard. What they print says that they did what they do.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from support.peer import brings
from support.port import free_block
from support.process import Process
from support.ros import PYTHON
from support.ros_graph import ros_graph
from support.wait import HANG
from support.wrapyfi_venv import prepare

pytest.importorskip("zmq")
pytest.importorskip("cv2")
ROOT = Path(__file__).parents[2]
RUN = Path(__file__).parent / "programs" / "examples.py"
SENT = "This argument message was sent"
PRINTED = {
    "hello listen": "Method result: .'message': 'word', .* running in publish mode'",
    "hello request": "Method result: .'message': 'word', .* running in request mode'",
    "hello reply": "Method result: .'message': 'word', .* running in request mode'",
    "mirror listen": f".'msg': '{SENT} by the publish script', 'msg_ip': 'word'",
    "mirror request": f".'msg': '{SENT} by the request script', 'msg_ip': 'word'",
    "chain last": f"{SENT} from read_chain_A transmitted over zeromq. It was .* over yarp",
    "channel listen": "zeromq_native::",
    "ask request": r"Request: received reply: .*'counter': [1-9]",
    "ask reply": r"shown \(240, 320, 3\) 100",
    "effects transceive": r"shown \(24, 32, 3\) 5[3-7]",
    "camera listen": r"shown \(24, 32, 3\) (19|20)\d",
    "sound listen": r"played \(80,\) 44100",
}
ROS_PRINTED = {
    "message listen": r'Method result: data: "word" position',
    "property listen": r"Method result: word .*'d': 12.3",
}


@pytest.fixture(scope="module")
@brings("wrapyfi")
def site() -> Path:
    """Where pip has put the examples."""
    return next(prepare().glob("lib/python*/site-packages"))


@pytest.fixture(scope="module")
def examples(site: Path) -> Iterator[Process]:
    prefixes = ("YARP", "WRAPYFI", "PYTHON")
    clean = {name: value for name, value in os.environ.items() if not name.startswith(prefixes)}
    number = free_block(2)
    environment = {
        **clean,
        "PYTHONPATH": str(ROOT / "compat" / "wrapyfi" / "src"),
        "WRAPYFI_ZEROMQ_SOCKET_IP": f"127.{1 + os.getpid() % 250}.{os.getpid() // 250 % 250}.1",
        "WRAPYFI_ZEROMQ_SOCKET_PUB_PORT": str(number),
        "WRAPYFI_ZEROMQ_SOCKET_SUB_PORT": str(number + 1),
    }
    with Process([sys.executable, RUN, site / "examples"], env=environment) as process:
        yield process


@pytest.mark.parametrize("role", PRINTED)
def test_example(role: str, examples: Process) -> None:
    line = f"^{role}: {PRINTED[role]}"
    assert examples.wait_line(line, timeout=HANG, stream="out")


@pytest.fixture(scope="module")
@brings("ros", "rosmaster")
def ros_examples(site: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Process]:
    """With the messages of rospy, in its Python."""
    with ros_graph(tmp_path_factory.mktemp("ros")) as graph:
        graph.needs_packages(site)
        ours = os.pathsep.join(map(str, (ROOT / "compat/wrapyfi/src", ROOT / "src", site)))
        environment = {**graph.environment, "PYTHONPATH": ours}
        with Process([PYTHON, RUN, site / "examples", "ros"], env=environment) as process:
            yield process


@pytest.mark.parametrize("role", ROS_PRINTED)
def test_example_of_ros(role: str, ros_examples: Process) -> None:
    line = f"^{role}: {ROS_PRINTED[role]}"
    assert ros_examples.wait_line(line, timeout=HANG, stream="out")
