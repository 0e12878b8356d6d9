"""Written by generate.py: the names of `yarp`, for type checkers."""

from yarp._absent import LogStream as LogStream
from yarp._abstract_contactable import AbstractContactable as AbstractContactable
from yarp._abstract_contactable import UnbufferedContactable as UnbufferedContactable
from yarp._bottle import Bottle as Bottle
from yarp._buffered_port import BottleCallback as BottleCallback
from yarp._buffered_port import BufferedPort as BufferedPort
from yarp._buffered_port import BufferedPortBottle as BufferedPortBottle
from yarp._buffered_port import BufferedPortImageFloat as BufferedPortImageFloat
from yarp._buffered_port import BufferedPortImageInt as BufferedPortImageInt
from yarp._buffered_port import BufferedPortImageMono as BufferedPortImageMono
from yarp._buffered_port import BufferedPortImageMono16 as BufferedPortImageMono16
from yarp._buffered_port import BufferedPortImageRgb as BufferedPortImageRgb
from yarp._buffered_port import BufferedPortImageRgbFloat as BufferedPortImageRgbFloat
from yarp._buffered_port import BufferedPortImageRgba as BufferedPortImageRgba
from yarp._buffered_port import BufferedPortMatrix as BufferedPortMatrix
from yarp._buffered_port import BufferedPortProperty as BufferedPortProperty
from yarp._buffered_port import BufferedPortSound as BufferedPortSound
from yarp._buffered_port import BufferedPortVector as BufferedPortVector
from yarp._buffered_port import BufferedPortVectorInt as BufferedPortVectorInt
from yarp._buffered_port import ImageFloatCallback as ImageFloatCallback
from yarp._buffered_port import ImageIntCallback as ImageIntCallback
from yarp._buffered_port import ImageMono16Callback as ImageMono16Callback
from yarp._buffered_port import ImageMonoCallback as ImageMonoCallback
from yarp._buffered_port import ImageRgbCallback as ImageRgbCallback
from yarp._buffered_port import ImageRgbFloatCallback as ImageRgbFloatCallback
from yarp._buffered_port import ImageRgbaCallback as ImageRgbaCallback
from yarp._buffered_port import MatrixCallback as MatrixCallback
from yarp._buffered_port import PropertyCallback as PropertyCallback
from yarp._buffered_port import SoundCallback as SoundCallback
from yarp._buffered_port import TypedReaderCallbackImageFloat as TypedReaderCallbackImageFloat
from yarp._buffered_port import TypedReaderCallbackImageInt as TypedReaderCallbackImageInt
from yarp._buffered_port import TypedReaderCallbackImageMono as TypedReaderCallbackImageMono
from yarp._buffered_port import TypedReaderCallbackImageMono16 as TypedReaderCallbackImageMono16
from yarp._buffered_port import TypedReaderCallbackImageRgb as TypedReaderCallbackImageRgb
from yarp._buffered_port import TypedReaderCallbackImageRgbFloat as TypedReaderCallbackImageRgbFloat
from yarp._buffered_port import TypedReaderCallbackImageRgba as TypedReaderCallbackImageRgba
from yarp._buffered_port import TypedReaderCallbackSound as TypedReaderCallbackSound
from yarp._buffered_port import TypedReaderCallbackVector as TypedReaderCallbackVector
from yarp._buffered_port import TypedReaderCallbackVectorInt as TypedReaderCallbackVectorInt
from yarp._buffered_port import VectorCallback as VectorCallback
from yarp._buffered_port import VectorIntCallback as VectorIntCallback
from yarp._camera_view import CameraDescriptor as CameraDescriptor
from yarp._camera_view import IFrameGrabber as IFrameGrabber
from yarp._camera_view import IFrameGrabberControls as IFrameGrabberControls
from yarp._camera_view import IFrameGrabberImage as IFrameGrabberImage
from yarp._camera_view import IFrameGrabberImageBase as IFrameGrabberImageBase
from yarp._camera_view import IFrameGrabberRgb as IFrameGrabberRgb
from yarp._connection import ConnectionReader as ConnectionReader
from yarp._connection import ConnectionWriter as ConnectionWriter
from yarp._contact import Contact as Contact
from yarp._contact import ContactStyle as ContactStyle
from yarp._contactable import Contactable as Contactable
from yarp._contactable import PortInfo as PortInfo
from yarp._contactable import PortReport as PortReport
from yarp._control_view import IControlLimits as IControlLimits
from yarp._control_view import IControlMode as IControlMode
from yarp._control_view import IInteractionMode as IInteractionMode
from yarp._controller_view import CartesianEvent as CartesianEvent
from yarp._controller_view import CartesianEventParameters as CartesianEventParameters
from yarp._controller_view import CartesianEventVariables as CartesianEventVariables
from yarp._controller_view import ICartesianControl as ICartesianControl
from yarp._device import DeprecatedDeviceDriver as DeprecatedDeviceDriver
from yarp._device import DeviceDriver as DeviceDriver
from yarp._device import DeviceResponder as DeviceResponder
from yarp._device import IConfig as IConfig
from yarp._device_view import IAnalogSensor as IAnalogSensor
from yarp._device_view import IControlDebug as IControlDebug
from yarp._device_view import IFrameWriterImage as IFrameWriterImage
from yarp._device_view import IJointCoupling as IJointCoupling
from yarp._drivers import DriverCreator as DriverCreator
from yarp._drivers import Drivers as Drivers
from yarp._drivers import StubDriverCreator as StubDriverCreator
from yarp._environment import cachehome as cachehome
from yarp._environment import configdirs as configdirs
from yarp._environment import confighome as confighome
from yarp._environment import datadirs as datadirs
from yarp._environment import datahome as datahome
from yarp._environment import getEnvironment as getEnvironment
from yarp._environment import get_bool as get_bool
from yarp._environment import get_path as get_path
from yarp._environment import get_string as get_string
from yarp._environment import home as home
from yarp._environment import is_set as is_set
from yarp._environment import path_separator as path_separator
from yarp._environment import runtimedir as runtimedir
from yarp._environment import setEnvironment as setEnvironment
from yarp._environment import set_bool as set_bool
from yarp._environment import set_path as set_path
from yarp._environment import set_string as set_string
from yarp._environment import tempdir as tempdir
from yarp._environment import unset as unset
from yarp._environment import unsetEnvironment as unsetEnvironment
from yarp._environment import yarpcachehome as yarpcachehome
from yarp._environment import yarpconfigdirs as yarpconfigdirs
from yarp._environment import yarpconfighome as yarpconfighome
from yarp._environment import yarpdatadirs as yarpdatadirs
from yarp._environment import yarpdatahome as yarpdatahome
from yarp._environment import yarpruntimedir as yarpruntimedir
from yarp._file import read as read
from yarp._file import read_bytestream as read_bytestream
from yarp._file import write as write
from yarp._file import write_bytestream as write_bytestream
from yarp._firewire_view import IFrameGrabberControlsDC1394 as IFrameGrabberControlsDC1394
from yarp._gaze_view import GazeEvent as GazeEvent
from yarp._gaze_view import GazeEventParameters as GazeEventParameters
from yarp._gaze_view import GazeEventVariables as GazeEventVariables
from yarp._gaze_view import IGazeControl as IGazeControl
from yarp._image import FlexImage as FlexImage
from yarp._image import Image as Image
from yarp._image import ImageFloat as ImageFloat
from yarp._image import ImageInt as ImageInt
from yarp._image import ImageMono as ImageMono
from yarp._image import ImageMono16 as ImageMono16
from yarp._image import ImageRgb as ImageRgb
from yarp._image import ImageRgbFloat as ImageRgbFloat
from yarp._image import ImageRgba as ImageRgba
from yarp._image import PAD_BYTES as PAD_BYTES
from yarp._iterator import SwigPyIterator as SwigPyIterator
from yarp._log import Log as Log
from yarp._log import yDebug as yDebug
from yarp._log import yError as yError
from yarp._log import yInfo as yInfo
from yarp._log import yTrace as yTrace
from yarp._log import yWarning as yWarning
from yarp._log import yarp_print_trace as yarp_print_trace
from yarp._map_grid import MapGrid2D as MapGrid2D
from yarp._map_place import Map2DArea as Map2DArea
from yarp._map_place import Map2DLocation as Map2DLocation
from yarp._map_place import Map2DPath as Map2DPath
from yarp._map_port import BufferedPortMap2DArea as BufferedPortMap2DArea
from yarp._map_port import BufferedPortMap2DLocation as BufferedPortMap2DLocation
from yarp._map_port import BufferedPortMap2DPath as BufferedPortMap2DPath
from yarp._map_port import BufferedPortMapGrid2D as BufferedPortMapGrid2D
from yarp._map_port import Map2DAreaCallback as Map2DAreaCallback
from yarp._map_port import Map2DLocationCallback as Map2DLocationCallback
from yarp._map_port import Map2DPathCallback as Map2DPathCallback
from yarp._map_port import MapGrid2DCallback as MapGrid2DCallback
from yarp._map_port import TypedReaderMap2DArea as TypedReaderMap2DArea
from yarp._map_port import TypedReaderMap2DLocation as TypedReaderMap2DLocation
from yarp._map_port import TypedReaderMap2DPath as TypedReaderMap2DPath
from yarp._map_port import TypedReaderMapGrid2D as TypedReaderMapGrid2D
from yarp._matrix import Matrix as Matrix
from yarp._matrix import removeCols as removeCols
from yarp._matrix import removeRows as removeRows
from yarp._matrix import submatrix as submatrix
from yarp._measuring_view import IAmplifierControl as IAmplifierControl
from yarp._measuring_view import IAxisInfo as IAxisInfo
from yarp._measuring_view import IEncoders as IEncoders
from yarp._measuring_view import IEncodersTimed as IEncodersTimed
from yarp._measuring_view import IJointFault as IJointFault
from yarp._measuring_view import IMotor as IMotor
from yarp._measuring_view import IMotorEncoders as IMotorEncoders
from yarp._measuring_view import IRemoteVariables as IRemoteVariables
from yarp._mirror import ILLM as ILLM
from yarp._mirror import ILocalization2D as ILocalization2D
from yarp._mirror import IMap2D as IMap2D
from yarp._mirror import IOdometry2D as IOdometry2D
from yarp._mirror import IRGBDSensor as IRGBDSensor
from yarp._mirror import ISimulatedWorld as ISimulatedWorld
from yarp._mirror import ISpeechSynthesizer as ISpeechSynthesizer
from yarp._mirror import ISpeechTranscription as ISpeechTranscription
from yarp._motion_view import ICurrentControl as ICurrentControl
from yarp._motion_view import IImpedanceControl as IImpedanceControl
from yarp._motion_view import IPWMControl as IPWMControl
from yarp._motion_view import IPositionControl as IPositionControl
from yarp._motion_view import IPositionDirect as IPositionDirect
from yarp._motion_view import ITorqueControl as ITorqueControl
from yarp._motion_view import IVelocityControl as IVelocityControl
from yarp._motion_view import MotorTorqueParameters as MotorTorqueParameters
from yarp._name_server import NameStore as NameStore
from yarp._navigation_view import INavigation2D as INavigation2D
from yarp._navigation_view import INavigation2DControlActions as INavigation2DControlActions
from yarp._navigation_view import INavigation2DExtraActions as INavigation2DExtraActions
from yarp._navigation_view import INavigation2DTargetActions as INavigation2DTargetActions
from yarp._navigation_view import INavigation2DVelocityActions as INavigation2DVelocityActions
from yarp._navigation_view import statusToString as statusToString
from yarp._navigation_view import stringToStatus as stringToStatus
from yarp._nested_contact import NestedContact as NestedContact
from yarp._net_int import NetInt16 as NetInt16
from yarp._net_int import NetInt32 as NetInt32
from yarp._net_int import NetInt64 as NetInt64
from yarp._net_int import UnionNetInt64 as UnionNetInt64
from yarp._network import Network as Network
from yarp._network import NetworkBase as NetworkBase
from yarp._numbers import BVector as BVector
from yarp._numbers import DVector as DVector
from yarp._numbers import IVector as IVector
from yarp._numbers import SPairVector as SPairVector
from yarp._numbers import SVector as SVector
from yarp._numbers import ShortVector as ShortVector
from yarp._pid_view import IPidControl as IPidControl
from yarp._pid_view import Pid as Pid
from yarp._pid_view import PidDataDescription as PidDataDescription
from yarp._pid_view import PidDataUnits as PidDataUnits
from yarp._pid_view import PidExtraInfo as PidExtraInfo
from yarp._pid_view import PidVector as PidVector
from yarp._pid_view import PidWithExtraInfo as PidWithExtraInfo
from yarp._pixel import PixelBgr as PixelBgr
from yarp._pixel import PixelBgra as PixelBgra
from yarp._pixel import PixelHsv as PixelHsv
from yarp._pixel import PixelHsvFloat as PixelHsvFloat
from yarp._pixel import PixelRgb as PixelRgb
from yarp._pixel import PixelRgbFloat as PixelRgbFloat
from yarp._pixel import PixelRgbInt as PixelRgbInt
from yarp._pixel import PixelRgbSigned as PixelRgbSigned
from yarp._pixel import PixelRgba as PixelRgba
from yarp._place_view import IBattery as IBattery
from yarp._place_view import IFrameTransform as IFrameTransform
from yarp._point import Vector2D as Vector2D
from yarp._point import Vector2DVector as Vector2DVector
from yarp._poly_driver import PolyDriver as PolyDriver
from yarp._port import Port as Port
from yarp._portable import PortReader as PortReader
from yarp._portable import PortReaderCreator as PortReaderCreator
from yarp._portable import PortWriter as PortWriter
from yarp._portable import Portable as Portable
from yarp._portable_pair import PortablePair as PortablePair
from yarp._portable_pair import PortablePairBase as PortablePairBase
from yarp._property import Property as Property
from yarp._qos import QosStyle as QosStyle
from yarp._random import Random as Random
from yarp._raw_view import IAmplifierControlRaw as IAmplifierControlRaw
from yarp._raw_view import IAxisInfoRaw as IAxisInfoRaw
from yarp._raw_view import IControlLimitsRaw as IControlLimitsRaw
from yarp._raw_view import IControlModeRaw as IControlModeRaw
from yarp._raw_view import ICurrentControlRaw as ICurrentControlRaw
from yarp._raw_view import IEncodersRaw as IEncodersRaw
from yarp._raw_view import IEncodersTimedRaw as IEncodersTimedRaw
from yarp._raw_view import IImpedanceControlRaw as IImpedanceControlRaw
from yarp._raw_view import IInteractionModeRaw as IInteractionModeRaw
from yarp._raw_view import IJointFaultRaw as IJointFaultRaw
from yarp._raw_view import IMotorEncodersRaw as IMotorEncodersRaw
from yarp._raw_view import IMotorRaw as IMotorRaw
from yarp._raw_view import IPWMControlRaw as IPWMControlRaw
from yarp._raw_view import IPidControlRaw as IPidControlRaw
from yarp._raw_view import IPositionControlRaw as IPositionControlRaw
from yarp._raw_view import IPositionDirectRaw as IPositionDirectRaw
from yarp._raw_view import IRemoteVariablesRaw as IRemoteVariablesRaw
from yarp._raw_view import ITorqueControlRaw as ITorqueControlRaw
from yarp._raw_view import IVelocityControlRaw as IVelocityControlRaw
from yarp._resource_finder import ResourceFinder as ResourceFinder
from yarp._return_value import ReturnValue as ReturnValue
from yarp._rf_module import RFModule as RFModule
from yarp._rpc import RpcClient as RpcClient
from yarp._rpc import RpcServer as RpcServer
from yarp._searchable import SearchMonitor as SearchMonitor
from yarp._searchable import SearchReport as SearchReport
from yarp._searchable import Searchable as Searchable
from yarp._sensor_view import IContactLoadCellArrays as IContactLoadCellArrays
from yarp._sensor_view import IEncoderArrays as IEncoderArrays
from yarp._sensor_view import ILinearVelocitySensors as ILinearVelocitySensors
from yarp._sensor_view import IOrientationSensors as IOrientationSensors
from yarp._sensor_view import IPositionSensors as IPositionSensors
from yarp._sensor_view import ISixAxisForceTorqueSensors as ISixAxisForceTorqueSensors
from yarp._sensor_view import ISkinPatches as ISkinPatches
from yarp._sensor_view import ITemperatureSensors as ITemperatureSensors
from yarp._sensor_view import IThreeAxisAngularAccelerometers as IThreeAxisAngularAccelerometers
from yarp._sensor_view import IThreeAxisGyroscopes as IThreeAxisGyroscopes
from yarp._sensor_view import IThreeAxisLinearAccelerometers as IThreeAxisLinearAccelerometers
from yarp._sensor_view import IThreeAxisMagnetometers as IThreeAxisMagnetometers
from yarp._sound import Sound as Sound
from yarp._sound_marker import SoundMarker as SoundMarker
from yarp._sound_tools import makeSawTooth as makeSawTooth
from yarp._sound_tools import makeSquareWave as makeSquareWave
from yarp._sound_tools import makeTone as makeTone
from yarp._sound_tools import mix as mix
from yarp._stamp import Stamp as Stamp
from yarp._std_string import std_string as std_string
from yarp._struct import ColorRGB as ColorRGB
from yarp._struct import LLMVector as LLMVector
from yarp._struct import LLM_Message as LLM_Message
from yarp._struct import Map2DAreaData as Map2DAreaData
from yarp._struct import Map2DLocationData as Map2DLocationData
from yarp._struct import Map2DLocationVector as Map2DLocationVector
from yarp._struct import Map2DObject as Map2DObject
from yarp._struct import Map2DObjectData as Map2DObjectData
from yarp._struct import Map2DPathData as Map2DPathData
from yarp._struct import OdometryData as OdometryData
from yarp._struct import Pose6D as Pose6D
from yarp._struct import vertex_t as vertex_t
from yarp._things import DummyConnector as DummyConnector
from yarp._things import Things as Things
from yarp._thread import PeriodicThread as PeriodicThread
from yarp._thread import RateThread as RateThread
from yarp._thread import Semaphore as Semaphore
from yarp._thread import Thread as Thread
from yarp._time import Time as Time
from yarp._time import YARP_CLOCK_CUSTOM as YARP_CLOCK_CUSTOM
from yarp._time import YARP_CLOCK_DEFAULT as YARP_CLOCK_DEFAULT
from yarp._time import YARP_CLOCK_NETWORK as YARP_CLOCK_NETWORK
from yarp._time import YARP_CLOCK_SYSTEM as YARP_CLOCK_SYSTEM
from yarp._time import YARP_CLOCK_UNINITIALIZED as YARP_CLOCK_UNINITIALIZED
from yarp._time import clockTypeToString as clockTypeToString
from yarp._time import delay as delay
from yarp._time import getClockType as getClockType
from yarp._time import isClockInitialized as isClockInitialized
from yarp._time import isCustomClock as isCustomClock
from yarp._time import isNetworkClock as isNetworkClock
from yarp._time import isSystemClock as isSystemClock
from yarp._time import isValid as isValid
from yarp._time import now as now
from yarp._time import turboBoost as turboBoost
from yarp._time import useCustomClock as useCustomClock
from yarp._time import useNetworkClock as useNetworkClock
from yarp._time import useSystemClock as useSystemClock
from yarp._time import yield_c as yield_c
from yarp._type import Type as Type
from yarp._typed_reader import TypedReaderBottle as TypedReaderBottle
from yarp._typed_reader import TypedReaderImageFloat as TypedReaderImageFloat
from yarp._typed_reader import TypedReaderImageInt as TypedReaderImageInt
from yarp._typed_reader import TypedReaderImageMono as TypedReaderImageMono
from yarp._typed_reader import TypedReaderImageMono16 as TypedReaderImageMono16
from yarp._typed_reader import TypedReaderImageRgb as TypedReaderImageRgb
from yarp._typed_reader import TypedReaderImageRgbFloat as TypedReaderImageRgbFloat
from yarp._typed_reader import TypedReaderImageRgba as TypedReaderImageRgba
from yarp._typed_reader import TypedReaderMatrix as TypedReaderMatrix
from yarp._typed_reader import TypedReaderProperty as TypedReaderProperty
from yarp._typed_reader import TypedReaderSound as TypedReaderSound
from yarp._typed_reader import TypedReaderVector as TypedReaderVector
from yarp._typed_reader import TypedReaderVectorInt as TypedReaderVectorInt
from yarp._value import Value as Value
from yarp._vector import Vector as Vector
from yarp._vector import VectorBase as VectorBase
from yarp._vector import VectorInt as VectorInt
from yarp._vocab import VOCAB as VOCAB
from yarp._vocab import VOCAB1 as VOCAB1
from yarp._vocab import VOCAB2 as VOCAB2
from yarp._vocab import VOCAB3 as VOCAB3
from yarp._vocab import VOCAB4 as VOCAB4
from yarp._vocab import Vocab as Vocab
from yarp._vocab import createVocab as createVocab
from yarp._vocab import createVocab32 as createVocab32
from yarp._vocab import createVocab64 as createVocab64
from yarp._vocab import decode as decode
from yarp._vocab import decode64 as decode64
from yarp._vocab import encode as encode
from yarp._vocab import encode64 as encode64
from yarp._wire import Wire as Wire
from yarp._wire import WireLink as WireLink

YARP_VERSION: str
YARP_VERSION_SHORT: str
YARP_VERSION_MAJOR: int
YARP_VERSION_MINOR: int
YARP_VERSION_PATCH: int
YARP_VERSION_HEX: int
ALLOW_OLD_CONTROL_MODE_INTERFACE: int
BOTTLE_TAG_BLOB: int
BOTTLE_TAG_DICT: int
BOTTLE_TAG_DOUBLE: int
BOTTLE_TAG_FLOAT32: int
BOTTLE_TAG_FLOAT64: int
BOTTLE_TAG_INT: int
BOTTLE_TAG_INT16: int
BOTTLE_TAG_INT32: int
BOTTLE_TAG_INT64: int
BOTTLE_TAG_INT8: int
BOTTLE_TAG_LIST: int
BOTTLE_TAG_STRING: int
BOTTLE_TAG_VOCAB: int
BOTTLE_TAG_VOCAB32: int
BOTTLE_TAG_VOCAB64: int
BUS_FIREWIRE: int
BUS_UNKNOWN: int
BUS_USB: int
BusType_BUS_FIREWIRE: int
BusType_BUS_UNKNOWN: int
BusType_BUS_USB: int
ContactLoadCellArray_EXTENDED_INTERFACE: int
ControlModeEnum_VOCAB_CM_CALIBRATING: int
ControlModeEnum_VOCAB_CM_CALIB_DONE: int
ControlModeEnum_VOCAB_CM_CONFIGURED: int
ControlModeEnum_VOCAB_CM_CONTROL_MODE: int
ControlModeEnum_VOCAB_CM_CONTROL_MODES: int
ControlModeEnum_VOCAB_CM_CONTROL_MODE_GROUP: int
ControlModeEnum_VOCAB_CM_CURRENT: int
ControlModeEnum_VOCAB_CM_FORCE_IDLE: int
ControlModeEnum_VOCAB_CM_HW_FAULT: int
ControlModeEnum_VOCAB_CM_IDLE: int
ControlModeEnum_VOCAB_CM_IMPEDANCE_POS: int
ControlModeEnum_VOCAB_CM_IMPEDANCE_VEL: int
ControlModeEnum_VOCAB_CM_MIXED: int
ControlModeEnum_VOCAB_CM_NOT_CONFIGURED: int
ControlModeEnum_VOCAB_CM_POSITION: int
ControlModeEnum_VOCAB_CM_POSITION_DIRECT: int
ControlModeEnum_VOCAB_CM_PWM: int
ControlModeEnum_VOCAB_CM_TORQUE: int
ControlModeEnum_VOCAB_CM_UNKNOWN: int
ControlModeEnum_VOCAB_CM_VELOCITY: int
ControlModeEnum_VOCAB_CM_VELOCITY_DIRECT: int
EncoderArray_EXTENDED_INTERFACE: int
FORMAT_ANY: int
FORMAT_JPG: int
FORMAT_NULL: int
FORMAT_NUMERIC: int
FORMAT_NUMERIC_COMPRESSED: int
FORMAT_PGM: int
FORMAT_PNG: int
FORMAT_PPM: int
FeatureMode_MODE_AUTO: int
FeatureMode_MODE_MANUAL: int
FeatureMode_MODE_UNKNOWN: int
JointTypeEnum_VOCAB_JOINTTYPE_PRISMATIC: int
JointTypeEnum_VOCAB_JOINTTYPE_REVOLUTE: int
JointTypeEnum_VOCAB_JOINTTYPE_UNKNOWN: int
MAS_ERROR: int
MAS_OK: int
MAS_OVF: int
MAS_TIMEOUT: int
MAS_UNKNOWN: int
MAS_WAITING_FOR_FIRST_READ: int
MODE_AUTO: int
MODE_MANUAL: int
MODE_UNKNOWN: int
OrientationSensor_EXTENDED_INTERFACE: int
PeriodicThreadClock_Absolute: int
PeriodicThreadClock_Relative: int
SelectableControlModeEnum_VOCAB_CM_CALIBRATING: int
SelectableControlModeEnum_VOCAB_CM_CALIB_DONE: int
SelectableControlModeEnum_VOCAB_CM_CONFIGURED: int
SelectableControlModeEnum_VOCAB_CM_CONTROL_MODE: int
SelectableControlModeEnum_VOCAB_CM_CONTROL_MODES: int
SelectableControlModeEnum_VOCAB_CM_CONTROL_MODE_GROUP: int
SelectableControlModeEnum_VOCAB_CM_CURRENT: int
SelectableControlModeEnum_VOCAB_CM_FORCE_IDLE: int
SelectableControlModeEnum_VOCAB_CM_HW_FAULT: int
SelectableControlModeEnum_VOCAB_CM_IDLE: int
SelectableControlModeEnum_VOCAB_CM_IMPEDANCE_POS: int
SelectableControlModeEnum_VOCAB_CM_IMPEDANCE_VEL: int
SelectableControlModeEnum_VOCAB_CM_MIXED: int
SelectableControlModeEnum_VOCAB_CM_NOT_CONFIGURED: int
SelectableControlModeEnum_VOCAB_CM_POSITION: int
SelectableControlModeEnum_VOCAB_CM_POSITION_DIRECT: int
SelectableControlModeEnum_VOCAB_CM_PWM: int
SelectableControlModeEnum_VOCAB_CM_TORQUE: int
SelectableControlModeEnum_VOCAB_CM_UNKNOWN: int
SelectableControlModeEnum_VOCAB_CM_VELOCITY: int
SelectableControlModeEnum_VOCAB_CM_VELOCITY_DIRECT: int
ShouldUseSystemClock_No: int
ShouldUseSystemClock_Yes: int
SixAxisForceTorqueSensor_EXTENDED_INTERFACE: int
SkinPatch_EXTENDED_INTERFACE: int
TemperatureSensor_EXTENDED_INTERFACE: int
ThreeAxisGyroscope_EXTENDED_INTERFACE: int
ThreeAxisLinearAccelerometer_EXTENDED_INTERFACE: int
ThreeAxisMagnetometer_EXTENDED_INTERFACE: int
VOCAB_AMP_CURRENT: int
VOCAB_AMP_CURRENTS: int
VOCAB_AMP_DISABLE: int
VOCAB_AMP_ENABLE: int
VOCAB_AMP_MAXCURRENT: int
VOCAB_AMP_NOMINAL_CURRENT: int
VOCAB_AMP_PEAK_CURRENT: int
VOCAB_AMP_PWM: int
VOCAB_AMP_PWM_LIMIT: int
VOCAB_AMP_STATUS: int
VOCAB_AMP_STATUS_SINGLE: int
VOCAB_AMP_VOLTAGE_SUPPLY: int
VOCAB_BEMF: int
VOCAB_CM_CALIBRATING: int
VOCAB_CM_CALIB_DONE: int
VOCAB_CM_CONFIGURED: int
VOCAB_CM_CONTROL_MODE: int
VOCAB_CM_CONTROL_MODES: int
VOCAB_CM_CONTROL_MODE_GROUP: int
VOCAB_CM_CURRENT: int
VOCAB_CM_FORCE_IDLE: int
VOCAB_CM_HW_FAULT: int
VOCAB_CM_IDLE: int
VOCAB_CM_IMPEDANCE_POS: int
VOCAB_CM_IMPEDANCE_VEL: int
VOCAB_CM_MIXED: int
VOCAB_CM_NOT_CONFIGURED: int
VOCAB_CM_POSITION: int
VOCAB_CM_POSITION_DIRECT: int
VOCAB_CM_PWM: int
VOCAB_CM_TORQUE: int
VOCAB_CM_UNKNOWN: int
VOCAB_CM_VELOCITY: int
VOCAB_CM_VELOCITY_DIRECT: int
VOCAB_CURRENTCONTROL_INTERFACE: int
VOCAB_CURRENT_RANGE: int
VOCAB_CURRENT_RANGES: int
VOCAB_CURRENT_REF: int
VOCAB_CURRENT_REFS: int
VOCAB_CURRENT_REF_GROUP: int
VOCAB_ENCODER: int
VOCAB_ENCODERS: int
VOCAB_ENCODER_ACCELERATION: int
VOCAB_ENCODER_ACCELERATIONS: int
VOCAB_ENCODER_SPEED: int
VOCAB_ENCODER_SPEEDS: int
VOCAB_E_RESET: int
VOCAB_E_RESETS: int
VOCAB_GEARBOX_RATIO: int
VOCAB_IANALOG: int
VOCAB_ICONTROLMODE: int
VOCAB_IJOINTFAULT: int
VOCAB_IMPEDANCE: int
VOCAB_IMP_OFFSET: int
VOCAB_IMP_PARAM: int
VOCAB_IM_COMPLIANT: int
VOCAB_IM_STIFF: int
VOCAB_IM_UNKNOWN: int
VOCAB_INAVIGATION: int
VOCAB_INFO_NAME: int
VOCAB_INFO_TYPE: int
VOCAB_INTERACTION_MODE: int
VOCAB_INTERACTION_MODES: int
VOCAB_INTERACTION_MODE_GROUP: int
VOCAB_INTERFACE_INTERACTION_MODE: int
VOCAB_ITRANSFORM: int
VOCAB_JF_GET_JOINTFAULT: int
VOCAB_JOINTTYPE_PRISMATIC: int
VOCAB_JOINTTYPE_REVOLUTE: int
VOCAB_JOINTTYPE_UNKNOWN: int
VOCAB_LIMITS: int
VOCAB_LIST_VARIABLES: int
VOCAB_MOTION_DONE_GROUP: int
VOCAB_MOTORS_NUMBER: int
VOCAB_MOTOR_CPR: int
VOCAB_MOTOR_ENCODER: int
VOCAB_MOTOR_ENCODERS: int
VOCAB_MOTOR_ENCODER_ACCELERATION: int
VOCAB_MOTOR_ENCODER_ACCELERATIONS: int
VOCAB_MOTOR_ENCODER_NUMBER: int
VOCAB_MOTOR_ENCODER_SPEED: int
VOCAB_MOTOR_ENCODER_SPEEDS: int
VOCAB_MOTOR_E_RESET: int
VOCAB_MOTOR_E_RESETS: int
VOCAB_MOTOR_PARAMS: int
VOCAB_NAV_AREA: int
VOCAB_NAV_CLEARALL_X: int
VOCAB_NAV_DELETE_X: int
VOCAB_NAV_GET_ABS_TARGET: int
VOCAB_NAV_GET_CURRENT_POS: int
VOCAB_NAV_GET_CURRENT_POSCOV: int
VOCAB_NAV_GET_CURRENT_WAYPOINT: int
VOCAB_NAV_GET_ESTIMATED_ODOM: int
VOCAB_NAV_GET_LIST_X: int
VOCAB_NAV_GET_LOCALIZER_POSES: int
VOCAB_NAV_GET_LOCALIZER_STATUS: int
VOCAB_NAV_GET_NAME_TARGET: int
VOCAB_NAV_GET_NAVIGATION_STATUS: int
VOCAB_NAV_GET_NAVIGATION_WAYPOINTS: int
VOCAB_NAV_GET_NAV_MAP: int
VOCAB_NAV_GET_REL_TARGET: int
VOCAB_NAV_GET_X: int
VOCAB_NAV_GOTOABS: int
VOCAB_NAV_GOTOABS_AND_NAME: int
VOCAB_NAV_GOTOREL: int
VOCAB_NAV_LOCALIZATION_START: int
VOCAB_NAV_LOCALIZATION_STOP: int
VOCAB_NAV_LOCATION: int
VOCAB_NAV_PATH: int
VOCAB_NAV_RECOMPUTE_PATH: int
VOCAB_NAV_RENAME_X: int
VOCAB_NAV_RESUME: int
VOCAB_NAV_SET_INITIAL_POS: int
VOCAB_NAV_SET_INITIAL_POSCOV: int
VOCAB_NAV_STOP: int
VOCAB_NAV_STORE_X: int
VOCAB_NAV_SUSPEND: int
VOCAB_NAV_TEMPORARY_FLAGS: int
VOCAB_NAV_VELOCITY_CMD: int
VOCAB_PID: int
VOCAB_PIDCONTROL_INTERFACE: int
VOCAB_PIDCONTROL_SET_FEEDFORWARD: int
VOCAB_PIDCONTROL_SET_OFFSET: int
VOCAB_PIDS: int
VOCAB_PIDTYPE_CURRENT: int
VOCAB_PIDTYPE_POSITION: int
VOCAB_PIDTYPE_TORQUE: int
VOCAB_PIDTYPE_VELOCITY: int
VOCAB_PIXEL_BGR: int
VOCAB_PIXEL_BGRA: int
VOCAB_PIXEL_ENCODING_BAYER_BGGR16: int
VOCAB_PIXEL_ENCODING_BAYER_BGGR8: int
VOCAB_PIXEL_ENCODING_BAYER_GBRG16: int
VOCAB_PIXEL_ENCODING_BAYER_GBRG8: int
VOCAB_PIXEL_ENCODING_BAYER_GRBG16: int
VOCAB_PIXEL_ENCODING_BAYER_GRBG8: int
VOCAB_PIXEL_ENCODING_BAYER_RGGB16: int
VOCAB_PIXEL_ENCODING_BAYER_RGGB8: int
VOCAB_PIXEL_HSV: int
VOCAB_PIXEL_HSV_FLOAT: int
VOCAB_PIXEL_INT: int
VOCAB_PIXEL_INVALID: int
VOCAB_PIXEL_MONO: int
VOCAB_PIXEL_MONO16: int
VOCAB_PIXEL_MONO_FLOAT: int
VOCAB_PIXEL_MONO_SIGNED: int
VOCAB_PIXEL_RGB: int
VOCAB_PIXEL_RGBA: int
VOCAB_PIXEL_RGB_FLOAT: int
VOCAB_PIXEL_RGB_INT: int
VOCAB_PIXEL_RGB_SIGNED: int
VOCAB_PIXEL_YUV_411: int
VOCAB_PIXEL_YUV_420: int
VOCAB_PIXEL_YUV_422: int
VOCAB_PIXEL_YUV_444: int
VOCAB_POSITION: int
VOCAB_POSITIONCONTROL_INTERFACE: int
VOCAB_POSITIONDIRECTCONTROL_INTERFACE: int
VOCAB_POSITION_DIRECT: int
VOCAB_POSITION_DIRECTS: int
VOCAB_POSITION_DIRECT_GROUP: int
VOCAB_POSITION_MOVE_GROUP: int
VOCAB_PWMCONTROL_INTERFACE: int
VOCAB_PWMCONTROL_PWM_OUTPUT: int
VOCAB_PWMCONTROL_PWM_OUTPUTS: int
VOCAB_PWMCONTROL_REF_PWM: int
VOCAB_PWMCONTROL_REF_PWMS: int
VOCAB_RANGE: int
VOCAB_RANGES: int
VOCAB_REF_ACCELERATION_GROUP: int
VOCAB_REF_SPEED_GROUP: int
VOCAB_RELATIVE_MOVE_GROUP: int
VOCAB_REMOTE_VARIABILE_INTERFACE: int
VOCAB_STOP_GROUP: int
VOCAB_TEMPERATURE: int
VOCAB_TEMPERATURES: int
VOCAB_TEMPERATURE_LIMIT: int
VOCAB_TORQUE: int
VOCAB_TORQUECONTROL_INTERFACE: int
VOCAB_TORQUES_DIRECT: int
VOCAB_TORQUES_DIRECTS: int
VOCAB_TORQUES_DIRECT_GROUP: int
VOCAB_TORQUE_MODE: int
VOCAB_TRANSFORM_DELETE: int
VOCAB_TRANSFORM_DELETE_ALL: int
VOCAB_TRANSFORM_SET: int
VOCAB_TRQ: int
VOCAB_TRQS: int
VOCAB_VARIABLE: int
VOCAB_VELOCITY: int
VOCAB_VELOCITYCONTROL_INTERFACE: int
VOCAB_VELOCITY_MOVE: int
VOCAB_VELOCITY_MOVES: int
VOCAB_VELOCITY_MOVE_GROUP: int
VOCAB_VEL_LIMITS: int
VOCAB_VEL_PID: int
VOCAB_VEL_PIDS: int
YARP_CROP_LIST: int
YARP_CROP_RECT: int
YARP_FEATURE_BRIGHTNESS: int
YARP_FEATURE_CAPTURE_QUALITY: int
YARP_FEATURE_CAPTURE_SIZE: int
YARP_FEATURE_EXPOSURE: int
YARP_FEATURE_FOCUS: int
YARP_FEATURE_FRAME_RATE: int
YARP_FEATURE_GAIN: int
YARP_FEATURE_GAMMA: int
YARP_FEATURE_HUE: int
YARP_FEATURE_INVALID: int
YARP_FEATURE_IRIS: int
YARP_FEATURE_MIRROR: int
YARP_FEATURE_NUMBER_OF: int
YARP_FEATURE_OPTICAL_FILTER: int
YARP_FEATURE_PAN: int
YARP_FEATURE_SATURATION: int
YARP_FEATURE_SHARPNESS: int
YARP_FEATURE_SHUTTER: int
YARP_FEATURE_TEMPERATURE: int
YARP_FEATURE_TILT: int
YARP_FEATURE_TRIGGER: int
YARP_FEATURE_TRIGGER_DELAY: int
YARP_FEATURE_WHITE_BALANCE: int
YARP_FEATURE_WHITE_SHADING: int
YARP_FEATURE_ZOOM: int
YARP_RETURNVALUE_DISABLE_BOOL_INPUT: int
YARP_RETURNVALUE_DISABLE_BOOL_OUTPUT: int
cameraFeature_id_t_YARP_FEATURE_BRIGHTNESS: int
cameraFeature_id_t_YARP_FEATURE_CAPTURE_QUALITY: int
cameraFeature_id_t_YARP_FEATURE_CAPTURE_SIZE: int
cameraFeature_id_t_YARP_FEATURE_EXPOSURE: int
cameraFeature_id_t_YARP_FEATURE_FOCUS: int
cameraFeature_id_t_YARP_FEATURE_FRAME_RATE: int
cameraFeature_id_t_YARP_FEATURE_GAIN: int
cameraFeature_id_t_YARP_FEATURE_GAMMA: int
cameraFeature_id_t_YARP_FEATURE_HUE: int
cameraFeature_id_t_YARP_FEATURE_INVALID: int
cameraFeature_id_t_YARP_FEATURE_IRIS: int
cameraFeature_id_t_YARP_FEATURE_MIRROR: int
cameraFeature_id_t_YARP_FEATURE_NUMBER_OF: int
cameraFeature_id_t_YARP_FEATURE_OPTICAL_FILTER: int
cameraFeature_id_t_YARP_FEATURE_PAN: int
cameraFeature_id_t_YARP_FEATURE_SATURATION: int
cameraFeature_id_t_YARP_FEATURE_SHARPNESS: int
cameraFeature_id_t_YARP_FEATURE_SHUTTER: int
cameraFeature_id_t_YARP_FEATURE_TEMPERATURE: int
cameraFeature_id_t_YARP_FEATURE_TILT: int
cameraFeature_id_t_YARP_FEATURE_TRIGGER: int
cameraFeature_id_t_YARP_FEATURE_TRIGGER_DELAY: int
cameraFeature_id_t_YARP_FEATURE_WHITE_BALANCE: int
cameraFeature_id_t_YARP_FEATURE_WHITE_SHADING: int
cameraFeature_id_t_YARP_FEATURE_ZOOM: int
global_map: int
global_trajectory: int
local_map: int
local_trajectory: int
localization_status_error: int
localization_status_localized_ok: int
localization_status_not_yet_localized: int
navigation_status_aborted: int
navigation_status_error: int
navigation_status_failing: int
navigation_status_goal_reached: int
navigation_status_idle: int
navigation_status_moving: int
navigation_status_paused: int
navigation_status_preparing_before_move: int
navigation_status_thinking: int
navigation_status_waiting_obstacle: int

Bottle_copyPortable = Bottle.copyPortable
Bottle_describeBottleCode = Bottle.describeBottleCode
Bottle_getNullBottle = Bottle.getNullBottle
ColorRGB_copyPortable = ColorRGB.copyPortable
ConnectionReader_createConnectionReader = ConnectionReader.createConnectionReader
ConnectionReader_readFromStream = ConnectionReader.readFromStream
ConnectionWriter_createBufferedConnectionWriter = ConnectionWriter.createBufferedConnectionWriter
ConnectionWriter_writeToStream = ConnectionWriter.writeToStream
Contact_convertHostToIp = Contact.convertHostToIp
Contact_fromConfig = Contact.fromConfig
Contact_fromString = Contact.fromString
Drivers_factory = Drivers.factory
Drivers_yarpdev = Drivers.yarpdev
FlexImage_copyPortable = FlexImage.copyPortable
Image_copyPortable = Image.copyPortable
ImageFloat_copyPortable = ImageFloat.copyPortable
ImageInt_copyPortable = ImageInt.copyPortable
ImageMono_copyPortable = ImageMono.copyPortable
ImageMono16_copyPortable = ImageMono16.copyPortable
ImageRgb_copyPortable = ImageRgb.copyPortable
ImageRgbFloat_copyPortable = ImageRgbFloat.copyPortable
ImageRgba_copyPortable = ImageRgba.copyPortable
LLM_Message_copyPortable = LLM_Message.copyPortable
Log_debug = Log.debug
Log_defaultForwardCallback = Log.defaultForwardCallback
Log_defaultMinimumForwardLevel = Log.defaultMinimumForwardLevel
Log_defaultMinimumPrintLevel = Log.defaultMinimumPrintLevel
Log_defaultPrintCallback = Log.defaultPrintCallback
Log_error = Log.error
Log_fatal = Log.fatal
Log_forwardCallback = Log.forwardCallback
Log_getLogMutex = Log.getLogMutex
Log_info = Log.info
Log_minimumForwardLevel = Log.minimumForwardLevel
Log_minimumPrintLevel = Log.minimumPrintLevel
Log_nolog = Log.nolog
Log_printCallback = Log.printCallback
Log_setForwardCallback = Log.setForwardCallback
Log_setMinimumForwardLevel = Log.setMinimumForwardLevel
Log_setMinimumPrintLevel = Log.setMinimumPrintLevel
Log_setPrintCallback = Log.setPrintCallback
Log_trace = Log.trace
Log_warning = Log.warning
Map2DArea_copyPortable = Map2DArea.copyPortable
Map2DAreaData_copyPortable = Map2DAreaData.copyPortable
Map2DLocation_copyPortable = Map2DLocation.copyPortable
Map2DLocationData_copyPortable = Map2DLocationData.copyPortable
Map2DObject_copyPortable = Map2DObject.copyPortable
Map2DObjectData_copyPortable = Map2DObjectData.copyPortable
Map2DPath_copyPortable = Map2DPath.copyPortable
Map2DPathData_copyPortable = Map2DPathData.copyPortable
MapGrid2D_copyPortable = MapGrid2D.copyPortable
Matrix_copyPortable = Matrix.copyPortable
Network_assertion = Network.assertion
Network_autoInitMinimum = Network.autoInitMinimum
Network_checkNetwork = Network.checkNetwork
Network_connect = Network.connect
Network_detectNameServer = Network.detectNameServer
Network_disconnect = Network.disconnect
Network_disconnectInput = Network.disconnectInput
Network_exists = Network.exists
Network_fini = Network.fini
Network_finiMinimum = Network.finiMinimum
Network_getConfigFile = Network.getConfigFile
Network_getConnectionQos = Network.getConnectionQos
Network_getDefaultPortRange = Network.getDefaultPortRange
Network_getDirectorySeparator = Network.getDirectorySeparator
Network_getEnvironment = Network.getEnvironment
Network_getLocalMode = Network.getLocalMode
Network_getNameServerContact = Network.getNameServerContact
Network_getNameServerName = Network.getNameServerName
Network_getPathSeparator = Network.getPathSeparator
Network_getProperty = Network.getProperty
Network_getQueryBypass = Network.getQueryBypass
Network_init = Network.init
Network_initMinimum = Network.initMinimum
Network_initialized = Network.initialized
Network_isConnected = Network.isConnected
Network_isNetworkInitialized = Network.isNetworkInitialized
Network_isValidPortName = Network.isValidPortName
Network_localNetworkAllocation = Network.localNetworkAllocation
Network_lock = Network.lock
Network_poll = Network.poll
Network_queryBypass = Network.queryBypass
Network_queryName = Network.queryName
Network_registerCarrier = Network.registerCarrier
Network_registerContact = Network.registerContact
Network_registerName = Network.registerName
Network_sendMessage = Network.sendMessage
Network_setConnectionQos = Network.setConnectionQos
Network_setEnvironment = Network.setEnvironment
Network_setLocalMode = Network.setLocalMode
Network_setNameServerContact = Network.setNameServerContact
Network_setNameServerName = Network.setNameServerName
Network_setProperty = Network.setProperty
Network_setVerbosity = Network.setVerbosity
Network_sync = Network.sync
Network_unlock = Network.unlock
Network_unregisterContact = Network.unregisterContact
Network_unregisterName = Network.unregisterName
Network_unsetEnvironment = Network.unsetEnvironment
Network_waitConnection = Network.waitConnection
Network_waitPort = Network.waitPort
Network_write = Network.write
Network_writeToNameServer = Network.writeToNameServer
Network_yarpClockInit = Network.yarpClockInit
NetworkBase_assertion = NetworkBase.assertion
NetworkBase_autoInitMinimum = NetworkBase.autoInitMinimum
NetworkBase_checkNetwork = NetworkBase.checkNetwork
NetworkBase_connect = NetworkBase.connect
NetworkBase_detectNameServer = NetworkBase.detectNameServer
NetworkBase_disconnect = NetworkBase.disconnect
NetworkBase_disconnectInput = NetworkBase.disconnectInput
NetworkBase_exists = NetworkBase.exists
NetworkBase_finiMinimum = NetworkBase.finiMinimum
NetworkBase_getConfigFile = NetworkBase.getConfigFile
NetworkBase_getConnectionQos = NetworkBase.getConnectionQos
NetworkBase_getDefaultPortRange = NetworkBase.getDefaultPortRange
NetworkBase_getDirectorySeparator = NetworkBase.getDirectorySeparator
NetworkBase_getEnvironment = NetworkBase.getEnvironment
NetworkBase_getLocalMode = NetworkBase.getLocalMode
NetworkBase_getNameServerContact = NetworkBase.getNameServerContact
NetworkBase_getNameServerName = NetworkBase.getNameServerName
NetworkBase_getPathSeparator = NetworkBase.getPathSeparator
NetworkBase_getProperty = NetworkBase.getProperty
NetworkBase_getQueryBypass = NetworkBase.getQueryBypass
NetworkBase_initMinimum = NetworkBase.initMinimum
NetworkBase_initialized = NetworkBase.initialized
NetworkBase_isConnected = NetworkBase.isConnected
NetworkBase_isNetworkInitialized = NetworkBase.isNetworkInitialized
NetworkBase_isValidPortName = NetworkBase.isValidPortName
NetworkBase_localNetworkAllocation = NetworkBase.localNetworkAllocation
NetworkBase_lock = NetworkBase.lock
NetworkBase_poll = NetworkBase.poll
NetworkBase_queryBypass = NetworkBase.queryBypass
NetworkBase_queryName = NetworkBase.queryName
NetworkBase_registerCarrier = NetworkBase.registerCarrier
NetworkBase_registerContact = NetworkBase.registerContact
NetworkBase_registerName = NetworkBase.registerName
NetworkBase_sendMessage = NetworkBase.sendMessage
NetworkBase_setConnectionQos = NetworkBase.setConnectionQos
NetworkBase_setEnvironment = NetworkBase.setEnvironment
NetworkBase_setLocalMode = NetworkBase.setLocalMode
NetworkBase_setNameServerContact = NetworkBase.setNameServerContact
NetworkBase_setNameServerName = NetworkBase.setNameServerName
NetworkBase_setProperty = NetworkBase.setProperty
NetworkBase_setVerbosity = NetworkBase.setVerbosity
NetworkBase_sync = NetworkBase.sync
NetworkBase_unlock = NetworkBase.unlock
NetworkBase_unregisterContact = NetworkBase.unregisterContact
NetworkBase_unregisterName = NetworkBase.unregisterName
NetworkBase_unsetEnvironment = NetworkBase.unsetEnvironment
NetworkBase_waitConnection = NetworkBase.waitConnection
NetworkBase_waitPort = NetworkBase.waitPort
NetworkBase_write = NetworkBase.write
NetworkBase_writeToNameServer = NetworkBase.writeToNameServer
NetworkBase_yarpClockInit = NetworkBase.yarpClockInit
OdometryData_copyPortable = OdometryData.copyPortable
PeriodicThread_getCount = PeriodicThread.getCount
PeriodicThread_getKeyOfCaller = PeriodicThread.getKeyOfCaller
PeriodicThread_setDefaultStackSize = PeriodicThread.setDefaultStackSize
PeriodicThread_yield_c = PeriodicThread.yield_c
Portable_copyPortable = Portable.copyPortable
PortablePair_copyPortable = PortablePair.copyPortable
PortablePair_readPair = PortablePair.readPair
PortablePair_writePair = PortablePair.writePair
PortablePairBase_copyPortable = PortablePairBase.copyPortable
PortablePairBase_readPair = PortablePairBase.readPair
PortablePairBase_writePair = PortablePairBase.writePair
Pose6D_copyPortable = Pose6D.copyPortable
Property_copyPortable = Property.copyPortable
QosStyle_getDSCPByVocab = QosStyle.getDSCPByVocab
QosStyle_getLevelByVocab = QosStyle.getLevelByVocab
Random_normal = Random.normal
Random_seed = Random.seed
Random_seed_c = Random.seed_c
Random_uniform = Random.uniform
RateThread_getCount = RateThread.getCount
RateThread_getKeyOfCaller = RateThread.getKeyOfCaller
RateThread_setDefaultStackSize = RateThread.setDefaultStackSize
RateThread_yield_c = RateThread.yield_c
ResourceFinder_getConfigDirs = ResourceFinder.getConfigDirs
ResourceFinder_getConfigHome = ResourceFinder.getConfigHome
ResourceFinder_getConfigHomeNoCreate = ResourceFinder.getConfigHomeNoCreate
ResourceFinder_getDataDirs = ResourceFinder.getDataDirs
ResourceFinder_getDataHome = ResourceFinder.getDataHome
ResourceFinder_getDataHomeNoCreate = ResourceFinder.getDataHomeNoCreate
ResourceFinder_getResourceFinderSingleton = ResourceFinder.getResourceFinderSingleton
ReturnValue_copyPortable = ReturnValue.copyPortable
Sound_copyPortable = Sound.copyPortable
Stamp_copyPortable = Stamp.copyPortable
Thread_getCount = Thread.getCount
Thread_getKeyOfCaller = Thread.getKeyOfCaller
Thread_setDefaultStackSize = Thread.setDefaultStackSize
Thread_yield_c = Thread.yield_c
Time_delay = Time.delay
Time_getClockType = Time.getClockType
Time_isClockInitialized = Time.isClockInitialized
Time_isCustomClock = Time.isCustomClock
Time_isNetworkClock = Time.isNetworkClock
Time_isSystemClock = Time.isSystemClock
Time_isValid = Time.isValid
Time_now = Time.now
Time_turboBoost = Time.turboBoost
Time_useCustomClock = Time.useCustomClock
Time_useNetworkClock = Time.useNetworkClock
Time_useSystemClock = Time.useSystemClock
Time_yield_c = Time.yield_c
Type_anon = Type.anon
Type_byName = Type.byName
Type_byNameOnWire = Type.byNameOnWire
Value_copyPortable = Value.copyPortable
Value_getNullValue = Value.getNullValue
Value_makeBlob = Value.makeBlob
Value_makeDouble = Value.makeDouble
Value_makeFloat32 = Value.makeFloat32
Value_makeFloat64 = Value.makeFloat64
Value_makeInt = Value.makeInt
Value_makeInt16 = Value.makeInt16
Value_makeInt32 = Value.makeInt32
Value_makeInt64 = Value.makeInt64
Value_makeInt8 = Value.makeInt8
Value_makeList = Value.makeList
Value_makeString = Value.makeString
Value_makeValue = Value.makeValue
Value_makeVocab = Value.makeVocab
Value_makeVocab32 = Value.makeVocab32
Vector_copyPortable = Vector.copyPortable
VectorBase_copyPortable = VectorBase.copyPortable
VectorInt_copyPortable = VectorInt.copyPortable
Vocab_decode = Vocab.decode
Vocab_encode = Vocab.encode
vertex_t_copyPortable = vertex_t.copyPortable
