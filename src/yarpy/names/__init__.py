"""Names: who is called what and where, asked of name services.

`base` is what ports are written against; `client` and `fallback_client` implement it, and
`yarpy.nameserver.local` does for programs that need no server.
"""
