"""A method of Wrapyfi over REQ and REP of ZeroMQ: `asked.py reply`, or `asked.py request`."""

import json
import sys

from wrapyfi.connect.wrapper import MiddlewareCommunicator


class Asked(MiddlewareCommunicator):
    @MiddlewareCommunicator.register("NativeObject", "zeromq", "Asked", "/asked")
    def add(self, first, second=0):
        return ({"sum": first + second, "words": ["a", [1, 2.5]]},)


asked = Asked()
asked.activate_communication(asked.add, mode=sys.argv[1])
print("ready", flush=True)
if sys.argv[1] == "reply":
    while True:
        asked.add()
(answer,) = asked.add(3, second=4)
print(json.dumps(answer), flush=True)
