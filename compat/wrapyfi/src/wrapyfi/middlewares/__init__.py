"""Middlewares: each sends and takes in the forms of Wrapyfi 0.4 and 0.5."""
