"""Digest and basic: the examples of the RFCs, what is chosen, and cameras that mean no good."""

from __future__ import annotations

import re
from base64 import b64decode

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.steps import measured

from yarpy.carriers.web.http.login import Challenge, Login, parse_challenges, refusal, take_login
from yarpy.errors import LocalProtocolError, LoginRefused, RemoteProtocolError, YarpError
from yarpy.limit import HTTP_CHALLENGE_VALUE, HTTP_CHALLENGES
from yarpy.route import Route

NEW = (
    'Digest realm="http-auth@example.org", qop="auth, auth-int", algorithm=%s, '
    'nonce="7ypf/xlj9XXwfDPEoM4URrv/xwf94BcCAzFZH4GiTo0v", '
    'opaque="FQhe/qaU925kfnzjCev0ciny7QMkPqMAFRtzCUYo5tdS"'
)
NEW_CNONCE = b"f2/wE4q74E6zIJEtWaHKaf5wv/H5QzzpXusqGemxURZJ"
OLD = (
    'Digest realm="testrealm@host.com", nonce="dcd98b7102dd2f0e8b11d0f600bfb0c093", '
    'opaque="5ccc069c403ebaf9f0171e9517f40e41"'
)
SHA = b"753927fa0e85d155564e2e272a28d1802ca10daf4496794697cf8db5856cb6c1"

EXAMPLES = {
    # challenge, password, our random text, response
    "RFC 7616, SHA-256": (NEW % "SHA-256", b"Circle of Life", NEW_CNONCE, SHA),
    "RFC 7616, MD5": (
        NEW % "MD5",
        b"Circle of Life",
        NEW_CNONCE,
        b"8ca523f5e9506fed4657c9700eebdbec",
    ),
    "RFC 2617": (
        OLD + ', qop="auth,auth-int"',
        b"Circle Of Life",
        b"0a4f113b",
        b"6629fae49393a05397450978507c4ef1",
    ),
    "RFC 2069, as corrected": (OLD, b"CircleOfLife", b"", b"1949323746fe6a43ef61f9606e7febea"),
}


def fields(answer: bytes) -> dict[str, str]:
    """The parameters of an answer, which is a challenge in reverse."""
    (found,) = parse_challenges(answer.decode("latin-1"))
    assert found.scheme == "digest"
    return found.values


@pytest.mark.parametrize("example", EXAMPLES)
def test_examples(example: str) -> None:
    challenge, password, cnonce, response = EXAMPLES[example]
    (found,) = parse_challenges(challenge)
    answer = Login(b"Mufasa", password).digest(found, b"/dir/index.html", cnonce)
    said = fields(answer)
    assert said["response"] == response.decode()
    assert (said["username"], said["uri"]) == ("Mufasa", "/dir/index.html")
    for key in ("realm", "nonce", "opaque"):
        assert said[key] == found.values[key]
    with_qop = {"qop": "auth", "nc": "00000001", "cnonce": cnonce.decode()}
    assert with_qop.items() <= said.items() if cnonce else not with_qop.keys() & said.keys()
    # What the RFC says stands without quotes, or with.
    assert b"qop=auth," in answer or not cnonce
    assert b'nonce="' in answer


def test_sessions() -> None:
    """No RFC has an example: A1 as RFC 7616 section 3.4.2 puts it together, hashed beside."""
    from hashlib import md5

    def h(text: str) -> str:
        return md5(text.encode()).hexdigest()

    login = Login(b"u", b"p")
    secret = h(h("u:r:p") + ":n:c")
    for qop, middle in (("", "n"), ("auth", "n:00000001:c:auth")):
        challenge = Challenge(
            "digest", {"realm": "r", "nonce": "n", "algorithm": "md5-SESS", "qop": qop}
        )
        said = fields(login.digest(challenge, b"/x", b"c"))
        assert said["response"] == h(f"{secret}:{middle}:{h('GET:/x')}")
        assert said["algorithm"] == "md5-SESS"  # as the camera spelled it
        assert said["cnonce"] == "c"  # without it nobody could check


OFFERS = [
    # what comes, what is chosen
    (['Digest nonce="a", algorithm=MD5', 'Digest nonce="b", algorithm=SHA-256'], "b"),
    (['Digest nonce="b", algorithm=SHA-256, Digest nonce="a", algorithm=MD5'], "b"),
    (['Basic realm="x"', 'Digest nonce="a"'], "a"),
    (['Digest nonce="a", algorithm=SHA-512-256', 'Digest nonce="b"'], "b"),
    (['Digest nonce="a", algorithm=sha-256-sess', 'Digest nonce="b", algorithm="SHA-256"'], "a"),
    (['Digest nonce="a", algorithm=SHA-256, qop="auth-int"', "digest nonce=b,qop=auth"], "b"),
    (['NTLM, Negotiate abc==, Digest nonce="a b", realm="x, Basic y=\\"z\\""', "Bearer"], "a b"),
    ([' ,, Digest\tNONCE = "a" , , realm="x"'], "a"),
    (['Digest nonce="a"', "Digest"], "a"),
    (["Basic"], ""),
    (["NTLM", "Basic realm=x"], ""),
    ([""], ""),
]


@pytest.mark.parametrize(("lines", "nonce"), OFFERS)
def test_strongest_digest_is_chosen(lines: list[str], nonce: str) -> None:
    login = Login("jü".encode(), b"p:a")
    answer = login.answer(", ".join(lines), b"/x")
    if nonce:
        assert fields(answer)["nonce"] == nonce
        assert b"p:a" not in answer
    else:
        assert b64decode(answer.removeprefix(b"Basic ")) == "jü:p:a".encode()


@pytest.mark.parametrize(
    ("wanted", "words"),
    [
        ('Digest nonce="a", algorithm=SHA-512-256', "digest authentication with SHA-512-256,"),
        ('Digest nonce="a", algorithm=X, Basic realm="y"', "with X, which yarpy does not support"),
        ('Digest nonce="a", qop="auth-int"', "with MD5 and auth-int"),
        ('Negotiate, NTLM realm="x"', "negotiate authentication"),
        ("\x1b[2J" + "x" * 999, "wants [2jx"),
    ],
)
def test_what_is_not_spoken_is_told(wanted: str, words: str) -> None:
    """The password does not go in clear to a camera that knows better."""
    with pytest.raises(LoginRefused, match="configure the camera for digest") as caught:
        Login(b"u", b"secret").answer(wanted, b"/")
    assert words in str(caught.value)
    assert str(caught.value).isprintable()
    assert len(str(caught.value)) < 300


def test_answers_differ() -> None:
    answers = {Login(b"u", b"p").answer('Digest nonce="n", qop="auth"', b"/") for _ in range(5)}
    assert len(answers) == 5


def test_what_is_quoted_stays_one_value() -> None:
    """Quotes, backslashes and bytes beyond ASCII in everything, as UTF-8 on the wire."""
    user = 'me"\\, x="1 ü'
    wanted = 'Digest realm="a\\"b\\\\c, d=e \xc3\xbc", nonce="n\\"", opaque="\\\\", qop="auth"'
    answer = Login(user.encode(), b"p").answer(wanted, '/a"b?ü'.encode())
    said = fields(answer)
    assert said["username"].encode("latin-1").decode() == user
    assert said["uri"].encode("latin-1").decode() == '/a"b?ü'
    assert said["realm"].encode("latin-1").decode() == 'a"b\\c, d=e ü'
    assert (said["nonce"], said["opaque"]) == ('n"', "\\")


# ------------------------------------------------------------------------------ the carrier string


def test_login_of_a_carrier_string() -> None:
    carrier = "mjpeg+path.video+user.me%2Byou+password.p.a%3A%25s%c3%bc"
    route = Route("", "", carrier)
    login = take_login(route)
    assert login == Login(b"me+you", "p.a:%sü".encode())
    assert "p.a" not in repr(login)
    assert route.carrier == "mjpeg+path.video+user.me%2Byou+password.***"
    assert route.spec.whole == carrier
    assert take_login(route) == login  # the second address of a host is tried with it too


@pytest.mark.parametrize(
    ("carrier", "login"),
    [
        ("mjpeg+path.x", None),
        ("mjpeg+user.me", Login(b"me", b"")),
        ("mjpeg+password.x", Login(b"", b"x")),
        ("mjpeg+user.ü", Login("ü".encode(), b"")),
    ],
)
def test_half_a_login(carrier: str, login: Login | None) -> None:
    assert take_login(Route("", "", carrier)) == login


@pytest.mark.parametrize("words", ["user.a%3Ab", "user.a%0d%0aX:y", "user.a+password.b%00"])
def test_login_that_http_cannot_spell(words: str) -> None:
    with pytest.raises(LocalProtocolError, match="colon"):
        take_login(Route("", "", f"mjpeg+{words}"))


def test_refusals_say_what_to_do() -> None:
    login = Login(b"me", b"secret")
    assert "user.<name>+password.<word>" in str(refusal("Basic", None))
    assert "does not accept this name and password" in str(refusal("Basic", login))
    assert "connect again" in str(refusal('Digest nonce="x", stale=TRUE', login))
    assert "secret" not in str(refusal("", login))


# ------------------------------------------------------------------------------ hostile cameras


@pytest.mark.parametrize(
    "wanted",
    [
        'Digest realm="x"',
        'Digest nonce=""',
        f'Digest nonce="{"n" * (HTTP_CHALLENGE_VALUE + 1)}"',
        f'Digest nonce="n", realm="{"r" * (HTTP_CHALLENGE_VALUE + 1)}"',
        f'Digest nonce="n", opaque="{"o" * (HTTP_CHALLENGE_VALUE + 1)}"',
        'Digest nonce="a\rb"',
        'Digest nonce="a", realm="\0"',
        'Digest nonce="n", x="' + "x" * HTTP_CHALLENGES,
    ],
)
def test_challenges_that_are_refused(wanted: str) -> None:
    with pytest.raises(RemoteProtocolError) as caught:
        Login(b"u", b"p").answer(wanted, b"/")
    assert not isinstance(caught.value, LoginRefused)


@pytest.mark.parametrize("piece", ['"', '\\"', '="', "a ", "a=,", ", ", " ", "Digest ", '"\\'])
def test_challenges_take_little_time_and_memory(piece: str) -> None:
    """The longest that is read at all: what grows with its square would show here."""
    text = (piece * HTTP_CHALLENGES)[:HTTP_CHALLENGES]
    with measured() as peak:
        for _ in range(20):
            parse_challenges(text)
    assert peak.bytes < 4 << 20


GOOD = NEW % "SHA-256" + ", " + OLD + ', stale=false, Basic realm="x"'


PIECES = st.binary(max_size=20) | st.sampled_from([b'"', b"\\", b",", b"=", b"Digest ", b"-sess"])
EDITS = st.tuples(st.integers(0, len(GOOD)), st.integers(0, 40), PIECES)


@settings(max_examples=300)
@given(st.lists(EDITS, min_size=1, max_size=8))
def test_whatever_comes_only_our_errors(edits: list[tuple[int, int, bytes]]) -> None:
    wire = bytearray(GOOD.encode())
    for at, count, piece in edits:
        wire[at : at + count] = piece
    try:
        answer = Login(b"u", b"p").answer(bytes(wire).decode("latin-1"), b"/x")
    except YarpError as error:
        assert isinstance(error, RemoteProtocolError)  # not our fault
        refusal(bytes(wire).decode("latin-1"), Login(b"u", b"p"))
    else:
        assert not re.search(rb"[\x00-\x1f\x7f]", answer)
        assert len(answer) < HTTP_CHALLENGES


@given(st.binary(max_size=300))
def test_any_bytes(data: bytes) -> None:
    for challenge in parse_challenges(data.decode("latin-1")):
        assert challenge.scheme == challenge.scheme.lower() != ""
        assert challenge.strength in (0, 1, 2)
