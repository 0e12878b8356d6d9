"""Names: where ports are found by name, asked of name services.

`base` is what ports are written against; `client` and `fallback_client` implement it, as does
`yarpy.nameserver.local` for programs that need no server.
"""
