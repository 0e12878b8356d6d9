"""Pictures of the simulated robot's cameras: a scene, its textures, and the pixels."""
