"""What all tests share: a browser (`support/browser.py`)."""

pytest_plugins = ["support.browser"]
