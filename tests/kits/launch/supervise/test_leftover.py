"""The end of what a killed supervisor has left."""

import subprocess

from yarpy.kits.launch.supervise.leftover import end_all, told


def test_told() -> None:
    assert told({8: "b", 7: "a"}) == "a (pid 7), b (pid 8)"


def test_both_the_willing_and_the_deaf_end() -> None:
    deaf = ["sh", "-c", "trap '' TERM; echo ready; while :; do sleep 0.05; done"]
    children = [
        subprocess.Popen(["sleep", "600"]),
        subprocess.Popen(deaf, stdout=subprocess.PIPE),
    ]
    out = children[1].stdout
    assert out is not None and out.readline() == b"ready\n"
    try:
        assert end_all({child.pid: "x" for child in children}, 0.2) == []
        assert [child.wait() for child in children] == [-15, -9]
    finally:
        out.close()
        for child in children:
            child.kill()
            child.wait()


def test_who_is_gone_is_no_trouble() -> None:
    child = subprocess.Popen(["true"])
    child.wait()
    assert end_all({child.pid: "x"}, 5.0) == []
