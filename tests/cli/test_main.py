"""The frame of the command: verbs are found, errors are one line, exit codes are as promised."""

import os
import shlex
import subprocess
import sys
from pathlib import Path

import click
import pytest
from support.wait import HANG

from yarpy import registry
from yarpy.cli import main as frame
from yarpy.cli.verb_list import GROUPS, VERBS

SOURCE = Path(frame.__file__).parents[1]


def test_every_verb_has_a_module_and_every_module_is_a_verb():
    """In `cli/verbs`, or in the room of a peer or kit, where those of `yarpy idl` and what `check`
    asks are, too."""
    found = [path.stem for path in SOURCE.rglob("verbs/*.py") if path.stem != "__init__"]
    others = [*registry.idl_commands.names(), *registry.checks.names()]
    others += registry.applications.names()
    assert sorted(found) == sorted([*VERBS, *others])


@pytest.mark.parametrize("verb", VERBS)
def test_every_verb_explains_itself(verb, here):
    assert isinstance(frame.find_verb(verb), click.Command)
    said = here(verb, "--help")
    assert said.code == 0
    assert said.out.startswith(f"Usage: yarpy {verb} ")
    assert here("help", verb).out == said.out


@pytest.mark.skipif(not hasattr(os, "fork"), reason="this system has no fork")
@pytest.mark.parametrize("part", range(4))
def test_every_verb_loads_alone(part):
    """Nothing else of yarpy has been imported before, as when a person starts it."""
    program = (
        "import os, sys\n"
        "import click, numpy\n"  # which take most of the time, and know nothing of yarpy
        "import yarpy.cli.main as main\n"
        "for verb in sys.argv[1:]:\n"
        "    child = os.fork()\n"
        "    if not child:\n"
        "        assert main.find_verb(verb) is not None\n"
        "        os._exit(0)\n"
        "    if os.waitpid(child, 0)[1]:\n"
        "        print(verb)\n"
    )
    words = [sys.executable, "-c", program, *[*VERBS][part::4]]
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}  # a fork has no other threads
    said = subprocess.run(words, capture_output=True, text=True, timeout=100, env=environment)
    assert (said.returncode, said.stdout) == (0, ""), said.stderr


def test_every_verb_is_in_the_documentation():
    page = (Path(__file__).parents[2] / "docs" / "cli.md").read_text()
    headings = " ".join(line for line in page.splitlines() if line.startswith("### "))
    assert [verb for verb in VERBS if f"`{verb}" not in headings] == []


def test_alone_it_lists_the_verbs(cli):
    said = cli.run()
    assert said.returncode == 0
    for name, verb in VERBS.items():
        assert f"  {name} " in said.stdout and verb.about in said.stdout


def test_groups_are_those_of_the_documentation():
    page = (Path(__file__).parents[2] / "docs" / "cli.md").read_text()
    sections = {part.partition("\n")[0]: part for part in page.split("\n## ")}
    for title, verbs in GROUPS.items():
        missing = [verb for verb in verbs if f"`{verb}" not in sections[title]]
        assert missing == [], title


@pytest.mark.parametrize("verb", VERBS)
def test_example_is_what_the_verb_takes(verb):
    """The words of each example are parsed, and nothing is run."""
    words = shlex.split(VERBS[verb].example.partition(" >> ")[0])
    assert words[0] == verb
    command = frame.find_verb(verb)
    assert command is not None
    with frame.root.make_context("yarpy", [verb], resilient_parsing=True) as top:
        command.make_context(verb, words[1:], parent=top)


def test_defaults_and_an_example_are_shown(here):
    said = here("help", "split").out
    assert "[default: udp]" in said
    assert "Example: yarpy split /state" in said


def test_version_flag(here):
    assert here("--version").out == here("version").out


def test_unknown_verb(cli):
    said = cli.run("raed", "/x")
    assert (said.returncode, said.stdout) == (255, "")
    assert said.stderr == 'error: no command "raed": did you mean "read"? `yarpy help` lists them\n'


@pytest.mark.parametrize(
    ("line", "known", "example"),
    [
        ("idl camera.thrift", "rosmsg, sniff and thrift", "yarpy idl thrift camera.thrift"),
        ("qos /a /b", "describe, get, set and time", "yarpy qos get /talker /listener"),
        ("sched /a", "describe, get and set", "yarpy sched set /talker /listener"),
        ("admin /a", "rpc and write", "yarpy admin rpc /listener"),
        ("qos gte /a /b", 'did you mean "get"? there are', "yarpy qos get"),
    ],
)
def test_verbs_with_commands_of_their_own_name_them(cli, line, known, example):
    said = cli.run(*line.split())
    assert said.returncode == 1
    word = line.split()[1]
    assert said.stderr.startswith(f'error: no command "{word}" of yarpy {line.split()[0]}: ')
    assert known in said.stderr and f"Example: {example}" in said.stderr


def test_wrong_use_is_told_with_the_right_one(here):
    said = here("exists")
    assert (said.code, said.out) == (1, "")
    assert said.err == (
        "error: Missing argument 'PORT'.\nUsage: yarpy exists [OPTIONS] PORT [TARGET]\n"
    )


@pytest.mark.parametrize("verb", ["idl", "qos", "sched"])
def test_a_verb_of_verbs_lists_them_where_none_is_said(here, verb):
    code, out, err = here(verb)
    assert (code, out) == (1, "")
    assert err.startswith(f"Usage: yarpy {verb} ")
    assert "\nCommands:\n" in err.replace("\r", "")


def test_an_error_is_one_line(lone):
    said = lone.run("ping", "/nobody")
    assert (said.returncode, said.stdout) == (1, "")
    assert said.stderr.startswith("error: no name server is configured for /root: start one with")
    assert "LocalNames" not in said.stderr, "that is for programs"
    assert said.stderr.count("\n") == 1


def test_an_error_of_the_system_is_one_line(here, monkeypatch, tmp_path):
    (tmp_path / "config").write_text("a file where a directory should be")
    said = here("conf", "127.0.0.1", "10000")
    assert said.code == 1
    assert said.err.count("\n") == 1 and said.err.startswith("error: ")


def test_verbs_of_other_packages(here, monkeypatch):
    @click.command()
    def wave() -> int:
        """Wave."""
        click.echo("hello")
        return 3

    foreign = registry.Registry("commands", {})
    foreign.add("wave", wave)
    foreign.add("odd", print)
    monkeypatch.setattr(registry, "commands", foreign)
    assert here("wave")[:2] == (3, "hello\n")
    assert "wave" in here("help").out
    said = here("odd")
    assert said.code == 1 and "is not a click command" in said.err


@pytest.mark.skipif(sys.platform == "win32", reason="names there are characters of 16 bits")
def test_bytes_go_through_as_they_are(cli):
    """Whatever the locale is: names and data are bytes to a shell."""
    done = subprocess.run(
        [sys.executable, "-m", "yarpy", "env", "ODD"],
        env={**cli.environment, "LC_ALL": "C", "PYTHONUTF8": "0"} | {"ODD": "caf\udce9 é"},
        capture_output=True,
        timeout=20,
    )
    assert done.stdout.replace(b"\r\n", b"\n") == b"ODD=caf\xe9 \xc3\xa9\n"


def test_a_reader_that_goes_away_is_no_traceback(cli):
    with subprocess.Popen(
        [sys.executable, "-m", "yarpy", "time"],
        env=cli.environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    ) as process:
        assert process.stdout is not None and process.stderr is not None
        process.stdout.readline()
        process.stdout.close()
        assert process.wait() == 1
        assert process.stderr.read() == b""


def test_installed_command():
    """The entry point of the package; a bare source tree has none."""
    script = Path(sys.executable).parent / "yarpy"
    if not script.exists():
        pytest.skip("yarpy is not installed beside this interpreter")
    done = subprocess.run([script, "version"], capture_output=True, text=True, timeout=HANG)
    assert (done.returncode, done.stdout.split()[:2]) == (0, ["yarpy", "version"])


@pytest.mark.parametrize("verb", ["exists", "ping", "where", "name", "version"])
def test_small_verbs_load_nothing_heavy(verb):
    heavy = ("numpy", "rich", "sqlite3", "asyncio", "email", "http", "xml", "importlib.metadata")
    code = (
        f"import sys; from yarpy.cli.main import find_verb; find_verb({verb!r});"
        f"print(sorted(set({heavy!r}) & sys.modules.keys()))"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, timeout=HANG
    )
    assert done.stdout.strip() == "[]", done.stderr


@pytest.mark.skipif(sys.platform == "win32", reason="there is no sh, which closes them")
@pytest.mark.parametrize(
    "shell",
    ["yarpy name list >&-", "yarpy name list 2>&-", "yarpy write /closed/in <&-"],
)
def test_standard_streams_that_are_closed(shell, cli):
    """As services have them: nobody reads, nobody types."""
    program = "import sys; sys.argv[0] = 'yarpy'; from yarpy.cli.main import main; main()"
    command = shell.replace("yarpy", f'{sys.executable} -c "{program}"', 1)
    done = subprocess.run(
        ["sh", "-c", command], env=cli.environment, capture_output=True, text=True, timeout=HANG
    )
    assert (done.returncode, "Traceback" in done.stderr) == (0, False), done.stderr


def test_a_wrong_number_is_told_in_plain_words(here):
    for number, words in (("abc", "is no whole number."), ("99999", "is not from 1 to 65535.")):
        said = here("conf", "127.0.0.1", number)
        assert said.code == 1
        assert words in said.err.splitlines()[0]
    assert "'x' is no number." in here("wait", "/a", "--timeout", "x").err
