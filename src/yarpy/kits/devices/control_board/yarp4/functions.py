"""The interface functions, written by `yarpy idl thrift`."""

from typing import Annotated

import yarpy
from yarpy.kits import thrift

vocab = thrift.vocab


class Status(thrift.Struct):
    """The outcome of a call: ok, or err1 (failed) ... err7, miss."""

    code: vocab = ""


class Pid(thrift.Struct):
    """The gains of a controller."""

    kp: float = 0.0
    kd: float = 0.0
    ki: float = 0.0
    max_integral: float = 0.0
    scale: float = 0.0
    max_output: float = 0.0
    offset: float = 0.0
    stiction_up: float = 0.0
    stiction_down: float = 0.0
    feed_forward: float = 0.0


class PidDetails(thrift.Struct):
    """Texts about a controller: three, and one for each gain."""

    description: str = ""
    input: str = ""
    output: str = ""
    kp: str = ""
    kd: str = ""
    ki: str = ""
    max_integral: str = ""
    scale: str = ""
    max_output: str = ""
    offset: str = ""
    stiction_up: str = ""
    stiction_down: str = ""
    feed_forward: str = ""


class TorqueParameters(thrift.Struct):
    """How a motor produces torque."""

    bemf: float = 0.0
    bemf_scale: float = 0.0
    ktau: float = 0.0
    ktau_scale: float = 0.0
    viscous_positive: float = 0.0
    viscous_negative: float = 0.0
    coulomb_positive: float = 0.0
    coulomb_negative: float = 0.0
    velocity_threshold: float = 0.0


class Calibration(thrift.Struct):
    """How a joint is calibrated."""

    kind: thrift.i32 = 0
    parameter1: float = 0.0
    parameter2: float = 0.0
    parameter3: float = 0.0
    parameter4: float = 0.0
    parameter5: float = 0.0
    zero: float = 0.0


Bottle = Annotated[yarpy.Bottle, thrift.External("yarp::os::Bottle", 1, "yarpy.Bottle")]


class Number(thrift.Struct):
    status: thrift.Nested[Status] = thrift.new(lambda: Status())
    value: float = 0.0


class Numbers(thrift.Struct):
    status: thrift.Nested[Status] = thrift.new(lambda: Status())
    values: thrift.Float64s = thrift.new(list)


class Sample(thrift.Struct):
    status: thrift.Nested[Status] = thrift.new(lambda: Status())
    value: float = 0.0
    time: float = 0.0


class Samples(thrift.Struct):
    status: thrift.Nested[Status] = thrift.new(lambda: Status())
    values: thrift.Float64s = thrift.new(list)
    times: thrift.Float64s = thrift.new(list)


class Range(thrift.Struct):
    status: thrift.Nested[Status] = thrift.new(lambda: Status())
    low: float = 0.0
    high: float = 0.0


class Ranges(thrift.Struct):
    status: thrift.Nested[Status] = thrift.new(lambda: Status())
    low: thrift.Float64s = thrift.new(list)
    high: thrift.Float64s = thrift.new(list)


class Truth(thrift.Struct):
    status: thrift.Nested[Status] = thrift.new(lambda: Status())
    value: bool = False


class Count(thrift.Struct):
    status: thrift.Nested[Status] = thrift.new(lambda: Status())
    value: thrift.i32 = 0


class Counts(thrift.Struct):
    status: thrift.Nested[Status] = thrift.new(lambda: Status())
    values: thrift.Int32s = thrift.new(list)


class Text(thrift.Struct):
    status: thrift.Nested[Status] = thrift.new(lambda: Status())
    value: str = ""


class Fault(thrift.Struct):
    status: thrift.Nested[Status] = thrift.new(lambda: Status())
    code: thrift.i32 = 0
    text: str = ""


class Impedance(thrift.Struct):
    status: thrift.Nested[Status] = thrift.new(lambda: Status())
    stiffness: float = 0.0
    damping: float = 0.0


class ImpedanceRange(thrift.Struct):
    status: thrift.Nested[Status] = thrift.new(lambda: Status())
    stiffness_low: float = 0.0
    stiffness_high: float = 0.0
    damping_low: float = 0.0
    damping_high: float = 0.0


class Gains(thrift.Struct):
    status: thrift.Nested[Status] = thrift.new(lambda: Status())
    gains: thrift.Nested[Pid] = thrift.new(lambda: Pid())


class AllGains(thrift.Struct):
    status: thrift.Nested[Status] = thrift.new(lambda: Status())
    gains: list[Pid] = thrift.new(list)


class Details(thrift.Struct):
    status: thrift.Nested[Status] = thrift.new(lambda: Status())
    details: thrift.Nested[PidDetails] = thrift.new(lambda: PidDetails())


class AllDetails(thrift.Struct):
    status: thrift.Nested[Status] = thrift.new(lambda: Status())
    details: list[PidDetails] = thrift.new(list)


class TorqueModel(thrift.Struct):
    status: thrift.Nested[Status] = thrift.new(lambda: Status())
    parameters: TorqueParameters = thrift.new(lambda: TorqueParameters())


class Variable(thrift.Struct):
    status: thrift.Nested[Status] = thrift.new(lambda: Status())
    value: Bottle = thrift.new(yarpy.Bottle)


class VariableNames(thrift.Struct):
    status: thrift.Nested[Status] = thrift.new(lambda: Status())
    names: list[Bottle] = thrift.new(list)


class Interfaces(thrift.Struct):
    status: thrift.Nested[Status] = thrift.new(lambda: Status())
    interfaces: dict[str, bool] = thrift.new(dict)


class ControlBoardMsgs(thrift.Service):
    @thrift.method
    def getAxesRPC(self) -> Count:
        raise NotImplementedError

    @thrift.method
    def getDeviceInterfacesRPC(self) -> Interfaces:
        raise NotImplementedError

    @thrift.method
    def getAxisNameRPC(self, joint: thrift.i32) -> Text:
        raise NotImplementedError

    @thrift.method
    def getJointTypeRPC(self, joint: thrift.i32) -> Count:
        raise NotImplementedError

    @thrift.method
    def positionMoveOneRPC(self, joint: thrift.i32, value: float) -> Status:
        raise NotImplementedError

    @thrift.method
    def positionMoveGroupRPC(self, joints: thrift.Int32s, values: thrift.Float64s) -> Status:
        raise NotImplementedError

    @thrift.method
    def positionMoveAllRPC(self, values: thrift.Float64s) -> Status:
        raise NotImplementedError

    @thrift.method
    def relativeMoveOneRPC(self, joint: thrift.i32, value: float) -> Status:
        raise NotImplementedError

    @thrift.method
    def relativeMoveGroupRPC(self, joints: thrift.Int32s, values: thrift.Float64s) -> Status:
        raise NotImplementedError

    @thrift.method
    def relativeMoveAllRPC(self, values: thrift.Float64s) -> Status:
        raise NotImplementedError

    @thrift.method
    def velocityMoveOneRPC(self, joint: thrift.i32, value: float) -> Status:
        raise NotImplementedError

    @thrift.method
    def velocityMoveGroupRPC(self, joints: thrift.Int32s, values: thrift.Float64s) -> Status:
        raise NotImplementedError

    @thrift.method
    def velocityMoveAllRPC(self, values: thrift.Float64s) -> Status:
        raise NotImplementedError

    @thrift.method
    def setTrajSpeedOneRPC(self, joint: thrift.i32, value: float) -> Status:
        raise NotImplementedError

    @thrift.method
    def setTrajSpeedGroupRPC(self, joints: thrift.Int32s, values: thrift.Float64s) -> Status:
        raise NotImplementedError

    @thrift.method
    def setTrajSpeedAllRPC(self, values: thrift.Float64s) -> Status:
        raise NotImplementedError

    @thrift.method
    def setRefPositionOneRPC(self, joint: thrift.i32, value: float) -> Status:
        raise NotImplementedError

    @thrift.method
    def setRefPositionGroupRPC(self, joints: thrift.Int32s, values: thrift.Float64s) -> Status:
        raise NotImplementedError

    @thrift.method
    def setRefPositionAllRPC(self, values: thrift.Float64s) -> Status:
        raise NotImplementedError

    @thrift.method
    def setRefVelocityOneRPC(self, joint: thrift.i32, value: float) -> Status:
        raise NotImplementedError

    @thrift.method
    def setRefVelocityGroupRPC(self, joints: thrift.Int32s, values: thrift.Float64s) -> Status:
        raise NotImplementedError

    @thrift.method
    def setRefVelocityAllRPC(self, values: thrift.Float64s) -> Status:
        raise NotImplementedError

    @thrift.method
    def setRefTorqueOneRPC(self, joint: thrift.i32, value: float) -> Status:
        raise NotImplementedError

    @thrift.method
    def setRefTorqueGroupRPC(self, joints: thrift.Int32s, values: thrift.Float64s) -> Status:
        raise NotImplementedError

    @thrift.method
    def setRefTorqueAllRPC(self, values: thrift.Float64s) -> Status:
        raise NotImplementedError

    @thrift.method
    def setRefCurrentOneRPC(self, joint: thrift.i32, value: float) -> Status:
        raise NotImplementedError

    @thrift.method
    def setRefCurrentGroupRPC(self, joints: thrift.Int32s, values: thrift.Float64s) -> Status:
        raise NotImplementedError

    @thrift.method
    def setRefCurrentAllRPC(self, values: thrift.Float64s) -> Status:
        raise NotImplementedError

    @thrift.method
    def setRefDutyCycleOneRPC(self, joint: thrift.i32, value: float) -> Status:
        raise NotImplementedError

    @thrift.method
    def setRefDutyCycleGroupRPC(self, joints: thrift.Int32s, values: thrift.Float64s) -> Status:
        raise NotImplementedError

    @thrift.method
    def setRefDutyCycleAllRPC(self, values: thrift.Float64s) -> Status:
        raise NotImplementedError

    @thrift.method
    def setTrajAccelerationOneRPC(self, joint: thrift.i32, value: float) -> Status:
        raise NotImplementedError

    @thrift.method
    def setTrajAccelerationsGroupRPC(
        self,
        joints: thrift.Int32s,
        values: thrift.Float64s,
    ) -> Status:
        raise NotImplementedError

    @thrift.method
    def setTrajAccelerationsAllRPC(self, values: thrift.Float64s) -> Status:
        raise NotImplementedError

    @thrift.method
    def stopOneRPC(self, joint: thrift.i32) -> Status:
        raise NotImplementedError

    @thrift.method
    def stopGroupRPC(self, joints: thrift.Int32s) -> Status:
        raise NotImplementedError

    @thrift.method
    def stopAllRPC(self) -> Status:
        raise NotImplementedError

    @thrift.method
    def getTargetPositionOneRPC(self, joint: thrift.i32) -> Number:
        raise NotImplementedError

    @thrift.method
    def getTargetPositionGroupRPC(self, joints: thrift.Int32s) -> Numbers:
        raise NotImplementedError

    @thrift.method
    def getTargetPositionAllRPC(self) -> Numbers:
        raise NotImplementedError

    @thrift.method
    def getTargetVelocityOneRPC(self, joint: thrift.i32) -> Number:
        raise NotImplementedError

    @thrift.method
    def getTargetVelocityGroupRPC(self, joints: thrift.Int32s) -> Numbers:
        raise NotImplementedError

    @thrift.method
    def getTargetVelocityAllRPC(self) -> Numbers:
        raise NotImplementedError

    @thrift.method
    def getRefPositionOneRPC(self, joint: thrift.i32) -> Number:
        raise NotImplementedError

    @thrift.method
    def getRefPositionGroupRPC(self, joints: thrift.Int32s) -> Numbers:
        raise NotImplementedError

    @thrift.method
    def getRefPositionAllRPC(self) -> Numbers:
        raise NotImplementedError

    @thrift.method
    def getRefVelocityOneRPC(self, joint: thrift.i32) -> Number:
        raise NotImplementedError

    @thrift.method
    def getRefVelocityGroupRPC(self, joints: thrift.Int32s) -> Numbers:
        raise NotImplementedError

    @thrift.method
    def getRefVelocityAllRPC(self) -> Numbers:
        raise NotImplementedError

    @thrift.method
    def getRefTorqueOneRPC(self, joint: thrift.i32) -> Number:
        raise NotImplementedError

    @thrift.method
    def getRefTorqueGroupRPC(self, joints: thrift.Int32s) -> Numbers:
        raise NotImplementedError

    @thrift.method
    def getRefTorqueAllRPC(self) -> Numbers:
        raise NotImplementedError

    @thrift.method
    def getTrajSpeedOneRPC(self, joint: thrift.i32) -> Number:
        raise NotImplementedError

    @thrift.method
    def getTrajSpeedsGroupRPC(self, joints: thrift.Int32s) -> Numbers:
        raise NotImplementedError

    @thrift.method
    def getTrajSpeedsAllRPC(self) -> Numbers:
        raise NotImplementedError

    @thrift.method
    def getTrajAccelerationOneRPC(self, joint: thrift.i32) -> Number:
        raise NotImplementedError

    @thrift.method
    def getTrajAccelerationGroupRPC(self, joints: thrift.Int32s) -> Numbers:
        raise NotImplementedError

    @thrift.method
    def getTrajAccelerationAllRPC(self) -> Numbers:
        raise NotImplementedError

    @thrift.method
    def checkMotionDoneOneRPC(self, joint: thrift.i32) -> Truth:
        raise NotImplementedError

    @thrift.method
    def checkMotionDoneGroupRPC(self, joints: thrift.Int32s) -> Truth:
        raise NotImplementedError

    @thrift.method
    def checkMotionDoneAllRPC(self) -> Truth:
        raise NotImplementedError

    @thrift.method
    def getRefCurrentOneRPC(self, joint: thrift.i32) -> Number:
        raise NotImplementedError

    @thrift.method
    def getRefCurrentAllRPC(self) -> Numbers:
        raise NotImplementedError

    @thrift.method
    def getCurrentOneRPC(self, joint: thrift.i32) -> Number:
        raise NotImplementedError

    @thrift.method
    def getCurrentAllRPC(self) -> Numbers:
        raise NotImplementedError

    @thrift.method
    def getRefDutyCycleOneRPC(self, joint: thrift.i32) -> Number:
        raise NotImplementedError

    @thrift.method
    def getRefDutyCycleAllRPC(self) -> Numbers:
        raise NotImplementedError

    @thrift.method
    def getDutyCycleOneRPC(self, joint: thrift.i32) -> Number:
        raise NotImplementedError

    @thrift.method
    def getDutyCycleAllRPC(self) -> Numbers:
        raise NotImplementedError

    @thrift.method
    def getTemperatureOneRPC(self, joint: thrift.i32) -> Number:
        raise NotImplementedError

    @thrift.method
    def getTemperatureAllRPC(self) -> Numbers:
        raise NotImplementedError

    @thrift.method
    def getEncoderOneRPC(self, joint: thrift.i32) -> Number:
        raise NotImplementedError

    @thrift.method
    def getEncoderAllRPC(self) -> Numbers:
        raise NotImplementedError

    @thrift.method
    def getEncoderSpeedOneRPC(self, joint: thrift.i32) -> Number:
        raise NotImplementedError

    @thrift.method
    def getEncoderSpeedAllRPC(self) -> Numbers:
        raise NotImplementedError

    @thrift.method
    def getEncoderAccelerationOneRPC(self, joint: thrift.i32) -> Number:
        raise NotImplementedError

    @thrift.method
    def getEncoderAccelerationAllRPC(self) -> Numbers:
        raise NotImplementedError

    @thrift.method
    def getMotorEncoderOneRPC(self, joint: thrift.i32) -> Number:
        raise NotImplementedError

    @thrift.method
    def getMotorEncoderAllRPC(self) -> Numbers:
        raise NotImplementedError

    @thrift.method
    def getMotorEncoderSpeedOneRPC(self, joint: thrift.i32) -> Number:
        raise NotImplementedError

    @thrift.method
    def getMotorEncoderSpeedAllRPC(self) -> Numbers:
        raise NotImplementedError

    @thrift.method
    def getMotorEncoderAccelerationOneRPC(self, joint: thrift.i32) -> Number:
        raise NotImplementedError

    @thrift.method
    def getMotorEncoderAccelerationAllRPC(self) -> Numbers:
        raise NotImplementedError

    @thrift.method
    def getEncoderTimedOneRPC(self, joint: thrift.i32) -> Sample:
        raise NotImplementedError

    @thrift.method
    def getEncoderTimedAllRPC(self) -> Samples:
        raise NotImplementedError

    @thrift.method
    def getMotorEncoderTimedOneRPC(self, joint: thrift.i32) -> Sample:
        raise NotImplementedError

    @thrift.method
    def getMotorEncodersTimedAllRPC(self) -> Samples:
        raise NotImplementedError

    @thrift.method
    def getCurrentRangeOneRPC(self, joint: thrift.i32) -> Range:
        raise NotImplementedError

    @thrift.method
    def getCurrentRangeAllRPC(self) -> Ranges:
        raise NotImplementedError

    @thrift.method
    def getTorqueRangeOneRPC(self, joint: thrift.i32) -> Range:
        raise NotImplementedError

    @thrift.method
    def getTorqueRangeAllRPC(self) -> Ranges:
        raise NotImplementedError

    @thrift.method
    def getAmpStatusOneRPC(self, joint: thrift.i32) -> Count:
        raise NotImplementedError

    @thrift.method
    def getAmpStatusAllRPC(self) -> Counts:
        raise NotImplementedError

    @thrift.method
    def getNumberOfMotorEncodersRPC(self) -> Count:
        raise NotImplementedError

    @thrift.method
    def getNumberOfMotorsRPC(self) -> Count:
        raise NotImplementedError

    @thrift.method
    def setControlModeOneRPC(self, joint: thrift.i32, mode: thrift.i32) -> Status:
        raise NotImplementedError

    @thrift.method
    def setControlModeGroupRPC(self, joints: thrift.Int32s, modes: thrift.Int32s) -> Status:
        raise NotImplementedError

    @thrift.method
    def setControlModeAllRPC(self, modes: thrift.Int32s) -> Status:
        raise NotImplementedError

    @thrift.method
    def getAvailableControlModesRPC(self, joint: thrift.i16) -> Counts:
        raise NotImplementedError

    @thrift.method
    def setInteractionModeOneRPC(self, joint: thrift.i32, mode: thrift.i32) -> Status:
        raise NotImplementedError

    @thrift.method
    def setInteractionModesGroupRPC(self, joints: thrift.Int32s, modes: thrift.Int32s) -> Status:
        raise NotImplementedError

    @thrift.method
    def setInteractionModesAllRPC(self, modes: thrift.Int32s) -> Status:
        raise NotImplementedError

    @thrift.method
    def getInteractionModeOneRPC(self, joint: thrift.i32) -> Count:
        raise NotImplementedError

    @thrift.method
    def getInteractionModesGroupRPC(self, joints: thrift.Int32s) -> Counts:
        raise NotImplementedError

    @thrift.method
    def getInteractionModesAllRPC(self) -> Counts:
        raise NotImplementedError

    @thrift.method
    def resetEncoderOneRPC(self, joint: thrift.i32) -> Status:
        raise NotImplementedError

    @thrift.method
    def resetEncoderAllRPC(self) -> Status:
        raise NotImplementedError

    @thrift.method
    def setEncoderOneRPC(self, joint: thrift.i32, value: thrift.i32) -> Status:
        raise NotImplementedError

    @thrift.method
    def setEncoderAllRPC(self, values: thrift.Float64s) -> Status:
        raise NotImplementedError

    @thrift.method
    def resetMotorEncoderRPC(self, joint: thrift.i32) -> Status:
        raise NotImplementedError

    @thrift.method
    def resetMotorEncodersRPC(self) -> Status:
        raise NotImplementedError

    @thrift.method
    def setMotorEncoderRPC(self, joint: thrift.i32, value: float) -> Status:
        raise NotImplementedError

    @thrift.method
    def setMotorEncodersAllRPC(self, values: thrift.Float64s) -> Status:
        raise NotImplementedError

    @thrift.method
    def enablePidRPC(self, kind: thrift.i32, joint: thrift.i16) -> Status:
        raise NotImplementedError

    @thrift.method
    def disablePidRPC(self, kind: thrift.i32, joint: thrift.i16) -> Status:
        raise NotImplementedError

    @thrift.method
    def resetPidRPC(self, kind: thrift.i32, joint: thrift.i16) -> Status:
        raise NotImplementedError

    @thrift.method
    def isPidEnabledRPC(self, kind: thrift.i32, joint: thrift.i16) -> Truth:
        raise NotImplementedError

    @thrift.method
    def getAvailablePidsRPC(self, joint: thrift.i16) -> Counts:
        raise NotImplementedError

    @thrift.method
    def getPidRPC(self, kind: thrift.i32, joint: thrift.i16) -> Gains:
        raise NotImplementedError

    @thrift.method
    def getPidsRPC(self, kind: thrift.i32) -> AllGains:
        raise NotImplementedError

    @thrift.method
    def setPidRPC(self, kind: thrift.i32, joint: thrift.i16, gains: thrift.Nested[Pid]) -> Status:
        raise NotImplementedError

    @thrift.method
    def setPidsRPC(self, kind: thrift.i32, gains: list[Pid]) -> Status:
        raise NotImplementedError

    @thrift.method
    def getPidExtraInfoRPC(self, kind: thrift.i32, joint: thrift.i16) -> Details:
        raise NotImplementedError

    @thrift.method
    def getPidExtraInfosRPC(self, kind: thrift.i32) -> AllDetails:
        raise NotImplementedError

    @thrift.method
    def setPidOffsetOneRPC(self, kind: thrift.i32, joint: thrift.i16, value: float) -> Status:
        raise NotImplementedError

    @thrift.method
    def setPidFeedforwardOneRPC(self, kind: thrift.i32, joint: thrift.i16, value: float) -> Status:
        raise NotImplementedError

    @thrift.method
    def setPidReferenceRPC(self, kind: thrift.i32, joint: thrift.i16, value: float) -> Status:
        raise NotImplementedError

    @thrift.method
    def setPidErrorLimitRPC(self, kind: thrift.i32, joint: thrift.i16, value: float) -> Status:
        raise NotImplementedError

    @thrift.method
    def setPidReferencesRPC(self, kind: thrift.i32, values: thrift.Float64s) -> Status:
        raise NotImplementedError

    @thrift.method
    def setPidErrorLimitsRPC(self, kind: thrift.i32, values: thrift.Float64s) -> Status:
        raise NotImplementedError

    @thrift.method
    def getPidOffsetRPC(self, kind: thrift.i32, joint: thrift.i16) -> Number:
        raise NotImplementedError

    @thrift.method
    def getPidFeedforwardRPC(self, kind: thrift.i32, joint: thrift.i16) -> Number:
        raise NotImplementedError

    @thrift.method
    def getPidReferenceRPC(self, kind: thrift.i32, joint: thrift.i16) -> Number:
        raise NotImplementedError

    @thrift.method
    def getPidErrorLimitRPC(self, kind: thrift.i32, joint: thrift.i16) -> Number:
        raise NotImplementedError

    @thrift.method
    def getPidErrorRPC(self, kind: thrift.i32, joint: thrift.i16) -> Number:
        raise NotImplementedError

    @thrift.method
    def getPidOutputRPC(self, kind: thrift.i32, joint: thrift.i16) -> Number:
        raise NotImplementedError

    @thrift.method
    def getPidReferencesRPC(self, kind: thrift.i32) -> Numbers:
        raise NotImplementedError

    @thrift.method
    def getPidErrorLimitsRPC(self, kind: thrift.i32) -> Numbers:
        raise NotImplementedError

    @thrift.method
    def getPidErrorsRPC(self, kind: thrift.i32) -> Numbers:
        raise NotImplementedError

    @thrift.method
    def getPidOutputsRPC(self, kind: thrift.i32) -> Numbers:
        raise NotImplementedError

    @thrift.method
    def setPosLimitsRPC(self, joint: thrift.i16, low: float, high: float) -> Status:
        raise NotImplementedError

    @thrift.method
    def getPosLimitsRPC(self, joint: thrift.i16) -> Range:
        raise NotImplementedError

    @thrift.method
    def setVelLimitsRPC(self, joint: thrift.i16, low: float, high: float) -> Status:
        raise NotImplementedError

    @thrift.method
    def getVelLimitsRPC(self, joint: thrift.i16) -> Range:
        raise NotImplementedError

    @thrift.method
    def setImpedanceRPC(self, joint: thrift.i32, stiffness: float, damping: float) -> Status:
        raise NotImplementedError

    @thrift.method
    def getImpedanceRPC(self, joint: thrift.i32) -> Impedance:
        raise NotImplementedError

    @thrift.method
    def setImpedanceOffsetRPC(self, joint: thrift.i32, value: float) -> Status:
        raise NotImplementedError

    @thrift.method
    def getImpedanceOffsetRPC(self, joint: thrift.i32) -> Number:
        raise NotImplementedError

    @thrift.method
    def getCurrentImpedanceLimitRPC(self, joint: thrift.i32) -> ImpedanceRange:
        raise NotImplementedError

    @thrift.method
    def setNominalCurrentRPC(self, joint: thrift.i32, value: float) -> Status:
        raise NotImplementedError

    @thrift.method
    def getNominalCurrentRPC(self, joint: thrift.i32) -> Number:
        raise NotImplementedError

    @thrift.method
    def setPeakCurrentRPC(self, joint: thrift.i32, value: float) -> Status:
        raise NotImplementedError

    @thrift.method
    def getPeakCurrentRPC(self, joint: thrift.i32) -> Number:
        raise NotImplementedError

    @thrift.method
    def setPWMLimitRPC(self, joint: thrift.i32, value: float) -> Status:
        raise NotImplementedError

    @thrift.method
    def getPWMLimitRPC(self, joint: thrift.i32) -> Number:
        raise NotImplementedError

    @thrift.method
    def setGearboxRatioRPC(self, joint: thrift.i32, value: float) -> Status:
        raise NotImplementedError

    @thrift.method
    def getGearboxRatioRPC(self, joint: thrift.i32) -> Number:
        raise NotImplementedError

    @thrift.method
    def setTemperatureLimitRPC(self, joint: thrift.i32, value: float) -> Status:
        raise NotImplementedError

    @thrift.method
    def getTemperatureLimitRPC(self, joint: thrift.i32) -> Number:
        raise NotImplementedError

    @thrift.method
    def setMaxCurrentRPC(self, joint: thrift.i32, value: float) -> Status:
        raise NotImplementedError

    @thrift.method
    def getMaxCurrentRPC(self, joint: thrift.i32) -> Number:
        raise NotImplementedError

    @thrift.method
    def setMotorEncoderCountsPerRevolutionRPC(self, joint: thrift.i32, value: float) -> Status:
        raise NotImplementedError

    @thrift.method
    def getMotorEncoderCountsPerRevolutionRPC(self, joint: thrift.i32) -> Number:
        raise NotImplementedError

    @thrift.method
    def getPWMRPC(self, joint: thrift.i32) -> Number:
        raise NotImplementedError

    @thrift.method
    def getPowerSupplyVoltageRPC(self, joint: thrift.i32) -> Number:
        raise NotImplementedError

    @thrift.method
    def enableAmpRPC(self, joint: thrift.i32) -> Status:
        raise NotImplementedError

    @thrift.method
    def disableAmpRPC(self, joint: thrift.i32) -> Status:
        raise NotImplementedError

    @thrift.method
    def setMotorTorqueParamsRPC(self, joint: thrift.i32, parameters: TorqueParameters) -> Status:
        raise NotImplementedError

    @thrift.method
    def getMotorTorqueParamsRPC(self, joint: thrift.i32) -> TorqueModel:
        raise NotImplementedError

    @thrift.method
    def setManualBrakeActiveRPC(self, joint: thrift.i32, active: bool) -> Status:
        raise NotImplementedError

    @thrift.method
    def setAutoBrakeEnabledRPC(self, joint: thrift.i32, enabled: bool) -> Status:
        raise NotImplementedError

    @thrift.method
    def isJointBrakedRPC(self, joint: thrift.i32) -> Truth:
        raise NotImplementedError

    @thrift.method
    def getAutoBrakeEnabledRPC(self, joint: thrift.i32) -> Truth:
        raise NotImplementedError

    @thrift.method
    def isCalibratorDevicePresentRPC(self) -> Truth:
        raise NotImplementedError

    @thrift.method
    def calibrateSingleJointRPC(self, joint: thrift.i32) -> Status:
        raise NotImplementedError

    @thrift.method
    def homingSingleJointRPC(self, joint: thrift.i32) -> Status:
        raise NotImplementedError

    @thrift.method
    def parkSingleJointRPC(self, joint: thrift.i32, wait: bool) -> Status:
        raise NotImplementedError

    @thrift.method
    def calibrateWholePartRPC(self) -> Status:
        raise NotImplementedError

    @thrift.method
    def homingWholePartRPC(self) -> Status:
        raise NotImplementedError

    @thrift.method
    def parkWholePartRPC(self) -> Status:
        raise NotImplementedError

    @thrift.method
    def quitCalibrateRPC(self) -> Status:
        raise NotImplementedError

    @thrift.method
    def quitParkRPC(self) -> Status:
        raise NotImplementedError

    @thrift.method
    def calibrateRobotRPC(self) -> Status:
        raise NotImplementedError

    @thrift.method
    def abortCalibrationRPC(self) -> Status:
        raise NotImplementedError

    @thrift.method
    def abortParkRPC(self) -> Status:
        raise NotImplementedError

    @thrift.method
    def parkRPC(self, wait: bool) -> Status:
        raise NotImplementedError

    @thrift.method
    def calibrateAxisWithParamsRPC(
        self,
        joint: thrift.i32,
        kind: thrift.i32,
        parameter1: float,
        parameter2: float,
        parameter3: float,
    ) -> Status:
        raise NotImplementedError

    @thrift.method
    def setCalibrationParametersRPC(self, joint: thrift.i32, parameters: Calibration) -> Status:
        raise NotImplementedError

    @thrift.method
    def calibrationDoneRPC(self, joint: thrift.i32) -> Status:
        raise NotImplementedError

    @thrift.method
    def getLastJointFaultRPC(self, joint: thrift.i32) -> Fault:
        raise NotImplementedError

    @thrift.method
    def getRemoteVariableRPC(self, key: str) -> Variable:
        raise NotImplementedError

    @thrift.method
    def setRemoteVariableRPC(self, key: str, value: Bottle) -> Status:
        raise NotImplementedError

    @thrift.method
    def getRemoteVariablesListRPC(self) -> VariableNames:
        raise NotImplementedError


connect = ControlBoardMsgs.connect
connect_async = ControlBoardMsgs.connect_async
