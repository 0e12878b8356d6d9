"""The types of yarp::sig: images, sounds, point clouds, vectors, matrices."""
