"""XML with places: what is forgiven, and what is refused before it costs anything."""

import time
import tracemalloc

import pytest

from yarpy.kits.launch.document.element import BadFile, Element, parse
from yarpy.limit import APPLICATION_DEPTH, APPLICATION_ELEMENTS, APPLICATION_FILE


def read(text: str | bytes) -> Element:
    return parse(text.encode() if isinstance(text, str) else text, "a.xml")


def test_tags_texts_and_places() -> None:
    root = read('<a>\n  <b x="1 &amp; 2"> one <c/> two </b>\n  <b/>\n</a>')
    first, second = root.all("b")
    assert str(first.where) == "a.xml:2:3" and str(second.where) == "a.xml:3:3"
    assert first.attributes == {"x": "1 & 2"} and first.text == "one  two"
    assert [one.tag for one in first.children] == ["c"]


def test_places_count_letters() -> None:
    root = read("<a>\n\u00e9\u00e9<b/></a>")
    assert str(root.children[0].where) == "a.xml:2:3"


@pytest.mark.parametrize(
    "text",
    [
        "<a><!-- --no-x --><b>1 & 2</b></a>",
        "<?xml version='1.0' encoding='ISO-8859-1'?><a><b>1 & 2</b></a>",
        "\ufeff<?xml version='1.0'?><a><b>1 &amp; 2</b></a>",
        "<!DOCTYPE a SYSTEM 'http://nobody.invalid/a.dtd'><a><b>1 & 2</b></a>",
        "<a><b><![CDATA[1 & 2]]></b></a>",
    ],
)
def test_what_the_parser_of_cpp_forgives(text: str) -> None:
    assert next(read(text).all("b")).text == "1 & 2"


@pytest.mark.parametrize(
    ("text", "where", "why"),
    [
        ("", "a.xml:1:1", "no XML"),
        ("<a>\n <b></a>", "a.xml:2:7", "mismatched tag"),
        ("<a/>x", "a.xml:1:5", "junk"),
        (b"<a>\n\xff</a>", "a.xml:2:1", "not utf-8"),
        ("<?xml version='1.0' encoding='ebcdic'?><a/>", "a.xml:1", "ebcdic"),
        ("<a b='1' b='2'/>", "a.xml:1:10", "duplicate attribute"),
    ],
)
def test_what_is_no_xml(text: str | bytes, where: str, why: str) -> None:
    with pytest.raises(BadFile, match=why) as caught:
        read(text)
    assert str(caught.value.where) == where


LAUGHS = "".join(f"<!ENTITY l{n} '{f'&l{n - 1};' * 10}'>" for n in range(1, 10))


@pytest.mark.parametrize(
    ("text", "why"),
    [
        (f"<!DOCTYPE a [<!ENTITY l0 'ha'>{LAUGHS}]><a>&l9;</a>", "entities"),
        ("<!DOCTYPE a [<!ENTITY x SYSTEM 'file:///etc/passwd'>]><a>&x;</a>", "entities"),
        ("<!DOCTYPE a [<!ENTITY % x SYSTEM 'http://nobody.invalid/'>%x;]><a/>", "entities"),
        ("<a>" * (APPLICATION_DEPTH + 1), "deep"),
        ("<a>" + "<b/>" * APPLICATION_ELEMENTS, "tags"),
        ("<a>" + "x" * APPLICATION_FILE, "bytes"),
        ("<a><" + "b" * (10 << 20) + "/></a>", "bytes"),
    ],
)
def test_bombs(text: str, why: str) -> None:
    tracemalloc.start()
    try:
        with pytest.raises(BadFile, match=why):
            read(text)
        assert tracemalloc.get_traced_memory()[1] < 15 * len(text) + (32 << 20)
    finally:
        tracemalloc.stop()


def test_one_long_tag_takes_no_longer_than_its_length() -> None:
    size = APPLICATION_FILE // 8
    began = time.process_time()
    for count in (1, 4):
        tag = "b" * (count * size)
        assert read(f"<a><{tag}/></a>").children[0].tag == tag
    for text in ("<!--" * size, "&" * size, "<![CDATA[" * (size // 4)):
        with pytest.raises(BadFile):
            read(text)
    assert time.process_time() - began < 20
