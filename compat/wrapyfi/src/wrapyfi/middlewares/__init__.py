"""Middlewares: each sends and takes in the forms of Wrapyfi 0.4 and 0.5."""

from __future__ import annotations

# It registers all of them, in an order in which none is imported while it is imported: so a program
# may name a middleware before anything else of the package.
import wrapyfi.connect  # noqa: F401
