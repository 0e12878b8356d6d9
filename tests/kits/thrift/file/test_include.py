"""Files that include others: where they are looked for, and which are refused."""

import sys
from pathlib import Path

import pytest

from yarpy.errors import DecodeError
from yarpy.kits.thrift.file.include import read_interface


def test_included_files(tmp_path: Path) -> None:
    (tmp_path / "lib").mkdir()
    (tmp_path / "lib" / "geometry.thrift").write_text("struct Point { 1: i32 x }")
    (tmp_path / "arm.thrift").write_text(
        'include "geometry.thrift"\nstruct A { 1: geometry.Point p }'
    )
    with pytest.raises(DecodeError, match=r'arm.thrift:1: no file "geometry.thrift" in'):
        read_interface(tmp_path / "arm.thrift")
    found = read_interface(tmp_path / "arm.thrift", [tmp_path / "lib"])
    assert found.name == "arm" and [*found.includes] == ["geometry"]
    (tmp_path / "geometry.thrift").write_text("struct Pt {}")  # that beside it comes first
    with pytest.raises(DecodeError, match=r'arm.thrift:2: no type "geometry.Point": did you mean'):
        read_interface(tmp_path / "arm.thrift", [tmp_path / "lib"])


def test_files_that_include_each_other_are_refused(tmp_path: Path) -> None:
    for name, other in (("a", "b"), ("b", "c"), ("c", "a")):
        (tmp_path / f"{name}.thrift").write_text(f'include "{other}.thrift"')
    with pytest.raises(DecodeError, match=r"c\.thrift:1: files include each other: a.thrift -> b"):
        read_interface(tmp_path / "a.thrift")
    (tmp_path / "self.thrift").write_text('include "self.thrift"')
    with pytest.raises(DecodeError, match="include each other"):
        read_interface(tmp_path / "self.thrift")


def test_a_file_may_be_included_twice_by_different_ways(tmp_path: Path) -> None:
    (tmp_path / "base.thrift").write_text("struct P { 1: i32 x }")
    (tmp_path / "a.thrift").write_text('include "base.thrift"\nstruct A { 1: base.P p }')
    (tmp_path / "b.thrift").write_text('include "a.thrift"\ninclude "base.thrift"')
    found = read_interface(tmp_path / "b.thrift")
    assert found.includes["a"].includes["base"] is found.includes["base"]


def test_files_that_are_no_text(tmp_path: Path) -> None:
    (tmp_path / "a.thrift").write_bytes(b"struct A {}\n\xff")
    with pytest.raises(DecodeError, match=r"a\.thrift:2: the file is not UTF-8 text"):
        read_interface(tmp_path / "a.thrift")
    with pytest.raises(FileNotFoundError):
        read_interface(tmp_path / "none.thrift")
    if sys.platform != "win32":  # which has no file without an end
        (tmp_path / "zero.thrift").symlink_to("/dev/zero")
        with pytest.raises(DecodeError, match="has more than 262144 characters"):
            read_interface(tmp_path / "zero.thrift")


def test_a_diamond_of_included_files(tmp_path: Path) -> None:
    """Each includes two, which include the same two: that would be a million ways."""
    for side in "ab":
        (tmp_path / f"{side}0.thrift").write_text(f"struct {side.upper()}0 {{}}")
        for n in range(1, 40):
            (tmp_path / f"{side}{n}.thrift").write_text(
                f'include "a{n - 1}.thrift"\ninclude "b{n - 1}.thrift"\n'
                f"struct {side.upper()}{n} {{ 1: a{n - 1}.A{n - 1} a }}"
            )
    found = read_interface(tmp_path / "a39.thrift").all()
    assert len(found) == 79 and found[-1].name == "a39"
    names = [each.name for each in found]
    assert all(names.index(f"a{n - 1}") < names.index(f"a{n}") for n in range(1, 40))
