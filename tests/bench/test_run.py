"""The benchmark program runs and its arithmetic is right; how fast anything is, is not tested."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

BENCH = Path(__file__).resolve().parents[2] / "bench"
sys.path.insert(0, str(BENCH))

import report  # noqa: E402
from workload import GOALS, WORKLOADS, Goal  # noqa: E402


def rounds(*samples: list[int]) -> list[report.Measurement]:
    return [report.Measurement(one) for one in samples]


def test_quantile_is_a_value_that_occurred() -> None:
    hundred = list(range(1, 101))
    assert report.quantile(hundred, 0.99) == 99
    assert report.quantile(hundred, 0.5) == 50
    assert report.quantile(hundred, 1.0) == 100
    assert report.quantile([7], 0.01) == 7


def test_ratio_pairs_the_rounds() -> None:
    # The machine was twice as slow in the second round and disturbed one peer in the third.
    mine = rounds([10, 11, 12], [22, 22, 22], [900, 900, 900])
    other = rounds([11, 11, 11], [22, 22, 22], [11, 11, 11])
    assert report.ratio(mine, other) == 1.0


@pytest.mark.parametrize(
    ("workload", "mine", "reached"),
    [("stream", 74, True), ("stream", 76, False), ("flood", 501, True), ("flood", 499, False)],
)
def test_goals_know_which_way_is_better(workload: str, mine: int, reached: bool) -> None:
    factor = 5.0 if WORKLOADS[workload].more_is_better else 0.75
    goal = Goal(workload, "a", "b", factor)
    [outcome] = report.outcomes({workload: {"a": rounds([mine]), "b": rounds([100])}}, [goal])
    assert (outcome.measured, outcome.reached) == (mine / 100, reached)
    assert not list(report.outcomes({workload: {"a": rounds([mine])}}, [goal]))


def test_processor_time_counts_by_itself() -> None:
    mine, other = ([report.Measurement([1.0], ran)] for ran in (30.0, 20.0))
    goal = Goal("flood", "a", "b", 1.0, processor=True)
    [outcome] = report.outcomes({"flood": {"a": mine, "b": other}}, [goal])
    assert (outcome.measured, outcome.reached) == (1.5, False)
    assert goal.title == "a / b, processor time"
    unknown = {"flood": {"a": mine, "b": rounds([1])}}
    assert not list(report.outcomes(unknown, [goal]))


def test_goals_count_in_each_placement() -> None:
    measured = {"a": rounds([1]), "b": rounds([2])}
    results = {"stream": measured, "stream-1-core": measured, "rpc": measured}
    found = report.outcomes(results, [Goal("stream", "a", "b", 1.0)])
    assert [outcome.workload for outcome in found] == ["stream", "stream-1-core"]


def test_goals_name_what_exists() -> None:
    assert {goal.function for goal in GOALS} <= {one.function for one in WORKLOADS.values()}


def test_a_quick_run_prints_a_table_and_writes_json(tmp_path: Path) -> None:
    options = ["--quick", "--rounds", "1", "--peers", "raw", "--output", str(tmp_path)]
    answer = subprocess.run(
        [sys.executable, str(BENCH / "run.py"), *options, "--workloads", "stream", "flood"],
        capture_output=True,
        text=True,
        timeout=50,
    )
    assert answer.returncode == 0, answer.stderr
    assert "not measured" not in answer.stdout
    [written] = tmp_path.glob("*.json")
    document = json.loads(written.read_text())
    assert document["workloads"]["stream"]["peers"]["raw"]["samples"] == 800
    assert document["workloads"]["stream"]["peers"]["raw"]["processor"] > 0
    assert document["workloads"]["flood"]["peers"]["raw"]["median"] > 0
    assert document["machine"]["cores"] >= 1
