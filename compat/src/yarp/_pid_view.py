"""IPidControl: the controllers of joints, as Pid, and what their driver says of them."""

from __future__ import annotations

import contextlib
from typing import Any, ClassVar

import yarpy
from yarp._control_view import PIDS, word_of
from yarp._numbers import StdVector, store
from yarp._view import FAILURES, View
from yarpy.kits.devices import Gains


class Pid:
    """The numbers of a controller."""

    def __init__(
        self,
        kp: float = 0.0,
        kd: float = 0.0,
        ki: float = 0.0,
        int_max: float = 0.0,
        scale: float = 0.0,
        out_max: float = 0.0,
        st_up: float = 0.0,
        st_down: float = 0.0,
        kff: float = 0.0,
    ) -> None:
        self.kp, self.kd, self.ki, self.kff = kp, kd, ki, kff
        self.max_int, self.scale, self.max_output, self.offset = int_max, scale, out_max, 0.0
        self.stiction_up_val, self.stiction_down_val = st_up, st_down

    def setMaxInt(self, m: float) -> None:
        self.max_int = m

    def setMaxOut(self, m: float) -> None:
        self.max_output = m

    def setStictionValues(self, up_value: float, down_value: float) -> None:
        self.stiction_up_val, self.stiction_down_val = up_value, down_value

    def setKp(self, p: float) -> None:
        self.kp = p

    def setKi(self, i: float) -> None:
        self.ki = i

    def setKd(self, d: float) -> None:
        self.kd = d

    def setKff(self, Kff: float) -> None:
        self.kff = Kff

    def setScale(self, sc: float) -> None:
        self.scale = sc

    def setOffset(self, o: float) -> None:
        self.offset = o

    def clear(self) -> None:
        self._become(Gains())

    def isEqual(self, p: Pid) -> bool:
        return self.__dict__ == p.__dict__

    def _gains(self) -> Gains:
        return Gains(
            self.kp,
            self.kd,
            self.ki,
            self.max_int,
            self.max_output,
            self.offset,
            self.scale,
            self.stiction_up_val,
            self.stiction_down_val,
            self.kff,
        )

    def _become(self, found: Any) -> None:
        gains = Gains(*found)
        self.kp, self.kd, self.ki, self.kff = gains.kp, gains.kd, gains.ki, gains.feed_forward
        self.max_int, self.max_output = gains.max_integral, gains.max_output
        self.offset, self.scale = gains.offset, gains.scale
        self.stiction_up_val, self.stiction_down_val = gains.stiction_up, gains.stiction_down


def _pid(value: Any) -> Pid:
    if not isinstance(value, Pid):
        raise TypeError(f"a Pid is needed, not {value!r}")
    return value


class _Texts:
    """Texts under the names of C++. `_names`: those of `yarpy.devices`."""

    _names: ClassVar[dict[str, str]]

    def __init__(self) -> None:
        for name in self._names:
            setattr(self, name, "")

    def _become(self, found: Any) -> None:
        for name, member in self._names.items():
            setattr(self, name, str(found.get(member, "")))

    def __getattr__(self, name: str) -> str:
        raise AttributeError(f"a {type(self).__name__} has {', '.join(self._names)}, not {name}")


class PidDataDescription(_Texts):
    """The description of a controller, with its units."""

    _names: ClassVar = {
        "pid_description": "description",
        "input_data_description": "input",
        "output_data_description": "output",
    }


class PidDataUnits(_Texts):
    """The unit of each number of a Pid."""

    _names: ClassVar = {
        "units_kp": "kp",
        "units_kd": "kd",
        "units_ki": "ki",
        "units_max_int": "max_integral",
        "units_scale": "scale",
        "units_max_output": "max_output",
        "units_offset": "offset",
        "units_stiction_up_val": "stiction_up",
        "units_stiction_down_val": "stiction_down",
        "units_kff": "feed_forward",
    }


class PidExtraInfo:
    """A parameter that a driver of YARP 4 adds to a controller: `description` and `units`."""

    def __init__(self) -> None:
        self.description, self.units = PidDataDescription(), PidDataUnits()

    def _become(self, found: Any) -> None:
        self.description._become(found)
        self.units._become(found)


class PidWithExtraInfo:
    """A controller, and what its driver says of it."""

    def __init__(self) -> None:
        self.pid = Pid()
        self.pidExtraInfo = PidExtraInfo()


class PidVector(StdVector[Pid]):
    _kind = staticmethod(_pid)

    def __init__(self, size: Any = 0) -> None:
        super().__init__([Pid() for _ in range(size)] if isinstance(size, int) else size)

    _zero = None


class IPidControl(View):
    """Controllers of each joint, of the kind in the first argument: `VOCAB_PIDTYPE_POSITION`."""

    def _kind(self, pidtype: Any) -> View:
        """A view of the controllers of one kind."""
        inner = View(_Kind(self._board.pids[word_of(pidtype)], self.getAxes()))
        return inner

    def getPid(self, pidtype: int, j: int, pid: Any) -> bool:
        def read() -> None:
            gains = self._board.pids[word_of(pidtype)].gains[j]
            if isinstance(pid, Pid):
                pid._become(gains)
            else:
                found = Pid()
                found._become(gains)
                store(pid, [found])

        return self._tell(read)

    def getPidExtraInfo(self, pidtype: int, j: int, info: Any) -> bool:
        """Store what the driver says of a controller: its texts and units, of YARP 4."""

        def read() -> None:
            info._become(self._board.pids[word_of(pidtype)].details[j])

        return self._tell(read)

    def getPidExtraInfos(self, pidtype: int, info: Any) -> bool:
        """The same of the controllers of all joints, in a list."""

        def read() -> None:
            found = []
            for each in self._board.pids[word_of(pidtype)].details:
                found.append(PidExtraInfo())
                found[-1]._become(each)
            store(info, found)

        return self._tell(read)

    def getPids(self, pidtype: int, pids: Any) -> bool:
        def read() -> None:
            found = []
            for gains in self._board.pids[word_of(pidtype)].gains:
                found.append(Pid())
                found[-1]._become(gains)
            store(pids, found)

        return self._tell(read)

    def setPid(self, pidtype: int, j: int, pid: Pid) -> bool:
        return self._tell(lambda: self._kind(pidtype)._change("gains", (j, pid._gains())))

    def setPids(self, pidtype: int, pids: Any) -> bool:
        gains = [pid._gains() for pid in pids]
        return self._tell(lambda: self._kind(pidtype)._change("gains", (gains,)))

    def resetPid(self, pidtype: int, j: int) -> bool:
        return self._tell(lambda: self._board.pids[word_of(pidtype)].reset([j]))

    def enablePid(self, pidtype: int, j: int) -> bool:
        return self._tell(lambda: self._kind(pidtype)._change("enabled", (j, True)))

    def disablePid(self, pidtype: int, j: int) -> bool:
        return self._tell(lambda: self._kind(pidtype)._change("enabled", (j, False)))

    def isPidEnabled(self, pidtype: int, j: int, enabled: Any) -> bool:
        return self._tell(lambda: self._kind(pidtype)._get("enabled", (j, enabled)))

    def getPidReference(self, pidtype: int, j: int, ref: Any) -> bool:
        return self._tell(lambda: self._kind(pidtype)._get("targets", (j, ref)))

    def getPidReferences(self, pidtype: int, refs: Any) -> bool:
        return self._tell(lambda: self._kind(pidtype)._get("targets", (refs,)))

    def setPidReference(self, pidtype: int, j: int, ref: float) -> bool:
        return self._tell(lambda: self._kind(pidtype)._change("targets", (j, ref)))

    def setPidReferences(self, pidtype: int, refs: Any) -> bool:
        return self._tell(lambda: self._kind(pidtype)._change("targets", (refs,)))

    def getPidError(self, pidtype: int, j: int, err: Any) -> bool:
        return self._tell(lambda: self._kind(pidtype)._get("errors", (j, err)))

    def getPidErrors(self, pidtype: int, errs: Any) -> bool:
        return self._tell(lambda: self._kind(pidtype)._get("errors", (errs,)))

    def getPidOutput(self, pidtype: int, j: int, out: Any) -> bool:
        return self._tell(lambda: self._kind(pidtype)._get("outputs", (j, out)))

    def getPidOutputs(self, pidtype: int, outs: Any) -> bool:
        return self._tell(lambda: self._kind(pidtype)._get("outputs", (outs,)))

    def getPidErrorLimit(self, pidtype: int, j: int, limit: Any) -> bool:
        return self._tell(lambda: self._kind(pidtype)._get("error_limits", (j, limit)))

    def getPidErrorLimits(self, pidtype: int, limits: Any) -> bool:
        return self._tell(lambda: self._kind(pidtype)._get("error_limits", (limits,)))

    def setPidErrorLimit(self, pidtype: int, j: int, limit: float) -> bool:
        return self._tell(lambda: self._kind(pidtype)._change("error_limits", (j, limit)))

    def setPidErrorLimits(self, pidtype: int, limits: Any) -> bool:
        return self._tell(lambda: self._kind(pidtype)._change("error_limits", (limits,)))

    def getPidOffset(self, pidtype: int, j: int, v: Any) -> bool:
        """Return the offset, which is added to the output."""
        return self._tell(lambda: self._kind(pidtype)._get("offsets", (j, v)))

    def getPidFeedforward(self, pidtype: int, j: int, v: Any) -> bool:
        """The gain of what is known in advance, that of `Pid.kff`."""
        return self._tell(lambda: store(v, [self._gains(pidtype, j).feed_forward]))

    def setPidFeedforward(self, pidtype: int, j: int, v: float) -> bool:
        def change() -> None:
            gains = self._gains(pidtype, j)._replace(feed_forward=float(v))
            self._kind(pidtype)._change("gains", (j, gains))

        return self._tell(change)

    def _gains(self, pidtype: int, j: int) -> Gains:
        return Gains(*self._board.pids[word_of(pidtype)].gains[j])

    def getAvailablePids(self, j: int, avail: Any) -> bool:
        """Store which kinds of controllers a joint has, in an IVector."""
        found = []
        for word in PIDS:
            with contextlib.suppress(*FAILURES):
                self._gains(yarpy.Vocab(word).code, j)
                found.append(yarpy.Vocab(word).code)
        avail.assign(0, 0)
        for code in found:
            avail.push_back(code)
        return bool(found)

    def setPidOffset(self, pidtype: int, j: int, v: float) -> bool:
        return self._tell(lambda: self._kind(pidtype)._change("offsets", (j, v)))


class _Kind:
    """Controllers of one kind as a board of so many joints."""

    def __init__(self, pids: Any, count: int) -> None:
        object.__setattr__(self, "_pids", pids)
        object.__setattr__(self, "axis_names", [""] * count)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._pids, name)

    def __setattr__(self, name: str, value: Any) -> None:
        setattr(self._pids, name, value)
