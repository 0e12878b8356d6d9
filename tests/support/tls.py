"""Certificates for tests: an authority and this computer's, in a folder of their own."""

from __future__ import annotations

from pathlib import Path

import pytest

from yarpy.config.authority import make


def prepare(folder: Path, monkeypatch: pytest.MonkeyPatch, setting: str = "") -> Path:
    """Certificates in `folder`, where this process looks for them."""
    pytest.importorskip("cryptography", reason='certificates: pip install "yarpy[tls]"')
    make(folder, ["127.0.0.1", "localhost"])
    monkeypatch.setenv("YARPY_TLS_DIR", str(folder))
    monkeypatch.setenv("YARPY_TLS", setting)
    return folder
