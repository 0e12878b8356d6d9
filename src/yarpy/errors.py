"""Every error that yarpy raises, in one tree.

    YarpError
    |-- AddressError (ValueError)        a name, address or carrier string that cannot be used
    |-- UnknownName (LookupError)        no name service knows this port
    |   `-- WrongPort                    ... or another port has its number by now
    |-- UnknownType (LookupError)        nobody has the definition of this type
    |-- UnknownPlugin (LookupError)      no installed carrier, type, monitor or command of that name
    |-- MissingFile (FileNotFoundError)  a file that was asked for is nowhere, or cannot be read
    |-- NoNameServer (ConnectionError)   no name server answers
    |-- PortClosed (RuntimeError)        the port was closed or interrupted meanwhile
    |-- LinkClosed (ConnectionError)     the other side of a connection went away
    |-- Timeout (TimeoutError)           nothing came in the time given
    |-- RemoteError                      a method of another program raised an exception
    |-- DecodeError (ValueError)         bytes or text that are not what they claim to be
    |   `-- Truncated                    ... because they end too early
    |-- LocalProtocolError               we asked for the impossible (a reply where none can go)
    |   `-- NotAllowed                   ... or for what this port does not do
    `-- RemoteProtocolError              the peer broke the rules: its link closes, the port lives
        `-- AccessRefused                ... or has rules of its own: we may not do that there
            `-- LoginRefused             ... or it wants another name and password

Rules: a message says what happened and what to do next; names come in quotes, as typed.
"""

from __future__ import annotations


class YarpError(Exception):
    """The root: `except yarpy.YarpError` catches whatever this library raises on purpose."""


class AddressError(YarpError, ValueError):
    """A port name, host:port or carrier string that cannot be used."""


class UnknownName(YarpError, LookupError):
    """No name service knows the port."""


class WrongPort(UnknownName):
    """Where a name leads, another port listens: the entry of the name service is out of date."""


class UnknownType(YarpError, LookupError):
    """Nobody has the definition of a type."""


class UnknownPlugin(YarpError, LookupError):
    """No installed plug-in has that name."""


class MissingFile(YarpError, FileNotFoundError):
    """A file that was asked for is nowhere, or cannot be read."""


class NoNameServer(YarpError, ConnectionError):
    """No name server answers."""


class PortClosed(YarpError, RuntimeError):
    """The port was closed or interrupted before or during the call."""


class LinkClosed(YarpError, ConnectionError):
    """The other side of a connection went away."""


class Timeout(YarpError, TimeoutError):
    """Nothing came in the time given."""


class RemoteError(YarpError):
    """A method of another program raised an exception: `type` is its name, `text` what it said."""

    def __init__(self, text: str, type_: str = "") -> None:
        super().__init__(f"{type_}: {text}" if type_ else text)
        self.type = type_
        self.text = text


class DecodeError(YarpError, ValueError):
    """Bytes or text that are not what they claim to be."""


class Truncated(DecodeError):
    """The bytes end before the value does; `need` is how many bytes it takes at least."""

    def __init__(self, message: str, need: int = 0) -> None:
        super().__init__(message)
        self.need = need


class LocalProtocolError(YarpError):
    """This side asked for something the connection cannot do."""


class NotAllowed(LocalProtocolError):
    """A port does not make such connections; another one may."""


class RemoteProtocolError(YarpError):
    """The peer broke the rules of its protocol; its link is closed."""


class AccessRefused(RemoteProtocolError):
    """The peer does not let us do that (its access.toml); asking again does not help."""


class LoginRefused(AccessRefused):
    """The peer wants a name and a password, or others than ours; asking again does not help."""
