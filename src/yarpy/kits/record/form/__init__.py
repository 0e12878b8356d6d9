"""The form of messages in files, such that other programs see them, and YARP's bytes come back."""
