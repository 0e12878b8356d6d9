"""WebSocket: ports with names, as `yarp`, connected by WebSocket, as browsers are.

Rules: a web page reads what is published, and writes to listeners (docs/web.md); nothing has to be
said for that. This middleware makes our own connections WebSockets, too, for networks in which
nothing else passes.
"""

from __future__ import annotations

from yarpy.kits.wrap.middleware import Binding
from yarpy.kits.wrap.yarp import Yarp


class WebSocket(Yarp):
    """The middleware `websocket`."""

    name = "websocket"
    carrier = "websocket"

    def check(self, binding: Binding) -> None:
        super().check(binding)
        binding.refuse(carrier="it is websocket")
