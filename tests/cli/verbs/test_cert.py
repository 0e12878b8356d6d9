"""`yarpy cert`: for this computer, for another, and what it says."""

from __future__ import annotations

from pathlib import Path

import pytest

pytest.importorskip("cryptography", reason='certificates: pip install "yarpy[tls]"')


def test_for_this_computer_and_another(cli, tmp_path: Path):
    where = tmp_path / "here"
    environment = {**cli.environment, "YARPY_TLS_DIR": str(where)}
    cli.environment.clear()
    cli.environment.update(environment)
    said = cli.run("cert")
    assert said.returncode == 0, said.stderr
    assert "Authority made" in said.stdout
    assert "localhost" in said.stdout
    assert "127.0.0.1" in said.stdout
    said = cli.run("cert", "robot.lab", "--out", str(tmp_path / "robot"))
    assert said.returncode == 0, said.stderr
    assert "Authority" not in said.stdout
    assert (tmp_path / "robot" / "ca.pem").read_bytes() == (where / "ca.pem").read_bytes()
    said = cli.run("cert", "--out", str(tmp_path / "robot"))
    assert said.returncode == 1
    assert "which computer" in said.stderr
