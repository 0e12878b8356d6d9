"""Which module of this package has which name."""

from __future__ import annotations

_MODULES = {
    "_value": "Value",
    "_bottle": "Bottle",
    "_property": "Property",
    "_searchable": "Searchable SearchMonitor SearchReport",
    "_type": "Type",
    "_things": "Things DummyConnector",
    "_iterator": "SwigPyIterator",
    "_environment": "path_separator get_string get_path get_bool is_set set_string set_path "
    "set_bool unset getEnvironment setEnvironment unsetEnvironment home tempdir datahome datadirs "
    "confighome configdirs cachehome runtimedir yarpdatahome yarpdatadirs yarpconfighome "
    "yarpconfigdirs yarpcachehome yarpruntimedir",
    "_portable": "Portable PortReader PortWriter PortReaderCreator",
    "_connection": "ConnectionReader ConnectionWriter",
    "_contact": "Contact ContactStyle",
    "_nested_contact": "NestedContact",
    "_portable_pair": "PortablePair PortablePairBase",
    "_contactable": "Contactable PortReport PortInfo",
    "_abstract_contactable": "UnbufferedContactable AbstractContactable",
    "_stamp": "Stamp",
    "_time": "Time delay now yield_c turboBoost isValid useSystemClock useNetworkClock "
    "useCustomClock isSystemClock isNetworkClock isCustomClock isClockInitialized getClockType "
    "clockTypeToString YARP_CLOCK_UNINITIALIZED YARP_CLOCK_DEFAULT YARP_CLOCK_SYSTEM "
    "YARP_CLOCK_NETWORK YARP_CLOCK_CUSTOM",
    "_log": "Log yTrace yDebug yInfo yWarning yError yarp_print_trace",
    "_network": "Network NetworkBase",
    "_port": "Port",
    "_rpc": "RpcServer RpcClient",
    "_buffered_port": "BufferedPort BufferedPortBottle BufferedPortProperty BufferedPortVector "
    "BufferedPortVectorInt BufferedPortMatrix BufferedPortSound BufferedPortImageRgb "
    "BufferedPortImageRgba BufferedPortImageMono BufferedPortImageMono16 BufferedPortImageInt "
    "BufferedPortImageFloat BufferedPortImageRgbFloat BottleCallback PropertyCallback "
    "VectorCallback VectorIntCallback MatrixCallback SoundCallback ImageRgbCallback "
    "ImageRgbaCallback ImageMonoCallback ImageMono16Callback ImageIntCallback ImageFloatCallback "
    "ImageRgbFloatCallback TypedReaderCallbackVector TypedReaderCallbackVectorInt "
    "TypedReaderCallbackSound TypedReaderCallbackImageRgb TypedReaderCallbackImageRgba "
    "TypedReaderCallbackImageMono TypedReaderCallbackImageMono16 TypedReaderCallbackImageInt "
    "TypedReaderCallbackImageFloat TypedReaderCallbackImageRgbFloat",
    "_typed_reader": "TypedReaderBottle TypedReaderProperty TypedReaderVector "
    "TypedReaderVectorInt TypedReaderMatrix TypedReaderSound TypedReaderImageRgb "
    "TypedReaderImageRgba TypedReaderImageMono TypedReaderImageMono16 TypedReaderImageInt "
    "TypedReaderImageFloat TypedReaderImageRgbFloat",
    "_raw_view": "IAmplifierControlRaw IAxisInfoRaw IControlLimitsRaw IControlModeRaw "
    "ICurrentControlRaw IEncodersRaw IEncodersTimedRaw IImpedanceControlRaw IInteractionModeRaw "
    "IJointFaultRaw IMotorEncodersRaw IMotorRaw IPWMControlRaw IPidControlRaw IPositionControlRaw "
    "IPositionDirectRaw IRemoteVariablesRaw ITorqueControlRaw IVelocityControlRaw",
    "_numbers": "DVector IVector BVector SVector SPairVector ShortVector",
    "_std_string": "std_string",
    "_vector": "Vector VectorInt VectorBase",
    "_matrix": "Matrix removeCols removeRows submatrix",
    "_sound": "Sound",
    "_sound_marker": "SoundMarker",
    "_sound_tools": "makeTone makeSquareWave makeSawTooth mix",
    "_pixel": "PixelRgb PixelRgba PixelRgbFloat PixelBgr PixelBgra PixelHsv PixelHsvFloat "
    "PixelRgbSigned PixelRgbInt",
    "_net_int": "NetInt16 NetInt32 NetInt64 UnionNetInt64",
    "_qos": "QosStyle",
    "_device": "IConfig DeviceDriver DeprecatedDeviceDriver DeviceResponder",
    "_drivers": "Drivers DriverCreator StubDriverCreator",
    "_return_value": "ReturnValue",
    "_map_grid": "MapGrid2D",
    "_image": "Image ImageRgb ImageRgba ImageRgbFloat ImageMono ImageMono16 ImageInt ImageFloat "
    "FlexImage PAD_BYTES",
    "_file": "read write read_bytestream write_bytestream",
    "_vocab": "encode decode createVocab createVocab32 VOCAB VOCAB1 VOCAB2 VOCAB3 VOCAB4 Vocab "
    "createVocab64 encode64 decode64",
    "_navigation_view": "INavigation2D INavigation2DTargetActions INavigation2DControlActions "
    "INavigation2DVelocityActions INavigation2DExtraActions statusToString stringToStatus",
    "_controller_view": "ICartesianControl CartesianEvent CartesianEventParameters "
    "CartesianEventVariables",
    "_gaze_view": "IGazeControl GazeEvent GazeEventParameters GazeEventVariables",
    "_point": "Vector2D Vector2DVector",
    "_map_place": "Map2DLocation Map2DPath Map2DArea",
    "_struct": "Map2DLocationVector Map2DObject OdometryData Pose6D ColorRGB LLM_Message "
    "LLMVector Map2DLocationData Map2DPathData Map2DAreaData Map2DObjectData vertex_t",
    "_map_port": "BufferedPortMap2DLocation BufferedPortMap2DArea BufferedPortMap2DPath "
    "BufferedPortMapGrid2D TypedReaderMap2DLocation TypedReaderMap2DArea TypedReaderMap2DPath "
    "TypedReaderMapGrid2D Map2DLocationCallback Map2DAreaCallback Map2DPathCallback "
    "MapGrid2DCallback",
    "_place_view": "IBattery IFrameTransform",
    "_mirror": "ILocalization2D IMap2D IOdometry2D ILLM ISimulatedWorld "
    "ISpeechSynthesizer ISpeechTranscription IRGBDSensor",
    "_resource_finder": "ResourceFinder",
    "_rf_module": "RFModule",
    "_thread": "Thread PeriodicThread RateThread Semaphore",
    "_random": "Random",
    "_poly_driver": "PolyDriver",
    "_motion_view": "IPositionControl IPositionDirect IVelocityControl ITorqueControl "
    "ICurrentControl IPWMControl IImpedanceControl MotorTorqueParameters",
    "_measuring_view": "IEncoders IEncodersTimed IMotorEncoders IMotor IAmplifierControl "
    "IAxisInfo IJointFault IRemoteVariables",
    "_control_view": "IControlMode IInteractionMode IControlLimits",
    "_pid_view": "IPidControl Pid PidVector PidWithExtraInfo PidDataDescription PidDataUnits "
    "PidExtraInfo",
    "_sensor_view": "IThreeAxisGyroscopes IThreeAxisLinearAccelerometers IThreeAxisMagnetometers "
    "IOrientationSensors ITemperatureSensors ISixAxisForceTorqueSensors IPositionSensors "
    "IContactLoadCellArrays IEncoderArrays ISkinPatches ILinearVelocitySensors "
    "IThreeAxisAngularAccelerometers",
    "_camera_view": "IFrameGrabberImageBase IFrameGrabber IFrameGrabberImage IFrameGrabberRgb "
    "IFrameGrabberControls CameraDescriptor",
    "_device_view": "IAnalogSensor IJointCoupling IFrameWriterImage IControlDebug",
    "_firewire_view": "IFrameGrabberControlsDC1394",
    "_name_server": "NameStore",
    "_wire": "Wire WireLink",
    "_absent": "LogStream",
}
WHERE = {name: module for module, names in _MODULES.items() for name in names.split()}

#: Whose static methods are also functions: `Network_connect`.
CLASSES = frozenset(name for name in WHERE if name[0].isupper() and not name.isupper())

#: What the bindings of C++ have and means nothing here, and why: it refuses when it is called.
NOT_HERE: dict[str, str] = {
    "LogStream": "it is the << of C++: yarp.Log().info(text)",
}
