"""Vocabs: as numbers, as words, in a Bottle."""

import yarp

for word in ("", "a", "ab", "abcd", "abcde", "ok", "fail", " ", "a b", "1", "ü", "A.", "[a]"):
    code = yarp.encode(word)
    print(repr(word), code, repr(yarp.decode(code)))
for code in (1, 32, 127, 0x616263, 0x61006263, 27503, 97):
    b = yarp.Bottle()
    b.addVocab(code)
    value = b.get(0)
    print(code, repr(yarp.decode(code)), repr(b.toString()), value.isVocab32(), value.asInt32())
    again = yarp.Bottle(b.toString())
    print(repr(value.asString()), repr(value.toString()), again.get(0).getCode())
for letters in (("a",), ("a", "b"), ("a", "b", "c", "d")):
    print(yarp.createVocab32(*letters), yarp.createVocab(*letters))
letters = (
    (113, 117, 105, 116),
    (97, 99, 107, 0),
    ("a", 0),
    ("a", -1),
    (-128,) * 4,
    ("", 97),
    (True,),
)
for some in letters:  # numbers of letters, as programs say that have ord("q")
    print(yarp.createVocab32(*some))
for wrong in (("a", 300), ("a", 1.5), ("ab", 0)):
    try:
        yarp.createVocab32(*wrong)
    except TypeError:
        print("TypeError")
