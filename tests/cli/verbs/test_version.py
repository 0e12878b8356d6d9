"""`yarpy version`."""

from support.build import COMPILED

import yarpy


def test_version(cli):
    said = cli.run("version")
    assert (said.returncode, said.stdout) == (
        0,
        f"yarpy version {yarpy.__version__} ({'compiled core' if COMPILED else 'pure Python'})\n",
    )
