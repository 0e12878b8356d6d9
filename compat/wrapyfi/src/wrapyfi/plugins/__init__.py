"""Types of other libraries as values: the plug-ins of Wrapyfi, under its names and tags.

    from wrapyfi.plugins.pandas_data import PandasData       # as there; nobody has to

Rules: one is loaded by itself when a value of its library is sent, or when a value with its tag
comes and its library is installed. What is sent here is read by the original. What the original
sends as a pickle is not read; ours carries the same once more in a form that runs nothing.
"""
