"""Contact of a solid of finite strain: elements, surface force, equilibria, path, error estimate."""
