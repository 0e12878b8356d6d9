/* The laser scanner of YARP 3.10 and later: what `/robot/laser/rpc:i` is asked, and what
 * `/robot/laser` sends. Angles are in degrees, distances in metres.
 */

typedef i32 (yarp.type = "yarp::conf::vocab32_t") vocab

/** The outcome of a call: ok, or err1 (failed) ... err7, miss. */
struct Status { 1: vocab code }

struct Vector { 1: list<double> content }
  (yarp.name = "yarp::sig::Vector" yarp.includefile = "yarp/sig/Vector.h")

/** The first of the ranges belongs to the first angle; what hit nothing is infinite. */
struct LaserScan2D {
  1: double angle_min,
  2: double angle_max,
  3: double range_min,
  4: double range_max,
  5: Vector scans,
  6: i32 status = 3
}

struct Condition { 1: Status status (yarp.nested = "true"), 2: vocab condition }
struct Limits { 1: Status status (yarp.nested = "true"), 2: double low, 3: double high }
struct Number { 1: Status status (yarp.nested = "true"), 2: double value }
struct Info { 1: Status status (yarp.nested = "true"), 2: string text }

service IRangefinder2DMsgs {
  Condition getDeviceStatus_RPC();
  Limits getDistanceRange_RPC();
  Limits getScanLimits_RPC();
  Number getHorizontalResolution_RPC();
  Number getScanRate_RPC();
  Info getDeviceInfo_RPC();
  Status setDistanceRange_RPC(1: double low, 2: double high);
  Status setScanLimits_RPC(1: double low, 2: double high);
  Status setHorizontalResolution_RPC(1: double step);
  Status setScanRate_RPC(1: double rate);
}
