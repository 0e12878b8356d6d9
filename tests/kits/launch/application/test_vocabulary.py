"""The words of yarpmanager's files."""

from yarpy.kits.launch.application import vocabulary


def test_words_are_told_once_and_in_lower_case() -> None:
    for words in (vocabulary.ROOT, vocabulary.MODULE, vocabulary.CONNECTION, vocabulary.NESTED):
        assert len({*words}) == len(words) and all(word == word.lower() for word in words)
    assert not {*vocabulary.USUAL} & {*vocabulary.MODULE}
