"""What the environment says of TLS, and that certificates lie beside yarp.conf."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import pytest

from yarpy.errors import LocalProtocolError
from yarpy.platform.folders import conf_directory
from yarpy.transports.tls_setting import folder, has_certificate, mutual, required


@pytest.mark.parametrize(
    ("said", "all_", "both"),
    [("", False, False), ("require", True, False), ("mutual", True, True)],
)
def test_setting(monkeypatch: pytest.MonkeyPatch, said: str, all_: bool, both: bool) -> None:
    monkeypatch.setenv("YARPY_TLS", said)
    assert (required(), mutual()) == (all_, both)


def test_a_mistake_does_not_mean_no(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("YARPY_TLS", "required")
    with pytest.raises(LocalProtocolError, match="require"):
        required()


#: what says where a user's settings are, here
OWN = {"win32": ["APPDATA"], "darwin": ["HOME"]}.get(sys.platform, ["XDG_CONFIG_HOME", "HOME"])


@pytest.mark.parametrize("name", ["YARP_CONFIG_HOME", *OWN])
def test_certificates_lie_beside_the_configuration(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, name: str
) -> None:
    for each in ("YARPY_TLS_DIR", "YARP_CONFIG_HOME", "XDG_CONFIG_HOME", "APPDATA", "HOME"):
        monkeypatch.delenv(each, raising=False)
    monkeypatch.setenv(name, str(tmp_path))
    assert folder().is_relative_to(tmp_path)
    assert folder() == conf_directory(os.environ) / "tls"
    assert not has_certificate()
    folder().mkdir(parents=True)
    (folder() / "cert.pem").touch()
    assert has_certificate()
