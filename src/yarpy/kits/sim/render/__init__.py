"""What a camera of the simulated robot sees: a scene, its textures, and the pixels."""
