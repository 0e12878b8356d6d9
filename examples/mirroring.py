"""Mirroring: the same program in two places; one runs the method, the other gets what it returns.

    yarpy server
    python examples/mirroring.py publish hello     # and in another terminal
    python examples/mirroring.py listen

Or ask and answer: `serve` here, `call hello` there; then the arguments are those of the caller.
"""

import sys
import time

from yarpy.kits import wrap


class Mirror:
    @wrap.on("/mirror/message", timeout=10)
    def say(self, text: str = "") -> dict[str, str]:
        """Runs in one program, returns in both."""
        return {"text": text, "said by": sys.argv[1]}

    @wrap.on("/mirror/question", timeout=10)
    def answer(self, text: str = "") -> dict[str, str]:
        return {"text": text.upper(), "said by": sys.argv[1]}


if sys.argv[1:2] not in (["publish"], ["listen"], ["serve"], ["call"]):
    sys.exit(__doc__)
mirror = Mirror()
mode, text = sys.argv[1], " ".join(sys.argv[2:])
method = mirror.say if mode in ("publish", "listen") else mirror.answer
with getattr(wrap, mode)(method) as handle:
    if mode == "serve":
        handle.wait(timeout=60)
    for _ in range({"publish": 600, "listen": 3, "call": 1}.get(mode, 0)):
        print(method(text), flush=True)
        time.sleep(0.1 if mode == "publish" else 0)
