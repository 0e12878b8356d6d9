"""Wrapyfi's own tests of YARP, unmodified, with compat in place of C++ YARP."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

import pytest
from support.peer import brings
from support.port import free_block
from support.process import Process
from support.wait import HANG
from support.wrapyfi_venv import prepare

import yarpy

ROOT = Path(__file__).parents[2]
TESTS = {
    "wrapyfi.tests.test_wrapper.YarpTestWrapper": 3,
    "wrapyfi.tests.test_middleware.YarpTestMiddleware": 1,
}

IMAGES = """
import os, time, numpy as np
from wrapyfi.connect.wrapper import MiddlewareCommunicator

class Eye(MiddlewareCommunicator):
    @MiddlewareCommunicator.register("Image", "yarp", "Eye", "/eye/image", width=32, height=24,
                                     rgb=True, should_wait=True)
    def look(self):
        picture = np.arange(24 * 32 * 3, dtype=np.uint8).reshape(24, 32, 3)
        return picture,

    @MiddlewareCommunicator.register("NativeObject", "yarp", "Eye", "/eye/sum", should_wait=True)
    def add(self, a, b):
        return {"sum": a + b},

child = os.fork()
eye = Eye()
eye.activate_communication(eye.look, "publish" if child else "listen")
eye.activate_communication(eye.add, "reply" if child else "request")
for _ in range(30 if child else 3):  # who publishes does not wait for those who listen
    got, = eye.look()
    time.sleep(0.05 if child else 0)
expected = np.arange(24 * 32 * 3, dtype=np.uint8).reshape(24, 32, 3)
good = np.array_equal(got, expected)
answer = eye.add(2, 3)
if child:
    print("child", os.waitpid(child, 0)[1], flush=True)
    os._exit(0)
print("image", good, "answer", answer, flush=True)
os._exit(0 if good and answer[0] == {"sum": 5} else 1)
"""

SOUND = """
import os, time, numpy as np
from wrapyfi.connect.wrapper import MiddlewareCommunicator

class Ear(MiddlewareCommunicator):
    @MiddlewareCommunicator.register("AudioChunk", "yarp", "Ear", "/ear/sound", channels=1,
                                     rate=16000, chunk=200, should_wait=True)
    def listen(self):
        return (np.sin(np.arange(200) / 10).astype(np.float32), 16000),

child = os.fork()
ear = Ear()
ear.activate_communication(ear.listen, "publish" if child else "listen")
for _ in range(30 if child else 2):
    got, = ear.listen()
    time.sleep(0.05 if child else 0)
if child:
    print("child", os.waitpid(child, 0)[1], flush=True)
    os._exit(0)
samples, rate = got
error = np.abs(samples.ravel() - np.sin(np.arange(200) / 10)).max()
print("sound", rate, error < 1e-3, flush=True)
os._exit(0)
"""


@pytest.fixture(scope="module")
@brings("wrapyfi")
def wrapyfi() -> Path:
    return prepare()


@pytest.fixture
def server() -> Iterator[yarpy.NameServer]:
    with yarpy.NameServer(free_block(200)) as found:
        yield found


def run(wrapyfi: Path, server: yarpy.NameServer, directory: Path, *arguments: str) -> Process:
    clean = {k: v for k, v in os.environ.items() if not k.startswith(("YARP", "WRAPYFI", "XDG_"))}
    process = Process(
        [wrapyfi / "bin/python", *arguments],
        env={
            **clean,
            **server.environment,
            "PYTHONPATH": f"{ROOT / 'src'}{os.pathsep}{ROOT / 'compat/src'}",
            "WRAPYFI_DEFAULT_COMMUNICATOR": "yarp",
        },
        cwd=directory,
    )
    with process:
        process.wait(2 * HANG)
    # It goes on without a middleware that it cannot import, and tests nothing then.
    assert "fallback" not in (process.stdout + process.stderr).lower(), str(process.lines)
    return process


@pytest.mark.parametrize("name", TESTS)
def test_its_own_tests_pass(
    name: str, wrapyfi: Path, server: yarpy.NameServer, tmp_path: Path
) -> None:
    done = run(wrapyfi, server, tmp_path, "-m", "unittest", "-v", name)
    assert done.returncode == 0, done.stderr
    assert f"Ran {TESTS[name]} test" in done.stderr
    assert "skipped" not in done.stderr
    assert "Initialising YARP middleware" in done.stderr


def test_images_and_questions(wrapyfi: Path, server: yarpy.NameServer, tmp_path: Path) -> None:
    done = run(wrapyfi, server, tmp_path, "-c", IMAGES)
    assert "image True answer [{'sum': 5}]" in done.stdout, done.stdout + done.stderr
    assert "child 0" in done.stdout, done.stderr


def test_sound(wrapyfi: Path, server: yarpy.NameServer, tmp_path: Path) -> None:
    done = run(wrapyfi, server, tmp_path, "-c", SOUND)
    assert "sound 16000 True" in done.stdout, done.stdout + done.stderr
    assert "child 0" in done.stdout, done.stderr
