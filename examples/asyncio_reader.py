"""asyncio: read two ports in one event loop, with `async for`, next to other work.

    python examples/asyncio_reader.py

Needs no name server. A real program leaves `names` out and finds the server by itself.
"""

import asyncio

import yarpy
from yarpy import aio


async def talk(port: aio.Port, words: list[str]) -> None:
    for number, word in enumerate(words):
        await port.write([word, number])
        await asyncio.sleep(0.01)
    await port.write(["end"])


async def listen(port: aio.Port) -> int:
    count = 0
    async for message in port:
        if message.value == ["end"]:
            break
        print(port.name, "got", message.value, "from", message.source)
        count += 1
    return count


async def main() -> None:
    names = yarpy.LocalNames()
    async with (
        aio.Port("/left", names=names) as left,
        aio.Port("/right", names=names) as right,
    ):
        await left.connect("/right")
        await right.connect("/left")
        async with asyncio.timeout(10), asyncio.TaskGroup() as group:
            counts = [group.create_task(listen(port)) for port in (left, right)]
            group.create_task(talk(left, ["one", "two", "three"]))
            group.create_task(talk(right, ["four", "five"]))
        print("messages:", [task.result() for task in counts])


if __name__ == "__main__":
    asyncio.run(main())
