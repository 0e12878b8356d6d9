"""Which module of this package has which name."""

from __future__ import annotations

_MODULES = {
    "_value": "Value",
    "_bottle": "Bottle",
    "_property": "Property",
    "_searchable": "Searchable",
    "_portable": "Portable PortReader PortWriter PortReaderCreator",
    "_connection": "ConnectionReader ConnectionWriter",
    "_contact": "Contact ContactStyle",
    "_contactable": "Contactable PortReport PortInfo",
    "_stamp": "Stamp",
    "_time": "Time delay now yield_c turboBoost isValid useSystemClock useNetworkClock "
    "useCustomClock isSystemClock isNetworkClock isCustomClock isClockInitialized getClockType "
    "YARP_CLOCK_UNINITIALIZED "
    "YARP_CLOCK_DEFAULT YARP_CLOCK_SYSTEM YARP_CLOCK_NETWORK YARP_CLOCK_CUSTOM",
    "_log": "Log yTrace yDebug yInfo yWarning yError",
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
    "_numbers": "DVector IVector BVector SVector ShortVector",
    "_vector": "Vector VectorInt VectorBase",
    "_matrix": "Matrix",
    "_sound": "Sound",
    "_pixel": "PixelRgb PixelRgba PixelRgbFloat PixelBgr PixelBgra PixelHsv PixelHsvFloat "
    "PixelRgbSigned PixelRgbInt",
    "_net_int": "NetInt16 NetInt32 NetInt64",
    "_qos": "QosStyle",
    "_device": "IConfig DeviceDriver DeviceResponder Drivers",
    "_return_value": "ReturnValue",
    "_map_grid": "MapGrid2D",
    "_image": "Image ImageRgb ImageRgba ImageRgbFloat ImageMono ImageMono16 ImageInt ImageFloat "
    "FlexImage",
    "_file": "read write",
    "_vocab": "encode decode createVocab createVocab32 VOCAB VOCAB1 VOCAB2 VOCAB3 VOCAB4 Vocab",
    "_struct": "Map2DLocation Map2DLocationVector Map2DPath Map2DArea Map2DObject OdometryData "
    "Pose6D ColorRGB LLM_Message LLMVector",
    "_place_view": "IBattery IFrameTransform",
    "_mirror": "ILocalization2D IMap2D INavigation2D IOdometry2D ILLM ISimulatedWorld "
    "ISpeechSynthesizer ISpeechTranscription IRGBDSensor",
    "_resource_finder": "ResourceFinder",
    "_rf_module": "RFModule",
    "_thread": "Thread PeriodicThread RateThread Semaphore",
    "_random": "Random",
    "_poly_driver": "PolyDriver",
    "_motion_view": "IPositionControl IPositionDirect IVelocityControl ITorqueControl "
    "ICurrentControl IPWMControl IImpedanceControl",
    "_measuring_view": "IEncoders IEncodersTimed IMotorEncoders IMotor IAmplifierControl IAxisInfo "
    "IJointFault IRemoteVariables",
    "_control_view": "IControlMode IInteractionMode IControlLimits IPidControl Pid PidVector",
    "_sensor_view": "IThreeAxisGyroscopes IThreeAxisLinearAccelerometers IThreeAxisMagnetometers "
    "IOrientationSensors ITemperatureSensors ISixAxisForceTorqueSensors IPositionSensors "
    "IContactLoadCellArrays IEncoderArrays ISkinPatches ILinearVelocitySensors "
    "IThreeAxisAngularAccelerometers",
    "_camera_view": "IFrameGrabberImage IFrameGrabberRgb IFrameGrabberControls CameraDescriptor",
}
WHERE = {name: module for module, names in _MODULES.items() for name in names.split()}

#: Whose static methods are also functions: `Network_connect`.
CLASSES = frozenset(name for name in WHERE if name[0].isupper() and not name.isupper())

#: What the bindings of C++ have and this does not, and why.
NOT_HERE: dict[str, str] = {
    "ICartesianControl": "it asks a solver of the iCub in C++, whose protocol yarpy does not "
    "speak: joints are moved by viewIPositionControl and viewIPositionDirect",
    "IGazeControl": "it asks iKinGazeCtrl of the iCub in C++, whose protocol yarpy does not speak: "
    "the head and the eyes are moved by viewIPositionControl, and iKinGazeCtrl takes angles and "
    "points at its own ports",
}
