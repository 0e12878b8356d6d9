"""Keys of Zenoh as ends of connections, for programs that know nothing of YARP."""
