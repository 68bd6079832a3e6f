"""Commands of the command line, one module each: its `OPTIONS`, its `EXAMPLES`, and `call`, which runs it."""
