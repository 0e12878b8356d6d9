"""Stamps and drops: a fast writer, a slow reader, and where every message went.

    python examples/stamps_and_drops.py

Needs no name server. A BufferedPort keeps the newest message; drops are counted on the side that
dropped. So messages sent = messages read + drops, over any carrier.
"""

import time

import yarpy


def main() -> None:
    names = yarpy.LocalNames()
    with (
        yarpy.BufferedPort("/sensor", names=names) as sensor,
        yarpy.BufferedPort("/slow", names=names) as slow,
    ):
        sensor.connect("/slow")
        stamp = yarpy.Stamp()
        read, gaps, last = 0, 0, -1
        for turn in range(1000):
            stamp = stamp.next(time.time())
            sensor.write([turn], stamp)
            if turn % 5 == 0:
                time.sleep(0.001)
            if turn % 50 == 45:  # the reader looks twenty times only
                message = slow.read(timeout=5)
                age = time.time() - message.stamp.time
                gaps += message.stamp.count - last - 1
                last = message.stamp.count
                read += 1
        print(f"the last one read is number {last}, {age * 1000:.1f} ms old; {gaps} were skipped")

        sensor.flush()
        while slow.poll():
            read += 1
        out, into = sensor.outputs[0].stats, slow.inputs[0].stats
        print(f"written           {turn + 1}")
        print(f"  sent            {out.messages}, replaced at the writer {out.replaced}")
        print(f"  arrived         {into.messages}, replaced at the reader {into.replaced}")
        print(f"  read            {read}")
        print(f"rate of arrival   {into.rate:.0f} per second, jitter {into.jitter:.6f} s")
        assert turn + 1 == read + out.replaced + into.replaced


if __name__ == "__main__":
    main()
