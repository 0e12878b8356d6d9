"""A laboratory's own certificate authority, and the certificates that it issues to computers.

    ca.pem  ca-key.pem      the authority; the key stays where it was made
    cert.pem  key.pem       one computer, by its names and addresses

Rules: keys are P-256 and readable only by their owner. Nothing is overwritten except a certificate
that is renewed. Only making certificates needs the package cryptography.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from contextlib import suppress
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any, Final

from yarpy.errors import LocalProtocolError
from yarpy.platform.file_place import replace

YEARS: Final = 10  # of an authority
DAYS: Final = 825  # of a certificate, the most that browsers take


def make(directory: Path, names: Sequence[str], authority: Path | None = None) -> bool:
    """Make a certificate for a computer with these names and addresses, in `directory`.

    authority: where the authority is, default `directory`; one is made if there is none. Returns
    whether one was made. Raises LocalProtocolError.
    """
    where = directory if authority is None else authority
    x509, _, hashes, _ = _library()
    for folder in (where, directory):
        folder.mkdir(parents=True, exist_ok=True)
    key, issuer, fresh = _authority(where)
    own = _key()
    now = datetime.now(UTC)
    certificate = (
        x509.CertificateBuilder()
        .subject_name(_name(names[0]))
        .issuer_name(issuer.subject)
        .public_key(own.public_key())
        .serial_number(x509.random_serial_number())
        .not_valid_before(now - timedelta(hours=1))
        .not_valid_after(now + timedelta(days=DAYS))
        .add_extension(x509.SubjectAlternativeName([_alternative(one) for one in names]), False)
        .add_extension(x509.BasicConstraints(ca=False, path_length=None), True)
        .add_extension(x509.AuthorityKeyIdentifier.from_issuer_public_key(key.public_key()), False)
        .sign(key, hashes.SHA256())
    )
    files = {
        directory / "key.pem": (_private(own), 0o600),
        directory / "cert.pem": (_public(certificate), 0o644),
    }
    if directory != where:
        files[directory / "ca.pem"] = (_public(issuer), 0o644)
    _write(files)
    return fresh


def _authority(where: Path) -> tuple[Any, Any, bool]:
    """The authority's key and certificate, and whether they are new."""
    x509, _, hashes, serialization = _library()
    key_file, file = where / "ca-key.pem", where / "ca.pem"
    if key_file.exists():
        try:
            key = serialization.load_pem_private_key(key_file.read_bytes(), None)
            return key, x509.load_pem_x509_certificate(file.read_bytes()), False
        except (OSError, ValueError) as error:
            raise LocalProtocolError(f"{key_file} and {file} cannot be used: {error}") from error
    if file.exists():
        raise LocalProtocolError(
            f"the key of the authority {file} is not here. Make the certificate where ca-key.pem "
            "is (yarpy cert NAME --out DIR), or delete the file"
        )
    key, now = _key(), datetime.now(UTC)
    subject = _name("yarpy laboratory")
    certificate = (
        x509.CertificateBuilder()
        .subject_name(subject)
        .issuer_name(subject)
        .public_key(key.public_key())
        .serial_number(x509.random_serial_number())
        .not_valid_before(now - timedelta(hours=1))
        .not_valid_after(now + timedelta(days=365 * YEARS))
        .add_extension(x509.BasicConstraints(ca=True, path_length=0), True)
        .add_extension(x509.SubjectKeyIdentifier.from_public_key(key.public_key()), False)
        .add_extension(
            x509.KeyUsage(False, False, False, False, False, True, True, False, False), True
        )
        .sign(key, hashes.SHA256())
    )
    _write({key_file: (_private(key), 0o600), file: (_public(certificate), 0o644)})
    return key, certificate, True


def _library() -> tuple[Any, Any, Any, Any]:
    try:
        from cryptography import x509
        from cryptography.hazmat.primitives import hashes, serialization
        from cryptography.hazmat.primitives.asymmetric import ec
    except ImportError as error:
        raise LocalProtocolError(
            'making certificates needs the package cryptography: pip install "yarpy[tls]"'
        ) from error
    return x509, ec, hashes, serialization


def _key() -> Any:
    _, ec, _, _ = _library()
    return ec.generate_private_key(ec.SECP256R1())


def _name(text: str) -> Any:
    x509, *_ = _library()
    return x509.Name([x509.NameAttribute(x509.NameOID.COMMON_NAME, text[:64])])


def _alternative(name: str) -> Any:
    import ipaddress

    x509, *_ = _library()
    try:
        return x509.IPAddress(ipaddress.ip_address(name))
    except ValueError:
        pass
    try:
        return x509.DNSName(name)
    except ValueError as error:
        raise LocalProtocolError(f'"{name}" is not the name of a computer') from error


def _private(key: Any) -> bytes:
    *_, serialization = _library()
    form = serialization.PrivateFormat.PKCS8, serialization.NoEncryption()
    found: bytes = key.private_bytes(serialization.Encoding.PEM, *form)
    return found


def _public(certificate: Any) -> bytes:
    *_, serialization = _library()
    found: bytes = certificate.public_bytes(serialization.Encoding.PEM)
    return found


def _write(files: dict[Path, tuple[bytes, int]]) -> None:
    """Write contents with their modes; others cannot read them even for a moment. Where there is no
    room for all, none is there: a key without its certificate is of no use. Raises OSError."""
    drafts = {file: file.with_name(f".{file.name}.new") for file in files}
    try:
        for file, draft in drafts.items():
            data, mode = files[file]
            draft.unlink(missing_ok=True)
            with open(os.open(draft, os.O_WRONLY | os.O_CREAT | os.O_EXCL, mode), "wb") as out:
                out.write(data)
        for file, draft in drafts.items():
            replace(draft, file)
    except OSError as error:
        error.filename = str(file)  # a full disk does not say which file
        for draft in drafts.values():
            with suppress(OSError):  # on a disk that cannot be written nothing can be taken away
                draft.unlink(missing_ok=True)
        raise
