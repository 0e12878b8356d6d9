"""What programs send, one small round."""

import subprocess
import sys
from pathlib import Path

BENCH = Path(__file__).parents[2] / "bench" / "values.py"


def test_every_type_and_the_dict_have_a_row() -> None:
    command = [sys.executable, str(BENCH), "--bytes", "20000", "--rounds", "1", "--count", "2"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=100)
    assert done.returncode == 0, done.stderr
    rows = [line.split("|")[1].strip() for line in done.stdout.splitlines() if line[:1] == "|"]
    for title in ("Image", "bytes", "bool 1-D", "uint8 1-D", "complex64 3-D", "float16 2-D"):
        assert title in rows, done.stdout
    assert {"dict of them", "the dict by pickle", "dict of dicts", "list of them"} <= set(rows)
