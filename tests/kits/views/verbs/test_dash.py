"""`yarpy dash`."""

import json
import signal
import urllib.request

from support.wait import HANG, wait_until

import yarpy


def test_the_network_is_shown_to_this_computer_alone(cli, names):
    with (
        yarpy.Port("/ds/out", names=names) as out,
        yarpy.BufferedPort("/ds/in", names=names),
        cli.start("dash", "--name", "/ds/page") as process,
    ):
        out.connect("/ds/in")
        line = r"^/ds/page is shown at (http://127\.0\.0\.1:\d+/)$"
        shown = process.wait_line(line, timeout=HANG)[1]

        def links():
            with urllib.request.urlopen(f"{shown}network", timeout=HANG) as answer:
                return json.load(answer).get("links", [])

        wait_until(lambda: ["/ds/out", "/ds/in", "tcp"] in links())
        process.signal(signal.SIGINT)
        assert process.wait(HANG) == 130
        assert "Traceback" not in process.stderr


def test_no_name_server(lone):
    said = lone.run("dash")
    assert said.returncode == 1
    assert said.stderr.startswith("error: ")
