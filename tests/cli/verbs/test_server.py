"""`yarpy server`."""

import re
import signal
import socket
import sys
import threading
import urllib.request
from pathlib import Path

import pytest
from support.command_line import CommandLine
from support.multicast import needs_multicast
from support.port import free_port
from support.wait import HANG, wait_until

import yarpy
from yarpy.cli.verbs.server import BACKLOG, LONGEST, QUESTIONS, SILENT, CommandPrinter, decide
from yarpy.config.configuration import Configuration, Server
from yarpy.names.default import client_of


@pytest.fixture
def port():
    return free_port()


def conf(command_line: CommandLine) -> Path:
    return Path(command_line.environment["YARP_CONFIG_HOME"], "yarp.conf")


def test_from_nothing(lone, port):
    """The first server on a computer: it says where it is, and other commands find it."""
    with lone.start("server", "--ip", "127.0.0.1", "--socket", str(port)) as process:
        process.wait_line(r"^Ok\. Ready!$", stream="out")
        assert process.stdout.splitlines()[:8] == [
            f"yarpy name server {yarpy.__version__}",
            "Using port database: :memory:",
            "Using subscription database: :memory:",
            "IP address: 127.0.0.1",
            f"Port number: {port}",
            f"Address stored in {conf(lone)}",
            f"Name server can be browsed at http://127.0.0.1:{port}/",
            "Ok. Ready!",
        ]
        assert conf(lone).read_text() == f"127.0.0.1 {port} yarp\n"
        where = re.escape(f"/root active at tcp://127.0.0.1:{port}/, open to all networks")
        process.wait_line(rf"^\[INFO\] Port {where}$", stream="err")
        assert lone.run("where").returncode == 0
        with lone.start("read", "/server/r", "once") as reader:
            assert lone.run("wait", "/server/r").returncode == 0
            process.wait_line(r'^ \* register "/server/r"$', stream="out")
            # It says so behind its name: once it has read something, it may be gone before.
            process.wait_line(r'^   \+ bot set "/server/r" offers ', stream="out")
            assert lone.run("write", "/server/w", "/server/r", input="hello\n").returncode == 0
            assert reader.wait() == 0
        assert reader.stdout == "hello\n"
        process.wait_line(r'^ \* query "/server/r"$', stream="out")
        process.signal(signal.SIGTERM)
        assert process.wait() == 0
    assert process.stdout.endswith("Name server ends.\n")
    assert "Traceback" not in process.stderr


def test_the_stored_address_is_used_again(lone, port):
    assert lone.run("conf", "127.0.0.1", str(port)).returncode == 0
    with lone.start("server") as process:
        process.wait_line("Ready", stream="out")
        assert f"Port number: {port}\n" in process.stdout
        assert "stored" not in process.stdout
        process.signal(signal.SIGINT)
        assert process.wait() == 0


def test_a_busy_port(lone, port):
    with socket.create_server(("", port)):
        said = lone.run("server", "--ip", "127.0.0.1", "--socket", str(port))
    assert said.returncode == 1
    assert re.search(rf"^error: .*cannot listen on TCP port {port}", said.stderr, re.M)
    assert "kill -CONT" in said.stderr and "another number with --socket" in said.stderr
    assert not conf(lone).exists()


@pytest.mark.skipif(sys.platform == "win32", reason="nothing stops a program there")
def test_a_server_that_was_stopped(lone, port):
    words = ("server", "--ip", "127.0.0.1", "--socket", str(port))
    with lone.start(*words) as process:
        process.wait_line("Ready", stream="out")
        process.signal(signal.SIGSTOP)
        said = lone.run(*words)
        process.signal(signal.SIGCONT)
        assert said.returncode == 1
        assert "a name server that was stopped (`fg`, or kill -CONT, lets it go on)" in said.stderr
        assert said.stderr.endswith("give this one another number with --socket\n")
        again = lone.run(*words)
    assert "is running here already" in again.stderr


def test_a_server_that_runs_already(lone, server):
    said = lone.run("server", "--ip", "127.0.0.1", "--socket", str(server.port))
    assert said.returncode == 1
    here = f"is running here already, at 127.0.0.1:{server.port}: "
    assert f"{here}`yarpy conf 127.0.0.1 {server.port}` lets programs use it;" in said.stderr
    assert not conf(lone).exists()
    assert lone.run("conf", "127.0.0.1", str(server.port)).returncode == 0
    said = lone.run("server", "--ip", "127.0.0.1", "--socket", str(server.port))
    assert f"{here}programs use it;" in said.stderr


def test_another_address_is_stored_only_when_asked(lone, port):
    assert lone.run("conf", "127.0.0.1", str(port + 1)).returncode == 0
    said = lone.run("server", "--ip", "127.0.0.1", "--socket", str(port))
    assert said.returncode == 1
    assert f"it says 127.0.0.1 {port + 1}, wanted is 127.0.0.1 {port};" in said.stderr
    words = ("server", "--ip", "127.0.0.1", "--socket", str(port), "--write")
    with lone.start(*words) as process:
        process.wait_line("Ready", stream="out")
    assert conf(lone).read_text() == f"127.0.0.1 {port} yarp\n"


@pytest.mark.parametrize("text", ["hello", "127.0.0.1 nine yarp", "\x01 \x02 \x03"])
def test_an_address_file_that_holds_none(lone, port, text):
    conf(lone).parent.mkdir(parents=True, exist_ok=True)
    conf(lone).write_text(text)
    words = ("server", "--ip", "127.0.0.1", "--socket", str(port))
    said = lone.run(*words, "--read")
    assert said.returncode == 1
    assert f"error: {conf(lone)}: " in said.stderr
    with socket.create_server(("", port)):
        assert f"cannot listen on TCP port {port}" in lone.run(*words).stderr
    assert conf(lone).read_text() == text
    with lone.start(*words) as process:
        process.wait_line(f"warning: {re.escape(str(conf(lone)))}: .* goes there", stream="err")
        process.wait_line("Ready", stream="out")
    assert conf(lone).read_text() == f"127.0.0.1 {port} yarp\n"


def test_an_address_file_that_cannot_be_written(lone, port):
    Path(lone.environment["YARP_CONFIG_HOME"]).write_text(
        "a file where a directory should be", encoding="utf-8"
    )
    with lone.start("server", "--ip", "127.0.0.1", "--socket", str(port)) as process:
        where = re.escape(str(conf(lone).parent))
        process.wait_line(rf"^warning: the address cannot be stored: [^\[]*: {where}", stream="err")
        process.wait_line("Ready", stream="out")


def test_silent(lone, port):
    words = ("server", "--ip", "127.0.0.1", "--socket", str(port), "--silent")
    with lone.start(*words) as process:
        with yarpy.YarpNameClient("127.0.0.1", port) as client:
            wait_until(client.alive)
        process.signal(signal.SIGTERM)
        assert process.wait() == 0
    assert (process.stdout, process.stderr) == ("", "")


def test_files_for_browsers(lone, port, tmp_path):
    (tmp_path / "index.html").write_text("<h1>robots</h1>")
    options = ("--ip", "127.0.0.1", "--socket", str(port), "--web", str(tmp_path))
    with lone.start("server", *options) as process:
        process.wait_line(
            f"^Files of {re.escape(str(tmp_path))} are shown at http://127.0.0.1:{port}/web/$"
        )
        process.wait_line(r"^Ok\. Ready!$")
        with urllib.request.urlopen(f"http://127.0.0.1:{port}/web/", timeout=HANG) as page:
            assert page.read() == b"<h1>robots</h1>"
    done = lone.run("server", "--web", str(tmp_path / "none"))
    assert done.returncode != 0
    assert "does not exist" in done.stderr


def test_databases_survive_it(lone, port, tmp_path):
    files = ("--portdb", str(tmp_path / "ports.db"), "--subdb", str(tmp_path / "rules.db"))
    words = ("server", "--ip", "127.0.0.1", "--socket", str(port), *files)
    cam = "registration name /cam ip 10.0.0.5 port 80 type mjpeg\n"
    with lone.start(*words) as process:
        process.wait_line("Ready", stream="out")
        assert "just delete those files" in process.stdout
        assert lone.run("name", "register", "/cam", "mjpeg", "10.0.0.5", "80").stdout == cam
        assert lone.run("topic", "/t").returncode == 0
        process.signal(signal.SIGTERM)
        assert process.wait() == 0
    with lone.start(*words) as process:
        process.wait_line("Ready", stream="out")
        assert lone.run("name", "query", "/cam").stdout == cam
        assert lone.run("topic", "--list").stdout == 'Topics: "/t"\n'


def test_who_is_cautious_keeps_what_was_acknowledged_when_it_is_killed(lone, port, tmp_path):
    words = ("server", "--ip", "127.0.0.1", "--socket", str(port), "--cautious")
    words = (*words, "--portdb", str(tmp_path / "ports.db"))
    acknowledged = []

    def register(by):
        names = client_of(Server("127.0.0.1", port))
        try:
            for number in range(10_000):
                names.register(f"/{by}/{number}", "tcp", "127.0.0.1", 1000 + number)
                acknowledged.append(f"/{by}/{number}")
        except yarpy.YarpError:
            pass  # it was killed

    for _ in range(3):
        with lone.start(*words) as process:
            process.wait_line("Ready", stream="out")
            before = len(acknowledged)
            threads = [threading.Thread(target=register, args=(by,)) for by in "abc"]
            for thread in threads:
                thread.start()
            wait_until(lambda: len(acknowledged) > before + 30)  # noqa: B023
            process.kill()
            for thread in threads:
                thread.join(HANG)
    with lone.start(*words) as process:
        process.wait_line("Ready", stream="out")
        names = client_of(Server("127.0.0.1", port))
        assert {*acknowledged} <= {contact.name for contact in names.list()}


@pytest.mark.skipif(sys.platform != "linux", reason="files are limited on Linux alone")
def test_an_end_on_a_full_disk_keeps_the_last_good_file(lone, port, tmp_path):
    """The disk is a file that may not grow any more."""
    import resource

    database = tmp_path / "ports.db"
    words = ("server", "--ip", "127.0.0.1", "--socket", str(port), "--portdb", str(database))
    names = client_of(Server("127.0.0.1", port))
    with lone.start(*words) as process:
        process.wait_line("Ready", stream="out")
        names.register("/cam", "tcp", "127.0.0.1", 9)
        wait_until(lambda: b"/cam" in database.read_bytes())
        full = database.stat().st_size
        resource.prlimit(process.pid, resource.RLIMIT_FSIZE, (full, full))
        for number in range(300):
            names.register(f"/later/{number}", "tcp", "127.0.0.1", 1000 + number)
        process.wait_line("database cannot be written")
        assert names.query("/later/299").port == 1299
        process.signal(signal.SIGTERM)
        assert process.wait() == 1
    assert process.stderr.splitlines()[-1].startswith("error: the name server's database")
    with lone.start(*words) as process:
        process.wait_line("Ready", stream="out")
        assert names.query("/cam").port == 9


def test_what_is_no_database(lone, port, tmp_path):
    (tmp_path / "text.db").write_text("this is no database, " * 100)
    words = ("--ip", "127.0.0.1", "--socket", str(port), "--portdb", str(tmp_path / "text.db"))
    said = lone.run("server", *words)
    assert said.returncode == 1
    assert said.stderr.splitlines()[-1].startswith("error: ")
    assert "text.db" in said.stderr
    assert not conf(lone).exists()


def test_is_found_by_multicast(lone, port):
    needs_multicast()
    with lone.start("server", "--ip", "127.0.0.1", "--socket", str(port)) as process:
        process.wait_line("Ready", stream="out")
        conf(lone).unlink()
        said = lone.run("detect")
        assert f"/root is available at ip 127.0.0.1 port {port}" in said.stdout


def test_namespace(lone, port):
    lone.environment["YARP_NAMESPACE"] = "/lab"
    with lone.start("server", "--ip", "127.0.0.1", "--socket", str(port)) as process:
        process.wait_line("Ready", stream="out")
        assert conf(lone).with_name("_lab.conf").read_text() == f"127.0.0.1 {port} yarp\n"
        said = lone.run("name", "query", "/lab")
        assert said.stdout == f"registration name /lab ip 127.0.0.1 port {port} type tcp\n"


# --- the decision alone

CONFIGURED = str(Path("/c/yarp.conf"))
HERE, AWAY = "127.0.0.1", "203.0.113.9"  # an address for documentation: nobody's


def stored(host=None, port=10000, path=CONFIGURED, mode="yarp"):
    servers = () if host is None else (Server(host, port, mode, path=path and Path(path)),)
    return Configuration(servers, () if servers else ("/root",), Path("/c"))


@pytest.mark.parametrize(
    ("found", "options", "expected"),
    [
        # nothing is stored: the options, else 10000 or YARP_PORT_RANGE
        (stored(), {"ip": HERE}, (HERE, 10000, True)),
        (stored(), {"ip": HERE, "socket": 5}, (HERE, 5, True)),
        (stored(), {"ip": HERE, "environment": {"YARP_PORT_RANGE": "12345"}}, (HERE, 12345, True)),
        # what is stored is where programs look
        (stored(HERE), {}, (HERE, 10000, False)),
        (stored(HERE, 21100), {}, (HERE, 21100, False)),
        (stored(HERE, 21100), {"ip": HERE}, (HERE, 21100, False)),
        (stored(HERE, 21100), {"environment": {"YARP_PORT_RANGE": "5"}}, (HERE, 21100, False)),
        (stored(AWAY), {"read": True}, (AWAY, 10000, False)),
        # another one only when it is meant
        (stored(HERE), {"socket": 5, "write": True}, (HERE, 5, True)),
        (stored(HERE), {"ip": AWAY, "write": True}, (AWAY, 10000, True)),
        (stored(AWAY), {"ip": HERE, "write": True}, (HERE, 10000, True)),
        # YARPY_SERVER: nothing is stored
        (stored(HERE, 7, None), {}, (HERE, 7, False)),
        (stored(HERE, 7, None), {"socket": 8}, (HERE, 8, False)),
    ],
)
def test_where_to_listen(found, options, expected):
    place = decide(found, **{"environment": {}, **options})
    assert (place.server.host, place.server.port, place.store) == expected


@pytest.mark.parametrize(
    ("found", "options", "complaint"),
    [
        (stored(HERE), {"socket": 5}, "it says 127.0.0.1 10000, wanted is 127.0.0.1 5"),
        (stored(HERE), {"ip": AWAY}, "--write to overwrite"),
        (stored(AWAY), {}, f"it says {AWAY} 10000, wanted is "),
        (stored(), {"read": True}, f"Could not read configuration file {CONFIGURED}"),
    ],
)
def test_a_dispute_is_an_error(found, options, complaint):
    with pytest.raises(yarpy.AddressError) as error:
        decide(found, environment={}, **options)
    assert complaint in str(error.value)


def test_notes():
    assert "no address of this computer" in decide(stored(), ip=AWAY, environment={}).note
    assert "YARPY_SERVER says 127.0.0.1:7" in decide(stored(HERE, 7, None), socket=8).note
    assert decide(stored(HERE), environment={}).note == ""


def test_an_own_address_is_chosen():
    place = decide(stored(), environment={})
    assert re.fullmatch(r"\d+\.\d+\.\d+\.\d+", place.server.host)


def test_commands_are_marked(capsys):
    scribe = CommandPrinter()
    for text in (
        'register "/a"',
        'bot set "/a" ips "::1"',
        'set "/b" x y',
        'register "..."',
        'set "/tmp/port/1" process 3',
        "list",
        "",
    ):
        scribe.command(text, "127.0.0.1")
    scribe.close()
    assert capsys.readouterr().out.splitlines() == [
        ' * register "/a"',
        '   + bot set "/a" ips "::1"',
        ' * set "/b" x y',
        ' * register "..."',
        '   + set "/tmp/port/1" process 3',
        " * list",
        " * ",
    ]


def said(capsys, *commands: str) -> list[str]:
    scribe = CommandPrinter()
    for text in commands:
        scribe.command(text, "127.0.0.1")
    scribe.close()
    return [line.removeprefix(" * ") for line in capsys.readouterr().out.splitlines()]


def test_what_a_terminal_would_obey_is_escaped(capsys):
    """Also where the output is a file, which somebody reads in a terminal."""
    assert said(capsys, 'query "/a\x1b[2J\nb"') == [r'query "/a\x1b[2J\nb"']


DIAL = ('query "/dead"', 'get "/dead" ips', 'announce "/dead" 0')


def test_dialling_a_dead_port_again_and_again_is_printed_once(capsys):
    assert said(capsys, *DIAL * 50, 'query "/other"') == [*DIAL, *DIAL[:2], 'query "/other"']


@pytest.mark.parametrize("back", ['register "/dead"', 'announce "/dead"', 'announce "/dead" 1'])
def test_a_port_that_is_back_is_printed_as_ever(back, capsys):
    lines = (*DIAL, back, *DIAL, back, *DIAL[:2] * 2)
    assert said(capsys, *lines) == [*lines]


def test_what_is_remembered_of_dead_ports_is_bounded(capsys):
    names = [f'announce "/{number}" 0' for number in range(SILENT + 1)]
    assert said(capsys, *names, names[0], names[0]) == [*names, names[0]]
    questions = [f'get "/x" {number}' for number in range(QUESTIONS + 10)]
    repeated = said(capsys, 'announce "/x" 0', *questions * 2)
    assert repeated[1:] == [*questions, *questions[QUESTIONS - 1 :]], "the announcement is one too"
    long = f'announce "/{"x" * LONGEST}" 0'
    assert said(capsys, long, long) == [long, long]


def test_no_client_waits_for_a_slow_terminal(monkeypatch):
    stuck, free, printed = threading.Event(), threading.Event(), []

    def slow(text):
        stuck.set()
        free.wait(HANG)
        printed.extend(text.splitlines())

    monkeypatch.setattr("yarpy.cli.verbs.server.print_line", slow)
    scribe = CommandPrinter()
    scribe.command("list", "")
    assert stuck.wait(HANG)
    for number in range(BACKLOG + 100):
        scribe.command(f"query {number}", "")
    free.set()
    scribe.close()
    assert len(printed) == 1 + BACKLOG + 1
    assert printed[-2:] == [f" * query {BACKLOG - 1}", "(100 commands not shown)"]


def test_nobody_else_reaches_a_local_one(lone, port):
    with lone.start("server", "--local", "--socket", str(port)) as process:
        process.wait_line("Ready", stream="out")
        assert "IP address: 127.0.0.1" in process.stdout
        process.wait_line("open to this computer alone", stream="err")
        with pytest.raises(OSError, match="refused"):
            socket.create_connection(("127.0.0.2", port), 2.0)
        socket.create_connection(("127.0.0.1", port), 2.0).close()
