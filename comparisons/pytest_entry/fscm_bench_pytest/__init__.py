"""Nothing: an installation of an earlier version names this module as a plugin of pytest."""
