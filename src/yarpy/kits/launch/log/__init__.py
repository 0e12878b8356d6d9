"""Log: takes what all programs of the network log, filters it, shows it and keeps it."""
