"""`yarpy idl thrift`: Python is written for .thrift files, and they are checked."""

import subprocess
import sys

from yarpy.kits.thrift import load

HERE = "import sys; sys.path.insert(0, '.'); "  # an isolated Python leaves that out


def files_of(folder, module):
    """The line for a module that is written."""
    return f"{folder / module}.py, {folder / module}.pyi\n"


def test_thrift_is_written(here, tmp_path, monkeypatch):
    (tmp_path / "lib").mkdir()
    (tmp_path / "lib" / "shape.thrift").write_text("struct Point { 1: i32 x }")
    arm = tmp_path / "arm.thrift"
    arm.write_text(
        'include "shape.thrift"\nenum E { A }\nservice Arm { shape.Point get(), void stop() }'
    )
    arguments = ("idl", "thrift", str(arm), "--folder", str(tmp_path / "lib"))
    said = here(*arguments, "--check")
    assert (said.code, said.err) == (0, "")
    assert said.out.splitlines()[1] == f"{arm}: 1 enum, 2 methods in Arm"
    assert said.out.splitlines()[0].endswith("shape.thrift: 1 struct")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["arm.thrift", "lib"]
    out = tmp_path / "out"
    said = here(*arguments, "--out", str(out))
    assert said.out == files_of(out, "shape") + files_of(out, "arm")
    monkeypatch.syspath_prepend(str(out))
    program = HERE + "import arm; print(arm.shape.Point(3), 'lark' in sys.modules)"
    done = subprocess.run(
        [sys.executable, "-c", program],
        cwd=out, capture_output=True, text=True, check=True, timeout=50,
    )  # fmt: skip
    assert done.stdout == "Point(x=3) False\n"


def test_all_files_are_checked(here, tmp_path):
    (tmp_path / "a.thrift").write_text("struct A { 1: i32 x")
    (tmp_path / "b.thrift").write_text("struct B { 1: i32 x }")
    (tmp_path / "c.thrift").write_text("struct C { 1: Nothing x }")
    files = [str(tmp_path / f"{name}.thrift") for name in "abcd"]
    said = here("idl", "thrift", "--check", *files)
    assert said.code == 1
    assert said.out == f"{files[1]}: 1 struct\n"
    errors = said.err.splitlines()
    assert len(errors) == 3
    for error, file in zip(errors, (files[0], files[2], files[3]), strict=True):
        assert error.startswith("error: ") and file in error
    said = here("idl", "thrift", *files, "--out", str(tmp_path / "out"))
    assert (said.code, said.err.splitlines()) == (1, errors)
    assert not (tmp_path / "out").exists()


def test_no_module_that_is_written_hides_one_of_python(here, tmp_path):
    (tmp_path / "types.thrift").write_text("struct Point { 1: i32 x }")
    arm = tmp_path / "arm.thrift"
    arm.write_text('include "types.thrift"\nservice Arm { types.Point get() }')
    out = tmp_path / "out"
    said = here("idl", "thrift", str(arm), "--out", str(out))
    assert said.out == files_of(out, "types_") + files_of(out, "arm")
    done = subprocess.run(
        [sys.executable, "-c", HERE + "import arm; print(arm.types.Point(3))"],
        cwd=out, capture_output=True, text=True, check=True, timeout=50,
    )  # fmt: skip
    assert done.stdout == "Point(x=3)\n"
    assert load(arm).types.Point(3).x == 3


def test_wrong_thrift_files_are_named_with_the_line(here, tmp_path):
    good, bad = tmp_path / "good.thrift", tmp_path / "bad.thrift"
    good.write_text("struct A {}")
    bad.write_text("struct A {\n  1: i32 x = 'y'\n}")
    out = tmp_path / "out"
    said = here("idl", "thrift", str(good), str(bad), "--out", str(out))
    assert said.code == 1 and f"{bad}:2: expected a value for i32, found 'y'" in said.err
    assert not out.exists()
    said = here("idl", "thrift", str(tmp_path / "none.thrift"))
    assert said.code == 1 and "none.thrift" in said.err
    odd = tmp_path / "my-arm.thrift"
    odd.write_text("struct A {}")
    said = here("idl", "thrift", str(odd))
    assert said.code == 1 and "no module is called my-arm: rename it" in said.err
