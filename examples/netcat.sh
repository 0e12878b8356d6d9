#!/bin/sh
# Netcat: talks to two yarpy ports with nothing but `nc`.
#
#     yarpy server
#     python examples/talker.py           # says its HOST:PORT
#     python examples/rpc_server.py       # says its HOST:PORT
#     sh examples/netcat.sh HOST:PORT-OF-TALKER HOST:PORT-OF-SERVER
#
# Works against C++ YARP ports too. docs/humans.md explains the words.

talker=${1:?HOST:PORT of examples/talker.py}
server=${2:?HOST:PORT of examples/rpc_server.py}

# say HOST:PORT SECONDS LINE...: connect, send the lines, stay connected for so many seconds.
say() {
    address=$1 seconds=$2
    shift 2
    { printf '%s\r\n' "$@"; sleep "$seconds"; } | nc "${address%:*}" "${address##*:}"
}

echo "--- bytes that are no greeting"
say "$server" 0 "what is this"

echo "--- two questions to the RPC server; a list goes on until its bracket closes"
say "$server" 0 "CONNECT test" "d" "add 1 2" "d" "set path (1 2" "3 4)" "q"

echo "--- what the talker says of itself, and its administrative side"
say "$talker" 0 "CONNECT test" "*" "a" "ver" "q"

echo "--- three messages of the talker's stream: a reader says r, and then nothing any more"
say "$talker" 1 "CONNECT test" "r" | head -n 7
