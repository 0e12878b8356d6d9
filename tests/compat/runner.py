"""Runs a script; what it prints goes to standard output, what its libraries print to the other one.

    python runner.py SCRIPT

It ends without tidying up, since the C++ binding may crash in that. Runs under CPython 3.10, too.
"""

import os
import sys
import traceback

out = os.fdopen(os.dup(1), "w")
os.dup2(2, 1)


def say(*words):
    print(*words, file=out, flush=True)


path = sys.argv[1]
code = 0
try:
    with open(path, encoding="utf-8") as file:
        exec(compile(file.read(), path, "exec"), {"__name__": "__main__", "print": say})
except BaseException:
    traceback.print_exc()
    code = 1
out.flush()
os._exit(code)
