"""Models from outside: found by entry point, file or data folder, run in a process of their own, checked.

Nothing of theirs is ever imported into this process.  A package or a file runs in a child (`child`, `worker`)
that has a time limit, a memory limit and, where the system can, no right to write outside its scratch folder;
predictions as data (`data_model`) run nothing at all.  `loading.load_model` hides the difference: whatever
the door, what comes out is a `comparisons.model.Model`.
"""
