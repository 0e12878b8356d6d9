"""ServoBoard: the servos of a bus as a control board, such as the arms of LeRobot.

    <device name="arm" type="feetechServos">
      <param name="port">/dev/ttyUSB0</param>
      <param name="ids">(1 2 3 4 5 6)</param>
      <param name="AxisName">(pan lift elbow flex roll gripper)</param>
    </device>

    yarpy dev feetechServos --port /dev/ttyUSB0 --ids "(1 2 3)" --name /arm

Rules: it has the members of `control_board.interface`. 0 degrees is the middle of a turn. Servos
move in the mode `pos` and go limp in `idl`; they begin limp, so that nothing moves by itself. One
question reads all servos; a servo that does not answer within 50 ms fails the call, and what it
says later answers no other question. `baud` is the speed of the line.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Sequence
from contextlib import ExitStack
from typing import Final, NamedTuple

from yarpy.data.bottle import Property
from yarpy.errors import Timeout
from yarpy.kits.devices.closeable import Closeable
from yarpy.kits.devices.hardware.line import Line
from yarpy.kits.devices.hardware.packet import (
    ALL,
    SYNC_READ,
    SYNC_WRITE,
    Form,
    Version1,
    Version2,
)
from yarpy.kits.devices.simulated.plugin import values
from yarpy.names.base import NameClient

#: Seconds for an answer.
TIMEOUT: Final = 0.05
#: Seconds more for a line on which something always comes, but not the answer.
NOISE: Final = 1.0


class Register(NamedTuple):
    """The address of a number, and its size in bytes. sign: the bit of its sign, where it is no
    two's complement."""

    at: int
    size: int
    sign: int = 0

    def read(self, data: bytes) -> int:
        """Return the number in bytes."""
        if not self.sign:
            return int.from_bytes(data, "little", signed=self.size > 1)
        number = int.from_bytes(data, "little")
        bit = 1 << self.sign
        return -(number & (bit - 1)) if number & bit else number

    def write(self, number: int) -> bytes:
        """Return the bytes of a number."""
        if self.sign and number < 0:
            return (-number | 1 << self.sign).to_bytes(self.size, "little")
        return number.to_bytes(self.size, "little", signed=number < 0)


class Kind(NamedTuple):
    """The servos of a maker: their packets, registers, and units."""

    form: Form
    baud: int
    torque: Register  # 1 holds, 0 is limp
    goal: Register
    pace: Register  # of the way to the goal
    position: Register
    speed: Register
    temperature: Register
    moving: Register
    turn: int = 4096  # steps
    unit: float = 360.0 / 4096  # deg/s of a step of `pace` and `speed`


#: STS3215 and its family.
FEETECH: Final = Kind(
    form=Version1(),
    baud=1_000_000,
    torque=Register(40, 1),
    goal=Register(42, 2, 15),
    pace=Register(46, 2, 15),
    position=Register(56, 2, 15),
    speed=Register(58, 2, 15),
    temperature=Register(63, 1),
    moving=Register(66, 1),
)
#: The X series.
DYNAMIXEL: Final = Kind(
    form=Version2(),
    baud=57_600,
    torque=Register(64, 1),
    goal=Register(116, 4),
    pace=Register(112, 4),
    position=Register(132, 4),
    speed=Register(128, 4),
    temperature=Register(146, 1),
    moving=Register(122, 1),
    unit=0.229 * 6.0,
)


class ServoBoard(Closeable):
    """The servos `ids` on the line at `port`, in this order.

    names: of the joints. baud: of the line, 0 for the usual one. Raises OSError (no such line),
    Timeout (a servo does not answer), ValueError.
    """

    def __init__(
        self,
        kind: Kind,
        port: str,
        ids: Sequence[int],
        names: Sequence[str] = (),
        baud: int = 0,
    ) -> None:
        if not ids or len({*ids}) != len(ids) or not all(0 <= one < ALL for one in ids):
            raise ValueError(f"the ids of servos are different numbers from 0 to 253, not {ids}")
        if names and len(names) != len(ids):
            raise ValueError(f"{len(names)} names for {len(ids)} servos")
        self._kind, self._ids = kind, [*ids]
        self._lock = threading.Lock()
        count = len(self._ids)
        self.axis_names = [*names] or [f"servo{one}" for one in ids]
        self.axis_types = ["revolute"] * count
        self.position_limits = [(-180.0, 180.0)] * count
        self.velocity_limits = [(0.0, 360.0)] * count
        self.reference_speeds = [30.0] * count
        self._modes = ["idl"] * count
        with ExitStack() as resources:
            self._line = resources.enter_context(Line(port, baud or kind.baud))
            self._read(kind.position)  # all are there
            self._write(kind.torque, dict.fromkeys(range(count), 0))
            self._resources = resources.pop_all()

    def encoders(self) -> list[float]:
        """Degrees."""
        half, step = self._kind.turn // 2, 360.0 / self._kind.turn
        return [(number - half) * step for number in self._read(self._kind.position)]

    def encoder_speeds(self) -> list[float]:
        """Degrees per second."""
        return [number * self._kind.unit for number in self._read(self._kind.speed)]

    def motor_temperatures(self) -> list[float]:
        """Degrees Celsius."""
        return [float(number) for number in self._read(self._kind.temperature)]

    def motion_done(self) -> list[bool]:
        return [not number for number in self._read(self._kind.moving)]

    def control_modes(self) -> list[str]:
        return [*self._modes]

    def switch_control_modes(self, joints: Sequence[int], modes: Sequence[str]) -> None:
        """Hold joints, or let them go limp. Raises ValueError for other modes."""
        wanted = {"posd": "pos"}
        found = [wanted.get(mode, mode) for mode in modes]
        if not {*found} <= {"pos", "idl"}:
            raise ValueError(f"servos have the modes pos and idl, not {', '.join(modes)}")
        chosen = dict(zip(joints, found, strict=True))
        held = [joint for joint, mode in chosen.items() if mode == "pos"]
        if held:  # where they are, so that they do not jump to an old goal
            at = self._read(self._kind.position)
            self._write(self._kind.goal, {joint: at[joint] for joint in held})
        self._write(self._kind.torque, {joint: int(joint in held) for joint in chosen})
        for joint, mode in chosen.items():
            self._modes[joint] = mode

    def position_move(self, joints: Sequence[int], positions: Sequence[float]) -> None:
        """Go there at the reference speeds."""
        paces = {
            joint: max(1, round(self.reference_speeds[joint] / self._kind.unit)) for joint in joints
        }
        self._write(self._kind.pace, paces)
        self._go(joints, positions)

    def position_direct(self, joints: Sequence[int], positions: Sequence[float]) -> None:
        """Go there at once."""
        self._write(self._kind.pace, dict.fromkeys(joints, 0))
        self._go(joints, positions)

    def stop(self, joints: Sequence[int]) -> None:
        """Stay where they are."""
        at = self._read(self._kind.position)
        self._write(self._kind.goal, {joint: at[joint] for joint in joints})

    def _go(self, joints: Sequence[int], positions: Sequence[float]) -> None:
        half, turn, goals = self._kind.turn // 2, self._kind.turn, {}
        for joint, position in zip(joints, positions, strict=True):
            lowest, highest = self.position_limits[joint]
            steps = round(min(max(position, lowest), highest) * turn / 360.0) + half
            goals[joint] = min(max(steps, 0), turn - 1)
        self._write(self._kind.goal, goals)

    def _write(self, register: Register, numbers: dict[int, int]) -> None:
        """Write a register of some joints, at once: none of them answers."""
        form = self._kind.form
        data = b"".join(
            bytes((self._ids[joint],)) + register.write(number) for joint, number in numbers.items()
        )
        with self._lock:
            where = form.span(register.at, register.size)
            self._line.write(form.packet(ALL, SYNC_WRITE, where + data))

    def _read(self, register: Register) -> list[int]:
        """Read a register of all joints. Raises Timeout."""
        form = self._kind.form
        found: dict[int, int] = {}
        asked = form.span(register.at, register.size) + bytes(self._ids)
        with self._lock:
            self._line.discard()  # of servos that were too late: it does not say for which register
            self._line.write(form.packet(ALL, SYNC_READ, asked))
            until, received = time.monotonic() + TIMEOUT, b""
            while len(found) < len(self._ids):
                more = self._line.read(until)
                if not more or time.monotonic() > until + NOISE:
                    silent = [one for one in self._ids if one not in found]
                    raise Timeout(
                        f"{self._line.path}: servo {silent[0]} does not answer: is it on?"
                    )
                received += more
                while True:
                    status, received = form.split(received)
                    if status is None:
                        break
                    if status.servo in self._ids and len(status.data) == register.size:
                        found[status.servo] = register.read(status.data)
        return [found[one] for one in self._ids]


def feetech(options: Property, *, names: NameClient | None = None) -> object:
    """Servos of Feetech (STS) on a serial line. Raises ValueError, OSError, YarpError."""
    return _opened(FEETECH, options)


def dynamixel(options: Property, *, names: NameClient | None = None) -> object:
    """Servos of Dynamixel (X) on a serial line. Raises ValueError, OSError, YarpError."""
    return _opened(DYNAMIXEL, options)


def _opened(kind: Kind, options: Property) -> ServoBoard:
    port = str(options.find("port", "") or "")
    ids = values(options, "ids")
    if not port or not ids or not all(type(one) is int for one in ids):
        raise ValueError("it needs the parameters port, a serial line, and ids, a list of numbers")
    baud = options.find("baud", 0)
    if type(baud) is not int:
        raise ValueError(f"baud {baud} is no number")
    return ServoBoard(kind, port, ids, [str(one) for one in values(options, "AxisName")], baud)
