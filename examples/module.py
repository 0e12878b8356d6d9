"""A module: it does something ten times a second, answers questions, and ends when it is asked to.

    yarpy server                                       # in one terminal
    python examples/module.py --name /tick --rate 2    # in another
    yarpy rpc /tick/rpc                                # in a third: help, count, rate 5, quit

`yarpy terminate /tick` and Ctrl-C end it, too. Options may come from a file: `--from tick.ini`.
"""

import sys

import yarpy


class Tick(yarpy.Module):
    name = "/tick"
    commands = {"count": "tell how many there were", "rate HZ": "change how many a second"}

    def configure(self, resources: yarpy.ResourceFinder) -> None:
        self.period = 1 / resources.find("rate", 10)
        self.port = yarpy.BufferedPort(f"{self.name}/out")
        self.count = 0

    def update(self) -> None:
        self.count += 1
        self.port.write([self.count])

    def respond(self, request: yarpy.Bottle) -> object:
        match request:
            case ["count"]:
                return [self.count]
            case ["rate", int(rate)] if rate > 0:
                self.period = 1 / rate
                return [yarpy.Vocab("ok")]
        return None  # help, quit, and what is unknown

    def close(self) -> None:
        self.port.close()


if __name__ == "__main__":
    sys.exit(Tick().run(yarpy.ResourceFinder(sys.argv[1:])))
