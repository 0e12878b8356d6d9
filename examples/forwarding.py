"""Forwarding: a chain of programs, each hands on what it got, over another middleware or carrier.

yarpy server
python examples/forwarding.py start            # publishes on the first link of the chain
python examples/forwarding.py middle           # listens to the first, publishes on the second
python examples/forwarding.py end              # listens to the second
"""

import sys
import time

from yarpy.kits import wrap


class Chain:
    @wrap.on("/chain/first", carrier="udp", timeout=10)
    def first(self, text: str = "") -> str:
        return text

    @wrap.on("/chain/second", "websocket", source="/chain/first", timeout=10)
    def second(self, text: str = "") -> str:
        return f"{text}, handed on"


chain = Chain()
role = sys.argv[1] if sys.argv[1:] else sys.exit(__doc__)
if role == "start":
    wrap.publish(chain.first)
    for number in range(600):
        chain.first(f"message {number}")
        time.sleep(0.1)
elif role == "middle":
    wrap.relay(chain.second)
    while True:
        print(chain.second(), flush=True)
else:
    wrap.listen(chain.second)
    for _ in range(3):
        print(chain.second(), flush=True)
