"""Carriers: the same message over every installed protocol, one connection after another.

    python examples/several_carriers.py

Needs no name server. The last line asks for a carrier that does not exist.
"""

import yarpy

CARRIERS = [
    "tcp",  # the default: every message is acknowledged
    "fast_tcp",  # the same without acknowledgements
    "udp",  # datagrams: what is lost is lost, and counted
    "mcast",  # datagrams to a group: one send, many readers
    "text",  # what a person types into netcat
    "text_ack",
    "unix_stream",  # a Unix socket, for two programs on one computer
    "unix_stream+ack",
    "local",  # two ports of one program: nothing is encoded
]


def main() -> None:
    names = yarpy.LocalNames()
    with yarpy.Port("/writer", names=names) as writer:
        for carrier in CARRIERS:
            with yarpy.Port("/reader", names=names) as reader:
                try:
                    writer.connect("/reader", carrier)
                except yarpy.YarpError as error:  # e.g. no Unix sockets on Windows
                    print(f"{carrier:16} not here: {error}")
                    continue
                reader.wait_for_inputs(timeout=5)  # in multicast nobody says "ready"
                writer.write(["hello", 1, 2.5, ["nested", b"\0\1"]])
                message = reader.read(timeout=5)
                print(f"{carrier:16} {message.value} over {reader.inputs[0].carrier}")

        try:
            writer.connect("/reader", "tpc")
        except yarpy.UnknownPlugin as error:
            print(error)


if __name__ == "__main__":
    main()
