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
