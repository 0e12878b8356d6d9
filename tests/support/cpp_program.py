"""A C++ YARP program that does what a test tells it, step by step.

    with CppProgram(cpp) as peer:                # one process, `import yarp` done
        peer.do("port = yarp.Port(); port.open('/p')")
        assert peer.do("port.getOutputCount()") == 0
        peer.begin("port.read(bottle)")          # blocks over there
        ...
        peer.end()                               # what it came to

Rules: variables stay from step to step. A step's last line, if it is an expression, is its value;
it comes back through JSON, so it must be numbers, strings, lists. What goes wrong over there is an
AssertionError here, with everything the program had said.
"""

import json
from types import TracebackType
from typing import Any, Self

from support.cpp import CppYarp
from support.wait import HANG

# Answers have standard output for themselves: what C++ prints there, whenever, goes to the other.
_LOOP = """
import ast, json, os, sys, time, traceback
answers = os.fdopen(os.dup(1), "w")
os.dup2(2, 1)
import yarp
yarp.Network.init()
space = {"yarp": yarp, "time": time}
def carry_out(source):
    tree = ast.parse(source)
    last = tree.body.pop() if tree.body and isinstance(tree.body[-1], ast.Expr) else None
    exec(compile(tree, "step", "exec"), space)
    if last is not None:
        return eval(compile(ast.Expression(last.value), "step", "eval"), space)
for line in sys.stdin:
    try:
        answer = json.dumps(["done", carry_out(json.loads(line))])
    except BaseException:
        answer = json.dumps(["failed", traceback.format_exc()])
    print(answer, file=answers, flush=True)
"""


class CppProgram:
    """One process with the C++ binding. A context manager that ends it."""

    def __init__(self, cpp: CppYarp) -> None:
        self.process = cpp.python_popen(_LOOP)
        self._steps = 0

    def do(self, code: str, timeout: float = HANG) -> Any:
        """Carry out the lines of `code`; the value of the last one."""
        self.begin(code)
        return self.end(timeout)

    def begin(self, code: str) -> None:
        """As `do`, without waiting; `end` has to follow."""
        self._steps += 1
        self.process.write_line(json.dumps(code))

    def end(self, timeout: float = HANG) -> Any:
        """The value of the step that was begun."""
        answer = self.process.wait_line("", timeout=timeout, count=self._steps, stream="out")
        state, value = json.loads(answer.string)
        said = "\n".join(self.process.stderr.splitlines()[-20:])
        assert state == "done", f"{value}\nafter it had said:\n{said}"
        return value

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.process.stop(grace=0)
