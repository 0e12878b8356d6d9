"""Looking back: a page of a recording, or of the last minutes, and a server for it.

    with View(FileSource(["walk.mcap"])) as view:
        print(view.url)

Rules: the data of the page travel by the WebSocket protocol of Foxglove, so that Foxglove and
Lichtblick can use the same server; what a page asks besides is plain HTTP. Nothing on this side
changes through either.
"""
