"""Messages, progress and exit statuses."""
