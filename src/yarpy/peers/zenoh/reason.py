"""The reason why a router of Zenoh could not be reached, found out by dialling it ourselves.

Rules: what is found is an error to be raised, or shown: LinkClosed, or RemoteProtocolError where a
certificate is the matter.
"""

from __future__ import annotations

import socket
import time
from typing import Final

from yarpy.errors import LinkClosed, RemoteProtocolError
from yarpy.peers.zenoh.place import parts
from yarpy.transports.tls_setting import folder

PROBE_TIMEOUT: Final = 2.0  # seconds to find out
HANDSHAKE: Final = 1.0  # seconds for TLS, behind those that Zenoh has waited
REFUSAL: Final = 0.5  # seconds within which a router says that it refuses a certificate


def reason(where: str) -> Exception:
    """Return why a router could not be reached, found out by dialling it ourselves."""
    kind, host, port = parts(where)
    if kind in ("quic", "udp") or not port.isdigit():
        return LinkClosed("no answer")
    try:
        sock = socket.create_connection((host, int(port)), PROBE_TIMEOUT)
    except (OSError, UnicodeError) as error:
        return LinkClosed(str(getattr(error, "strerror", "") or error))
    with sock:
        if kind != "tls":
            return LinkClosed("what listens there does not speak Zenoh, or wants TLS: tls/...")
        return _of_tls(sock, host, where)


def _of_tls(sock: socket.socket, host: str, where: str) -> Exception:
    import ssl

    from yarpy.transports.tls import client_context, explained

    told = f"the Zenoh router at {where}: "
    sock.settimeout(HANDSHAKE)
    try:
        with client_context().wrap_socket(sock, server_hostname=host) as secure:
            until = time.monotonic() + REFUSAL
            secure.settimeout(REFUSAL)  # with TLS 1.3 it comes after the handshake
            while time.monotonic() < until and secure.recv(1000):
                pass
    except ssl.SSLCertVerificationError as error:
        return RemoteProtocolError(told + explained(error))
    except ssl.SSLError as error:
        return RemoteProtocolError(
            f"{told}it refuses our certificate ({error.reason or error}): it wants cert.pem and "
            f"key.pem in {folder()}, of its own authority"
        )
    except TimeoutError:
        return LinkClosed("what listens there says nothing in TLS, perhaps it has none: tcp/...")
    except (OSError, UnicodeError) as error:
        return LinkClosed(str(error))
    return LinkClosed("what listens there does not speak Zenoh")
