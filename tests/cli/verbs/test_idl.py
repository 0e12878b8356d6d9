"""`yarpy idl`: the languages of types are found by name."""

from yarpy.registry import idl_commands


def test_languages_are_listed_and_explained(here):
    said = here("idl", "--help")
    assert said.code == 0
    assert idl_commands.names()
    for language in idl_commands.names():
        assert f"  {language} " in said.out
        assert here("idl", language, "--help").out.startswith(f"Usage: yarpy idl {language} ")


def test_an_unknown_language(here):
    said = here("idl", "klingon")
    assert said.code == 1 and "klingon" in said.err
