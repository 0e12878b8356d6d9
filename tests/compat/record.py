"""Writes what C++ YARP prints for each script of `scripts` to `expected`.

python tests/compat/record.py [NAME...]
"""

import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE.parent))

from support.cpp import CppYarp  # noqa: E402
from support.port import free_block  # noqa: E402

with tempfile.TemporaryDirectory() as home:
    cpp = CppYarp.prepare(Path(home))
    for script in sorted((HERE / "scripts").glob("*.py")):
        if sys.argv[1:] and script.stem not in sys.argv[1:]:
            continue
        done = subprocess.run(
            [cpp.interpreter, HERE / "runner.py", script],
            env={**cpp.environment, "YARP_PORT_RANGE": str(free_block(200))},
            capture_output=True,
            text=True,
            timeout=30,
        )
        if done.returncode:
            sys.exit(f"{script.name} fails:\n{done.stderr}")
        (HERE / "expected" / f"{script.stem}.txt").write_text(done.stdout)
        print(script.stem, len(done.stdout.splitlines()), "lines")
