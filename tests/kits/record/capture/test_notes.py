"""Notes of a recording, and those from before it begins."""

from yarpy.kits.record.capture.notes import Notes


def test_notes_in_their_order() -> None:
    notes = Notes(iter((10, 20)).__next__, begun=True)
    notes.add("connected", port="/x")
    notes.add("mark", 5, text="it fell")
    expected = [
        ({"what": "connected", "port": "/x"}, 10),
        ({"what": "mark", "text": "it fell"}, 15),
    ]
    assert [*notes.take()] == expected and not [*notes.take()]


def test_what_was_noted_before_the_beginning_has_its_time() -> None:
    notes = Notes(iter((100, 200)).__next__, begun=False)
    notes.add("connected")
    notes.add("resume")
    assert not [*notes.take()]
    notes.begin()
    notes.begin()
    notes.add("pause")
    assert [(what["what"], time) for what, time in notes.take()] == [
        ("connected", 100),
        ("resume", 100),
        ("pause", 200),
    ]
