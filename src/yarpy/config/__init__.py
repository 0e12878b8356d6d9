"""Configuration: the files and words that tell programs what to do, as C++ YARP reads them."""
