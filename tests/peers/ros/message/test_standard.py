"""The types that yarpy brings: each is read, needs none but the others, and is the one of ROS."""

from pathlib import Path

from support.table import for_each

from yarpy.peers.ros.message.catalogue import Catalogue
from yarpy.peers.ros.message.source import Packages, Rosbags, Standard

OWN = Catalogue([Standard()])
DEBIAN = Packages((), [Path("/usr/share")])


@for_each(Standard.messages)
def test_each_stands_alone(name: str) -> None:
    assert OWN.message(name).name == name


@for_each(Standard.services)
def test_so_do_services(name: str) -> None:
    assert OWN.service(name).name == name


@for_each(Standard.messages)
def test_each_is_that_of_ros(name: str) -> None:
    """Where a package or rosbags has it, too; the sum of its definition says so."""
    for theirs in (DEBIAN, Rosbags()):
        if theirs.find(name, "msg") is not None:
            expected = Catalogue([theirs, DEBIAN, Rosbags()]).message(name).md5sum
            assert OWN.message(name).md5sum == expected, theirs


@for_each(Standard.services)
def test_so_is_each_service(name: str) -> None:
    if DEBIAN.find(name, "srv") is not None:
        assert OWN.service(name).md5sum == Catalogue([DEBIAN]).service(name).md5sum
