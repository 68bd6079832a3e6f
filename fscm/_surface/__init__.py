"""One state of the surface: mesh, kernel, response, deformation, tail, equilibrium and its solution on a mesh."""
