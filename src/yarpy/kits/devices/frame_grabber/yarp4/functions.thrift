/* The camera of YARP 4: what `/robot/eye/rpc` is asked, and the port of the images.
 *
 * Every answer begins with a Status. Features have the numbers of `yarpy.devices.FEATURES`; angles
 * are in degrees, sizes in pixels. Functions with DC1394 are about cameras at FireWire.
 */

typedef i32 (yarp.type = "yarp::conf::vocab32_t") vocab

/** The outcome of a call: ok, or err1 (failed) ... err7, miss. */
struct Status { 1: vocab code }

/** A corner of a part of an image. */
struct Corner { 1: i32 x, 2: i32 y }

/** A way to take images; the code is that of the pixels, a vocab that travels as a number. */
struct Configuration { 1: i32 width, 2: i32 height, 3: double rate, 4: i32 code }

struct Image {} (yarp.name = "yarp::sig::FlexImage" yarp.includefile = "yarp/sig/Image.h")
struct Property {} (yarp.name = "yarp::os::Property" yarp.includefile = "yarp/os/Property.h")

struct Picture { 1: Status status (yarp.nested = "true"), 2: Image image }
struct Number { 1: Status status (yarp.nested = "true"), 2: double value }
struct Pair { 1: Status status (yarp.nested = "true"), 2: double first, 3: double second }
struct Size { 1: Status status (yarp.nested = "true"), 2: i32 width, 3: i32 height }
struct Count { 1: Status status (yarp.nested = "true"), 2: i32 value }
struct Truth { 1: Status status (yarp.nested = "true"), 2: bool value }
struct Configurations {
  1: Status status (yarp.nested = "true"),
  2: list<Configuration> configurations
}
struct Parameters { 1: Status status (yarp.nested = "true"), 2: Property parameters }
struct Description { 1: Status status (yarp.nested = "true"), 2: i32 bus, 3: string text }
struct Window {
  1: Status status (yarp.nested = "true"),
  2: i32 width, 3: i32 height, 4: i32 x, 5: i32 y
}
struct LargestWindow {
  1: Status status (yarp.nested = "true"),
  2: i32 width, 3: i32 height, 4: i32 x_step, 5: i32 y_step, 6: i32 x_offset_step, 7: i32 y_offset_step
}

service FrameGrabberMsgs {

  // images
  Count getHeightRPC();
  Count getWidthRPC();
  Picture getImageRPC();
  Picture getImageCropRPC(1: i32 kind, 2: list<Corner> corners);

  // the lens
  Count getRgbWidthRPC();
  Count getRgbHeightRPC();
  Configurations getRgbSupportedConfigurationsRPC();
  Size getRgbResolutionRPC();
  Status setRgbResolutionRPC(1: i32 width, 2: i32 height);
  Pair getRgbFOVRPC();
  Status setRgbFOVRPC(1: double horizontal, 2: double vertical);
  Parameters getRgbIntrinsicParamRPC();
  Truth getRgbMirroringRPC();
  Status setRgbMirroringRPC(1: bool mirror);

  // features
  Description getCameraDescriptionRPC();
  Truth hasFeatureRPC(1: i32 feature);
  Status setFeature1RPC(1: i32 feature, 2: double value);
  Number getFeature1RPC(1: i32 feature);
  Status setFeature2RPC(1: i32 feature, 2: double first, 3: double second);
  Pair getFeature2RPC(1: i32 feature);
  Truth hasOnOffRPC(1: i32 feature);
  Status setActiveRPC(1: i32 feature, 2: bool on);
  Truth getActiveRPC(1: i32 feature);
  Truth hasAutoRPC(1: i32 feature);
  Truth hasManualRPC(1: i32 feature);
  Truth hasOnePushRPC(1: i32 feature);
  Status setModeRPC(1: i32 feature, 2: i32 mode);
  Count getModeRPC(1: i32 feature);
  Status setOnePushRPC(1: i32 feature);

  // FireWire
  Count getVideoModeMaskDC1394RPC();
  Count getVideoModeDC1394RPC();
  Status setVideoModeDC1394RPC(1: i32 value);
  Count getFPSMaskDC1394RPC();
  Count getFPSDC1394RPC();
  Status setFPSDC1394RPC(1: i32 value);
  Count getISOSpeedDC1394RPC();
  Status setISOSpeedDC1394RPC(1: i32 value);
  Count getColorCodingMaskDC1394RPC(1: i32 video_mode);
  Count getColorCodingDC1394RPC();
  Status setColorCodingDC1394RPC(1: i32 value);
  LargestWindow getFormat7MaxWindowDC1394RPC();
  Window getFormat7WindowDC1394RPC();
  Status setFormat7WindowDC1394RPC(1: i32 width, 2: i32 height, 3: i32 x, 4: i32 y);
  Status setOperationModeDC1394RPC(1: bool value);
  Truth getOperationModeDC1394RPC();
  Status setTransmissionDC1394RPC(1: bool on);
  Truth getTransmissionDC1394RPC();
  Status setBroadcastDC1394RPC(1: bool on);
  Status setDefaultsDC1394RPC();
  Status setResetDC1394RPC();
  Status setPowerDC1394RPC(1: bool on);
  Status setCaptureDC1394RPC(1: bool on);
  Count getBytesPerPacketDC1394RPC();
  Status setBytesPerPacketDC1394RPC(1: i32 value);
}
