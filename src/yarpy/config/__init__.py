"""Configuration: files, variables and command lines, as C++ YARP reads them."""
