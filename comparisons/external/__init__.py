"""External models: from a package, a file or data, run in a process of their own, and checked.

No code of an external model is imported into this process.  A package or a file runs in a child (`child`,
`worker`) that has a time limit, a memory limit and, where the system can, no right to write anywhere but in its
scratch folder.  Predictions as data (`data_model`) run nothing at all.  `model_source.load_model` returns a
`comparisons.model.Model` for every source.
"""
