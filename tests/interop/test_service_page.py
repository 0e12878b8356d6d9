"""The page of a Thrift service in a real browser: forms are filled in and sent."""

from support.browser import Browser

import yarpy
from yarpy.kits.thrift.library import loads
from yarpy.nameserver.local import LocalNames

INTERFACE = """\
enum Mode { IDLE, RUN }
struct Pose { 1: double x, 2: double y }
service Arm {
  /** Moves <quickly>. */
  bool move(1: i32 joint, 2: double angle = 10.0);
  string describe(1: Pose pose, 2: Mode mode, 3: string note, 4: list<i32> numbers, 5: bool on);
}
"""


def test_forms_call_methods(browser: Browser) -> None:
    arm = loads(INTERFACE, "arm")

    class Arm(arm.Arm):  # type: ignore[misc, name-defined]
        def move(self, joint: int, angle: float) -> bool:
            return (joint, angle) == (3, 10.0)

        def describe(self, pose: object, mode: object, note: str, numbers: object, on: bool) -> str:
            return f"{pose} {mode!r} {note} {numbers} {on}"

    with yarpy.RpcServer("/arm", Arm(), names=LocalNames()) as server:
        page = browser.open(f"http://{server.address}/", phone=True)
        assert page.get_by_role("heading", name="Arm").is_visible()
        assert page.get_by_text("Moves <quickly>.").is_visible()
        form = page.locator("#move")
        form.get_by_label("joint").fill("3")
        form.get_by_role("button", name="call").click()
        page.get_by_text("[ok]").wait_for()
        page.go_back()
        form = page.locator("#describe")
        form.get_by_label("pose.x").fill("1.5")
        form.get_by_label("mode").select_option("RUN")
        form.get_by_label("note").fill("two words")
        form.get_by_label("numbers").fill("1 2 3")
        form.get_by_label("on").select_option("true")
        browser.picture(page, "service")
        form.get_by_role("button", name="call").click()
        page.get_by_text("Pose(x=1.5, y=0.0) <Mode.RUN: 1> two words [1 2 3] True").wait_for()
        page.go_back()
        page.locator("#move").get_by_label("joint").fill("three")
        page.locator("#move").get_by_role("button", name="call").click()
        page.get_by_text("move.joint: expected an integer").wait_for()
