"""How fast the page of the network draws in Chromium: 1000 ports, 3000 connections.

    .venv/bin/python bench/dash.py

Prints redraws per second while the picture moves, in views of all, of a part and while one
searches, and what a second of news costs the page. Chromium draws in software here, as a browser
without a graphics card does. Needs playwright and Chromium, as the tests do.
"""

from __future__ import annotations

import statistics
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

from playwright.sync_api import sync_playwright
from support.browser import FLAGS
from support.network import large

import yarpy
from yarpy.kits.views import dash
from yarpy.network.traffic import Snapshot

ROUNDS = 100
MOVE = f"""async () => {{
  const graph = dash.graph, context = graph.canvas.getContext("2d"), times = [];
  for (let round = 0; round < {ROUNDS}; round++) {{
    const begin = performance.now();
    graph.view.x += round % 2 ? 3 : -3;
    graph.redraw();
    context.getImageData(0, 0, 1, 1);
    times.push(performance.now() - begin);
  }}
  return times;
}}"""


def main() -> None:
    network: Snapshot = large(1000, 3000)
    dash.Sampler.look = lambda self: _later(network)  # type: ignore[method-assign]
    names = yarpy.LocalNames()
    with yarpy.Port("/dash", names=names) as port, sync_playwright() as playwright:
        shown = dash.Dash(port, names)
        chromium = playwright.chromium.launch(executable_path="/usr/bin/chromium", args=[*FLAGS])
        page = chromium.new_page(viewport={"width": 1600, "height": 900})
        page.goto(f"http://{port.address}/")
        page.get_by_text("3000 connections").wait_for()
        for view, act in (
            ("all", "dash.graph.fit()"),
            ("a part, with names", "dash.graph.show('/robot1/module50/port0')"),
            (
                "a search",
                "document.querySelector('#search').value = 'port3'; "
                "document.querySelector('#search').oninput()",
            ),
        ):
            page.evaluate(act)
            times = page.evaluate(MOVE)
            middle, worst = statistics.median(times), sorted(times)[int(0.95 * len(times))]
            print(f"{view:20}  {1000 / middle:6.0f} redraws/s, 95 % in {worst:.1f} ms")
        news = page.evaluate(
            """async () => { const begin = performance.now(); for (let i = 0; i < 10; i++) {
            const told = await (await fetch("/network?since=-1&event=0")).json();
            dash.network.take(told); dash.graph.arrange([...dash.network.ports.values()],
            [...dash.network.links.values()]); dash.graph.redraw(); }
            return (performance.now() - begin) / 10; }"""
        )
        print(f"{'everything anew':20}  {news:6.1f} ms")
        shown.close()
        chromium.close()


def _later(network: Snapshot) -> Snapshot:
    network = Snapshot(time.time(), network.ports, network.flows)
    return network


if __name__ == "__main__":
    main()
