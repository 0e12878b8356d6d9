/* The battery of YARP 3.12 and later: what `/robot/battery/rpc:i` is asked, and what
 * `/robot/battery/data:o` sends.
 */

typedef i32 (yarp.type = "yarp::conf::vocab32_t") vocab

/** The outcome of a call: ok, or err1 (failed) ... err7, miss. */
struct Status { 1: vocab code }

/** Percent, V, A, degrees Celsius; the status has the numbers of `yarpy.devices.BATTERY`. */
struct BatteryData {
  1: double charge,
  2: double voltage,
  3: double current,
  4: double temperature,
  5: i32 status = 3
}

struct Info { 1: Status status (yarp.nested = "true"), 2: string text }

service IBatteryMsgs {
  Info getBatteryInfoRPC();
}
