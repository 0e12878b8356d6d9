"""An RPC client: asks examples/rpc_server.py some questions and prints the answers.

    yarpy server                        # in one terminal
    python examples/rpc_server.py       # in another
    python examples/rpc_client.py       # in a third

It also works with any C++ YARP program that answers, and needs no name of its own.
"""

import yarpy


def main() -> None:
    yarpy.wait_for("/calculator", timeout=10)
    with yarpy.RpcClient("/calculator") as client:
        print("add 1 2 3   ->", *client.call("add", 1, 2, 3))
        print("set speed 4 ->", *client.call("set", "speed", 4))
        print("get speed   ->", *client.call(["get", "speed"], timeout=2.0))
        print("get other   ->", *client.call("get", "other"))


if __name__ == "__main__":
    main()
