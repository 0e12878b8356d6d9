"""The asyncio face of ports: the same ports, awaited.

    async with yarpy.aio.Port("/listener") as port:
        async for message in port:
            print(message.value)

Rules: no second stack. Messages come in the threads of their connections, as always, and are
handed to the loop; what may block (opening, connecting, writing to a slow reader, closing) runs in
a thread.
"""

from yarpy.aio.base import BasePort
from yarpy.aio.port import Port
from yarpy.aio.rpc import RpcClient, RpcServer

__all__ = ["BasePort", "Port", "RpcClient", "RpcServer"]
