"""The words of a control board's RPC port: which member of the interface each one means.

    [get] [encs]                    -> encoders, of all joints
    [set] [pos] 2 45.0              -> position_move, of joint 2
    [get] [torq] [refg] ...         -> an interface's own word between them

Rules: just a table, which server and client read from opposite sides. A row has up to three words:
for one joint (`j value`), for all (`(values)`), for some (`count (joints) (values)`).

Source: protocol 1.9.0 of YARP 3.x, as controlBoard_nws_yarp and remote_controlboard speak it.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import Final

from yarpy.kits.devices.kind import (
    BOXED,
    FAULT,
    FLAG,
    FLOAT,
    JOINT_TYPE,
    NOTHING,
    PAIR,
    TEXT,
    WHOLE,
    WORD,
    ZERO,
    Fixed,
    Kind,
    Numbers,
)

VERSION: Final = (1, 9, 0)

GAINS: Final = Numbers(10)
FIELDS_OF_TORQUE: Final = Numbers(9)
IMPEDANCE: Final = Numbers(2)
IMPEDANCE_RANGE: Final = Numbers(4)


class Form(Enum):
    """The number of joints that a word of a request is about."""

    ONE = "one"
    ALL = "all"
    SOME = "some"


@dataclass(frozen=True, slots=True)
class Words:
    """The words for one member of the interface: for one joint, for all, for some."""

    one: str
    all: str
    some: str
    member: str

    def words(self) -> dict[str, Form]:
        pairs = ((self.one, Form.ONE), (self.all, Form.ALL), (self.some, Form.SOME))
        return {word: form for word, form in pairs if word}


@dataclass(frozen=True, slots=True)
class Row(Words):
    """`kind`: how the values are encoded."""

    kind: Kind = FLOAT


@dataclass(frozen=True, slots=True)
class Interface:
    """A group of rows introduced by a word of its own ("" for those without)."""

    word: str
    get: tuple[Row, ...]
    set: tuple[Row, ...] = ()
    stamped: bool = True  # replies carry [tsta] count time
    echo: bool = True  # replies begin with [is] and element 1 of the request

    @property
    def members(self) -> frozenset[str]:
        """Its own members, without those of others that one of its words happens to set."""
        rows = (*self.get, *self.set)
        return frozenset(row.member for row in rows if not isinstance(row.kind, Fixed))


PLAIN: Final = Interface(
    "",
    get=(
        Row("name", "", "", "axis_names", TEXT),
        Row("type", "", "", "axis_types", JOINT_TYPE),
        # positions, speeds
        Row("pos", "poss", "posg", "position_targets"),
        Row("don", "dons", "dong", "motion_done", FLAG),
        Row("vel", "vels", "velg", "reference_speeds"),
        Row("acc", "accs", "accg", "reference_accelerations"),
        Row("vmo", "vmos", "vmog", "velocity_targets"),
        Row("dpo", "dpos", "dpog", "direct_targets"),
        # encoders
        Row("enc", "encs", "", "encoders"),
        Row("esp", "esps", "", "encoder_speeds"),
        Row("eac", "eacs", "", "encoder_accelerations"),
        Row("mnc", "mncs", "", "motor_encoders"),
        Row("msp", "msps", "", "motor_speeds"),
        Row("mac", "macs", "", "motor_accelerations"),
        Row("mcpr", "", "", "counts_per_revolution"),
        # motors
        Row("tmp", "tmps", "", "motor_temperatures"),
        Row("tmpl", "", "", "temperature_limits"),
        Row("gbxr", "", "", "gearbox_ratios"),
        # limits
        Row("llim", "", "", "position_limits", PAIR),
        Row("vlim", "", "", "velocity_limits", PAIR),
        # amplifiers
        Row("acu", "acus", "", "currents"),
        Row("asts", "asta", "", "amplifier_status", WHOLE),
        Row("maxc", "", "", "max_currents"),
        Row("acno", "", "", "nominal_currents"),
        Row("acpk", "", "", "peak_currents"),
        Row("pwml", "", "", "pwm_limits"),
        Row("pwm", "", "", "duty_cycles"),
        Row("avsu", "", "", "supply_voltages"),
    ),
    set=(
        Row("pos", "poss", "posg", "position_move"),
        Row("rel", "rels", "relg", "relative_move"),
        Row("", "vmos", "", "velocity_move"),
        Row("sto", "stos", "stog", "stop", NOTHING),
        Row("vel", "vels", "velg", "reference_speeds"),
        Row("acc", "accs", "accg", "reference_accelerations"),
        Row("enc", "encs", "", "preset_encoders"),
        Row("ere", "eres", "", "preset_encoders", ZERO),
        Row("mnc", "mncs", "", "preset_motor_encoders"),
        Row("mre", "mres", "", "preset_motor_encoders", ZERO),
        Row("mcpr", "", "", "counts_per_revolution"),
        Row("tmpl", "", "", "temperature_limits"),
        Row("gbxr", "", "", "gearbox_ratios"),
        Row("llim", "", "", "position_limits", PAIR),
        Row("vlim", "", "", "velocity_limits", PAIR),
        Row("aen", "", "", "enable_amplifiers", NOTHING),
        Row("adi", "", "", "disable_amplifiers", NOTHING),
        Row("maxc", "", "", "max_currents"),
        Row("acno", "", "", "nominal_currents"),
        Row("acpk", "", "", "peak_currents"),
        Row("pwml", "", "", "pwm_limits"),
    ),
)

CONTROL_MODE: Final = Interface(
    "icmd",
    get=(Row("cmod", "cmds", "cmog", "control_modes", WORD),),
    set=(Row("cmod", "cmds", "cmog", "switch_control_modes", WORD),),
)

INTERACTION_MODE: Final = Interface(
    "intm",
    get=(Row("mode", "mods", "modg", "interaction_modes", WORD),),
    set=(Row("mode", "mods", "modg", "switch_interaction_modes", WORD),),
    echo=False,
)

TORQUE: Final = Interface(
    "torq",
    get=(
        Row("trq", "trqs", "", "torques"),
        Row("ref", "refs", "", "torque_targets"),
        Row("rng", "rngs", "", "torque_ranges", PAIR),
        Row("mtps", "", "", "motor_torque_parameters", FIELDS_OF_TORQUE),
    ),
    set=(
        Row("ref", "refs", "", "apply_torques"),
        Row("mtps", "", "", "motor_torque_parameters", FIELDS_OF_TORQUE),
        Row("", "trqd", "", "switch_control_modes", Fixed("torq")),
    ),
)

IMPEDANCES: Final = Interface(
    "iimp",
    get=(
        Row("ipr", "", "", "impedances", IMPEDANCE),
        Row("iof", "", "", "impedance_offsets", BOXED),
        Row("llim", "", "", "impedance_ranges", IMPEDANCE_RANGE),
    ),
    set=(
        Row("ipr", "", "", "impedances", IMPEDANCE),
        Row("iof", "", "", "impedance_offsets", BOXED),
    ),
)

CURRENT: Final = Interface(
    "icur",
    get=(
        Row("ref", "refs", "", "current_targets"),
        Row("rng", "rngs", "", "current_ranges", PAIR),
    ),
    stamped=False,
)

PWM: Final = Interface(
    "ipwm",
    get=(
        Row("ref", "refs", "", "duty_cycle_targets"),
        Row("pwm", "", "", "duty_cycles"),
        # C++ also means the measured ones but returns these, so we do too.
        Row("", "pwms", "", "duty_cycle_targets"),
    ),
    stamped=False,
)

FAULTS: Final = Interface("ijfl", get=(Row("jhfl", "", "", "faults", FAULT),), stamped=False)

INTERFACES: Final = {
    interface.word: interface
    for interface in (
        *(PLAIN, CONTROL_MODE, INTERACTION_MODE, TORQUE, IMPEDANCES, CURRENT, PWM, FAULTS),
    )
}

#: For the controllers of one kind: the word is followed by the kind, then the joint.
PID: Final = Interface(
    "pid",
    get=(
        Row("pid", "pids", "", "gains", GAINS),
        Row("ref", "refs", "", "targets"),
        Row("lim", "lims", "", "error_limits"),
        Row("err", "errs", "", "errors"),
        Row("out", "outs", "", "outputs"),
        Row("ena", "", "", "enabled", FLAG),
    ),
    set=(
        Row("pid", "pids", "", "gains", GAINS),
        Row("ref", "refs", "", "targets"),
        Row("lim", "lims", "", "error_limits"),
        Row("off", "", "", "offsets"),
        Row("ena", "", "", "enabled", Fixed(True)),
        Row("dis", "", "", "enabled", Fixed(False)),
        Row("res", "", "", "reset", NOTHING),
    ),
    stamped=False,
)

#: [set] [reca] <word>, followed by a joint if the second value says so.
CALIBRATOR: Final = {
    "cal": ("calibrate", Form.ONE),
    "cals": ("calibrate", Form.ALL),
    "hom": ("home", Form.ONE),
    "homs": ("home", Form.ALL),
    "par": ("park", Form.ONE),
    "pars": ("park", Form.ALL),
}
QUITTING: Final = {"quca": "quit_calibration", "qupa": "quit_parking"}


def lookup(rows: tuple[Row, ...]) -> dict[str, tuple[Form, Row]]:
    """Word -> how many joints it is about, and its row."""
    return {word: (form, row) for row in rows for word, form in row.words().items()}


#: How the arguments of each form are shown in the list of requests.
_ARGUMENTS: Final = {
    ("get", Form.ONE): " joint",
    ("get", Form.ALL): "",
    ("get", Form.SOME): " count (joints)",
    ("set", Form.ONE): " joint value",
    ("set", Form.ALL): " (values)",
    ("set", Form.SOME): " count (joints) (values)",
}


def usage() -> list[tuple[str, str]]:
    """Every request with the member that it uses, for `[help]`."""
    found = [
        ("[help] [all]", "these lines"),
        ("[help] [more]", "these lines with some comments"),
        ("[get] [prot]", "version of this protocol"),
        ("[get] [axes]", "number of joints"),
    ]
    for interface in (*INTERFACES.values(), PID):
        middle = f" [{interface.word}]" if interface.word else ""
        for verb, rows in (("get", interface.get), ("set", interface.set)):
            for word, (form, row) in lookup(rows).items():
                arguments = _ARGUMENTS[verb, form]
                if row.kind.count == 0:
                    arguments = arguments.replace(" (values)", "").replace(" value", "")
                elif verb == "set" and form is Form.ONE and row.kind is PAIR:
                    arguments = " joint lowest highest"
                kind = " pos|vel|trq|cur" if interface is PID else ""
                comment = row.member.replace("_", " ")
                found.append((f"[{verb}]{middle} [{word}]{kind}{arguments}", comment))
    return found
