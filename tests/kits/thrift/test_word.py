"""Names that Python needs for itself."""

import keyword

from yarpy.kits.thrift.word import ENUM, MODULES, PYTHON, SERVICE, STRUCT, attribute, original


def test_there_and_back() -> None:
    for taken in (PYTHON, STRUCT, SERVICE, ENUM):
        for name in (*taken, *(f"{each}_" for each in taken), "x", "x_", "From"):
            if not name.startswith("_"):
                assert original(attribute(name, taken), taken) == name
            assert not keyword.iskeyword(attribute(name, taken))


def test_only_what_is_needed_is_changed() -> None:
    assert attribute("from") == "from_" and attribute("frame") == "frame"
    assert attribute("to_dict", STRUCT) == "to_dict_" and attribute("to_dict") == "to_dict"
    assert attribute("types", MODULES) == "types_" and attribute("camera", MODULES) == "camera"
    assert attribute("close", SERVICE) == "close_" and attribute("name", ENUM) == "name_"


def test_a_line_before_a_name_goes_behind_it() -> None:
    assert attribute("_enum") == attribute("__enum") == "enum_"
    assert attribute("_from") == "from_" and attribute("_to_dict", STRUCT) == "to_dict_"
