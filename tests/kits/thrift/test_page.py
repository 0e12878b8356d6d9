"""The page of a service: what its forms send is what the methods take."""

import re
from html import unescape
from types import ModuleType
from typing import Any

from support.thrift import reply

from yarpy.carriers.web.http.argument import substitute
from yarpy.kits.thrift.library import loads
from yarpy.kits.thrift.page import page


def sent(text: str, method: str, **values: str) -> str:
    """What the form of a method sends, with its inputs as they are or as given by label."""
    form = re.search(rf'<form [^>]*id="{method}">.*?</form>', text, re.S)
    assert form is not None
    data = re.search(r'name="data" value="([^"]*)"', form[0])
    assert data is not None
    fields = {}
    for name, label, value in re.findall(
        r'<input name="(a\d+)" [^>]*aria-label="([^"]*)" size="12" value="([^"]*)"', form[0]
    ):
        fields[name] = values.get(label.replace(".", "_"), unescape(value))
    for name, label, options in re.findall(
        r'<select name="(a\d+)" aria-label="([^"]*)">(.*?)</select>', form[0]
    ):
        chosen = re.search(r'value="([^"]*)" selected', options)
        fields[name] = values.get(label.replace(".", "_"), chosen[1] if chosen else "")
    return substitute(unescape(data[1]), fields)


def test_forms_send_what_methods_take(capt: ModuleType, server: Any) -> None:
    text = page(server)
    assert text.count("<form") == len(capt.Capt._methods)
    assert "Adds two numbers." in text
    for method, values, expected in (
        ("add", {"a": "1", "b": "2"}, "3"),
        ("r_string", {"v": "two words"}, '"two words"'),
        ("r_string", {"v": 'a "b" \\c'}, r'"a \"b\" \\c"'),
        ("r_bool", {"v": "1"}, "[ok]"),
        ("r_enum", {"v": "7"}, "7"),
        ("r_struct", {"v_x": "4", "v_y": "5"}, "4 5"),
        ("r_lint", {"v": "1 2 3"}, "(1 2 3)"),
        ("r_llist", {"v": "(1 2) (3)"}, "((1 2) (3))"),
        ("r_mint", {"v": "(a 1) (b 2)"}, "((a 1) (b 2))"),
        ("tail_defaults", {"first": "1"}, '"1 2 5 def word"'),
        ("check_defaults", {}, "[ok]"),
        ("nothing", {}, ""),
        ("r_prims", {"v_s": "x", "v_raw": "{1 2}"}, "[fail] 0 0 0 0 0.0 x {1 2} 1"),
    ):
        assert reply(server, sent(text, method, **values)) == expected, method


def test_defaults_are_there_and_names_escaped() -> None:
    made = loads(
        "/** <b> */ service S { /** <script> */ void f(1: list<double> v = [1.5, 2], "
        '2: string s = "<&>", 3: bool b = true) }',
        "s",
    )
    text = page(made.S())
    assert sent(text, "f") == 'f (1.5 2.0) "<&>" 1'
    assert "<script>" not in text and "&lt;script&gt;" in text and "<b>" not in text


def test_large_structs_are_one_input() -> None:
    fields = ", ".join(f"i32 f{number}" for number in range(60))
    made = loads(f"struct L {{ {fields} }}\nservice S {{ void f(1: L l) }}", "s")
    assert page(made.S()).count('aria-label="l"') == 1
