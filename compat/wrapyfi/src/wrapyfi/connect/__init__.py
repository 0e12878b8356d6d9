"""Publishers, listeners, servers and clients by type and middleware, and the decorator above them.

Middlewares are registered here, once; those of users (WRAPYFI_MWARE_PATHS) behind ours.
"""

from __future__ import annotations

from wrapyfi.connect.clients import Clients
from wrapyfi.connect.listeners import Listeners
from wrapyfi.connect.publishers import Publishers
from wrapyfi.connect.servers import Servers

Publishers.scan()
Listeners.scan()
Servers.scan()
Clients.scan()
