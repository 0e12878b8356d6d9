from support.board import Controllers, FakeBoard
from support.table import for_each

from yarpy.kits.devices.control_board import grammar
from yarpy.kits.devices.control_board.grammar import (
    CALIBRATOR,
    INTERFACES,
    PID,
    QUITTING,
    Row,
    lookup,
    usage,
)
from yarpy.kits.devices.control_board.interface import ControlBoardLike, PidController
from yarpy.kits.devices.control_board.newer import NewerMembers

MEMBERS = {*vars(ControlBoardLike), *ControlBoardLike.__annotations__, "axis_names", "encoders"}
ROWS = [row for i in INTERFACES.values() for row in (*i.get, *i.set)]


@for_each(ROWS)
def test_rows_name_members_of_the_interface(row: Row):
    assert row.member in MEMBERS
    assert row.words()
    assert all(len(text) <= 4 for text in row.words())


def test_rows_of_controllers():
    members = {*vars(PidController), *PidController.__annotations__}
    newer = {"details"}  # of YARP 4 alone
    assert {row.member for row in (*PID.get, *PID.set)} | newer == {
        name for name in members if not name.startswith("_")
    }
    assert all(hasattr(Controllers(1), row.member) for row in (*PID.get, *PID.set))


def test_every_member_can_be_reached():
    """But for times, which travel as envelopes, what is only streamed or measured, and what came
    with YARP 4 (`newer`)."""
    reached = {row.member for row in ROWS} | {name for name, _ in CALIBRATOR.values()}
    reached |= {*QUITTING.values(), "calibrate_joint", "calibration_done", "pids", "variables"}
    streamed = {"position_direct", "apply_currents", "apply_duty_cycles", "timestamps"}
    newer = {name for name in vars(NewerMembers) if not name.startswith("_")}
    assert newer >= {"braked", "velocity_direct"}
    assert {name for name in MEMBERS if not name.startswith("_")} - reached == streamed | newer


def test_the_full_board_of_the_tests_has_everything():
    targets = {name for name in MEMBERS if name.endswith("_targets")}  # remembered by the server
    public = {name for name in MEMBERS if not name.startswith("_")}
    assert {name for name in public if not hasattr(FakeBoard(), name)} == {
        *targets,
        "relative_move",
    }


def test_words_are_unique():
    for interface in (*INTERFACES.values(), PID):
        for rows in (interface.get, interface.set):
            words = [word for row in rows for word in row.words()]
            assert len(words) == len(set(words)) == len(lookup(rows))


def test_usage_lists_every_request():
    requests = dict(usage())
    assert requests["[get] [axes]"] == "number of joints"
    assert requests["[set] [pos] joint value"] == "position move"
    assert requests["[set] [posg] count (joints) (values)"] == "position move"
    assert requests["[set] [llim] joint lowest highest"] == "position limits"
    assert requests["[set] [stos]"] == "stop"
    assert requests["[get] [pid] [err] pos|vel|trq|cur joint"] == "errors"
    words = sum(len(lookup(rows)) for i in (*INTERFACES.values(), PID) for rows in (i.get, i.set))
    assert len(requests) == words + 4
    assert grammar.VERSION == (1, 9, 0)
