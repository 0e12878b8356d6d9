"""The page of a recorder."""
