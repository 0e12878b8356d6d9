"""Programs linked from what C++ YARP brings: its libraries and headers.

    linked(cpp, "devices", source, ["fakeFrameGrabber"], ["YARP_dev", "YARP_os"])

Rules: they are linked once, and kept beside the prefix or virtual environment. A source includes
nothing for plugins (devices, carriers), it calls `add_plugins();`. The package has them as static
libraries, which are linked; an installation has them as files, which the program loads itself.
"""

import hashlib
import os
import shutil
import subprocess
from collections.abc import Sequence
from pathlib import Path

from support.cpp import CppYarp
from support.file_lock import hold
from support.peer_venv import MissingPeer

#: Static libraries that others need.
_BELOW = ("YARP_priv_hmac", "YARP_wire_rep_utils", "YARP_gsl")
#: Plugins in the library of another.
_WITHIN = {"remotecontrolboardremapper": "controlboardremapper", "unix_stream": "unix"}


def linked(
    cpp: CppYarp, name: str, source: str, plugins: Sequence[str], libraries: Sequence[str]
) -> Path:
    """The program whose main function is in `source`; links it the first time. Or MissingPeer."""
    there = plugins if cpp.package else []
    declared = "".join(f"void add_owned_{plugin}(const char*);\n" for plugin in there)
    added = " ".join(f'add_owned_{plugin}("host");' for plugin in there)
    source = f"{declared}static void add_plugins() {{ {added} }}\n{source}"
    mark = hashlib.sha256(source.encode()).hexdigest()[:12]
    target = cpp.root.parent / f"{cpp.root.name}-{name}-{mark}"
    with (cpp.root.parent / f"{target.name}.lock").open("w") as lock:
        hold(lock)
        if not target.exists():
            file = target.with_name(f"{target.name}.cpp")
            file.write_text(source)
            within = dict.fromkeys(f"yarp_{_WITHIN.get(plugin, plugin)}" for plugin in there)
            compiled(cpp, target, [file], [*within, *libraries])
    return target


def compiled(
    cpp: CppYarp,
    target: Path,
    sources: Sequence[Path],
    libraries: Sequence[str],
    *options: str,
) -> None:
    """Compile and link `target` from these files. Or MissingPeer."""
    compiler = shutil.which(os.environ.get("CXX", "g++"))
    if compiler is None:
        raise MissingPeer("a C++ peer has to be compiled: install g++, or name it in CXX")
    half_done = target.with_name(f"{target.name}.part")
    standard = "-std=c++17" if cpp.version < (3, 9) else "-std=c++20"
    include = (cpp.package or cpp.root) / "include"
    command = [
        *(compiler, standard, *options, f"-I{include}", *map(str, sources)),
        *("-o", str(half_done), *_libraries(cpp, libraries), "-lz", "-lpthread", "-ldl"),
    ]
    try:
        subprocess.run(command, check=True, capture_output=True, text=True, timeout=400)
    except subprocess.CalledProcessError as error:
        line = error.stderr.strip().splitlines()[-1:]
        raise MissingPeer(f"could not compile {target.name}: {' '.join(line)}") from error
    half_done.replace(target)


def _libraries(cpp: CppYarp, names: Sequence[str]) -> list[str]:
    if cpp.package is None:
        place = cpp.root / "lib"
        return [f"-L{place}", f"-Wl,-rpath,{place}", *(f"-l{name}" for name in names)]
    foreign = cpp.package.parent / "yarp_middleware.libs"
    files = [str(cpp.package / f"lib/lib{name}.a") for name in (*names, *_BELOW)]
    return [
        *("-Wl,--start-group", *files, "-Wl,--end-group"),
        *map(str, sorted(foreign.glob("libACE*.so*"))),
        f"-Wl,-rpath,{foreign}",
    ]
