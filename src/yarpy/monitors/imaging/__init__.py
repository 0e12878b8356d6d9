"""Images in monitors: the image of a message, colour from the grey pictures of Bayer cameras."""
