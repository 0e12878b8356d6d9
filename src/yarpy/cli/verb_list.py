"""The verbs of `yarpy`, in groups, each with what it does and an example.

Rules: this table is what `yarpy help`, completion, the manual page and docs/cli.md agree on; it is
read without loading a verb. A verb is the module of its name in `verbs`.
"""

from __future__ import annotations

from typing import Final, NamedTuple


class Verb(NamedTuple):
    """`about` is one line without a full stop; `example` is typed behind `yarpy`."""

    about: str
    example: str


GROUPS: Final[dict[str, dict[str, Verb]]] = {
    "Sending and receiving": {
        "read": Verb("print what arrives at a port", "read ... /icubSim/head/state:o once"),
        "write": Verb("send lines from a port", "write /talker /listener"),
        "readwrite": Verb(
            "print what arrives at one port, send lines from another", "readwrite /me/in /me/out"
        ),
        "rpc": Verb("send lines to a port and print its replies", "rpc /icubSim/head/rpc:i"),
        "rpcserver": Verb("print questions and answer them by hand", "rpcserver /answerer"),
        "admin": Verb("write or rpc to the administrative side of a port", "admin rpc /listener"),
    },
    "Looking and hearing": {
        "view": Verb(
            "look at images, or a recording, in a browser", "view --connect /icubSim/cam/left"
        ),
        "scope": Verb("look at numbers as curves in a browser", "scope /icubSim/inertial"),
        "dash": Verb("see and change the whole network in a browser", "dash"),
        "log": Verb("see what the programs of the network log", "log --level WARNING"),
        "panel": Verb("see and move a robot in a browser", "panel /icubSim"),
        "hear": Verb("play what a port says, or record it", "hear /ears --record ears.wav"),
        "speak": Verb("send a WAV file or the microphone to ports", "speak /mouth --play hi.wav"),
    },
    "Recording": {
        "record": Verb("keep what ports send in a file", "record /icub/head/state:o -o walk"),
        "play": Verb("send what was recorded again", "play walk.mcap --prefix /replay"),
        "info": Verb("say what is in a recording", "info walk.mcap"),
        "convert": Verb(
            "write a recording in another way, or some of it",
            "convert walk.mcap -o short --start 5",
        ),
        "cut": Verb("write a stretch of time of a recording", "cut walk.mcap -o fall --start 5"),
        "filter": Verb("write some ports of a recording", "filter walk.mcap -o small -e ^/icub/"),
    },
    "Applications": {
        "up": Verb("start the programs of a file and keep them running", "up robot.toml"),
        "down": Verb("stop a running application", "down robot"),
        "status": Verb("show how a running application is doing", "status"),
        "logs": Verb("show what its programs have printed", "logs camera -n 100"),
        "start": Verb("start one of its programs", "start camera"),
        "stop": Verb("end one of its programs, and leave it so", "stop camera"),
        "restart": Verb("end one of its programs and start it again", "restart camera"),
        "new": Verb("write a project that runs and is tested", "new ball_tracker"),
        "robot": Verb("open and join the devices of a robot", "robot icub.xml --check"),
        "dev": Verb("open one device and serve it", "dev --device fakeFrameGrabber --name /cam"),
    },
    "A robot to try things with": {
        "demo": Verb("see and move a simulated robot in a browser", "demo"),
        "sim": Verb("simulate a robot", "sim --robot /icubSim"),
    },
    "Starting programs": {
        "run": Verb(
            "start programs here or on other computers",
            "run --on /nodeA --as cam -- yarpdev --device fakeFrameGrabber",
        ),
    },
    "Connections": {
        "connect": Verb(
            "connect two ports, or list persistent connections",
            "connect /talker /listener fast_tcp",
        ),
        "disconnect": Verb("end a connection of two ports", "disconnect /talker /listener"),
        "qos": Verb(
            "show or set the priority of a connection's packets", "qos get /talker /listener"
        ),
        "sched": Verb(
            "show or set the scheduling of a connection's thread",
            "sched set /talker /listener --des FIFO:30",
        ),
        "autoqos": Verb(
            "set priorities by what matters, while connections run", "autoqos rules.toml"
        ),
        "exists": Verb("tell whether a port or a connection is alive", "exists /talker /listener"),
        "wait": Verb("wait for a port or a connection", "wait /talker --timeout 10"),
        "ping": Verb("ask a port about itself and its connections", "ping /talker"),
        "topic": Verb("make, list or remove topics", "topic --list"),
        "terminate": Verb("ask a program to end, by the name of its port", "terminate /module"),
    },
    "The name server": {
        "server": Verb("run a name server", "server --portdb ports.db"),
        "router": Verb(
            "pass on names and messages between computers, by Zenoh", "router tcp/0.0.0.0:7447"
        ),
        "name": Verb("send a command to the name server", "name query /talker"),
        "clean": Verb("take names of dead ports off the name server", "clean"),
        "where": Verb("tell where the name server is", "where"),
        "detect": Verb("search the network for a name server", "detect --write"),
        "conf": Verb("show or set the address of the name server", "conf 192.168.0.3 10000"),
        "namespace": Verb("show or set the namespaces in use", "namespace /lab"),
    },
    "Passing messages on": {
        "repeat": Verb("send on what a port receives", "repeat /tee"),
        "sample": Verb(
            "send on what a port receives, at a constant rate",
            "sample --output /slow --rate 10 --input /icubSim/inertial",
        ),
        "merge": Verb("concatenate what several ports send", "merge /left /right"),
        "split": Verb("send each element of a message to a port of its own", "split /state"),
    },
    "Measuring and the rest": {
        "top": Verb("show how every connection is doing, live", "top /icub --sort drops"),
        "stats": Verb(
            "show every connection once, or measure what a port sends",
            "stats --wide",
        ),
        "trafficgen": Verb(
            "send messages of a given size at a given rate",
            "trafficgen /load --bandwidth 100 --size 1",
        ),
        "doctor": Verb("say why nothing arrives, and what mends it", "doctor /talker /listener"),
        "check": Verb("try whether ports work here, or what is odd in files", "check robot.xml"),
        "access": Verb(
            "show who may do what with the ports here, or change it",
            "access allow script 192.168.1.9",
        ),
        "cert": Verb("make a certificate for TLS", "cert robot.lab 192.168.1.7"),
        "resource": Verb("find configuration files", "resource --from robot.ini"),
        "idl": Verb(
            "show types of ROS, or write Python for them and for Thrift", "idl thrift camera.thrift"
        ),
        "plugin": Verb(
            "list carriers, types, monitors and commands that are installed", "plugin tcp"
        ),
        "completion": Verb(
            "print what makes Tab complete in bash, zsh or fish", "completion bash >> ~/.bashrc"
        ),
        "env": Verb("print environment variables", "env"),
        "time": Verb("print the time, again and again", "time"),
        "clock": Verb("send the time to programs that have YARP_CLOCK", "clock --rtf 0.5"),
        "version": Verb("print the version", "version"),
        "help": Verb("list the commands, or explain one", "help connect"),
    },
}
VERBS: Final = {name: verb for group in GROUPS.values() for name, verb in group.items()}
