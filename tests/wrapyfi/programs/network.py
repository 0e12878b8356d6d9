"""Networks of torch as users spread them over computers, all of them in this process.

An ensemble whose branches run in one object and arrive in the other, modes by a file; and a chain
of blocks, each with a topic and a mode of its own, half of it in either object.
"""

import sys
import threading

import torch
from torch import nn

import yarpy
from wrapyfi.config.manager import ConfigManager
from wrapyfi.connect.wrapper import DEFAULT_COMMUNICATOR, MiddlewareCommunicator
from yarpy.names.default import DEFAULT

register = MiddlewareCommunicator.register
DEFAULT.push(yarpy.LocalNames())
BRANCHES = 9
DEVICE = {"load_torch_device": "$device"}


class Ensemble(MiddlewareCommunicator, nn.Module):
    """Shared layers, and branches whose results are put together."""

    def __init__(self, device):
        MiddlewareCommunicator.__init__(self)  # modes come from the file, before anything is there
        nn.Module.__init__(self)
        self.device = device
        self.branches = {}
        for number in range(1, BRANCHES + 1):
            getattr(self, f"create_branch_{number}")(device)

    def forward(self, x):
        found = []
        for number in range(1, BRANCHES + 1):
            (one,) = getattr(self, f"forward_branch_{number}")(x, device=self.device)
            found.append(one)
        return torch.stack(found)


def branch(number):
    """The two methods of a branch, as somebody would write them nine times."""

    def create(self, device):
        self.branches[number] = nn.Linear(3, 2, bias=False)
        nn.init.constant_(self.branches[number].weight, float(number))
        return (True,)

    def forward(self, x_shared_representations, device=None):
        return (self.branches[number](x_shared_representations),)

    for name, method in (("create", create), ("forward", forward)):
        method.__qualname__ = f"Ensemble.{name}_branch_{number}"
    topics = f"/net/created_branch_{number}", f"/net/forward_branch_{number}"
    kind = "NativeObject", DEFAULT_COMMUNICATOR, "Ensemble"
    made = register(*kind, topics[0], should_wait=True)(create)
    setattr(Ensemble, f"create_branch_{number}", made)
    made = register(*kind, topics[1], should_wait=True, listener_kwargs=DEVICE)(forward)
    setattr(Ensemble, f"forward_branch_{number}", made)


for each in range(1, BRANCHES + 1):
    branch(each)


class Block(MiddlewareCommunicator, nn.Module):
    """Part of a chain; where another computer has it, it is empty here."""

    def __init__(self, enabled):
        MiddlewareCommunicator.__init__(self)
        nn.Module.__init__(self)
        if enabled:
            self.layer = nn.Linear(3, 3, bias=False)
            nn.init.eye_(self.layer.weight)

    @register("NativeObject", DEFAULT_COMMUNICATOR, "Block", "$topic_name", should_wait=True,
              listener_kwargs={"load_torch_device": "$device"})  # fmt: skip
    def forward_wrapped(self, x, start_pos, topic_name="/net/block_x", device="cpu"):
        return (self(x) + start_pos,)

    def forward(self, x):
        return self.layer(x)


def chain(modes, x):
    """What comes out of a chain of blocks with these modes."""
    blocks = [Block(mode in (None, "publish")) for mode in modes]
    for block, mode in zip(blocks, modes, strict=True):
        block.activate_communication(block.forward_wrapped, mode)
    with torch.inference_mode():
        for number, block in enumerate(blocks):
            topic = number - 1 if modes[number] == "listen" else number
            (x,) = block.forward_wrapped(x, 1, topic_name=f"/net/block_{topic}")
    return x


if sys.argv[1] == "ensemble":
    forward = {f"forward_branch_{n}": ["publish", "listen"] for n in range(1, BRANCHES + 1)}
    ConfigManager({"Ensemble": forward})
    x = torch.ones(1, 3)
    here, there = Ensemble("cpu"), Ensemble("cpu")
    threading.Thread(target=here, args=(x,), daemon=True).start()
    print("ensemble", there(None).sum(dim=2).flatten().tolist(), flush=True)
else:
    ours = [None, "publish", "disable", "disable"]
    theirs = ["disable", "disable", "listen", None]
    threading.Thread(target=chain, args=(ours, torch.zeros(3)), daemon=True).start()
    print("chain", chain(theirs, None).tolist(), flush=True)
