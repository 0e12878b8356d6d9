"""The interface functions, written by `yarpy idl thrift`."""

from yarpy.kits import thrift


class RobotInterface(thrift.Service):
    @thrift.method
    def get_phase(self) -> str:
        """Return the phase: startup, run, interrupt1, interrupt2, interrupt3 or shutdown."""
        raise NotImplementedError

    @thrift.method
    def get_level(self) -> thrift.i32:
        """Return the level of the phase, from 0 on."""
        raise NotImplementedError

    @thrift.method
    def get_robot(self) -> str:
        """Return the name of the robot."""
        raise NotImplementedError

    @thrift.method
    def is_ready(self) -> bool:
        """Return whether the robot has started and runs."""
        raise NotImplementedError

    @thrift.method
    def quit(self) -> str:
        """End the robot."""
        raise NotImplementedError

    @thrift.method
    def bye(self) -> str:
        """End the robot."""
        raise NotImplementedError

    @thrift.method
    def exit(self) -> str:
        """End the robot."""
        raise NotImplementedError

    @thrift.method
    def get_devices(self) -> list[str]:
        """(yarpy) Return a line for each device: its name, its state, the reason of that."""
        raise NotImplementedError

    @thrift.method
    def retry(self, device: str) -> bool:
        """(yarpy) Open a device that has failed, and do what could not be done without it."""
        raise NotImplementedError


connect = RobotInterface.connect
connect_async = RobotInterface.connect_async
