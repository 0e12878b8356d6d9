"""Files to modules, once, until they change."""

import os
from pathlib import Path

import pytest

from yarpy import idl
from yarpy.errors import DecodeError
from yarpy.kits.thrift.file.include import read_interface
from yarpy.kits.thrift.generate.module import stubs
from yarpy.kits.thrift.library import load, loads


def test_a_file_is_a_module(tmp_path: Path) -> None:
    (tmp_path / "arm.thrift").write_text("namespace yarp a.b\nstruct P { 1: i32 x }")
    found = idl.load(tmp_path / "arm.thrift")
    assert found.P(3).x == 3 and found.__name__ == "arm"
    assert found.__file__ == str(tmp_path / "arm.thrift")


def test_it_is_read_again_only_if_it_changed(tmp_path: Path) -> None:
    inner, outer = tmp_path / "inner.thrift", tmp_path / "outer.thrift"
    inner.write_text("struct P { 1: i32 x }")
    outer.write_text('include "inner.thrift"\nstruct L { 1: inner.P p }')
    first = load(outer)
    assert load(str(outer)) is first and first.L().p == first.inner.P()
    inner.write_text("struct P { 1: string name }")
    os.utime(inner, ns=(1, 1))
    second = load(outer)
    assert second is not first and second.L().p.name == ""
    inner.unlink()
    with pytest.raises(DecodeError, match="no file"):
        load(outer)


def test_included_services_and_constants(tmp_path: Path) -> None:
    (tmp_path / "base.thrift").write_text(
        "const i32 N = 4\nenum E { A, B }\nstruct P { 1: E e = E.B }\nservice S { i32 f() }"
    )
    (tmp_path / "top.thrift").write_text(
        'include "base.thrift"\nconst i32 M = base.N\nconst base.P Q = { "e": base.E.A }\n'
        "service T extends base.S { base.P g(1: base.E e = base.E.B) }"
    )
    found = load(tmp_path / "top.thrift")
    assert found.M == 4 and found.base.P(found.base.E.A) == found.Q
    assert [*found.T._methods] == ["f", "g"]
    assert found.T._methods["g"].prototype == "P g(E e = E.B)"


def test_typedefs_of_included_files_and_of_those_that_they_include(tmp_path: Path) -> None:
    (tmp_path / "deep.thrift").write_text("enum K { A = 1, B }\nstruct D { 1: i32 a = 4 }")
    (tmp_path / "mid.thrift").write_text(
        'include "deep.thrift"\ntypedef list<deep.D> Ds\ntypedef map<deep.K, deep.D> Table\n'
        "struct M { 1: deep.D d, 2: deep.K k }"
    )
    (tmp_path / "top.thrift").write_text(
        'include "mid.thrift"\n'
        "struct T { 1: mid.Ds ds = [{}], 2: mid.Table t = {1: {'a': 7}},\n"
        "3: mid.M m = {'d': {'a': 9}, 'k': 2} }\n"
        "service S { void f(1: mid.Ds ds) }"
    )
    found = load(tmp_path / "top.thrift")
    deep = found.mid.deep
    top = found.T()
    assert (top.ds, top.t) == ([deep.D(4)], {deep.K.A: deep.D(7)})
    assert top.m == found.mid.M(deep.D(9), deep.K.B)
    text = stubs(read_interface(tmp_path / "top.thrift"))
    assert "def f(self, ds: mid.Ds) -> None:" in text


def test_folders_to_include_from(tmp_path: Path) -> None:
    (tmp_path / "lib").mkdir()
    (tmp_path / "lib" / "a.thrift").write_text("struct P {}")
    (tmp_path / "b.thrift").write_text('include "a.thrift"')
    assert load(tmp_path / "b.thrift", [tmp_path / "lib"]).a.P() is not None


def test_texts() -> None:
    assert loads("const i32 A = 3").A == 3


def test_types_of_cpp_that_yarpy_has_begin_empty() -> None:
    kinds = ("os::Bottle", "os::Property", "os::Stamp", "sig::Vector", "sig::Matrix")
    text = "".join(f'struct T{n} {{}} (yarp.name = "yarp::{k}")\n' for n, k in enumerate(kinds))
    fields = ", ".join(f"{n}: T{n} t{n}" for n in range(1, len(kinds)))
    made = loads(f"{text}struct All {{ {fields} }}").All()
    again = type(made).from_bottle(made.to_bottle())
    assert again == made and (again.t4.rows, again.t4.cols) == (0, 0)
