/* A robot's arm: a method for every type that Thrift has. */

typedef i32 ( yarp.type = "yarp::conf::vocab32_t" ) vocab
typedef i8 ( yarp.type = "std::uint8_t" ) ui8
typedef double ( yarp.type = "yarp::conf::float32_t" ) float32

const i32 JOINTS = 4

enum Mode { IDLE = 0, POSITION = 1, TORQUE = 5 }

/** Where something is, in metres. */
struct Pose {
  1: double x,
  2: double y,
  3: string frame = "base"
}

struct Status {
  1: Mode mode = Mode.IDLE,
  2: Pose pose,
  3: list<double> angles,
  4: map<string, i32> counts
}

/** A type of C++ YARP, as it is. */
struct Vector {
  1: list<double> content
} ( yarp.name = "yarp::sig::Vector" )

service Arm {
  /** Moves a joint to an angle, in degrees; false if there is no such joint. */
  bool move(1: i32 joint, 2: double angle, 3: double speed = 10.0);
  /** Stops at once. Nobody waits for it. */
  oneway void stop();
  void rest();
  i32 count_joints();
  i8 small(1: i8 value);
  i16 short_number(1: i16 value);
  i64 large(1: i64 value);
  ui8 unsigned_number(1: ui8 value);
  float32 single(1: float32 value);
  string say(1: string text, 2: i32 times = 1);
  vocab word(1: vocab value);
  binary reverse(1: binary data);
  Mode set_mode(1: Mode mode = Mode.POSITION);
  list<double> scale(1: list<double> values, 2: double factor = 2.0);
  set<i32> unique(1: list<i32> values);
  map<string, i32> letters(1: string text);
  list<Pose> path(1: Pose begin, 2: Pose end, 3: i32 steps = 3);
  list<list<i32>> grid(1: i32 rows, 2: i32 columns);
  Status status();
  Vector add(1: Vector a, 2: Vector b);
}
