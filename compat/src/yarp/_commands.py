"""The classical commands, as aliases of `yarpy`.

    yarp ...          yarpy ...            yarpserver        yarpy server
    yarpview          yarpy view           yarpscope         yarpy scope
    yarphear          yarpy hear           yarpidl_thrift    yarpy idl thrift
    yarpidl_rosmsg    yarpy idl rosmsg     yarp-config       where things are kept
    yarprun           yarpy run            yarplogger        yarpy log
    yarpdev           see `_yarpdev`
    yarpdatadumper    see `_datadumper`       yarpdataplayer    see `_dataplayer`
    yarprobotinterface                        yarpy robot
    yarpmanager       yarpy up --idle --page  yarpmanager-console    see `yarpy.kits.launch.manager`

Rules: arguments are translated word by word (`translate_...`, pure) and `yarpy` does the rest. What
a page in a browser has no use for, such as the place of a window, is left out, and that is said.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Final, NoReturn

import yarpy
from yarp._log import print_lines
from yarpy.config.command_line import parse_options
from yarpy.config.configuration import configuration, namespace_file, server_file
from yarpy.config.resource import base_directories
from yarpy.data.text import plain_text
from yarpy.platform.folders import conf_directory

#: Options of windows, and of what is drawn into them.
_WINDOW: Final = frozenset(
    """
    x y w h p dx dy title Title compact minimal interval RefreshTime PosX PosY Width
    Height saveoptions synch autosize keep-above fullscreen bgcolor color thickness type
    graph_thickness graph_size plot_title bufsize bufferSize rows columns gridx gridy
    hspan vspan rightout leftout nodevice mute device size graph_title autorescale
    no-persistent OutputEnabled neto neti
    """.split()  # noqa: SIM905
)

_HELP: Final = frozenset(("-h", "-help", "--help"))


class Wrong(Exception):
    """The arguments make no sense; the text says why."""


def translate_view(arguments: Sequence[str]) -> list[str]:
    """`yarpview [--name /p] [--out /q]`, `yarpview /p`."""
    options, plain = _split(arguments)
    found = ["view", *plain]
    if not plain:
        found.append(_text(options, "name", "PortName") or "/yarpview/img:i")
    for key in ("remote", "connect"):
        if key in options:
            found += ["--connect", _text(options, key)]
    out = _text(options, "out", "OutPortName")
    if out:
        found += ["--out", out]
    return found + _rest(
        options,
        {"name", "PortName", "remote", "connect", "out", "OutPortName"},
        {"carrier", "quality", "rate"},
    )


def translate_scope(arguments: Sequence[str]) -> list[str]:
    """`yarpscope --remote /p [--index "(0 1)"] [--min -1] [--max 1]`."""
    options, plain = _split(arguments)
    found = ["scope", *plain]
    remote = _words(options, "remote")
    found += remote
    index = _words(options, "index")
    if index:
        found += ["--index", ",".join(index)]
    found += ["--name", _text(options, "name") or "/yarpscope"]
    return found + _rest(options, {"remote", "index", "name"}, {"carrier", "min", "max", "window"})


def translate_hear(arguments: Sequence[str]) -> list[str]:
    """`yarphear [--name /p] [--remote /q]`."""
    options, plain = _split(arguments)
    name = _text(options, "name") or "/yarphear"
    rest = _rest(options, {"remote", "name"}, {"carrier", "record", "duration"})
    return ["hear", *plain, *_words(options, "remote"), "--name", name, *rest]


def translate_manager(arguments: Sequence[str]) -> list[str]:
    """`yarpmanager --application F.xml`, whose window is a page here; nothing runs at first."""
    options, plain = _split(arguments)
    files = [*_words(options, "application"), *plain]
    if len(files) != 1 and not _HELP.intersection(arguments):
        raise Wrong("yarpmanager --application FILE.xml")
    known = {"application", "from", "ymanagerini_dir", "apppath", "modpath", "respath"}
    known |= {"templpath", "load_subfolders", "watchdog", "add_current_dir", "silent"}
    return ["up", *files, "--idle", "--page", *_rest(options, known, set())]


def translate_thrift(arguments: Sequence[str]) -> list[str]:
    """`yarpidl_thrift --gen yarp [-o DIR] [-I DIR] FILE...`, which writes Python here; `--gen ts`
    writes TypeScript."""
    found, files = ["idl", "thrift"], list[str]()
    if _HELP.intersection(arguments):
        return [*found, "--help"]
    words = iter(arguments)
    for word in words:
        if word in ("-gen", "--gen"):
            language = next(words, "").partition(":")[0]
            if language not in ("yarp", "py", "python", "ts"):
                raise Wrong(
                    f'no generator "{language}": this one writes Python (--gen py) and TypeScript '
                    "(--gen ts)"
                )
            found += ["--gen", "ts"] if language == "ts" else []
        elif word in ("-o", "-out", "--out"):
            found += ["--out", next(words, ".")]
        elif word == "--check":
            found.append(word)
        elif word in ("-I", "--I", "--folder"):
            found += ["--folder", next(words, ".")]
        elif word in ("-r", "-v", "--verbose", "-recurse", "--recurse", "-strict", "-debug"):
            continue
        elif word.startswith("-"):
            raise Wrong(f'no option "{word}"')
        else:
            files.append(word)
    if not files:
        raise Wrong("give a .thrift file: yarpidl_thrift --gen py camera.thrift")
    return [*found, *files]


def translate_rosmsg(arguments: Sequence[str]) -> list[str]:
    """`yarpidl_rosmsg --name /typ@/yarpros` serves types; with a type, Python for it is printed.

    What `yarpy idl rosmsg` takes besides is taken here, too.
    """
    found, form, names = ["idl", "rosmsg"], "--python", list[str]()
    if _HELP.intersection(arguments):
        return [*found, "--help"]
    words = iter(arguments)
    for word in words:
        if word in ("--raw", "--md5", "--python", "--stubs"):
            form = word
        elif word in ("--name", "--folder", "--context"):
            found += [word, next(words, "")]
        elif word in ("--out", "--no-ros", "--web", "--soft"):
            next(words, "")
        elif word in ("--no-cache", "--no-index", "--verbose"):
            continue
        elif word.startswith("-"):
            raise Wrong(f'no option "{word}"')
        else:
            names.append(word)
    if "--name" in found:
        return found
    if not names:
        raise Wrong("give a type or a file: yarpidl_rosmsg std_msgs/String")
    return [*found, form, *names]


def translate_yarp(arguments: Sequence[str]) -> list[str]:
    """`yarp [verbose|quiet] COMMAND ...`."""
    found = [*arguments]
    while found[:1] in (["verbose"], ["quiet"]):
        del found[0]
    if found[:1] == ["config"]:
        raise Wrong("that is a command of its own: yarp-config")
    return found


def translate_server(arguments: Sequence[str]) -> list[str]:
    """`yarpserver [--write | --read] [--ip H] [--socket N] [--portdb F] [--subdb F] ...`."""
    return ["server", *(word for word in arguments if word not in ("verbose", "quiet"))]


def translate_logger(arguments: Sequence[str]) -> list[str]:
    """`yarplogger [--name /yarplogger] [--start] ...`, which takes all ports by itself."""
    options, plain = _split(arguments)
    found = ["log", *plain]
    if "name" in options:
        found += ["--name", _text(options, "name")]
    windows = {"start", "unlimited_size", "no_stop", "no_gui"}
    return found + _rest(options, {"name", *windows}, {"level", "program", "component", "grep"})


def translate_run(arguments: Sequence[str]) -> list[str]:
    """`yarprun --server /node [--log]`, whose programs end with it; `yarprun --on /node ...`."""
    found, option = ["run"], ""
    for word in arguments:
        follows = not word.startswith("--")
        option = option if follows else word
        if option in ("--hold", "--geometry"):
            continue  # of a window
        if option == "--cmd" and follows and found[-1] != option:
            found[-1] += f" {word}"  # its words, without quotes
        else:
            found.append(word)
    if "--server" in found:
        found.append("--end-programs")
    return found


def translate_robot(arguments: Sequence[str]) -> list[str]:
    """`yarprobotinterface --config robot.xml [--portprefix P] [--enable_tags "(a b)"] [--dryrun]`.

    The file may be named in `yarprobotinterface.ini`; other options replace parameters.
    """
    if _HELP.intersection(arguments):
        return ["robot", "--help"]
    finder = yarpy.ResourceFinder(arguments, file="yarprobotinterface.ini")
    config = plain_text(finder.find("config", ""))
    if not config:
        raise Wrong("give the file of a robot: yarprobotinterface --config robot.xml")
    found = ["robot", str(finder.file(config) or config)]
    options, _ = _split(arguments)
    for key in options:
        words = [plain_text(word) for word in (options[key] or [key])[1:]]
        if key in ("config", "from", "context", "verbose") or key.startswith("allow-deprecated"):
            continue
        if key == "dryrun":
            found.append("--check")
        elif key in ("portprefix", "enable_tags", "disable_tags"):
            found += [f"--{key}", " ".join(_words(options, key))]
        else:
            found += [f"--{key}", *words]
    return found


# --- yarp-config

_CONFIG: Final = (
    "yarp-config --namespace | --nameserver | --version | context --list | context --where C | "
    "robot --list | robot --where R | robot --current; files of contexts are copied by hand"
)


def config_lines(arguments: Sequence[str], environment: Mapping[str, str]) -> list[str]:
    """Return what `yarp-config` prints. Raises Wrong."""
    match [*arguments]:
        case ["--version"]:
            return [yarpy.__version__]
        case ["--namespace"]:
            return [str(namespace_file(conf_directory(environment)))]
        case ["--nameserver"]:
            found = configuration(environment)
            return [str(server_file(found.directory, found.namespace))]
        case ["context" | "robot" as kind, "--list", *_]:
            return _listed(kind, environment)
        case ["context" | "robot" as kind, "--where", name]:
            folders = _folders(kind, environment)
            paths = [str(folder / name) for folder in folders if (folder / name).is_dir()]
            if not paths:
                raise Wrong(f'no {kind} "{name}": yarp-config {kind} --list shows what there is')
            return paths
        case ["robot", "--current"]:
            return [environment.get("YARP_ROBOT_NAME") or "default"]
        case ["--help"]:
            return [_CONFIG]
    raise Wrong(_CONFIG)


def _folders(kind: str, environment: Mapping[str, str]) -> list[Path]:
    return [base / f"{kind}s" for base in base_directories(environment)]


def _listed(kind: str, environment: Mapping[str, str]) -> list[str]:
    lines = []
    for folder in _folders(kind, environment):
        if folder.is_dir():
            lines.append(f"* Directory : {folder}")
            lines += sorted(item.name for item in folder.iterdir() if item.is_dir())
    return lines


# --- options


def _split(arguments: Sequence[str]) -> tuple[dict[str, Any], list[str]]:
    """`--key value ...` by key, and what stands before the first of them."""
    count = next((n for n, word in enumerate(arguments) if word.startswith("--")), len(arguments))
    options = parse_options(arguments[count:])
    return {key: options.group(key) for key in options}, [*arguments[:count]]


def _words(options: Mapping[str, Any], key: str) -> list[str]:
    """The values of an option, those of a list one by one."""
    found: list[str] = []
    for value in (options.get(key) or [key])[1:]:
        found += map(plain_text, value) if isinstance(value, list) else [plain_text(value)]
    return found


def _text(options: Mapping[str, Any], *keys: str) -> str:
    return next((words[0] for key in keys if (words := _words(options, key))), "")


def _rest(options: Mapping[str, Any], done: set[str], same: set[str]) -> list[str]:
    """Options that are spelled the same there; those that mean nothing here are said."""
    found = []
    for key in options:
        if key in done:
            continue
        if key in same:
            found += [f"--{key}", *_words(options, key)[:1]]
        elif key in _WINDOW:
            print(f"note: --{key} means nothing in a browser", file=sys.stderr)
        elif key in ("help", "no-browser"):
            found.append(f"--{key}")
        else:
            raise Wrong(f'no option "--{key}"')
    return found


# --- programs


def _forward(name: str, translate: Any) -> NoReturn:
    try:
        words = translate(sys.argv[1:])
    except Wrong as wrong:
        print(f"error: {name}: {wrong}", file=sys.stderr)
        sys.exit(1)
    sys.argv = ["yarpy", *words]
    from yarpy.cli.start import main

    main()


def yarp() -> NoReturn:
    _forward("yarp", translate_yarp)


def yarpserver() -> NoReturn:
    _forward("yarpserver", translate_server)


def yarpview() -> NoReturn:
    _forward("yarpview", translate_view)


def yarpscope() -> NoReturn:
    _forward("yarpscope", translate_scope)


def yarphear() -> NoReturn:
    _forward("yarphear", translate_hear)


def yarplogger() -> NoReturn:
    _forward("yarplogger", translate_logger)


def yarprun() -> NoReturn:
    _forward("yarprun", translate_run)


def yarprobotinterface() -> NoReturn:
    _forward("yarprobotinterface", translate_robot)


def yarpmanager() -> NoReturn:
    _forward("yarpmanager", translate_manager)


def yarpmanager_console() -> NoReturn:
    from yarpy.kits.launch.manager import words

    sys.exit(words.main(sys.argv[1:]))


def yarpidl_thrift() -> NoReturn:
    _forward("yarpidl_thrift", translate_thrift)


def yarpidl_rosmsg() -> NoReturn:
    _forward("yarpidl_rosmsg", translate_rosmsg)


def yarp_config() -> NoReturn:
    try:
        lines = config_lines(sys.argv[1:], os.environ)
    except Wrong as wrong:
        print(f"usage: {wrong}", file=sys.stderr)
        sys.exit(1)
    print_lines(lines)
    sys.exit(0)
