"""Findings about names; test_examination.py has the faults."""

import os

from support.doctor import answering, made_up

from yarpy.contact import Contact
from yarpy.kits.doctor.name import find
from yarpy.network.traffic import PortState


def test_a_program_that_lives_and_listens_no_more() -> None:
    here = PortState("/a", Contact("tcp", "/a", "127.0.0.1", 1), "refused")
    case = made_up(ports=(here, answering("/b")))
    case.property_of = lambda name, key: [str(os.getpid())]  # type: ignore[method-assign]
    [finding] = find(case)
    assert finding.probe == "dead-name"
    assert f"(process {os.getpid()}) lives" in finding.verdict


def test_of_another_computer_no_process_is_looked_at() -> None:
    away = PortState("/a", Contact("tcp", "/a", "192.0.2.1", 1), "refused")
    case = made_up(ports=(away,), wanted=())
    [finding] = find(case)
    assert "process" not in finding.verdict
