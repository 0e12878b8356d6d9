"""The states of managed nodes: each way, and where it leads."""

import pytest

from yarpy.peers.ros2.node.state import ASKED, GRAPH, Outcome, State, available, end_of, find

S = State


@pytest.mark.parametrize(
    ("state", "labels"),
    [
        (S.UNCONFIGURED, ["configure", "shutdown"]),
        (S.INACTIVE, ["cleanup", "activate", "shutdown"]),
        (S.ACTIVE, ["deactivate", "shutdown"]),
        (S.FINALIZED, []),
        (S.CONFIGURING, []),
    ],
)
def test_what_may_be_asked_for(state: State, labels: list[str]) -> None:
    assert [item.label for item in available(state)] == labels


@pytest.mark.parametrize(
    ("label", "start", "ends"),
    [
        ("configure", S.UNCONFIGURED, [S.INACTIVE, S.UNCONFIGURED, S.ERRORPROCESSING]),
        ("cleanup", S.INACTIVE, [S.UNCONFIGURED, S.INACTIVE, S.ERRORPROCESSING]),
        ("activate", S.INACTIVE, [S.ACTIVE, S.INACTIVE, S.ERRORPROCESSING]),
        ("deactivate", S.ACTIVE, [S.INACTIVE, S.ACTIVE, S.ERRORPROCESSING]),
        ("shutdown", S.ACTIVE, [S.FINALIZED, S.FINALIZED, S.ERRORPROCESSING]),
    ],
)
def test_where_it_leads(label: str, start: State, ends: list[State]) -> None:
    way = find(start, 0, label)
    assert way is not None and way == find(start, way.id)
    assert [end_of(way.goal, outcome).goal for outcome in Outcome] == ends


def test_what_leads_nowhere() -> None:
    assert find(S.ACTIVE, 1) is None
    assert find(S.ACTIVE, 7, "configure") is None  # a label counts before a number
    assert [end_of(S.ERRORPROCESSING, item).goal for item in Outcome] == [
        S.UNCONFIGURED,
        S.FINALIZED,
        S.FINALIZED,
    ]


def test_numbers_are_those_of_lifecycle_msgs() -> None:
    assert [item.id for item in GRAPH] == [
        *range(1, 8),
        *(first + outcome for first in range(10, 61, 10) for outcome in range(3)),
    ]
    assert len({item.id for item in GRAPH}) == len(ASKED) + 18
    assert S.ERRORPROCESSING.label == "errorprocessing"
