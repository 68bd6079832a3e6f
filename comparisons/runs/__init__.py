"""Runs: cases, tasks, their computation, and the folder that stores them."""
