"""Settings of TLS from the environment: `YARPY_TLS`, and where the certificates are.

    (nothing)   the initiator chooses: `+tls`, https and wss are TLS, the rest is plain
    require     every connection of this program is TLS, to it and from it
    mutual      and whoever dials it must show a certificate of its authority

The folder `tls` beside the other configuration, or YARPY_TLS_DIR, has `cert.pem` and `key.pem` of
this computer, and `ca.pem`, the authority that the others are checked against; without that one,
the system's. `yarpy cert` makes all three.

Rules: apart from `tls`, so that a program without TLS does not load it.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import Final

from yarpy.errors import LocalProtocolError
from yarpy.platform.folders import conf_directory

SETTING: Final = "YARPY_TLS"
FIRST_BYTE: Final = 0x16  # of every TLS connection, and of no other protocol here
WORD: Final = "tls"  # in a carrier string


def required() -> bool:
    """Return whether every connection must be TLS. Raises LocalProtocolError for a senseless
    setting."""
    said = os.environ.get(SETTING, "")
    if said not in ("", "require", "mutual"):
        raise LocalProtocolError(f'{SETTING} is "require", "mutual" or nothing, not "{said[:40]}"')
    return bool(said)


def mutual() -> bool:
    """Return whether those who dial us must show a certificate."""
    return os.environ.get(SETTING, "") == "mutual"


def folder() -> Path:
    """Return the folder of the certificates: beside `yarp.conf`."""
    said = os.environ.get("YARPY_TLS_DIR")
    return Path(said) if said else conf_directory(os.environ) / "tls"


def has_certificate() -> bool:
    """Return whether this computer can be dialled with TLS."""
    return (folder() / "cert.pem").is_file()
