"""The asyncio face of ports: the same ports, awaited.

    async with yarpy.aio.Port("/listener") as port:
        async for message in port:
            print(message.value)

Rules: no second stack, the same names. Messages come in the threads of their connections, as
always, and wait in the same mailboxes; what may block (opening, connecting, writing, closing) runs
in a thread that it has for itself.
"""

from yarpy.aio.base import BasePort
from yarpy.aio.port import BufferedPort, Port
from yarpy.aio.rpc import RpcClient, RpcServer

__all__ = ["BasePort", "BufferedPort", "Port", "RpcClient", "RpcServer"]
