"""Print a run as the tables of docs/performance.md:  python bench/page.py RESULT.json"""

import json
import sys

# heading, the workloads that are its columns, and how a number is shown
TABLES = (
    (
        "Small message there and back over two streams, median in microseconds:",
        {"stream": "stream", "stream-paced": "paced", "stream-1-core": "1 core"},
    ),
    (
        "Small request and its reply, median in microseconds:",
        {"rpc": "rpc", "rpc-paced": "paced", "rpc-1-core": "1 core"},
    ),
    (
        "Image of 1 MiB there and back, median in microseconds:",
        {"large": "1 MiB", "large-1-core": "1 core"},
    ),
    ("Small messages one way, messages per second:", {"flood": "flood"}),
    ("1 kB to 50 readers until all have it, median in microseconds:", {"fan": "fan of 50"}),
)


def table(workloads, heading, columns):
    columns = {name: title for name, title in columns.items() if name in workloads}
    if not columns:
        return
    peers = []
    for name in columns:
        peers += [peer for peer in workloads[name]["peers"] if peer not in peers]
    print(f"{heading}\n\n| peer | {' | '.join(columns.values())} |")
    print("|---|" + "--:|" * len(columns))
    for peer in peers:
        found = [workloads[name]["peers"].get(peer) for name in columns]
        cells = (f"{one['median']:,.0f}" if one else "" for one in found)
        print(f"| {peer} | {' | '.join(cells)} |")
    print()


def goals(rows):
    print("| workload | ratio | measured | goal | |\n|---|---|--:|--:|---|")
    for row in rows:
        more = row["workload"] == "flood" and "processor" not in row["ratio_of"]
        print(
            f"| {row['workload']} | {row['ratio_of']} | {row['measured']:.2f} "
            f"| {'≥' if more else '≤'} {row['goal']} "
            f"| {'reached' if row['reached'] else 'missed'} |"
        )


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        result = json.load(file)
    for heading, columns in TABLES:
        table(result["workloads"], heading, columns)
    goals(result["goals"])


if __name__ == "__main__":
    main()
