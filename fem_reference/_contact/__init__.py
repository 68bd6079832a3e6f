"""Contact equilibrium: equations, continuation, events, choice of meshes, uncertainty."""
