"""What a file says: values, compared as such."""

from yarpy.kits.thrift.file.document import Document, FieldText, Name, Pairs, TypeText


def test_values_compare() -> None:
    assert TypeText("list", (TypeText("i32"),)) == TypeText("list", (TypeText("i32"),))
    assert Name("A") != Name("B") and Pairs(((1, 2),)) == Pairs(((1, 2),))
    assert Document("a.thrift").declarations == ()
    assert FieldText("a", TypeText("i32")).default is None
