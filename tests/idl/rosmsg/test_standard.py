"""The types that yarpy brings: each is read, and needs none but the others."""

import pytest

from yarpy.idl.rosmsg.catalogue import Catalogue
from yarpy.idl.rosmsg.source import Standard
from yarpy.idl.rosmsg.standard import MESSAGES, SERVICES


@pytest.mark.parametrize("name", MESSAGES)
def test_each_stands_alone(name: str) -> None:
    assert Catalogue([Standard()]).message(name).name == name


@pytest.mark.parametrize("name", SERVICES)
def test_so_do_services(name: str) -> None:
    assert Catalogue([Standard()]).service(name).name == name
