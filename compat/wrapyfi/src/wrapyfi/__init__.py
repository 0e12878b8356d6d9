"""https://github.com/modular-ml/wrapyfi"""

from __future__ import annotations

# The first line is what programs print as `wrapyfi.__doc__`: where the documentation is.

name = "wrapyfi"
__version__ = "0.5.0"
__url__ = "https://github.com/modular-ml/wrapyfi"
