"""Values of Thrift on the wire of YARP: read and written, one by one or by compiled functions."""
