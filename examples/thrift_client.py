"""A client of Thrift: calls the methods of examples/thrift_server.py.

yarpy server                        # in one terminal
python examples/thrift_server.py    # in another
python examples/thrift_client.py    # in a third
"""

from pathlib import Path

import yarpy
from yarpy import idl

arm = idl.load(Path(__file__).with_name("arm.thrift"))


def main() -> None:
    yarpy.wait_for("/arm/rpc", timeout=10)
    with arm.connect("/arm/rpc", timeout=5) as robot:
        print(robot.move(1, 30), robot.move(9, 30), robot.set_mode(arm.Mode.TORQUE))
        print(robot.status())
        print(robot.path(arm.Pose(), arm.Pose(x=1.0)))
        print(robot.scale([1, 2.5]), robot.letters("hello"), robot.unique([3, 1, 3]))
        print(robot.say("hello", times=2), robot.reverse(b"abc"), robot.add([1.0], [2.0]))
        robot.stop()
        try:
            robot.move("one", 30)
        except TypeError as error:
            print(error)
        try:
            robot.path(arm.Pose(), arm.Pose(), 1)
        except yarpy.YarpError as error:
            print(error)


if __name__ == "__main__":
    main()
