"""The elastic half-space: mesh, stiffness, exterior, and the compliance of its surface."""
