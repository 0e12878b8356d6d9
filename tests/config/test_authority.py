"""Certificates: made once and anew, for others, private keys kept, judged by openssl."""

from __future__ import annotations

import errno
import os
import subprocess
from pathlib import Path

import pytest
from support.peer import program

from yarpy.config.authority import make
from yarpy.errors import LocalProtocolError

pytest.importorskip("cryptography", reason='certificates: pip install "yarpy[tls]"')


def test_authority_is_made_once(tmp_path: Path) -> None:
    assert make(tmp_path, ["localhost", "127.0.0.1", "fe80::1"])
    first = (tmp_path / "ca.pem").read_bytes(), (tmp_path / "cert.pem").read_bytes()
    assert not make(tmp_path, ["localhost"])
    assert (tmp_path / "ca.pem").read_bytes() == first[0]
    assert (tmp_path / "cert.pem").read_bytes() != first[1]
    if os.name == "posix":  # on Windows a file has the rights of its folder
        for name in ("ca-key.pem", "key.pem"):
            assert (tmp_path / name).stat().st_mode & 0o077 == 0
    assert {file.name for file in tmp_path.iterdir()} == {
        *("ca.pem", "ca-key.pem", "cert.pem", "key.pem"),
    }


def test_for_another_computer(tmp_path: Path) -> None:
    make(tmp_path / "mine", ["localhost"])
    assert not make(tmp_path / "its", ["robot.lab"], tmp_path / "mine")
    its = tmp_path / "its"
    assert not (its / "ca-key.pem").exists()
    with pytest.raises(LocalProtocolError, match="the key of the authority"):
        make(its, ["robot.lab"])


@pytest.mark.peer("openssl")
def test_openssl_accepts_it(tmp_path: Path) -> None:
    make(tmp_path / "mine", ["localhost"])
    make(tmp_path / "its", ["robot.lab"], tmp_path / "mine")
    its = tmp_path / "its"
    line = [program("openssl"), "verify", "-x509_strict", "-verify_hostname", "robot.lab",
            "-CAfile", str(its / "ca.pem"), str(its / "cert.pem")]  # fmt: skip
    done = subprocess.run(line, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_a_full_disk_is_told_with_the_file_and_changes_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    make(tmp_path, ["localhost"])
    before = {file.name: file.read_bytes() for file in tmp_path.iterdir()}
    opened = os.open

    def full(path: Path, *rest: int) -> int:
        if path.name == ".cert.pem.new":
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        return opened(path, *rest)

    monkeypatch.setattr("yarpy.config.authority.os.open", full)
    with pytest.raises(OSError) as told:
        make(tmp_path, ["localhost"])
    assert told.value.filename == str(tmp_path / "cert.pem")
    assert {file.name: file.read_bytes() for file in tmp_path.iterdir()} == before


def test_mistakes(tmp_path: Path) -> None:
    with pytest.raises(LocalProtocolError, match="not the name of a computer"):
        make(tmp_path, ["r\u00f6bot"])
    (tmp_path / "ca-key.pem").write_text("no key")
    with pytest.raises(LocalProtocolError, match="cannot be used"):
        make(tmp_path, ["robot"])
