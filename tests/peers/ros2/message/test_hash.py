"""Type hashes, against those that were published and those that an independent library makes."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rosbags.typesys import Stores, get_typestore

from yarpy.errors import DecodeError
from yarpy.peers.ros.message.source import Texts
from yarpy.peers.ros2.message.hash import dds_name, is_hash, ros_name, service_hash
from yarpy.peers.ros2.message.library import Library, hash_of
from yarpy.peers.ros2.message.source import Rosbags, Standard

# From the generator of ROS 2, and from projects that were made with it.
PUBLISHED = {
    "std_msgs/msg/String": "df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18",
    "std_msgs/msg/Header": "f49fb3ae2cf070f793645ff749683ac6b06203e41c891e17701b1cb597ce6a01",
    "std_msgs/msg/Empty": "20b625256f32d5dbc0d04fee44f43c41e51c70d3502f84b4a08e7a9c26a96312",
    "std_msgs/msg/Char": "3ad2d04dd29ba19d04b16659afa3ccaedd691914b02a64e82e252f2fa6a586a9",
    "geometry_msgs/msg/Twist": "9c45bf16fe0983d80e3cfe750d6835843d265a9a6c46bd2e609fcddde6fb8d2a",
    "sensor_msgs/msg/Imu": "7d9a00ff131080897a5ec7e26e315954b8eae3353c3f995c55faf71574000b5b",
    "sensor_msgs/msg/Image": "d31d41a9a4c4bc8eae9be757b0beed306564f7526c88ea6a4588fb9582527d47",
    "action_msgs/msg/GoalStatusArray": (
        "6c1684b00f177d37438febe6e709fc4e2b0d4248dca4854946f9ed8b30cda83e"
    ),
    "std_srvs/srv/Trigger": "eeff2cd6fa5ad9d27cdf4dec64818317839b62f212a91e6b5304b634b2062c5f",
    "example_interfaces/srv/AddTwoInts": (
        "e118de6bf5eeb66a2491b5bda11202e7b68f198d6f67922cf30364858239c81a"
    ),
}
# rosbags takes `char` for a type of its own, which the generator of ROS 2 does not.
WITH_CHAR = {
    *("std_msgs/msg/Char", "service_msgs/msg/ServiceEventInfo"),
    *(f"rmw_dds_common/msg/{name}" for name in ("Gid", "NodeEntitiesInfo")),
    "rmw_dds_common/msg/ParticipantEntitiesInfo",
}
JAZZY = Library([Rosbags("jazzy"), Standard()])


@pytest.mark.parametrize("name", PUBLISHED)
def test_published_hashes(name: str) -> None:
    assert hash_of(JAZZY.load(name)) == f"RIHS01_{PUBLISHED[name]}"


def test_the_published_hash_of_a_wide_string() -> None:
    name = "example_interfaces/WString"
    published = "32033e06d9dfe5468c5d6e1dc8b7a23c8910bad071cfd4e151a951d580e68dd8"
    found = Library([Texts({name: "wstring data"}, "here")]).message(name)
    assert hash_of(found) == f"RIHS01_{published}"


def test_service_of_type_descriptions() -> None:
    """Its request has no field of ROS's own types, its response has many."""
    text = """\
string type_name
string type_hash
bool include_type_sources true
---
bool successful
string failure_reason
TypeDescription type_description
TypeSource[] type_sources
KeyValue[] extra_information
"""

    class Services(Texts):
        def find(self, name: str, kind: str) -> str | None:
            return self.texts.get(name) if kind == "srv" else None

    name = "type_description_interfaces/GetTypeDescription"
    library = Library([Services({name: text}, "here"), Rosbags("jazzy")])
    assert service_hash(library.service(name).definition) == (
        "RIHS01_69b9c19c1021405984cc60dbbb1edceb147a6538b411d812ba6afabeed962cd5"
    )


@pytest.mark.parametrize("distro", ["humble", "jazzy", "lyrical"])
def test_every_message_of_a_distribution(distro: str) -> None:
    store = get_typestore(Stores[f"ROS2_{distro.upper()}"])
    library = Library([Rosbags(distro)])
    names = [name for name in store.fielddefs if name not in WITH_CHAR]
    assert len(names) > 140
    wrong = [name for name in names if store.hash_rihs01(name) != hash_of(library.message(name))]
    assert wrong == []


@given(st.permutations(["int8 a", "string<=4 b", "float64[] c", "std_msgs/Header[<=2] d"]))
def test_every_order_of_fields_has_its_own(lines: list[str]) -> None:
    def hash_(rows: list[str]) -> str:
        return hash_of(
            Library([Texts({"p/T": "\n".join(rows)}, "here"), Standard()]).message("p/T")
        )

    assert (hash_(lines) == hash_(sorted(lines))) == (lines == sorted(lines))
    assert hash_([f"{line}  # as a remark" for line in lines]) == hash_(lines)
    assert hash_([*lines, "int32 A=3"]) == hash_(lines)


def test_bounds_count() -> None:
    def hash_(text: str) -> str:
        return hash_of(Library([Texts({"p/T": text}, "here")]).message("p/T"))

    texts = ("string a", "string<=3 a", "string<=4 a", "string[] a", "string[2] a", "string[<=2] a")
    others = (
        "string<=3[] a",
        "wstring a",
        "wstring<=3 a",
        "byte a",
        "uint8 a",
        "int8 a",
        "string b",
    )
    assert len({hash_(text) for text in (*texts, *others)}) == len(texts) + len(others)
    assert hash_("uint8 a") == hash_("char a")


def test_names_of_dds() -> None:
    assert dds_name("std_msgs/String") == "std_msgs::msg::dds_::String_"
    assert ros_name("p::srv::dds_::Add_Two_") == ("p/Add_Two", "srv")
    for text in ("", "p::msg::dds_::T", "p/msg/T", "p::other::dds_::T_", "::msg::dds_::T_"):
        with pytest.raises(DecodeError, match="no type of ROS 2"):
            ros_name(text)


def test_what_is_a_hash() -> None:
    assert is_hash("RIHS01_" + "0" * 64)
    for text in ("TypeHashNotSupported", "RIHS01_" + "0" * 63, "RIHS01_" + "G" * 64):
        assert not is_hash(text)
