"""How messages are spelled in files so that other programs see them, and YARP's bytes come back."""
