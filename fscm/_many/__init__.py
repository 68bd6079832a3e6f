"""Batches of problems on common meshes: pull-off forces and their bounds (see `fscm.many`)."""
