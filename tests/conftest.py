"""What all tests share: a browser (`support/browser.py`), and signals as a terminal gives them."""

import signal

pytest_plugins = ["support.browser"]


def pytest_configure() -> None:
    """Undo what a shell does to background jobs: programs that tests start would inherit it, and
    could not be interrupted."""
    if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)
    hang_up = getattr(signal, "SIGHUP", None)
    if hang_up is not None and signal.getsignal(hang_up) is signal.SIG_IGN:
        signal.signal(hang_up, signal.SIG_DFL)
