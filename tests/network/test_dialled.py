"""Addresses for names: `/host:port/` is the port that is registered there."""

from __future__ import annotations

import doctest

import pytest

from yarpy.contact import Contact
from yarpy.network import dialled
from yarpy.network.dialled import address_in, leads_to


def test_examples_in_the_docstrings() -> None:
    assert doctest.testmod(dialled).attempted > 0
    assert doctest.testmod(dialled).failed == 0


@pytest.mark.parametrize("name", ["/a", "/a:b", "/tcp://h:1/a", "/10.0.0.1:99999/", "", "/:1/"])
def test_names_are_no_addresses(name: str) -> None:
    assert address_in(name) is None


@pytest.mark.parametrize(
    ("dialled", "registered", "host", "leads"),
    [
        ("10.0.0.1", "10.0.0.1", "10.0.0.9", True),
        ("10.0.0.1", "10.0.0.2", "10.0.0.1", False),
        ("::ffff:10.0.0.1", "10.0.0.1", "", True),
        ("127.0.0.1", "10.0.0.1", "10.0.0.1", True),
        ("127.0.0.1", "10.0.0.1", "10.0.0.9", False),
        ("localhost", "127.0.0.1", "127.0.0.1", True),
        ("10.0.0.1", "127.0.0.1", "10.0.0.1", False),
    ],
)
def test_the_loopback_is_that_of_who_dialled(
    dialled: str, registered: str, host: str, leads: bool
) -> None:
    here, there = Contact("tcp", "", dialled, 5), Contact("tcp", "/a", registered, 5)
    assert leads_to(here, there, host) == leads
    assert not leads_to(here, Contact("tcp", "/a", registered, 6), host)
