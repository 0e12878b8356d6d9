"""The name server: what it keeps, what it answers, how it lasts.

`store`, `topology` and `command` are pure; `database` makes them last; `server` is the port in
front of them; `local` keeps the names of one process without any of it.
"""
