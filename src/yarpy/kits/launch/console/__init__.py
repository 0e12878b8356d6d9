"""The screen of a running application, and the socket by which other commands reach it."""
