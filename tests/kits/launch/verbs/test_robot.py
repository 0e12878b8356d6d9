"""`yarpy robot`: the simulated robot from its file, and files with errors."""

import signal
from pathlib import Path

import yarpy

ROBOT = Path(__file__).parents[4] / "examples/simulated_robot.xml"


def test_the_simulated_robot_runs_until_it_is_asked_to_end(
    cli, server: yarpy.NameServer, names
) -> None:
    cli.environment["YARPY_LINGER"] = "20"  # a busy machine takes longer to take names off
    with cli.start("robot", str(ROBOT), "--width", "32", "--height", "24", "--odd", "1") as robot:
        robot.wait_line("icubSim runs: 8 of 8 devices")
        robot.wait_line('no parameter has extern-name="odd"', stream="err")
        with yarpy.RpcClient("/icubSim/head/rpc:i", names=names) as client:
            assert client.call(["get", "axes"])[2] == 6
        with yarpy.RpcClient("/icubSim/yarprobotinterface", names=names) as client:
            assert client.call(["get_phase"]) == "run"
            assert client.call(["quit"]) == "bye"
        assert robot.wait() == 0
    assert names.query("/icubSim/head/state:o") is None


def test_a_signal_ends_it(cli, names) -> None:
    cli.environment["YARPY_LINGER"] = "20"
    with cli.start("robot", str(ROBOT), "--width", "32", "--height", "24") as robot:
        robot.wait_line("icubSim runs")
        robot.signal(signal.SIGINT)
        assert robot.wait() == 0
    assert names.query("/icubSim/yarprobotinterface") is None


def test_files_are_looked_at_first(cli) -> None:
    path = cli.home / "bad.xml"
    path.write_text(
        '<robot name="r">\n<device name="a" type="simulatedHed">\n'
        '<action phase="startup" level="1" type="attach"><param name="device">b</param></action>\n'
        "</device></robot>\n"
    )
    done = cli.run("robot", "bad.xml", "--check")
    assert done.returncode == 1
    lines = done.stdout.splitlines()
    assert lines[1] == 'bad.xml:3:1: warning: attach: no device here is called "b"'
    assert lines[2].startswith('bad.xml:2:1: error: no device of type "simulatedHed" is installed')
    assert lines[3] == "r: 1 device, 3 problems"
    done = cli.run("robot", "bad.xml")
    assert done.returncode == 1 and "bad.xml:2:1: no device of type" in done.stderr
    path.write_text(path.read_text().replace("simulatedHed", "simulatedInertial"))
    done = cli.run("robot", "bad.xml")
    assert done.returncode == 1 and "bad.xml:3:1: attach: no device here" in done.stderr
    assert "active at" not in done.stderr + done.stdout, "nothing was opened"
    assert cli.run("robot", "none.xml").returncode == 1


def test_the_merged_view(cli) -> None:
    done = cli.run("robot", str(ROBOT), "--show", "--portprefix", "/z")
    assert done.returncode == 0
    assert done.stdout.startswith("robot icubSim, ports /z\ndevice head (simulatedHead)")
    assert '  name "/z/head"' in done.stdout
