"""A listener that is no port: what a thread of the test does with whoever dials it.

Rules: it leaves nothing behind. Closing a listening socket does not wake a thread that waits in
`accept`, which would take one more connection later, in the middle of another test; shutting it
down wakes it on Linux alone. So it is dialled once more, the thread is waited for, and all that it
took is closed.
"""

from __future__ import annotations

import contextlib
import socket
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from support.wait import HANG


@contextmanager
def listening(
    serve: Callable[[socket.socket], object] = lambda sock: None,
) -> Iterator[tuple[int, list[socket.socket]]]:
    """Give each connection to `serve`, one after the other, and keep it open until the end of the
    block unless `serve` closes it; yield the number to dial, and all that were taken so far."""
    taken: list[socket.socket] = []
    over = threading.Event()

    def run() -> None:
        while True:
            try:
                sock, _ = listener.accept()
            except OSError:
                return
            if over.is_set():  # after the others were shut down
                sock.close()
                return
            taken.append(sock)
            with contextlib.suppress(OSError):  # they have gone, or the test is over
                serve(sock)

    with socket.create_server(("127.0.0.1", 0)) as listener:
        thread = threading.Thread(target=run, daemon=True)
        thread.start()
        try:
            yield listener.getsockname()[1], taken
        finally:
            over.set()
            for sock in taken:
                with contextlib.suppress(OSError):
                    sock.shutdown(socket.SHUT_RDWR)
            with contextlib.suppress(OSError):  # it has ended by itself
                socket.create_connection(listener.getsockname()[:2], HANG).close()
            thread.join(HANG)
            for sock in taken:
                sock.close()
            assert not thread.is_alive(), "it still serves somebody"
