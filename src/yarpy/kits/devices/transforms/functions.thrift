/* The store of frames and where they are: what the ports `thrift` of frameTransformSet_nws_yarp and
 * frameTransformGet_nws_yarp are asked.
 */

typedef i32 (yarp.type = "yarp::conf::vocab32_t") vocab

/** The outcome of a call: ok, or err1 (failed) ... err7, miss. */
struct Status { 1: vocab code }

/** The pose of the frame `target`, seen from `source`: metres, and a quaternion. */
struct Transform {
  1: string source, 2: string target,
  3: double time, 4: i8 constant,
  5: double x, 6: double y, 7: double z,
  8: double qx, 9: double qy, 10: double qz, 11: double qw = 1.0
}

struct Transforms { 1: Status status (yarp.nested = "true"), 2: list<Transform> transforms }

service FrameTransformStorageSetRPC {
  Status setTransformsRPC(1: list<Transform> transforms);
  Status setTransformRPC(1: Transform transform (yarp.nested = "true"));
  Status deleteTransformRPC(1: string source, 2: string target);
  Status clearAllRPC();
}

service FrameTransformStorageGetRPC {
  Transforms getTransformsRPC();
}
