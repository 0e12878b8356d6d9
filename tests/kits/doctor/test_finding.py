"""What the doctor found."""

from yarpy.kits.doctor.finding import LEVELS, Finding


def test_findings_alike_are_one() -> None:
    one = Finding("loose-cable", "/a -> /b", "the cable is loose", "push it in")
    assert one.level == LEVELS[0] == "fault"
    assert len({one, Finding("loose-cable", "/a -> /b", "the cable is loose", "push it in")}) == 1
