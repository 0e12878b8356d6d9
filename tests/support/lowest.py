"""What `make lowest` installs: of each library that yarpy needs the oldest version it may have.

python tests/support/lowest.py      a line of names and versions, as pip takes them
"""

import tomllib
from pathlib import Path

PROJECT = Path(__file__).parents[2] / "pyproject.toml"


def main() -> None:
    needed = tomllib.loads(PROJECT.read_text(encoding="utf-8"))["project"]["dependencies"]
    print(*(one.replace(">=", "==") for one in needed))


if __name__ == "__main__":
    main()
