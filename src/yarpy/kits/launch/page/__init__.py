"""The page of a running application."""
