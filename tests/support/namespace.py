"""Network namespaces: several hosts on this computer. They need root and the command ip."""

import os
import shutil
import subprocess


def ip(*words: str, check: bool = True) -> None:
    subprocess.run(["ip", *words], check=check, capture_output=True, timeout=10)


def why_not() -> str:
    """Why there can be none, "" if there can."""
    if not hasattr(os, "geteuid") or os.geteuid() != 0:
        return "network namespaces need root: run this file with sudo"
    if shutil.which("ip") is None:
        return "network namespaces need the command ip: install iproute2"
    name = f"t{os.getpid()}"
    probe = subprocess.run(["ip", "netns", "add", name], capture_output=True, text=True)
    if probe.returncode:
        return f"this system has no network namespaces: {probe.stderr.strip()}"
    ip("netns", "del", name)
    return ""
