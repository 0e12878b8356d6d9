"""`yarpy env`."""


def test_whole_environment(cli):
    said = cli.run("env")
    assert said.returncode == 0
    lines = said.stdout.splitlines()
    assert f"YARP_DATA_HOME={cli.environment['YARP_DATA_HOME']}" in lines
    assert lines == sorted(lines, key=lambda line: line.partition("=")[0])


def test_one_variable(here, monkeypatch):
    monkeypatch.setenv("YARP_ROBOT_NAME", "icub=1")
    assert here("env", "YARP_ROBOT_NAME") == (0, "YARP_ROBOT_NAME=icub=1\n", "")


def test_missing_variable(here):
    said = here("env", "YARP_NO_SUCH")
    assert said == (1, "", "error: Could not find environment variable 'YARP_NO_SUCH'\n")
