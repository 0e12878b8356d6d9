"""Tensors of a real torch through a port and back, and their memory; prints `well` at the end."""

import numpy as np
import torch

import yarpy
from yarpy.data.python.array import array_of

names = yarpy.LocalNames()
reader, writer = yarpy.Port("/in", names=names), yarpy.Port("/out", names=names)
writer.connect("/in", "tcp")


def through(value: object) -> yarpy.Message:
    writer.write(value)
    return reader.read(timeout=60)


kinds = "float64 float32 float16 int64 int32 int16 int8 uint8 bool complex64 complex128"
for kind in (getattr(torch, name) for name in kinds.split()):
    for shape in (12,), (3, 4), (2, 2, 3), (0,):
        tensor = torch.arange(int(np.prod(shape))).reshape(shape).to(kind)
        found = through(tensor).as_(torch.Tensor)
        assert found.dtype == kind and torch.equal(found, tensor), (kind, shape, found)

square = torch.arange(9.0).reshape(3, 3)
turning = torch.tensor([1j, 2]).conj()
views = [square.t(), square[:, ::2], turning, turning.imag, torch.ones(1).expand(2, 2)]
views += [torch.ones(3, requires_grad=True), torch.nn.Parameter(torch.ones(2, 2))]
for view in views:
    assert torch.equal(through(view).as_(torch.Tensor), view.detach()), view

held = through({"a": square, "b": [square.int(), None]}).value
assert (held["a"] == square.numpy()).all() and held["b"][0].dtype == np.int32

for refused in (torch.ones(2, dtype=torch.bfloat16), square.to_sparse()):
    try:
        writer.write(refused)
    except TypeError as error:
        assert "a tensor of torch." in str(error) and "tensor.float()" in str(error)
    else:
        raise AssertionError(f"{refused} was sent")
    assert through("still there").value == "still there"

large = torch.arange(100_000.0)
assert array_of(large).ctypes.data == large.data_ptr(), "copied before it was sent"
for tensor in large, large.reshape(100, 1000), large.double().reshape(100, 1000), large.int():
    message = through(tensor)
    memory = message.as_(np.ndarray)
    assert np.shares_memory(memory, np.frombuffer(message.payload, "u1"))
    assert message.as_(torch.Tensor).data_ptr() == memory.ctypes.data, "copied on arrival"
    assert torch.equal(torch.from_dlpack(message.value), tensor)
print("well")
