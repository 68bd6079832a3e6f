"""Cases, gates and paper values as data, and their schemas."""
