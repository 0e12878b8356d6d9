/* The control board of YARP 4: what `/robot/part/nws/rpc:i` is asked.
 *
 * Every answer begins with a Status. Angles are in degrees, speeds in degrees per second, torques
 * in Nm, currents in A, duty cycles in percent. Modes and kinds of controllers are vocabs that
 * travel as numbers. Speeds and accelerations with `Traj` are those of position moves.
 */

typedef i32 (yarp.type = "yarp::conf::vocab32_t") vocab

/** The outcome of a call: ok, or err1 (failed) ... err7, miss. */
struct Status { 1: vocab code }

/** The gains of a controller. */
struct Pid {
  1: double kp, 2: double kd, 3: double ki,
  4: double max_integral, 5: double scale, 6: double max_output, 7: double offset,
  8: double stiction_up, 9: double stiction_down, 10: double feed_forward
}

/** Texts about a controller: three, and one for each gain. */
struct PidDetails {
  1: string description, 2: string input, 3: string output,
  4: string kp, 5: string kd, 6: string ki, 7: string max_integral, 8: string scale,
  9: string max_output, 10: string offset, 11: string stiction_up, 12: string stiction_down,
  13: string feed_forward
}

/** The parameters by which a motor produces torque. */
struct TorqueParameters {
  1: double bemf, 2: double bemf_scale, 3: double ktau, 4: double ktau_scale,
  5: double viscous_positive, 6: double viscous_negative,
  7: double coulomb_positive, 8: double coulomb_negative, 9: double velocity_threshold
}

/** The parameters by which a joint is calibrated. */
struct Calibration {
  1: i32 kind, 2: double parameter1, 3: double parameter2, 4: double parameter3,
  5: double parameter4, 6: double parameter5, 7: double zero
}

struct Bottle {} (yarp.name = "yarp::os::Bottle" yarp.includefile = "yarp/os/Bottle.h")

struct Number { 1: Status status (yarp.nested = "true"), 2: double value }
struct Numbers { 1: Status status (yarp.nested = "true"), 2: list<double> values }
struct Sample { 1: Status status (yarp.nested = "true"), 2: double value, 3: double time }
struct Samples {
  1: Status status (yarp.nested = "true"),
  2: list<double> values, 3: list<double> times
}
struct Range { 1: Status status (yarp.nested = "true"), 2: double low, 3: double high }
struct Ranges { 1: Status status (yarp.nested = "true"), 2: list<double> low, 3: list<double> high }
struct Truth { 1: Status status (yarp.nested = "true"), 2: bool value }
struct Count { 1: Status status (yarp.nested = "true"), 2: i32 value }
struct Counts { 1: Status status (yarp.nested = "true"), 2: list<i32> values }
struct Text { 1: Status status (yarp.nested = "true"), 2: string value }
struct Fault { 1: Status status (yarp.nested = "true"), 2: i32 code, 3: string text }
struct Impedance { 1: Status status (yarp.nested = "true"), 2: double stiffness, 3: double damping }
struct ImpedanceRange {
  1: Status status (yarp.nested = "true"),
  2: double stiffness_low, 3: double stiffness_high, 4: double damping_low, 5: double damping_high
}
struct Gains { 1: Status status (yarp.nested = "true"), 2: Pid gains (yarp.nested = "true") }
struct AllGains { 1: Status status (yarp.nested = "true"), 2: list<Pid> gains }
struct Details {
  1: Status status (yarp.nested = "true"),
  2: PidDetails details (yarp.nested = "true")
}
struct AllDetails { 1: Status status (yarp.nested = "true"), 2: list<PidDetails> details }
struct TorqueModel { 1: Status status (yarp.nested = "true"), 2: TorqueParameters parameters }
struct Variable { 1: Status status (yarp.nested = "true"), 2: Bottle value }
struct VariableNames { 1: Status status (yarp.nested = "true"), 2: list<Bottle> names }
struct Interfaces { 1: Status status (yarp.nested = "true"), 2: map<string, bool> interfaces }

service ControlBoardMsgs {

  // what there is
  Count getAxesRPC();
  Interfaces getDeviceInterfacesRPC();
  Text getAxisNameRPC(1: i32 joint);
  Count getJointTypeRPC(1: i32 joint);

  // moves
  Status positionMoveOneRPC(1: i32 joint, 2: double value);
  Status positionMoveGroupRPC(1: list<i32> joints, 2: list<double> values);
  Status positionMoveAllRPC(1: list<double> values);
  Status relativeMoveOneRPC(1: i32 joint, 2: double value);
  Status relativeMoveGroupRPC(1: list<i32> joints, 2: list<double> values);
  Status relativeMoveAllRPC(1: list<double> values);
  Status velocityMoveOneRPC(1: i32 joint, 2: double value);
  Status velocityMoveGroupRPC(1: list<i32> joints, 2: list<double> values);
  Status velocityMoveAllRPC(1: list<double> values);
  Status setTrajSpeedOneRPC(1: i32 joint, 2: double value);
  Status setTrajSpeedGroupRPC(1: list<i32> joints, 2: list<double> values);
  Status setTrajSpeedAllRPC(1: list<double> values);
  Status setRefPositionOneRPC(1: i32 joint, 2: double value);
  Status setRefPositionGroupRPC(1: list<i32> joints, 2: list<double> values);
  Status setRefPositionAllRPC(1: list<double> values);
  Status setRefVelocityOneRPC(1: i32 joint, 2: double value);
  Status setRefVelocityGroupRPC(1: list<i32> joints, 2: list<double> values);
  Status setRefVelocityAllRPC(1: list<double> values);
  Status setRefTorqueOneRPC(1: i32 joint, 2: double value);
  Status setRefTorqueGroupRPC(1: list<i32> joints, 2: list<double> values);
  Status setRefTorqueAllRPC(1: list<double> values);
  Status setRefCurrentOneRPC(1: i32 joint, 2: double value);
  Status setRefCurrentGroupRPC(1: list<i32> joints, 2: list<double> values);
  Status setRefCurrentAllRPC(1: list<double> values);
  Status setRefDutyCycleOneRPC(1: i32 joint, 2: double value);
  Status setRefDutyCycleGroupRPC(1: list<i32> joints, 2: list<double> values);
  Status setRefDutyCycleAllRPC(1: list<double> values);
  Status setTrajAccelerationOneRPC(1: i32 joint, 2: double value);
  Status setTrajAccelerationsGroupRPC(1: list<i32> joints, 2: list<double> values);
  Status setTrajAccelerationsAllRPC(1: list<double> values);
  Status stopOneRPC(1: i32 joint);
  Status stopGroupRPC(1: list<i32> joints);
  Status stopAllRPC();

  // what was commanded, and whether it is done
  Number getTargetPositionOneRPC(1: i32 joint);
  Numbers getTargetPositionGroupRPC(1: list<i32> joints);
  Numbers getTargetPositionAllRPC();
  Number getTargetVelocityOneRPC(1: i32 joint);
  Numbers getTargetVelocityGroupRPC(1: list<i32> joints);
  Numbers getTargetVelocityAllRPC();
  Number getRefPositionOneRPC(1: i32 joint);
  Numbers getRefPositionGroupRPC(1: list<i32> joints);
  Numbers getRefPositionAllRPC();
  Number getRefVelocityOneRPC(1: i32 joint);
  Numbers getRefVelocityGroupRPC(1: list<i32> joints);
  Numbers getRefVelocityAllRPC();
  Number getRefTorqueOneRPC(1: i32 joint);
  Numbers getRefTorqueGroupRPC(1: list<i32> joints);
  Numbers getRefTorqueAllRPC();
  Number getTrajSpeedOneRPC(1: i32 joint);
  Numbers getTrajSpeedsGroupRPC(1: list<i32> joints);
  Numbers getTrajSpeedsAllRPC();
  Number getTrajAccelerationOneRPC(1: i32 joint);
  Numbers getTrajAccelerationGroupRPC(1: list<i32> joints);
  Numbers getTrajAccelerationAllRPC();
  Truth checkMotionDoneOneRPC(1: i32 joint);
  Truth checkMotionDoneGroupRPC(1: list<i32> joints);
  Truth checkMotionDoneAllRPC();

  // what is measured
  Number getRefCurrentOneRPC(1: i32 joint);
  Numbers getRefCurrentAllRPC();
  Number getCurrentOneRPC(1: i32 joint);
  Numbers getCurrentAllRPC();
  Number getRefDutyCycleOneRPC(1: i32 joint);
  Numbers getRefDutyCycleAllRPC();
  Number getDutyCycleOneRPC(1: i32 joint);
  Numbers getDutyCycleAllRPC();
  Number getTemperatureOneRPC(1: i32 joint);
  Numbers getTemperatureAllRPC();
  Number getEncoderOneRPC(1: i32 joint);
  Numbers getEncoderAllRPC();
  Number getEncoderSpeedOneRPC(1: i32 joint);
  Numbers getEncoderSpeedAllRPC();
  Number getEncoderAccelerationOneRPC(1: i32 joint);
  Numbers getEncoderAccelerationAllRPC();
  Number getMotorEncoderOneRPC(1: i32 joint);
  Numbers getMotorEncoderAllRPC();
  Number getMotorEncoderSpeedOneRPC(1: i32 joint);
  Numbers getMotorEncoderSpeedAllRPC();
  Number getMotorEncoderAccelerationOneRPC(1: i32 joint);
  Numbers getMotorEncoderAccelerationAllRPC();
  Sample getEncoderTimedOneRPC(1: i32 joint);
  Samples getEncoderTimedAllRPC();
  Sample getMotorEncoderTimedOneRPC(1: i32 joint);
  Samples getMotorEncodersTimedAllRPC();
  Range getCurrentRangeOneRPC(1: i32 joint);
  Ranges getCurrentRangeAllRPC();
  Range getTorqueRangeOneRPC(1: i32 joint);
  Ranges getTorqueRangeAllRPC();
  Count getAmpStatusOneRPC(1: i32 joint);
  Counts getAmpStatusAllRPC();
  Count getNumberOfMotorEncodersRPC();
  Count getNumberOfMotorsRPC();

  // modes
  Status setControlModeOneRPC(1: i32 joint, 2: i32 mode);
  Status setControlModeGroupRPC(1: list<i32> joints, 2: list<i32> modes);
  Status setControlModeAllRPC(1: list<i32> modes);
  Counts getAvailableControlModesRPC(1: i16 joint);
  Status setInteractionModeOneRPC(1: i32 joint, 2: i32 mode);
  Status setInteractionModesGroupRPC(1: list<i32> joints, 2: list<i32> modes);
  Status setInteractionModesAllRPC(1: list<i32> modes);
  Count getInteractionModeOneRPC(1: i32 joint);
  Counts getInteractionModesGroupRPC(1: list<i32> joints);
  Counts getInteractionModesAllRPC();

  // encoders: set to a value (of one joint: a whole number), or to zero
  Status resetEncoderOneRPC(1: i32 joint);
  Status resetEncoderAllRPC();
  Status setEncoderOneRPC(1: i32 joint, 2: i32 value);
  Status setEncoderAllRPC(1: list<double> values);
  Status resetMotorEncoderRPC(1: i32 joint);
  Status resetMotorEncodersRPC();
  Status setMotorEncoderRPC(1: i32 joint, 2: double value);
  Status setMotorEncodersAllRPC(1: list<double> values);

  // controllers
  Status enablePidRPC(1: i32 kind, 2: i16 joint);
  Status disablePidRPC(1: i32 kind, 2: i16 joint);
  Status resetPidRPC(1: i32 kind, 2: i16 joint);
  Truth isPidEnabledRPC(1: i32 kind, 2: i16 joint);
  Counts getAvailablePidsRPC(1: i16 joint);
  Gains getPidRPC(1: i32 kind, 2: i16 joint);
  AllGains getPidsRPC(1: i32 kind);
  Status setPidRPC(1: i32 kind, 2: i16 joint, 3: Pid gains (yarp.nested = "true"));
  Status setPidsRPC(1: i32 kind, 2: list<Pid> gains);
  Details getPidExtraInfoRPC(1: i32 kind, 2: i16 joint);
  AllDetails getPidExtraInfosRPC(1: i32 kind);
  Status setPidOffsetOneRPC(1: i32 kind, 2: i16 joint, 3: double value);
  Status setPidFeedforwardOneRPC(1: i32 kind, 2: i16 joint, 3: double value);
  Status setPidReferenceRPC(1: i32 kind, 2: i16 joint, 3: double value);
  Status setPidErrorLimitRPC(1: i32 kind, 2: i16 joint, 3: double value);
  Status setPidReferencesRPC(1: i32 kind, 2: list<double> values);
  Status setPidErrorLimitsRPC(1: i32 kind, 2: list<double> values);
  Number getPidOffsetRPC(1: i32 kind, 2: i16 joint);
  Number getPidFeedforwardRPC(1: i32 kind, 2: i16 joint);
  Number getPidReferenceRPC(1: i32 kind, 2: i16 joint);
  Number getPidErrorLimitRPC(1: i32 kind, 2: i16 joint);
  Number getPidErrorRPC(1: i32 kind, 2: i16 joint);
  Number getPidOutputRPC(1: i32 kind, 2: i16 joint);
  Numbers getPidReferencesRPC(1: i32 kind);
  Numbers getPidErrorLimitsRPC(1: i32 kind);
  Numbers getPidErrorsRPC(1: i32 kind);
  Numbers getPidOutputsRPC(1: i32 kind);

  // limits, impedance
  Status setPosLimitsRPC(1: i16 joint, 2: double low, 3: double high);
  Range getPosLimitsRPC(1: i16 joint);
  Status setVelLimitsRPC(1: i16 joint, 2: double low, 3: double high);
  Range getVelLimitsRPC(1: i16 joint);
  Status setImpedanceRPC(1: i32 joint, 2: double stiffness, 3: double damping);
  Impedance getImpedanceRPC(1: i32 joint);
  Status setImpedanceOffsetRPC(1: i32 joint, 2: double value);
  Number getImpedanceOffsetRPC(1: i32 joint);
  ImpedanceRange getCurrentImpedanceLimitRPC(1: i32 joint);

  // motors
  Status setNominalCurrentRPC(1: i32 joint, 2: double value);
  Number getNominalCurrentRPC(1: i32 joint);
  Status setPeakCurrentRPC(1: i32 joint, 2: double value);
  Number getPeakCurrentRPC(1: i32 joint);
  Status setPWMLimitRPC(1: i32 joint, 2: double value);
  Number getPWMLimitRPC(1: i32 joint);
  Status setGearboxRatioRPC(1: i32 joint, 2: double value);
  Number getGearboxRatioRPC(1: i32 joint);
  Status setTemperatureLimitRPC(1: i32 joint, 2: double value);
  Number getTemperatureLimitRPC(1: i32 joint);
  Status setMaxCurrentRPC(1: i32 joint, 2: double value);
  Number getMaxCurrentRPC(1: i32 joint);
  Status setMotorEncoderCountsPerRevolutionRPC(1: i32 joint, 2: double value);
  Number getMotorEncoderCountsPerRevolutionRPC(1: i32 joint);
  Number getPWMRPC(1: i32 joint);
  Number getPowerSupplyVoltageRPC(1: i32 joint);
  Status enableAmpRPC(1: i32 joint);
  Status disableAmpRPC(1: i32 joint);
  Status setMotorTorqueParamsRPC(1: i32 joint, 2: TorqueParameters parameters);
  TorqueModel getMotorTorqueParamsRPC(1: i32 joint);

  // brakes
  Status setManualBrakeActiveRPC(1: i32 joint, 2: bool active);
  Status setAutoBrakeEnabledRPC(1: i32 joint, 2: bool enabled);
  Truth isJointBrakedRPC(1: i32 joint);
  Truth getAutoBrakeEnabledRPC(1: i32 joint);

  // calibration
  Truth isCalibratorDevicePresentRPC();
  Status calibrateSingleJointRPC(1: i32 joint);
  Status homingSingleJointRPC(1: i32 joint);
  Status parkSingleJointRPC(1: i32 joint, 2: bool wait);
  Status calibrateWholePartRPC();
  Status homingWholePartRPC();
  Status parkWholePartRPC();
  Status quitCalibrateRPC();
  Status quitParkRPC();
  Status calibrateRobotRPC();
  Status abortCalibrationRPC();
  Status abortParkRPC();
  Status parkRPC(1: bool wait);
  Status calibrateAxisWithParamsRPC(
    1: i32 joint, 2: i32 kind, 3: double parameter1, 4: double parameter2, 5: double parameter3);
  Status setCalibrationParametersRPC(1: i32 joint, 2: Calibration parameters);
  Status calibrationDoneRPC(1: i32 joint);

  // faults, variables
  Fault getLastJointFaultRPC(1: i32 joint);
  Variable getRemoteVariableRPC(1: string key);
  Status setRemoteVariableRPC(1: string key, 2: Bottle value);
  VariableNames getRemoteVariablesListRPC();
}
