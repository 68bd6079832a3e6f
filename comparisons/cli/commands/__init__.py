"""Commands of the command line, one module each: `add` declares the arguments, `call` runs the command."""
