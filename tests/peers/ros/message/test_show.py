"""Types as rosmsg and rossrv show them."""

import pytest
from support import ros

from yarpy.peers.ros.message.catalogue import Catalogue
from yarpy.peers.ros.message.library import Library, Service
from yarpy.peers.ros.message.show import MAX_LINES, show
from yarpy.peers.ros.message.source import Texts


def test_constants_fields_and_what_is_in_them(library: Library) -> None:
    text = show(library.message("sensor_msgs/PointCloud2")._definition)
    assert text.startswith(
        "std_msgs/Header header\n  uint32 seq\n  time stamp\n  string frame_id\n"
    )
    assert "sensor_msgs/PointField[] fields\n  uint8 INT8=1\n" in text
    assert text.endswith("bool is_dense")


def test_services_have_two_halves(library: Library) -> None:
    add = library.service_of("p/Add", "int64 a\nint64 b\n---\nint64 sum")
    assert isinstance(add, Service)
    assert show(add.definition) == "int64 a\nint64 b\n---\nint64 sum"


@pytest.mark.peer("ros")
def test_it_is_what_ros_shows() -> None:
    """For every installed type, with the function behind `rosmsg show` and `rossrv show`."""
    program = """
import genmsg, rosmsg
answer = {}
for key in given:
    kind, name = key.split()
    places = {each.split("/")[0]: ["/usr/share/%s/msg" % each.split("/")[0]] for _, each in
              (other.split() for other in given)}
    context = genmsg.MsgContext.create_default()
    if kind == "msg":
        spec = genmsg.load_msg_by_type(context, name, places)
        genmsg.load_depends(context, spec, places)
        answer[key] = rosmsg.spec_to_str(context, spec)
    else:
        services = {package: [path[0][:-3] + "srv"] for package, path in places.items()}
        spec = genmsg.load_srv_by_type(context, name, services)
        genmsg.load_depends(context, spec, places)
        halves = [rosmsg.spec_to_str(context, half) for half in (spec.request, spec.response)]
        answer[key] = "---\\n".join(halves)
"""
    found = Catalogue()
    for key, text in ros.ask(program, [*ros.installed()]).items():
        kind, name = key.split()
        definition = found.message(name) if kind == "msg" else found.service(name)
        assert (name, show(definition).strip()) == (name, text.strip())


def test_long_listings_end() -> None:
    doubling = {f"p/A{n}": f"A{n + 1}[] x\nA{n + 1}[] y" for n in range(40)}
    found = Catalogue([Texts({**doubling, "p/A40": "int8 x"}, "a test")])
    lines = show(found.message("p/A0")).split("\n")
    assert (len(lines), lines[-1]) == (MAX_LINES + 1, "...")
