"""Tensors of torch, JAX, TensorFlow, MXNet and CuPy, as Wrapyfi's plug-ins spell them.

    PytorchTensor                            the file of `torch.save`, and the device
    JAXTensor, TensorflowTensor              .npy
    MXNetTensor, CuPyArray                   .npy, and the device

Rules: no library is imported here: who has such a tensor has it. A listener whose program has not
imported the library gets an array of numpy. Files of torch are read without unpickling. A plug-in
of the user's for the same type comes first.
"""

from __future__ import annotations

import io
from base64 import b64decode, b64encode
from typing import Any

from yarpy.data.python.array import array_of
from yarpy.data.python.loaded import loaded
from yarpy.kits.wrap.value.npy import to_npy
from yarpy.kits.wrap.value.tensor import read
from yarpy.kits.wrap.value.tree import untag

#: the package that a class is of, its tag, the option that names the device of listeners
_TAGS = {
    "jax": "JAXTensor",
    "jaxlib": "JAXTensor",
    "tensorflow": "TensorflowTensor",
    "mxnet": "MXNetTensor",
    "cupy": "CuPyArray",
}
_LIBRARIES = {
    "PytorchTensor": "torch",
    "JAXTensor": "jax",
    "TensorflowTensor": "tensorflow",
    "MXNetTensor": "mxnet",
    "CuPyArray": "cupy",
}


def planted(value: Any) -> list[Any] | None:
    """The tag and what belongs to it; None for what is no tensor."""
    torch = loaded("torch")
    if torch is not None and isinstance(value, torch.Tensor):
        out = io.BytesIO()
        torch.save(value, out)
        return ["PytorchTensor", b64encode(out.getvalue()).decode(), str(value.device)]
    tag = _TAGS.get(type(value).__module__.partition(".")[0])
    if tag is None:
        return None
    array = value.asnumpy() if hasattr(value, "asnumpy") else array_of(value)
    if array is None:
        return None
    found = [tag, b64encode(to_npy(array)).decode()]
    if tag == "CuPyArray":
        found.append(f"cuda:{value.device.id}")
    elif tag == "MXNetTensor":
        found.append(f"{value.context}".replace("gpu", "cuda").replace("(", ":").rstrip(")"))
    return found


def gathered(content: list[Any], options: dict[str, Any]) -> Any:
    """The tensor of a tag, where its library is loaded; None for everything else."""
    tag = content[0]
    library = loaded(_LIBRARIES.get(tag, ""))
    if library is None:
        return None
    if tag == "PytorchTensor":
        return _torch(library, content, options)
    if tag == "JAXTensor":
        return library.numpy.array(_array(content))
    if tag == "TensorflowTensor":
        return library.convert_to_tensor(_array(content))
    if tag == "CuPyArray":
        device = _device(content, options, "cupy") or "cuda:0"
        with library.cuda.Device(int(str(device).rpartition(":")[2])):
            return library.array(_array(content))
    name, _, number = str(_device(content, options, "mxnet") or "cpu:0").partition(":")
    place = library.context.Context(name.replace("cuda", "gpu"), int(number or 0))
    return library.nd.array(_array(content), ctx=place)


def _array(content: list[Any]) -> Any:
    return untag({"__wrapyfi__": content})


def _device(content: list[Any], options: dict[str, Any], library: str) -> Any:
    """The device that a listener wants for what comes from the sender's."""
    known = options.get(f"map_{library}_devices") or {}
    default = options.get(f"load_{library}_device")
    said = content[2] if len(content) > 2 else ""
    return known.get(said, default if default is not None else known.get("default"))


def _torch(torch: Any, content: list[Any], options: dict[str, Any]) -> Any:
    found = read(b64decode(content[1], validate=True))
    array = found.array
    repeated = tuple(slice(1) if step == 0 else slice(None) for step in array.strides)
    once = array if array.flags.writeable else array[repeated]
    if array.size:  # torch and numpy may be of versions that do not know each other
        numbers = torch.frombuffer(bytearray(once.tobytes()), dtype=getattr(torch, found.kind))
        tensor = numbers.reshape(once.shape).expand(array.shape)
    else:
        tensor = torch.empty(array.shape, dtype=getattr(torch, found.kind))
    device = _device(content, options, "torch")
    if device is not None:
        tensor = tensor.to(device)
    return tensor.requires_grad_() if found.grad else tensor
