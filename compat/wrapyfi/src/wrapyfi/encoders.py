"""Where the encoders were up to 0.4."""

from __future__ import annotations

from wrapyfi.utils.serialization_encoders import JsonDecodeHook, JsonEncoder

__all__ = ["JsonDecodeHook", "JsonEncoder"]
