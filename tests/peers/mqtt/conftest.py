"""Names within the process, and settings that end with each test."""

from support.wrapping import names, no_settings

__all__ = ["names", "no_settings"]
