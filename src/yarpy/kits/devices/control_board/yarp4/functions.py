"""The control board of YARP 4: what `/robot/part/nws/rpc:i` is asked.

Every answer begins with a Status. Angles are in degrees, speeds in degrees per second, torques
in Nm, currents in A, duty cycles in percent. Modes and kinds of controllers are vocabs that
travel as numbers. Speeds and accelerations with `Traj` are those of position moves.
"""

from typing import Annotated

import yarpy
from yarpy.kits.devices.declared import Answer, Status, function
from yarpy.kits.thrift.kind import External, Float64s, Int32s, Nested, i16, i32
from yarpy.kits.thrift.service import Service
from yarpy.kits.thrift.structure import Struct, new


class Pid(Struct):
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


class PidDetails(Struct):
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


class TorqueParameters(Struct):
    """The parameters by which a motor produces torque."""

    bemf: float = 0.0
    bemf_scale: float = 0.0
    ktau: float = 0.0
    ktau_scale: float = 0.0
    viscous_positive: float = 0.0
    viscous_negative: float = 0.0
    coulomb_positive: float = 0.0
    coulomb_negative: float = 0.0
    velocity_threshold: float = 0.0


class Calibration(Struct):
    """The parameters by which a joint is calibrated."""

    kind: i32 = 0
    parameter1: float = 0.0
    parameter2: float = 0.0
    parameter3: float = 0.0
    parameter4: float = 0.0
    parameter5: float = 0.0
    zero: float = 0.0


Bottle = Annotated[yarpy.Bottle, External("yarp::os::Bottle", 1, "yarpy.Bottle")]


class Number(Answer):
    value: float = 0.0


class Numbers(Answer):
    values: Float64s = new(list)


class Sample(Answer):
    value: float = 0.0
    time: float = 0.0


class Samples(Answer):
    values: Float64s = new(list)
    times: Float64s = new(list)


class Range(Answer):
    low: float = 0.0
    high: float = 0.0


class Ranges(Answer):
    low: Float64s = new(list)
    high: Float64s = new(list)


class Truth(Answer):
    value: bool = False


class Count(Answer):
    value: i32 = 0


class Counts(Answer):
    values: Int32s = new(list)


class Text(Answer):
    value: str = ""


class Fault(Answer):
    code: i32 = 0
    text: str = ""


class Impedance(Answer):
    stiffness: float = 0.0
    damping: float = 0.0


class ImpedanceRange(Answer):
    stiffness_low: float = 0.0
    stiffness_high: float = 0.0
    damping_low: float = 0.0
    damping_high: float = 0.0


class Gains(Answer):
    gains: Nested[Pid] = new(Pid)


class AllGains(Answer):
    gains: list[Pid] = new(list)


class Details(Answer):
    details: Nested[PidDetails] = new(PidDetails)


class AllDetails(Answer):
    details: list[PidDetails] = new(list)


class TorqueModel(Answer):
    parameters: TorqueParameters = new(TorqueParameters)


class Variable(Answer):
    value: Bottle = new(yarpy.Bottle)


class VariableNames(Answer):
    names: list[Bottle] = new(list)


class Interfaces(Answer):
    interfaces: dict[str, bool] = new(dict)


class ControlBoardMsgs(Service):
    # what there is
    getAxesRPC = function(Count)
    getDeviceInterfacesRPC = function(Interfaces)
    getAxisNameRPC = function(Text, joint=i32)
    getJointTypeRPC = function(Count, joint=i32)

    # moves
    positionMoveOneRPC = function(Status, joint=i32, value=float)
    positionMoveGroupRPC = function(Status, joints=Int32s, values=Float64s)
    positionMoveAllRPC = function(Status, values=Float64s)
    relativeMoveOneRPC = function(Status, joint=i32, value=float)
    relativeMoveGroupRPC = function(Status, joints=Int32s, values=Float64s)
    relativeMoveAllRPC = function(Status, values=Float64s)
    velocityMoveOneRPC = function(Status, joint=i32, value=float)
    velocityMoveGroupRPC = function(Status, joints=Int32s, values=Float64s)
    velocityMoveAllRPC = function(Status, values=Float64s)
    setTrajSpeedOneRPC = function(Status, joint=i32, value=float)
    setTrajSpeedGroupRPC = function(Status, joints=Int32s, values=Float64s)
    setTrajSpeedAllRPC = function(Status, values=Float64s)
    setRefPositionOneRPC = function(Status, joint=i32, value=float)
    setRefPositionGroupRPC = function(Status, joints=Int32s, values=Float64s)
    setRefPositionAllRPC = function(Status, values=Float64s)
    setRefVelocityOneRPC = function(Status, joint=i32, value=float)
    setRefVelocityGroupRPC = function(Status, joints=Int32s, values=Float64s)
    setRefVelocityAllRPC = function(Status, values=Float64s)
    setRefTorqueOneRPC = function(Status, joint=i32, value=float)
    setRefTorqueGroupRPC = function(Status, joints=Int32s, values=Float64s)
    setRefTorqueAllRPC = function(Status, values=Float64s)
    setRefCurrentOneRPC = function(Status, joint=i32, value=float)
    setRefCurrentGroupRPC = function(Status, joints=Int32s, values=Float64s)
    setRefCurrentAllRPC = function(Status, values=Float64s)
    setRefDutyCycleOneRPC = function(Status, joint=i32, value=float)
    setRefDutyCycleGroupRPC = function(Status, joints=Int32s, values=Float64s)
    setRefDutyCycleAllRPC = function(Status, values=Float64s)
    setTrajAccelerationOneRPC = function(Status, joint=i32, value=float)
    setTrajAccelerationsGroupRPC = function(Status, joints=Int32s, values=Float64s)
    setTrajAccelerationsAllRPC = function(Status, values=Float64s)
    stopOneRPC = function(Status, joint=i32)
    stopGroupRPC = function(Status, joints=Int32s)
    stopAllRPC = function(Status)

    # what was commanded, and whether it is done
    getTargetPositionOneRPC = function(Number, joint=i32)
    getTargetPositionGroupRPC = function(Numbers, joints=Int32s)
    getTargetPositionAllRPC = function(Numbers)
    getTargetVelocityOneRPC = function(Number, joint=i32)
    getTargetVelocityGroupRPC = function(Numbers, joints=Int32s)
    getTargetVelocityAllRPC = function(Numbers)
    getRefPositionOneRPC = function(Number, joint=i32)
    getRefPositionGroupRPC = function(Numbers, joints=Int32s)
    getRefPositionAllRPC = function(Numbers)
    getRefVelocityOneRPC = function(Number, joint=i32)
    getRefVelocityGroupRPC = function(Numbers, joints=Int32s)
    getRefVelocityAllRPC = function(Numbers)
    getRefTorqueOneRPC = function(Number, joint=i32)
    getRefTorqueGroupRPC = function(Numbers, joints=Int32s)
    getRefTorqueAllRPC = function(Numbers)
    getTrajSpeedOneRPC = function(Number, joint=i32)
    getTrajSpeedsGroupRPC = function(Numbers, joints=Int32s)
    getTrajSpeedsAllRPC = function(Numbers)
    getTrajAccelerationOneRPC = function(Number, joint=i32)
    getTrajAccelerationGroupRPC = function(Numbers, joints=Int32s)
    getTrajAccelerationAllRPC = function(Numbers)
    checkMotionDoneOneRPC = function(Truth, joint=i32)
    checkMotionDoneGroupRPC = function(Truth, joints=Int32s)
    checkMotionDoneAllRPC = function(Truth)

    # what is measured
    getRefCurrentOneRPC = function(Number, joint=i32)
    getRefCurrentAllRPC = function(Numbers)
    getCurrentOneRPC = function(Number, joint=i32)
    getCurrentAllRPC = function(Numbers)
    getRefDutyCycleOneRPC = function(Number, joint=i32)
    getRefDutyCycleAllRPC = function(Numbers)
    getDutyCycleOneRPC = function(Number, joint=i32)
    getDutyCycleAllRPC = function(Numbers)
    getTemperatureOneRPC = function(Number, joint=i32)
    getTemperatureAllRPC = function(Numbers)
    getEncoderOneRPC = function(Number, joint=i32)
    getEncoderAllRPC = function(Numbers)
    getEncoderSpeedOneRPC = function(Number, joint=i32)
    getEncoderSpeedAllRPC = function(Numbers)
    getEncoderAccelerationOneRPC = function(Number, joint=i32)
    getEncoderAccelerationAllRPC = function(Numbers)
    getMotorEncoderOneRPC = function(Number, joint=i32)
    getMotorEncoderAllRPC = function(Numbers)
    getMotorEncoderSpeedOneRPC = function(Number, joint=i32)
    getMotorEncoderSpeedAllRPC = function(Numbers)
    getMotorEncoderAccelerationOneRPC = function(Number, joint=i32)
    getMotorEncoderAccelerationAllRPC = function(Numbers)
    getEncoderTimedOneRPC = function(Sample, joint=i32)
    getEncoderTimedAllRPC = function(Samples)
    getMotorEncoderTimedOneRPC = function(Sample, joint=i32)
    getMotorEncodersTimedAllRPC = function(Samples)
    getCurrentRangeOneRPC = function(Range, joint=i32)
    getCurrentRangeAllRPC = function(Ranges)
    getTorqueRangeOneRPC = function(Range, joint=i32)
    getTorqueRangeAllRPC = function(Ranges)
    getAmpStatusOneRPC = function(Count, joint=i32)
    getAmpStatusAllRPC = function(Counts)
    getNumberOfMotorEncodersRPC = function(Count)
    getNumberOfMotorsRPC = function(Count)

    # modes
    setControlModeOneRPC = function(Status, joint=i32, mode=i32)
    setControlModeGroupRPC = function(Status, joints=Int32s, modes=Int32s)
    setControlModeAllRPC = function(Status, modes=Int32s)
    getAvailableControlModesRPC = function(Counts, joint=i16)
    setInteractionModeOneRPC = function(Status, joint=i32, mode=i32)
    setInteractionModesGroupRPC = function(Status, joints=Int32s, modes=Int32s)
    setInteractionModesAllRPC = function(Status, modes=Int32s)
    getInteractionModeOneRPC = function(Count, joint=i32)
    getInteractionModesGroupRPC = function(Counts, joints=Int32s)
    getInteractionModesAllRPC = function(Counts)

    # encoders: set to a value (of one joint: a whole number), or to zero
    resetEncoderOneRPC = function(Status, joint=i32)
    resetEncoderAllRPC = function(Status)
    setEncoderOneRPC = function(Status, joint=i32, value=i32)
    setEncoderAllRPC = function(Status, values=Float64s)
    resetMotorEncoderRPC = function(Status, joint=i32)
    resetMotorEncodersRPC = function(Status)
    setMotorEncoderRPC = function(Status, joint=i32, value=float)
    setMotorEncodersAllRPC = function(Status, values=Float64s)

    # controllers
    enablePidRPC = function(Status, kind=i32, joint=i16)
    disablePidRPC = function(Status, kind=i32, joint=i16)
    resetPidRPC = function(Status, kind=i32, joint=i16)
    isPidEnabledRPC = function(Truth, kind=i32, joint=i16)
    getAvailablePidsRPC = function(Counts, joint=i16)
    getPidRPC = function(Gains, kind=i32, joint=i16)
    getPidsRPC = function(AllGains, kind=i32)
    setPidRPC = function(Status, kind=i32, joint=i16, gains=Nested[Pid])
    setPidsRPC = function(Status, kind=i32, gains=list[Pid])
    getPidExtraInfoRPC = function(Details, kind=i32, joint=i16)
    getPidExtraInfosRPC = function(AllDetails, kind=i32)
    setPidOffsetOneRPC = function(Status, kind=i32, joint=i16, value=float)
    setPidFeedforwardOneRPC = function(Status, kind=i32, joint=i16, value=float)
    setPidReferenceRPC = function(Status, kind=i32, joint=i16, value=float)
    setPidErrorLimitRPC = function(Status, kind=i32, joint=i16, value=float)
    setPidReferencesRPC = function(Status, kind=i32, values=Float64s)
    setPidErrorLimitsRPC = function(Status, kind=i32, values=Float64s)
    getPidOffsetRPC = function(Number, kind=i32, joint=i16)
    getPidFeedforwardRPC = function(Number, kind=i32, joint=i16)
    getPidReferenceRPC = function(Number, kind=i32, joint=i16)
    getPidErrorLimitRPC = function(Number, kind=i32, joint=i16)
    getPidErrorRPC = function(Number, kind=i32, joint=i16)
    getPidOutputRPC = function(Number, kind=i32, joint=i16)
    getPidReferencesRPC = function(Numbers, kind=i32)
    getPidErrorLimitsRPC = function(Numbers, kind=i32)
    getPidErrorsRPC = function(Numbers, kind=i32)
    getPidOutputsRPC = function(Numbers, kind=i32)

    # limits, impedance
    setPosLimitsRPC = function(Status, joint=i16, low=float, high=float)
    getPosLimitsRPC = function(Range, joint=i16)
    setVelLimitsRPC = function(Status, joint=i16, low=float, high=float)
    getVelLimitsRPC = function(Range, joint=i16)
    setImpedanceRPC = function(Status, joint=i32, stiffness=float, damping=float)
    getImpedanceRPC = function(Impedance, joint=i32)
    setImpedanceOffsetRPC = function(Status, joint=i32, value=float)
    getImpedanceOffsetRPC = function(Number, joint=i32)
    getCurrentImpedanceLimitRPC = function(ImpedanceRange, joint=i32)

    # motors
    setNominalCurrentRPC = function(Status, joint=i32, value=float)
    getNominalCurrentRPC = function(Number, joint=i32)
    setPeakCurrentRPC = function(Status, joint=i32, value=float)
    getPeakCurrentRPC = function(Number, joint=i32)
    setPWMLimitRPC = function(Status, joint=i32, value=float)
    getPWMLimitRPC = function(Number, joint=i32)
    setGearboxRatioRPC = function(Status, joint=i32, value=float)
    getGearboxRatioRPC = function(Number, joint=i32)
    setTemperatureLimitRPC = function(Status, joint=i32, value=float)
    getTemperatureLimitRPC = function(Number, joint=i32)
    setMaxCurrentRPC = function(Status, joint=i32, value=float)
    getMaxCurrentRPC = function(Number, joint=i32)
    setMotorEncoderCountsPerRevolutionRPC = function(Status, joint=i32, value=float)
    getMotorEncoderCountsPerRevolutionRPC = function(Number, joint=i32)
    getPWMRPC = function(Number, joint=i32)
    getPowerSupplyVoltageRPC = function(Number, joint=i32)
    enableAmpRPC = function(Status, joint=i32)
    disableAmpRPC = function(Status, joint=i32)
    setMotorTorqueParamsRPC = function(Status, joint=i32, parameters=TorqueParameters)
    getMotorTorqueParamsRPC = function(TorqueModel, joint=i32)

    # brakes
    setManualBrakeActiveRPC = function(Status, joint=i32, active=bool)
    setAutoBrakeEnabledRPC = function(Status, joint=i32, enabled=bool)
    isJointBrakedRPC = function(Truth, joint=i32)
    getAutoBrakeEnabledRPC = function(Truth, joint=i32)

    # calibration
    isCalibratorDevicePresentRPC = function(Truth)
    calibrateSingleJointRPC = function(Status, joint=i32)
    homingSingleJointRPC = function(Status, joint=i32)
    parkSingleJointRPC = function(Status, joint=i32, wait=bool)
    calibrateWholePartRPC = function(Status)
    homingWholePartRPC = function(Status)
    parkWholePartRPC = function(Status)
    quitCalibrateRPC = function(Status)
    quitParkRPC = function(Status)
    calibrateRobotRPC = function(Status)
    abortCalibrationRPC = function(Status)
    abortParkRPC = function(Status)
    parkRPC = function(Status, wait=bool)
    calibrateAxisWithParamsRPC = function(
        Status, joint=i32, kind=i32, parameter1=float, parameter2=float, parameter3=float
    )
    setCalibrationParametersRPC = function(Status, joint=i32, parameters=Calibration)
    calibrationDoneRPC = function(Status, joint=i32)

    # faults, variables
    getLastJointFaultRPC = function(Fault, joint=i32)
    getRemoteVariableRPC = function(Variable, key=str)
    setRemoteVariableRPC = function(Status, key=str, value=Bottle)
    getRemoteVariablesListRPC = function(VariableNames)
