/* What `/robot/yarprobotinterface` is asked: the words of C++ YARP, and two more. */

service RobotInterface {
  /** Return the phase: startup, run, interrupt1, interrupt2, interrupt3 or shutdown. */
  string get_phase();
  /** Return the level of the phase, from 0 on. */
  i32 get_level();
  /** Return the name of the robot. */
  string get_robot();
  /** Return whether the robot has started and runs. */
  bool is_ready();
  /** End the robot. */
  string quit();
  /** End the robot. */
  string bye();
  /** End the robot. */
  string exit();
  /** (yarpy) Return a line for each device: its name, its state, the reason of that. */
  list<string> get_devices();
  /** (yarpy) Open a device that has failed, and do what could not be done without it. */
  bool retry(1: string device);
}
