"""The middlewares that come with yarpy; those of other packages have the entry point group
`yarpy.middlewares`."""
