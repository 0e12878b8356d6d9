"""`yarpy completion`: the scripts, in the shells that read them."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest
from support.wait import HANG

import yarpy
from yarpy.cli.verbs.completion import SCRIPTS

TRIALS = {
    "bash": r"""
eval "$(yarpy completion bash)"
compopt() { :; }
COMP_LINE=$1 COMP_POINT=${#1} COMP_WORDBREAKS=$' \t\n"><=;|&(:'
_yarpy_complete
printf '%s\n' "${COMPREPLY[@]}"
""",
    "zsh": r"""
compdef() { :; }
compadd() { print -rl -- $values; }
eval "$(yarpy completion zsh)"
LBUFFER=$1
_yarpy_complete
""",
    "fish": r"""
yarpy completion fish | source
complete -C "$argv[1]" | cut -f 1
""",
}

YARPY = f"""#!{sys.executable}
from yarpy.cli import completion, start

completion.TIMEOUT = {HANG}  # a busy machine takes more than what a person waits
start.main()
"""


@pytest.fixture(
    params=["bash", *(pytest.param(name, marks=pytest.mark.peer(name)) for name in ("zsh", "fish"))]
)
def offered(request, cli, tmp_path):
    """What a shell makes of a line."""
    if sys.platform == "win32":
        pytest.skip("the command of this test is a script with #!, which Windows does not run")
    shell = request.param
    program, script = tmp_path / "yarpy", tmp_path / "trial"
    program.write_text(YARPY)
    program.chmod(0o755)
    script.write_text(TRIALS[shell])

    def ask(line: str) -> list[str]:
        done = subprocess.run(
            [shell, script, line],
            env={
                **cli.environment,
                "PATH": f"{tmp_path}{os.pathsep}{os.environ['PATH']}",
                "HOME": str(tmp_path),
            },
            capture_output=True,
            text=True,
            timeout=2 * HANG,
        )
        assert done.stderr == ""
        return done.stdout.split()

    ask.shell = shell
    return ask


def test_verbs(offered):
    assert offered("yarpy disc") == ["disconnect"]


def test_ports_with_colons_in_their_names(offered, names):
    with yarpy.Port("/shell/rpc:i", names=names), yarpy.Port("/shell/rpc:o", names=names):
        heads = "" if offered.shell == "bash" else "/shell/rpc:"  # bash completes the last word
        assert offered("yarpy ping /shell/rpc:") == [f"{heads}i", f"{heads}o"]
        assert offered("yarpy connect /shell/rpc:o /shell/r") == ["/shell/rpc:i", "/shell/rpc:o"]


def test_scripts_and_mistakes(here):
    for shell, script in SCRIPTS.items():
        assert here("completion", shell) == (0, script, "")
    assert here("completion").code == 1
    assert "bash" in here("completion", "tcsh").err
