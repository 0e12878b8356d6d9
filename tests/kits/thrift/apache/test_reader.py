"""What is not known is left out, in both protocols, by what Apache's library writes."""

import pytest
from support.thrift_module import ROWS, data

from yarpy.errors import DecodeError
from yarpy.kits.thrift.apache.decode import READERS


@pytest.mark.parametrize("protocol", READERS)
@pytest.mark.parametrize("name", ROWS)
def test_a_struct_can_be_left_out(name: str, protocol: str) -> None:
    reader = READERS[protocol](data(name, protocol))
    reader.head()
    reader.skip(12)
    assert reader.left == 0


@pytest.mark.parametrize("protocol", READERS)
def test_no_type_of_thrift(protocol: str) -> None:
    with pytest.raises(DecodeError, match="99 is no type of Thrift"):
        READERS[protocol](bytes(10)).skip(99)
