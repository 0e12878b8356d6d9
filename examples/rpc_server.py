"""An RPC server: `add 1 2` is answered with the sum, `set KEY VALUE` and `get KEY` keep values.

    yarpy server                        # in one terminal
    python examples/rpc_server.py       # in another
    python examples/rpc_client.py       # in a third, or: yarpy rpc /calculator

What the handler returns is the reply. An error in the handler is logged here and answered as
`[fail] "reason"`, and the connection stays open. Ctrl-C ends the server.
"""

import threading
from contextlib import suppress

import yarpy

store: dict[str, object] = {}


def answer(message: yarpy.Message) -> object:
    match message.as_(list):
        case ["add", *numbers]:
            return [sum(numbers)]
        case ["set", str(key), value]:
            store[key] = value
            return [yarpy.Vocab("ok")]
        case ["get", str(key)]:
            return [store.get(key, f"nobody has set {key}")]
    return [yarpy.Vocab("many"), "add NUMBER...", "set KEY VALUE", "get KEY"]


def main() -> None:
    # `lock`: one question at a time, even if several clients ask.
    with yarpy.RpcServer("/calculator", answer, lock=True) as server:
        print(f"{server.name} listens at {server.address}", flush=True)
        threading.Event().wait()


if __name__ == "__main__":
    with suppress(KeyboardInterrupt):
        main()
