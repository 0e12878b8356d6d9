"""Names: who is called what and where: clients of name services, and what a server is made of.

`base` is what ports are written against; `client`, `local` and `several` implement it.
`store`, `topology`, `command` are the pure parts of a name server; `database` makes them last.
"""
