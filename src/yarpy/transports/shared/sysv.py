"""Parts of C++ YARP's shared memory: segments of System V, and mutexes of glibc in files.

Rules: Linux with glibc, in 64 bits. Both exist for programs of one user alone: what belongs to
another user, or what another user may change, is refused, since whoever may make a file shorter can
stop a program that looks at it. A segment never becomes shorter. What has a name here may be
`forgotten` as soon as the other side has found it: then nothing stays behind, whoever is killed.
"""

from __future__ import annotations

import ctypes
import mmap
import os
import platform
import stat
import struct
import sys
import weakref
from typing import Any, Final

from yarpy.errors import LocalProtocolError
from yarpy.platform.user import user

ELSEWHERE: Final = "use memory, unix_stream or tcp"

_CREATE: Final = 0o1000  # IPC_CREAT
_ALONE: Final = 0o2000  # IPC_EXCL
_REMOVE: Final = 0  # IPC_RMID
_LOOK: Final = 2  # IPC_STAT
_OURS: Final = 0o600
_NO_LINK: Final = getattr(os, "O_NOFOLLOW", 0)
_OTHERS: Final = 0o022  # may write

# struct shmid_ds: owner, group, creator, his group, mode | size | processes that have it
_OWNERS: Final = struct.Struct("4x5I")
_SIZE: Final = struct.Struct("48xQ")
_ATTACHED: Final = struct.Struct("88xQ")

# pthread_mutex_t: the lock's word, a count, the owner, users, its kind
_SIZES: Final = {"x86_64": 40, "aarch64": 48}
MUTEX: Final = _SIZES.get(platform.machine(), 0)
_SHARED: Final = 0x80  # a plain mutex between processes
_KIND: Final = 4  # which int of it says so

_FUTEX: Final = {"x86_64": 202, "aarch64": 98}.get(platform.machine(), 0)
_WAIT, _WAKE = 0, 1

# What never waits keeps Python's lock; what sleeps gives it away.
_quick: Any = ctypes.PyDLL(None, use_errno=True) if os.name == "posix" else None
_slow: Any = ctypes.CDLL(None, use_errno=True) if os.name == "posix" else None


def available() -> bool:
    """Return whether this system has shared memory and semaphores of System V, as C++ YARP uses
    them."""
    return (
        sys.platform == "linux"
        and sys.maxsize > 1 << 32
        and bool(MUTEX and _FUTEX)
        and hasattr(_quick, "gnu_get_libc_version")
    )


if available():
    _quick.shmget.argtypes = [ctypes.c_int, ctypes.c_size_t, ctypes.c_int]
    _quick.shmat.argtypes = [ctypes.c_int, ctypes.c_void_p, ctypes.c_int]
    _quick.shmat.restype = ctypes.c_void_p
    _quick.shmdt.argtypes = [ctypes.c_void_p]
    _quick.shmctl.argtypes = [ctypes.c_int, ctypes.c_int, ctypes.c_void_p]
    _quick.pthread_mutex_trylock.argtypes = [ctypes.c_void_p]
    _quick.pthread_mutex_unlock.argtypes = [ctypes.c_void_p]
    for _library in (_quick, _slow):
        _library.syscall.argtypes = [
            *(ctypes.c_long, ctypes.c_void_p, ctypes.c_long, ctypes.c_long),
            *(ctypes.c_char_p, ctypes.c_void_p, ctypes.c_long),
        ]


def _failed(what: str) -> OSError:
    number = ctypes.get_errno()
    return OSError(number, f"{what}: {os.strerror(number)}")


class Segment:
    """A segment of shared memory, attached: `bytes` is all of it, `numbers` its beginning as ints.

    It stays attached as long as the object lives, or a view of it.
    """

    def __init__(self, identity: int, header: int) -> None:
        self._identity = identity
        self.size = _SIZE.unpack_from(_stat(identity))[0]
        if self.size < header:
            raise OSError(f"a segment of {self.size} bytes")
        address = _quick.shmat(identity, None, 0)
        if address in (None, ctypes.c_void_p(-1).value):
            raise _failed("shmat")
        memory = (ctypes.c_char * self.size).from_address(address)
        # Detached when the last view has gone; not at exit, where threads may still look.
        weakref.finalize(memory, _quick.shmdt, address).atexit = False
        self.bytes = memoryview(memory).cast("B")
        self.numbers = self.bytes[:header].cast("i")

    @classmethod
    def create(cls, key: int, size: int, header: int) -> Segment:
        """A new one of zeros. What a program that has ended left behind gives way.

        Raises OSError: there is no room, or the key is taken.
        """
        for again in (True, False):
            identity = _quick.shmget(key, size, _CREATE | _ALONE | _OURS)
            if identity >= 0:
                return cls(identity, header)
            error = _failed(f"shared memory of {size} bytes")
            if not (again and isinstance(error, FileExistsError) and _left_behind(key, header)):
                raise error
        raise AssertionError

    @classmethod
    def attach(cls, key: int, header: int) -> Segment:
        """The one that another program of our user has made. Raises OSError."""
        identity = _quick.shmget(key, header, _OURS)
        if identity < 0:
            raise _failed("shared memory")
        owner, _, creator, _, mode = _OWNERS.unpack_from(_stat(identity))
        if not owner == creator == user() or mode & _OTHERS:
            raise PermissionError("the shared memory belongs to another user, or is open to others")
        return cls(identity, header)

    @property
    def attached(self) -> int:
        """The number of programs that have it (a program that has it twice counts twice)."""
        count: int = _ATTACHED.unpack_from(_stat(self._identity))[0]
        return count

    def forget(self) -> None:
        """Take its key away: it ends with the last one that has it."""
        _quick.shmctl(self._identity, _REMOVE, None)


def _stat(identity: int) -> bytes:
    found = ctypes.create_string_buffer(256)
    if _quick.shmctl(identity, _LOOK, found):
        raise _failed("shmctl")
    return found.raw


def _left_behind(key: int, header: int) -> bool:
    """Remove a segment of our user that nobody has any more, and that looks like one of these: the
    second number is the size of what follows the header."""
    try:
        old = Segment.attach(key, header)
        if old.attached != 1 or old.numbers[1] != old.size - header:
            return False
        old.forget()
    except OSError:
        return False
    return True


class Mutex:
    """A mutex in a file, between processes: made by one side, found by the other."""

    def __init__(self, path: str, create: bool) -> None:
        self._path = path
        # No link that somebody else has put there is followed.
        flags = os.O_RDWR | _NO_LINK | (os.O_CREAT | os.O_EXCL) * create
        try:
            file = os.open(path, flags, _OURS)
        except FileExistsError:
            os.unlink(path)  # of a program that has ended: its number was ours to take
            file = os.open(path, flags, _OURS)
        try:
            if create:
                os.write(file, bytes(4 * _KIND) + struct.pack("i", _SHARED))
                os.truncate(file, MUTEX)
            found = os.fstat(file)
            if not stat.S_ISREG(found.st_mode) or found.st_size < MUTEX:
                raise OSError(f"{path} is not the file of a mutex")
            if found.st_uid != user() or found.st_mode & _OTHERS:
                raise PermissionError(f"{path} belongs to another user, or is open to others")
            self._map = mmap.mmap(file, MUTEX)
        finally:
            os.close(file)
        self._numbers = memoryview(self._map).cast("i")
        self._word = ctypes.c_int.from_buffer(self._map)
        self._address = ctypes.addressof(self._word)

    def _check(self) -> None:
        """Its own processor instructions would end us if the file had become shorter."""
        if self._map.size() < MUTEX or self._numbers[_KIND] & ~_SHARED:
            raise OSError("the file of the mutex was changed")

    def try_acquire(self) -> bool:
        """Take it, if nobody has it. Raises OSError."""
        self._check()
        return not _quick.pthread_mutex_trylock(self._address)

    def release(self) -> None:
        """Give it back, and wake who waits for it: whoever took it. Raises OSError."""
        self._check()
        _quick.pthread_mutex_unlock(self._address)

    @property
    def held(self) -> bool:
        """Return whether somebody holds it. Raises OSError."""
        self._check()
        return bool(self._numbers[0])

    def hold(self) -> None:
        """Take it without asking, so that `wait` sleeps until another one releases it."""
        self._check()
        self._numbers[0] = 2

    def wait(self, seconds: float) -> None:
        """Sleep while it is held, but not for ever."""
        time = struct.pack("ll", int(seconds), int(seconds % 1 * 1e9))
        _slow.syscall(_FUTEX, self._address, _WAIT, 2, time, None, 0)

    def wake(self) -> None:
        """Wake who waits, without giving it back."""
        _quick.syscall(_FUTEX, self._address, _WAKE, 1 << 30, None, None, 0)

    def forget(self) -> None:
        """Take its name away."""
        try:
            os.unlink(self._path)
        except OSError:
            pass  # the other side was quicker


def require() -> None:
    """Raises LocalProtocolError where there is no such memory."""
    if not available():
        raise LocalProtocolError(f"shmem needs Linux with glibc in 64 bits; {ELSEWHERE}")
