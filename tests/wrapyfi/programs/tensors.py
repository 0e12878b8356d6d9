"""Tensors of torch as texts of Wrapyfi, by either `wrapyfi`: prints one, and what it reads."""

import json
import sys

import torch

from wrapyfi.utils.serialization_encoders import JsonDecodeHook, JsonEncoder

value = {
    "a": torch.arange(6.0).reshape(2, 3),
    "b": (torch.ones(2, dtype=torch.bfloat16), torch.ones(1).expand(2, 2), torch.empty(0)),
    "c": torch.ones(2, requires_grad=True),
}
print(json.dumps(value, cls=JsonEncoder), flush=True)
hook = JsonDecodeHook(load_torch_device="cpu").object_hook
for line in sys.stdin:
    print(repr(json.loads(line, object_hook=hook)).replace("\n", ""), flush=True)
