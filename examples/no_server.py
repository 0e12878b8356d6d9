"""No name server: names inside one program, or no names at all.

    python examples/no_server.py

`LocalNames` is a dictionary: ports that share one find each other. An address `/host:port` needs no
names at all, not even on the other side.
"""

import yarpy


def with_names_of_our_own() -> None:
    names = yarpy.LocalNames()
    with (
        yarpy.Port("/a", names=names) as a,
        yarpy.Port("/b", names=names) as b,
    ):
        a.connect("/b")
        a.write("by a name that only this program knows")
        print(b.read(timeout=5).value)


def with_addresses() -> None:
    # An empty name is not registered. `tcp_port=10050` would be a number to tell others beforehand.
    with yarpy.Port("") as writer, yarpy.Port("") as reader:
        writer.connect(f"/{reader.address}")
        writer.write(f"to {reader.address.split(':')[0]}, without any name")
        print(reader.read(timeout=5).value)
        print(*yarpy.ping(f"tcp://{reader.address}/"), sep="\n")


def asked_by_address() -> None:
    def double(message: yarpy.Message) -> list[float]:
        return [2 * number for number in message.as_(list)]

    with (
        yarpy.RpcServer("", double) as server,
        yarpy.RpcClient(f"/{server.address}") as client,
    ):
        print(*client.call(1, 2, 3))


if __name__ == "__main__":
    with_names_of_our_own()
    with_addresses()
    asked_by_address()
