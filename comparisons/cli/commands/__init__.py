"""One module a command of the command line: `add` declares its arguments, `call` carries it out."""
