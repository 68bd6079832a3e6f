"""Commands of the command line, one module each: the examples of its help, its `OPTIONS`, and `call`."""
