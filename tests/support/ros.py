"""ROS 1 as a peer: the system's own Python with rospy and the packages of messages, where Debian's
are installed.

Rules: a question is a small program that prints JSON; it runs in a process of its own, without our
environment. A test that asks declares the peer `ros`.
"""

import json
import subprocess
from functools import cache
from typing import Any

from support.peer import DEBIAN_PYTHON, demand

PYTHON = DEBIAN_PYTHON

_INSTALLED = """
import glob, os
found = {}
for path in sorted(glob.glob("/usr/share/*/msg/*.msg") + glob.glob("/usr/share/*/srv/*.srv")):
    package, kind, file = path.split("/")[-3:]
    name = package + "/" + file[:-4]
    load = roslib.message.get_message_class if kind == "msg" else roslib.message.get_service_class
    cls = load(name)
    if cls is None:
        continue
    halves = [cls] if kind == "msg" else [cls._request_class, cls._response_class]
    halves = [[half._md5sum, half._full_text, half.__slots__] for half in halves]
    found[kind + " " + name] = [cls._md5sum, halves]
answer = found
"""


def ask(program: str, given: Any = None) -> Any:
    """What a program of ROS's Python leaves in `answer`; it finds `given` in a variable."""
    demand("ros")
    code = f"import json, sys\nimport roslib.message\ngiven = json.load(sys.stdin)\n{program}\n"
    done = subprocess.run(
        [PYTHON, "-c", code + "json.dump(answer, sys.stdout)"],
        input=json.dumps(given),
        capture_output=True,
        text=True,
        timeout=60,
        env={"PATH": "/usr/bin:/bin"},
    )
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


@cache
def installed() -> dict[str, Any]:
    """`msg package/Type` or `srv ...` -> checksum; checksum, full text, fields of each half"""
    found: dict[str, Any] = ask(_INSTALLED)
    return found
