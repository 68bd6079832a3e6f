"""The path of equilibria: continuation, completeness, events, jumps and ends."""
