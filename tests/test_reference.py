"""The pages made from the code are those that the code of today makes."""

import pytest
from support import reference

import yarpy

pytestmark = pytest.mark.usefixtures("no_collector")
AGAIN = "docs are older than the code: python tests/support/reference.py"


def test_the_page_of_the_api_is_current() -> None:
    assert reference.API.read_text() == reference.api(), AGAIN


def test_it_has_every_public_name() -> None:
    page = reference.api()
    missing = [name for name in yarpy.__all__ if f"| `{name}" not in page]
    assert missing == ["__version__"]


def test_the_page_of_errors_is_current() -> None:
    """All but its messages to the letter. Those change with every week's work: one in twenty may be
    older, so that not every change of a word changes the page."""
    written, made = (
        text.splitlines() for text in (reference.ERRORS.read_text(), reference.errors())
    )
    assert [one for one in written if not one.startswith("- ")] == [
        one for one in made if not one.startswith("- ")
    ], AGAIN
    assert len({*written} ^ {*made}) < 0.05 * len(made), AGAIN


def test_every_error_says_what_mends_it() -> None:
    parts = reference.errors().split("\n## ")[1:]
    silent = [part.split("\n")[0] for part in parts if "**What mends it.**" not in part]
    assert silent == ["YarpError"]


def test_messages_are_found_wherever_they_are_made() -> None:
    page = reference.errors()
    assert (
        '- `"..." is in use by a port at ...: close that program, or choose another name`' in page
    )
    assert '- `no port "..." is registered`' in page
    assert page.count("\n- `") > 500
