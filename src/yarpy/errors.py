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

Rules: a message says what happened and what to do next; names come in quotes, as typed. The second
paragraph of a class says what mends it: docs/errors.md is made from it and from the messages.
"""

from __future__ import annotations


class YarpError(Exception):
    """The root: `except yarpy.YarpError` catches whatever this library raises on purpose."""


class AddressError(YarpError, ValueError):
    """A port name, host:port or carrier string that cannot be used.

    Choose another name or number, or correct what the message quotes. Names begin with a slash; a
    name that is taken belongs to a program that still runs: `yarpy where NAME` says which.
    """


class UnknownName(YarpError, LookupError):
    """No name service knows the port.

    Start the program of that port, or correct its name: `yarpy name list` shows what is registered
    with your name server, `yarpy where` which server that is. `timeout=` waits for it.
    """


class WrongPort(UnknownName):
    """Another port listens at the address of a name: the entry of the name service is out of date.

    Start the program of that port again, or let `yarpy clean` take out what is no longer there.
    """


class UnknownType(YarpError, LookupError):
    """Nobody has the definition of a type.

    Correct the name of the type, install the package that defines it, or give the path of its file.
    """


class UnknownPlugin(YarpError, LookupError):
    """No installed plug-in has that name.

    Correct the name (`yarpy plugin` lists what there is), or install the extra that is named.
    """


class MissingFile(YarpError, FileNotFoundError):
    """A file that was asked for is nowhere, or cannot be read.

    Correct the path, or make the file as the message says.
    """


class NoNameServer(YarpError, ConnectionError):
    """No name server answers.

    Start `yarpy server` on this computer, or say where one runs: `yarpy conf HOST PORT`. Inside one
    program `names=yarpy.LocalNames()` takes none.
    """


class PortClosed(YarpError, RuntimeError):
    """The port was closed or interrupted before or during the call.

    Open another port; after `interrupt`, `resume` lets this one go on. A loop ends with it.
    """


class LinkClosed(YarpError, ConnectionError):
    """The other side of a connection went away.

    See whether the program at the other end still runs, and what its log says. Connections that
    broke are made again by themselves.
    """


class Timeout(YarpError, TimeoutError):
    """Nothing came in the time given.

    Wait longer (`timeout=`), or see whether the other side sends at all: `yarpy doctor /name`.
    """


class RemoteError(YarpError):
    """A method of another program raised an exception: `type` is its name, `text` what it said.

    Mend what the other program says; its log has the traceback.
    """

    def __init__(self, text: str, type_: str = "") -> None:
        super().__init__(f"{type_}: {text}" if type_ else text)
        self.type = type_
        self.text = text


class DecodeError(YarpError, ValueError):
    """Bytes or text that are not what they claim to be.

    Read it as what it is: the message says what came. For a typed port, correct its type.
    """


class Truncated(DecodeError):
    """The bytes end before the value does; `need` is how many bytes it takes at least.

    The sender has written less than it announced; see its log.
    """

    def __init__(self, message: str, need: int = 0) -> None:
        super().__init__(message)
        self.need = need


class LocalProtocolError(YarpError):
    """This side asked for something the connection cannot do.

    Do what the message proposes; asking again in the same way gives the same answer.
    """


class NotAllowed(LocalProtocolError):
    """A port does not make such connections; another one may.

    Connect another port of that program, or give this one the right to make connections.
    """


class RemoteProtocolError(YarpError):
    """The peer broke the rules of its protocol; its link is closed.

    See which program that is and of which version; its log may say more.
    """


class AccessRefused(RemoteProtocolError):
    """The peer does not let us do that (its access.toml); asking again does not help.

    Ask the owner of the other port for the right (its access.toml, docs/security.md).
    """


class LoginRefused(AccessRefused):
    """The peer wants a name and a password, or others than ours; asking again does not help.

    Give the name and the password that the other side wants; the message says where they go.
    """
